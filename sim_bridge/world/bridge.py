"""The bridge: world, sensor and master on one clock, one bus and their links."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from onboard.game.scenario import Scenario
from onboard.runtime.protocols import Bus, Clock, Link
from onboard.runtime.tasks import Pace, periodic
from onboard.wire.bus.topics import DEFAULT_GAME, TRACK
from sim_bridge.world.master import BridgeMaster
from sim_bridge.world.sensor import Sensor
from sim_bridge.world.staging import Wind, generator, wind_of
from sim_bridge.world.world import RATE_HZ, Tap, World


def mute(line: str) -> None:
    """Say nothing."""


class Bridge:
    """Everything that is simulated, and the game's master; `run` it, or `step` it yourself.

    `seed` overrides the scenario's; `nonce` tells this master from another one: a process in real time
    draws it at random. With `referee` False another program is the master. `wind` overrides the
    scenario's, whose recordings lie in `folder`. Raises ConfigError for what cannot fly.
    """

    def __init__(
        self,
        scenario: Scenario,
        clock: Clock,
        bus: Bus,
        links: Mapping[int, Sequence[Link]],
        *,
        nonce: int,
        game: str = DEFAULT_GAME,
        seed: int | None = None,
        wind: Wind | None = None,
        folder: Path | None = None,
        rate_hz: float = RATE_HZ,
        tap: Tap | None = None,
        say: Callable[[str], None] = mute,
        referee: bool = True,
        battery_s: float = 1200.0,
    ) -> None:
        seed = scenario.seed if seed is None else seed
        self.scenario = scenario
        wind = wind_of(scenario, seed, folder) if wind is None else wind
        self.world = World(scenario, clock, links, wind=wind, rate_hz=rate_hz, tap=tap, battery_s=battery_s)
        self.sensor = Sensor(scenario.flight.sensor, scenario.ids, generator(seed, "sensor"))
        self.master = BridgeMaster(scenario, game, clock, bus, nonce, say) if referee else None
        self.pace = Pace("world", 1.0 / rate_hz)
        self._clock = clock
        self._bus = bus
        self._keys = {id: TRACK.key(game, id) for id in scenario.ids}

    def step(self) -> None:
        """Move the world on to now, publish what the sensor sees, judge the game."""
        self.world.step()
        motions = self.world.motions
        for track in self.sensor.step(self.world.wall_ns, motions):
            self._bus.publish(self._keys[track.id], TRACK.encode(track), TRACK.delivery)
        if self.master is not None:
            self.master.step(motions)

    async def run(self) -> None:
        """Step at the world's rate, for ever."""
        await periodic(self.pace, self.step, self._clock)

    def close(self) -> None:
        """Hear no more; links and bus are the caller's."""
        if self.master is not None:
            self.master.close()
