"""`onboard-agent check`: what is in order before a flight, what is not, and what to do about it.

The rows are judged by a plain function from what was seen; `preflight` looks.
"""

from __future__ import annotations

import asyncio
import importlib.util
import shutil
from collections.abc import Callable, Hashable, Sequence
from enum import Enum
from functools import partial
from pathlib import Path
from typing import NamedTuple

from onboard.agent.config import AgentConfig
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.events import Instant, LinkFacts, Outbox, Send, Subscribe
from onboard.agent.core.journal import Journal
from onboard.agent.core.mavlink_radio import Radio
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.agent.opening import close_bus, open_bus, open_links, security, signing_of
from onboard.autopilot.base import Telemetry
from onboard.autopilot.parameters import findings
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NEVER, NS_PER_S
from onboard.runtime.bus_field import FieldBus
from onboard.runtime.bus_security import BusSecurity, Lock
from onboard.runtime.bus_zenoh import ZenohBus
from onboard.runtime.clock import RealClock
from onboard.runtime.protocols import Bus, Clock, Link, Sample
from onboard.runtime.zenoh_config import DEFAULT_ENDPOINT
from onboard.wire.bus.messages import LinkLock
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.frames import SIGNATURES
from onboard.wire.mavlink.ids import MessageId
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.signing import Signing

