"""The stories of an acceptance flight, each a generator of pauses that notes what it saw.

Every story ends in the mode in which this vehicle can be left alone; a story that sinks is broken off.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import atan2, cos, degrees, radians, sin
from typing import NamedTuple

from onboard.core.math.angles import wrap
from onboard.core.math.vectors import Vec
from onboard.wire.autopilot_kind import Kind
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.vehicle.acceptance.companion import Companion

SINK_MOST = 5.0  # [m] that a story may lose before it is broken off
AHEAD = 300.0  # [m] of a plane's position target along its course
PX4 = (Kind.PX4_MULTICOPTER, Kind.PX4_PLANE)
RESULTS = {0: "accepted", 1: "later", 2: "denied", 3: "unsupported", 4: "failed", 5: "under way"}
PARAMETERS = {
    Kind.ARDUCOPTER: (
        "FS_GCS_ENABLE", "FS_GCS_TIMEOUT", "FS_OPTIONS", "SYSID_MYGCS", "MAV_GCS_SYSID", "GUID_TIMEOUT",
        "PILOT_SPEED_UP", "PILOT_SPEED_DN", "THR_DZ", "FS_THR_ENABLE", "RTL_ALT", "RTL_ALT_M", "FENCE_ENABLE",
    ),
    Kind.ARDUPLANE: (
        "FS_GCS_ENABL", "FS_LONG_ACTN", "FS_LONG_TIMEOUT", "SYSID_MYGCS", "MAV_GCS_SYSID", "AIRSPEED_MIN",
        "AIRSPEED_MAX", "AIRSPEED_CRUISE", "ROLL_LIMIT_DEG", "RTL_ALTITUDE", "THR_FAILSAFE",
    ),
    Kind.PX4_MULTICOPTER: (
        "COM_OBL_RC_ACT", "COM_OF_LOSS_T", "COM_RCL_EXCEPT", "NAV_RCL_ACT", "NAV_DLL_ACT", "COM_DL_LOSS_T",
        "COM_FAIL_ACT_T", "RTL_RETURN_ALT", "MPC_XY_VEL_MAX", "MPC_Z_VEL_MAX_UP", "MPC_Z_VEL_MAX_DN",
    ),
    Kind.PX4_PLANE: (
        "COM_OBL_RC_ACT", "COM_OF_LOSS_T", "COM_RCL_EXCEPT", "NAV_RCL_ACT", "NAV_DLL_ACT", "COM_DL_LOSS_T",
        "COM_FAIL_ACT_T", "RTL_RETURN_ALT", "FW_AIRSPD_MIN", "FW_AIRSPD_MAX", "FW_AIRSPD_TRIM", "FW_R_LIM",
    ),
}  # fmt: skip
"""What is read before the flight, and given to the simulated twin, by kind."""


class Pause(NamedTuple):
    """Let time pass: `seconds`, or until a condition holds, for `seconds` at most."""

    seconds: float
    until: Callable[[], bool] | None = None


class Note(NamedTuple):
    """One thing that a story saw."""

    what: str
    value: float | str
    within: float = 0.0  # by which a number may differ from the twin's


class Story(NamedTuple):
    """A story: what is told before it, and its pauses."""

    name: str
    announcement: str
    fly: Callable[[Companion, list[Note]], Iterator[Pause]]


def following_mode(kind: Kind) -> str:
    """The mode in which targets are followed."""
    return "OFFBOARD" if kind in PX4 else "GUIDED"


def holding_mode(companion: Companion) -> str:
    """The mode in which this vehicle can be left for a while, by kind and by the stick as it is measured."""
    if companion.kind in PX4:
        return "HOLD"
    if companion.kind is Kind.ARDUPLANE:
        return "LOITER"
    return "LOITER" if companion.stick_centred else "BRAKE"


def stories(kind: Kind) -> list[Story]:
    """The stories for a kind, in the order in which they are flown. Raises ValueError for a kind without."""
    if kind not in PARAMETERS:
        raise ValueError(f"no acceptance flight for {kind.value}")
    scheme = {Kind.ARDUPLANE: _plane_scheme, Kind.PX4_PLANE: _position_ahead}.get(kind, _velocity_scheme)
    told = {
        Kind.ARDUPLANE: "Follow: GUIDED; airspeed, height and course by command; roll of 20° for 4 s.",
        Kind.PX4_PLANE: "Follow: OFFBOARD; a position target 300 m ahead, east, for 12 s.",
    }.get(kind, "Follow: 2 m/s to the north for 4 s, then silence of targets for 5 s, then targets again.")
    return [
        Story("hold", "Hold: the vehicle stays where it is for 8 s.", _hold),
        Story("refusal", "Refusals: a mode that does not exist is asked for; nothing moves.", _refusal),
        Story("follow", told, scheme),
        Story("return", "Return: the vehicle flies towards its home for 4 s, then holds.", _return),
        Story(
            "silence",
            "Silence: the companion falls silent for 9 s while it is followed, as if it had died; "
            "the autopilot's own failsafe decides. Then the vehicle holds.",
            _silence,
        ),
    ]


def _enter(companion: Companion, mode: str) -> Iterator[Pause]:
    since = companion.now
    companion.order_mode(mode)
    yield from _answer(companion, since, dialect.MAV_CMD_DO_SET_MODE)
    yield Pause(1.4, lambda: companion.mode == mode)


def _answer(companion: Companion, since: float, number: int) -> Iterator[Pause]:
    """Wait for a command's first acknowledgement, and a little for a second one."""
    yield Pause(2.5, lambda: bool(companion.results(number, since)))
    yield Pause(0.3)


