"""While any setpoint leaves the agent, the supervisor judged this very step: in flight, before and after."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import onboard.agent.core.flight as flight_module
from onboard.agent.core.events import Send, Stop
from onboard.core.math.vectors import Vec
from onboard.core.safety.policy import Command
from onboard.core.safety.supervisor import SupervisorOutput
from onboard.wire.bus.messages import Phase
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.modes import MODES, Kind
from tests.support.lone_agent import SETPOINTS, VEHICLE, FakeAutopilot, LoneAgent, playing

ALL = [Kind.ARDUCOPTER, Kind.PX4_MULTICOPTER, Kind.ARDUPLANE]
GUIDED = {Kind.ARDUCOPTER: "GUIDED", Kind.PX4_MULTICOPTER: "OFFBOARD", Kind.ARDUPLANE: "GUIDED"}
COPTERS = [Kind.ARDUCOPTER, Kind.PX4_MULTICOPTER]
PLACES = [Vec(0.0, 0.0, -50.0), Vec(1100.0, 0.0, -50.0)]
NOTICED_S = 0.3  # what the autopilot has said for so long, the agent knows


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.value)
def test_a_return_for_low_battery_is_not_undone_by_a_master_that_goes_back_to_ready(kind: Kind) -> None:
    agent = playing(kind)
    agent.autopilot.battery = 10
    agent.run(2.0)
    assert agent.autopilot.mode_name == "RTL"
    agent.autopilot.battery = 95  # an idle battery recovers
    for phase, in_s in ((Phase.STAGING, 0.0), (Phase.READY, 2.0), (Phase.RUNNING, 0.0)):
        agent.master.phase(phase, in_s)
        agent.run(2.5)
        assert agent.autopilot.mode_name == "RTL", phase
    agent.master.setup("another")
    agent.master.phase(Phase.READY, 2.0)
    agent.run(2.0)
    assert agent.autopilot.mode_name == "RTL"
    assert agent.health is not None
    assert any("resume" in lack for lack in agent.health.lacks)


def low(a: FakeAutopilot) -> None:
    a.battery = 10


def blind(a: FakeAutopilot) -> None:
    a.fix = 0


def lost(a: FakeAutopilot) -> None:
    a.ekf = 0x400


def far(a: FakeAutopilot) -> None:
    a.place = PLACES[1]


@pytest.mark.parametrize("phase", [Phase.STAGING, Phase.READY])
@pytest.mark.parametrize("harm", [low, blind, lost, far], ids=lambda harm: harm.__name__)
@pytest.mark.parametrize("kind", COPTERS, ids=lambda kind: kind.value)
def test_stand_by_is_supervised(kind: Kind, harm: Callable[[FakeAutopilot], None], phase: Phase) -> None:
    agent = playing(kind)
    agent.master.phase(phase, 3600.0)  # as after a jump of the clock
    agent.run(1.0)
    assert agent.rate(0.5) > 15.0
    for north in range(0, 400, 2) if harm is far else ():  # it is carried off, and says so
        agent.autopilot.place, agent.autopilot.drift = Vec(float(north), 0.0, -50.0), 40.0
        agent.step()
    agent.autopilot.drift = 0.0
    if harm is not far:
        harm(agent.autopilot)
    agent.run(2.0)
    assert agent.rate(1.0) == 0.0
    if harm in (low, far):
        assert agent.autopilot.mode_name == "RTL"


@pytest.mark.parametrize("harm", [low, far, blind, lost], ids=lambda harm: harm.__name__)
@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.value)
def test_control_is_not_taken_of_a_vehicle_that_would_be_sent_home(
    kind: Kind, harm: Callable[[FakeAutopilot], None]
) -> None:
    agent = LoneAgent(kind)
    before = agent.autopilot.mode_name
    harm(agent.autopilot)
    agent.run(1.0)
    agent.master.setup()
    agent.master.phase(Phase.READY, 3600.0)
    agent.run(3.0)
    assert agent.autopilot.mode_name == before
    assert agent.autopilot.setpoints == []


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.value)
def test_the_end_of_the_process_keeps_a_return_that_is_on_its_way(kind: Kind) -> None:
    agent = playing(kind)
    agent.autopilot.battery = 10
    agent.step()
    agent.do(Stop())
    agent.run(2.0)
    assert agent.autopilot.mode_name == "RTL"
    assert agent.core.ending.complete


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.value)
def test_the_end_of_the_process_leaves_the_guided_mode_also_without_a_position(kind: Kind) -> None:
    agent = playing(kind)
    agent.autopilot.ekf = 0x400
    agent.run(1.0)
    agent.do(Stop())
    agent.run(2.0)
    assert agent.autopilot.mode_name in ("LAND", "CIRCLE")  # no mode that needs one


class Witness:
    """Stands beside the supervisor: what it judged in the event that is being handled."""

    def __init__(self) -> None:
        self.judged: list[SupervisorOutput] = []
        self._supervise = flight_module.supervise

    def __call__(self, *arguments: Any) -> SupervisorOutput:
        output = self._supervise(*arguments)
        self.judged.append(output)
        return output


STEPS = st.integers(1, 30)
WHAT = st.one_of(
    st.tuples(st.just("battery"), st.sampled_from([10, 95])),
    st.tuples(st.just("fix"), st.sampled_from([0, 3])),
    st.tuples(st.just("ekf"), st.sampled_from([0x400, 0x33F])),
    st.tuples(st.just("place"), st.sampled_from(PLACES)),
    st.tuples(st.just("talks"), st.booleans()),
    st.tuples(st.just("phase"), st.tuples(st.sampled_from(list(Phase)), st.sampled_from([0.0, 1.0, 100.0]))),
    st.tuples(st.just("setup"), st.sampled_from(["one", "two"])),
    st.tuples(st.just("pilot"), st.sampled_from(["LOITER", "RTL", "guided"])),
    st.tuples(st.just("tracks"), st.booleans()),
    st.tuples(st.just("clock"), st.sampled_from([-600.0, -0.5, 0.5, 600.0])),
)


class Danger:
    """Since when the autopilot says what forbids setpoints, from first principles."""

    def __init__(self) -> None:
        self.since = 1e9

    def look(self, agent: LoneAgent) -> None:
        a = agent.autopilot
        bad = a.battery < 20 or a.fix < 3 or a.ekf == 0x400
        self.since = min(self.since, agent.s) if bad and a.talks else 1e9


@pytest.mark.parametrize("kind", ALL, ids=lambda kind: kind.value)
@settings(max_examples=8, deadline=None, suppress_health_check=list(HealthCheck))
@given(story=st.lists(st.tuples(WHAT, STEPS), min_size=1, max_size=8))
def test_no_setpoint_without_a_verdict_on_this_step(kind: Kind, story: list[Any]) -> None:
    witness = Witness()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(flight_module, "supervise", witness)
        agent = playing(kind)
        ears = dialect.MAVLink(None)
        danger = Danger()

        def watched(event: Any, real: Any = agent.do) -> Any:
            effects = real(event)
            sent = [e for e in effects if isinstance(e, Send)]
            names = [str(m.get_type()) for e in sent for m in ears.parse_buffer(e.frame) or ()]
            if any(name in SETPOINTS for name in names):
                last = witness.judged[-1]
                assert last.command in (Command.STREAM, Command.HOVER)
                assert last.at == agent.s
                assert agent.s - danger.since <= NOTICED_S, (names, last)
            return effects

        agent.do = watched  # type: ignore[method-assign]
        for (what, value), steps in story:
            tell(agent, what, value)
            for _ in range(steps):
                danger.look(agent)
                agent.step()


def tell(agent: LoneAgent, what: str, value: Any) -> None:
    """One thing of a random story happens."""
    if what in ("battery", "fix", "ekf", "place", "talks"):
        setattr(agent.autopilot, what, value)
    elif what == "phase":
        agent.master.phase(value[0], value[1], (VEHICLE,))
    elif what == "setup":
        agent.master.setup(value)
    elif what == "pilot":
        modes, other = MODES[agent.autopilot.kind], "HOLD" if value == "LOITER" else value
        name = GUIDED[agent.autopilot.kind] if value == "guided" else value
        agent.autopilot.mode = modes[name] if name in modes else modes[other]
    elif what == "tracks":
        agent.master.tracks = value
    else:
        agent.wall_ns += round(value * 1e9)


def test_a_verdict_on_another_step_lets_nothing_pass() -> None:
    agent = playing()
    verdict = agent.core.flight.output
    assert verdict is not None
    assert verdict.stream
    agent.s += 0.05
    before = len(agent.autopilot.setpoints)
    agent.core.vehicle.step(agent.s, verdict)
    agent.core.radio.flush(agent.now)
    for effect in agent.core.out.take():
        assert isinstance(effect, Send)
        agent.autopilot.hear(agent.s, effect.frame)
    assert len(agent.autopilot.setpoints) == before
    assert agent.core.vehicle.counters()["verdict_of_another_step"] == 1
