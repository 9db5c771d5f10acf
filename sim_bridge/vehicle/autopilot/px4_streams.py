"""What PX4 1.16 streams by default on a companion's link: 22 kB/s, most of which no agent reads.

Rates as PX4's Onboard mode has them. The contents nobody reads are of the right size and roughly true.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import cos, nan, sin

from onboard.core.math.constants import STANDARD_GRAVITY
from onboard.wire.mavlink.dialect import MavMessage, dialect
from sim_bridge.vehicle.autopilot.state import AutopilotState

SEA_LEVEL_HPA = 1013.25

FULL_RATES: Mapping[int, float] = {
    dialect.MAVLINK_MSG_ID_ATTITUDE: 100.0,
    dialect.MAVLINK_MSG_ID_ATTITUDE_QUATERNION: 50.0,
    dialect.MAVLINK_MSG_ID_HIGHRES_IMU: 50.0,
    dialect.MAVLINK_MSG_ID_LOCAL_POSITION_NED: 30.0,
    dialect.MAVLINK_MSG_ID_ODOMETRY: 30.0,
    dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT: 10.0,
    dialect.MAVLINK_MSG_ID_ALTITUDE: 10.0,
    dialect.MAVLINK_MSG_ID_ATTITUDE_TARGET: 10.0,
    dialect.MAVLINK_MSG_ID_POSITION_TARGET_LOCAL_NED: 10.0,
    dialect.MAVLINK_MSG_ID_SERVO_OUTPUT_RAW: 10.0,
    dialect.MAVLINK_MSG_ID_VFR_HUD: 10.0,
    dialect.MAVLINK_MSG_ID_GPS_RAW_INT: 10.0,
    dialect.MAVLINK_MSG_ID_RC_CHANNELS: 10.0,
    dialect.MAVLINK_MSG_ID_SYS_STATUS: 1.0,
    dialect.MAVLINK_MSG_ID_EXTENDED_SYS_STATE: 5.0,
    dialect.MAVLINK_MSG_ID_BATTERY_STATUS: 0.5,
    dialect.MAVLINK_MSG_ID_ESTIMATOR_STATUS: 1.0,
    dialect.MAVLINK_MSG_ID_SYSTEM_TIME: 1.0,
    dialect.MAVLINK_MSG_ID_WIND_COV: 10.0,
    dialect.MAVLINK_MSG_ID_HOME_POSITION: 0.5,
}


def highres_imu(ap: AutopilotState, now_ns: int) -> MavMessage:
    """HIGHRES_IMU: the accelerations of rest, turn rates, no field."""
    r = ap.motion.rates
    message: MavMessage = dialect.MAVLink_highres_imu_message(
        ap.boot_ms(now_ns) * 1000, 0.0, 0.0, -STANDARD_GRAVITY, r.x, r.y, r.z, 0.0, 0.0, 0.0, SEA_LEVEL_HPA,
        0.0, ap.place.altitude_m, 25.0, 0x1FFF,
    )  # fmt: skip
    return message


def odometry(ap: AutopilotState, now_ns: int) -> MavMessage | None:
    """ODOMETRY: place and velocity in the local frame, the attitude by its yaw; None without a position."""
    if not ap.positioned(now_ns):
        return None
    p, m = ap.local.ned_from_geodetic(*ap.place), ap.motion
    half = 0.5 * m.yaw
    unknown = [nan] + [0.0] * 20
    message: MavMessage = dialect.MAVLink_odometry_message(
        ap.boot_ms(now_ns) * 1000, dialect.MAV_FRAME_LOCAL_NED, dialect.MAV_FRAME_BODY_FRD, *p,
        [cos(half), 0.0, 0.0, sin(half)], *m.velocity, *m.rates, unknown, unknown,
    )  # fmt: skip
    return message


def attitude_target(ap: AutopilotState, now_ns: int) -> MavMessage:
    """ATTITUDE_TARGET: what is flown, for what is sought."""
    half = 0.5 * ap.motion.yaw
    message: MavMessage = dialect.MAVLink_attitude_target_message(
        ap.boot_ms(now_ns), 0, [cos(half), 0.0, 0.0, sin(half)], 0.0, 0.0, 0.0, 0.5
    )
    return message


def position_target(ap: AutopilotState, now_ns: int) -> MavMessage:
    """POSITION_TARGET_LOCAL_NED: what is flown, for what is sought."""
    p, v = ap.local.ned_from_geodetic(*ap.place), ap.motion.velocity
    message: MavMessage = dialect.MAVLink_position_target_local_ned_message(
        ap.boot_ms(now_ns), dialect.MAV_FRAME_LOCAL_NED, 0, *p, *v, 0.0, 0.0, 0.0, ap.motion.yaw, 0.0
    )
    return message


def servo_output(ap: AutopilotState, now_ns: int) -> MavMessage:
    """SERVO_OUTPUT_RAW: four motors at half throttle in flight, off on the ground."""
    pwm = 1000 if ap.landed else 1500
    message: MavMessage = dialect.MAVLink_servo_output_raw_message(
        ap.boot_ms(now_ns) * 1000 & 0xFFFFFFFF, 0, pwm, pwm, pwm, pwm, 0, 0, 0, 0
    )
    return message


UNREAD: dict[int, Callable[[AutopilotState, int], MavMessage | None]] = {
    dialect.MAVLINK_MSG_ID_HIGHRES_IMU: highres_imu,
    dialect.MAVLINK_MSG_ID_ODOMETRY: odometry,
    dialect.MAVLINK_MSG_ID_ATTITUDE_TARGET: attitude_target,
    dialect.MAVLINK_MSG_ID_POSITION_TARGET_LOCAL_NED: position_target,
    dialect.MAVLINK_MSG_ID_SERVO_OUTPUT_RAW: servo_output,
}
"""Messages of PX4 that no agent reads, by number."""
