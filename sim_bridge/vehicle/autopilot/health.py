"""Battery, satellites and estimator of a simulated vehicle, and what can be done to them."""

from __future__ import annotations

from enum import Enum

from onboard.wire.mavlink.dialect import dialect

CELLS = 3
CELL_FULL, CELL_EMPTY = 4.2, 3.4  # [V]
CURRENT_FLYING, CURRENT_IDLE = 18.0, 0.5  # [A]

SENSOR_GPS: int = dialect.MAV_SYS_STATUS_SENSOR_GPS
SENSOR_AHRS: int = dialect.MAV_SYS_STATUS_AHRS
SENSOR_BATTERY: int = dialect.MAV_SYS_STATUS_SENSOR_BATTERY
PREARM: int = dialect.MAV_SYS_STATUS_PREARM_CHECK
SENSORS: int = (
    dialect.MAV_SYS_STATUS_SENSOR_3D_GYRO
    | dialect.MAV_SYS_STATUS_SENSOR_3D_ACCEL
    | dialect.MAV_SYS_STATUS_SENSOR_3D_MAG
    | dialect.MAV_SYS_STATUS_SENSOR_ABSOLUTE_PRESSURE
    | SENSOR_GPS
    | SENSOR_AHRS
    | SENSOR_BATTERY
    | PREARM
)

_ALL_ESTIMATES = (
    dialect.EKF_ATTITUDE
    | dialect.EKF_VELOCITY_HORIZ
    | dialect.EKF_VELOCITY_VERT
    | dialect.EKF_POS_HORIZ_REL
    | dialect.EKF_POS_HORIZ_ABS
    | dialect.EKF_POS_VERT_ABS
    | dialect.EKF_PRED_POS_HORIZ_REL
    | dialect.EKF_PRED_POS_HORIZ_ABS
)
_NO_POSITION = (
    dialect.EKF_ATTITUDE | dialect.EKF_VELOCITY_VERT | dialect.EKF_POS_VERT_ABS | dialect.EKF_CONST_POS_MODE
)


def pack_voltage(charge: float) -> float:
    """Voltage of a pack at a charge of 0…1 [V]."""
    return CELLS * (CELL_EMPTY + (CELL_FULL - CELL_EMPTY) * charge)


class Fault(Enum):
    """What can be made to fail, and to recover."""

    GPS = "gps"  # no fix: and with it no position
    EKF = "ekf"  # estimator without position though satellites are there


class Health:
    """Batteries and failures of one vehicle's sensors."""

    def __init__(self, battery_s: float, batteries: int = 1) -> None:
        self.battery = 1.0  # of the charge of the first battery, which flies it
        self.payload: float | None = 1.0 if batteries > 1 else None  # … of the second, which feeds a payload
        self.sag = 0.0  # voltage that is missing beside the charge: a bad cell [V]
        self.faults: set[Fault] = set()
        self.drain_rate = 1.0 / battery_s  # [1/s] in flight

    def drain(self, dt: float, flying: bool, steps: int = 1) -> None:
        """Use the battery for so many steps of `dt` seconds each."""
        share = 1.0 if flying else CURRENT_IDLE / CURRENT_FLYING
        used, left = self.drain_rate * share * dt, self.battery
        for _ in range(steps):
            left -= used
        self.battery = left if left > 0.0 else 0.0

    @property
    def voltage(self) -> float:
        """Voltage of the battery pack [V]."""
        return max(0.0, pack_voltage(self.battery) - self.sag)

    @property
    def gps(self) -> bool:
        """Whether satellites give a fix."""
        return Fault.GPS not in self.faults

    @property
    def positioned(self) -> bool:
        """Whether the estimator knows where it is."""
        return not self.faults

    def ekf_flags(self, positioned: bool) -> int:
        """EKF_STATUS_REPORT.flags; ESTIMATOR_STATUS has the same bits."""
        flags: int = _ALL_ESTIMATES if positioned else _NO_POSITION
        return flags

    def sensor_health(self, gps: bool, positioned: bool, prearm: bool) -> int:
        """Bits of the healthy sensors, as SYS_STATUS.onboard_control_sensors_health has them."""
        bad = (0 if gps else SENSOR_GPS) | (0 if positioned else SENSOR_AHRS) | (0 if prearm else PREARM)
        return SENSORS & ~bad & ~(SENSOR_BATTERY if self.battery <= 0.0 else 0)
