"""The agent as a process: real clock, real links, Zenoh, signals, the service manager."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import json
import os
import secrets
import signal
from collections.abc import Sequence
from pathlib import Path

from onboard.agent.agent import Agent, to_stderr
from onboard.agent.config import AgentConfig
from onboard.agent.version import version
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.clock import RealClock
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Bus, Link
from onboard.runtime.signing_keys import StampFile, read_key
from onboard.runtime.systemd import Notifier
from onboard.wire.mavlink.signing import Signing
from onboard.wire.mavlink.tlog import TlogWriter

CLOSE_S = 0.5  # for the bus to close; the process ends within 2 s of a signal
FLUSH_NS = NS_PER_S


def fly(config: AgentConfig, timing: Path | None = None) -> int:
    """Fly until SIGTERM or ctrl-C; gives the exit code. Raises ConfigError."""
    return asyncio.run(_fly(config, timing))


def check(config: AgentConfig, seconds: float) -> int:
    """The preflight; gives the exit code. Raises ConfigError."""
    from onboard.agent.preflight import preflight

    return asyncio.run(preflight(config, seconds, print))


def signing_of(config: AgentConfig) -> Signing | None:
    """Signing as configured. Raises ConfigError for a key that is missing or that others may read."""
    if config.signing is None:
        return None
    path = Path(config.signing.key)
    stamps = Path(config.signing.stamps or f"{config.signing.key}.stamps")
    return Signing(read_key(path), StampFile(stamps))


class LogFile:
    """A .tlog that is flushed once a second."""

    def __init__(self, path: Path) -> None:
        try:
            self._file = path.open("ab")
        except OSError as error:
            raise ConfigError(f"log: {path}: {(error.strerror or str(error)).lower()}") from None
        self._writer = TlogWriter(self._file)
        self._flushed_ns = 0
        self.failures = 0

    def record(self, wall_ns: int, frame: bytes) -> None:
        """Write one frame; a full disk must not stop a flight."""
        try:
            self._writer.write(wall_ns, frame)
            if abs(wall_ns - self._flushed_ns) >= FLUSH_NS:
                self._flushed_ns = wall_ns
                self._file.flush()
        except OSError:
            self.failures += 1

    def close(self) -> None:
        """Flush and close."""
        with contextlib.suppress(OSError):
            self._file.close()


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


async def open_bus(config: AgentConfig) -> Bus:
    """Open the bus, there or not. Raises ConfigError."""
    file = Path(config.zenoh) if config.zenoh else None
    return await open_zenoh(config.bus or None, config_file=file)


async def _fly(config: AgentConfig, timing: Path | None) -> int:
    clock = RealClock()
    signing = signing_of(config)
    log = LogFile(Path(config.log)) if config.log else None
    links = await open_links(config)
    try:
        bus = await open_bus(config)
        notifier = Notifier(clock)
        agent = Agent(
            config,
            clock,
            links,
            bus,
            nonce=secrets.randbits(48),
            version=version(),
            log=to_stderr,
            record=log.record if log is not None else None,
            signing=signing,
            beat=notifier.alive,
        )
        _catch_signals(agent)
        gc.collect()
        gc.freeze()  # what was imported is never garbage: collections in flight stay short
        notifier.ready()
        await agent.run()
        notifier.stopping()
        notifier.close()
        if timing is not None:
            _write_timing(timing, agent)
        closed = await close_bus(bus)
    finally:
        _release(links, log)
    if not closed:  # a bus that does not answer must not keep the process: everything else is done
        os._exit(0)
    return 0


def _release(links: Sequence[Link], log: LogFile | None) -> None:
    for link in links:
        link.close()
    if log is not None:
        log.close()


async def close_bus(bus: Bus) -> bool:
    """Close the bus within `CLOSE_S`; False where it does not answer."""
    try:
        async with asyncio.timeout(CLOSE_S):
            await bus.close()
    except TimeoutError:
        return False
    return True


def _catch_signals(agent: Agent) -> None:
    """The first signal lands softly, the second ends at once."""
    loop = asyncio.get_running_loop()
    asked = False

    def ask() -> None:
        nonlocal asked
        if asked:
            os._exit(1)
        asked = True
        agent.stop()

    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, ask)


def _write_timing(path: Path, agent: Agent) -> None:
    t = agent.timing
    report = {
        "id": agent.id,
        "latency_p50_us": t.percentile_us(0.5),
        "latency_p99_us": t.percentile_us(0.99),
        **t.counters(),
    }
    with contextlib.suppress(OSError):
        path.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
