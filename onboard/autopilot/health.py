"""What the autopilot says of its own health, in words: for readiness, for the supervisor, for a person."""

from __future__ import annotations

from typing import NamedTuple

from onboard.autopilot.base import Telemetry
from onboard.core.math.constants import NEVER

HEARTBEAT_AGE = 2.0  # [s]
TELEMETRY_AGE = 0.5  # [s]
REPORT_AGE = 5.0  # [s] of the slow reports: battery, GPS, estimator
GPS_3D = 3


class Thresholds(NamedTuple):
    """What counts as healthy."""

    heartbeat_age: float = HEARTBEAT_AGE  # [s]
    telemetry_age: float = TELEMETRY_AGE  # [s]
    report_age: float = REPORT_AGE  # [s]
    battery_min: float = 0.25  # 0…1
    voltage_min: float = 0.0  # [V] 0 = not judged
    satellites_min: int = 6
    accuracy_max: float = 5.0  # [m] horizontal


class Health(NamedTuple):
    """What is wrong with a vehicle; empty tuples mean good health."""

    lacks: tuple[str, ...]  # what must come before it may fly
    faults: tuple[str, ...]  # what is wrong
    battery_low: bool = False
    estimate_bad: bool = False  # GPS or EKF
    silent: bool = False  # heartbeat or telemetry too old


def read(now: float, telemetry: Telemetry, limits: Thresholds | None = None) -> Health:
    """Return the autopilot's health at `now` [s, monotonic].

    A report that never came is a lack; one that came and went silent is a fault. Of the estimator (EKF)
    nothing is demanded where the autopilot does not report it: then GPS alone is judged.
    """
    limit = limits or Thresholds()
    lacks: list[str] = []
    faults: list[str] = []

    def fresh(at: float, age: float, what: str) -> bool:
        if at == NEVER:
            lacks.append(f"no {what}")
        elif now - at > age:
            faults.append(f"{what} {now - at:.1f} s old")
        return at != NEVER and now - at <= age

    alive = fresh(telemetry.heartbeat_at, limit.heartbeat_age, "heartbeat")
    alive &= fresh(telemetry.position_at, limit.telemetry_age, "position")
    alive &= fresh(telemetry.attitude_at, limit.telemetry_age, "attitude")
    estimate = len(faults) + len(lacks)
    if fresh(telemetry.gps_at, limit.report_age, "GPS"):
        if telemetry.gps_fix < GPS_3D:
            faults.append(f"GPS fix {telemetry.gps_fix}, needs 3")
        if 0 <= telemetry.satellites < limit.satellites_min:
            faults.append(f"{telemetry.satellites} satellites, needs {limit.satellites_min}")
        if telemetry.accuracy_m > limit.accuracy_max:
            faults.append(f"GPS accuracy {telemetry.accuracy_m:.1f} m, needs {limit.accuracy_max:.1f}")
    if telemetry.ekf_at != NEVER:
        if now - telemetry.ekf_at > limit.report_age:
            faults.append(f"EKF status {now - telemetry.ekf_at:.1f} s old")
        elif not telemetry.ekf_ok:
            faults.append("EKF: no good estimate of attitude, velocity and position")
    estimate_bad = len(faults) + len(lacks) > estimate
    low = 0.0 <= telemetry.battery < limit.battery_min or 0.0 < telemetry.voltage < limit.voltage_min
    if low:
        faults.append(f"battery {telemetry.battery:.0%}" if telemetry.battery >= 0 else "battery voltage low")
    if telemetry.status_at != NEVER and not telemetry.armed and not telemetry.pre_arm_ok:
        lacks.append("pre-arm checks not passed")
    return Health(tuple(lacks), tuple(faults), low, estimate_bad, not alive)