def _leave(companion: Companion) -> Iterator[Pause]:
    companion.target = None
    yield from _enter(companion, holding_mode(companion))
    yield Pause(2.0)


def _acknowledged(companion: Companion, since: float, number: int) -> str:
    return ", ".join(RESULTS.get(r, str(r)) for r in companion.results(number, since)) or "no answer"


def _hold(companion: Companion, notes: list[Note]) -> Iterator[Pause]:
    mode, since = holding_mode(companion), companion.now
    yield from _enter(companion, mode)
    notes.append(Note(f"{mode}: answers", _acknowledged(companion, since, dialect.MAV_CMD_DO_SET_MODE)))
    notes.append(Note("mode told", companion.mode))
    yield Pause(3.0)
    height, place = companion.height or 0.0, companion.local
    yield Pause(8.0, lambda: height - (companion.height or 0.0) > SINK_MOST)
    lost = height - (companion.height or 0.0)
    notes.append(Note("height lost in 8 s [m]", lost, 1.5))
    if companion.kind in (Kind.ARDUCOPTER, Kind.PX4_MULTICOPTER):
        moved = ((companion.local.x - place.x) ** 2 + (companion.local.y - place.y) ** 2) ** 0.5
        notes.append(Note("drift in 8 s [m]", moved, 2.0))


def _refusal(companion: Companion, notes: list[Note]) -> Iterator[Pause]:
    since, mode = companion.now, companion.mode
    companion.command(dialect.MAV_CMD_DO_SET_MODE, 1, 97, 3)
    yield from _answer(companion, since, dialect.MAV_CMD_DO_SET_MODE)
    notes.append(Note("unknown mode: answers", _acknowledged(companion, since, dialect.MAV_CMD_DO_SET_MODE)))
    if companion.kind in PX4:
        since = companion.now
        yield Pause(1.5)  # older than COM_OF_LOSS_T
        since = companion.now
        companion.order_mode("OFFBOARD")
        yield from _answer(companion, since, dialect.MAV_CMD_DO_SET_MODE)
        answers = _acknowledged(companion, since, dialect.MAV_CMD_DO_SET_MODE)
        notes.append(Note("OFFBOARD without targets: answers", answers))
    notes.append(Note("mode unchanged", "yes" if companion.mode == mode else companion.mode))


def _velocity_scheme(companion: Companion, notes: list[Note]) -> Iterator[Pause]:
    companion.target = lambda: companion.velocity_target(Vec(2.0, 0.0, 0.0))
    yield Pause(0.3)
    since = companion.now
    mode = following_mode(companion.kind)
    yield from _enter(companion, mode)
    notes.append(Note(f"{mode}: answers", _acknowledged(companion, since, dialect.MAV_CMD_DO_SET_MODE)))
    yield Pause(4.0)
    notes.append(Note("speed to the north after 4 s [m/s]", companion.velocity.x, 0.5))
    companion.target = None
    yield Pause(5.0)
    notes.append(Note("mode after 5 s without targets", companion.mode))
    notes.append(Note("speed after 5 s without targets [m/s]", companion.level_speed, 0.7))
    companion.target = lambda: companion.velocity_target(Vec(0.0, 0.0, 0.0))
    yield Pause(2.5)
    notes.append(Note("mode when targets have returned", companion.mode))
    yield from _leave(companion)


