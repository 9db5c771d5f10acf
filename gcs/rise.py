"""Brings one vehicle from the ground to its place: arm, climb, go there, stay. Pure; time is an argument.

What is in the air already is left alone, and nobody is armed who may not be. No heartbeat is sent: a station
that begins to beat and stops sets off a failsafe. At the end an ArduCopter stays at its place in GUIDED, a
plane circles it in GUIDED, a PX4 holds it in HOLD.
"""

from __future__ import annotations

from enum import Enum
from math import nan
from typing import NamedTuple

from onboard.core.math.vectors import Vec, norm, sub
from onboard.wire.autopilot_kind import Kind
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Outgoing, Target
from onboard.wire.mavlink.frames import Packet
from onboard.wire.mavlink.ids import MessageId
from onboard.wire.mavlink.modes import custom_mode
from onboard.wire.mavlink.values import CommandAck, ExtendedState, GlobalPosition, Heartbeat, StatusText

EVERY_S = 1.0  # between two times that the same is asked
ON_GROUND = 1  # MAV_LANDED_STATE_ON_GROUND
REACHED = 0.9  # of the climb, before it goes to its place
HEARD_S = 5.0  # without a heartbeat for longer nothing more is sent
PLANES = frozenset({Kind.ARDUPLANE, Kind.PX4_PLANE})
RISES = frozenset({Kind.ARDUCOPTER, Kind.ARDUPLANE, Kind.PX4_MULTICOPTER, Kind.PX4_PLANE})
NEAR_M = {True: 250.0, False: 4.0}  # of its place; a plane circles it
LEVEL_M = {True: 20.0, False: 2.0}
REFUSED = {1: "not now", 2: "denied", 3: "unsupported", 4: "failed"}  # MAV_RESULT


class Step(Enum):
    """How far it is."""

    UNHEARD = "not heard"
    GROUND = "on the ground"
    CLIMBS = "climbs"
    GOES = "goes to its place"
    THERE = "at its place"
    LEFT = "left alone"


class Place(NamedTuple):
    """Where it shall be."""

    id: int
    ned: Vec  # [m; NED, game frame]
    frame: Frame


class Rise:
    """One vehicle on its way up. `take` what arrives; `due` gives what is to be sent; `why` tells of it."""

    def __init__(self, place: Place, *, may_arm: bool) -> None:
        self.place = place
        self.step = Step.UNHEARD
        self.why = ""  # what it waits for, or why it is left alone
        self._may_arm = may_arm
        self._to = Target(place.id, 1)
        self._beat: Heartbeat | None = None
        self._beat_at = 0.0
        self._spot: GlobalPosition | None = None
        self._landed = 0
        self._due = 0.0
        self._ground_m: float | None = None  # altitude of where it stands [m above mean sea level]
        self._said = ""

    @property
    def over(self) -> bool:
        """Whether there is nothing left to do."""
        return self.step in (Step.THERE, Step.LEFT)

    def take(self, packet: Packet, now: float) -> None:
        """Take a frame of the autopilot."""
        value = packet.value
        if packet.system != self.place.id or packet.component != 1:
            return
        if isinstance(value, Heartbeat):
            self._beat, self._beat_at = value, now
        elif isinstance(value, GlobalPosition):
            self._spot = value
        elif isinstance(value, ExtendedState):
            self._landed = value.landed_state
        elif isinstance(value, StatusText) and value.severity <= 4:
            self._said = value.text
        elif isinstance(value, CommandAck) and value.result in REFUSED:
            self._said = self._said or f"command {value.command} {REFUSED[value.result]}"

    def due(self, now: float) -> list[Outgoing]:
        """What is to be sent now [s]."""
        if self.over or now < self._due:
            return []
        beat, spot = self._beat, self._spot
        self._due = now + EVERY_S
        if beat is None or now - self._beat_at > HEARD_S:
            self.why = "no heartbeat"
            return []
        if beat.kind not in RISES:
            self.step, self.why = Step.LEFT, f"{beat.kind.value} is not flown"
            return []
        if spot is None or self._landed == 0:
            self.why = "no position, or no word whether it stands on the ground"
            return [commands.set_message_interval(self._to, int(number), 4.0)
                    for number in (MessageId.GLOBAL_POSITION_INT, MessageId.EXTENDED_SYS_STATE)]  # fmt: skip
        return self._on(beat, spot)

    def _on(self, beat: Heartbeat, spot: GlobalPosition) -> list[Outgoing]:
        if self.step is Step.UNHEARD:
            if beat.armed and self._landed != ON_GROUND:
                self.step, self.why = Step.LEFT, f"in the air already, in {beat.mode}"
                return []
            self.step, self._ground_m = Step.GROUND, spot.altitude_m
        if self.step is Step.GROUND and beat.armed and self._landed != ON_GROUND:
            self.step, self._said = Step.CLIMBS, ""
        assert self._ground_m is not None
        goal = self.place.frame.geodetic_from_ned(self.place.ned).altitude_m - self._ground_m
        if self.step is Step.CLIMBS and spot.altitude_m - self._ground_m >= REACHED * goal:
            self.step = Step.GOES
        if self.step is Step.GOES:
            return self._go(beat, spot)
        if self.step is Step.GROUND and not beat.armed and not self._may_arm:
            self.step, self.why = Step.LEFT, "disarmed, and arming is not allowed (--may-arm)"
            return []
        self.why = self._said or f"{'armed' if beat.armed else 'disarmed'}, in {beat.mode}"
        return self._climb(beat, goal)

    def _climb(self, beat: Heartbeat, height: float) -> list[Outgoing]:
        """Arm and rise, each kind in its own way."""
        mode = {Kind.ARDUCOPTER: "GUIDED", Kind.ARDUPLANE: "TAKEOFF"}.get(beat.kind, "")
        if mode and beat.mode != mode:
            number = custom_mode(beat.kind, mode)
            return [] if number is None else [commands.set_mode(self._to, number, px4=False)]
        if not beat.armed:
            return [commands.arm(self._to)]
        if beat.kind is Kind.ARDUPLANE or self._landed != ON_GROUND:
            return self._higher(beat, height)
        if beat.kind is Kind.ARDUCOPTER:
            return [commands.takeoff(self._to, height)]
        assert self._ground_m is not None
        return [commands.takeoff(self._to, self._ground_m + height, place=nan)]

    def _higher(self, beat: Heartbeat, height: float) -> list[Outgoing]:
        """A plane's own take-off ends at a height of its own: above 10 m the rest is flown to the place."""
        spot = self._spot
        assert spot is not None
        assert self._ground_m is not None
        if beat.kind in PLANES and spot.altitude_m - self._ground_m > min(10.0, REACHED * height):
            self.step = Step.GOES
        return []

    def _go(self, beat: Heartbeat, spot: GlobalPosition) -> list[Outgoing]:
        """Fly to the place and stay."""
        plane = beat.kind in PLANES
        here = self.place.frame.ned_from_geodetic(spot.latitude_deg, spot.longitude_deg, spot.altitude_m)
        off = sub(here, self.place.ned)
        flat = norm(Vec(off.x, off.y, 0.0))
        still = plane or norm(spot.velocity) < 1.0
        if flat < NEAR_M[plane] and abs(off.z) < LEVEL_M[plane] and still:
            self.step, self.why = Step.THERE, f"in {beat.mode}, {flat:.0f} m from its place"
            return []
        self.why = f"{flat:.0f} m and {-off.z:+.0f} m of height away, in {beat.mode}"
        return [commands.reposition(self._to, self.place.frame.geodetic_from_ned(self.place.ned))]