ENOUGH = 0.7  # of the position rate that was asked for
DISK_MIN = 200e6  # bytes free, for logs
HARMLESS = ("no_peer", "muted", "twin")  # counted, but no bad frames
DIALECT = "pymavlink.dialects.v20.ardupilotmega"
UNSERVED_S = 4.0  # a listener that answers nothing is known by then
PEERS_MAX = 64  # of one link that are told apart


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
    version: str = ""
    telemetry: Telemetry = Telemetry()
    position_rate: float = 0.0  # [Hz]
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
        mark = Mark.WARN if config.field else Mark.PASS
        rows.append(Row("signing key", mark, "none: anybody on the link can command the vehicle",
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
    if not seen.kind:
        others = ", ".join(map(str, seen.other_systems))
        found = f"none with system id {config.id}" + (f", but system {others}" if others else "")
        return [Row("autopilot", Mark.FAIL, found, "give the vehicle's MAVLink system id as --id")]
    t = seen.telemetry
    rows = [Row("autopilot", Mark.PASS, f"{seen.kind} {seen.version or 'of unknown version'}, in {t.mode}")]
    wanted = config.control_rate_hz
    rate = f"position at {seen.position_rate:.1f} Hz of {wanted:g}"
    rows.append(Row("rates", Mark.PASS if seen.position_rate >= ENOUGH * wanted else Mark.FAIL, rate,
                    "a faster link, or a lower control_rate_hz"))  # fmt: skip
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
    if t.battery < 0.0:
        rows.append(Row("battery", Mark.WARN, "not reported: the supervisor cannot watch it", "set it up"))
    else:
        mark = Mark.PASS if t.battery >= 2.0 * config.safety.battery else Mark.FAIL
        rows.append(Row("battery", mark, f"{t.battery:.0%}", "charge it"))
    kind = Kind(seen.kind)
    parameters = seen.parameters or {}
    troubles = findings(kind, parameters, config.id)
    for trouble in troubles:
        mark = Mark.FAIL if trouble.severity == "error" else Mark.WARN
        rows.append(Row(f"parameter {trouble.name}", mark, trouble.text, trouble.remedy))
    if not troubles:
        rows.append(Row("parameters", Mark.PASS, f"{len(parameters)} read, failsafes set"))
    return rows


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


def check(config: AgentConfig, seconds: float) -> int:
    """The preflight; gives the exit code. Raises ConfigError."""
    return asyncio.run(preflight(config, seconds, print))


async def preflight(config: AgentConfig, seconds: float, say: Callable[[str], None]) -> int:
    """Listen for `seconds`, print the table; 0 where nothing failed, else 1."""
    seen = await look(config, seconds)
    rows = judge(config, seen)
    for line in table(rows):
        say(line)
    failed = sum(row.mark is Mark.FAIL for row in rows)
    warned = sum(row.mark is Mark.WARN for row in rows)
    say(f"{'not ready' if failed else 'ready'}: {failed} failed, {warned} warnings")
    return 1 if failed else 0


async def look(config: AgentConfig, seconds: float) -> Sight:
    """See what there is. Nothing is commanded: message rates and parameters are asked for.

    No heartbeat is sent: an autopilot that watches this system as its ground station would take the end of
    the check for the loss of it."""
    seen = Sight(bytecode=bytecode(), free_bytes=free_bytes(config))
    signing: Signing | None = None
    try:
        signing = signing_of(config)
        seen = seen._replace(signed=signing is not None)
    except ConfigError as error:
        seen = seen._replace(key_trouble=str(error))
    bus: ZenohBus | None = None
    try:
        seen = seen._replace(lock=security(config))
        bus = await open_bus(config)
    except ConfigError as error:
        seen = seen._replace(bus_trouble=str(error))
    try:
        links: list[Link] = []
        try:
            links = await open_links(config)
        except ConfigError as error:
            seen = seen._replace(link_trouble=str(error))
        try:
            seen = await Ears(config, links, bus, signing, RealClock()).listen(seen, seconds)
        finally:
            for link in links:
                link.close()
        if bus is not None:
            seen = seen._replace(bus_status=bus.status(), unserved=bus.trouble())
    finally:
        if bus is not None:
            await close_bus(bus)
    return seen


class Ears:
    """The listening parts of the agent: radio, vehicle link and bus view, without anything that flies."""

    def __init__(
        self,
        config: AgentConfig,
        links: Sequence[Link],
        bus: Bus | None,
        signing: Signing | None,
        clock: Clock,
    ) -> None:
        self._config = config
        self._links = links
        self._bus = bus
        self._clock = clock
        self._out = Outbox()
        self._journal = Journal(config.id, config.game, 0)
        facts = [LinkFacts(link.name, link.name.startswith("serial:")) for link in links]
        self._radio = Radio(facts, config.id, self._out, signing=signing, mute=config.dry_run)
        self._vehicle = VehicleLink(config, self._radio, self._journal, self._out)
        self._view = BusView(config, 0, self._out, self._journal)
        self._numbers: list[dict[Hashable, int]] = [{} for _ in links]

    async def listen(self, seen: Sight, seconds: float) -> Sight:
        """Listen for `seconds`; shorter where there is no link."""
        for index, link in enumerate(self._links):
            link.receive(partial(self._arrived, index))
        self._view.open()
        self._do(self._instant())
        begun = self._instant().s
        asked = 0
        least = UNSERVED_S if isinstance(self._bus, FieldBus) else 0.0
        patience = max(least, seconds if self._links else min(seconds, 2.0))
        while (past := self._instant().s - begun) < patience:
            if self._links:
                now = self._instant()
                self._vehicle.chores(now.s)
                if past >= asked and self._vehicle.version is None:
                    asked += 1
                    self._radio.send(commands.request_message(self._vehicle.to, MessageId.AUTOPILOT_VERSION))
                self._do(now)
            await asyncio.sleep(0.05)
        return self._found(seen)

    def _found(self, seen: Sight) -> Sight:
        config, vehicle, now = self._config, self._vehicle, self._instant()
        if self._bus is not None:
            seen = seen._replace(
                bus=config.bus or config.zenoh or DEFAULT_ENDPOINT,
                connected=self._bus.connected(),
                master=self._view.clock.known,
                offset_s=self._view.clock.offset_s,
            )
        if not self._links:
            return seen
        version = vehicle.version
        return seen._replace(
            now=now.s,
            link=self._radio.active,
            datagrams=self._radio.received,
            kind=vehicle.adapter.kind.value if vehicle.adapter is not None else "",
            refusal=vehicle.refusal,
            other_systems=tuple(sorted(vehicle.heard_systems)),
            link_lock=self._radio.lock,
            version="" if version is None else ".".join(map(str, version.flight[:3])),
            telemetry=vehicle.look(now.s),
            position_rate=vehicle.position_rate.value,
            parameters=vehicle.parameters,
            bad_frames={cause: n for cause, n in self._radio.causes.items() if cause not in HARMLESS},
        )

    def _instant(self) -> Instant:
        return Instant(self._clock.monotonic_ns() / NS_PER_S, self._clock.wall_ns())

    def _arrived(self, index: int, data: bytes, peer: Hashable) -> None:
        numbers = self._numbers[index]
        if peer not in numbers and len(numbers) >= PEERS_MAX:
            return
        now = self._instant()
        for packet in self._radio.take(index, numbers.setdefault(peer, len(numbers)), data, now).packets:
            self._vehicle.hear(packet, now.s)
        self._do(now)

    def _heard(self, sample: Sample) -> None:
        self._view.take(sample.key, sample.payload, self._instant())

    def _do(self, now: Instant) -> None:
        """Send and subscribe; everything else that the parts want is an agent's."""
        self._radio.flush(now)
        for effect in self._out.take():
            if isinstance(effect, Send):
                numbers = self._numbers[effect.link]
                peer = next((p for p, number in numbers.items() if number == effect.peer), None)
                self._links[effect.link].send(effect.frame, peer)
            elif isinstance(effect, Subscribe) and self._bus is not None:
                self._bus.subscribe(effect.key, self._heard)


def bytecode() -> bool:
    """Whether the MAVLink dialect, the largest module by far, has compiled bytecode."""
    found = importlib.util.find_spec(DIALECT)
    return found is not None and found.cached is not None and Path(found.cached).is_file()


def free_bytes(config: AgentConfig) -> float:
    """Free space where the log goes, or here [bytes]."""
    place = Path(config.log).resolve().parent if config.log else Path.cwd()
    try:
        return float(shutil.disk_usage(place).free)
    except OSError:
        return 0.0
