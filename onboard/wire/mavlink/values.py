"""What the agent reads from an autopilot: typed frozen values in SI, radians and NED."""

from __future__ import annotations

from typing import NamedTuple

from onboard.core.math.vectors import Vec
from onboard.wire.mavlink.modes import Kind

UNKNOWN = -1.0  # of a fraction, an age or an accuracy that is not reported


class Heartbeat(NamedTuple):
    """HEARTBEAT."""

    kind: Kind
    vehicle_type: int  # MAV_TYPE
    autopilot: int  # MAV_AUTOPILOT, 8 = this component is none
    custom_mode: int
    mode: str  # in the autopilot's own words
    armed: bool
    status: int  # MAV_STATE: 3 standby, 4 active, 5 critical, 6 emergency


class GlobalPosition(NamedTuple):
    """GLOBAL_POSITION_INT."""

    time_boot_s: float
    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level
    above_home_m: float
    velocity: Vec  # [m/s; ground, NED]


class Attitude(NamedTuple):
    """ATTITUDE."""

    time_boot_s: float
    roll: float  # [rad]
    pitch: float  # [rad, up]
    yaw: float  # [rad, north to east]
    rates: Vec  # [rad/s; body x, y, z]


class AirData(NamedTuple):
    """VFR_HUD."""

    airspeed: float  # [m/s]
    groundspeed: float  # [m/s]
    climb: float  # [m/s, up]
    throttle: float  # 0…1
    altitude_m: float  # above mean sea level


class Wind(NamedTuple):
    """WIND (ArduPilot: where it comes from) or WIND_COV (PX4): one sense for both."""

    velocity: Vec  # [m/s; NED] of the air over ground: where it moves to


class SysStatus(NamedTuple):
    """SYS_STATUS."""

    battery: float  # 0…1, −1 = unknown
    voltage: float  # [V], −1 = unknown
    pre_arm_known: bool  # the autopilot reports its pre-arm checks
    pre_arm_ok: bool  # not sufficient for arming: it may be refused for many seconds more
    unhealthy: int  # MAV_SYS_STATUS_SENSOR bits that are enabled but not healthy
    load: float  # 0…1
    drop_rate: float  # 0…1 of what the autopilot should have received


class Battery(NamedTuple):
    """BATTERY_STATUS."""

    id: int
    remaining: float  # 0…1, −1 = unknown
    voltage: float  # [V] of the pack, −1 = unknown
    time_left_s: float  # −1 = unknown
    function: int = 0  # MAV_BATTERY_FUNCTION: 0 unknown, 1 all, 2 propulsion, 3 avionics, 4 payload


class GpsFix(NamedTuple):
    """GPS_RAW_INT."""

    fix: int  # 0–1 none, 2 two-dimensional, 3 three-dimensional, 4 DGPS, 5–6 RTK
    satellites: int  # −1 = unknown
    hdop: float  # −1 = unknown
    accuracy_m: float  # horizontal, −1 = unknown


class EkfStatus(NamedTuple):
    """EKF_STATUS_REPORT (ArduPilot) or ESTIMATOR_STATUS (PX4)."""

    flags: int  # up to 512 the same in both
    ok: bool  # attitude, velocity, absolute position estimated, no fault set, no test ratio above 1
    worst: float  # the largest of the test ratios
    estimated: bool = True  # attitude, velocity and absolute position, and not at rest by assumption

    @property
    def rejecting(self) -> bool:
        """Whether only a rejected measurement makes it not good: one such report says little."""
        return self.estimated and not self.ok


class ExtendedState(NamedTuple):
    """EXTENDED_SYS_STATE."""

    vtol_state: int
    landed_state: int  # 0 unknown, 1 on ground, 2 in air, 3 taking off, 4 landing


class CommandAck(NamedTuple):
    """COMMAND_ACK."""

    command: int
    result: int  # MAV_RESULT: 0 accepted, 1 later, 2 denied, 3 unsupported, 4 failed, 5 in progress
    target_system: int
    target_component: int


class StatusText(NamedTuple):
    """STATUSTEXT."""

    severity: int  # 0 emergency … 7 debug
    text: str
    id: int  # not 0: a chunk of a longer text
    chunk: int


class Home(NamedTuple):
    """HOME_POSITION."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level


class ParamValue(NamedTuple):
    """PARAM_VALUE."""

    name: str
    value: float  # ArduPilot's reading: the number itself
    bytewise: float  # PX4's reading: the bytes of the float are those of an integer type
    kind: int  # MAV_PARAM_TYPE
    total: int  # of the autopilot's parameters
    number: int  # of this one among them, 65535 = not said


class Version(NamedTuple):
    """AUTOPILOT_VERSION."""

    capabilities: int  # MAV_PROTOCOL_CAPABILITY
    flight: tuple[int, int, int, int]  # major, minor, patch, kind (255 = release)
    board: int
    uid: int


class Timesync(NamedTuple):
    """TIMESYNC: a request where `answered_ns` is 0."""

    answered_ns: int  # tc1
    asked_ns: int  # ts1


class AdsbVehicle(NamedTuple):
    """ADSB_VEHICLE."""

    icao: int
    callsign: str
    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above mean sea level, or of the standard atmosphere: see `geometric`
    geometric: bool
    velocity: Vec  # [m/s; ground, NED]
    age_s: float  # since it was last heard
    position_valid: bool
    velocity_valid: bool


class DroneIdentity(NamedTuple):
    """OPEN_DRONE_ID_BASIC_ID."""

    transmitter: bytes  # whose broadcast it is: the address of its radio
    uas_id: str


class DroneLocation(NamedTuple):
    """OPEN_DRONE_ID_LOCATION."""

    transmitter: bytes
    latitude_deg: float
    longitude_deg: float
    altitude_m: float  # above the ellipsoid of WGS-84, or of the standard atmosphere: see `pressure`
    pressure: bool
    velocity: Vec | None  # [m/s; ground, NED]
    accuracy_m: float  # horizontal, one sigma an axis; −1 = unknown


class RcChannels(NamedTuple):
    """RC_CHANNELS."""

    pulses: tuple[int, ...]  # [µs] of the channels that the receiver hears, channel 1 first


class MessageInterval(NamedTuple):
    """MESSAGE_INTERVAL."""

    number: int  # of the message
    interval_s: float  # between two; 0: it is not sent


class RadioStatus(NamedTuple):
    """RADIO_STATUS of a telemetry radio."""

    buffer_free: float  # 0…1 of its transmit buffer
    rssi: int
    remote_rssi: int
    errors: int


Value = (
    Heartbeat
    | GlobalPosition
    | Attitude
    | AirData
    | Wind
    | SysStatus
    | Battery
    | GpsFix
    | EkfStatus
    | ExtendedState
    | CommandAck
    | StatusText
    | Home
    | ParamValue
    | Version
    | Timesync
    | AdsbVehicle
    | DroneIdentity
    | DroneLocation
    | RadioStatus
    | MessageInterval
    | RcChannels
)
