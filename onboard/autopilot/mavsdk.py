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
from collections.abc import Callable, Mapping
from importlib.util import find_spec
from math import degrees
from struct import Struct
from types import MappingProxyType
from typing import Protocol

from onboard.autopilot.base import Note, Setpoint, Stage, Step, Telemetry
from onboard.autopilot.guided import GuidedAdapter
from onboard.autopilot.velocity import VelocityEncoder
from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.modes import Kind

LINE = Struct("<cd4d")  # what, when [s, monotonic], north, east, down [m/s], yaw [deg]
SETPOINT, ENTER, HOLD, RETURN, LAND, RELEASE = b"S", b"E", b"H", b"R", b"L", b"X"
ORDERS = {"HOLD": HOLD, "LOITER": HOLD, "RTL": RETURN, "LAND": LAND}
"""What MAVSDK can be told, by the autopilot's word for the mode that follows."""
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


class MavsdkEncoder(VelocityEncoder):
    """Velocity targets as the child takes them: always with a yaw, and while it asks for offboard too."""

    def __init__(self, kind: Kind, to: Target) -> None:
        super().__init__(kind, to)
        self.traits = self.traits._replace(name="mavsdk")
        self._looks = True

    def sends_in(self, stage: Stage) -> bool:
        """Return whether the child wants setpoints."""
        return stage in (Stage.ENTERING, Stage.ACTIVE)


class MavsdkAdapter(GuidedAdapter):
    """See `base.Adapter`; modes and setpoints go through the child, arming alone over the agent's link."""

    def __init__(
        self,
        to: Target,
        encoder: MavsdkEncoder,
        url: str,
        *,
        may_arm: bool = False,
        launch: Callable[..., Courier] = Child,
        parameters: Mapping[str, float] = MappingProxyType({}),
    ) -> None:
        super().__init__(to, encoder, may_arm=may_arm, parameters=parameters)
        self._launch = launch
        self._targets = encoder
        self._url, self._system = url, to.system
        self._courier: Courier | None = None
        self._launched_at = NEVER

    @staticmethod
    def available() -> bool:
        """Return whether the optional extra is installed."""
        return find_spec("mavsdk") is not None

    @property
    def child(self) -> int | None:
        """The child's process id, while there is one."""
        return self._courier.process.pid if isinstance(self._courier, Child) else None

    def close(self) -> None:
        """End the child."""
        if self._courier is not None:
            self._courier.close()
            self._courier = None

    def step(self, now: float, telemetry: Telemetry, setpoint: Setpoint | None) -> Step:
        """Pass orders and setpoints on to the child; return the messages for arming alone."""
        notes = self._ended()  # before the mode is judged: it was the child that changed it
        self._see(now, telemetry)
        asked = self._machine.step(now, telemetry)
        notes += asked.notes
        leaving = bool(asked.mode) and self.stage is Stage.LEAVING
        beyond = leaving and asked.mode not in ORDERS  # BRAKE: MAVSDK has no word for it
        messages = (*self._arming(asked), *(self._mode_messages(asked) if beyond else ()))
        courier = self._present(now)
        if courier is None:
            return Step(messages, tuple(notes))
        notes += courier.said()
        if self.stage is Stage.TAKEN:  # it must not ask for hold: that would take the vehicle from the pilot
            courier.send(LINE.pack(RELEASE, now, 0.0, 0.0, 0.0, 0.0))
            self.close()
        elif beyond:
            courier.send(LINE.pack(RELEASE, now, 0.0, 0.0, 0.0, 0.0))
        elif asked.mode:
            order = ORDERS[asked.mode] if leaving else ENTER
            courier.send(LINE.pack(order, now, 0.0, 0.0, 0.0, 0.0))
        sound = self._sound(setpoint, notes)
        if sound is not None:
            target = self._targets.target(now, telemetry, sound)
            v, yaw = target.velocity, degrees(target.yaw or 0.0)
            courier.send(LINE.pack(SETPOINT, now, v.x, v.y, v.z, yaw))
        return Step(messages, tuple(notes))

    def _ended(self) -> list[Note]:
        """What there is to tell of a child that has ended: control is given up."""
        if self._courier is None or self._courier.alive():
            return []
        notes = self._courier.said()
        self.close()
        if self.stage is Stage.ACTIVE:
            self._machine.give_up()
            notes.append(Note("error", "mavsdk_ended", "the MAVSDK child has ended: offboard is over"))
        return notes

    def _present(self, now: float) -> Courier | None:
        """The child, started when it is needed."""
        needed = self.stage in (Stage.ENTERING, Stage.ACTIVE, Stage.LEAVING)
        if self._courier is None and needed and now - self._launched_at >= RELAUNCH:
            self._launched_at = now
            self._courier = self._launch(self._url, str(self._system))
        return self._courier
