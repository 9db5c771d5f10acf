"""A whole game in real processes: agents as subprocesses, UDP and Zenoh on loopback."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from onboard.core.vectors import distance
from onboard.runtime.bus_zenoh import DEFAULT_ENDPOINT, ZenohBus
from onboard.runtime.clock import RealClock
from onboard.runtime.scenario import Scenario
from onboard.runtime.staging import target_of
from onboard.wire.swarm import Phase
from onboard.wire.topics import DEFAULT_GAME
from sim_bridge import run_folder
from sim_bridge.bridge import Bridge
from sim_bridge.observer import Observer
from sim_bridge.rehearsal import BusRecorder
from sim_bridge.serve import Options as ServeOptions
from sim_bridge.serve import serve_scenario
from sim_bridge.summary import Summary

if TYPE_CHECKING:
    from sim_bridge.fly import Options

RESTARTS_MAX = 5
TELL_S = 5.0
STOP_S = 4.0


async def fly_real(
    scenario: Scenario, options: Options, folder: Path, home: Path, say: Callable[[str], None]
) -> tuple[Summary, dict[str, object]]:
    """Play it; gives the summary and what was measured on the wall clock."""
    crew = Crew(scenario, options, folder, say)
    seen: dict[str, Any] = {}

    recorder = BusRecorder(folder, DEFAULT_GAME, RealClock())

    def started(bridge: Bridge, bus: ZenohBus, ports: dict[int, int]) -> None:
        recorder.hear(bus)
        seed = scenario.seed if options.seed is None else options.seed
        seen["bridge"] = bridge
        seen["observer"] = Observer(scenario, seed, "real", DEFAULT_GAME, bus)
        crew.ports = ports
        crew.aboard.set()

    serve_options = ServeOptions(
        bus=options.bus, listen=True, once=True, seed=options.seed, ground_stations=True
    )
    async with asyncio.TaskGroup() as group:
        hands = group.create_task(crew.work(), name="crew")
        teller = group.create_task(_tell(scenario, seen, say), name="teller")
        keeper = group.create_task(recorder.run(), name="recorder")
        try:
            outcome = await serve_scenario(scenario, serve_options, say, None, home, started)
        finally:
            teller.cancel()
            keeper.cancel()
            crew.over.set()
            recorder.close()
        await hands
    bridge: Bridge = seen["bridge"]
    observer: Observer = seen["observer"]
    assert bridge.master is not None
    summary = observer.summary(bridge.master.rules, outcome, bridge.sensor, {})
    timing: dict[str, object] = {
        "world": bridge.pace.counters(),
        "agents": crew.timings(),
        "agents_started_again": crew.restarts,
    }
    return summary, timing


async def _tell(scenario: Scenario, seen: dict[str, Any], say: Callable[[str], None]) -> None:
    """What is going on, every few seconds."""
    target = target_of(scenario)
    evader = scenario.ids[0]
    while True:
        await asyncio.sleep(TELL_S)
        bridge: Bridge | None = seen.get("bridge")
        if bridge is None or bridge.master is None:
            continue
        rules = bridge.master.rules
        motions = bridge.world.motions
        if rules.phase is not Phase.RUNNING:
            continue
        place = motions[evader].position
        far = {id: distance(motions[id].position, place) for id in scenario.ids[1:]}
        nearest = min(far, key=lambda id: far[id])
        t = (bridge.world.wall_ns - rules.t0_ns) / 1e9
        goal = f", target {distance(place, target):.0f} m away" if target is not None else ""
        say(f"  t = {t:5.1f} s: nearest pursuer {nearest} at {far[nearest]:.1f} m{goal}")


class Crew:
    """The agents: a process each, started again when it dies."""

    def __init__(
        self, scenario: Scenario, options: Options, folder: Path, say: Callable[[str], None]
    ) -> None:
        self.ports: dict[int, int] = {}
        self.aboard = asyncio.Event()  # the bridge is up
        self.over = asyncio.Event()  # the game is over
        self.restarts = 0
        self._scenario = scenario
        self._options = options
        self._folder = folder
        self._say = say

    async def work(self) -> None:
        """Start everybody, start again who dies, end everybody."""
        waiting = [asyncio.ensure_future(self.aboard.wait()), asyncio.ensure_future(self.over.wait())]
        await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
        for future in waiting:
            future.cancel()
        if not self.aboard.is_set():
            return
        async with asyncio.TaskGroup() as group:
            for id in self._scenario.ids:
                group.create_task(self._keep(f"agent {id}", self._agent_command(id), f"agent-{id}.log"))

    def timings(self) -> dict[str, object]:
        """What the agents measured of themselves."""
        found: dict[str, object] = {}
        for id in self._scenario.ids:
            path = self._folder / f".timing-{id}.json"
            with contextlib.suppress(OSError, msgspec.DecodeError):
                found[str(id)] = msgspec.json.decode(path.read_bytes())
            path.unlink(missing_ok=True)
        return found

    async def _keep(self, name: str, command: list[str], log: str) -> None:
        """Keep one process running until the game is over."""
        starts = 0
        while not self.over.is_set() and starts <= RESTARTS_MAX:
            starts += 1
            code = await self._run_once(command, log)
            if self.over.is_set():
                return
            self.restarts += 1
            self._say(f"{name} ended with code {code} and is started again (see {log})")
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(0.5):
                    await self.over.wait()

    async def _run_once(self, command: list[str], log: str) -> int:
        with (self._folder / log).open("ab") as file:
            process = await asyncio.create_subprocess_exec(
                *command,
                stdin=asyncio.subprocess.DEVNULL,
                stdout=file,
                stderr=file,
                env={**os.environ, "PYTHONUNBUFFERED": "1"},
            )
        ended = asyncio.ensure_future(process.wait())
        over = asyncio.ensure_future(self.over.wait())
        try:
            await asyncio.wait({ended, over}, return_when=asyncio.FIRST_COMPLETED)
            if not ended.done():
                process.send_signal(signal.SIGTERM)
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(STOP_S):
                        await asyncio.shield(ended)
        finally:
            over.cancel()
            if process.returncode is None:
                with contextlib.suppress(ProcessLookupError):
                    process.kill()
            await process.wait()
        return process.returncode if process.returncode is not None else -1

    def _agent_command(self, id: int) -> list[str]:
        spec = self._scenario.vehicles[self._scenario.ids.index(id)]
        flight = self._scenario.flight
        settings: dict[str, Any] = {
            "id": id,
            "role": "evader" if spec is self._scenario.evader else "pursuer",
            "game": DEFAULT_GAME,
            "link": [f"udpin://127.0.0.1:{self.ports[id]}"],
            "bus": self._options.bus or DEFAULT_ENDPOINT,
            "strategy": spec.strategy,
            "take_control": True,
            "may_arm": flight.ground_start,
            "control_rate_hz": flight.control_rate_hz,
            "log": str(self._folder / f"vehicle-{id}.tlog"),
        }
        path = self._folder / f"agent-{id}.toml"
        text = run_folder.toml_of({**settings, "log": f"vehicle-{id}.tlog"})
        run_folder.write_bytes(path, text.encode())
        timing = self._folder / f".timing-{id}.json"
        return [
            sys.executable, "-m", "onboard.cli", "--config", str(path), "--log", settings["log"],
            "--timing", str(timing),
        ]  # fmt: skip
