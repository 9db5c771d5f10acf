"""Multicopters through MAVSDK 4, for those who have it as their stack (optional extra `mavsdk`).

Once started, MAVSDK repeats the last setpoint at 20 Hz for ever, also when the code that fed it has died.
So it lives in a child process (`mavsdk_child`), fed through a pipe, that stops offboard and exits when no
setpoint has come for 200 ms. The child has a MAVLink connection of its own (`url`); the agent keeps reading
telemetry from its link.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from math import degrees, isfinite
from struct import Struct
from typing import Protocol

from onboard.autopilot.base import Envelope, Note, ReleaseMode, Setpoint, Stage, Step, Telemetry
from onboard.autopilot.envelope import Shaper
from onboard.autopilot.mode_control import Control
from onboard.autopilot.velocity import GUIDED, WAYS, yaw_along
from onboard.core.math.constants import NEVER
from onboard.core.math.vectors import add, norm
from onboard.wire.mavlink.commands import CommandLong, Target
from onboard.wire.mavlink.ids import CommandId
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import CommandAck

LINE = Struct("<cd4d")  # what, when [s, monotonic], north, east, down [m/s], yaw [deg]
SETPOINT, ENTER, HOLD, RETURN, LAND, RELEASE = b"S", b"E", b"H", b"R", b"L", b"X"
ORDERS = {ReleaseMode.HOLD: HOLD, ReleaseMode.RETURN: RETURN, ReleaseMode.LAND: LAND}
SILENCE = 0.2  # [s] without a setpoint after which the child stops offboard and exits
RELAUNCH = 1.0  # [s] at least between two starts of the child


class Courier(Protocol):
    """The way to the child."""

    def send(self, line: bytes) -> bool:
        """Pass a line on without waiting; False where it did not go."""
        ...

    def said(self) -> list[Note]:
        """What the child has said since."""
        ...

    def alive(self) -> bool:
        """Whether there is a child."""
        ...

    def close(self) -> None:
        """End the child: its input ends, so it stops offboard if that is on, and exits."""
        ...


class Child:
    """The child process and its two pipes, never waited for."""

    def __init__(self, *arguments: str) -> None:
        command = [sys.executable, "-m", "onboard.autopilot.mavsdk_child", *arguments]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self._in, self._out = self.process.stdin.fileno(), self.process.stdout.fileno()
        os.set_blocking(self._in, False)
        os.set_blocking(self._out, False)
        self._rest = b""
        self._closed = False

    @property
    def output(self) -> int:
        """File descriptor of what the child writes."""
        return self._out

    def send(self, line: bytes) -> bool:
        """A line is shorter than what a pipe takes in one piece."""
        if self._closed:
            return False
        try:
            return os.write(self._in, line) == len(line)
        except OSError:
            return False

    def said(self) -> list[Note]:
        """Lines `severity kind text`."""
        try:
            self._rest += os.read(self._out, 65536) if not self._closed else b""
        except OSError:
            return []
        *lines, self._rest = self._rest.split(b"\n")
        parts = (line.decode("utf-8", errors="replace").split(" ", 2) for line in lines)
        return [Note(*part) for part in parts if len(part) == 3]

    def alive(self) -> bool:
        """Not exited, not closed."""
        return not self._closed and self.process.poll() is None

    def close(self) -> None:
        """Close both pipes; the child sees the end and goes by itself."""
        if not self._closed:
            self._closed = True
            for pipe in (self.process.stdin, self.process.stdout):
                if pipe is not None:
                    pipe.close()


class MavsdkAdapter:
    """See `base.Adapter`; its steps give no messages: they go through the child."""

    name = "mavsdk"
    holds_airspeed = False

    def __init__(
        self,
        kind: Kind,
        to: Target,
        envelope: Envelope,
        url: str,
        *,
        may_arm: bool = False,
        launch: Callable[..., Courier] = Child,
    ) -> None:
        self.kind = kind
        self.guided_mode = GUIDED[kind]
        self._control = Control(kind, to, self.guided_mode, WAYS[kind], may_arm=may_arm)
        self._shaper = Shaper(envelope)
        self._url, self._system = url, to.system
        self._way = ReleaseMode.HOLD
        self._launch = launch
        self._courier: Courier | None = None
        self._launched_at = NEVER

    @staticmethod
    def available() -> bool:
        """Whether the optional extra is installed."""
        return find_spec("mavsdk") is not None

    @property
    def stage(self) -> Stage:
        """Who flies."""
        return self._control.stage

    def enter(self, now: float) -> None:
        """Ask the child to start offboard; give setpoints meanwhile (zero to hover)."""
        self._control.enter(now)

    def leave(self, now: float, way: ReleaseMode) -> None:
        """End the setpoints; ask the child to hold, return or land."""
        self._way = way
        self._control.leave(now, way)

    def end(self, now: float) -> None:
        """Silence: the child then stops offboard within 200 ms and exits."""
        self._shaper.restart()

    def arm(self, now: float) -> bool:
        """Arming goes over the agent's own link."""
        return self._control.arm()

    def close(self) -> None:
        """End the child."""
        if self._courier is not None:
            self._courier.close()
            self._courier = None

    def acknowledge(self, now: float, ack: CommandAck) -> None:
        """Hear the answer to arming."""
        self._control.acknowledge(now, ack)

    def step(self, now: float, telemetry: Telemetry, setpoint: Setpoint | None) -> Step:
        """Pass orders and setpoints on to the child; messages are those for arming alone."""
        ended = self._ended()  # before the mode is judged: it was the child that changed it
        messages, notes = self._control.step(now, telemetry)
        notes = ended + notes
        ids = [message.command for message in messages if isinstance(message, CommandLong)]
        asking = CommandId.SET_MODE in ids
        # The child asks for modes; over the agent's own link go requests to arm alone.
        arming = [m for m, number in zip(messages, ids, strict=True) if number == CommandId.ARM]
        courier = self._present(now)
        if courier is None:
            return Step(tuple(arming), tuple(notes))
        notes += courier.said()
        stage = self._control.stage
        if stage is Stage.TAKEN:  # it must not ask for hold: that would take the vehicle from the pilot
            courier.send(LINE.pack(RELEASE, now, 0.0, 0.0, 0.0, 0.0))
            self.close()
        elif asking:
            order = ENTER if stage is Stage.ENTERING else ORDERS[self._way]
            courier.send(LINE.pack(order, now, 0.0, 0.0, 0.0, 0.0))
        if setpoint is not None and stage in (Stage.ENTERING, Stage.ACTIVE):
            wanted = add(setpoint.velocity, setpoint.wind)
            if isfinite(norm(wanted)):
                v = self._shaper.shape(now, wanted)
                yaw = degrees(yaw_along(v, telemetry.yaw))
                courier.send(LINE.pack(SETPOINT, now, v.x, v.y, v.z, yaw))
        return Step(tuple(arming), tuple(notes))

    def _ended(self) -> list[Note]:
        """What there is to tell of a child that has ended: control is given up."""
        if self._courier is None or self._courier.alive():
            return []
        notes = self._courier.said()
        self.close()
        if self._control.stage is Stage.ACTIVE:
            self._control.release()
            notes.append(Note("error", "mavsdk_ended", "the MAVSDK child has ended: offboard is over"))
        return notes

    def _present(self, now: float) -> Courier | None:
        """The child, started when it is needed."""
        needed = self._control.stage in (Stage.ENTERING, Stage.ACTIVE, Stage.LEAVING)
        if self._courier is None and needed and now - self._launched_at >= RELAUNCH:
            self._launched_at = now
            self._courier = self._launch(self._url, str(self._system))
        return self._courier
