"""Opens what an agent needs, as its configuration says: links, bus, signing."""

from __future__ import annotations

import asyncio
from pathlib import Path

from onboard.agent.config import AgentConfig
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_field import FieldBus
from onboard.runtime.bus_security import BusSecurity, Lock, security_of
from onboard.runtime.bus_zenoh import ZenohBus, open_zenoh
from onboard.runtime.clock import RealClock
from onboard.runtime.file_writer import FileWriter
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Bus, Link
from onboard.runtime.signing_keys import StampFile, read_key
from onboard.wire.mavlink.signing import Signing

CLOSE_S = 0.5  # for the bus to close; the process ends within 2 s of a signal


def stamps_of(config: AgentConfig, writer: FileWriter | None = None) -> StampFile | None:
    """Where the stamps of the configured key are kept, written by `writer`; None without a key."""
    if config.signing is None:
        return None
    return StampFile(Path(config.signing.stamps or f"{config.signing.key}.stamps"), writer)


def signing_of(config: AgentConfig, stamps: StampFile | None = None) -> Signing | None:
    """Signing as configured. Raises ConfigError for a key that is missing or that others may read."""
    store = stamps or stamps_of(config)
    if config.signing is None or store is None:
        return None
    return Signing(read_key(Path(config.signing.key)), store)


async def open_links(config: AgentConfig) -> list[Link]:
    """Open all links. Raises ConfigError."""
    links: list[Link] = []
    try:
        for url in config.links:
            links.append(await open_link(url))
    except ConfigError:
        for link in links:
            link.close()
        raise
    return links


async def open_bus(config: AgentConfig) -> ZenohBus:
    """Open the bus, there or not. Raises ConfigError, also for an open bus in the field."""
    refuse_open_bus(config, security(config))
    return await open_zenoh(config.bus or None, config_file=_zenoh_file(config))


def security(config: AgentConfig) -> BusSecurity:
    """The lock of the bus that the configuration names. Raises ConfigError."""
    now_s = RealClock().wall_ns() / NS_PER_S
    return security_of(config.bus or None, _zenoh_file(config), now_s)


def refuse_open_bus(config: AgentConfig, found: BusSecurity) -> None:
    """Raise ConfigError where a flight in the field would be open to whoever reaches the network."""
    if config.field and found.lock is Lock.OPEN and not config.open_bus:
        raise ConfigError(
            f"zenoh: found a bus that is {found.words}, expected keys, or open_bus = true, "
            "because field = true (docs/security.md)"
        )


def master_of(bus: Bus) -> str:
    """The member of the bus's field whose certificate may write as the master; "" where there are no keys."""
    return bus.member.master if isinstance(bus, FieldBus) else ""


def _zenoh_file(config: AgentConfig) -> Path | None:
    return Path(config.zenoh) if config.zenoh else None


async def close_bus(bus: Bus) -> bool:
    """Close the bus within `CLOSE_S`; False where it does not answer."""
    try:
        async with asyncio.timeout(CLOSE_S):
            await bus.close()
    except TimeoutError:
        return False
    return True
