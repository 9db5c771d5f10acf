"""`sim-bridge planar` as a person uses it: verdicts, pictures, and mistakes that cost one line."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import NamedTuple

import pytest
from PIL import Image

from onboard.runtime.program import run
from sim_bridge.campaign import plane_play
from sim_bridge.campaign.kernel_folder import FOLDER
from sim_bridge.cli import app
from sim_bridge.plane_game.program import table1
from tests.support.paths import ROOT
from tests.support.progress_lines import without_progress
from tests.support.real_time import patience

pytestmark = pytest.mark.timeout(300)  # twenty games at 0.01 s are 200,000 steps

ROW = table1()[9].read_text(encoding="utf-8")  # captured after 12 s: a short game


class Ended(NamedTuple):
    code: int
    out: str
    err: str


def command(*words: object) -> Ended:
    """`sim-bridge planar …` within this process, exit code and all."""
    out, err = io.StringIO(), io.StringIO()
    before = sys.argv
    sys.argv = ["sim-bridge", "planar", *map(str, words)]
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as end:
            run(app, "sim-bridge")
    finally:
        sys.argv = before
    return Ended(int(end.value.code or 0), out.getvalue(), without_progress(err.getvalue()))


def process(*words: object, folder: Path) -> Ended:
    """`sim-bridge planar …` as a process of its own."""
    done = subprocess.run(
        [sys.executable, "-m", "sim_bridge.cli", "planar", *map(str, words)], cwd=folder,
        timeout=patience(40.0), check=False, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    return Ended(done.returncode, done.stdout, without_progress(done.stderr))


def scenario(folder: Path, text: str = ROW, *changes: tuple[str, str]) -> Path:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "game.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_compiled_run_prints_what_an_interpreted_one_prints(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The kernel of `paper` is the one that other tests compile; what is not on disk is interpreted."""
    games = [*table1()[8:], "--json", "--strategy", "paper", "--strategy", "earlier"]
    played: list[bool] = []
    whole = plane_play.result
    monkeypatch.setattr(
        plane_play, "result", lambda *a: played.append((found := whole(*a)) is not None) or found
    )
    kept = Path(os.environ.get(FOLDER, "") or Path.home() / ".cache" / "apollonius" / "kernels")
    monkeypatch.setenv(FOLDER, str(tmp_path / "none"))
    interpreted = command(*games)
    assert not any(played)
    assert "numba" not in sys.modules or not (tmp_path / "none").exists()  # nothing was compiled
    monkeypatch.setenv(FOLDER, str(kept))
    assert command(*games[:2], "--json", "--strategy", "paper", "--compile").code == 0
    played.clear()
    compiled = command(*games)
    assert (compiled.out, compiled.code) == (interpreted.out, interpreted.code)
    assert [played[0], played[2]] == [True, True]  # by `paper`


def test_what_cannot_be_compiled_is_said(tmp_path: Path) -> None:
    ended = command(table1()[9], "--compile", "--figures", tmp_path)
    assert ended.code == 2
    assert ended.err == (
        "sim-bridge: --compile: found with --figures or --animate, expected without: they interpret\n"
    )


@pytest.mark.parametrize("dt", [pytest.param("0.01", marks=pytest.mark.long), "0.02", "0.05", "0.1"])
def test_table_1_comes_out_as_in_the_paper_at_every_time_step(dt: str) -> None:
    ended = command("--dt", dt)
    assert "30 of 30 verdicts as in the paper" in ended.out
    assert (ended.code, ended.err) == (0, "")


