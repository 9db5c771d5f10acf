"""What agents send to autopilots, and stations to others: typed values in SI and NED, builders of commands.

`encoding` turns them into the wire's units, `frames.Sender` into frames.
"""

from __future__ import annotations

from math import degrees, nan
from typing import NamedTuple

from onboard.core.math.vectors import Vec
from onboard.wire.geodesy import Geodetic
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.ids import AUTOPILOT, CommandId
from onboard.wire.mavlink.values import AdsbVehicle, Timesync


class Target(NamedTuple):
    """Whom a message is for."""

    system: int
    component: int = AUTOPILOT


class OwnHeartbeat(NamedTuple):
    """HEARTBEAT of the agent: an active onboard controller that is no autopilot."""


class CommandLong(NamedTuple):
    """COMMAND_LONG."""

    to: Target
    command: int  # MAV_CMD
    params: tuple[float, ...] = ()  # up to seven, the rest is sent as 0
    confirmation: int = 0  # how often this very command was sent before


class CommandInt(NamedTuple):
    """COMMAND_INT."""

    to: Target
    command: int  # MAV_CMD
    frame: int  # MAV_FRAME
    params: tuple[float, ...] = ()  # up to four, the rest is sent as 0
    x: int = 0  # [degE7] latitude
    y: int = 0  # [degE7] longitude
    z: float = 0.0  # [m]


class VelocityTarget(NamedTuple):
    """SET_POSITION_TARGET_LOCAL_NED with a velocity, for a multicopter.

    Never for a plane: it takes such a message for an altitude of 0.
    """

    to: Target
    time_boot_s: float  # the autopilot's clock [s]
    velocity: Vec  # [m/s; ground, NED]
    yaw: float | None = None  # [rad, north to east] where the vehicle looks; None: not commanded


class PlaceTarget(NamedTuple):
    """SET_POSITION_TARGET_GLOBAL_INT with a place alone, for a PX4 plane in OFFBOARD.

    Never for an ArduPlane: of such a message it takes the altitude alone.
    """

    to: Target
    time_boot_s: float  # the autopilot's clock [s]
    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level


class RollTarget(NamedTuple):
    """SET_ATTITUDE_TARGET with a roll angle alone, for an ArduPlane in GUIDED.

    The plane keeps altitude and speed by itself; the target lapses after 3 s.
    """

    to: Target
    time_boot_s: float  # the autopilot's clock [s]
    roll: float  # [rad, right positive]


class ParamRead(NamedTuple):
    """PARAM_REQUEST_READ by name."""

    to: Target
    name: str


SetpointMessage = VelocityTarget | RollTarget | PlaceTarget
"""A message of the stream of setpoints: only the newest one counts."""
class SetupSigning(NamedTuple):
    """SETUP_SIGNING: the key in clear, so over a wire alone."""

    to: Target
    key: bytes  # 32 bytes
    stamp: int  # [10 µs since 2015] the autopilot takes nothing older


class AdsbHeartbeat(NamedTuple):
    """HEARTBEAT of a component that reports traffic."""


Outgoing = (
    OwnHeartbeat | CommandLong | CommandInt | SetpointMessage | ParamRead | Timesync | SetupSigning
    | AdsbVehicle | AdsbHeartbeat
)  # fmt: skip
"""Everything that agents and stations send. A `Timesync` with `answered_ns` 0 is a question."""


def set_message_interval(to: Target, message: int, rate_hz: float) -> CommandLong:
    """Ask for a message (by its number) at a rate [Hz]; 0 stops it."""
    interval_us = round(1e6 / rate_hz) if rate_hz > 0.0 else -1
    return CommandLong(to, CommandId.SET_MESSAGE_INTERVAL, (message, interval_us))


def get_message_interval(to: Target, message: int) -> CommandLong:
    """Ask at which interval a message (by its number) is sent: the answer is MESSAGE_INTERVAL."""
    return CommandLong(to, CommandId.GET_MESSAGE_INTERVAL, (message,))


def request_message(to: Target, message: int) -> CommandLong:
    """Ask for a message (by its number) once."""
    return CommandLong(to, CommandId.REQUEST_MESSAGE, (message,))


def change_heading(to: Target, course: float, acceleration: float) -> CommandInt:
    """Command a course [rad] over ground with a lateral acceleration [m/s²] (43002). It never lapses."""
    wanted = round(degrees(course) % 360.0, 2)
    wanted = wanted if wanted < 360.0 else 0.0  # ArduPlane denies 360 itself
    params = (dialect.HEADING_TYPE_COURSE_OVER_GROUND, wanted, acceleration)
    return CommandInt(to, CommandId.CHANGE_HEADING, dialect.MAV_FRAME_GLOBAL, params)


def change_altitude(to: Target, altitude_m: float) -> CommandInt:
    """Command an altitude [m above mean sea level], reached as fast as the plane may climb (43001)."""
    z = altitude_m if abs(altitude_m) > 0.01 else 0.01  # ArduPlane denies 0
    return CommandInt(to, CommandId.CHANGE_ALTITUDE, dialect.MAV_FRAME_GLOBAL, z=z)


def change_speed(to: Target, airspeed: float) -> CommandInt:
    """Command an airspeed [m/s], reached as fast as the plane may accelerate (43000)."""
    params = (dialect.SPEED_TYPE_AIRSPEED, airspeed)
    return CommandInt(to, CommandId.CHANGE_SPEED, dialect.MAV_FRAME_GLOBAL, params)


def set_mode(to: Target, mode: int, *, px4: bool) -> CommandLong:
    """Ask for a custom mode (176); `px4`: main and sub mode go in two parameters."""
    custom = dialect.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED
    params = (custom, mode >> 16 & 0xFF, mode >> 24 & 0xFF) if px4 else (custom, mode)
    return CommandLong(to, CommandId.SET_MODE, params)


def arm(to: Target) -> CommandLong:
    """Ask for arming (400), never by force."""
    return CommandLong(to, CommandId.ARM, (1.0, 0.0))


def takeoff(to: Target, height_m: float, place: float = 0.0) -> CommandLong:
    """Ask for a take-off (22) to a height [m]: above home for ArduCopter, above sea level for PX4.

    `place` stands for yaw, latitude and longitude: NaN where PX4 is to rise from where it stands."""
    return CommandLong(to, CommandId.TAKE_OFF, (0.0, 0.0, 0.0, place, place, place, height_m))


def reposition(to: Target, place: Geodetic) -> CommandInt:
    """Ask to go to a place and stay there, in the autopilot's own mode for that (192)."""
    params = (-1.0, float(dialect.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE), 0.0, nan)
    x, y = round(place.latitude_deg * 1e7), round(place.longitude_deg * 1e7)
    return CommandInt(
        to, CommandId.REPOSITION, dialect.MAV_FRAME_GLOBAL, params, x=x, y=y, z=place.altitude_m
    )
