"""Adapter and observer beside each simulated personality, over a link that loses, on virtual time."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import atan2, cos, degrees, pi, radians, sin, sqrt

import numpy as np
import pytest

from onboard.autopilot import health
from onboard.autopilot.base import Note, Refusal, ReleaseMode, Setpoint, Stage
from onboard.autopilot.choose import AdapterOptions, adapter_for
from onboard.autopilot.stream_rates import StreamRates
from onboard.autopilot.telemetry_state import Observer
from onboard.autopilot.timesync import TimesyncEstimator
from onboard.core.math.angles import wrap
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO, Vec
from onboard.game.scenario import Kind
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Outgoing, SetpointMessage, Target
from onboard.wire.mavlink.frames import Framer, Sender
from onboard.wire.mavlink.modes import Kind as Autopilot
from onboard.wire.mavlink.values import CommandAck, Heartbeat, Timesync
from tests.support.flown_autopilot import FLOWN, ORIGIN, FlownAutopilot

KINDS = pytest.mark.parametrize("kind", FLOWN, ids=lambda kind: kind.value)
HOLD = {Kind.PX4: "HOLD", Kind.ARDUCOPTER: "BRAKE", Kind.ARDUPLANE: "LOITER"}
GUIDED = {Kind.PX4: "OFFBOARD", Kind.ARDUCOPTER: "GUIDED", Kind.ARDUPLANE: "GUIDED"}


class Flight:
    """The agent's own side, cut down to observer and adapter, at 20 Hz; loss in both directions."""

    def __init__(
        self,
        kind: Kind,
        loss: float = 0.0,
        wind: Vec = ZERO,
        *,
        seed: int = 1,
        scheme: str = "auto",
        parameters: dict[str, float] | None = None,
    ) -> None:
        self.flown = FlownAutopilot(kind, wind=wind, parameters=parameters or {})
        self.loss = loss
        self.rng = np.random.default_rng(seed)
        self.wind = wind if kind == Kind.ARDUPLANE else ZERO
        self.observer, self.framer = Observer(1), Framer()
        self.observer.frame = ORIGIN
        self.sender = Sender(1, 191)
        self.timesync = TimesyncEstimator()
        self.notes: list[Note] = []
        self.setpoints: list[float] = []  # arrival of each that the autopilot got [s]
        self.path: list[tuple[Vec, Vec]] = []  # (wanted over ground, flown)
        self.seen = 0
        while self.observer.snapshot().mode == "":
            self.flown.forward(0.05)
            self._hear()
        heart = self.observer.snapshot()
        chosen = adapter_for(
            Heartbeat(heart.kind, 0, 0, 0, heart.mode, heart.armed, 4),
            Target(1),
            AdapterOptions(scheme),
            parameters or {},
        )
        assert not isinstance(chosen, Refusal)
        self.adapter = chosen
        self.asking = StreamRates(heart.kind, Target(1))
        self._asked_at = -1.0
        self._counts: dict[str, int] = {}

    @property
    def now(self) -> float:
        return self.flown.now_ns / NS_PER_S

    def forward(self, seconds: float, wanted: Vec | Callable[[float], Vec] | None) -> None:
        """Let time pass in steps of 50 ms; `wanted` is relative to the air."""
        for _ in range(round(seconds / 0.05)):
            self.flown.forward(0.05)
            self._hear()
            velocity = wanted(self.now) if callable(wanted) else wanted
            setpoint = None if velocity is None else Setpoint(velocity, self.wind)
            step = self.adapter.step(self.now, self.observer.snapshot(), setpoint)
            self.notes += step.notes
            for message in step.messages:
                self._send(message)
            if velocity is not None:
                self.path.append((velocity, self.flown.velocity))
            if self.now - self._asked_at >= 1.0:
                self._chores()

    def _chores(self) -> None:
        span = self.now - self._asked_at
        rates = {name: count / span for name, count in self._counts.items()}
        self._asked_at, self._counts = self.now, {}
        for message in self.asking.step(self.now, rates):
            self._send(message)
        self._send(commands.OwnHeartbeat())
        self._send(self.timesync.ask(self.flown.now_ns))

    def _send(self, message: Outgoing) -> None:
        frame = self.sender.pack(message)
        if self.rng.random() >= self.loss:
            self.flown.autopilot.receive(self.flown.now_ns, frame, "agent")
            if isinstance(message, SetpointMessage):
                self.setpoints.append(self.now)

    def _hear(self) -> None:
        frames, self.seen = self.flown.frames[self.seen :], len(self.flown.frames)
        for frame in frames:
            if self.rng.random() < self.loss:
                continue
            for packet in self.framer.feed(frame):
                value = self.observer.take(self.now, packet)
                if value is not None and hasattr(self, "adapter"):
                    name = packet.name
                    self._counts[name] = self._counts.get(name, 0) + 1
                    if isinstance(value, CommandAck):
                        self.adapter.acknowledge(self.now, value)
                    elif isinstance(value, Timesync):
                        answer = self.timesync.take(self.flown.now_ns, value)
                        if answer is not None:
                            self._send(answer)


