"""The bridge as the game's master: a thin shell that joins `GameMaster` to the bus and the true motions."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from typing import NamedTuple

from onboard.core.math.vectors import Vec
from onboard.game.master import GameMaster, Timing
from onboard.game.scenario import Scenario
from onboard.game.staging import flown_targets, setup_of
from onboard.runtime.protocols import Bus, Clock
from onboard.wire.bus.messages import Health, Master
from onboard.wire.bus.topics import HEALTH, MASTER, TRACK, Dispatcher
from sim_bridge.vehicle.motion import Motion

NAME = "sim-bridge"
RECOVERY_S = 3.0


class Who(NamedTuple):
    """As whom a bridge is the master."""

    name: str
    nonce: int


class BridgeMaster:
    """Call `step` each step of the world; `rules` is the master itself."""

    def __init__(
        self, scenario: Scenario, game: str, clock: Clock, bus: Bus, who: Who, say: Callable[[str], None]
    ) -> None:
        flight, (name, nonce) = scenario.flight, who
        timing = Timing(flight.ready_s, flight.timeout_s, RECOVERY_S)
        self.rules = GameMaster(setup_of(scenario, game, name), flown_targets(scenario), name, nonce, timing)
        self.drops: Counter[str] = Counter()
        self._game = game
        self._clock = clock
        self._bus = bus
        self._say = say
        hear = Dispatcher(self.drops).on(MASTER, self._on_master).on(HEALTH, self._on_health)
        if any(spec.tracked for spec in scenario.evading):
            hear.on(TRACK, self.rules.heard_track)
        self._subscriptions = [bus.subscribe(topic.key(game), hear) for topic in hear.topics]

    def step(self, motions: Mapping[int, Motion]) -> None:
        """Judge what has happened since the last step, and say what is due."""
        wall_ns, now_ns = self._clock.wall_ns(), self._clock.monotonic_ns()
        positions: dict[int, Vec] = {id: motion.position for id, motion in motions.items()}
        self.rules.tick(wall_ns, now_ns)
        self.rules.observe(wall_ns, now_ns, positions)
        for topic, message, id in self.rules.outgoing():
            self._bus.publish(topic.key(self._game, id), topic.encode(message), topic.delivery)
        for line in self.rules.news():
            self._say(line)

    def abort(self, reason: str) -> None:
        """End the game without a verdict; published with the next step."""
        self.rules.abort(self._clock.wall_ns(), self._clock.monotonic_ns(), reason)

    def close(self) -> None:
        """Leave the bus: hear and say no more."""
        for subscription in self._subscriptions:
            subscription.close()

    def _on_master(self, master: Master) -> None:
        self.rules.heard_master(master, self._clock.monotonic_ns())

    def _on_health(self, health: Health) -> None:
        self.rules.heard_health(health, self._clock.monotonic_ns())
