"""How long a simulated autopilot may rest: until when nothing of its own is due, if nobody tells it anything.

While it rests the world still moves the vehicle on under its demand, but nothing is watched, sent or timed.
The answers are on the safe side: an autopilot wakes a little early, looks, and rests on. What it does is the
same, byte for byte, as if it had looked at every step.
"""

from __future__ import annotations

from onboard.core.math.constants import NS_PER_S
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.autopilot.health import CELL_EMPTY, CELL_FULL, CELLS, Health
from sim_bridge.vehicle.autopilot.parameters import Parameters

AWAKE = 0  # no rest: what may happen depends on more than time
FOR_EVER = 1 << 62  # [ns]
EARLY_NS = 2_000_000  # of waking, so that rounding never makes anything late
CHARGE = 1e-6  # share of a battery's charge, likewise
BATTERY_LEVELS = ((1, "BATT_LOW_VOLT", "BATT_LOW_MAH"), (2, "BATT_CRT_VOLT", "BATT_CRT_MAH"))
PX4_LEVELS = ("BAT_LOW_THR", "BAT_CRIT_THR", "BAT_EMERGEN_THR")
DELAYED = frozenset(  # commands: they may be executed some time after they came
    (
        dialect.MAVLINK_MSG_ID_COMMAND_LONG,
        dialect.MAVLINK_MSG_ID_COMMAND_INT,
        dialect.MAVLINK_MSG_ID_SET_MODE,
    )
)
SETPOINTS = frozenset(  # they change what is demanded, and nothing that is watched
    (
        dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED,
        dialect.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT,
        dialect.MAVLINK_MSG_ID_SET_ATTITUDE_TARGET,
    )
)


def until(now_ns: int, left_s: float) -> int:
    """The instant [ns] up to which something is surely not due that is due in `left_s` [s]."""
    return now_ns + round(left_s * NS_PER_S) - EARLY_NS


def drained_ns(now_ns: int, charge: float, level: float, drain: float) -> int:
    """The instant [ns] up to which a battery of `charge` is surely above `level`, at `drain` [1/s]."""
    return until(now_ns, min((charge - level - CHARGE) / drain, 1e6))


def ardupilot_level(p: Parameters, sag: float, full: float, acted: int) -> float:
    """The charge, 0…1, at or below which a battery level beyond `acted` (upon) may be reached.

    `sag` is the voltage that is missing [V], `full` what a full battery holds [mAh].
    """
    level = CHARGE
    for number, voltage, reserve in BATTERY_LEVELS:
        volt, charge = p[voltage], p[reserve]
        if number > acted and volt > 0.0:
            level = max(level, ((volt + sag) / CELLS - CELL_EMPTY) / (CELL_FULL - CELL_EMPTY) + CHARGE)
        if number > acted and charge > 0.0:
            level = max(level, 1.0 - (p["BATT_CAPACITY"] - charge) / full + CHARGE)
    return level


def px4_rest(p: Parameters, health: Health, now_ns: int, silence_s: float, setpoint_ns: int) -> int:
    """Until when [ns] a PX4 has nothing to watch that is armed, in the air and in no failsafe.

    `silence_s` is that of the ground stations [s], `setpoint_ns` the last setpoint's instant, where it needs
    them.
    """
    if p["GF_MAX_HOR_DIST"] > 0.0 or p["GF_MAX_VER_DIST"] > 0.0:
        return AWAKE
    level = max((p[name] for name in PX4_LEVELS if p[name] < health.battery), default=-1.0)
    rest = drained_ns(now_ns, health.battery, level, health.drain_rate)
    left_s = p["COM_DL_LOSS_T"] - silence_s
    if left_s >= 0.0:
        rest = min(rest, until(now_ns, left_s))
    return min(rest, until(setpoint_ns, p["COM_OF_LOSS_T"]))
