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

from onboard.agent.config import AgentConfig
from onboard.agent.event_file import EventFile, ThreadSink, unused
from onboard.agent.opening import close_bus, open_bus, open_links, signing_of
from onboard.agent.shell import Agent, Equipment
from onboard.agent.version import version
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.game.route_file import load_route
from onboard.runtime.clock import RealClock
from onboard.runtime.protocols import Link
from onboard.runtime.systemd import Notifier
from onboard.wire.bus.messages import Role
from onboard.wire.mavlink.tlog import TlogWriter

FLUSH_NS = NS_PER_S


def fly(config: AgentConfig, timing: Path | None = None) -> int:
    """Fly until SIGTERM or ctrl-C; gives the exit code. Raises ConfigError."""
    return asyncio.run(_fly(config, timing))


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


async def _fly(config: AgentConfig, timing: Path | None) -> int:
    clock = RealClock()
    signing = signing_of(config)
    route = load_route(Path(config.route)) if config.role is Role.TRACKER else None
    log = LogFile(Path(config.log)) if config.log else None
    links = await open_links(config)
    try:
        events = None
        if config.events:
            sink = ThreadSink(unused(Path(config.events)))
            events = EventFile(sink, round(config.events_max_mb * 1e6))
        bus = await open_bus(config)
        notifier = Notifier(clock)
        equipment = Equipment(
            nonce=secrets.randbits(48),
            version=version(),
            record=log.record if log is not None else None,
            events=events,
            signing=signing,
            beat=notifier.alive,
            route=route,
            apart=True,
        )
        agent = Agent(config, clock, links, bus, equipment)
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
        "control_steps": agent.core.steps,
        "control_steps_by_timer": agent.core.timer_steps,
        **t.counters(),
    }
    with contextlib.suppress(OSError):
        path.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
