"""Who else speaks on a vehicle's link: a gimbal of the same system, and a second ground station.

Both reach the autopilot and, through its router, everybody on its links.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.math.constants import NS_PER_S
from onboard.wire.mavlink.dialect import MavMessage, dialect
from sim_bridge.vehicle.autopilot.setup import Options

GIMBAL: int = dialect.MAV_COMP_ID_GIMBAL
STATION = (254, 190)  # system and component of the second ground station
ASK_AGAIN_NS = 5 * NS_PER_S  # the second station repeats its REQUEST_DATA_STREAM so often


class Voice(NamedTuple):
    """One message of a neighbour."""

    system: int
    component: int
    message: MavMessage


class Company:
    """The neighbours that the options ask for, each with its heartbeat at 1 Hz."""

    def __init__(self, options: Options, system: int, now_ns: int) -> None:
        self._system = system
        self._gimbal = options.gimbal
        self._hz = round(options.other_station_hz)
        self._beat_ns = now_ns
        self._ask_ns = now_ns

    @property
    def alone(self) -> bool:
        """Whether nobody else speaks."""
        return not self._gimbal and not self._hz

    def step(self, now_ns: int) -> list[Voice]:
        """What is said now."""
        if not self._gimbal and not self._hz:
            return []
        said: list[Voice] = []
        if now_ns >= self._beat_ns:
            self._beat_ns += NS_PER_S
            if self._gimbal:
                beat = dialect.MAVLink_heartbeat_message(
                    dialect.MAV_TYPE_GIMBAL, dialect.MAV_AUTOPILOT_INVALID, 0, 0, dialect.MAV_STATE_ACTIVE, 3
                )
                said.append(Voice(self._system, GIMBAL, beat))
            if self._hz:
                beat = dialect.MAVLink_heartbeat_message(
                    dialect.MAV_TYPE_GCS, dialect.MAV_AUTOPILOT_INVALID, 0, 0, dialect.MAV_STATE_ACTIVE, 3
                )
                said.append(Voice(*STATION, beat))
        if self._hz and now_ns >= self._ask_ns:
            self._ask_ns += ASK_AGAIN_NS
            ask = dialect.MAVLink_request_data_stream_message(
                self._system, 1, dialect.MAV_DATA_STREAM_ALL, self._hz, 1
            )
            said.append(Voice(*STATION, ask))
        return said
