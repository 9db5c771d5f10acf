"""`onboard-agent check`: what is in order before a flight, what is not, and what to do about it.

`preflight_rows` judges what `look` has seen.
"""

from __future__ import annotations

import asyncio
import importlib.util
import shutil
from collections.abc import Callable, Hashable, Sequence
from functools import partial
from pathlib import Path

from onboard.agent.config import AgentConfig
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.events import Instant, LinkFacts, Outbox, Send, Subscribe
from onboard.agent.core.journal import Journal
from onboard.agent.core.mavlink_radio import Radio
from onboard.agent.core.signing_watch import SigningWatch
from onboard.agent.core.vehicle_link import VehicleLink
from onboard.agent.opening import close_bus, open_bus, open_links, security, signing_of
from onboard.agent.preflight_rows import Mark, Sight, judge, table
from onboard.autopilot.failsafes import sticks_heard
from onboard.autopilot.parameters import CHECKED
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_field import FieldBus
from onboard.runtime.bus_zenoh import ZenohBus
from onboard.runtime.clock import RealClock
from onboard.runtime.protocols import Bus, Clock, Link, Sample
from onboard.runtime.zenoh_config import DEFAULT_ENDPOINT
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.ids import MessageId
from onboard.wire.mavlink.signing import Signing

HARMLESS = ("no_peer", "muted", "twin", "signed_without_key", "unknown_id")
"""Counted, but no bad frames: a message newer than the dialect is none."""
DIALECT = "pymavlink.dialects.v20.ardupilotmega"
UNSERVED_S = 4.0  # a listener that answers nothing is known by then
PEERS_MAX = 64  # of one link that are told apart


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
        self._signing = SigningWatch(self._radio)
        self._second = False  # another autopilot was heard

    async def listen(self, seen: Sight, seconds: float) -> Sight:
        """Listen for `seconds`; shorter where there is no link."""
        for index, link in enumerate(self._links):
            link.receive(partial(self._arrived, index))
        self._view.open()
        self._do(self._instant())
        begun = self._instant().s
        least = UNSERVED_S if isinstance(self._bus, FieldBus) else 0.0
        patience = max(least, seconds if self._links else min(seconds, 2.0))
        called = 0  # seconds in which it was asked who is there
        while (past := self._instant().s - begun) < patience:
            if self._links:
                now = self._instant()
                if past >= called and self._radio.received == 0:  # some answer only whom they have heard
                    called += 1
                    self._radio.send(commands.request_message(self._vehicle.to, MessageId.AUTOPILOT_VERSION))
                self._vehicle.read_also(CHECKED)
                self._vehicle.chores(now.s)
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
        version, telemetry = vehicle.version, vehicle.look(now.s)
        return seen._replace(
            now=now.s,
            link=self._radio.active,
            datagrams=self._radio.received,
            kind=vehicle.adapter.kind.value if vehicle.adapter is not None else "",
            refusal=vehicle.refusal,
            other_systems=tuple(sorted(vehicle.heard_systems)),
            link_lock=self._radio.lock,
            version="" if version is None else ".".join(map(str, version.flight[:3])),
            uid=0 if version is None else version.uid,
            second=self._second or vehicle.second_heard,
            components=tuple(vehicle.components),
            telemetry=telemetry,
            batteries=vehicle.observer.batteries,
            sticks=sticks_heard(now.s, telemetry, vehicle.parameters),
            signing_trouble=self._signing.trouble(now.s, telemetry.heartbeat_at),
            position_rate=vehicle.position_rate.value,
            shortfall=vehicle.shortfall,
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
        received = self._radio.take(index, numbers.setdefault(peer, len(numbers)), data, now)
        self._second = self._second or received.second
        for packet in received.packets:
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
