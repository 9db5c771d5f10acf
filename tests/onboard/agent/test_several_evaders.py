"""One agent in a game of several evaders: whose brief it takes, whom it keeps off."""

from __future__ import annotations

from collections import Counter

import msgspec
import pytest

from onboard.agent.core.events import BusMessage, Subscribe, Unsubscribe
from onboard.core.math.vectors import Vec
from onboard.wire.bus import topics
from onboard.wire.bus.codec import Codec
from onboard.wire.bus.evader_messages import EvaderOutcome, OutcomeResult, OwnBrief
from onboard.wire.bus.messages import (
    SCHEMA,
    AgentStage,
    EvaderBrief,
    Member,
    Message,
    Outcome,
    Phase,
    PhaseChange,
    Role,
    RulesMessage,
    Track,
)
from onboard.wire.bus.team_messages import TeamPlan
from tests.support.lone_agent import EVADER, GAME, VEHICLE, FakeMaster, LoneAgent, playing

OTHER = 9  # a further evader
PURSUERS = (
    Member(EVADER, Role.EVADER, 10.0, (200.0, 0.0, -50.0)),
    Member(VEHICLE, Role.PURSUER, 15.0, (0.0, 0.0, -50.0)),
    Member(OTHER, Role.EVADER, 10.0, (0.0, 300.0, -50.0)),
)
BRIEF = topics.OWN_BRIEF.key(GAME, VEHICLE)


def chasing() -> LoneAgent:
    """Pursuer 2 after evaders 1 and 9 for two seconds; 9 is tracked beside it, where it stands."""
    agent = playing()
    rules = RulesMessage(2.0, 4.0, separation=8.0, horizon=100.0)
    agent.master.setup("several", roster=PURSUERS, rules=rules)
    for phase in (Phase.STAGING, Phase.READY, Phase.RUNNING):
        agent.master.phase(phase, 1.0 if phase is Phase.READY else 0.0)
        look(agent, 2.0)
    return agent


def look(agent: LoneAgent, seconds: float) -> None:
    """Let time pass while evader 9's track says that it stands 7 m north of the vehicle."""
    for _ in range(round(seconds / 0.1)):
        place = agent.autopilot.place
        at = (place.x + 7.0, place.y, place.z)
        agent.hear(Track(OTHER, agent.wall_ns, at, (0.0, 0.0, 0.0), (0.01,) * 6), topics.TRACK)
        agent.run(0.1)


def out(agent: LoneAgent, id: int, phase: Phase = Phase.RUNNING) -> None:
    """The master tells a phase in which an evader is out: it was captured."""
    change = agent.master.change(phase, agent.wall_ns - 10**9, agent.wall_ns)
    end = EvaderOutcome(id, OutcomeResult.CAPTURED, 4.0, VEHICLE, 2.0)
    agent.hear(msgspec.structs.replace(change, out=(end,)), topics.PHASE)


def test_an_evader_that_is_out_is_an_obstacle_and_one_in_the_game_is_not() -> None:
    agent = chasing()
    assert agent.core.stage is AgentStage.ACTING
    assert agent.core.flight.output is not None
    assert agent.core.flight.output.ground.x > 3.0  # towards it, and the quarry behind it
    out(agent, OTHER)
    look(agent, 0.5)
    decision = agent.core.flight.decision
    assert decision is not None
    assert decision.quarry == EVADER
    assert agent.core.flight.output.ground.x < -3.0  # away from it, though the quarry is that way


def test_a_track_that_has_ended_is_an_obstacle_no_more() -> None:
    agent = chasing()
    out(agent, OTHER)
    look(agent, 0.5)
    agent.run(agent.core.part.policy.mate_forget + 4.0)  # it turns only so fast
    assert agent.core.flight.output is not None
    assert agent.core.flight.output.ground.x > 3.0


ROSTER = (
    Member(VEHICLE, Role.EVADER, 10.0, (0.0, 0.0, -50.0)),
    Member(EVADER, Role.PURSUER, 8.0, (200.0, 0.0, -50.0)),
    Member(OTHER, Role.EVADER, 10.0, (0.0, 300.0, -50.0)),
)


def fleeing() -> LoneAgent:
    """Vehicle 2 as one of two evaders."""
    agent = LoneAgent(role=Role.EVADER)
    agent.run(1.0)
    agent.master.setup("several", roster=ROSTER)
    return agent


def brief(agent: LoneAgent, message: OwnBrief) -> None:
    """A brief comes on the vehicle's own key."""
    agent.do(BusMessage(BRIEF, topics.OWN_BRIEF.encode(message)))


