"""What a vehicle does by its own failsafes when the agent dies, in sentences, and what is wrong with that.

A dead agent's story must end on the ground or at home: a hover that nothing ends is an error. What is not
known counts as not set.

Sources: ArduPilot's and PX4's parameter references (4.5 and 4.7, 1.16 and 1.18); GUIDED's and OFFBOARD's ends
and the vehicle without sticks as recorded (tests/field/recordings).
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.autopilot.base import Telemetry
from onboard.autopilot.failsafe_actions import (
    COPTER_BATTERY,
    COPTER_EKF,
    COPTER_FENCE,
    COPTER_GCS,
    GF_ACTION,
    HOVERS,
    LOITERS,
    NOTHING,
    PLANE_BATTERY,
    PLANE_FENCE,
    PLANE_LONG,
    PX4_BATTERY,
    PX4_OFFBOARD,
    PX4_RC,
    RETURNS,
    Ending,
)
from onboard.autopilot.parameters import PX4, Finding, Parameters, either, gcs_failsafe
from onboard.autopilot.pilot_hands import HEARD_S
from onboard.autopilot.release_modes import stick_centred
from onboard.wire.mavlink.modes import Kind

AGENT, HELD, BATTERY, STICKS, PLACE, FENCE, ARMING = (
    "agent dies", "agent dies in hold", "battery low", "transmitter lost", "position lost", "fence crossed",
    "arming",
)  # fmt: skip
CONTINUE_PILOTED, CONTINUE_GUIDED = 16, 4  # FS_OPTIONS: the GCS's failsafe, the transmitter's


class Around(NamedTuple):
    """What else is there besides parameters."""

    sticks: bool = False  # a pilot's transmitter is heard now
    beating: tuple[int, ...] = ()  # other components that beat under the vehicle's system id


ALONE = Around()


def sticks_heard(now: float, telemetry: Telemetry, parameters: Parameters) -> bool:
    """Return whether a pilot's transmitter is there, as far as that can be known.

    ArduPilot reports channels, and a healthy receiver, where nobody is: there only a throttle stick in the
    middle tells. PX4 is silent about channels that it does not hear.
    """
    if telemetry.kind in PX4:
        fresh = 0.0 <= now - telemetry.channels_at <= HEARD_S
        return fresh and any(telemetry.channels)
    return stick_centred(now, telemetry, parameters)


def stories(kind: Kind, parameters: Parameters, system: int, around: Around = ALONE) -> tuple[Finding, ...]:
    """Return what the vehicle does, one finding for each thing that may happen; the agent's death first."""
    if kind in PX4:
        return _px4(kind, parameters, around)
    if kind is Kind.ARDUCOPTER:
        return _copter(parameters, system, around)
    return _plane(parameters, system, around) if kind is Kind.ARDUPLANE else ()


def _named(parameters: Parameters, name: str, table: dict[int, Ending]) -> tuple[str, Ending]:
    """The parameter with its value, in words, and what that comes to."""
    value = parameters.get(name)
    if value is None:
        return f"{name} is not known", NOTHING._replace(words="does what is not known")
    found = table.get(round(value))
    return f"{name} {value:g}", found or Ending("does what this program does not know", False, bad=True)


# ---------------------------------------------------------------------- batteries of ArduPilot


class _Watch(NamedTuple):
    """What the batteries' failsafes come to."""

    ends: bool  # one of them brings a hovering vehicle down
    finding: Finding


