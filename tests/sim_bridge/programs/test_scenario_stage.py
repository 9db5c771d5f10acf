"""`sim-bridge scenario stage` and what `scenario check` says of the band, on files as people write them."""

from __future__ import annotations

from math import hypot, radians
from pathlib import Path

import pytest
from msgspec.structs import replace

from onboard.config.strict import ConfigError
from onboard.game.scenario import load
from onboard.runtime.resources import configs
from sim_bridge.programs.scenario_band import band_lines, stage_file, turn_rate_of
from sim_bridge.programs.scenario_picture import draw_band
from sim_bridge.programs.scenario_tools import check

SCENARIOS = configs() / "scenarios"


def staged(name: str, folder: Path, seconds: float | None = None, nearest: float | None = None) -> Path:
    file = folder / "staged.toml"
    stage_file(SCENARIOS / f"{name}.toml", file, seconds, nearest)
    return file


@pytest.mark.parametrize(
    ("name", "nearest"), [("spatial/five", 1496.0), ("spatial/six", 1496.0), ("flight/demo", 60.0)]
)
def test_a_staged_file_is_closed_far_enough_out_and_else_the_same(
    name: str, nearest: float, tmp_path: Path
) -> None:
    before, after = load(SCENARIOS / f"{name}.toml"), load(staged(name, tmp_path))
    assert "closed" in band_lines(after)[0]
    assert "open" in band_lines(before)[0] or name == "flight/demo"
    assert all(hypot(*p.position[:2]) >= nearest - 0.2 for p in after.pursuers)
    assert min(abs(p.position[1] / p.position[0]) for p in after.pursuers) < 1e-3 or name == "flight/demo"
    assert (after.evader, after.parameters, after.flight) == (before.evader, before.parameters, before.flight)
    text = (SCENARIOS / f"{name}.toml").read_text()
    comments = [line for line in text.splitlines() if line.startswith("#")]
    assert all(comment in (tmp_path / "staged.toml").read_text() for comment in comments)


def test_too_few_pursuers_are_told_the_bound(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="takes 4, here are 2"):
        staged("spatial/two", tmp_path)
    assert not (tmp_path / "staged.toml").exists()
    assert any("takes 4, here are 2" in line for line in band_lines(load(SCENARIOS / "spatial/two.toml")))


def test_too_little_time_is_told_with_the_time_that_is_enough(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"in 20 s; .*with (\d+) s they can") as told:
        staged("spatial/five", tmp_path, 20.0)
    enough = float(str(told.value).split("with ")[-1].split(" s")[0])
    assert "closed" in band_lines(load(staged("spatial/five", tmp_path, enough)))[0]


def test_four_aircraft_need_a_wide_ring_for_their_turns(tmp_path: Path) -> None:
    """Near by, the turn of the noses eats the overlap of four: the smallest closed ring is a wider one."""
    ring = load(SCENARIOS / "spatial/ring-4.toml")
    near = tmp_path / "near.toml"
    text = (SCENARIOS / "spatial/ring-4.toml").read_text().replace("2000.0", "1000.0").replace("2130", "1000")
    near.write_text(text)
    assert "closed" in band_lines(ring)[0]
    assert "open" in band_lines(load(near))[0]
    stage_file(near, tmp_path / "far.toml", None, 1000.0)
    far = load(tmp_path / "far.toml")
    assert min(hypot(*p.position[:2]) for p in far.pursuers) > 1300.0


def test_check_tells_the_turn_that_the_aircraft_can_fly() -> None:
    """Left at its default a file declares 60 deg/s; the rudder of `nose` holds 4.5."""
    six = load(SCENARIOS / "spatial/six.toml")
    told = check(six)
    assert "636.6 m" in told
    assert "a half turn of the evader takes 40.0 s" in told
    assert "its airframe holds" not in told
    quick = replace(six, evader=replace(six.evader, turn_rate_deg=60.0))
    told = check(quick)
    assert "a half turn of the evader takes 40.0 s" in told
    assert "warning: vehicle 1 declares a turn of 60°/s, its airframe holds 4.5" in told


@pytest.mark.parametrize("path", sorted(SCENARIOS.rglob("*.toml")), ids=lambda path: path.stem)
def test_shipped_scenarios_declare_turns_that_their_airframes_hold(path: Path) -> None:
    scenario = load(path, several=True)
    for index, spec in enumerate(scenario.vehicles):
        assert turn_rate_of(scenario, index) == pytest.approx(radians(spec.turn_rate_deg))


@pytest.mark.parametrize("layout", ["inline", "two lines"])
def test_other_ways_to_write_pursuers_are_refused_by_place(layout: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    evader = 'name = "mine"\n[evader]\nposition = [0, 0]\nspeed = 5\ntarget = [90, 0]\n'
    places = [(60, 0), (0, 60), (-60, 0), (0, -60), (50, 50)]
    if layout == "inline":
        rows = ", ".join(f"{{ position = [{x}, {y}], speed = 4 }}" for x, y in places)
        file.write_text(f"pursuers = [{rows}]\n{evader}")
    else:
        tables = [f"[[pursuers]]\nposition = [{x},\n  {y}]\nspeed = 4\n" for x, y in places]
        file.write_text(evader + "".join(tables))
    with pytest.raises(ConfigError, match=r"pursuers.*expected a table \[\[pursuers\]\]"):
        stage_file(file, tmp_path / "out.toml", None, None)
    assert not (tmp_path / "out.toml").exists()


def test_an_existing_file_is_kept(tmp_path: Path) -> None:
    (tmp_path / "staged.toml").write_text("mine")
    with pytest.raises(ConfigError, match="a file of this name already"):
        staged("flight/demo", tmp_path)
    assert (tmp_path / "staged.toml").read_text() == "mine"


def test_the_picture_shows_what_the_words_say(tmp_path: Path) -> None:
    """The band's map is drawn from the very cones: its title tells an open band where it is open."""
    drawn = draw_band(load(SCENARIOS / "spatial/two.toml"), tmp_path, "two")
    assert [path.suffix for path in drawn] == [".png", ".svg"]
    assert drawn[0].read_bytes().startswith(b"\x89PNG")
    assert drawn[1].stat().st_size < 500_000
