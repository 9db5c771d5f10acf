"""The bridge: world, sensor and master on one clock, one bus and their links."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from onboard.game.scenario import Scenario
from onboard.runtime.protocols import Bus, Clock, Link
from onboard.runtime.tasks import Pace, periodic
from onboard.wire.bus.topics import DEFAULT_GAME, TRACK
from sim_bridge.vehicle.motion import Motion
from sim_bridge.world.master import NAME, BridgeMaster, Who
from sim_bridge.world.sensor import Sensor
from sim_bridge.world.staging import wind_of
from sim_bridge.world.world import RATE_HZ, World


def mute(line: str) -> None:
    """A `say` that tells nobody."""


def unwatched(wall_ns: int, motions: Mapping[int, Motion]) -> None:
    """A `Bridge.watch` that looks at nothing."""


Watch = Callable[[int, Mapping[int, Motion]], None]  # wall instant [ns], true motions then, by vehicle id


class Options(NamedTuple):
    """What may be chosen about a bridge."""

    nonce: int  # tells this master from another one: a process in real time draws it at random
    game: str = DEFAULT_GAME  # name of the game on the bus
    seed: int | None = None  # in place of the scenario's
    folder: Path | None = None  # in which the scenario's recordings of wind lie
    referee: bool = True  # whether the bridge is the game's master
    name: str = NAME  # of the master, on a bus with keys that of its member
    battery_s: float = 1200.0  # a battery's time from full to empty in flight [s]


class Bridge:
    """Everything that is simulated, and the game's master; `run` it, or `step` it yourself.

    `links` are those on which each vehicle's autopilot speaks, by vehicle id; `say` hears what people should
    know; `watch`, which may be set, is told the true motions at every step. Raises ConfigError for what
    cannot fly.
    """

    def __init__(
        self,
        scenario: Scenario,
        clock: Clock,
        bus: Bus,
        links: Mapping[int, Sequence[Link]],
        options: Options,
        say: Callable[[str], None] = mute,
    ) -> None:
        game = options.game
        seed = scenario.seed if options.seed is None else options.seed
        self.scenario = scenario
        self.world = World(
            scenario, clock, links, wind_of(scenario, seed, options.folder), options.battery_s, seed
        )
        self.sensor = Sensor(scenario.flight.sensor, scenario.ids, seed)
        self.master = (
            BridgeMaster(scenario, game, clock, bus, Who(options.name, options.nonce), say)
            if options.referee
            else None
        )
        self.pace = Pace("world", 1.0 / RATE_HZ)
        self._clock = clock
        self._bus = bus
        self._keys = {id: TRACK.key(game, id) for id in scenario.ids}
        self.watch: Watch = unwatched

    def step(self) -> None:
        """Move the world on to now, publish what the sensor sees, judge the game."""
        self.world.step()
        motions = self.world.motions
        self.watch(self.world.wall_ns, motions)
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