def _batteries(parameters: Parameters, table: dict[int, Ending], rtl_ends: bool) -> _Watch:
    """Judge BATT_ and, where there is one, BATT2_."""
    words, ends, bad, silent = [], False, False, []
    for battery in ("BATT", "BATT2"):
        monitor = parameters.get(f"{battery}_MONITOR")
        if battery == "BATT2" and not monitor:
            continue
        acting = False
        for level, stage in (("LOW", "low"), ("CRT", "critical")):
            at = _level(parameters, battery, level)
            named, action = _named(parameters, f"{battery}_FS_{level}_ACT", table)
            if not at or monitor == 0 or action.words == NOTHING.words:
                continue
            acting = True
            bad = bad or action.bad
            ends = ends or (
                action.ends and not action.bad and (rtl_ends or not action.words.startswith("returns"))
            )
            words.append(f"{stage} at {at} ({named}) it {action.words}")
        if not acting:
            silent.append(battery)
    if not words:
        text = "no battery failsafe acts: " + _why_silent(parameters)
        return _Watch(
            False, Finding("warning", BATTERY, text, "set BATT_LOW_VOLT and BATT_FS_LOW_ACT to 2 (return)")
        )
    text = "; ".join(words)
    if bad:
        return _Watch(
            ends, Finding("error", BATTERY, text, "set BATT_FS_LOW_ACT and BATT_FS_CRT_ACT to 1 or 2")
        )
    if silent:
        remedy = f"set {silent[0]}_LOW_VOLT and {silent[0]}_FS_LOW_ACT"
        return _Watch(ends, Finding("warning", BATTERY, f"{text}; nothing watches {silent[0]}", remedy))
    return _Watch(ends, Finding("info", BATTERY, text, ""))


def _level(parameters: Parameters, battery: str, level: str) -> str:
    """When a battery counts as low or critical, in words; "" for never."""
    volt, mah = parameters.get(f"{battery}_{level}_VOLT", 0.0), parameters.get(f"{battery}_{level}_MAH", 0.0)
    timer = parameters.get(f"{battery}_LOW_TIMER", 10.0)  # 0: voltages never count
    said = [f"{volt:g} V for {timer:g} s"] if volt > 0.0 and timer > 0.0 else []
    return " or ".join(said + ([f"{mah:g} mAh left"] if mah > 0.0 else []))


def _why_silent(parameters: Parameters) -> str:
    names = ("BATT_MONITOR", "BATT_LOW_VOLT", "BATT_LOW_MAH", "BATT_FS_LOW_ACT")
    return ", ".join(
        f"{name} {parameters[name]:g}" if name in parameters else f"{name} unknown" for name in names
    )


# ---------------------------------------------------------------------- ArduPilot


def _copter(p: Parameters, system: int, around: Around) -> tuple[Finding, ...]:
    final_name, final = either(p, "RTL_ALT_FINAL_M")
    rtl_ends = not final  # it lands; else it stays over home at that height
    battery = _batteries(p, COPTER_BATTERY, rtl_ends)
    after = f"{p.get('FS_GCS_TIMEOUT', 5.0):g} s after the last heartbeat"
    stops = f"{p.get('GUID_TIMEOUT', 3.0):g} s after the last target it stops and hovers"
    why, remedy = _unwatched(Kind.ARDUCOPTER, p, system, around)
    named, action = _named(p, "FS_GCS_ENABLE", COPTER_GCS)
    if why:
        agent = _unended(AGENT, f"{stops}, and {why}", remedy, battery.ends, always=True)
    else:
        text = f"{stops}; {after} it {action.words} ({named})"
        if action.words.startswith("returns") and not rtl_ends:
            text += f", and hovers over home ({final_name} {final:g})"
            action = action._replace(ends=False)
        if action.bad:
            agent = Finding("error", AGENT, text, "set FS_GCS_ENABLE to 1")
        elif action.ends:
            agent = Finding("info", AGENT, text, "")
        else:
            agent = _unended(AGENT, text, "set FS_GCS_ENABLE to 1, RTL_ALT_FINAL to 0", battery.ends)
    return (agent, *_copter_held(p, why, around, battery), battery.finding, _copter_sticks(p, around),
            _copter_place(p, around), _fence(p, COPTER_FENCE), _arming(p))  # fmt: skip


