"""The master of a game of several evaders: each is judged, leaves and is briefed by itself."""

from __future__ import annotations

from typing import Any

import pytest
from msgspec.structs import replace

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.game.master import GameMaster, Timing
from onboard.wire.bus.messages import (
    AgentStage,
    EvaderBrief,
    Member,
    OutcomeResult,
    OwnBrief,
    Phase,
    Role,
    RulesMessage,
)
from onboard.wire.bus.topics import OWN_BRIEF
from tests.onboard.game.test_master import Range, health, setup

GOALS = {1: (Vec(-300, 0, -50),), 4: (Vec(0, 500, -50), Vec(300, 400, -50))}
ROSTER = (
    Member(1, Role.EVADER, 4.0, (0.0, 0.0, -50.0)),
    Member(2, Role.PURSUER, 5.0, (100.0, 0.0, -50.0)),
    Member(3, Role.PURSUER, 5.0, (0.0, 200.0, -50.0)),
    Member(4, Role.EVADER, 4.0, (0.0, 400.0, -50.0)),
)


class Several(Range):
    """Evaders 1 and 4 against pursuers 2 and 3."""

    def __init__(self, takes_over: str = "", **changes: Any) -> None:
        super().__init__()
        timing = Timing(ready_s=2.0, timeout_s=20.0)
        self.master = GameMaster(setup(roster=ROSTER, **changes), GOALS, "bridge", 50, timing, takes_over)
        self.places[4] = Vec(0, 400, -50)
        self.speeds[4] = Vec(0, 0, 0)

    def crew(self) -> None:
        self.agents = {one.id: replace(health(one.id), role=one.role) for one in ROSTER}

    def act(self) -> None:
        """Until just after t₀, everybody acting."""
        self.begin()
        self.agents = {id: replace(one, stage=AgentStage.ACTING) for id, one in self.agents.items()}


def test_each_evader_gets_its_own_targets_on_its_own_key_and_no_common_brief_is_given() -> None:
    field = Several()
    field.begin()
    briefs = [(id, m) for topic, m, id in field.said if topic is OWN_BRIEF]
    assert [(id, m.id, m.targets) for id, m in briefs if isinstance(m, OwnBrief)] == [
        (1, 1, ((-300.0, 0.0, -50.0),)),
        (4, 4, ((0.0, 500.0, -50.0), (300.0, 400.0, -50.0))),
    ]
    assert not [m for _, m, _ in field.said if isinstance(m, EvaderBrief)]


def test_one_evader_with_two_targets_has_the_common_brief_with_both() -> None:
    field = Range()
    field.master = GameMaster(setup(), {1: GOALS[4]}, "bridge", 50, Timing(ready_s=2.0, timeout_s=20.0))
    field.begin()
    (brief,) = [m for _, m, _ in field.said if isinstance(m, EvaderBrief)]
    assert brief.target == (0.0, 500.0, -50.0)
    assert brief.targets == ((0.0, 500.0, -50.0), (300.0, 400.0, -50.0))


def test_a_captured_evader_leaves_and_the_game_goes_on_until_the_last_one() -> None:
    field = Several()
    field.act()
    field.places[2] = Vec(20, 0, -50)
    field.speeds[2] = Vec(-10, 0, 0)
    field.fly(3.0)
    assert field.master.phase is Phase.RUNNING
    told = field.phases()[-1]
    assert [(end.id, end.verdict, end.captor) for end in told.out] == [(1, OutcomeResult.CAPTURED, 2)]
    assert told.out[0].smallest_distance == pytest.approx(5.0, abs=0.11)  # R, by a step of 10 m/s at most
    assert "evader 1 captured by 2" in told.reason
    field.speeds[2] = Vec(0, 0, 0)
    field.places[3] = Vec(0, 380, -50)
    field.speeds[3] = Vec(0, 10, 0)
    field.fly(3.0)
    outcome = field.outcome()
    assert (outcome.verdict, outcome.captor) == (OutcomeResult.CAPTURED, 3)
    assert [(end.id, end.captor) for end in outcome.evaders] == [(1, 2), (4, 3)]
    assert outcome.time == outcome.evaders[1].time > outcome.evaders[0].time
    assert field.master.phase is Phase.ENDED


