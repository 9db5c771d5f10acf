"""What is known of one autopilot: each packet is taken in, `snapshot` is read when a decision is due.

Only packets of the autopilot's own component count, so that the heartbeat of a ground station that a router
passes on cannot change the vehicle's mode. A frame that a link delivers late does not replace a newer one,
and one odd sample decides nothing: see `plausibility`.
"""

from __future__ import annotations

from collections import Counter
from typing import Any

from onboard.autopilot.base import Telemetry
from onboard.autopilot.batteries import Batteries, Gauged
from onboard.autopilot.plausibility import FALL, LEAST, ClockWatch, EstimatorWatch, PlaceWatch, Recent, Stamp
from onboard.core.math.constants import NEVER
from onboard.core.math.each import new
from onboard.core.math.vectors import ZERO, Vec
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.frames import Packet
from onboard.wire.mavlink.ids import AUTOPILOT
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import (
    UNKNOWN,
    AirData,
    Attitude,
    Battery,
    EkfStatus,
    ExtendedState,
    GlobalPosition,
    GpsFix,
    Heartbeat,
    Home,
    RcChannels,
    SysStatus,
    Value,
    Wind,
)

OLD = 0.5  # [s] within which a lower sequence number means a late frame rather than a restart
NO_NUMBER = -1  # of a frame that came over another link
QUALITY = 0.005  # weight of one frame in the running link quality: about the last 200

BLANK: dict[type, Value] = {
    Heartbeat: Heartbeat(Kind.UNKNOWN, 0, 0, 0, "", False, 0),
    GlobalPosition: GlobalPosition(0.0, 0.0, 0.0, 0.0, 0.0, ZERO),
    Attitude: Attitude(0.0, 0.0, 0.0, 0.0, ZERO),
    AirData: AirData(0.0, 0.0, 0.0, 0.0, 0.0),
    Wind: Wind(Vec(0.0, 0.0, 0.0)),
    SysStatus: SysStatus(UNKNOWN, UNKNOWN, False, False, 0, 0.0, 0.0),
    GpsFix: GpsFix(0, -1, UNKNOWN, UNKNOWN),
    EkfStatus: EkfStatus(0, False, 0.0),
    ExtendedState: ExtendedState(0, 0),
    RcChannels: RcChannels(()),
}
NOTHING: dict[type, tuple[float, int, Any]] = {kind: (NEVER, 0, value) for kind, value in BLANK.items()}
_STAMPED = (GlobalPosition, Attitude)  # with the instant that they are of, on the autopilot's clock
_WEIGHED = {EkfStatus, GpsFix, Battery, SysStatus}  # of which the last few are judged together