def _copter_place(p: Parameters, around: Around) -> Finding:
    named, action = _named(p, "FS_EKF_ACTION", COPTER_EKF)
    if action.bad and not around.sticks:
        return Finding("error", PLACE, f"it {action.words} ({named})", "set FS_EKF_ACTION to 1 (land)")
    return Finding("info", PLACE, f"it {action.words} ({named})", "")


def _copter_held(p: Parameters, why: str, around: Around, battery: _Watch) -> tuple[Finding, ...]:
    """In BRAKE, where a hold without a stick ends."""
    options = p.get("FS_OPTIONS")
    if around.sticks or why:
        return ()
    if options is not None and not round(options) & CONTINUE_PILOTED:
        return (Finding("info", HELD, "as in GUIDED (FS_OPTIONS without 16)", ""),)
    said = "FS_OPTIONS is not known" if options is None else f"FS_OPTIONS {options:g} has 16"
    text = f"in BRAKE nothing brings it home: {said}, so the GCS failsafe leaves it alone"
    return (_unended(HELD, text, "take 16 out of FS_OPTIONS", battery.ends),)


def _copter_sticks(p: Parameters, around: Around) -> Finding:
    named, action = _named(p, "FS_THR_ENABLE", {0: NOTHING, **COPTER_GCS})
    if round(p.get("FS_THR_ENABLE", 0.0)) and round(p.get("FS_OPTIONS", 0.0)) & CONTINUE_GUIDED:
        return Finding(
            "info", STICKS, f"in GUIDED it flies on (FS_OPTIONS has 4); else it {action.words} ({named})", ""
        )
    if around.sticks and action.words == NOTHING.words:
        return Finding("warning", STICKS, f"it {action.words} ({named})", "set FS_THR_ENABLE to 1 (return)")
    return Finding("info", STICKS, f"it {action.words} ({named})", "")


def _plane(p: Parameters, system: int, around: Around) -> tuple[Finding, ...]:
    battery = _batteries(p, PLANE_BATTERY, True)
    why, remedy = _unwatched(Kind.ARDUPLANE, p, system, around)
    named, action = _named(p, "FS_LONG_ACTN", PLANE_LONG)
    if why:
        agent = Finding("error", AGENT, f"it flies on as last told, and {why}", remedy)
    else:
        text = f"{p.get('FS_LONG_TIMEOUT', 5.0):g} s after the last heartbeat it {action.words} ({named})"
        home = action is RETURNS and not p.get("RTL_AUTOLAND")
        if home:
            text += ", and circles over home until a person lands it (RTL_AUTOLAND 0)"
        bad = action.bad or not action.ends
        severity = "error" if bad else "warning" if home else "info"
        agent = Finding(severity, AGENT, text, "set FS_LONG_ACTN to 1" if bad else "have a pilot to land it")
    return (agent, battery.finding, _plane_sticks(p), _fence(p, PLANE_FENCE), _arming(p))


def _plane_sticks(p: Parameters) -> Finding:
    found = p.get("THR_FAILSAFE")
    if found is None or round(found) != 1:
        said = "is not known" if found is None else f"{found:g}"
        return Finding("info", STICKS, f"it does nothing (THR_FAILSAFE {said})", "")
    _, action = _named(p, "FS_LONG_ACTN", PLANE_LONG)
    short = "circles" if p.get("FS_SHORT_ACTN") in (0.0, 1.0) else "goes by FS_SHORT_ACTN"
    return Finding("info", STICKS, f"at first it {short}, then it {action.words} (THR_FAILSAFE 1)", "")


def _unwatched(kind: Kind, p: Parameters, system: int, around: Around) -> tuple[str, str]:
    """Why no GCS failsafe acts when the agent dies, and the remedy; "" where one does."""
    failsafe = gcs_failsafe(kind, p, system)
    if failsafe is not None:
        return failsafe.text, failsafe.remedy
    if around.beating:
        others = ", ".join(map(str, around.beating))
        return (
            f"component {others} beats under the same system id, which keeps the GCS failsafe quiet",
            "give it another system id, or end its heartbeat",
        )
    return "", ""


