"""The product still does what was recorded, the everyday share; and the guard sees what it must see.

The whole guard, some two minutes, is `make golden`.
"""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.golden import adapter, capture, differences, digests, translations
from tests.golden.guard import chosen, same_arithmetic
from tests.golden.parts import PARTS, RECORDED, RECORDINGS, SHORT, Rows, Streamed

EPOCH_NS = adapter.EPOCH_NS
BEAT = "HEARTBEAT from 1/191"


@cache
def why_not_comparable() -> str:
    return "; ".join(same_arithmetic())


@pytest.mark.game
@pytest.mark.parametrize("name", SHORT)
def test_the_product_does_what_was_recorded(name: str, tmp_path: Path) -> None:
    if why_not_comparable():
        pytest.skip(f"floats differ in their last bits on this machine: {why_not_comparable()}")
    lines = PARTS[name].compare(RECORDED, tmp_path)
    assert not lines, "\n".join(lines)


def test_every_part_is_recorded_and_can_be_read() -> None:
    for name, part in PARTS.items():
        if isinstance(part, Streamed):
            kept = digests.read(RECORDED, name)
            assert set(kept.seconds) == set(kept.overview["streams"])
            for stream, told in kept.overview["streams"].items():
                assert set(kept.seconds[stream]) == {*told["kinds"], digests.WHOLE}
        else:
            assert len((RECORDED / f"{name}.jsonl").read_text(encoding="utf-8").splitlines()) >= 20


# ---------------------------------------------------------------------- that it sees


def bus(*messages: tuple[str, float, object]) -> list[capture.Item]:
    return [
        capture.Item(topic, EPOCH_NS + round(at * 1e9), capture.canonical(value), json.loads)
        for topic, at, value in messages
    ]


TOLD = bus(
    ("vehicles/1/state", 0.1, [1, [1, 5.0]]),
    ("vehicles/2/state", 0.1, [1, [2, 7.0]]),
    ("vehicles/1/state", 1.1, [1, [1, 6.0]]),
    ("vehicles/1/state", 2.1, [1, [1, 6.5]]),
)


def lines_of(now: list[capture.Item], folder: Path, summary: Any = "") -> list[str]:
    expected = digests.kept(digests.Part({"bus": TOLD}, ""), EPOCH_NS, 1)
    part = digests.Part({"bus": now}, summary)
    return differences.Comparison("game", expected, part, EPOCH_NS).lines(folder)


def test_the_same_again_is_no_difference(tmp_path: Path) -> None:
    assert lines_of(list(TOLD), tmp_path) == []
    assert list(tmp_path.iterdir()) == []


def test_a_last_bit_is_told_with_second_topic_and_value_and_lies_decoded(tmp_path: Path) -> None:
    changed = list(TOLD)
    changed[2] = bus(("vehicles/1/state", 1.1, [1, [1, 6.000000000000001]]))[0]
    lines = lines_of(changed, tmp_path)
    assert lines[0] == "game: bus: first difference in second 1: vehicles/1/state"
    assert any("[1][1]: expected 6.0, found 6.000000000000001" in line for line in lines)
    text = (tmp_path / "game" / "bus" / "vehicles_1_state.txt").read_text()
    assert "1.100000000 [1, [1, 6.000000000000001]]" in text


@pytest.mark.parametrize(
    ("now", "told"),
    [
        (TOLD[:3], "expected 1 in second 2, found 0"),
        ([*TOLD, *bus(("game/phase", 3.0, [1, []]))], "first difference in second 3: game/phase"),
        ([TOLD[1], TOLD[0], *TOLD[2:]], "second 0: the same items in another order"),
        ([TOLD[0]._replace(at_ns=TOLD[0].at_ns + 1), *TOLD[1:]], "second 0: vehicles/1/state"),
        (bus(("vehicles/1/state", 0.1, [1, [1, 5]]))[:1] + TOLD[1:], "expected 5.0, found 5"),
    ],
)
def test_what_is_missing_new_earlier_later_or_of_another_type(
    now: list[capture.Item], told: str, tmp_path: Path
) -> None:
    assert told in "\n".join(lines_of(now, tmp_path))


def test_a_summary_that_differs_is_told(tmp_path: Path) -> None:
    lines = lines_of(list(TOLD), tmp_path, {"verdict": "arrived"})
    assert any("summary.json" in line and "arrived" in line for line in lines)


class Table(Rows):
    """A table that says what it is told to."""

    def __init__(self, **times: float) -> None:
        super().__init__("table")
        self.times = times

    def rows(self) -> dict[str, Any]:
        return {name: {"verdict": "captured", "time": time} for name, time in self.times.items()}


def test_a_row_of_a_table_that_differs_is_told(tmp_path: Path) -> None:
    Table(one=22.420565, two=3.0).record(tmp_path)
    assert Table(one=22.420565, two=3.0).compare(tmp_path, tmp_path / "found") == []
    assert not (tmp_path / "found").exists()
    lines = Table(one=22.420566, three=4.0).compare(tmp_path, tmp_path / "found")
    assert lines[0] == "table: one: time: expected 22.420565, found 22.420566"
    assert [line.split(":")[1] for line in lines[1:]] == [" two", " three"]
    assert "22.420566" in (tmp_path / "found" / "table.jsonl").read_text()


def test_a_declared_translation_gives_the_recorded_shape_and_nothing_else() -> None:
    table = (
        translations.Translation(
            r"craft/([0-9]+)/state", lambda m: [1, [m["id"], m["speed"]]], "a map now", r"vehicles/\1/state"
        ),
    )
    found = translations.translated("craft/7/state", {"id": 7, "speed": 2.5}, table)
    assert found == ("vehicles/7/state", [1, [7, 2.5]])
    assert translations.translated("tracks/7", {"id": 7}, table) == ("tracks/7", {"id": 7})


def test_a_release_is_no_difference_but_another_health_is() -> None:
    def health(version: str, stage: str) -> object:
        body = [1, "evader", 0, stage, [], "", "", False, 1.0, 1.0, 0.0, 0.0, 0.0, 0, True, "ok", version, {}]
        return translations.translated("vehicles/1/health", [1, body], translations.EXCLUDED)

    assert health("0.1.0", "ready") == health("0.2.0", "ready")
    assert health("0.1.0", "ready") != health("0.1.0", "acting")


def test_frames_are_told_by_type_and_sender_and_a_cut_log_is_refused() -> None:
    log = (RECORDINGS / "arducopter-4.5.6-guided.tlog").read_bytes()
    items = capture.framed(capture.frames(log))
    assert b"".join((i.at_ns // 1000).to_bytes(8, "big") + i.data for i in items) == log
    beat = next(item for item in items if item.kind == BEAT)
    assert beat.decode(beat.data)["type"] == 18  # MAV_TYPE_ONBOARD_CONTROLLER
    with pytest.raises(ValueError, match="no whole MAVLink frame"):
        list(capture.frames(log[:-1]))


def test_parts_are_chosen_by_name_or_by_its_beginning() -> None:
    assert chosen("") == list(PARTS)
    assert chosen("planar,frames") == ["frames-arducopter", "frames-arduplane", "planar"]
    assert chosen("game-demo") == ["game-demo"]
    assert len(chosen("games")) == 4
    with pytest.raises(ValueError, match="'plane'"):
        chosen("plane")