class Observer:
    """Latest values of one autopilot, with the instants they came [s, monotonic]."""

    def __init__(self, system: int, component: int = AUTOPILOT) -> None:
        self.system = system
        self.component = component
        self.frame: Frame | None = None  # the game frame, when the setup is known
        self.home: Home | None = None
        self._latest: dict[type, tuple[float, int, Any]] = {}  # kind → (arrival, sequence, value)
        self._link = 0
        self.odd: Counter[str] = Counter()  # samples that did not count, by cause
        self._reboots = 0
        self._clock = ClockWatch()
        self._forget()
        self._quality = 1.0
        self._sequence = -1
        self._heard_at = NEVER

    def take(self, now: float, packet: Packet, link: int = 0) -> Value | None:
        """Take in one packet that came at `now` [s, monotonic]; return its value if it counts.

        None: the packet is another component's, nobody reads it, it is not sound, or a newer one came before.
        `link` tells several links apart: an autopilot numbers its frames on each of them separately.
        """
        if packet.system != self.system or packet.component != self.component:
            return None
        if link != self._link:
            self._link, self._heard_at = link, NEVER
            self._latest = {kind: (at, NO_NUMBER, value) for kind, (at, _, value) in self._latest.items()}
        self._count(now, packet.sequence)
        value = packet.value
        if value is None:
            return None
        kind, sequence = type(value), packet.sequence
        if isinstance(value, Heartbeat) and value.kind is Kind.UNKNOWN and value.autopilot == 8:
            return None  # MAV_AUTOPILOT_INVALID: the sender is no autopilot
        kept = self._latest.get(kind)
        late = kept is not None and now - kept[0] < OLD and (sequence - kept[1]) % 256 > 128
        if late and kept is not None and kept[1] != NO_NUMBER:
            if isinstance(value, _STAMPED):
                self._clock.passed_over(now, value.time_boot_s)
            return None
        if isinstance(value, _STAMPED):
            if not self._timely(now, value):
                return None
            doubt = self._places.judge(value) if isinstance(value, GlobalPosition) else ""
            if doubt:
                self.odd[doubt] += 1
                self._age(now, doubt)
                return None
        elif kind in _WEIGHED:
            self._weigh(now, value)
        elif isinstance(value, Home):
            self.home = value
        self._latest[kind] = (now, sequence, value)
        return value

    @property
    def doubt(self) -> str:
        """Why positions do not count now, as `odd` counts them; "" while they do."""
        return self._places.doubt

    @property
    def batteries(self) -> tuple[Gauged, ...]:
        """What each battery said last."""
        return self._batteries.each

    def two_clocks(self, now: float) -> bool:
        """Whether two autopilots seem to speak under this system id."""
        return self._clock.two_clocks(now)

    def _forget(self) -> None:
        """Forget what was heard: of an autopilot that has started again nothing of it holds."""
        self._latest.clear()
        self._places = PlaceWatch()
        self._estimator, self._fix, self._batteries = EstimatorWatch(), Recent(), Batteries()

    def _timely(self, now: float, value: GlobalPosition | Attitude) -> bool:
        """Whether a stamped value is not older than the newest of its kind; notices a restart."""
        stamp = self._clock.judge(now, value.time_boot_s)
        if stamp is Stamp.RESTART:
            self._reboots += 1
            self._forget()
        kept = self._latest.get(type(value))
        newest = kept[2].time_boot_s if kept and isinstance(kept[2], (GlobalPosition, Attitude)) else NEVER
        late = value.time_boot_s < newest <= value.time_boot_s + FALL
        if late or stamp is Stamp.ODD:
            self.odd["late" if late else stamp.value] += 1
            return False
        return True

    def _age(self, now: float, doubt: str) -> None:
        """A place found frozen now has not been known since it froze."""
        at, sequence, value = self._latest.get(GlobalPosition, (NEVER, 0, BLANK[GlobalPosition]))
        if doubt == "position_frozen":
            self._latest[GlobalPosition] = (min(at, now - LEAST), sequence, value)

    def _weigh(self, now: float, value: Value) -> None:
        """Take in a report of which the last few are judged together."""
        if isinstance(value, EkfStatus):
            self._estimator.take(now, value)
        elif isinstance(value, GpsFix):
            self._fix.take(value.fix)
        elif isinstance(value, Battery):
            self._batteries.take(now, value)
        elif isinstance(value, SysStatus):
            self._batteries.take_status(value)

    def snapshot(self) -> Telemetry:
        """Return what is known now."""
        heard = self._latest.get
        heart_at, _, heart = heard(Heartbeat) or NOTHING[Heartbeat]
        place_at, _, place = heard(GlobalPosition) or NOTHING[GlobalPosition]
        tilt_at, _, tilt = heard(Attitude) or NOTHING[Attitude]
        air_at, _, air = heard(AirData) or NOTHING[AirData]
        wind_at, _, wind = heard(Wind) or NOTHING[Wind]
        status_at, _, status = heard(SysStatus) or NOTHING[SysStatus]
        pack_at = self._latest[Battery][0] if Battery in self._latest else NEVER
        gps_at, _, gps = heard(GpsFix) or NOTHING[GpsFix]
        ekf_at = (heard(EkfStatus) or NOTHING[EkfStatus])[0]
        landed_at, _, landed = heard(ExtendedState) or NOTHING[ExtendedState]
        sticks_at, _, sticks = heard(RcChannels) or NOTHING[RcChannels]
        where = (place.latitude_deg, place.longitude_deg, place.altitude_m)
        placed = self.frame is not None and place_at != NEVER
        position = self.frame.ned_from_geodetic(*where) if self.frame is not None and placed else ZERO
        packs, fix = self._batteries, 0 if gps_at == NEVER else round(self._fix.value)
        estimated = ekf_at != NEVER and self._estimator.ok
        telemetry = new(Telemetry, (  # its fields in their order: five times as fast as by name
            heart.kind, heart.mode, heart.armed, heart_at, heart.status, self._clock.boot_s,
            *where, place.above_home_m, position, placed, place.velocity, place_at,
            tilt.roll, tilt.pitch, tilt.yaw, tilt_at, air.airspeed, air_at, wind.velocity, wind_at,
            packs.share, packs.voltage, max(pack_at, status_at),
            status.pre_arm_ok, status.unhealthy, status_at,
            fix, gps.satellites, gps.accuracy_m, gps_at, estimated, ekf_at,
            sticks.pulses, sticks_at, landed.landed_state, landed_at, self._reboots, self._quality,
        ))  # fmt: skip
        return telemetry

    def _count(self, now: float, sequence: int) -> None:
        """Keep the running share of frames that arrived, by the gaps in their numbers."""
        gap = (sequence - self._sequence - 1) % 256
        if self._heard_at == NEVER or now - self._heard_at > OLD:
            gap = 0  # how many a longer silence cost cannot be known: ages tell of it
        if gap < 128:
            self._quality = (1.0 - QUALITY) ** gap * self._quality
            self._quality += QUALITY * (1.0 - self._quality)
            self._sequence = sequence
        self._heard_at = now
