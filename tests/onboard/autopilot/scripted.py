"""A scripted autopilot: it keeps a mode, hears commands, and can be told to lose or refuse them."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin, tan
from typing import Any

from onboard.autopilot.base import Adapter, Note, Setpoint, Telemetry
from onboard.core.math.vectors import Vec
from onboard.wire.mavlink.commands import CommandInt, CommandLong, Outgoing, RollTarget
from onboard.wire.mavlink.modes import MODES, Kind, mode_name
from onboard.wire.mavlink.values import CommandAck

DT = 0.05


class Scripted:
    """Plays against one adapter at 20 Hz; heartbeats at 1 Hz and at each change of mode."""

    def __init__(self, kind: Kind, adapter: Adapter, mode: str) -> None:
        self.kind = kind
        self.adapter = adapter
        self.telemetry = Telemetry(kind=kind, mode=mode, altitude_m=600.0, airspeed=22.0)
        self.now = 100.0
        self.result = 0  # to every mode and arming command
        self.deaf = False  # hears nothing
        self.sent: list[tuple[float, Outgoing]] = []
        self.notes: list[Note] = []
        self.beat(mode)

    def beat(self, mode: str | None = None, **changes: Any) -> None:
        """A heartbeat, perhaps of a new mode."""
        self.telemetry = self.telemetry._replace(
            mode=mode or self.telemetry.mode, heartbeat_at=self.now, **changes
        )

    def fly(self, seconds: float, setpoint: Setpoint | Callable[[float], Setpoint] | None) -> list[Outgoing]:
        """Let time pass; what was sent meanwhile."""
        first = len(self.sent)
        for _ in range(round(seconds / DT)):
            self.now = round(self.now + DT, 6)
            if self.now - self.telemetry.heartbeat_at >= 1.0:
                self.beat()
            given = setpoint(self.now) if callable(setpoint) else setpoint
            self.telemetry = self.telemetry._replace(time_boot_s=self.now, position_at=self.now)
            step = self.adapter.step(self.now, self.telemetry, given)
            self.notes += step.notes
            for message in step.messages:
                self.sent.append((self.now, message))
                if not self.deaf:
                    self.hear(message)
        return [message for _, message in self.sent[first:]]

    def hear(self, message: Outgoing) -> None:
        """Answer a command."""
        if isinstance(message, CommandLong) and message.command == 176:
            number = int(message.params[1])
            if self.kind is Kind.PX4_MULTICOPTER:
                number = number << 16 | int(message.params[2]) << 24
            assert number in MODES[self.kind].values()
            self.answer(176)
            if self.result == 0:
                self.beat(mode_name(self.kind, number))
        elif isinstance(message, CommandLong) and message.command == 400:
            self.answer(400)
            if self.result == 0:
                self.beat(armed=True)
        elif isinstance(message, CommandInt):
            self.answer(message.command)

    def answer(self, command: int) -> None:
        """A COMMAND_ACK to the agent."""
        self.adapter.acknowledge(self.now, CommandAck(command, self.result, 1, 191))

    def kinds(self) -> list[str]:
        """Kinds of the notes so far."""
        return [note.kind for note in self.notes]


class Plane(Scripted):
    """A scripted ArduPlane that also flies: roll with a lag, coordinated turns, altitude and speed loops."""

    def __init__(self, adapter: Adapter, wind: Vec) -> None:
        super().__init__(Kind.ARDUPLANE, adapter, "GUIDED")
        self.wind = wind
        self.roll_wanted = 0.0
        self.altitude_wanted = 600.0
        self.speed_wanted = 22.0
        self.climb = 0.0
        self.step_at = self.now

    def hear(self, message: Outgoing) -> None:
        """Targets too."""
        super().hear(message)
        if isinstance(message, RollTarget):
            self.roll_wanted = message.roll
        elif isinstance(message, CommandInt) and message.command == 43001:
            self.altitude_wanted = message.z
        elif isinstance(message, CommandInt) and message.command == 43000:
            self.speed_wanted = message.params[1]

    def move(self) -> None:
        """One step of the aircraft (Euler, 50 ms)."""
        t = self.telemetry
        roll = t.roll + (self.roll_wanted - t.roll) * DT / 0.45
        yaw = t.yaw + 9.80665 * tan(roll) / max(t.airspeed, 1.0) * DT
        speed = t.airspeed + (self.speed_wanted - t.airspeed) * DT / 2.0
        climb = max(-4.0, min(4.0, (self.altitude_wanted - t.altitude_m) / 3.3))
        self.climb += (climb - self.climb) * DT / 0.8
        velocity = Vec(speed * cos(yaw) + self.wind.x, speed * sin(yaw) + self.wind.y, -self.climb)
        self.telemetry = t._replace(
            roll=roll,
            yaw=(yaw + pi) % (2 * pi) - pi,
            airspeed=speed,
            velocity=velocity,
            altitude_m=t.altitude_m + self.climb * DT,
        )
