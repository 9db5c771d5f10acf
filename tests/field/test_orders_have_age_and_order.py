"""Two stations, late, lost and repeated orders, against the specification in docs/commands.md."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from onboard.agent.core.command_book import SETS_OFF
from onboard.wire.bus.messages import AgentStage, Command, CommandKind, CommandState, Phase, Quote
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.modes import MODES, Kind
from tests.support.lone_agent import LoneAgent, playing


def heard_now(agent: LoneAgent) -> Quote:
    """What a station quotes that has heard everything up to now."""
    health = agent.health
    assert health is not None
    return Quote(agent.master.nonce, agent.master.number, health.nonce, health.stopped_by)


def order(agent: LoneAgent, kind: CommandKind, id: str, sender: str = "A") -> Command:
    """An order given now."""
    shown = agent.autopilot.mode_name
    return Command(id, kind, sender, 0, mode=shown, quote=heard_now(agent))


def test_a_resume_from_before_an_abort_does_not_undo_it() -> None:
    agent = playing()
    early = order(agent, CommandKind.RESUME, "a1", "laptop-A")  # its first tries are lost
    assert agent.order(order(agent, CommandKind.ABORT, "b1", "laptop-B")).state is CommandState.PENDING
    agent.run(1.5)
    assert agent.autopilot.mode_name in ("LOITER", "BRAKE")
    reply = agent.order(early)
    assert reply.state is CommandState.REFUSED
    assert "b1" in reply.reason
    agent.run(2.0)
    assert agent.rate(1.0) == 0.0
    assert agent.order(order(agent, CommandKind.RESUME, "a2")).state is CommandState.PENDING
    agent.run(1.0)
    assert agent.rate(0.5) > 15.0


def test_a_start_of_long_ago_or_for_another_process_is_refused() -> None:
    agent = playing(take_control=True)
    old = order(agent, CommandKind.START, "old")
    agent.run(5.2)
    assert "too old" in agent.order(old).reason
    assert "too old" in agent.order(Command("none", CommandKind.START, "x", 0, quote=Quote(0, 0, 77))).reason
    again = playing(nonce=78)  # the agent was started again
    reply = again.order(order(agent, CommandKind.START, "other"))
    assert reply.state is CommandState.REFUSED
    assert "another process" in reply.reason


def test_without_a_master_an_order_quotes_the_agents_own_word() -> None:
    agent = playing()
    agent.master.on = False
    agent.run(6.0)
    assert agent.order(order(agent, CommandKind.RESUME, "m")).state is CommandState.REFUSED
    health = agent.health
    assert health is not None
    quote = Quote(health.nonce, health.number, health.nonce, health.stopped_by)
    reply = agent.order(Command("o", CommandKind.RESUME, "A", 0, quote=quote))
    assert reply.state is not CommandState.REFUSED, reply.reason


def test_ids_do_not_become_new_again() -> None:
    agent = playing()
    for n in range(70):
        agent.order(Command(f"k{n}", CommandKind.HOLD, "x", n))
    agent.run(1.0)
    reply = agent.order(order(agent, CommandKind.RESUME, "go"))
    assert reply.state is not CommandState.REFUSED, reply.reason
    agent.run(1.5)
    assert agent.rate(0.5) > 15.0
    assert agent.order(Command("k0", CommandKind.HOLD, "x", 0)).state is CommandState.SUPERSEDED
    agent.run(1.0)
    assert agent.rate(0.5) > 15.0
    agent.order(Command("k0", CommandKind.ABORT, "another", 0))  # nobody's abort hides behind an id
    agent.run(1.0)
    assert agent.rate(0.5) == 0.0


def test_an_abort_of_any_age_is_obeyed_in_flight() -> None:
    agent = playing()
    old = order(agent, CommandKind.ABORT, "late")
    agent.run(30.0)
    agent.order(old)
    agent.run(1.0)
    assert agent.rate(0.5) == 0.0


def test_an_abort_from_before_the_agent_had_control_blocks_the_start_and_moves_nothing() -> None:
    agent = LoneAgent()
    before = agent.autopilot.mode_name
    agent.autopilot.mode = 3  # AUTO, a pilot's mission
    agent.run(1.0)
    reply = agent.order(Command("h", CommandKind.ABORT, "history", 0))
    assert (reply.state, agent.autopilot.mode_name) == (CommandState.CONFIRMED, "AUTO")
    agent.master.setup()
    agent.master.phase(Phase.READY, 2.0)
    agent.run(2.0)
    agent.master.phase(Phase.RUNNING)
    agent.run(2.0)
    assert agent.autopilot.setpoints == []
    assert agent.autopilot.mode_name == "AUTO" != before
    assert agent.health is not None
    assert any("history" in lack for lack in agent.health.lacks)
    assert agent.health.stage is not AgentStage.ACTING
    agent.order(order(agent, CommandKind.RESUME, "clear"))
    agent.run(1.5)
    assert agent.rate(0.5) > 15.0


@pytest.mark.parametrize("kind", [Kind.ARDUCOPTER, Kind.ARDUPLANE, Kind.PX4_MULTICOPTER])
@pytest.mark.parametrize("what", [CommandKind.START, CommandKind.RESUME])
@pytest.mark.parametrize("take_control", [False, True])
def test_what_set_off_and_expired_never_acts_afterwards(
    kind: Kind, what: CommandKind, take_control: bool
) -> None:
    """The autopilot answers nobody for a while; the game is staged long after the order has expired."""
    agent = LoneAgent(kind, take_control=take_control)
    agent.run(2.0)
    held = Command("h", CommandKind.HOLD, "A", 0, quote=heard_now(agent))
    agent.order(held)
    agent.autopilot.obeys = False
    agent.run(1.0)
    given = order(agent, what, "late")
    reply = agent.order(given)
    assert reply.state is CommandState.PENDING
    assert "is not reported" in reply.reason
    agent.run(5.2)
    reply = agent.order(given)
    assert reply.state is CommandState.EXPIRED
    assert "is not reported" in reply.reason
    asked = agent.autopilot.asked_modes
    asked.clear()
    agent.autopilot.obeys = True
    agent.run(13.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(2.0)
    agent.master.phase(Phase.READY, 2.0)
    agent.run(2.0)
    agent.master.phase(Phase.RUNNING)
    agent.run(3.0)
    assert agent.autopilot.setpoints == []
    assert not {"GUIDED", "OFFBOARD"} & set(asked)
    assert agent.order(given).state is CommandState.EXPIRED
    assert agent.order(order(agent, CommandKind.RESUME, "anew")).state is not CommandState.REFUSED
    agent.run(2.0)
    assert agent.rate(0.5) > 3.0


def test_an_expired_start_takes_nothing_off_and_arms_nothing() -> None:
    """A ground start that the autopilot refused to arm for: nothing of it is left when it would arm."""
    agent = LoneAgent(Kind.ARDUPLANE, take_control=False, may_arm=True)
    agent.autopilot.armed, agent.autopilot.landed, agent.autopilot.obeys = False, 1, False
    agent.run(2.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(1.0)
    assert agent.order(order(agent, CommandKind.START, "s")).state is CommandState.PENDING
    agent.run(6.0)
    agent.autopilot.obeys = True
    agent.autopilot.asked_modes.clear()
    agent.autopilot.orders.clear()
    agent.run(1.0)
    agent.master.phase(Phase.READY, 5.0)
    agent.run(4.0)
    assert agent.autopilot.asked_modes == []
    goes_up = (dialect.MAV_CMD_COMPONENT_ARM_DISARM, dialect.MAV_CMD_NAV_TAKEOFF)
    assert [number for _, number, _ in agent.autopilot.orders if number in goes_up] == []


def test_a_pilot_who_was_asked_in_vain_keeps_his_vehicle() -> None:
    """Taken over, then resumed without an answer: the configuration alone takes nothing back either."""
    agent = playing(take_control=True)
    agent.autopilot.mode = MODES[Kind.ARDUCOPTER]["LOITER"]
    agent.run(2.0)
    agent.autopilot.obeys = False
    given = order(agent, CommandKind.RESUME, "r")
    assert agent.order(given).state is CommandState.PENDING
    agent.run(5.5)
    assert agent.order(given).state is CommandState.EXPIRED
    agent.autopilot.obeys = True
    agent.autopilot.asked_modes.clear()
    agent.run(5.0)
    assert agent.autopilot.asked_modes == []
    assert agent.autopilot.mode_name == "LOITER"


class TwoStations(RuleBasedStateMachine):
    """Orders of two stations on a network that loses, repeats and delays; the model is the specification."""

    @initialize()
    def begin(self) -> None:
        """An agent in flight."""
        self.agent = playing()
        self.sent: list[tuple[Command, float]] = []  # with when it was given
        self.seen: set[tuple[str, str, CommandKind]] = set()
        self.stopped_by, self.stopped = "", False

    @rule(who=st.sampled_from("AB"), kind=st.sampled_from(list(CommandKind)))
    def give(self, who: str, kind: CommandKind) -> None:
        """A station gives an order: it is on its way."""
        self.agent.run(0.6)  # what it quotes it has heard
        self.sent.append((order(self.agent, kind, f"{who}{len(self.sent)}", who), self.agent.s))

    @rule(data=st.data())
    def arrive(self, data: Any) -> None:
        """Any order that was ever given arrives, for the first time or again."""
        if not self.sent:
            return
        what, given_at = data.draw(st.sampled_from(self.sent))
        key = (what.command_id, what.sender, what.kind)
        reply = self.agent.order(what)
        if key in self.seen:
            return
        self.seen.add(key)
        age = self.agent.s - given_at
        if what.kind not in SETS_OFF:
            assert reply.state is not CommandState.REFUSED
            self.stopped, self.stopped_by = True, what.command_id
        elif age < 4.0 and what.quote.after == self.stopped_by:
            assert reply.state is not CommandState.REFUSED, reply.reason
            self.stopped = False
        elif age > 5.6 or what.quote.after != self.stopped_by:
            assert reply.state is CommandState.REFUSED
        elif reply.state is not CommandState.REFUSED:  # about 5 s: either will do
            self.stopped = False

    @rule(seconds=st.sampled_from([0.5, 3.0, 6.0]))
    def wait(self, seconds: float) -> None:
        """Time passes."""
        self.agent.run(seconds)

    @invariant()
    def who_was_stopped_stays_stopped(self) -> None:
        """No setpoint leaves from a stop to the first order that may set off."""
        if not hasattr(self, "agent"):
            return
        before = len(self.agent.autopilot.setpoints)
        self.agent.run(0.3)
        if self.stopped:
            assert len(self.agent.autopilot.setpoints) == before


TestTwoStations = TwoStations.TestCase
TestTwoStations.settings = settings(max_examples=8, stateful_step_count=12, deadline=None)
