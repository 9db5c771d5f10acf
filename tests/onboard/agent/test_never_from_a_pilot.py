"""Whatever happens, in whatever order: the agent never takes a vehicle from a pilot who flies it by hand."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from onboard.agent.core.events import Stop
from onboard.autopilot.pilot_hands import FLOWN_BY_HAND
from onboard.wire.bus.messages import Command, CommandKind, Phase, Quote
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.modes import MODES, Kind
from tests.support.lone_agent import VEHICLE, FakeAutopilot, LoneAgent

GUIDED = {Kind.ARDUCOPTER: "GUIDED", Kind.ARDUPLANE: "GUIDED", Kind.PX4_MULTICOPTER: "OFFBOARD"}
BY_HAND = {
    Kind.ARDUCOPTER: ("LOITER", "ALT_HOLD", "STABILIZE"),
    Kind.ARDUPLANE: ("FBWA", "MANUAL", "CRUISE"),
    Kind.PX4_MULTICOPTER: ("POSCTL", "ALTCTL", "MANUAL"),
}
OTHERS = {
    Kind.ARDUCOPTER: ("RTL", "BRAKE", "AUTO"),
    Kind.ARDUPLANE: ("RTL", "LOITER", "AUTO"),
    Kind.PX4_MULTICOPTER: ("RTL", "HOLD", "MISSION"),
}


class FlownAutopilot(FakeAutopilot):
    """An autopilot that answers late, beside a pilot whose hands are on the sticks when he flies."""

    def __init__(self, kind: Kind) -> None:
        super().__init__(kind)
        self.delay = 0.0  # [s] until a request is obeyed
        self.status = 4
        self.pilot_since: float | None = None  # since when he flies by hand; None: he does not
        self.stolen: list[str] = []  # what the agent did against him
        self._switch, self._stick, self._late = 1000, 1500, []  # type: ignore[var-annotated]
        self._told_at = 0.0  # when his mode was last told

    def choose(self, now: float, name: str, *, by_switch: bool) -> None:
        """A pilot (`by_switch`) or somebody at a station chooses a mode."""
        self.mode = MODES[self.kind][name]
        if by_switch:
            self._switch = 3000 - self._switch
        flies = by_switch and name in BY_HAND[self.kind]
        self.pilot_since = now if flies else None
        self._told_at = 0.0

    def hear(self, now: float, frame: bytes) -> str:
        before, heard = self.mode, len(self.setpoints)
        name = super().hear(now, frame)
        if self.mode != before:
            wanted, self.mode = self.mode, before
            self._late.append((now + self.delay, wanted))
            self._blame(f"asked for {self.names[wanted]}")
        if len(self.setpoints) > heard:
            self._blame("a setpoint")
        return name

    def _blame(self, what: str) -> None:
        """Against a pilot's hands of which it was told the agent does nothing at all."""
        if self.pilot_since is not None and self._told_at > 0.0:
            self.stolen.append(what)

    def says(self, now: float) -> list[bytes]:
        for at, mode in [one for one in self._late if one[0] <= now]:
            self._late.remove((at, mode))
            if self.pilot_since is None:  # one obeyed against the pilot is the autopilot's lateness
                self.mode = mode
        said = super().says(now)
        if not self.talks:
            return said
        if self.pilot_since is not None:
            self._stick = 1500 + round(100 * ((now * 3.0) % 2.0 - 1.0))  # his hands are never still
            self._told_at = now
        d, boot = dialect, round(now * 1e3)
        kinds = {Kind.ARDUCOPTER: (2, 3), Kind.ARDUPLANE: (1, 3), Kind.PX4_MULTICOPTER: (2, 12)}
        beat = d.MAVLink_heartbeat_message(*kinds[self.kind], 128 | 1, self.mode, self.status, 3)
        pulses = [self._stick, 1500, 1500, 1500, self._switch, *[1500] * 13]
        channels = d.MAVLink_rc_channels_message(boot, 8, *pulses, 200)
        return [bytes(beat.pack(self._mav)), bytes(channels.pack(self._mav)), *said[1:]]


happening = st.one_of(
    st.tuples(st.just("pilot"), st.integers(0, 2)),  # flies by hand
    st.tuples(st.just("pilot"), st.integers(0, 2)),
    st.tuples(st.just("switch"), st.integers(0, 3)),  # chooses another mode by his switch
    st.tuples(st.just("station"), st.integers(0, 3)),  # somebody at a station chooses one
    st.tuples(st.just("order"), st.integers(0, 11)),
    st.tuples(st.just("phase"), st.integers(0, 4)),
    st.tuples(st.just("setup"), st.just(0)),
    st.tuples(st.just("talks"), st.integers(0, 1)),
    st.tuples(st.just("tracks"), st.integers(0, 1)),
    st.tuples(st.just("master"), st.integers(0, 1)),
    st.tuples(st.just("battery"), st.sampled_from([10, 95])),
    st.tuples(st.just("fix"), st.sampled_from([1, 3])),
    st.tuples(st.just("status"), st.sampled_from([4, 5])),
    st.tuples(st.just("delay"), st.sampled_from([0, 4, 20])),
    st.tuples(st.just("restart"), st.just(0)),
    st.tuples(st.just("pause"), st.integers(1, 4)),
    st.tuples(st.just("stop"), st.just(0)),
)


