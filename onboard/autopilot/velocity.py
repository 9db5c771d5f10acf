"""Multicopters by velocity targets: PX4 in OFFBOARD, ArduCopter in GUIDED.

PX4 takes mask 0x9C7 with a yaw, wants a stream of targets for a second before it lets OFFBOARD in, and falls
back by itself a second after the stream ends (COM_OF_LOSS_T). ArduCopter takes mask 0x0DC7 and stops three
seconds after the stream ends (GUID_TIMEOUT). Both are in the autopilot's local frame, whose axes are north,
east and down: a velocity needs no origin.
"""

from __future__ import annotations

from math import atan2, isfinite

from onboard.autopilot.base import Envelope, Note, ReleaseMode, Setpoint, Stage, Step, Telemetry
from onboard.autopilot.envelope import Shaper
from onboard.autopilot.mode_control import Control
from onboard.core.math.vectors import Vec, add, norm
from onboard.wire.mavlink.commands import Target, VelocityTarget
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import CommandAck

STREAM_BEFORE = 1.2  # [s] of targets before PX4 is asked for OFFBOARD (it wants 1 s at 2 Hz or more)
TURNING = 0.5  # [m/s; ground] below this the vehicle keeps looking where it looks

GUIDED = {Kind.PX4_MULTICOPTER: "OFFBOARD", Kind.ARDUCOPTER: "GUIDED"}
WAYS = {
    Kind.PX4_MULTICOPTER: {ReleaseMode.HOLD: "HOLD", ReleaseMode.RETURN: "RTL", ReleaseMode.LAND: "LAND"},
    Kind.ARDUCOPTER: {ReleaseMode.HOLD: "LOITER", ReleaseMode.RETURN: "RTL", ReleaseMode.LAND: "LAND"},
}


def yaw_along(velocity: Vec, present: float) -> float:
    """Where to look [rad]: along the flight, or as at present where there is none to speak of."""
    moving = velocity.x * velocity.x + velocity.y * velocity.y > TURNING * TURNING
    return atan2(velocity.y, velocity.x) if moving else present


class VelocityAdapter:
    """PX4 multicopter or ArduCopter; see `base.Adapter`.

    After TAKEN or LEFT a pilot hands an ArduCopter back by choosing GUIDED. PX4 lets nobody into OFFBOARD
    without a stream of targets, and none is sent then: there `enter` (an operator's resume) takes it back.
    ArduCopter's LOITER needs a pilot's throttle stick in the middle: without a transmitter hold by "BRAKE".
    """

    name = "velocity"
    holds_airspeed = False

    def __init__(
        self,
        kind: Kind,
        to: Target,
        envelope: Envelope,
        *,
        may_arm: bool = False,
        hold_mode: str = "",
    ) -> None:
        self.kind = kind
        self.envelope = envelope
        self.guided_mode = GUIDED[kind]
        ways = {**WAYS[kind], **({ReleaseMode.HOLD: hold_mode} if hold_mode else {})}
        self._control = Control(kind, to, self.guided_mode, ways, may_arm=may_arm)
        self._to = to
        self._shaper = Shaper(envelope)
        self._complained = False

    @property
    def stage(self) -> Stage:
        """Who flies."""
        return self._control.stage

    def enter(self, now: float) -> None:
        """Ask for OFFBOARD or GUIDED; with PX4 give setpoints meanwhile (zero to hover)."""
        self._control.enter(now)

    def leave(self, now: float, way: ReleaseMode) -> None:
        """End the targets; ask for hold, return or land."""
        self._control.leave(now, way)

    def end(self, now: float) -> None:
        """Silence: these autopilots stop by themselves."""
        self._shaper.restart()

    def arm(self, now: float) -> bool:
        """Ask for arming, if made with `may_arm`."""
        return self._control.arm()

    def close(self) -> None:
        """Nothing to release."""

    def acknowledge(self, now: float, ack: CommandAck) -> None:
        """Hear the answer to a command."""
        self._control.acknowledge(now, ack)

    def step(self, now: float, telemetry: Telemetry, setpoint: Setpoint | None) -> Step:
        """A target for a setpoint, where targets count (or PX4 must see them first)."""
        px4 = self.kind is Kind.PX4_MULTICOPTER
        ready = not px4 or self._shaper.streamed(now) >= STREAM_BEFORE
        messages, notes = self._control.step(now, telemetry, ready=ready)
        if setpoint is None or not self._may_send(px4):
            return Step(tuple(messages), tuple(notes))
        wanted = add(setpoint.velocity, setpoint.wind)
        if not isfinite(norm(wanted)):
            if not self._complained:
                notes.append(Note("error", "not_finite", "a setpoint that is no number was not sent"))
            self._complained = True
            return Step(tuple(messages), tuple(notes))
        self._complained = False
        wanted = self._shaper.shape(now, wanted)
        yaw = yaw_along(wanted, telemetry.yaw) if px4 else None
        messages.append(VelocityTarget(self._to, telemetry.time_boot_s, wanted, yaw))
        return Step(tuple(messages), tuple(notes))

    def _may_send(self, px4: bool) -> bool:
        """Targets outside the guided mode are ignored; PX4 wants to see them before it."""
        stage = self._control.stage
        return stage is Stage.ACTIVE or (px4 and stage in (Stage.IDLE, Stage.ENTERING))
