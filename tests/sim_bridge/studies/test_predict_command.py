"""`sim-bridge predict`: tracks from files and scenarios, the example of 3.5.2, tables and figures."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from onboard.config.strict import ConfigError
from onboard.runtime.resources import configs
from sim_bridge.studies.comparison import FLYING, LAST, PAPER, STEADY, Comparison, compare, table
from sim_bridge.studies.paper_example import example, example_table
from sim_bridge.studies.predict import predict
from sim_bridge.studies.tracks import Recording, recording_of, weave


def write(path: Path, recording: Recording) -> Path:
    rows = [f"{s.t},{s.position.x},{s.position.y},{s.position.z}" for s in recording.samples]
    path.write_text("\n".join(["t,north,east,down", *rows]))
    return path


def test_a_recorded_track_is_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = write(tmp_path / "weave.csv", weave(seconds=40.0))
    predict(source, tmp_path / "out", json=True)
    found = msgspec.json.decode(capsys.readouterr().out, type=Comparison)
    error = {row.predictor: row.mean_error for row in found.rows}
    assert set(error) == {LAST, STEADY, FLYING, PAPER}
    assert not found.simulated
    assert found.instants > 100
    one_second = found.horizons.index(1.0)
    assert error[FLYING][one_second] < 0.8 * error[STEADY][one_second] < 0.8 * error[LAST][one_second]
    assert len(list((tmp_path / "out").glob("predict-*.png"))) == 1


def test_a_scenario_is_simulated_and_its_evader_followed() -> None:
    scenario = configs() / "scenarios" / "table1" / "row05.toml"
    drawn = compare(recording_of(scenario), paper=False)
    assert drawn.comparison.simulated
    text = table(drawn.comparison)
    assert FLYING in text
    assert "who spoke" in text


def test_the_example_of_3_5_2_has_a_network_a_coordinate_and_a_figure(tmp_path: Path) -> None:
    from sim_bridge.studies.predict_figures import draw_activation, draw_example

    played = example(epochs=30)
    for one in played.results:
        assert one.error_test < 1.5
        assert one.epochs == 30
        assert one.time > 0.0
    assert [one.coordinate for one in played.results] == ["x", "y"]
    assert "test set" in example_table(played)
    x, y = (one.error_steady for one in played.results)  # of the trajectory alone: second differences
    assert x == pytest.approx(0.0129, abs=5e-5)
    assert y == pytest.approx(0.0259, abs=5e-5)
    assert "which learns nothing, errs by 0.013 m in x and 0.026 m in y" in example_table(played)
    assert all(path.stat().st_size > 1000 for path in draw_example(played, tmp_path))
    assert all(path.stat().st_size > 1000 for path in draw_activation(tmp_path))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "expected t,north,east,down"),
        ("t,x,y\n1,2,3\n", "expected t,north,east,down"),
        ("t,north,east,down\n0,1,2,3\n1,a,2,3\n", "line 3: north: found 'a', expected a finite number"),
        ("t,north,east,down\n0,1,2,nan\n", "line 2: down"),
        ("t,north,east,down\n0,1,2\n", "line 2: down"),
        ("t,north,east,down\n0,1,2,3\n", "found 1 instants"),
        ("t,north,east,down\n0,1,2,3\n1,1,2,3\n", "found 2 samples, expected at least 20"),
    ],
)
def test_bad_tracks_are_named_in_one_line(tmp_path: Path, text: str, said: str) -> None:
    source = tmp_path / "bad.csv"
    source.write_text(text)
    with pytest.raises(ConfigError) as failure:
        predict(source)
    assert said in str(failure.value)
    assert "\n" not in str(failure.value)


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no such file"):
        predict(tmp_path / "none.csv")
