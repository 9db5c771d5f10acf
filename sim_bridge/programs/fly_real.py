"""A whole game in real processes: agents as subprocesses, UDP and Zenoh on loopback."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from pathlib import Path

from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import distance
from onboard.game.master import Standing
from onboard.game.scenario import Scenario
from onboard.game.staging import flown_targets
from onboard.runtime.bus_zenoh import ZenohBus
from onboard.runtime.clock import RealClock
from onboard.runtime.file_writer import FileWriter
from onboard.runtime.zenoh_config import DEFAULT_ENDPOINT
from onboard.wire.bus.messages import DecisionReport, Event, Outcome, Phase, Severity
from onboard.wire.bus.topics import DECISION, DEFAULT_GAME, Dispatcher
from sim_bridge.programs.agent_processes import AgentProcesses
from sim_bridge.programs.serve import Options, serve_scenario
from sim_bridge.rehearsal import BusRecorder
from sim_bridge.world.bridge import Bridge
from sim_bridge.world.run_observer import Observer
from sim_bridge.world.summary import Summary
from sim_bridge.world.truth import TRUTH, TruthLog

CLOSE_S = 1.0  # for what is on its way to the disk at the end [s]
TELL_S = 5.0  # between two lines on how the game goes [s]


async def fly_real(
    scenario: Scenario, options: Options, folder: Path, home: Path, say: Callable[[str], None]
) -> tuple[Summary, dict[str, object]]:
    """Play a scenario in real time; gives its summary and what was measured on the wall clock.

    `options` are those of the server; the run is recorded in `folder`; recordings of wind lie in `home`.
    Raises ConfigError: an agent's settings, a bus or a port that cannot be, another game on the bus.
    """
    game = RealGame(scenario, options, folder, say)
    try:
        outcome = await game.play(home)
    except BaseExceptionGroup as group:
        mistake = _mistake(group)
        if mistake is None:
            raise
        raise mistake from None
    bridge, observer, agents = game.bridge, game.observer, game.agents
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
        "agents": agents.timings(),
        "agents_started_again": agents.restarts,
    }
    return summary, timing


def _mistake(group: BaseExceptionGroup[BaseException]) -> ConfigError | None:
    """The user's mistake among what went wrong, if that is all that did."""
    mistakes, others = group.split(ConfigError)
    if mistakes is None or others is not None:
        return None
    first = mistakes.exceptions[0]
    return first if isinstance(first, ConfigError) else _mistake(first)


class RealGame:
    """One game in real time: the bridge and a recorder in this process, the agents in others.

    `bridge` and `observer` are None until the server has started.
    """

    def __init__(
        self, scenario: Scenario, options: Options, folder: Path, say: Callable[[str], None]
    ) -> None:
        self.bridge: Bridge | None = None
        self.observer: Observer | None = None
        self.agents = AgentProcesses(scenario, options.bus, folder, say)
        self._scenario = scenario
        self._options = options
        self._seed = scenario.seed if options.seed is None else options.seed
        self._say = say
        self._recorder = BusRecorder(folder, DEFAULT_GAME, RealClock())
        self._writer = FileWriter()
        self._truth = TruthLog(self._writer.open(folder / TRUTH).write)
        self._rules: dict[int, str] = {}  # by which each evader decided last
        self._drops: Counter[str] = Counter()

    async def play(self, home: Path) -> Outcome | None:
        """Play from the first agent's start to the last one's end; recordings of wind lie in `home`.

        Gives the outcome, None where there was none. Raises groups of ConfigError.
        """
        try:
            async with asyncio.TaskGroup() as group:
                agents = group.create_task(self.agents.run(), name="agents")
                others = [
                    group.create_task(self._report_progress(), name="progress"),
                    group.create_task(self._recorder.run(), name="recorder"),
                ]

                async def end_agents() -> None:
                    """End the agents before the vehicles, so that each leaves its vehicle in a safe mode."""
                    self.agents.over.set()
                    await asyncio.wait([agents])

                try:
                    return await serve_scenario(
                        self._scenario, self._options, self._say, home, self._server_started, end_agents
                    )
                finally:
                    self.agents.over.set()
                    for task in others:
                        task.cancel()
        finally:
            self._recorder.close()
            self._writer.close(CLOSE_S)

    def _server_started(self, bridge: Bridge, bus: ZenohBus, ports: dict[int, int]) -> None:
        self._recorder.hear(bus)
        self.bridge = bridge
        bridge.watch = self._truth.step
        self.observer = Observer(self._scenario, self._seed, "real", DEFAULT_GAME, bus, self._on_event)
        hear = Dispatcher(self._drops).on(DECISION, self._on_decision)
        for id in self._scenario.evader_ids:
            bus.subscribe(DECISION.key(DEFAULT_GAME, id), hear)
        self.agents.ports = ports
        self.agents.bridge_up.set()

    def _on_event(self, event: Event) -> None:
        if event.severity is not Severity.INFO:
            self._say(f"  vehicle {event.id}: {event.text}")

    def _on_decision(self, decision: DecisionReport) -> None:
        self._rules[decision.id] = decision.rule.replace("_", " ")

    async def _report_progress(self) -> None:
        """Say every few seconds how the game goes, or what it waits for."""
        while True:
            await asyncio.sleep(TELL_S)
            bridge = self.bridge
            if bridge is None or bridge.master is None:
                continue
            rules = bridge.master.rules
            if rules.phase is Phase.RUNNING:
                out = {end.id for end in rules.out}
                for id in self._scenario.evader_ids:
                    if id not in out:
                        self._say(self._line(bridge, id, (bridge.world.wall_ns - rules.t0_ns) / NS_PER_S))
            elif rules.phase is Phase.STAGING:
                clock = RealClock()
                lacking = rules.lacking(clock.wall_ns(), clock.monotonic_ns())
                for id, reason in sorted(lacking.items()):
                    self._say(f"  waiting for vehicle {id}: {reason}")

    def _line(self, bridge: Bridge, id: int, t: float) -> str:
        """Where an evader stands at `t` [s since t0]."""
        scenario, motions = self._scenario, bridge.world.motions
        place = motions[id].position
        far = {one: distance(motions[one].position, place) for one in scenario.pursuer_ids}
        nearest = min(far, key=lambda one: far[one])
        goals = [distance(place, target) for target in flown_targets(scenario)[id]]
        goal = f", target {min(goals):.0f} m away" if goals else ""
        rule = f"; the evader's rule: {self._rules[id]}" if id in self._rules else ""
        which = f"evader {id}: " if scenario.evaders else ""
        return f"  t = {t:5.1f} s: {which}nearest pursuer {nearest} at {far[nearest]:.1f} m{goal}{rule}"
