"""Multicopters by velocity targets: PX4 in OFFBOARD, ArduCopter in GUIDED.

PX4 takes mask 0x9C7 with a yaw, wants a stream of targets for a second before it lets OFFBOARD in, and falls
back by itself a second after the stream ends (COM_OF_LOSS_T). ArduCopter takes mask 0x0DC7 and stops three
seconds after the stream ends (GUID_TIMEOUT). Both are in the autopilot's local frame, whose axes are north,
east and down: a velocity needs no origin.

After TAKEN or LEFT a pilot hands an ArduCopter back by choosing GUIDED. PX4 lets nobody into OFFBOARD without
a stream of targets, and none is sent then: there `enter` (an operator's resume) takes it back. Into which
modes they are left says `release_modes`.
"""

from __future__ import annotations

from math import atan2

from onboard.autopilot.base import Note, Setpoint, Stage, Telemetry
from onboard.autopilot.guided import LARGEST, Traits
from onboard.core.math.constants import NEVER
from onboard.core.math.each import new
from onboard.core.math.vectors import Vec, add, norm
from onboard.wire.mavlink.commands import Outgoing, Target, VelocityTarget
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import CommandAck

STREAM_BEFORE = 1.2  # [s] of targets before PX4 is asked for OFFBOARD (it wants 1 s at 2 Hz or more)
GAP = 0.4  # [s] without a target after which the stream begins again
TURNING = 0.5  # [m/s; ground] below this the vehicle keeps looking where it looks

GUIDED = {Kind.PX4_MULTICOPTER: "OFFBOARD", Kind.ARDUCOPTER: "GUIDED"}


def yaw_along(velocity: Vec, present: float) -> float:
    """Return where to look [rad]: along the flight, or as at present where it hardly moves."""
    moving = velocity.x * velocity.x + velocity.y * velocity.y > TURNING * TURNING
    return atan2(velocity.y, velocity.x) if moving else present


class TargetStream:
    """Since when targets have been flowing without a gap. Instants are local monotonic seconds."""

    def __init__(self) -> None:
        self._since = NEVER
        self._at = NEVER  # of the newest target

    def lasted(self, now: float) -> float:
        """Return how long targets have been flowing [s]; 0 after a gap."""
        return now - self._since if now - self._at <= GAP else 0.0

    def sent(self, now: float) -> None:
        """Hear that a target goes out."""
        if now - self._at > GAP:
            self._since = now
        self._at = now

    def restart(self) -> None:
        """The next target begins a new stream."""
        self._at = NEVER


class VelocityEncoder:
    """Velocity targets for a PX4 multicopter or an ArduCopter; see `guided.SetpointEncoder`."""

    def __init__(self, kind: Kind, to: Target, hold_mode: str = "") -> None:
        self.traits = Traits("velocity", kind, GUIDED[kind], hold_mode)
        self._to = to
        self._px4 = kind is Kind.PX4_MULTICOPTER
        self._looks = self._px4  # targets say where the vehicle looks
        self._stream = TargetStream()

    def ready(self, now: float) -> bool:
        """Return whether PX4 has seen enough targets; ArduCopter needs none."""
        return not self._px4 or self._stream.lasted(now) >= STREAM_BEFORE

    def sends_in(self, stage: Stage) -> bool:
        """Return whether targets count: in the guided mode, and for PX4 on the way into it.

        Never unasked: PX4 enters OFFBOARD again by itself when targets return after its signal-loss failsafe.
        """
        return stage is Stage.ACTIVE or (self._px4 and stage is Stage.ENTERING)

    def fault(self, setpoint: Setpoint) -> str:
        """Return "not_finite" for a setpoint that is no number."""
        return "" if norm(add(setpoint.velocity, setpoint.wind)) < LARGEST else "not_finite"

    def encode(self, now: float, telemetry: Telemetry, setpoint: Setpoint) -> list[Outgoing]:
        """Return one target."""
        return [self.target(now, telemetry, setpoint)]

    def target(self, now: float, telemetry: Telemetry, setpoint: Setpoint) -> VelocityTarget:
        """Return the target for a setpoint without fault."""
        self._stream.sent(now)
        wanted = add(setpoint.velocity, setpoint.wind)
        yaw = setpoint.yaw
        if yaw is None and self._looks:
            yaw = yaw_along(wanted, telemetry.yaw)
        return new(VelocityTarget, (self._to, telemetry.time_boot_s, wanted, yaw))

    def acknowledge(self, ack: CommandAck) -> list[Note]:
        """Targets are not acknowledged."""
        return []

    def restart(self) -> None:
        """The next target begins a new stream."""
        self._stream.restart()
