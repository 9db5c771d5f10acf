"""Whole games from staging to recovery: as a person at the field would tell them afterwards."""

from __future__ import annotations

from math import sqrt
from pathlib import Path

import pytest

from onboard.game.scenario import ImpairmentSpec, Kind, SensorSpec
from onboard.wire.bus.messages import OutcomeResult
from onboard.wire.bus.topics import EVADER_BRIEF, OUTCOME, TOPICS, Party
from onboard.wire.mavlink.tlog import read_tlog
from tests.support.flown_autopilot import FLOWN
from tests.support.small_scenarios import EVADER, GUIDED, HOLD, MATE, PURSUER, duel
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    STORY,
    HeardOfGame,
    WholeGame,
    game_of,
    mode,
    phases,
    place,
    speed,
    under_way,
)

pytestmark = pytest.mark.game


@pytest.mark.parametrize("kind", FLOWN, ids=lambda kind: kind.value)
@virtual
async def test_a_game_stages_starts_plays_and_ends_with_a_capture(kind: Kind) -> None:
    async with game_of(duel(kind)) as game:
        await under_way(game, 2.0)
        assert [mode(game, id) for id in (EVADER, PURSUER)] == [GUIDED[kind]] * 2
        assert speed(game, EVADER) == pytest.approx(40.0 if kind is Kind.ARDUPLANE else 4.0, rel=0.1)
        outcome = await game.until_ended()
        await game.forward(1.0)
        assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, PURSUER)
        assert 3.0 < outcome.time < (40.0 if kind is Kind.ARDUPLANE else 8.0)
        assert [phases(game, id) for id in (EVADER, PURSUER)] == [STORY, STORY]
        assert [mode(game, id) for id in (EVADER, PURSUER)] == [HOLD[kind]] * 2
        await game.land_agents()
        for id in (EVADER, PURSUER):
            kinds = game.kinds(id)
            story = ("started", "autopilot", "setup", "control", "released", "stopped")
            assert [kinds.index(one) for one in story] == sorted(kinds.index(one) for one in story)
        summary = game.summary()
        radius = game.scenario.parameters.R
        assert (summary.verdict, summary.captor, summary.time) == ("captured", 2, round(outcome.time, 6))
        assert summary.smallest_distance == pytest.approx(radius, abs=0.1 * radius)
        assert summary.vehicles[1].smallest_distance == summary.smallest_distance
        assert {v.stage for v in summary.vehicles} == {"ended"}
        assert all(18.0 < v.telemetry_rate_hz < 22.0 and v.setpoint_rate_hz > 15.0 for v in summary.vehicles)


@virtual
async def test_with_three_in_ten_messages_lost_everywhere_it_still_plays_to_the_end(tmp_path: Path) -> None:
    rough = ImpairmentSpec(loss=0.3, delay_s=0.02, jitter_s=0.03, bus=True)
    sensor = SensorSpec(rate_hz=10.0, sigma=0.1, sigma_velocity=0.05, delay_s=0.05, dropout=0.1)
    async with game_of(duel(mates=1, impairment=rough, sensor=sensor), folder=tmp_path) as game:
        heard = HeardOfGame(game)
        outcome = await game.until_ended()
        await game.forward(3.0)
        assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, PURSUER)
        for id in game.scenario.ids:
            assert phases(game, id)[-3:] == STORY[-3:], "what is cached arrives, be it late"
            counts = game.links[id].counters()
            for way in ("in", "out"):
                lost, sent = counts[f"{way}_lost"], counts["received" if way == "in" else "sent"]
                share = lost / (lost + sent) if way == "out" else lost / sent
                few = 4.0 * sqrt(0.3 * 0.7 / (sent if way == "in" else lost + sent))  # four sigmas of a draw
                assert share == pytest.approx(0.3, abs=few), way
        assert {mode(game, id) for id in game.scenario.ids} == {"LOITER"}
        assert len({TOPICS.find(sample.key).id for sample in heard.samples}) > 3
    log = [entry.packet for entry in read_tlog((tmp_path / "vehicle-2.tlog").read_bytes())]
    assert {packet.component for packet in log} == {1, 191}
    assert sum(packet.name == "GLOBAL_POSITION_INT" for packet in log) > 80


def parties(game: WholeGame, id: int, key: str) -> set[Party]:
    """As whom the agent of a vehicle may read a key: what an access rule of a secured bus grants."""
    found = {Party.ANY_AGENT}
    named = TOPICS.find(key).id
    if id == EVADER:
        found.add(Party.EVADER)
    if named == id:
        found.add(Party.OWN_AGENT)
    if named in game.scenario.ids and (named == EVADER) == (id == EVADER):
        found.add(Party.SAME_SIDE)
    return found


@virtual
async def test_no_agent_is_ever_handed_what_it_must_not_know_and_a_late_comer_learns_the_outcome() -> None:
    """Not what it asks for counts here, but what its connection delivers, from the start to the end."""
    async with game_of(duel(mates=1, horizon=2.0), agents=False) as game:
        delivered: dict[int, set[str]] = {id: set() for id in game.scenario.ids}
        for id in game.scenario.ids:
            bus = game.start_agent(id).bus
            bus.tap = lambda sample, keys=delivered[id]: keys.add(sample.key)
        outcome = await game.until_ended()
        brief = EVADER_BRIEF.key(game.game)
        assert brief in delivered[EVADER]
        for id, keys in delivered.items():
            for key in keys:
                assert parties(game, id, key) & {*TOPICS.find(key).topic.readers}, (id, key)
            others = {TOPICS.find(k).id for k in keys if "/vehicles/" in k and TOPICS.find(k).id != id}
            assert others == ({MATE if id == PURSUER else PURSUER} if id != EVADER else set())
            assert {TOPICS.find(k).topic.suffix for k in keys if "/vehicles/" in k} <= {  # type: ignore[union-attr]
                "vehicles/{id}/state", "vehicles/{id}/health",
            }  # fmt: skip
            if id != EVADER:
                assert brief not in keys
        assert place(game, EVADER).x > 4.0
        heard: list[bytes] = []  # by somebody who comes when it is over
        late = game.broker.connect("late")
        late.subscribe(OUTCOME.key(game.game), lambda sample: heard.append(sample.payload))
        await game.forward(1.0, until=lambda: bool(heard))
        assert OUTCOME.decode(heard[0], game.observer.drops) == outcome
        assert (outcome.verdict, outcome.time) == (OutcomeResult.DENIED, 2.0)