def _plane_scheme(companion: Companion, notes: list[Note]) -> Iterator[Pause]:
    since = companion.now
    yield from _enter(companion, "GUIDED")
    notes.append(Note("GUIDED: answers", _acknowledged(companion, since, dialect.MAV_CMD_DO_SET_MODE)))
    low = companion.parameters.get("AIRSPEED_MIN", 10.0)
    cruise = companion.parameters.get("AIRSPEED_CRUISE", 0.5 * (low + 30.0))
    asked: list[tuple[str, int, tuple[float, float, float, float], float, int]] = [
        ("cruise speed", 43000, (0.0, cruise, 0.0, 0.0), 0.0, 0),
        ("airspeed below the least", 43000, (0.0, 0.5 * low, 0.0, 0.0), 0.0, 0),
        ("height of 0", 43001, (0.0, 0.0, 0.0, 0.0), 0.0, 3),
        ("height as it is", 43001, (0.0, 0.0, 0.0, 0.0), companion.height or 100.0, 3),
        ("course of 360°", 43002, (0.0, 360.0, 9.8, 0.0), 0.0, 0),
        ("course of 90°", 43002, (0.0, 90.0, 9.8, 0.0), 0.0, 0),
    ]
    for name, number, values, z, frame in asked:
        since = companion.now
        companion.command_int(number, values, z, frame)
        yield from _answer(companion, since, number)
        notes.append(Note(f"{number}, {name}: answers", _acknowledged(companion, since, number)))
    yield Pause(14.0)
    notes.append(Note("error of course after 14 s [°]", _course_error(companion, 90.0), 10.0))
    half = 0.5 * radians(20.0)
    companion.target = lambda: dialect.MAVLink_set_attitude_target_message(
        0, companion.system, 1, 198, [cos(half), sin(half), 0.0, 0.0], 0, 0, 0, 0.0
    )
    yield Pause(4.0)
    notes.append(Note("bank after 4 s of 20° [°]", degrees(_roll(companion)), 4.0))
    yield from _leave(companion)


def _position_ahead(companion: Companion, notes: list[Note]) -> Iterator[Pause]:
    z = companion.local.z
    companion.target = lambda: companion.position_target(Vec(companion.local.x, companion.local.y + AHEAD, z))
    yield Pause(0.3)
    since = companion.now
    yield from _enter(companion, "OFFBOARD")
    notes.append(Note("OFFBOARD: answers", _acknowledged(companion, since, dialect.MAV_CMD_DO_SET_MODE)))
    yield Pause(12.0)
    notes.append(Note("error of course after 12 s [°]", _course_error(companion, 90.0), 6.0))
    notes.append(Note("error of height after 12 s [m]", companion.local.z - z, 3.0))
    companion.target = None
    yield Pause(3.5)
    notes.append(Note("mode after 3.5 s without targets", companion.mode))
    yield from _leave(companion)


def _return(companion: Companion, notes: list[Note]) -> Iterator[Pause]:
    since = companion.now
    yield from _enter(companion, "RTL")
    notes.append(Note("RTL: answers", _acknowledged(companion, since, dialect.MAV_CMD_DO_SET_MODE)))
    yield Pause(4.0)
    notes.append(Note("mode after 4 s", companion.mode))
    yield from _leave(companion)


def _silence(companion: Companion, notes: list[Note]) -> Iterator[Pause]:
    if companion.kind is Kind.PX4_PLANE:
        companion.target = lambda: companion.position_target(
            Vec(companion.local.x + AHEAD, companion.local.y, companion.local.z)
        )
    elif companion.kind is not Kind.ARDUPLANE:
        companion.target = lambda: companion.velocity_target(Vec(0.0, 0.0, 0.0))
    yield Pause(0.3)
    yield from _enter(companion, following_mode(companion.kind))
    yield Pause(2.0)
    height = companion.height or 0.0
    companion.target, companion.beats = None, False
    begun, known = companion.now, len(companion.changes)
    yield Pause(9.0, lambda: height - (companion.height or 0.0) > SINK_MOST)
    companion.beats = True
    modes = [change for change in companion.changes[known:] if change.mode != following_mode(companion.kind)]
    notes.append(Note("mode in the end", companion.mode))
    if modes:
        notes.append(Note("time to the first change [s]", modes[0].t - begun, 1.3))
        notes.append(
            Note("status then", "failsafe" if modes[0].status >= dialect.MAV_STATE_CRITICAL else "as before")
        )
    notes.append(Note("height lost [m]", height - (companion.height or 0.0), 3.0))
    yield Pause(1.5)
    yield from _leave(companion)


def _course_error(companion: Companion, course_deg: float) -> float:
    course = atan2(companion.velocity.y, companion.velocity.x)
    return degrees(wrap(course - radians(course_deg)))


def _roll(companion: Companion) -> float:
    told = companion.latest.get("ATTITUDE")
    return 0.0 if told is None else float(told.roll)