def test_the_claim_names_its_horizon_and_where_it_ends() -> None:
    """An evader that still flies at the horizon has escaped without arriving: a longer one lets it arrive."""
    said = command("--dt", "0.05").out.rstrip().splitlines()[-1]
    assert said == (
        "30 of 30 verdicts as in the paper, within a horizon of 100 s"
        " (30 of 30 hold from 55.7 to 120.4 s only: --horizon)"
    )
    for horizon, agree in (("55.6", 29), ("120.3", 30), ("200", 28)):
        ended = command("--horizon", horizon)
        last = ended.out.rstrip().splitlines()[-1]
        assert last.startswith(f"{agree} of 30 verdicts as in the paper, within a horizon of {horizon} s")
        assert ended.code == (0 if agree == 30 else 1)


@pytest.mark.real
def test_the_program_alone_plays_the_ten_rows_in_any_folder(tmp_path: Path) -> None:
    ended = process("--dt", "0.1", folder=tmp_path)
    assert (ended.code, ended.err) == (0, "")
    rows = [line for line in ended.out.splitlines() if line.startswith("table 1, row")]
    assert len(rows) == 10
    assert "30 of 30 verdicts" in ended.out
    assert list(tmp_path.iterdir()) == []


def test_a_verdict_that_differs_ends_with_1(tmp_path: Path) -> None:
    ended = command(scenario(tmp_path, ROW, ("escapes = false", "escapes = true")))
    assert ended.code == 1
    assert "2 of 3 verdicts" in ended.out


def test_a_scenario_without_expectation_is_played_and_judged_by_nobody(tmp_path: Path) -> None:
    ended = command(scenario(tmp_path, ROW.split("[expect]")[0]), "--strategy", "pure-pursuit")
    assert ended.code == 0
    assert "pure-pursuit: escaped" in ended.out
    assert "verdicts" not in ended.out


def test_json_is_one_object_a_game_and_nothing_else(tmp_path: Path) -> None:
    ended = command(scenario(tmp_path), "--json", "--figures", tmp_path / "out")
    games = [json.loads(line) for line in ended.out.splitlines()]
    assert [g["strategy"] for g in games] == ["paper", "earlier"]
    for game in games:
        assert game["verdict"] == "captured"
        assert game["escapes"] is False
        assert game["smallest_distance"] == pytest.approx(2.0, abs=1e-5)  # R: the game ends as it falls to it
        assert len(game["final_positions"]) == 6
        assert 0.0 < game["time"] < 100.0


def test_figures_are_written_as_png_and_svg_that_open(tmp_path: Path) -> None:
    ended = command(scenario(tmp_path), "--strategy", "paper", "--figures", tmp_path / "deep" / "out")
    assert ended.code == 0
    png, svg = sorted((tmp_path / "deep" / "out").iterdir())
    assert (png.suffix, svg.suffix) == (".png", ".svg")
    with Image.open(png) as picture:
        assert picture.width > 1000
        assert len(set(picture.convert("RGB").tobytes())) > 50  # not blank
    text = svg.read_text(encoding="utf-8")
    assert text.lstrip().startswith("<?xml")
    assert "</svg>" in text


def test_an_animation_is_a_gif_with_many_frames(tmp_path: Path) -> None:
    film = tmp_path / "game.gif"
    short = scenario(tmp_path, ROW.split("[expect]")[0], ("horizon = 100.0", "horizon = 0.6"))
    assert command(short, "--strategy", "paper", "--animate", film).code == 0
    with Image.open(film) as picture:
        assert picture.n_frames > 8


