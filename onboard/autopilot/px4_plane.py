"""PX4's fixed wing in OFFBOARD: a position target 300 m ahead along the wanted course, at 20 Hz.

Velocity targets alone let it wander; with the point ahead it settles within 2° (PX4 1.16, software in the
loop). It follows the target's altitude, and flies at FW_AIRSPD_TRIM whatever is asked: the game's speed must
be that. A second after the last target (COM_OF_LOSS_T) it does what COM_OBL_RC_ACT says.

PX4 1.18 knows a course command (43002) for fixed wings. The variant `px4-plane-course` sends it too, and
stops where it is answered UNSUPPORTED or DENIED; the targets go on, which keep OFFBOARD. Never flown.
"""

from __future__ import annotations

from math import atan2, cos, sin

from onboard.autopilot.base import Note, Setpoint, Stage, Telemetry
from onboard.autopilot.guided import LARGEST, Traits
from onboard.autopilot.velocity import STREAM_BEFORE, TargetStream
from onboard.core.guidance.plane import LOOK_AHEAD, Reference, followed
from onboard.core.math.angles import wrap
from onboard.core.math.constants import NEVER
from onboard.core.math.vectors import Vec, add, norm
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Outgoing, PlaceTarget, Target
from onboard.wire.mavlink.ids import CommandId
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import CommandAck

AHEAD = 300.0  # [m] from the aircraft to the point that it flies to
COURSE_EVERY, COURSE_AGAIN = 0.1, 1.0  # [s] between two course commands: a new course, the same one
COURSE_STEP = 0.01  # [rad] that is a new course
DENIED, UNSUPPORTED = 2, 3  # MAV_RESULT


class Px4PlaneEncoder:
    """Position targets ahead for a PX4 plane in OFFBOARD; see `guided.SetpointEncoder`."""

    def __init__(self, to: Target, *, course: bool = False) -> None:
        name = "px4-plane-course" if course else "px4-plane"
        self.traits = Traits(name, Kind.PX4_PLANE, "OFFBOARD", holds_airspeed=True)
        self._to = to
        self._commands_course = course
        self._stream = TargetStream()
        self._reference = Reference()  # [m above sea level]
        self._course, self._course_at = NEVER, NEVER  # [rad], [s] of the last course command

    def ready(self, now: float) -> bool:
        """Return whether PX4 has seen enough targets to be asked for OFFBOARD."""
        return self._stream.lasted(now) >= STREAM_BEFORE

    def sends_in(self, stage: Stage) -> bool:
        """Return whether targets count: in OFFBOARD and on the way into it, never unasked."""
        return stage in (Stage.ACTIVE, Stage.ENTERING)

    def fault(self, setpoint: Setpoint) -> str:
        """Return "not_finite" for a setpoint that is no number, "no_direction" for a stop."""
        if not (norm(setpoint.velocity) < LARGEST and norm(setpoint.wind) < LARGEST):
            return "not_finite"
        return "no_direction" if norm(setpoint.velocity) <= 1e-6 else ""

    def encode(self, now: float, telemetry: Telemetry, setpoint: Setpoint) -> list[Outgoing]:
        """Return the point ahead; nothing before the aircraft's place is known."""
        if telemetry.position_at == NEVER:
            return []
        ground = add(setpoint.velocity, setpoint.wind)
        level = ground.x * ground.x + ground.y * ground.y
        course = atan2(ground.y, ground.x) if level > 1e-6 else telemetry.yaw
        climb = -ground.z
        self._reference = followed(self._reference, now, telemetry.altitude_m, climb)
        altitude = self._reference.altitude + climb * LOOK_AHEAD
        here = Frame(telemetry.latitude_deg, telemetry.longitude_deg, altitude)
        place = here.geodetic_from_ned(Vec(AHEAD * cos(course), AHEAD * sin(course), 0.0))
        self._stream.sent(now)
        target = PlaceTarget(
            self._to, telemetry.time_boot_s, place.latitude_deg, place.longitude_deg, altitude
        )
        return [target, *self._course_command(now, course)]

    def _course_command(self, now: float, course: float) -> list[Outgoing]:
        if not self._commands_course:
            return []
        new = self._course == NEVER or abs(wrap(course - self._course)) >= COURSE_STEP
        if now - self._course_at < (COURSE_EVERY if new else COURSE_AGAIN):
            return []
        self._course, self._course_at = course, now
        return [commands.change_heading(self._to, course, 0.0)]

    def acknowledge(self, ack: CommandAck) -> list[Note]:
        """Hear whether the course command is taken; where it is not, it is not sent again."""
        refused = ack.command == CommandId.CHANGE_HEADING and ack.result in (DENIED, UNSUPPORTED)
        if not (refused and self._commands_course):
            return []
        self._commands_course = False
        text = f"the course command is refused (result {ack.result}): position targets alone fly it"
        return [Note("warning", "course_refused", text)]

    def restart(self) -> None:
        """The next target begins a new stream."""
        self._stream.restart()
