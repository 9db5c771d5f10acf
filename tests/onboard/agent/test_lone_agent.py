"""One agent beside an autopilot that reports what it is told to: what it answers, sends and lets be."""

from __future__ import annotations

from itertools import count

import pytest

from onboard.agent.core.events import LinkBytes
from onboard.agent.core.to_place import own_state
from onboard.autopilot.base import Stage
from onboard.core.math.vectors import ZERO, Vec
from onboard.pilot.setup import Own
from onboard.wire.bus.messages import Command, CommandKind, CommandState, Phase, Quote
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.modes import MODES, Kind
from tests.support.lone_agent import FakeMaster, LoneAgent, playing

ON_GROUND, UNKNOWN, SET_MODE, TAKE_OFF = 1, 0, 176, 22
CRITICAL = 5
NUMBERS = count()


def found(kind: Kind = Kind.ARDUCOPTER, mode: str = "", **config: object) -> LoneAgent:
    """An agent that has found its vehicle, and knows it."""
    agent = LoneAgent(kind, **config)  # type: ignore[arg-type]
    if mode:
        agent.autopilot.mode = MODES[kind][mode]
    agent.run(2.0)
    return agent


def told(agent: LoneAgent, kind: CommandKind, shown: str = "") -> str:
    """Why a person's order is refused; "" where it is not."""
    nonce, said = agent.core.bus.masters.last or (0, 0)
    quote = Quote(nonce, said, agent.core.facts.nonce, agent.core.orders.stopped_by)
    reply = agent.order(Command(f"c-{next(NUMBERS)}", kind, "anna", 0, shown, quote))
    return reply.reason if reply.state is CommandState.REFUSED else ""


# ---------------------------------------------------------------------- hands


@pytest.mark.parametrize(("landed", "words"), [(ON_GROUND, "stands on the ground"), (UNKNOWN, "is not armed"),
                                              (2, "is not armed")])  # fmt: skip
def test_a_disarmed_vehicle_is_said_to_stand_on_the_ground_only_where_it_says_so(
    landed: int, words: str
) -> None:
    agent = LoneAgent()
    agent.autopilot.armed, agent.autopilot.landed = False, landed
    agent.run(2.0)
    assert told(agent, CommandKind.START).startswith(f"it {words}, disarmed")


@pytest.mark.parametrize("status", [CRITICAL, CRITICAL + 1])
def test_out_of_a_failsafe_that_it_only_reports_a_vehicle_is_taken_by_its_mode(status: int) -> None:
    """It flies on in its mode, as ArduPilot does with a warning, and nobody has taken it from the agent."""
    agent = found(take_control=False)
    assert told(agent, CommandKind.RESUME) == ""
    agent = found(take_control=False)
    agent.autopilot.status = status
    agent.run(0.5)
    assert "LOITER, by a failsafe" in told(agent, CommandKind.RESUME)
    assert "shown in GUIDED" in told(agent, CommandKind.RESUME, "GUIDED")
    assert told(agent, CommandKind.RESUME, "LOITER") == ""


def test_a_take_over_is_told_once_and_its_verdict_stays() -> None:
    agent = playing()
    agent.autopilot.mode = MODES[Kind.ARDUCOPTER]["STABILIZE"]
    agent.run(3.0)
    assert agent.core.vehicle.stage is Stage.TAKEN
    assert agent.core.journal.kinds["supervisor_end"] == 1
    assert "hands off" in agent.core.flight.latched


def test_a_restart_that_looked_like_a_take_over_is_none_and_the_game_is_flown_on() -> None:
    """After the silence its heartbeats come first, in its initial mode; its new clock follows."""
    agent = playing()
    vehicle = agent.autopilot
    vehicle.talks = False
    agent.run(3.0)
    vehicle.talks, vehicle.booted = True, agent.s
    vehicle.mode = MODES[Kind.ARDUCOPTER]["STABILIZE"]
    says = vehicle.says
    vehicle.says = lambda now: says(now)[:1]  # type: ignore[method-assign]
    agent.run(0.5)
    assert agent.core.vehicle.stage is Stage.TAKEN
    vehicle.says = says  # type: ignore[method-assign]
    agent.run(2.0)
    assert agent.core.vehicle.stage is Stage.ACTIVE
    assert agent.core.flight.latched == ""
    assert agent.rate(1.0) > 15.0


# ---------------------------------------------------------------------- the own vehicle


@pytest.mark.parametrize(("severity", "said"), [(3, True), (4, True), (5, False), (6, False)])
def test_what_the_autopilot_warns_of_is_told_and_its_small_talk_is_not(severity: int, said: bool) -> None:
    agent = found()
    text = dialect.MAVLink_statustext_message(severity, b"EKF variance")
    agent.do(LinkBytes(0, 1, bytes(text.pack(agent.autopilot._mav))))
    assert agent.core.journal.kinds.get("autopilot", 0) == 1 + said  # one: that it was found


def test_a_limit_that_changes_in_a_running_game_is_kept_and_the_game_flown_on() -> None:
    agent = playing()
    assert agent.core.part.policy.envelope.climb_max > 2.0
    agent.autopilot.set_parameter("WP_SPD_UP", 2.0)
    agent.run(2.0)
    assert agent.core.part.policy.envelope.climb_max == pytest.approx(2.0)
    assert "late" not in agent.core.journal.kinds
    assert agent.rate(1.0) > 15.0


