"""A whole game in one process on virtual time: bridge, agents, memory links and bus, recorder.

The composition root: it alone in this package may import everything. `fly --fast` plays a
scenario with it; the tests read as flight stories on it. The same seed gives the same bytes.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

from gcs.recording.recorder import Recorder
from onboard.agent.config import AgentConfig
from onboard.agent.event_file import EventFile, FileSink, unused
from onboard.agent.shell import Agent, Equipment
from onboard.core.math.constants import NS_PER_S
from onboard.game.master import GameMaster
from onboard.game.scenario import Scenario
from onboard.runtime.bus_memory import MemoryBroker, MemoryBus
from onboard.runtime.impairment import Impaired, Impairment
from onboard.runtime.links import memory_pair
from onboard.runtime.progress import Tell, silent
from onboard.runtime.protocols import Bus, Clock, Link, Sample
from onboard.wire.bus.messages import Event, Health, Outcome, Phase
from onboard.wire.bus.topics import everything
from onboard.wire.mavlink.tlog import TlogWriter
from sim_bridge.world.bridge import Bridge, mute
from sim_bridge.world.bridge import Options as BridgeOptions
from sim_bridge.world.run_observer import Observer
from sim_bridge.world.staging import generator, impairment_of
from sim_bridge.world.summary import Summary
from sim_bridge.world.truth import TRUTH, TruthLog

GAME = "rehearsal"
TOLD_MAX = 100_000
LOOK_S = 0.05
PLACES_S = 200.0  # within which everybody is at its place


class BusRecorder:
    """Records a whole game into `FOLDER/recording.mcap`, as the ground station's recorder does."""

    def __init__(self, folder: Path, game: str, clock: Clock) -> None:
        self._recorder = Recorder(folder / "recording.mcap", game)
        self._game = game
        self._clock = clock

    def hear(self, bus: Bus) -> None:
        """Record everything on a bus."""
        bus.subscribe(everything(self._game), self._record, every=True)

    async def run(self) -> None:
        """Put on the disk what is due, until cancelled."""
        while True:
            self._recorder.tick(self._clock.wall_ns())
            await asyncio.sleep(0.2)

    def close(self) -> None:
        """End the recording; may be called again."""
        self._recorder.close()

    def _record(self, sample: Sample) -> None:
        self._recorder.record(sample.key, sample.payload, self._clock.wall_ns())


class Options(NamedTuple):
    """What may be chosen about a rehearsal."""

    seed: int | None = None  # in place of the scenario's
    folder: Path | None = None  # receives one .tlog per vehicle and recording.mcap; None records nothing
    scenario_folder: Path | None = None  # in which the scenario's recordings of wind lie
    game: str = GAME  # name of the game on the bus
    agents: bool = True  # whether agents are started with the game
    configure: Mapping[int, Mapping[str, Any]] = {}  # what single agents are told differently, by id
    say: Callable[[str], None] = mute  # hears what master and agents have to tell
    version: str = ""  # which the agents say they are of
    battery_s: float = 1200.0  # a battery's time from full to empty in flight [s]


