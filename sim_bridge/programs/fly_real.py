"""A whole game in real processes: agents as subprocesses, UDP and Zenoh on loopback."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import distance
from onboard.game.master import Standing
from onboard.game.scenario import Scenario
from onboard.game.staging import target_of
from onboard.runtime.bus_zenoh import DEFAULT_ENDPOINT, ZenohBus
from onboard.runtime.clock import RealClock
from onboard.runtime.protocols import Sample
from onboard.wire.bus import messages as swarm
from onboard.wire.bus.messages import Event, Outcome, Phase, Severity
from onboard.wire.bus.topics import DECISION, DEFAULT_GAME, key
from sim_bridge.programs import run_folder
from sim_bridge.programs.serve import Options as ServeOptions
from sim_bridge.programs.serve import serve_scenario
from sim_bridge.programs.summary import Summary
from sim_bridge.rehearsal import BusRecorder
from sim_bridge.world.bridge import Bridge
from sim_bridge.world.run_observer import Observer

if TYPE_CHECKING:
    from sim_bridge.programs.fly import Options

RESTARTS_MAX = 5
TELL_S = 5.0
STOP_S = 4.0
WRONG_SETTINGS = 2  # exit code of an agent that was told something it cannot do


async def fly_real(
    scenario: Scenario, options: Options, folder: Path, home: Path, say: Callable[[str], None]
) -> tuple[Summary, dict[str, object]]:
    """Play it; gives the summary and what was measured on the wall clock."""
    show = Show(scenario, options, folder, say)
    serve_options = ServeOptions(
        bus=options.bus, listen=True, once=True, seed=options.seed, ground_stations=True
    )
    try:
        outcome = await show.play(serve_options, home)
    except BaseExceptionGroup as group:
        mistake = _mistake(group)
        if mistake is None:
            raise
        raise mistake from None
    bridge, observer, crew = show.bridge, show.observer, show.crew
    assert bridge is not None
    assert observer is not None
    assert bridge.master is not None
    rules = bridge.master.rules
    if rules.standing is Standing.YIELDED:
        raise ConfigError(
            f"bus: found another game at work at {options.bus or DEFAULT_ENDPOINT}, expected none: "
            "end it, or choose another place with --bus"
        )
    summary = observer.summary(rules, outcome, bridge.sensor, {})
    timing: dict[str, object] = {
        "world": bridge.pace.counters(),
        "world_steps_lost": bridge.world.lost_steps,
        "agents": crew.timings(),
        "agents_started_again": crew.restarts,
    }
    return summary, timing


def _mistake(group: BaseExceptionGroup[BaseException]) -> ConfigError | None:
    """The user's mistake among what went wrong, if that is all that did."""
    mistakes, others = group.split(ConfigError)
    if mistakes is None or others is not None:
        return None
    first = mistakes.exceptions[0]
    return first if isinstance(first, ConfigError) else _mistake(first)


class Show:
    """One game: the bridge in this process, the crew beside it, a recorder, and what is told of it all."""

    def __init__(
        self, scenario: Scenario, options: Options, folder: Path, say: Callable[[str], None]
    ) -> None:
        self.bridge: Bridge | None = None
        self.observer: Observer | None = None
        self.crew = Crew(scenario, options, folder, say)
        self._scenario = scenario
        self._seed = scenario.seed if options.seed is None else options.seed
        self._say = say
        self._recorder = BusRecorder(folder, DEFAULT_GAME, RealClock())
        self._rule = ""  # by which the evader decided last
        self._drops: Counter[str] = Counter()

    async def play(self, options: ServeOptions, home: Path) -> Outcome | None:
        """From the first agent's start to the last one's end. Raises groups of ConfigError."""
        try:
            async with asyncio.TaskGroup() as group:
                hands = group.create_task(self.crew.work(), name="crew")
                beside = [
                    group.create_task(self._tell(), name="teller"),
                    group.create_task(self._recorder.run(), name="recorder"),
                ]

                async def dismiss() -> None:
                    """The agents end first, while there still is something to fly."""
                    self.crew.over.set()
                    await asyncio.wait([hands])

                try:
                    return await serve_scenario(
                        self._scenario, options, self._say, None, home, self._started, dismiss
                    )
                finally:
                    self.crew.over.set()
                    for task in beside:
                        task.cancel()
        finally:
            self._recorder.close()

    def _started(self, bridge: Bridge, bus: ZenohBus, ports: dict[int, int]) -> None:
        self._recorder.hear(bus)
        self.bridge = bridge
        self.observer = Observer(self._scenario, self._seed, "real", DEFAULT_GAME, bus, self._heard)
        bus.subscribe(key(DEFAULT_GAME, DECISION, self._scenario.ids[0]), self._decided)
        self.crew.ports = ports
        self.crew.aboard.set()

    def _heard(self, event: Event) -> None:
        if event.severity is not Severity.INFO:
            self._say(f"  vehicle {event.id}: {event.text}")

    def _decided(self, sample: Sample) -> None:
        decision = swarm.DECISION.decode(sample.payload, self._drops)
        if decision is not None:
            self._rule = decision.rule.replace("_", " ")

    async def _tell(self) -> None:
        """What is going on, every few seconds."""
        while True:
            await asyncio.sleep(TELL_S)
            bridge = self.bridge
            if bridge is None or bridge.master is None:
                continue
            rules = bridge.master.rules
            if rules.phase is Phase.RUNNING:
                self._say(self._line(bridge, (bridge.world.wall_ns - rules.t0_ns) / NS_PER_S))
            elif rules.phase is Phase.STAGING:
                lacking = rules.lacking(RealClock().monotonic_ns())
                for id, reason in sorted(lacking.items()):
                    self._say(f"  waiting for vehicle {id}: {reason}")

    def _line(self, bridge: Bridge, t: float) -> str:
        motions, target = bridge.world.motions, target_of(self._scenario)
        place = motions[self._scenario.ids[0]].position
        far = {id: distance(motions[id].position, place) for id in self._scenario.ids[1:]}
        nearest = min(far, key=lambda id: far[id])
        goal = f", target {distance(place, target):.0f} m away" if target is not None else ""
        rule = f"; the evader's rule: {self._rule}" if self._rule else ""
        return f"  t = {t:5.1f} s: nearest pursuer {nearest} at {far[nearest]:.1f} m{goal}{rule}"


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
            if code == WRONG_SETTINGS:  # no use in trying again
                raise ConfigError(f"{name}: {self._last_line(log)}")
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
            "role": "evader" if spec is self._scenario.evader else "pursuer",
            "game": DEFAULT_GAME,
            "link": [f"udpin://127.0.0.1:{self.ports[id]}"],
            "bus": self._options.bus or DEFAULT_ENDPOINT,
            "strategy": spec.strategy,
            "take_control": True,
            "may_arm": flight.ground_start,
            "control_rate_hz": flight.control_rate_hz,
            "prediction": flight.prediction.value,
            "log": f"vehicle-{id}.tlog",
            "events": f"vehicle-{id}.events",
        }
        path = self._folder / f"agent-{id}.toml"
        run_folder.write_bytes(path, run_folder.toml_of(settings).encode())
        timing = self._folder / f".timing-{id}.json"
        return [
            sys.executable, "-m", "onboard.cli", "--config", str(path),
            "--log", str(self._folder / settings["log"]), "--events", str(self._folder / settings["events"]),
            "--timing", str(timing),
        ]  # fmt: skip