def test_one_that_arrives_decides_the_whole_game_and_both_of_its_targets_count() -> None:
    field = Several()
    field.act()
    field.places[2] = Vec(3, 0, -50)  # evader 1 is captured
    field.places[4] = Vec(295, 400, -50)
    field.speeds[4] = Vec(4, 0, 0)  # to the second of its targets
    field.fly(3.0)
    outcome = field.outcome()
    assert (outcome.verdict, outcome.captor) == (OutcomeResult.ARRIVED, 0)
    assert [end.verdict for end in outcome.evaders] == [OutcomeResult.CAPTURED, OutcomeResult.ARRIVED]


def test_at_the_horizon_the_others_have_escaped() -> None:
    field = Several(rules=RulesMessage(5.0, 10.0, horizon=6.0))
    field.places[2] = Vec(1000, 0, -50)
    field.act()
    field.places[3] = Vec(0, 397, -50)
    field.fly(8.0)
    outcome = field.outcome()
    assert outcome.verdict is OutcomeResult.ESCAPED
    assert [end.verdict for end in outcome.evaders] == [OutcomeResult.ESCAPED, OutcomeResult.CAPTURED]
    assert outcome.time == pytest.approx(6.0)


def test_an_evader_that_nobody_sees_leaves_without_a_verdict_and_the_other_plays_on() -> None:
    field = Several()
    field.act()
    del field.places[4], field.speeds[4]
    field.fly(11.0)
    assert field.master.phase is Phase.RUNNING
    (end,) = field.phases()[-1].out
    assert (end.id, end.verdict) == (4, OutcomeResult.ABORTED)
    field.places[2] = Vec(3, 0, -50)
    field.fly(1.0)
    outcome = field.outcome()
    assert outcome.verdict is OutcomeResult.ABORTED
    assert outcome.reason == "nobody has seen vehicle 4 for 10 s"
    assert [end.verdict for end in outcome.evaders] == [OutcomeResult.CAPTURED, OutcomeResult.ABORTED]


def test_an_abort_keeps_the_verdicts_there_are() -> None:
    field = Several()
    field.act()
    field.places[2] = Vec(3, 0, -50)
    field.fly(1.0)
    field.master.abort(field.now, field.now, "rain")
    field.fly(0.1)
    outcome = field.outcome()
    assert (outcome.verdict, outcome.reason) == (OutcomeResult.ABORTED, "rain")
    assert [end.verdict for end in outcome.evaders] == [OutcomeResult.CAPTURED, OutcomeResult.ABORTED]


def test_who_takes_a_game_over_lets_nobody_play_again_who_was_out() -> None:
    field = Several()
    field.act()
    field.places[2] = Vec(3, 0, -50)
    field.fly(1.0)
    told = field.phases()[-1]
    assert told.out
    other = Several(takes_over="bridge")
    other.master.heard_phase(replace(told, master="somebody else"))
    assert not other.master._trials.is_out(1)
    other.master.heard_phase(told)
    other.crew()
    del other.agents[1]  # whose vehicle has landed
    other.fly(5.0)
    assert other.master.phase is Phase.RUNNING
    assert [end.id for end in other.phases()[-1].out] == [1]
    other.places[3] = Vec(0, 397, -50)
    other.fly(1.0)
    assert other.outcome().verdict is OutcomeResult.CAPTURED


def test_an_agent_of_an_evader_that_is_out_may_be_started_again_without_a_word() -> None:
    field = Several()
    field.act()
    field.places[2] = Vec(3, 0, -50)
    field.fly(1.0)
    before = len(field.phases())
    field.agents[1] = replace(field.agents[1], nonce=999, stage=AgentStage.WAITING)
    field.fly(4.0)
    assert [phase.resume for phase in field.phases()[before:]] == []
    assert field.now > 5 * NS_PER_S
