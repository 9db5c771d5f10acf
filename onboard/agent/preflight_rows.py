"""The rows of `onboard-agent check`: judged by a plain function from what was seen."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from onboard.agent.config import AgentConfig
from onboard.agent.core.policy_from_config import policy_of
from onboard.agent.core.signing_watch import SIGNING_REMEDY
from onboard.autopilot.base import Telemetry
from onboard.autopilot.batteries import FLIGHT, FUNCTIONS, Gauged
from onboard.autopilot.failsafes import Around, findings
from onboard.autopilot.flight_limits import read_limits
from onboard.autopilot.stream_rates import REMEDIES, Shortfall
from onboard.core.math.constants import NEVER
from onboard.core.safety.fence import deepest
from onboard.runtime.bus_security import BusSecurity, Lock
from onboard.wire.bus.messages import LinkLock
from onboard.wire.mavlink.frames import SIGNATURES
from onboard.wire.mavlink.modes import Kind

ENOUGH = 0.7  # of the position rate that was asked for
WINGED = (Kind.ARDUPLANE, Kind.PX4_PLANE)
DISK_MIN = 200e6  # bytes free, for logs


class Mark(Enum):
    """Result of one row."""

    PASS = "pass"
    WARN = "warn"
    FAIL = "fail"


class Row(NamedTuple):
    """One row of the table."""

    name: str
    mark: Mark
    found: str
    remedy: str = ""


class Sight(NamedTuple):
    """What was seen in some seconds of listening."""

    now: float = 0.0  # monotonic [s]
    link_trouble: str = ""  # why the link does not open
    link: str = ""
    datagrams: int = 0
    kind: str = ""  # of the autopilot, "" = none heard
    refusal: str = ""  # why no adapter flies it
    other_systems: tuple[int, ...] = ()
    second: bool = False  # another autopilot speaks under the same system id
    components: tuple[int, ...] = ()  # others that beat under the vehicle's system id
    version: str = ""
    uid: int = 0  # of the autopilot's board; 0: not said
    sticks: bool = False  # a pilot's transmitter is heard
    batteries: tuple[Gauged, ...] = ()
    telemetry: Telemetry = Telemetry()
    position_rate: float = 0.0  # [Hz]
    shortfall: Shortfall = Shortfall.NONE  # why it is below what was asked for
    parameters: dict[str, float] | None = None
    bad_frames: dict[str, int] | None = None
    bus_trouble: str = ""
    bus: str = ""
    lock: BusSecurity | None = None  # what keeps strangers off the bus
    bus_status: str = ""  # the bus's own words
    unserved: str = ""  # why an open session does not serve
    connected: bool = False
    link_lock: LinkLock = LinkLock.OPEN
    master: bool = False
    offset_s: float = 0.0
    key_trouble: str = ""
    signed: bool = False
    signing_trouble: str = ""  # why frames and the key do not fit
    free_bytes: float = 1e12
    bytecode: bool = True


def judge(config: AgentConfig, seen: Sight) -> list[Row]:
    """The table of a preflight."""
    rows = [_link(config, seen)]
    if not seen.link_trouble:
        rows += _autopilot(config, seen)
    rows += _bus(config, seen)
    if seen.key_trouble:
        rows.append(Row("signing key", Mark.FAIL, seen.key_trouble, "chmod 600, or make a new key"))
    elif seen.signed:
        rows.append(Row("signing key", Mark.PASS, "readable by its owner alone"))
        if not seen.link_trouble and seen.datagrams:
            rows.append(_link_lock(seen))
    else:
        rows.append(Row("signing key", Mark.WARN, "none: anybody on the link can command the vehicle",
                        "set [signing] key"))  # fmt: skip
    mark = Mark.PASS if seen.free_bytes >= DISK_MIN else Mark.WARN
    rows.append(Row("disk", mark, f"{seen.free_bytes / 1e9:.1f} GB free", "make room for logs"))
    rows.append(
        Row("bytecode", Mark.PASS, "compiled") if seen.bytecode else
        Row("bytecode", Mark.WARN, "the MAVLink dialect is not compiled: 80 MB more memory",
            "python -m compileall -q on site-packages")
    )  # fmt: skip
    if config.dry_run:
        rows.append(Row("dry run", Mark.WARN, "nothing will be sent to the autopilot", "leave out --dry-run"))
    return rows


def _link(config: AgentConfig, seen: Sight) -> Row:
    if seen.link_trouble:
        return Row("link", Mark.FAIL, seen.link_trouble, "another port or device, or end the other program")
    if seen.datagrams == 0:
        return Row("link", Mark.FAIL, f"{seen.link}: nothing arrives", "start the autopilot's output there")
    bad = seen.bad_frames or {}
    if bad:
        causes = ", ".join(f"{cause} {number}" for cause, number in sorted(bad.items()))
        found = f"{seen.link}: {seen.datagrams} received, bad: {causes}"
        return Row("link", Mark.WARN, found, "check the link")
    return Row("link", Mark.PASS, f"{seen.link}: {seen.datagrams} received")


def _autopilot(config: AgentConfig, seen: Sight) -> list[Row]:
    if seen.refusal:
        return [Row("autopilot", Mark.FAIL, seen.refusal, "see docs: which autopilots are flown")]
    if not seen.kind and seen.signing_trouble:
        return [Row("signing", Mark.FAIL, seen.signing_trouble, SIGNING_REMEDY)]
    if not seen.kind:
        others = ", ".join(map(str, seen.other_systems))
        found = f"none with system id {config.id}" + (f", but system {others}" if others else "")
        return [Row("autopilot", Mark.FAIL, found, "give the vehicle's MAVLink system id as --id")]
    t = seen.telemetry
    uid = f", uid {seen.uid:x}" if seen.uid else ""
    rows = [
        Row("autopilot", Mark.PASS, f"{seen.kind} {seen.version or 'of unknown version'}{uid}, in {t.mode}")
    ]
    rows += _company(config, seen)
    if seen.signing_trouble:
        mark = Mark.WARN if seen.parameters else Mark.FAIL  # it answers all the same, or it does not
        rows.append(Row("signing", mark, seen.signing_trouble, SIGNING_REMEDY))
    rows.append(_rates(config, seen))
    if t.gps_at == NEVER:
        rows.append(Row("GPS", Mark.WARN, "not reported", "ask for GPS_RAW_INT"))
    else:
        mark = Mark.PASS if t.gps_fix >= config.safety.gps_fix else Mark.FAIL
        rows.append(Row("GPS", mark, f"fix type {t.gps_fix}, {t.satellites} satellites", "wait for a fix"))
    if t.ekf_at == NEVER:
        rows.append(Row("estimate", Mark.WARN, "not reported", "ask for the estimator status"))
    else:
        mark = Mark.PASS if t.ekf_ok else Mark.FAIL
        rows.append(Row("estimate", mark, "healthy" if t.ekf_ok else "not healthy", "wait, or recalibrate"))
    return [*rows, _battery(config, seen), *_failsafes(config, seen)]


def _company(config: AgentConfig, seen: Sight) -> list[Row]:
    """Who else speaks under the vehicle's system id."""
    rows = []
    if seen.second:
        rows.append(Row("system id", Mark.FAIL, f"two autopilots have system id {config.id}",
                        "give each an id of its own"))  # fmt: skip
    if seen.components:
        others = ", ".join(map(str, seen.components))
        remedy = "give it another system id: an ArduPilot's GCS failsafe matches the id alone"
        rows.append(
            Row("components", Mark.WARN, f"component {others} beats as system {config.id} too", remedy)
        )
    return rows


