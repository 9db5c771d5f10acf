"""Sweep files: every combination once, samples that fill the space, each mistake named where it stands."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest

from onboard.config.strict import ConfigError
from sim_bridge.programs.campaigns import sweep
from sim_bridge.programs.campaigns.command import Options, plan_of

LISTS = '[list]\n"evader.speed" = [5.0, 6.0]\n"pursuers[0].speed" = [1, 2, 3]\n'
RANGE = '[range]\n"parameters.R" = { from = 1.0, to = 2.0, count = 5 }\n'


def points(folder: Path, text: str) -> list[sweep.Point]:
    path = folder / "sweep.toml"
    path.write_text(text, "utf-8")
    return sweep.load(path)


def test_lists_and_ranges_combine_each_value_with_each(tmp_path: Path) -> None:
    found = points(tmp_path, LISTS + RANGE)
    wanted = set(product((5.0, 6.0), (1, 2, 3), (1.0, 1.25, 1.5, 1.75, 2.0)))
    assert len(found) == len(wanted)
    assert {tuple(point.values()) for point in found} == wanted


def test_a_latin_hypercube_has_one_point_in_each_of_its_slices(tmp_path: Path) -> None:
    text = '[latin-hypercube]\ncount = 16\nseed = 3\nbetween = { "a.b" = [2.0, 4.0], "c" = [-1.0, 0.0] }\n'
    found = points(tmp_path, text)
    for key, low, high in (("a.b", 2.0, 4.0), ("c", -1.0, 0.0)):
        places = np.sort([float(point[key]) for point in found])
        slices = np.floor((places - low) / (high - low) * 16)
        assert slices.tolist() == list(range(16))
    assert points(tmp_path, text) == found  # the seed says all
    assert points(tmp_path, text.replace("seed = 3", "seed = 4")) != found


def test_a_sobol_sequence_halves_every_axis_evenly(tmp_path: Path) -> None:
    text = '[sobol]\ncount = 32\nbetween = { "x" = [0.0, 1.0], "y" = [0.0, 1.0] }\n'
    found = np.array([[float(p["x"]), float(p["y"])] for p in points(tmp_path, text)])
    quarters = (found[:, 0] >= 0.5) * 2 + (found[:, 1] >= 0.5)
    assert np.bincount(quarters.astype(int)).tolist() == [8, 8, 8, 8]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "expected a key or more"),
        ('[list]\n"evader.speed" = []', "list.evader.speed: found [], expected one value or more"),
        ('[list]\n"evader.speed" = 5', "list.evader.speed: found 5, expected a list"),
        ('[list]\n"evader.speed" = [nan]', "expected a finite number"),
        ('[lists]\n"evader.speed" = [1]', "lists: unknown key; did you mean 'list'"),
        ('[range]\n"a" = { from = 1, to = 2, cuont = 3 }', "range.a: cuont: unknown key; did you mean"),
        ('[range]\n"a" = { from = 1, to = 2, count = 1 }', "range.a: count: found 1, expected 2 to"),
        ('[sobol]\ncount = 6\nbetween = { "a" = [1, 2] }', "sobol.count: found 6, expected a power of two"),
        ('[sobol]\ncount = 8\nbetween = { "a" = [2, 1] }', "between.a: found 2 to 1, expected a growing"),
        ('[sobol]\ncount = 8\nbetween = { "a" = [2] }', "between.a: found"),
        (LISTS + '[range]\n"evader.speed" = { from = 1, to = 2, count = 3 }', "a key in two tables"),
        (LISTS + '[range]\n"x" = { from = 1, to = 2, count = 90000 }', "expected at most 100000"),
    ],
)
def test_a_mistake_in_a_sweep_file_is_named_where_it_stands(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(ConfigError) as error:
        points(tmp_path, text)
    assert said in str(error.value)
    assert "sweep.toml" in str(error.value)


@pytest.mark.parametrize(
    ("scenario", "key", "value", "said"),
    [
        ("row01", "evader.sped", "4", "evader.sped: unknown key; did you mean 'speed'"),
        ("row01", "evadr.speed", "4", "evadr: unknown key"),
        ("row01", "pursuers[9].speed", "4", "pursuers[9].speed: found no such key"),
        ("row01", "pursuers.speed", "-1", "speed: found -1, expected zero or more"),
        ("row01", "evader.speed", "'x'", "expected"),
        ("row01", "a b", "1", "a b: found no such key"),
        ("row01", "flight.wind.speed", "4", "simple motion, which knows nothing of it"),
        ("row01", "evader.acceleration", "4", "which know nothing of it"),
        ("row01", "seed", "4", "but the seed draws it"),
        ("row01", "pursuers[0].strategy", "'paper'", "strategies are options"),
        ("five", "flight.wind.from_deg", "4", "but the seed draws it"),
        ("five", "parameters.dt", "0.1", "which know nothing of it"),
        ("five", "flight.impairment.loss", "0.1", "which know nothing of it; see --flown"),
    ],
)
def test_a_swept_key_that_is_wrong_or_would_change_nothing_is_refused(
    tmp_path: Path, scenario: str, key: str, value: str, said: str
) -> None:
    path = tmp_path / "sweep.toml"
    path.write_text(f'[list]\n"{key}" = [{value}]\n', "utf-8")
    with pytest.raises(ConfigError) as error:
        plan_of(Options((Path(scenario),), sweep=path), until=False)
    assert said in str(error.value)


def test_a_swept_value_reaches_the_scenario_of_its_cell(tmp_path: Path) -> None:
    path = tmp_path / "sweep.toml"
    path.write_text('[list]\n"pursuers.speed" = [36.0, 38.0]\n"flight.wind.speed" = [2]\n', "utf-8")
    plan = plan_of(Options((Path("five"),), sweep=path, evaders=("paper", "straight")), until=False)
    assert plan.cell_count == 4
    cells = [plan.cell(number) for number in range(4)]
    assert [{p.speed for p in cell.scenario.pursuers} for cell in cells] == [{36.0}, {36.0}, {38.0}, {38.0}]
    assert [cell.scenario.evader.strategy for cell in cells] == ["paper", "straight"] * 2
    assert {cell.scenario.flight.wind.speed for cell in cells} == {2.0}