def level(kind: Kind) -> Vec:
    return Vec(0.0, 20.0, 0.0) if kind == Kind.ARDUPLANE else Vec(0.0, 4.0, 0.0)


@KINDS
@pytest.mark.parametrize("loss", [0.0, 0.3])
def test_it_enters_follows_and_leaves(kind: Kind, loss: float) -> None:
    flight = Flight(kind, loss)
    flight.forward(3.0, None)
    flight.adapter.enter(flight.now)
    flight.forward(8.0, level(kind))
    assert flight.adapter.stage is Stage.ACTIVE
    assert flight.flown.mode == GUIDED[kind]
    flight.forward(15.0, level(kind))
    assert degrees(abs(wrap(pi / 2 - atan2(flight.flown.velocity.y, flight.flown.velocity.x)))) < 5.0
    flight.adapter.leave(flight.now, ReleaseMode.HOLD)
    last = flight.now
    flight.forward(4.0, level(kind))
    assert flight.flown.mode == HOLD[kind]
    assert flight.adapter.stage is Stage.LEFT
    assert max(flight.setpoints) <= last
    flight.adapter.leave(flight.now, ReleaseMode.RETURN)
    flight.forward(4.0, None)
    assert flight.flown.mode == "RTL"
    assert {note.severity for note in flight.notes} == {"info"}


@KINDS
def test_a_pilot_takes_over_in_flight(kind: Kind) -> None:
    flight = Flight(kind, 0.2)
    flight.adapter.enter(flight.now)
    flight.forward(8.0, level(kind))
    flight.flown.autopilot.pilot_mode(flight.flown.now_ns, "POSCTL" if kind == Kind.PX4 else "CIRCLE")
    taken = flight.now
    flight.forward(5.0, level(kind))
    assert flight.adapter.stage is Stage.TAKEN
    assert max(flight.setpoints) < taken + 2.1  # the change's heartbeat may be lost: the next comes in 1 s
    assert [note.kind for note in flight.notes][-1] == "take_over"


@pytest.mark.parametrize("kind", [pytest.param(Kind.ARDUCOPTER, marks=pytest.mark.long), Kind.ARDUPLANE])
def test_half_an_hour_at_a_fifth_of_loss_has_no_gap_above_half_a_second(kind: Kind) -> None:
    """At the autopilot: ten losses in a row come once in five days."""
    flight = Flight(kind, 0.2)
    flight.adapter.enter(flight.now)
    flight.forward(6.0, level(kind))
    first = flight.now
    flight.forward(1800.0, level(kind))
    sent = [at for at in flight.setpoints if at >= first]
    assert len(sent) > 0.7 * 1800 * 20
    assert max(b - a for a, b in pairwise(sent)) <= 0.5