# ---------------------------------------------------------------------- to its place


def waiting(far: bool = True, kind: Kind = Kind.ARDUCOPTER, **config: object) -> LoneAgent:
    """An agent in a game that stages, 100 m from its place at the origin or at it."""
    agent = LoneAgent(kind, **config)  # type: ignore[arg-type]
    if far:
        agent.autopilot.place = agent.autopilot.place._replace(x=100.0)
    agent.run(2.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(2.0)
    assert agent.health is not None
    return agent


def test_time_to_its_place_is_asked_for_only_by_a_vehicle_that_its_agent_flies() -> None:
    """100 m at 15 m/s, time to stop from there and three seconds to come to rest."""
    needs = waiting(take_control=True).health
    alone = waiting(take_control=False).health
    there = waiting(far=False, take_control=True).health
    assert needs is not None
    assert alone is not None
    assert there is not None
    assert 100.0 / 15.0 + 3.0 < needs.place_s < 100.0 / 15.0 + 3.0 + 15.0
    assert alone.place_s == 0.0
    assert there.place_s == 0.0


def test_a_planes_time_to_its_place_is_that_of_its_way_through_the_wind() -> None:
    agent = waiting(kind=Kind.ARDUPLANE, take_control=True)
    agent.autopilot.wind = Vec(0.0, 12.0, 0.0)
    agent.run(0.5)
    assert agent.core.game is not None
    assert agent.core.game.flying is not None
    approach, t = agent.core.game.flying.approach, agent.core.vehicle.telemetry
    assert approach is not None
    assert t.wind == pytest.approx((0.0, 12.0, 0.0), abs=0.01)
    place_s = agent.core.part.place_s(agent.now)
    position = own_state(agent.s, t, hovers=False).position
    assert place_s == pytest.approx(approach.needs(Own(position, t.velocity, t.wind)))
    assert place_s != pytest.approx(approach.needs(Own(position, t.velocity, ZERO)), abs=0.1)


def test_an_agent_that_a_person_gave_control_asks_for_its_time_too() -> None:
    agent = waiting(take_control=False)
    assert told(agent, CommandKind.START) == ""
    agent.run(2.0)
    assert agent.core.vehicle.stage is Stage.ACTIVE
    assert agent.health is not None
    assert agent.health.place_s > 9.0


def test_before_the_start_is_fixed_the_game_has_no_time() -> None:
    agent = waiting()
    assert agent.core.part.time(agent.wall_ns) == 0.0
    agent.master.phase(Phase.READY, 5.0)
    agent.run(1.0)
    assert agent.core.part.time(agent.wall_ns) == pytest.approx(-4.0, abs=0.06)


# ---------------------------------------------------------------------- a ground start


def standing(kind: Kind, mode: str) -> LoneAgent:
    """A vehicle that stands armed on the ground, and a game that stages."""
    agent = LoneAgent(kind, may_arm=True, take_off_height=40.0)
    vehicle = agent.autopilot
    vehicle.mode, vehicle.landed, vehicle.speed = MODES[kind][mode], ON_GROUND, 0.0
    vehicle.place = vehicle.place._replace(z=0.0)
    agent.run(2.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    return agent


def asked(agent: LoneAgent, number: int, since: float) -> int:
    return sum(1 for at, command, _ in agent.autopilot.orders if command == number and at > since)


def test_a_plane_is_asked_for_take_off_mode_until_it_is_in_it_and_no_longer() -> None:
    agent = standing(Kind.ARDUPLANE, "MANUAL")
    agent.run(4.0)
    assert agent.autopilot.mode_name == "TAKEOFF"
    assert asked(agent, SET_MODE, 0.0) == 1
    agent.run(6.0)
    assert asked(agent, SET_MODE, 0.0) == 1
    assert agent.autopilot.setpoints == []
    assert agent.health is not None
    assert "its height of 40 m" in agent.health.lacks


def test_a_climb_is_over_at_nine_tenths_of_its_height() -> None:
    agent = standing(Kind.ARDUCOPTER, "LOITER")
    agent.run(6.0)
    assert agent.autopilot.mode_name == "GUIDED"
    assert asked(agent, TAKE_OFF, 0.0) >= 1
    agent.autopilot.landed = 2
    agent.autopilot.place = agent.autopilot.place._replace(z=-35.5)
    agent.run(2.0)
    assert agent.core.flight.take_off.climbing
    assert agent.autopilot.setpoints == []
    agent.autopilot.place = agent.autopilot.place._replace(z=-36.1)
    agent.run(2.0)
    assert not agent.core.flight.take_off.climbing


# ---------------------------------------------------------------------- masters beside the master


def test_of_eight_masters_that_wait_each_ones_game_counts_once_it_leads() -> None:
    """Each has told its setup before its lease; the ninth makes the first forgotten."""
    for many, known in ((8, True), (9, False)):
        agent = LoneAgent()
        agent.master.on = False
        others = [FakeMaster(f"m-{n}", nonce=n + 1) for n in range(many)]
        for master in others:
            master.setup(master.name)
            ((topic, setup), _) = master._due
            agent.hear(setup, topic)
        agent.master = others[0]
        agent.master._due.clear()
        agent.run(1.0)
        assert (agent.core.bus.setup is not None) is known
