"""The parameters each personality is delivered with.

Names, types and values as ArduCopter and ArduPlane 4.5.6 and PX4 1.16 report them, of what the
simulation heeds or a ground station asks for; a real one has over a thousand.
"""

from __future__ import annotations

from sim_bridge.vehicle.autopilot.parameters import INT8, INT16, INT32, REAL32, Parameter


def _table(kinds: dict[int, dict[str, float]]) -> tuple[Parameter, ...]:
    return tuple(Parameter(n, value, kind) for kind, values in kinds.items() for n, value in values.items())


ARDUPILOT = _table(
    {
        INT8: {
            "SYSID_ENFORCE": 0, "BATT_MONITOR": 4, "BATT_FS_LOW_ACT": 0, "BATT_FS_CRT_ACT": 0,
            "BATT_LOW_TIMER": 10, "FENCE_TYPE": 7,
            "FENCE_ACTION": 1, "FENCE_ENABLE": 0, "FENCE_TOTAL": 0, "AHRS_EKF_TYPE": 3, "EK3_ENABLE": 1,
            "COMPASS_ENABLE": 1, "LOG_BACKEND_TYPE": 0, "SERIAL0_PROTOCOL": 2,
        },
        INT16: {
            "SYSID_THISMAV": 1, "SYSID_MYGCS": 255, "STAT_BOOTCNT": 1, "SCHED_LOOP_RATE": 50,
            "SR0_POSITION": 4, "SR0_EXTRA1": 4, "SR0_EXTRA2": 2, "SR0_EXTRA3": 1, "SR0_EXT_STAT": 1,
        },
        INT32: {"FLTMODE_GCSBLOCK": 0, "ARMING_CHECK": 1, "BATT_CAPACITY": 6000, "SERIAL0_BAUD": 115},
        REAL32: {
            "BATT_LOW_MAH": 0, "BATT_CRT_VOLT": 0, "BATT_CRT_MAH": 0, "FENCE_ALT_MAX": 100,
            "FENCE_RADIUS": 300, "SIM_WIND_SPD": 0, "SIM_WIND_DIR": 180,
        },
    }
)  # fmt: skip
ARDUCOPTER = ARDUPILOT + _table(
    {
        INT8: {
            "FRAME_CLASS": 1, "FRAME_TYPE": 0, "DISARM_DELAY": 10, "FS_GCS_ENABLE": 0, "FS_EKF_ACTION": 1,
            "FS_THR_ENABLE": 0, "FS_CRASH_CHECK": 1, "WP_YAW_BEHAVIOR": 2, "FLTMODE1": 7, "FLTMODE2": 9,
            "FLTMODE3": 6, "FLTMODE4": 3, "FLTMODE5": 5, "FLTMODE6": 0, "FLTMODE_CH": 5,
        },
        INT16: {
            "FORMAT_VERSION": 120, "THR_DZ": 100, "PILOT_SPEED_UP": 250, "PILOT_SPEED_DN": 0,
            "ANGLE_MAX": 3000, "LAND_SPEED": 50, "LAND_SPEED_HIGH": 0,
            "RTL_SPEED": 0, "RTL_ALT_FINAL": 0,
        },
        INT32: {"GUID_OPTIONS": 0, "FS_OPTIONS": 16, "RTL_ALT": 1500, "RTL_LOIT_TIME": 5000},
        REAL32: {
            "GUID_TIMEOUT": 3, "FS_GCS_TIMEOUT": 5, "WPNAV_SPEED": 1000, "WPNAV_SPEED_UP": 250,
            "WPNAV_SPEED_DN": 150, "WPNAV_ACCEL": 250, "WPNAV_RADIUS": 200, "LOIT_SPEED": 1250,
            "FS_EKF_THRESH": 0.8, "BATT_LOW_VOLT": 10.5,
        },
    }
)  # fmt: skip
ARDUPLANE = ARDUPILOT + _table(
    {
        INT8: {
            "ARMING_REQUIRE": 1, "FS_GCS_ENABL": 0, "THR_FAILSAFE": 1, "FS_LONG_ACTN": 0, "FS_SHORT_ACTN": 0,
            "RTL_AUTOLAND": 0, "ARSPD_TYPE": 2, "ARSPD_USE": 1, "TRIM_THROTTLE": 50,
            "STALL_PREVENTION": 1, "FLTMODE1": 10, "FLTMODE2": 11, "FLTMODE3": 12, "FLTMODE4": 5,
            "FLTMODE5": 2, "FLTMODE6": 0, "FLTMODE_CH": 8,
        },
        INT16: {
            "FORMAT_VERSION": 13, "AIRSPEED_MIN": 10, "AIRSPEED_MAX": 30, "WP_LOITER_RAD": 80,
            "WP_RADIUS": 50, "RTL_RADIUS": 0, "TKOFF_ALT": 100, "TKOFF_DIST": 200,
        },
        REAL32: {
            "AIRSPEED_CRUISE": 22, "ROLL_LIMIT_DEG": 65, "PTCH_LIM_MAX_DEG": 25, "PTCH_LIM_MIN_DEG": -20,
            "FS_LONG_TIMEOUT": 5, "FS_SHORT_TIMEOUT": 1.5, "RTL_ALTITUDE": 100, "TECS_CLMB_MAX": 5,
            "TECS_SINK_MAX": 5, "GUIDED_P": 5000, "GUIDED_D": 0, "NAVL1_PERIOD": 15, "BATT_LOW_VOLT": 0,
        },
    }
)  # fmt: skip
PX4_COMMON = _table(
    {
        INT32: {
            "MAV_SYS_ID": 1, "MAV_COMP_ID": 1, "COM_OBL_RC_ACT": 5, "COM_RC_OVERRIDE": 1,
            "COM_RC_IN_MODE": 1, "COM_RCL_EXCEPT": 4, "NAV_RCL_ACT": 2, "NAV_DLL_ACT": 0,
            "COM_DL_LOSS_T": 10, "COM_LOW_BAT_ACT": 0, "GF_ACTION": 2, "SDLOG_MODE": 0,
            "CAL_MAG0_ID": 197388, "CAL_GYRO0_ID": 1310988, "CAL_ACC0_ID": 1310988, "EKF2_EN": 1,
        },
        REAL32: {
            "COM_FAIL_ACT_T": 5.0, "COM_RC_LOSS_T": 0.5, "GF_MAX_HOR_DIST": 0.0, "GF_MAX_VER_DIST": 0.0,
            "COM_OF_LOSS_T": 1.0, "COM_DISARM_LAND": 2.0, "COM_DISARM_PRFLT": 10.0, "RTL_LAND_DELAY": 0.0,
            "BAT_LOW_THR": 0.15, "BAT_CRIT_THR": 0.07, "BAT_EMERGEN_THR": 0.05,
        },
    }
)  # fmt: skip
PX4 = PX4_COMMON + _table(
    {
        INT32: {"MAV_TYPE": 2, "SYS_AUTOSTART": 4001},
        REAL32: {
            "MIS_TAKEOFF_ALT": 2.5, "MPC_XY_VEL_MAX": 12.0, "MPC_XY_CRUISE": 5.0, "MPC_Z_VEL_MAX_UP": 3.0,
            "MPC_Z_VEL_MAX_DN": 1.5, "MPC_LAND_SPEED": 0.7, "RTL_RETURN_ALT": 30.0,
        },
    }
)  # fmt: skip
PX4_PLANE = PX4_COMMON + _table(
    {
        INT32: {"MAV_TYPE": 1, "SYS_AUTOSTART": 2106},
        REAL32: {
            "MIS_TAKEOFF_ALT": 30.0, "FW_AIRSPD_MIN": 10.0, "FW_AIRSPD_MAX": 20.0, "FW_AIRSPD_TRIM": 15.0,
            "FW_R_LIM": 50.0, "FW_P_LIM_MAX": 30.0, "FW_P_LIM_MIN": -30.0, "FW_T_CLMB_MAX": 8.0,
            "FW_T_SINK_MAX": 5.0, "NAV_LOITER_RAD": 80.0, "RTL_RETURN_ALT": 60.0,
        },
    }
)  # fmt: skip