def befall(agent: LoneAgent, what: str, number: int, count: int) -> LoneAgent:
    """One thing happens; the agent that lives on."""
    vehicle: Any = agent.autopilot
    kind = vehicle.kind
    others = (*OTHERS[kind], GUIDED[kind])
    if what == "pilot":
        vehicle.choose(agent.s, BY_HAND[kind][number], by_switch=True)
    elif what == "switch":
        vehicle.choose(agent.s, others[number], by_switch=True)
    elif what == "station" and vehicle.pilot_since is None:
        vehicle.choose(agent.s, others[number], by_switch=False)
    elif what == "order":
        kinds = list(CommandKind)
        shown = vehicle.mode_name if number >= len(kinds) else ""
        core = agent.core
        nonce, said = core.bus.masters.last or (core.facts.nonce, core.desk.number)
        quote = Quote(nonce, said, core.facts.nonce, core.orders.stopped_by)
        agent.order(Command(f"c-{count}", kinds[number % len(kinds)], "anna", 0, shown, quote))
    elif what == "phase":
        phase = list(Phase)[number]
        agent.master.phase(phase, 0.5 if phase is Phase.READY else 0.0, (VEHICLE,) if number % 2 else ())
    elif what == "setup":
        agent.master.setup(f"square-{count}")
    elif what in ("talks", "battery", "fix", "status"):
        setattr(vehicle, what, bool(number) if what == "talks" else number)
    elif what == "tracks":
        agent.master.tracks = bool(number)
    elif what == "master":
        agent.master.on = bool(number)
    elif what == "delay":
        vehicle.delay = 0.1 * number
    elif what == "pause":
        agent.s += number
        agent.wall_ns += number * 10**9
    elif what == "stop":
        agent.do(Stop())
    if what in ("restart", "stop"):
        again = LoneAgent(kind, nonce=100 + count)
        again.s, again.wall_ns, again.autopilot, again.master = agent.s, agent.wall_ns, vehicle, agent.master
        return again
    return agent


def lived(kind: Kind, take_control: bool, story: list[tuple[str, int, int]]) -> FlownAutopilot:
    """A game has begun, and then the story happens."""
    agent = LoneAgent(kind, take_control=take_control)
    vehicle = agent.autopilot = FlownAutopilot(kind)
    agent.run(0.5)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(1.0)
    agent.master.phase(Phase.READY, 0.5)
    agent.run(0.7)
    agent.master.phase(Phase.RUNNING)
    agent.run(0.5)
    for count, (what, number, steps) in enumerate(story):
        agent = befall(agent, what, number, count)
        agent.run(0.05 * steps)
        assert not vehicle.stolen, (count, vehicle.mode_name, vehicle.stolen)
    return vehicle


stories = st.lists(
    st.tuples(happening, st.integers(1, 40)).map(lambda pair: (*pair[0], pair[1])), min_size=3, max_size=14
)
KINDS = pytest.mark.parametrize("kind", list(GUIDED), ids=lambda kind: kind.value)
SETTINGS: dict[str, Any] = {
    "deadline": None, "derandomize": True, "suppress_health_check": [HealthCheck.too_slow],
}  # fmt: skip


@KINDS
@settings(max_examples=5, **SETTINGS)
@given(take_control=st.booleans(), story=stories)
def test_no_request_and_no_setpoint_leaves_while_a_pilot_flies_by_hand(
    kind: Kind, take_control: bool, story: list[tuple[str, int, int]]
) -> None:
    lived(kind, take_control, story)


@pytest.mark.long
@KINDS
@settings(max_examples=400, **SETTINGS)
@given(take_control=st.booleans(), story=stories)
def test_nor_in_any_of_many_stories(
    kind: Kind, take_control: bool, story: list[tuple[str, int, int]]
) -> None:
    lived(kind, take_control, story)


@KINDS
def test_the_stories_do_fly(kind: Kind) -> None:
    """The property is not kept by an agent that never flies."""
    vehicle = lived(kind, True, [("tracks", 1, 40), ("order", 2, 60)])
    assert len(vehicle.setpoints) > 20
    assert set(BY_HAND[kind]) <= FLOWN_BY_HAND[kind]
