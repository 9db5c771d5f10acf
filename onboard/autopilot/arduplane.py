"""ArduPlane in GUIDED: a roll angle at 20 Hz, altitude and airspeed on change (the plain variant: a course).

A plane gets no velocity targets: it reads one as an altitude of 0. The decision's air velocity plus the wind
gives the course over ground; its error gives a turn rate, and that a bank angle. The autopilot keeps altitude
and airspeed by its own loops (43001, 43000). Roll-only attitude lapses after 3 s, altitude and speed do not,
and the plain variant's course (43002) never does: so the supervisor leaves a plane to LOITER where it would
end a multicopter's stream.
"""

from __future__ import annotations

from math import atan2, tan

from onboard.autopilot.base import Note, Setpoint, Stage, Telemetry
from onboard.autopilot.guided import LARGEST, Traits
from onboard.core.guidance.plane import (
    ALTITUDE_STEP,
    LOOK_AHEAD,
    SPEED_STEP,
    Reference,
    Said,
    bank_for,
    begins,
    due,
    followed,
)
from onboard.core.math.angles import wrap
from onboard.core.math.constants import NEVER, STANDARD_GRAVITY
from onboard.core.math.vectors import Vec, add, norm
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Outgoing, RollTarget, Target
from onboard.wire.mavlink.ids import CommandId
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import CommandAck

ROLL_EVERY = 0.03  # [s] at least between two roll targets: every step of a 20 Hz loop passes
COURSE_EVERY = 0.1  # [s] between two course commands of the plain variant
COURSE_STEP = 0.01  # [rad] that is a new course
NAMES: dict[int, str] = {
    CommandId.CHANGE_SPEED: "airspeed",
    CommandId.CHANGE_ALTITUDE: "altitude",
    CommandId.CHANGE_HEADING: "course",
}


class _OnChange:
    """When a wanted altitude or airspeed is sent: on change, again until acknowledged, at most at 2 Hz.

    This is no retry of one command: each try carries the newest value, and an old one is never repeated.
    """

    def __init__(self, step: float) -> None:
        self._step = step
        self._said = Said()
        self.open = True  # not acknowledged

    def due(self, now: float, value: float) -> bool:
        """Return whether to send `value` now, and count it as sent."""
        if not due(self._said, now, value, self._step, self.open):
            return False
        self._said, self.open = Said(value, now), True
        return True

    def forget(self) -> None:
        """The autopilot may have forgotten: say it at once."""
        self._said = Said()
        self.open = True


class ArduPlaneEncoder:
    """Roll (or course), altitude and airspeed for an ArduPlane in GUIDED; see `guided.SetpointEncoder`.

    `plain` commands a course in place of a bank angle of at most `bank_max` [rad]. Until the first setpoint
    the plane circles.
    """

    def __init__(self, to: Target, bank_max: float, *, plain: bool = False) -> None:
        name = "arduplane-plain" if plain else "arduplane"
        self.traits = Traits(name, Kind.ARDUPLANE, "GUIDED", holds_airspeed=True)
        self._bank_max = bank_max  # [rad]
        self._plain = plain
        self._to = to
        self._altitude, self._speed = _OnChange(ALTITUDE_STEP), _OnChange(SPEED_STEP)
        self._reference = Reference()  # [m above sea level]
        self._turned_at = NEVER
        self._course = NEVER  # [rad] of the plain variant's last command
        self._reboots = 0
        self._refused: set[tuple[int, int]] = set()  # (command, result) told already

    def ready(self, now: float) -> bool:
        """Return True: a plane asks for no setpoints before GUIDED."""
        return True

    def sends_in(self, stage: Stage) -> bool:
        """Return whether setpoints count: in GUIDED alone."""
        return stage is Stage.ACTIVE

    def fault(self, setpoint: Setpoint) -> str:
        """Return "not_finite" for a setpoint that is no number, "no_direction" for a stop."""
        if not (norm(setpoint.velocity) < LARGEST and norm(setpoint.wind) < LARGEST):
            return "not_finite"
        return "no_direction" if norm(setpoint.velocity) <= 1e-6 else ""

    def acknowledge(self, ack: CommandAck) -> list[Note]:
        """Hear whether altitude, airspeed or course was taken; a refusal is told once."""
        name = NAMES.get(ack.command)
        if name is None:
            return []
        if ack.result == 0:
            self._refused = {pair for pair in self._refused if pair[0] != ack.command}
            if ack.command != CommandId.CHANGE_HEADING:
                (self._altitude if ack.command == CommandId.CHANGE_ALTITUDE else self._speed).open = False
            return []
        if (ack.command, ack.result) in self._refused:
            return []
        self._refused.add((ack.command, ack.result))
        return [Note("warning", "setpoint_refused", f"{name} refused: result {ack.result}")]

    def restart(self) -> None:
        """A plane needs no stream of setpoints."""

    def encode(self, now: float, telemetry: Telemetry, setpoint: Setpoint) -> list[Outgoing]:
        """Return the roll target (or course), and altitude and airspeed where they are due."""
        ground = add(setpoint.velocity, setpoint.wind)
        if telemetry.reboots != self._reboots:
            self._reboots = telemetry.reboots
            self._altitude.forget()
            self._speed.forget()
        messages = self._turn(now, telemetry, ground) + self._climb(now, telemetry, ground)
        speed = norm(setpoint.velocity)
        if self._speed.due(now, speed):
            messages.append(commands.change_speed(self._to, speed))
        return messages

    def _turn(self, now: float, telemetry: Telemetry, ground: Vec) -> list[Outgoing]:
        if ground.x * ground.x + ground.y * ground.y < 1e-6:
            return []
        course = atan2(ground.y, ground.x)
        if not self._plain:
            if now - self._turned_at < ROLL_EVERY:
                return []
            self._turned_at = now
            bank = bank_for(course, telemetry.velocity, telemetry.yaw, self._bank_max)
            return [RollTarget(self._to, telemetry.time_boot_s, bank)]
        stale = now - self._turned_at >= 1.0  # it may have been lost
        new = self._course == NEVER or abs(wrap(course - self._course)) >= COURSE_STEP
        if now - self._turned_at < COURSE_EVERY or not (new or stale):
            return []
        self._turned_at, self._course = now, course
        lateral = STANDARD_GRAVITY * tan(self._bank_max)
        return [commands.change_heading(self._to, course, lateral)]

    def _climb(self, now: float, telemetry: Telemetry, ground: Vec) -> list[Outgoing]:
        """Altitude that follows the commanded climb: a reference integrates it, so that level stays level."""
        climb = -ground.z
        if begins(self._reference, now):
            self._altitude.forget()
        self._reference = followed(self._reference, now, telemetry.altitude_m, climb)
        wanted = self._reference.altitude + climb * LOOK_AHEAD
        if not self._altitude.due(now, wanted):
            return []
        return [commands.change_altitude(self._to, wanted)]