def _unended(name: str, text: str, remedy: str, battery_ends: bool, *, always: bool = False) -> Finding:
    """A hover: an error unless the battery's failsafe ends it; `always` an error whatever ends it."""
    if battery_ends:
        return Finding("error" if always else "warning", name, f"{text}: until its battery is low", remedy)
    return Finding(
        "error",
        name,
        f"{text}: a hover that nothing ends",
        remedy if always else f"{remedy}, or let the battery's failsafe land it",
    )


def _fence(p: Parameters, words: dict[int, str]) -> Finding:
    if not p.get("FENCE_ENABLE"):
        return Finding(
            "warning", FENCE, "the autopilot's own fence is off", "set FENCE_ENABLE to 1 and upload a fence"
        )
    action = p.get("FENCE_ACTION")
    if action is None:
        return Finding("info", FENCE, "FENCE_ACTION is not known", "")
    severity = "info" if action else "warning"
    text = f"it {words.get(round(action), 'does what this program does not know')} (FENCE_ACTION {action:g})"
    return Finding(severity, FENCE, text, "set FENCE_ACTION to 1 (return)")


def _arming(p: Parameters) -> Finding:
    name, value = either(p, "ARMING_SKIPCHK")
    if value is None:
        return Finding("info", ARMING, f"{name} is not known", "")
    skips = value != 0.0 if name == "ARMING_SKIPCHK" else value != 1.0
    if p.get("ARMING_REQUIRE") == 0:
        return Finding(
            "warning", ARMING, "it is armed from the start (ARMING_REQUIRE 0)", "set ARMING_REQUIRE to 1"
        )
    if skips:
        return Finding("warning", ARMING, f"it arms without all checks ({name} {value:g})",
                       f"set {name} to {'0' if name == 'ARMING_SKIPCHK' else '1'}")  # fmt: skip
    return Finding("info", ARMING, f"after all its checks ({name} {value:g})", "")


# ---------------------------------------------------------------------- PX4


def _px4(kind: Kind, p: Parameters, around: Around) -> tuple[Finding, ...]:
    named_battery, low = _named(p, "COM_LOW_BAT_ACT", PX4_BATTERY)
    lands_home = p.get("RTL_LAND_DELAY", 0.0) >= 0.0
    brought_down = low.ends and (lands_home or low is not RETURNS)
    named, action = _named(p, "COM_OBL_RC_ACT", PX4_OFFBOARD)
    after = f"{p['COM_OF_LOSS_T']:g} s" if "COM_OF_LOSS_T" in p else "COM_OF_LOSS_T (not known)"
    if kind is Kind.PX4_PLANE and action is PX4_OFFBOARD[5]:
        action = LOITERS
    text = f"{after} after the last target it {action.words} ({named})"
    if action is RETURNS and not lands_home:
        text, action = f"{text}, and stays over home (RTL_LAND_DELAY {p['RTL_LAND_DELAY']:g})", HOVERS
    remedy = "set COM_OBL_RC_ACT to 3 (return) or 5 (hold)"
    if "COM_OBL_RC_ACT" not in p or (action.bad and not (around.sticks and action is PX4_OFFBOARD[0])):
        agent = Finding("error", AGENT, text, remedy)
    elif action.bad:
        agent = Finding("warning", AGENT, f"{text}; a transmitter is heard", remedy)
    elif action.ends:
        agent = Finding("info", AGENT, text, "")
    elif brought_down:
        agent = Finding("info", AGENT, f"{text}, until its battery is low", "")
    else:
        text = f"{text}: a hover that nothing ends, for low on battery it {low.words} ({named_battery})"
        agent = Finding(
            "error", AGENT, text, "set COM_OBL_RC_ACT to 3 (return), or COM_LOW_BAT_ACT to 2 or 3"
        )
    severity = "info" if low.ends else "warning"
    battery = Finding(severity, BATTERY, f"it {low.words} ({named_battery})", "set COM_LOW_BAT_ACT to 2 or 3")
    return (agent, battery, _px4_sticks(p, around), _px4_fence(p), _px4_arming(p))