def _rates(config: AgentConfig, seen: Sight) -> Row:
    wanted = config.control_rate_hz
    found = f"position at {seen.position_rate:.1f} Hz of {wanted:g}"
    if seen.position_rate >= ENOUGH * wanted:
        return Row("rates", Mark.PASS, found)
    if seen.signing_trouble:
        return Row("rates", Mark.FAIL, found, "see signing")
    cause = seen.shortfall if seen.shortfall is not Shortfall.NONE else Shortfall.LINK
    return Row("rates", Mark.FAIL, f"{found}: {cause.value}", REMEDIES[cause])


def _battery(config: AgentConfig, seen: Sight) -> Row:
    """The emptiest that flies; where there are several, each by id and function."""
    share = seen.telemetry.battery
    if share < 0.0:
        return Row("battery", Mark.WARN, "not reported: the supervisor cannot watch it", "set it up")
    mark = Mark.PASS if share >= 2.0 * config.safety.battery else Mark.FAIL
    each = [
        f"id {one.id} ({FUNCTIONS.get(one.function, 'unknown')}) {one.share:.0%}"
        + ("" if one.function in FLIGHT else ", not counted")
        for one in seen.batteries
    ]
    told = f": {'; '.join(each)}" if len(each) > 1 else ""
    return Row("battery", mark, f"{share:.0%}{told}", "charge it")