class Rehearsal:
    """One game; use it as `async with Rehearsal(…) as game: await game.until_ended()`."""

    def __init__(
        self,
        scenario: Scenario,
        clock: Clock,
        options: Options = Options(),  # noqa: B008  (a NamedTuple cannot change)
    ) -> None:
        self.scenario = scenario
        self.clock = clock
        self.game = options.game
        self.seed = scenario.seed if options.seed is None else options.seed
        self.told: list[str] = []
        self.agents: dict[int, Agent] = {}
        self._tasks: dict[int, asyncio.Task[None]] = {}
        self._options = options
        self._tlogs: dict[int, tuple[BinaryIO, TlogWriter]] = {}
        impairment = impairment_of(scenario)
        on_bus = scenario.flight.impairment.bus
        self.broker = MemoryBroker(
            impairment if on_bus else None, generator(self.seed, "bus") if on_bus else None
        )
        self._nonces = generator(self.seed, "nonces")
        self.links: dict[int, Impaired] = {}
        sides: dict[int, tuple[Link, ...]] = {}
        for id in scenario.ids:
            autopilot, agent = memory_pair(f"vehicle-{id}")
            self.links[id] = Impaired(agent, impairment, generator(self.seed, f"link-{id}"))
            sides[id] = (autopilot,)
        self.bus: MemoryBus = self.broker.connect("observer")
        self.observer = Observer(scenario, self.seed, "fast", self.game, self.bus)
        bridge_options = BridgeOptions(
            self._nonce(), self.game, self.seed, options.scenario_folder, battery_s=options.battery_s
        )
        self.bridge = Bridge(
            scenario, clock, self.broker.connect("sim-bridge"), sides, bridge_options, self._tell
        )
        self._world: asyncio.Task[None] | None = None
        self._recorder: BusRecorder | None = None
        self._truth: BinaryIO | None = None

    # ------------------------------------------------------------------ life

    async def __aenter__(self) -> Rehearsal:
        folder = self._options.folder
        if folder is not None:
            self._recorder = BusRecorder(folder, self.game, self.clock)
            self._recorder.hear(self.bus)
            self._truth = (folder / TRUTH).open("wb")
            self.bridge.watch = TruthLog(self._truth.write).step
            for id in self.scenario.ids:
                file: BinaryIO = (folder / f"vehicle-{id}.tlog").open("wb")
                self._tlogs[id] = (file, TlogWriter(file))
        self._world = asyncio.create_task(self.bridge.run(), name="world")  # ended in __aexit__
        if self._options.agents:
            for id in self.scenario.flown_ids:
                self.start_agent(id)
        return self

    async def __aexit__(self, *_: object) -> None:
        for id in list(self._tasks):
            self.kill_agent(id)
        if self._world is not None:
            self._world.cancel()
            await asyncio.gather(self._world, return_exceptions=True)
        self.bridge.close()
        if self._recorder is not None:
            self._recorder.close()
        for log, _writer in self._tlogs.values():
            log.close()
        if self._truth is not None:
            self._truth.close()
        await self.bus.close()

    async def until(self, holds: Callable[[], bool], within_s: float) -> bool:
        """Let time pass until a condition holds; False where it did not within `within_s`."""
        end_ns = self.clock.monotonic_ns() + round(within_s * NS_PER_S)
        while not holds():
            if self.clock.monotonic_ns() >= end_ns:
                return False
            self._look_after_tasks()
            await asyncio.sleep(LOOK_S)
        return True

    async def until_ended(self, tell: Tell = silent) -> Outcome:
        """Let the game go to its end, telling how far it is; the master's patience bounds the wait."""
        flight, horizon = self.scenario.flight, self.scenario.parameters.horizon
        bound = flight.timeout_s + 10.0 * flight.ready_s + PLACES_S + horizon + 30.0

        def over() -> bool:
            now = max(self.now, 0.0)
            tell(now / horizon, f"{now:.0f} s of at most {horizon:g} s flown")
            return self.phase is Phase.RECOVERY

        await self.until(over, bound)
        if self.outcome is None:
            raise RuntimeError("the game did not end: " + "; ".join(self.told[-3:]))
        return self.outcome

    async def land_agents(self) -> None:
        """End all agents as SIGTERM would: each leaves its vehicle in a mode it can hold alone."""
        for agent in self.agents.values():
            agent.stop()
        await self.until(lambda: all(task.done() for task in self._tasks.values()), 5.0)

    # ------------------------------------------------------------------ what may happen to it

    def start_agent(self, id: int) -> Agent:
        """Start (or start again) the agent of a vehicle."""
        config = self.configuration()[id]
        bus = self.broker.connect(f"agent-{id}")
        agent = Agent(config, self.clock, [self.links[id]], bus, self.equipment(id, config))
        self.agents[id] = agent
        self._tasks[id] = asyncio.create_task(_live(agent, bus), name=f"agent-{id}")  # ended by kill_agent
        return agent

    def equipment(self, id: int, config: AgentConfig) -> Equipment:
        """What the agent of a vehicle is given besides its configuration; it writes at once."""
        record = None
        if id in self._tlogs:
            record = self._tlogs[id][1].write
        events = None
        if self._options.folder is not None:
            sink = FileSink(unused(self._options.folder / f"vehicle-{id}.events"))
            events = EventFile(sink, round(config.events_max_mb * 1e6))
        return Equipment(
            nonce=self._nonce(), version=self._options.version, log=self._tell, record=record, events=events
        )

    def configuration(self) -> dict[int, AgentConfig]:
        """What each agent is told."""
        flight = self.scenario.flight
        found = {}
        for id, spec in zip(self.scenario.ids, self.scenario.vehicles, strict=True):
            settings: dict[str, Any] = {
                "id": id,
                "role": self.scenario.role_of(id),
                "game": self.game,
                "take_control": True,
                "may_arm": flight.ground_start,
                "control_rate_hz": flight.control_rate_hz,
                "prediction": flight.prediction,
                "strategy": spec.strategy,
            }
            found[id] = AgentConfig(**(settings | dict(self._options.configure.get(id, {}))))
        return found

    def kill_agent(self, id: int) -> None:
        """The agent falls silent at once, as after `kill -9`."""
        task = self._tasks.pop(id, None)
        if task is not None:
            task.cancel()
            self.links[id].receive(lambda data, peer: None)

    def impair(self, id: int, impairment: Impairment) -> None:
        """Change what happens to a vehicle's datagrams."""
        self.links[id].change(impairment)

    # ------------------------------------------------------------------ what there is to see

    @property
    def now(self) -> float:
        """Time since t₀ [s]; negative before it, 0 while it is not fixed."""
        t0 = self.master.t0_ns
        return (self.clock.wall_ns() - t0) / NS_PER_S if t0 else 0.0

    @property
    def master(self) -> GameMaster:
        """The rules of the game's master."""
        assert self.bridge.master is not None
        return self.bridge.master.rules

    @property
    def phase(self) -> Phase:
        """Phase of the game now."""
        return self.master.phase

    @property
    def outcome(self) -> Outcome | None:
        """How it ended, once it has."""
        return self.master.outcome

    @property
    def events(self) -> list[Event]:
        """All events of all vehicles so far, in order."""
        return self.observer.events

    @property
    def health(self) -> dict[int, Health]:
        """The last health of each vehicle's agent."""
        return self.observer.health

    def kinds(self, id: int) -> list[str]:
        """Kinds of a vehicle's events so far, in order."""
        return self.observer.kinds(id)

    def summary(self) -> Summary:
        """The run in figures, all of virtual time."""
        return self.observer.summary(self.master, self.outcome, self.bridge.sensor, self.links)

    # ------------------------------------------------------------------ inside

    def _nonce(self) -> int:
        return int(self._nonces.integers(1, 1 << 48))

    def _tell(self, line: str) -> None:
        self.told.append(line)
        del self.told[:-TOLD_MAX]
        self._options.say(line)

    def _look_after_tasks(self) -> None:
        """A task that failed ends the rehearsal: nothing is swallowed."""
        for task in (self._world, *self._tasks.values()):
            if task is not None and task.done() and not task.cancelled():
                error = task.exception()
                if error is not None:
                    raise error


async def _live(agent: Agent, bus: MemoryBus) -> None:
    """An agent's life: with its process goes its connection to the bus."""
    try:
        await agent.run()
    finally:
        await bus.close()
