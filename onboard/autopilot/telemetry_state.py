"""What is known of one autopilot: each packet is taken in, `snapshot` is read when a decision is due.

Only packets of the autopilot's own component count, so that the heartbeat of a ground station that a router
passes on cannot change the vehicle's mode. A frame that a link delivers late does not replace a newer one.
"""

from __future__ import annotations

from typing import TypeVar, cast

from onboard.autopilot.base import Telemetry
from onboard.core.math.constants import NEVER
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
REBOOT = 3.0  # [s] by which the autopilot's clock must fall back to count as a restart
NO_NUMBER = -1  # of a frame that came over another link
QUALITY = 0.005  # weight of one frame in the running link quality: about the last 200

BLANK: dict[type, Value] = {
    Heartbeat: Heartbeat(Kind.UNKNOWN, 0, 0, 0, "", False, 0),
    GlobalPosition: GlobalPosition(0.0, 0.0, 0.0, 0.0, 0.0, ZERO),
    Attitude: Attitude(0.0, 0.0, 0.0, 0.0, ZERO),
    AirData: AirData(0.0, 0.0, 0.0, 0.0, 0.0),
    Wind: Wind(Vec(0.0, 0.0, 0.0)),
    SysStatus: SysStatus(UNKNOWN, UNKNOWN, False, False, 0, 0.0, 0.0),
    Battery: Battery(0, UNKNOWN, UNKNOWN, UNKNOWN),
    GpsFix: GpsFix(0, -1, UNKNOWN, UNKNOWN),
    EkfStatus: EkfStatus(0, False, 0.0),
    ExtendedState: ExtendedState(0, 0),
    RcChannels: RcChannels(()),
}
V = TypeVar("V")


class Observer:
    """Latest values of one autopilot, with the instants they came [s, monotonic]."""

    def __init__(self, system: int, component: int = AUTOPILOT) -> None:
        self.system = system
        self.component = component
        self.frame: Frame | None = None  # the game frame, when the setup is known
        self.home: Home | None = None
        self._latest: dict[type, tuple[float, int, Value]] = {}  # kind → (arrival, sequence, value)
        self._link = 0
        self._boot_s = 0.0
        self._reboots = 0
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
        if isinstance(value, Heartbeat) and value.kind is Kind.UNKNOWN and value.autopilot == 8:
            return None  # MAV_AUTOPILOT_INVALID: the sender is no autopilot
        kept = self._latest.get(type(value))
        late = kept is not None and now - kept[0] < OLD and (packet.sequence - kept[1]) % 256 > 128
        if late and kept is not None and kept[1] != NO_NUMBER:
            return None
        if isinstance(value, Home):
            self.home = value
        if isinstance(value, (GlobalPosition, Attitude)):
            if value.time_boot_s < self._boot_s - REBOOT:
                self._reboots += 1
                self._latest.clear()  # what was heard before the restart no longer holds
                self._boot_s = value.time_boot_s
            self._boot_s = max(self._boot_s, value.time_boot_s)
        self._latest[type(value)] = (now, packet.sequence, value)
        return value

    def snapshot(self) -> Telemetry:
        """Return what is known now."""
        heart_at, heart = self._of(Heartbeat)
        place_at, place = self._of(GlobalPosition)
        tilt_at, tilt = self._of(Attitude)
        air_at, air = self._of(AirData)
        wind_at, wind = self._of(Wind)
        status_at, status = self._of(SysStatus)
        pack_at, pack = self._of(Battery)
        gps_at, gps = self._of(GpsFix)
        ekf_at, ekf = self._of(EkfStatus)
        landed_at, landed = self._of(ExtendedState)
        sticks_at, sticks = self._of(RcChannels)
        where = (place.latitude_deg, place.longitude_deg, place.altitude_m)
        placed = self.frame is not None and place_at != NEVER
        return Telemetry(
            kind=heart.kind,
            mode=heart.mode,
            armed=heart.armed,
            heartbeat_at=heart_at,
            status=heart.status,
            time_boot_s=self._boot_s,
            latitude_deg=place.latitude_deg,
            longitude_deg=place.longitude_deg,
            altitude_m=place.altitude_m,
            above_home_m=place.above_home_m,
            position=self.frame.ned_from_geodetic(*where) if self.frame is not None and placed else ZERO,
            placed=placed,
            velocity=place.velocity,
            position_at=place_at,
            roll=tilt.roll,
            pitch=tilt.pitch,
            yaw=tilt.yaw,
            attitude_at=tilt_at,
            airspeed=air.airspeed,
            airspeed_at=air_at,
            wind=wind.velocity,
            wind_at=wind_at,
            battery=pack.remaining if pack.remaining >= 0.0 else status.battery,
            voltage=pack.voltage if pack.voltage >= 0.0 else status.voltage,
            battery_at=max(pack_at, status_at),
            pre_arm_ok=status.pre_arm_ok,
            unhealthy=status.unhealthy,
            status_at=status_at,
            gps_fix=gps.fix,
            satellites=gps.satellites,
            accuracy_m=gps.accuracy_m,
            gps_at=gps_at,
            ekf_ok=ekf.ok,
            ekf_at=ekf_at,
            channels=sticks.pulses,
            channels_at=sticks_at,
            landed_state=landed.landed_state,
            landed_at=landed_at,
            reboots=self._reboots,
            link_quality=self._quality,
        )

    def _of(self, kind: type[V]) -> tuple[float, V]:
        at, _, value = self._latest.get(kind) or (NEVER, 0, BLANK[kind])
        return at, cast(V, value)

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
