"""The reference of scenario files says what the types say, of every key, and is up to date."""

from __future__ import annotations

import re

import pytest

from onboard.config import strict
from onboard.config.strict import ConfigError
from onboard.game.describe import described
from onboard.game.scenario import Scenario
from tests.support.paths import ROOT

MINIMAL = 'name = "a"\n[evader]\nposition = [0, 0]\nspeed = 5\n[[pursuers]]\nposition = [9, 9]\nspeed = 4\n'


def test_the_page_is_up_to_date() -> None:
    page = (ROOT / "docs" / "scenario-reference.md").read_text(encoding="utf-8")
    assert page == described(), "python -m onboard.game.describe > docs/scenario-reference.md"


def rows() -> dict[str, list[tuple[str, str, str, str]]]:
    """The rows of each table of the page, by its heading."""
    found: dict[str, list[tuple[str, str, str, str]]] = {}
    heading = ""
    for line in described().splitlines():
        if line.startswith("## "):
            heading = line[3:]
        cells = line.strip("|").split(" | ")
        if line.startswith("| `"):
            found.setdefault(heading, []).append(tuple(cell.strip() for cell in cells))  # type: ignore[arg-type]
    return found


def test_every_key_says_what_it_may_be_and_what_it_is_for() -> None:
    for heading, table in rows().items():
        for row in table:
            assert len(row) == 4, (heading, row)
            assert all(row), (heading, row)


def test_a_file_takes_every_key_of_the_page_and_no_other() -> None:
    """A key is known where its table takes it: what is refused is then its value."""
    for heading, table in rows().items():
        places = re.findall(r"\[+([\w.]+)\]+", heading) or [""]
        for key in (row[0].strip("`") for row in table):
            for known in (key, f"{key}x"):
                text = with_key(places[0], known)
                try:
                    strict.parse(text, Scenario, "file")
                    said = ""
                except ConfigError as error:
                    said = str(error)
                assert ("unknown key" in said) is (known != key), (heading, known, said)


def with_key(place: str, key: str) -> str:
    """A whole small scenario in which a table has a key more, with a value of no type that any key has."""
    line = f"{key} = 1979-05-27\n"
    if not place:
        lines = MINIMAL.splitlines(keepends=True)
        return line + "".join(one for one in lines if not one.startswith(f"{key} "))
    if place == "evader":
        head, _, rest = MINIMAL.partition("[evader]\n")
        body, _, pursuers = rest.partition("[[")
        kept = "".join(one for one in body.splitlines(keepends=True) if not one.startswith(f"{key} "))
        return f"{head}[evader]\n{line}{kept}[[{pursuers}"
    return f"{MINIMAL}[[{place}]]\n{line}" if place == "zones" else f"{MINIMAL}[{place}]\n{line}"


@pytest.mark.parametrize("key", ["R", "rho", "horizon"])
def test_the_defaults_are_those_of_a_file_that_says_nothing(key: str) -> None:
    parameters = strict.parse(MINIMAL, Scenario, "file").parameters
    (row,) = (row for row in rows()["`[parameters]`"] if row[0] == f"`{key}`")
    value = getattr(parameters, key)
    assert row[2] == ("–" if value is None else f"`{value}`")