BAD = {
    "an unknown key": (("R = 2.0", "R = 2.0\nradius = 3"), "parameters.radius: unknown key"),
    "a wrong type": (("speed = 5", 'speed = "fast"'), "evader.speed: found 'fast', expected a number"),
    "a negative speed": (("speed = 4", "speed = -4"), "pursuers[0].speed: found -4, expected zero or more"),
    "a resting evader": (("speed = 5", "speed = 0"), "evader.speed: found 0.0, expected a positive speed"),
    "not a number": (("speed = 5", "speed = nan"), "evader.speed: found nan, expected a finite number"),
    "infinity": (("horizon = 100.0", "horizon = inf"), "parameters.horizon: found inf, expected a finite"),
    "infinity in a place": (("position = [0, 0]", "position = [-inf, 0]"), "evader.position[0]: found -inf"),
    "three numbers": (("position = [0, 0]", "position = [0, 0, 9]"), "found 2 numbers, expected 3 as in"),
    "one number": (("position = [0, 0]", "position = [0]"), "evader.position: found [0], expected a list"),
    "no TOML": (("[evader]", "[evader"), "not valid TOML"),
    "a step of nothing": (("dt = 0.05", "dt = 0.0"), "parameters.dt: found 0.0, expected a time step"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_mistake_in_a_scenario_costs_one_line(case: str, tmp_path: Path) -> None:
    change, said = BAD[case]
    path = scenario(tmp_path, ROW, change)
    ended = command(path, "--figures", tmp_path / "out")
    assert (ended.code, ended.out) == (2, "")
    assert ended.err.startswith(f"sim-bridge: {path}: ")
    assert said in ended.err
    assert ended.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def without(table: str) -> str:
    """The row without its evader or its pursuers."""
    kept, skip = [], False
    for line in ROW.splitlines():
        if line.startswith("["):
            skip = line.strip("[]") == table
        if not skip:
            kept.append(line)
    return "\n".join(kept)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (without("evader"), "evader: missing, but required"),
        (without("pursuers"), "pursuers: missing, but required"),
        ("pursuers = []\n" + without("pursuers"), "pursuers: found [], expected at least one pursuer"),
    ],
)
def test_a_game_without_its_players_costs_one_line(text: str, said: str, tmp_path: Path) -> None:
    path = scenario(tmp_path, text)
    ended = command(path)
    assert (ended.code, ended.out) == (2, "")
    assert ended.err == f"sim-bridge: {path}: {said}\n"


def test_a_bad_file_among_good_ones_is_found_before_anything_is_played(tmp_path: Path) -> None:
    good = scenario(tmp_path)
    ended = command(good, tmp_path / "none.toml", "--json", "--figures", tmp_path / "out")
    assert (ended.code, ended.out) == (2, "")
    assert ended.err == f"sim-bridge: {tmp_path / 'none.toml'}: no such file or directory\n"
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--dt", "0"], "--dt: found 0, expected a time step in (0, 1] s"),
        (["--horizon", "0"], "--horizon: found 0, expected a duration in (0, 86400] s"),
        (["--horizon", "nan"], "--horizon: found nan, expected a finite number"),
        (["--dt", "nan"], "--dt: found nan, expected a finite number"),
        (["--strategy", "magic"], "strategy: found 'magic', expected one of: paper, predictive"),
        (["--animate", "film.txt"], "--animate: found 'film.txt', expected a name ending in .gif or .mp4"),
        (["--animate", "nowhere/film.gif"], "--animate: found the folder 'nowhere'"),
        (["--colour"], "No such option"),
    ],
)
def test_a_wrong_option_costs_one_line(options: list[str], said: str, tmp_path: Path) -> None:
    ended = command(scenario(tmp_path), "--figures", tmp_path / "out", *options)
    assert (ended.code, ended.out) == (2, "")
    assert said in ended.err
    assert ended.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_made_costs_one_line(tmp_path: Path) -> None:
    path = scenario(tmp_path)
    ended = command(path, "--figures", path / "out")
    assert (ended.code, ended.out) == (2, "")
    assert ended.err == f"sim-bridge: {path / 'out'}: not a directory\n"


@pytest.mark.real
def test_a_mistake_leaves_no_traceback_in_a_process_of_its_own(tmp_path: Path) -> None:
    path = scenario(tmp_path, ROW, ("speed = 5", "speed = inf"))
    ended = process(path, folder=tmp_path)
    assert (ended.code, ended.out) == (2, "")
    assert ended.err == f"sim-bridge: {path}: evader.speed: found inf, expected a finite number\n"