def test_a_plane_follows_a_swinging_course_in_wind_as_a_real_one_was_measured_to() -> None:
    """A real ArduPlane by the same scheme: course 9.8° RMS, climb 0.68 m/s, airspeed 0.67 m/s."""
    wind = Vec(-4.0, 5.0, 0.0)
    flight = Flight(Kind.ARDUPLANE, 0.05, wind)
    flight.adapter.enter(flight.now)
    flight.forward(5.0, Vec(22.0, 0.0, 0.0))

    def wanted(now: float) -> Vec:
        yaw, speed = radians(70.0) * sin(2 * pi * now / 40.0), 22.0 + 2.0 * sin(2 * pi * now / 25.0)
        return Vec(speed * cos(yaw), speed * sin(yaw), -2.0 * sin(2 * pi * now / 30.0))

    flight.forward(20.0, wanted)
    flight.path.clear()
    flight.forward(100.0, wanted)
    course = [
        wrap(atan2(air.y + wind.y, air.x + wind.x) - atan2(ground.y, ground.x)) for air, ground in flight.path
    ]
    climb = [air.z - ground.z for air, ground in flight.path]
    assert degrees(sqrt(sum(e * e for e in course) / len(course))) < 12.0
    assert sqrt(sum(e * e for e in climb) / len(climb)) < 1.0


@KINDS
def test_the_rates_asked_for_arrive_and_health_is_read(kind: Kind) -> None:
    flight = Flight(kind)
    flight.forward(15.0, None)
    now, snapshot = flight.now, flight.observer.snapshot()
    assert now - snapshot.position_at <= 0.11
    assert now - snapshot.attitude_at <= 0.11
    reading = health.read(now, snapshot)
    assert (reading.lacks, reading.faults) == ((), ())
    assert snapshot.landed_state == 2
    if kind == Kind.ARDUPLANE:
        assert now - snapshot.wind_at <= 0.5
    assert flight.asking.budget == pytest.approx(StreamRates(Autopilot.ARDUPLANE, Target(1)).budget, rel=0.6)


@KINDS
def test_the_autopilots_clock_is_known_beside_ours(kind: Kind) -> None:
    flight = Flight(kind, 0.2)
    flight.forward(20.0, None)
    offset = flight.timesync.offset()
    assert offset.known
    assert offset.round_trip_ns <= 0.1 * NS_PER_S


def test_wind_of_both_reports_reaches_the_snapshot_as_where_the_air_moves() -> None:
    flight = Flight(Kind.ARDUPLANE, wind=Vec(0.0, 8.0, 0.0))
    flight.adapter.enter(flight.now)
    flight.forward(60.0, lambda now: Vec(20.0 * cos(0.1 * now), 20.0 * sin(0.1 * now), 0.0))
    assert flight.observer.snapshot().wind == pytest.approx((0.0, 8.0, 0.0), abs=1.0)


@KINDS
def test_an_autopilot_that_starts_again_in_flight_is_entered_again(kind: Kind) -> None:
    flight = Flight(kind)
    flight.adapter.enter(flight.now)
    flight.forward(8.0, level(kind))
    flight.flown.autopilot.reboot(flight.flown.now_ns)
    flight.forward(5.0, level(kind))
    assert flight.observer.snapshot().reboots == 1
    assert flight.adapter.stage is Stage.IDLE
    assert "reboot" in [note.kind for note in flight.notes]
    flight.adapter.enter(flight.now)
    flight.forward(8.0, level(kind))
    assert flight.adapter.stage is Stage.ACTIVE


WATCHED = {"FS_GCS_ENABL": 1.0, "SYSID_MYGCS": 1.0, "FS_LONG_ACTN": 1.0}


def test_the_plain_variant_flies_a_course_and_its_failsafe_brings_a_plane_home_whose_agent_has_died() -> None:
    flight = Flight(Kind.ARDUPLANE, scheme="arduplane-plain", parameters=WATCHED)
    flight.adapter.enter(flight.now)
    flight.forward(30.0, Vec(0.0, 20.0, 0.0))
    assert flight.setpoints == []  # no attitude targets: commands alone
    assert flight.flown.velocity.y == pytest.approx(20.0, abs=1.0)
    flight.flown.forward(2.0)  # killed: not even a heartbeat
    assert flight.flown.mode == "GUIDED"
    flight.flown.forward(40.0)
    assert flight.flown.mode == "RTL"


def test_a_killed_agents_plane_turns_no_more_when_its_roll_lapses_and_comes_home_by_the_failsafe() -> None:
    flight = Flight(Kind.ARDUPLANE, parameters=WATCHED)
    flight.adapter.enter(flight.now)
    flight.forward(10.0, lambda now: Vec(20.0 * cos(0.4 * now), 20.0 * sin(0.4 * now), 0.0))
    flight.flown.forward(40.0)
    assert flight.flown.mode == "RTL"
