"""NamedTuples made by `new`: as by a call of the class, interpreted and compiled, and checked by mypy."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from numba import njit

from onboard.core.math.each import new
from onboard.core.math.states import Mate
from onboard.core.math.vectors import Vec, add
from sim_bridge.campaign.compiled import register

ROOT = Path(__file__).parents[1]
MADE_IN = "onboard/core/math/each.py"


class Mixed(NamedTuple):
    """Fields of several kinds, some of them given as constants."""

    said: bool
    place: Vec
    number: int
    share: float


def mixed(v: Vec, number: int) -> tuple[Mixed, Mixed, Vec]:
    """Made of constants, of what is reckoned, and one of the other."""
    first = new(Mixed, (True, new(Vec, (v.x, 2.0, v.z)), 3, 0.5))
    return first, new(Mixed, (v.x > 0.0, add(v, first.place), number, v.y)), new(Vec, (v.y, v.z, v.x))


def test_interpreted_it_is_what_the_class_makes():
    made = new(Mate, (2, Vec(1.0, 2.0, 3.0), Vec(4.0, 5.0, 6.0), 0.5))
    assert made == Mate(2, Vec(1.0, 2.0, 3.0), Vec(4.0, 5.0, 6.0), 0.5)
    assert type(made) is Mate


def test_compiled_it_is_what_is_interpreted():
    register()
    v = Vec(1.5, -2.0, 3.25)
    compiled = njit(mixed)(v, 7)
    assert compiled == mixed(v, 7)
    assert [type(one) for one in compiled] == [Mixed, Mixed, Vec]


WRONG = {
    "new(Vec, (v.x, v.y))": "found 2 fields, expected 3",
    'new(Vec, (v.x, v.y, "z"))': "field 3 is Literal['z']?, expected float",
    "new(Vec, several)": "how many fields it gives is not known",
    "new(float, (v.x,))": "the first argument is no NamedTuple",
    "new(Vec)": "Too few arguments",
    "new(Mate, (1, v, v, 0.0)).speed": 'has no attribute "speed"',
}
RIGHT = ("new(Vec, (v.x, 1, 2.0))", "new(Vec, three)", "new(Mate, (1, v, v, 0.0)).age")


def test_mypy_checks_number_and_types_of_its_fields(tmp_path):
    lines = [
        "from onboard.core.math.each import new",
        "from onboard.core.math.states import Mate",
        "from onboard.core.math.vectors import Vec",
        "def all(v: Vec, several: tuple[float, ...], three: tuple[float, float, float]) -> None:",
        *(f"    print({call})" for call in (*WRONG, *RIGHT)),
    ]
    file = tmp_path / "made.py"
    file.write_text("\n".join(lines) + "\n")
    config = tmp_path / "mypy.ini"
    config.write_text(f"[mypy]\nstrict = True\nplugins = {ROOT / 'tests/support/mypy_new.py'}\n")
    mypy = [sys.executable, "-m", "mypy", "--config-file", config, "--cache-dir", tmp_path / "cache", file]
    said = subprocess.run(mypy, cwd=ROOT, capture_output=True, text=True, check=False).stdout
    for number, expected in enumerate(WRONG.values(), 5):
        here = [line for line in said.splitlines() if f"made.py:{number}: error" in line]
        assert any(expected in line for line in here), said
    assert said.count("error:") == len(WRONG), said


@pytest.mark.parametrize("room", ["onboard", "gcs", "sim_bridge"])
def test_nothing_goes_past_that_check(room):
    files = [file for file in (ROOT / room).rglob("*.py") if "tuple.__new__" in file.read_text()]
    assert [file for file in files if file != ROOT / MADE_IN] == []
