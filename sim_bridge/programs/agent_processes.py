"""The agents of a game as processes of their own, each started again when it dies."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec

from onboard.config.strict import ConfigError
from onboard.config.undecodable import UNDECODABLE
from onboard.game.scenario import Scenario
from onboard.runtime.whole_files import write_whole
from onboard.runtime.zenoh_config import DEFAULT_ENDPOINT
from onboard.wire.bus.topics import DEFAULT_GAME
from sim_bridge.programs import run_folder

RESTARTS_MAX = 5  # of one agent
RESTART_S = 0.5  # from an agent's unexpected end to its next start [s]
STOP_S = 4.0  # from SIGTERM to SIGKILL [s]
WRONG_SETTINGS = 2  # exit code of an agent that was told something it cannot do


class AgentProcesses:
    """One `onboard-agent` process per vehicle; files and logs of the agents lie in the run folder.

    Set `ports` and then `bridge_up` once the bridge answers; set `over` to end the agents.
    """

    def __init__(self, scenario: Scenario, bus: str, folder: Path, say: Callable[[str], None]) -> None:
        """`bus` is the Zenoh endpoint, "" = the default one; `say` is told of each restart."""
        self.ports: dict[int, int] = {}  # UDP port on which each vehicle's agent listens
        self.bridge_up = asyncio.Event()
        self.over = asyncio.Event()
        self.restarts = 0
        self._scenario = scenario
        self._bus = bus or DEFAULT_ENDPOINT
        self._folder = folder
        self._say = say

    async def run(self) -> None:
        """Start every agent once the bridge is up, restart those that die, end all when the game is over.

        Raises a group of ConfigError where an agent refuses its settings.
        """
        waiting = [asyncio.ensure_future(self.bridge_up.wait()), asyncio.ensure_future(self.over.wait())]
        await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
        for future in waiting:
            future.cancel()
        if not self.bridge_up.is_set():
            return
        async with asyncio.TaskGroup() as group:
            for id in self._scenario.flown_ids:
                group.create_task(self._keep(f"agent {id}", self._agent_command(id), f"agent-{id}.log"))

    def timings(self) -> dict[str, object]:
        """The timing that each agent measured of itself, by vehicle id; removes the files it comes from."""
        found: dict[str, object] = {}
        for id in self._scenario.flown_ids:
            path = self._folder / f".timing-{id}.json"
            with contextlib.suppress(OSError, *UNDECODABLE):
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
            if code == WRONG_SETTINGS:  # no use in trying again
                raise ConfigError(f"{name}: {self._last_line(log)}")
            self.restarts += 1
            self._say(f"{name} ended with code {code} and is started again (see {log})")
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(RESTART_S):
                    await self.over.wait()

    async def _run_once(self, command: list[str], log: str) -> int:
        """Run one process to its end, or end it when the game is over; gives its exit code."""
        with (self._folder / log).open("ab") as file:
            process = await asyncio.create_subprocess_exec(
                *command,
                stdin=asyncio.subprocess.DEVNULL,
                stdout=file,
                stderr=file,
                env={**os.environ, "PYTHONUNBUFFERED": "1"},
                process_group=0,  # ctrl-C at the terminal is for this process, which ends them in order
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

    def _last_line(self, log: str) -> str:
        with contextlib.suppress(OSError):
            lines = (self._folder / log).read_text(encoding="utf-8", errors="replace").splitlines()
            return lines[-1] if lines else "no word"
        return "no word"

    def _agent_command(self, id: int) -> list[str]:
        spec = self._scenario.vehicles[self._scenario.ids.index(id)]
        flight = self._scenario.flight
        settings: dict[str, Any] = {
            "id": id,
            "role": self._scenario.role_of(id).value,
            "game": DEFAULT_GAME,
            "link": [f"udpin://127.0.0.1:{self.ports[id]}"],
            "bus": self._bus,
            "strategy": spec.strategy,
            "take_control": True,
            "may_arm": flight.ground_start,
            "control_rate_hz": flight.control_rate_hz,
            "prediction": flight.prediction.value,
            "log": f"vehicle-{id}.tlog",
            "events": f"vehicle-{id}.events",
        }
        path = self._folder / f"agent-{id}.toml"
        text = run_folder.toml_of(settings)
        write_whole(path, text.encode())
        timing = self._folder / f".timing-{id}.json"
        return [
            sys.executable, "-m", "onboard.cli", "--config", str(path),
            "--log", str(self._folder / settings["log"]), "--events", str(self._folder / settings["events"]),
            "--timing", str(timing),
        ]  # fmt: skip