def test_of_several_evaders_one_takes_its_own_brief_and_no_other() -> None:
    agent = fleeing()
    asked = [effect.key for _ in range(60) for effect in agent.step() if isinstance(effect, Subscribe)]
    assert [key for key in asked if key.endswith("/brief")] == [BRIEF]
    agent.hear(EvaderBrief((1.0, 2.0, -3.0), agent.wall_ns), topics.EVADER_BRIEF)  # of another game's evader
    assert agent.core.bus.targets == ()
    assert not agent.core.bus.briefed
    agent.run(1.0)
    assert "the evader's brief" in agent.core.lacks
    places = ((5.0, 6.0, -7.0), (8.0, 9.0, -7.0))
    brief(agent, OwnBrief(OTHER, agent.wall_ns, places))
    assert not agent.core.bus.briefed
    brief(agent, OwnBrief(VEHICLE, agent.wall_ns, places))
    assert agent.core.bus.targets == (Vec(*places[0]), Vec(*places[1]))
    agent.run(1.0)
    assert "the evader's brief" not in agent.core.lacks


def test_in_the_next_game_of_one_evader_the_common_brief_counts_again() -> None:
    agent = fleeing()
    agent.run(3.0)
    brief(agent, OwnBrief(VEHICLE, agent.wall_ns, ((5.0, 6.0, -7.0),)))
    roster = (
        Member(VEHICLE, Role.EVADER, 10.0, (0.0, 0.0, -50.0)),
        Member(EVADER, Role.PURSUER, 8.0, (200.0, 0.0, -50.0)),
    )
    agent.master.setup("one", roster=roster)
    left = [effect.key for _ in range(40) for effect in agent.step() if isinstance(effect, Unsubscribe)]
    assert BRIEF in left
    assert agent.core.bus.targets == ()
    agent.hear(EvaderBrief((1.0, 2.0, -3.0), agent.wall_ns), topics.EVADER_BRIEF)
    assert agent.core.bus.targets == (Vec(1.0, 2.0, -3.0),)


def test_who_is_out_stays_out_under_a_master_that_takes_the_game_over() -> None:
    agent = fleeing()
    agent.run(3.0)
    brief(agent, OwnBrief(VEHICLE, agent.wall_ns, ((5.0, 6.0, -7.0),)))
    for phase in (Phase.STAGING, Phase.READY, Phase.RUNNING):
        agent.master.phase(phase, 1.0 if phase is Phase.READY else 0.0)
        agent.run(2.0)
    assert agent.rate(0.5) > 15.0
    out(agent, VEHICLE)
    agent.run(1.0)
    assert agent.core.stage is AgentStage.ENDED
    assert agent.rate(0.5) == 0.0
    other = FakeMaster("laptop-B", 6)
    other.takes_over = "laptop-A"
    agent.master = other
    agent.run(4.0)
    other.setup("several", roster=ROSTER)
    agent.run(1.0)
    assert agent.core.bus.masters.name == "laptop-B"
    for phase in (Phase.STAGING, Phase.READY, Phase.RUNNING):
        out(agent, VEHICLE, phase)
        agent.run(2.0)
        assert agent.core.stage is AgentStage.ENDED
        assert agent.rate(1.5) == 0.0


GROWN: tuple[tuple[Message, int], ...] = (
    (PhaseChange(Phase.RUNNING, 1, 2, (3,), "r", "m", 4, 5), 1),
    (Outcome(OutcomeResult.CAPTURED, 3.0, 2, 1.0, 5, "r"), 1),
    (EvaderBrief((1.0, 2.0, 3.0), 4), 1),
    (TeamPlan(2, 1, 0.5, (), False, 1.0, 0.0, 0.0, 2, 3.0, 9), 2),
)


@pytest.mark.parametrize(("message", "new"), GROWN, ids=lambda value: type(value).__name__)
def test_messages_recorded_before_there_were_several_evaders_are_read(message: Message, new: int) -> None:
    fields = msgspec.msgpack.decode(msgspec.msgpack.encode(message))
    names = ("out", "evaders", "targets", "quarries")
    last = next(i for i, name in enumerate(message.__struct_fields__) if name in names)
    assert len(fields) >= last + new
    old = msgspec.msgpack.encode([SCHEMA, fields[:last]])
    drops: Counter[str] = Counter()
    assert Codec(type(message)).decode(old, drops) == message
    assert not drops
