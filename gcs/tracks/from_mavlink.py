"""Reports in MAVLink messages: an autopilot's own position, ADS-B, and Open Drone ID. Pure."""

from __future__ import annotations

from gcs.tracks.report import Height, Report, named
from onboard.wire.mavlink.frames import Packet
from onboard.wire.mavlink.values import AdsbVehicle, DroneIdentity, DroneLocation, GlobalPosition

ADSB_SIGMA = 30.0  # [m] what a position of a small ADS-B transmitter is worth, unless told
OWN_SIGMA = 5.0  # [m] of an autopilot's own estimate
DRONES_MAX = 1024  # transmitters of Open Drone ID whose identity is remembered


class MavlinkReports:
    """Give it packets as they arrive; it gives reports.

    The numbers of targets are: a system id (`7`), an ICAO address (`4CA7B3`), an Open Drone ID (the UAS id,
    or the transmitter's address before that is heard).
    """

    def __init__(self) -> None:
        self._identities: dict[bytes, str] = {}

    def take(self, packet: Packet, now: float) -> Report | None:
        """The report of a packet that arrived at `now` [s]; None for one that reports nothing."""
        value = packet.value
        if isinstance(value, GlobalPosition):
            if packet.component != 1:
                return None  # what a camera or another component repeats
            return Report(now, str(packet.system), value.latitude_deg, value.longitude_deg, value.altitude_m,
                          value.velocity, OWN_SIGMA)  # fmt: skip
        if isinstance(value, AdsbVehicle):
            return _adsb(value, now)
        if isinstance(value, DroneIdentity):
            if value.transmitter in self._identities or len(self._identities) < DRONES_MAX:
                self._identities[value.transmitter] = named(value.uas_id)
        elif isinstance(value, DroneLocation):
            number = self._identities.get(value.transmitter) or value.transmitter.hex().upper()
            above = Height.PRESSURE if value.pressure else Height.ELLIPSOID
            sigma = value.accuracy_m if value.accuracy_m >= 0.0 else ADSB_SIGMA
            return Report(now, number, value.latitude_deg, value.longitude_deg, value.altitude_m,
                          value.velocity, sigma, above)  # fmt: skip
        return None


def _adsb(value: AdsbVehicle, now: float) -> Report | None:
    if not value.position_valid:
        return None
    velocity = value.velocity if value.velocity_valid else None
    return Report(
        now - value.age_s, f"{value.icao:06X}", value.latitude_deg, value.longitude_deg, value.altitude_m,
        velocity, ADSB_SIGMA, Height.ELLIPSOID if value.geometric else Height.PRESSURE,
    )  # fmt: skip
