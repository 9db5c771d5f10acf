"""The agent as a process: real clock, real links, Zenoh, signals, the service manager."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import json
import os
import secrets
import signal
import threading
from pathlib import Path

from onboard.agent.config import AgentConfig
from onboard.agent.lean import settle
from onboard.agent.opening import close_bus, master_of, open_bus, open_links, signing_of
from onboard.agent.shell import Agent, Equipment
from onboard.agent.written_files import WrittenFiles
from onboard.config.version import version
from onboard.game.route_file import load_route
from onboard.runtime.clock import RealClock
from onboard.runtime.fast_loop import loop_factory, loop_name
from onboard.runtime.protocols import Link
from onboard.runtime.resources import ROUTES, shipped_file
from onboard.runtime.systemd import Notifier
from onboard.wire.bus.messages import Role

END_S = 5.0  # from the first signal to the end of the process, at the latest


def fly(config: AgentConfig, timing: Path | None = None) -> int:
    """Fly until SIGTERM or ctrl-C; gives the exit code. Raises ConfigError."""
    with asyncio.Runner(loop_factory=loop_factory()) as runner:
        return runner.run(_fly(config, timing))


async def _fly(config: AgentConfig, timing: Path | None) -> int:
    clock = RealClock()
    files = WrittenFiles(config)
    links: list[Link] = []
    closed = True
    try:
        signing = signing_of(config, files.stamps)
        route = load_route(shipped_file(Path(config.route), ROUTES)) if config.role is Role.TRACKER else None
        links = await open_links(config)
        bus = await open_bus(config)
        notifier = Notifier(clock)
        equipment = Equipment(
            nonce=secrets.randbits(48),
            version=version(),
            log=files.line,
            record=files.record if files.logs else None,
            events=files.events,
            signing=signing,
            beat=notifier.alive,
            route=route,
            counters=files.counters,
            master=master_of(bus),
            apart=True,
        )
        agent = Agent(config, clock, links, bus, equipment)
        _catch_signals(agent)
        settle()
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
        for link in links:
            link.close()
        written = files.close()
    if not (closed and written):  # what does not answer must not keep the process: everything else is done
        os._exit(0)
    return 0


def _catch_signals(agent: Agent) -> None:
    """The first signal lands softly, the second ends at once; a loop that does not turn is not waited for."""
    loop = asyncio.get_running_loop()
    asked = False

    def ask() -> None:
        nonlocal asked
        if asked:
            os._exit(1)
        asked = True
        agent.stop()

    def bound(number: int, frame: object) -> None:
        """Runs between two instructions, even of an endless loop: the process ends, whatever holds it."""
        timer = threading.Timer(END_S, os._exit, (1,))
        timer.daemon = True
        timer.start()

    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, ask)
        signal.signal(number, bound)  # beside the loop's own way of hearing of it, which stays


def _write_timing(path: Path, agent: Agent) -> None:
    t = agent.timing
    report = {
        "id": agent.id,
        "loop": loop_name(asyncio.get_running_loop()),
        "latency_p50_us": t.percentile_us(0.5),
        "latency_p99_us": t.percentile_us(0.99),
        "control_steps": agent.core.steps,
        "control_steps_by_timer": agent.core.timer_steps,
        **t.counters(),
    }
    with contextlib.suppress(OSError):
        path.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