def _failsafes(config: AgentConfig, seen: Sight) -> list[Row]:
    """What the vehicle does by itself, one row for each thing that may happen."""
    marks = {"error": Mark.FAIL, "warning": Mark.WARN, "info": Mark.PASS}
    parameters = seen.parameters or {}
    rows = [
        Row(
            f"parameter {one.name}" if one.name.isupper() else one.name,
            marks[one.severity],
            one.text,
            one.remedy,
        )
        for one in findings(Kind(seen.kind), parameters, config.id, Around(seen.sticks, seen.components))
    ]
    rows += _coasting(config, Kind(seen.kind), parameters)
    return [*rows, Row("parameters", Mark.PASS if parameters else Mark.FAIL, f"{len(parameters)} read",
                       "see signing" if seen.signing_trouble else "a link that answers")]  # fmt: skip


def _coasting(config: AgentConfig, kind: Kind, parameters: dict[str, float]) -> list[Row]:
    """Whether the own fence holds a multicopter whose agent dies at full speed."""
    own = read_limits(kind, parameters)
    policy = policy_of(config, None, kind not in WINGED, own)
    if policy.coast <= 0.0 or not policy.fences:
        return []
    speed, e = policy.envelope.speed_max, policy.envelope
    way = speed * (policy.reaction + policy.coast) + 0.5 * speed * speed / max(0.1, e.deceleration)
    room = min(deepest(fence) for fence in policy.fences) - policy.fence_margin
    found = f"at {speed:g} m/s it flies on {way:.0f} m, with {policy.coast:g} s of the last velocity"
    if room >= way:
        return [Row("fence, agent dies", Mark.PASS, f"{found}; the fence is {room:.0f} m deep")]
    remedy = "a shorter GUID_TIMEOUT (COM_OF_LOSS_T), a slower envelope.speed_max, or a larger fence"
    return [Row("fence, agent dies", Mark.FAIL, f"{found}; the fence is {room:.0f} m deep only", remedy)]


def _bus(config: AgentConfig, seen: Sight) -> list[Row]:
    if seen.bus_trouble:
        return [Row("bus", Mark.FAIL, seen.bus_trouble, "correct the endpoint or the Zenoh configuration")]
    lock = [_lock(config, seen.lock)] if seen.lock is not None else []
    if not seen.connected:
        found = f"nobody at {seen.bus}" + (f": {seen.bus_status}" if seen.bus_status else "")
        return [Row("bus", Mark.FAIL, found, "start gcs or sim-bridge, or give --bus"), *lock]
    if seen.unserved:
        remedy = "gcs keys init with it in the roster, copy the folders, restart the listener"
        return [Row("bus", Mark.FAIL, f"{seen.bus}: {seen.unserved}", remedy), *lock]
    rows = [Row("bus", Mark.PASS, seen.bus), *lock]
    if not seen.master:
        rows.append(Row("clock", Mark.WARN, f"no master in game '{config.game}' to compare with",
                        "start the master"))  # fmt: skip
        return rows
    offset = abs(seen.offset_s)
    mark = Mark.PASS if offset <= 0.05 else (Mark.WARN if offset <= 0.2 else Mark.FAIL)
    rows.append(Row("clock", mark, f"{seen.offset_s * 1e3:+.0f} ms against the master", "run a time service"))
    return rows


def _lock(config: AgentConfig, found: BusSecurity) -> Row:
    if found.lock is Lock.OPEN:
        mark = Mark.WARN if config.field else Mark.PASS  # without open_bus it would not have opened
        return Row("bus lock", mark, found.words, "gcs keys init, and zenoh = its zenoh.json5")
    member = found.member
    if member is not None and found.words.endswith("EXPIRED"):
        return Row("bus lock", Mark.FAIL, found.words, "gcs keys init, and copy this member's folder again")
    return Row("bus lock", Mark.PASS, found.words)


def _link_lock(seen: Sight) -> Row:
    """Whether what comes over the links is signed with the key that is set."""
    if seen.link_lock is LinkLock.SIGNED:
        return Row("link lock", Mark.PASS, "locked: the autopilot signs with this key")
    if seen.link_lock is LinkLock.REFUSED:
        bad = seen.bad_frames or {}
        causes = ", ".join(f"{name} {n}" for name, n in sorted(bad.items()) if name in SIGNATURES)
        return Row("link lock", Mark.FAIL, f"frames come and are refused: {causes}",
                   "give the autopilot this key; stale or future: set both clocks")  # fmt: skip
    return Row("link lock", Mark.WARN, "a key is set, and no autopilot of this id was heard", "see autopilot")


def table(rows: list[Row]) -> list[str]:
    """The rows as lines of text."""
    width = max(len(row.name) for row in rows)
    lines = []
    for row in rows:
        remedy = f" → {row.remedy}" if row.mark is not Mark.PASS and row.remedy else ""
        lines.append(f"{row.mark.value.upper():4}  {row.name:{width}}  {row.found}{remedy}")
    return lines
