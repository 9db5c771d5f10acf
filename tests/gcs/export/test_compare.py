"""Two runs beside each other: what differed, what came of it, where they part."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import pytest

from gcs.export.compare import compare
from onboard.config.strict import ConfigError
from onboard.wire.bus import topics
from tests.support.chase_messages import Item
from tests.support.run_folders import SCENARIO, flight, make_run


def shifted(items: list[Item], after_s: float, metres: float) -> list[Item]:
    """The same flight in which vehicle 2 stands `metres` farther north from an instant of the flight on."""
    found = []
    begin = items[0].stamp_ns
    for item in items:
        place = topics.TOPICS.find(item.key)
        if place is not None and place.topic is topics.STATE and place.id == 2:
            state = topics.STATE.decode(item.payload, {})  # type: ignore[arg-type]
            assert state is not None
            if item.stamp_ns - begin > after_s * 1e9:
                north, east, down = state.position
                state = msgspec.structs.replace(state, position=(north + metres, east, down))
            item = item._replace(payload=topics.STATE.encode(state))
        found.append(item)
    return found


def test_a_run_is_the_same_as_itself(tmp_path: Path) -> None:
    run = make_run(tmp_path / "run")
    found = compare(run, run)
    assert found.played == ()
    assert all(row.same for row in (*found.figures, *found.rules))
    assert all("at most 0.00 m apart" in way and "more than" not in way for way in found.ways)
    assert len(found.ways) == 3
    assert "≠" not in "\n".join(found.lines())


def test_it_names_what_was_played_otherwise_and_where_the_ways_part(tmp_path: Path) -> None:
    first = make_run(tmp_path / "first")
    second = make_run(tmp_path / "second", shifted(flight(), 12.0, 7.5))
    text = SCENARIO.replace("speed = 12.0", "speed = 12.5").replace("R = 5.0", "R = 4.0")
    (second / "scenario.toml").write_text(text + "\n[flight]\nready_s = 7.0\n")
    found = compare(first, second)
    assert [(row.what, row.first, row.second) for row in found.played] == [
        ("evader.speed", "12.0", "12.5"), ("parameters.R", "5.0", "4.0"), ("flight.ready_s", "5.0", "7.0"),
    ]  # fmt: skip
    (moved,) = (way for way in found.ways if way.startswith("pursuer 2"))
    told = re.search(r"at most 7\.50 m apart, more than 1 m from (\d+\.\d) s on", moved)
    assert told is not None
    assert 9.0 < float(told[1]) < 12.5  # t₀ comes two seconds after the recording's begin
    assert sum("more than" in way for way in found.ways) == 1
    nearest = {row.what: row for row in found.figures}
    assert nearest["pursuer 3 nearest [m]"].same
    assert not nearest["pursuer 2 nearest [m]"].same


def test_shares_of_rules_are_shares(tmp_path: Path) -> None:
    run = make_run(tmp_path / "run")
    shares: dict[str, float] = {}
    for row in compare(run, run).rules:
        vehicle = row.what.split(":")[0]
        shares[vehicle] = shares.get(vehicle, 0.0) + float(row.first.rstrip("%"))
    assert shares
    assert all(98.0 <= total <= 102.0 for total in shares.values())


def test_a_run_that_is_not_there_is_said(tmp_path: Path) -> None:
    run = make_run(tmp_path / "run")
    with pytest.raises(ConfigError, match="nothing: no such run"):
        compare(run, tmp_path / "nothing")