def _px4_sticks(p: Parameters, around: Around) -> Finding:
    named, action = _named(p, "NAV_RCL_ACT", PX4_RC)
    text = f"it {action.words} ({named})"
    if p.get("COM_RC_IN_MODE") == 4:
        text = "none is used (COM_RC_IN_MODE 4)"
    elif round(p.get("COM_RCL_EXCEPT", 0.0)) & 4:
        text = f"in OFFBOARD, and in the failsafe after it, it flies on (COM_RCL_EXCEPT has 4); else {text}"
    elif not around.sticks:
        text += ", unless there was none at arming"
    if action.bad:
        return Finding("error", STICKS, text, "set NAV_RCL_ACT to 2 (return)")
    name, override = either(p, "MAN_OVERRIDE_SPD")
    if name == "COM_RC_OVERRIDE" and override is not None and not round(override) & 2:
        text += f"; sticks alone do not take it out of OFFBOARD ({name} {override:g}): the mode switch does"
    return Finding("info", STICKS, text, "")


def _px4_fence(p: Parameters) -> Finding:
    action = p.get("GF_ACTION")
    words = (
        "does what is not known" if action is None else GF_ACTION.get(round(action), "does what is not known")
    )
    if action is None or round(action) in (0, 1, 4):
        text = f"it {words} (GF_ACTION {'not known' if action is None else f'{action:g}'})"
        severity = "error" if action == 4 else "warning"
        return Finding(severity, FENCE, text, "set GF_ACTION to 2 (hold) or 3 (return)")
    return Finding("info", FENCE, f"it {words} (GF_ACTION {action:g})", "")


def _px4_arming(p: Parameters) -> Finding:
    without = p.get("COM_ARM_WO_GPS")
    if without is not None and round(without) == 2:
        return Finding(
            "warning", ARMING, "without GPS, and without a word (COM_ARM_WO_GPS 2)", "set COM_ARM_WO_GPS to 0"
        )
    return Finding("info", ARMING, "as its own checks let it" + (
        "" if without is None else f" (COM_ARM_WO_GPS {without:g})"), "")  # fmt: skip


def findings(kind: Kind, parameters: Parameters, system: int, around: Around = ALONE) -> tuple[Finding, ...]:
    """Return all that a preflight check should say of an autopilot's parameters."""
    found = list(stories(kind, parameters, system, around))
    if kind in PX4:
        loss = parameters.get("COM_OF_LOSS_T")
        if loss is None or loss > 2.0:
            text = "COM_OF_LOSS_T is not known" if loss is None else f"COM_OF_LOSS_T is {loss:g} s"
            found.append(Finding("error", "COM_OF_LOSS_T", text, "set COM_OF_LOSS_T to 1"))
    timeout = parameters.get("GUID_TIMEOUT")
    if kind is Kind.ARDUCOPTER and timeout is not None and timeout > 3.0:
        text = f"GUID_TIMEOUT is {timeout:g} s: it flies on that long after the last setpoint"
        found.append(Finding("warning", "GUID_TIMEOUT", text, "set GUID_TIMEOUT to 1"))
    silence = parameters.get("FS_LONG_TIMEOUT" if kind is Kind.ARDUPLANE else "FS_GCS_TIMEOUT")
    if kind not in PX4 and silence is not None and silence > 20.0:
        name = "FS_LONG_TIMEOUT" if kind is Kind.ARDUPLANE else "FS_GCS_TIMEOUT"
        text = f"{name} is {silence:g} s: nobody flies it for that long"
        found.append(Finding("warning", name, text, f"set {name} to 5"))
    return tuple(found)
