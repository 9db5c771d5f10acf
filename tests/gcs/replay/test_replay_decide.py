"""`gcs replay --decide`: flown agents fed again, with the same strategies and with others."""

from __future__ import annotations

import asyncio
import re
from pathlib import Path

import pytest

from gcs.replay.decide import Comparison, decide
from onboard.agent import event_file
from onboard.agent.core import flight
from onboard.agent.event_file import EventFile, FileSink, Full, Happened
from onboard.config.strict import ConfigError
from onboard.core.safety.policy import Policy
from onboard.game.scenario import load
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.resources import configs
from onboard.wire.bus.messages import Role
from sim_bridge.rehearsal import Options, Rehearsal


def fly(folder: Path, seconds: float) -> Path:
    """A game in which one pursuer hunts one evader, agents and all; the folder."""
    scenario = load(configs() / "scenarios" / "flight" / "one-on-one.toml")

    async def play() -> None:
        async with Rehearsal(scenario, virtual_clock(), Options(folder=folder)):
            await asyncio.sleep(seconds)

    run_virtual(play())
    return folder


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return fly(tmp_path_factory.mktemp("run"), 16.0)


@pytest.fixture(scope="module")
def again(flown: Path) -> Comparison:
    return decide(flown)


def test_the_same_machine_wants_the_same_done_again_byte_for_byte(again: Comparison) -> None:
    assert [fed.id for fed in again.fed] == [1, 2]
    for fed in again.fed:
        assert fed.events > 1000
        assert (fed.otherwise, fed.first, fed.remarks) == (0, "", ())
    assert again.compared > 100
    assert again.same == again.compared
    assert again.lines()[0] == f"{again.compared} decisions compared, {again.compared} the same (100.0 %)"


def test_another_strategy_shows_where_it_differs_and_for_whom(flown: Path, again: Comparison) -> None:
    other = decide(flown, {Role.PURSUER: "pure-pursuit"})
    assert other.compared == again.compared
    assert other.same < 0.7 * other.compared
    mine = [difference for difference in other.differences if difference.id == 2]
    assert mine
    assert all(difference.now == "pure_pursuit" for difference in mine)
    assert not any(difference.id == 1 for difference in other.differences)
    assert "→ pure_pursuit" in "\n".join(other.lines())
    assert all(fed.otherwise == 0 for fed in other.fed)  # what was flown stays the course of events


def test_a_changed_machine_is_found_out_with_the_first_effect_that_differs(
    flown: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def slower(wanted: object, seen: object, policy: Policy, state: object) -> object:
        envelope = policy.envelope._replace(speed_max=0.5 * policy.envelope.speed_max)
        return supervise(wanted, seen, policy._replace(envelope=envelope), state)  # type: ignore[arg-type]

    supervise = flight.supervise
    monkeypatch.setattr(flight, "supervise", slower)
    changed = decide(flown)
    for fed in changed.fed:
        assert fed.otherwise > 50
        assert re.search(r"recorded (Send|Publish)\(.* now (Send|Publish)\(", fed.first)
    assert "does otherwise after" in "\n".join(changed.lines())


def test_how_far_it_is_is_told_from_nothing_to_all(flown: Path) -> None:
    told: list[tuple[float, str]] = []
    decide(flown, tell=lambda share, what: told.append((share, what)))
    shares = [share for share, _ in told]
    assert shares == sorted(shares)
    assert shares[0] < 0.01
    assert shares[-1] > 0.99
    assert {what for _, what in told} == {"vehicle 1", "vehicle 2"}


def test_a_full_file_is_fed_as_far_as_it_goes_and_says_so(flown: Path, tmp_path: Path) -> None:
    story = event_file.read(flown / "vehicle-1.events")
    path = tmp_path / "vehicle-1.events"
    short = EventFile(FileSink(path), 100_000)
    short.begin(story.head.config, story.head.facts)
    for _share, record in story.records:
        assert isinstance(record, Happened)
        short.add(record.now, record.event, record.effects)  # type: ignore[arg-type]
    short.close()
    assert 90_000 < path.stat().st_size < 100_100
    assert short.counters() == {"events_unrecorded": 0, "events_file_full": 1}
    *records, last = [record for _, record in event_file.read(path).records]
    assert isinstance(last, Full)
    assert all(isinstance(record, Happened) for record in records)
    fed = decide(tmp_path).fed[0]
    assert (fed.events, fed.otherwise) == (len(records), 0)
    assert fed.remarks == ("the file was full at 0.1 MB: what came later is not in it",)


def test_where_the_disk_was_too_slow_it_is_fed_up_to_there(flown: Path, tmp_path: Path) -> None:
    class Slow(FileSink):
        chunks = 0

        def put(self, chunk: bytes) -> bool:
            self.chunks += 1
            return self.chunks != 3 and super().put(chunk)

    story = event_file.read(flown / "vehicle-1.events")
    lossy = EventFile(Slow(tmp_path / "vehicle-1.events"), 10**9)
    lossy.begin(story.head.config, story.head.facts)
    for _share, record in story.records:
        assert isinstance(record, Happened)
        lossy.add(record.now, record.event, record.effects)  # type: ignore[arg-type]
    lossy.close()
    assert lossy.counters()["events_unrecorded"] == 1
    fed = decide(tmp_path).fed[0]
    assert fed.otherwise == 0
    assert fed.remarks == ("the disk was too slow in flight: from here on records are missing",)


def test_a_strategy_that_does_not_exist_is_told_before_anything_else(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="found 'wishful', expected one of: paper"):
        decide(tmp_path, {Role.EVADER: "wishful"})


def test_a_run_without_records_and_a_file_that_is_none_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"found no vehicle-N\.events"):
        decide(tmp_path)
    (tmp_path / "vehicle-3.events").write_bytes(b"nothing of the kind")
    with pytest.raises(ConfigError, match="found no recorded flight"):
        decide(tmp_path)
