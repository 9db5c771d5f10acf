"""Scripted agents: they say they are ready and act when the game runs, and fly nothing."""

from __future__ import annotations

import asyncio
from collections import Counter

from onboard.runtime.protocols import Bus, Clock, Sample
from onboard.runtime.tasks import Pace, periodic
from onboard.wire.autopilot_kind import Kind
from onboard.wire.bus.messages import AgentStage, Health, Phase, PhaseChange, Role, SupervisorAction
from onboard.wire.bus.topics import HEALTH, PHASE


class ScriptedAgent:
    """A heartbeat on the bus; its stage follows the phase, as the real agent's does."""

    def __init__(self, bus: Bus, clock: Clock, game: str, id: int, *, nonce: int = 0) -> None:
        self.id = id
        self.bus = bus
        self.phases: list[PhaseChange] = []
        self.acting = False
        self._nonce = nonce or 1000 + id
        self._born_ns = clock.wall_ns()
        self._game = game
        self._clock = clock
        self._drops: Counter[str] = Counter()
        bus.subscribe(PHASE.key(game), self._on_phase)

    async def run(self) -> None:
        await periodic(Pace("health", 0.5), self._beat, self._clock)

    def _on_phase(self, sample: Sample) -> None:
        phase = PHASE.decode(sample.payload, self._drops)
        assert phase is not None
        self.phases.append(phase)
        if phase.phase is Phase.RUNNING and (phase.t0_ns > self._born_ns or self.id in phase.resume):
            self.acting = True

    def _beat(self) -> None:
        running = bool(self.phases) and self.phases[-1].phase is Phase.RUNNING
        waiting = not self.phases or (running and not self.acting)
        stage = AgentStage.WAITING if waiting else AgentStage.ACTING if running else AgentStage.READY
        role = Role.EVADER if self.id == 1 else Role.PURSUER
        health = Health(
            self.id, role, self._clock.wall_ns(), stage, ("resume",) if waiting else (), Kind.ARDUCOPTER,
            "GUIDED", True, 1.0, 1.0, 20.0, 20.0, 0.0, 3, True, SupervisorAction.OK, "0", {},
            nonce=self._nonce,
        )  # fmt: skip
        self.bus.publish(HEALTH.key(self._game, self.id), HEALTH.encode(health), HEALTH.delivery)


def crew(bus_of: dict[int, Bus], clock: Clock, game: str) -> dict[int, ScriptedAgent]:
    """One for each vehicle."""
    return {id: ScriptedAgent(bus, clock, game, id) for id, bus in bus_of.items()}


async def for_a_while(seconds: float, *work: object) -> None:
    """Run coroutines side by side for so long."""
    tasks: list[asyncio.Task[object]] = []
    try:
        async with asyncio.timeout(seconds), asyncio.TaskGroup() as group:
            tasks += [group.create_task(coroutine) for coroutine in work]  # type: ignore[arg-type]
    except TimeoutError:
        return
