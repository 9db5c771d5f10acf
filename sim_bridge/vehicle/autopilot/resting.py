"""How long a simulated autopilot may rest: until when nothing of its own is due, if nobody tells it anything.

While it rests the world still moves the vehicle on under its demand, but nothing is watched, sent or timed.
The answers are on the safe side: an autopilot wakes a little early, looks, and rests on. What it does is the
same, byte for byte, as if it had looked at every step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from onboard.core.math.constants import NS_PER_S
from sim_bridge.vehicle.autopilot.health import CELL_EMPTY, CELL_FULL, CELLS, CURRENT_FLYING

if TYPE_CHECKING:
    from sim_bridge.vehicle.autopilot.ardupilot import ArduPilot
    from sim_bridge.vehicle.autopilot.px4 import Px4

AWAKE = 0  # no rest: what may happen depends on more than time
FOR_EVER = 1 << 62  # [ns]
EARLY_NS = 2_000_000  # of waking, so that rounding never makes anything late
CHARGE = 1e-6  # share of a battery's charge, likewise
BATTERY_LEVELS = ((1, "BATT_LOW_VOLT", "BATT_LOW_MAH"), (2, "BATT_CRT_VOLT", "BATT_CRT_MAH"))
PX4_LEVELS = ("BAT_LOW_THR", "BAT_CRIT_THR", "BAT_EMERGEN_THR")


def until(now_ns: int, left_s: float) -> int:
    """The instant [ns] up to which something is surely not due that is due in `left_s` [s]."""
    return now_ns + round(left_s * NS_PER_S) - EARLY_NS


def drained_ns(now_ns: int, charge: float, level: float, drain: float) -> int:
    """The instant [ns] up to which a battery of `charge` is surely above `level`, at `drain` [1/s]."""
    return until(now_ns, min((charge - level - CHARGE) / drain, 1e6))


def ardupilot_level(ap: ArduPilot) -> float:
    """The charge, 0…1, at or below which a battery level beyond the one acted upon may be reached."""
    p, sag = ap.parameters, ap.health.sag
    used = ap.setup.options.battery_s * CURRENT_FLYING / 3.6  # [mAh] of a full battery
    level = CHARGE
    for number, voltage, reserve in BATTERY_LEVELS:
        volt, charge = p[voltage], p[reserve]
        if number > ap._battery_level and volt > 0.0:
            level = max(level, ((volt + sag) / CELLS - CELL_EMPTY) / (CELL_FULL - CELL_EMPTY) + CHARGE)
        if number > ap._battery_level and charge > 0.0:
            level = max(level, 1.0 - (p["BATT_CAPACITY"] - charge) / used + CHARGE)
    return level


def ardupilot_rest(ap: ArduPilot, now_ns: int) -> int:
    """Until when [ns] an ArduPilot that is armed and in the air has nothing to watch."""
    p, h = ap.parameters, ap.health
    if ap._failsafe or ap._radio_failsafe or ap._ekf_failsafe or ap._ekf_bad_ns >= 0 or h.faults:
        return AWAKE
    if ap._battery_low_ns >= 0 or p["FENCE_ENABLE"] or ap.transmitter.silent:
        return AWAKE
    rest = drained_ns(now_ns, h.battery, ap.battery_level(), h.drain_rate)
    limit = ap.silence_limit_s()
    if limit > 0.0:
        rest = min(rest, until(now_ns, limit - ap.ground_station_silence_s(now_ns)))
    return rest


def px4_rest(ap: Px4, now_ns: int) -> int:
    """Until when [ns] a PX4 that is armed and in the air has nothing to watch."""
    p, h = ap.parameters, ap.health
    if ap._in_failsafe or ap._signal_lost or ap._blind_ns >= 0 or ap._latches.latched or h.faults:
        return AWAKE
    if ap.mode != ap._intended or ap.transmitter.silent:
        return AWAKE
    if p["GF_MAX_HOR_DIST"] > 0.0 or p["GF_MAX_VER_DIST"] > 0.0:
        return AWAKE
    level = max((p[name] for name in PX4_LEVELS if p[name] < h.battery), default=-1.0)
    rest = drained_ns(now_ns, h.battery, level, h.drain_rate)
    left_s = p["COM_DL_LOSS_T"] - ap.ground_station_silence_s(now_ns)
    if left_s >= 0.0:
        rest = min(rest, until(now_ns, left_s))
    if ap.is_mode("OFFBOARD"):
        rest = min(rest, until(ap._setpoint_ns, p["COM_OF_LOSS_T"]))
    return min(rest, ap._beat_ns) if ap._beat_ns else rest
