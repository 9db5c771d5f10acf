"""A world that steps autopilots where something is due has the bits of one that steps all of them always."""

from __future__ import annotations

from collections.abc import Hashable, Iterator

import numpy as np
import pytest

from onboard.core.math.vectors import Vec
from onboard.game.scenario import Flight, Kind, Scenario, VehicleSpec, WindSpec
from onboard.runtime.clock import VirtualClock
from onboard.runtime.loop import EPOCH_NS
from onboard.runtime.protocols import Receiver
from onboard.wire.mavlink.commands import Outgoing, Target, VelocityTarget, set_message_interval, set_mode
from onboard.wire.mavlink.frames import Sender
from onboard.wire.mavlink.modes import ARDUCOPTER_MODES, PX4_MODES
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.motion import Motion
from sim_bridge.world.staging import wind_of
from sim_bridge.world.world import World

STEP_NS = 10_000_000
STEPS = 900
FOLLOW = {Kind.ARDUCOPTER: ("GUIDED", ARDUCOPTER_MODES), Kind.PX4: ("OFFBOARD", PX4_MODES)}
AWAY = {Kind.ARDUCOPTER: ("RTL", ARDUCOPTER_MODES), Kind.PX4: ("LAND", PX4_MODES)}
Happens = tuple[int, int, Outgoing]  # instant [ns], vehicle, message


class Line:
    """A link that keeps what is sent on it, and hands over what a test says."""

    name = "line"

    def __init__(self, clock: VirtualClock) -> None:
        self.sent: list[tuple[int, bytes]] = []
        self.hear: Receiver = lambda data, peer: None
        self._clock = clock

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        self.sent.append((self._clock.monotonic_ns(), data))

    def receive(self, receiver: Receiver) -> None:
        self.hear = receiver

    def counters(self) -> dict[str, int]:
        return {}

    def close(self) -> None:
        return


def game(kind: Kind, wind: WindSpec) -> Scenario:
    flight = Flight(autopilot=kind, wind=wind, ground_start=False)
    evader = VehicleSpec(position=(0.0, 0.0, 60.0), speed=4.0, target=(900.0, 0.0, 60.0))
    pursuers = (VehicleSpec(position=(300.0, 100.0, 60.0), speed=5.0),)
    return Scenario(name="two", evader=evader, pursuers=pursuers, flight=flight)


def script(kind: Kind, rng: np.random.Generator) -> Iterator[Happens]:
    """Setpoints that stream, stop and come again, orders and rates, at whatever instants."""
    (follow, modes), (away, _) = FOLLOW[kind], AWAY[kind]
    for id in (1, 2):
        to, on, at = Target(id), True, int(rng.integers(STEP_NS))
        while at < STEPS * STEP_NS:
            drawn = rng.random()
            if on:
                v = Vec(*rng.uniform(-5.0, 5.0, 2).tolist(), float(rng.uniform(-1.0, 1.0)))
                yield at, id, VelocityTarget(to, at / 1e9, v)
            if drawn < 0.06:
                on = not on
            elif drawn < 0.14:
                yield at, id, set_mode(to, modes[away if drawn < 0.08 else follow], px4=kind is Kind.PX4)
            elif drawn < 0.18:
                number, rate = int(rng.choice([30, 33, 147])), float(rng.choice([2, 20]))
                yield at, id, set_message_interval(to, number, rate)
            at += int(rng.choice([50_000_000, 7_000_001, 333_000_000]))


def flown(
    scenario: Scenario, happens: list[Happens], rng: np.random.Generator, *, plain: bool
) -> tuple[list[list[bytes]], list[dict[int, Motion]], World]:
    """What each vehicle sends, and where all are at the instants of `rng`: by one call of the world for any
    number of steps, or `plain`, a call for each with every autopilot awake."""
    clock = VirtualClock(EPOCH_NS)
    lines = {id: Line(clock) for id in scenario.ids}
    world = World(scenario, clock, {id: (line,) for id, line in lines.items()}, wind_of(scenario, 3, None))
    sender, motions, done, told = Sender(255, 190), [], 0, 0
    while done < STEPS:
        upto = min(STEPS, done + int(rng.integers(1, 8)))
        while told < len(happens) and happens[told][0] < upto * STEP_NS:
            at, id, message = happens[told]
            told += 1
            for step in range(done + 1, at // STEP_NS + 1) if plain else (at // STEP_NS,):
                _to(world, clock, step, plain=plain)
            done = max(done, at // STEP_NS)
            clock.advance_to(max(at, clock.monotonic_ns()))
            lines[id].hear(sender.pack(message), "companion")
        for step in range(done + 1, upto + 1) if plain else (upto,):
            _to(world, clock, step, plain=plain)
        done = upto
        motions.append(world.motions)
    return [[data for _, data in line.sent] for line in lines.values()], motions, world


def _to(world: World, clock: VirtualClock, step: int, *, plain: bool) -> None:
    clock.advance_to(max(step * STEP_NS, clock.monotonic_ns()))
    if plain:
        for vehicle in world.vehicles.values():
            vehicle.autopilot.wake()
    world.step()


@pytest.mark.parametrize("kind", list(FOLLOW))
@pytest.mark.parametrize("wind", [WindSpec(), WindSpec(speed=3.0, gust_sigma=1.0)], ids=["still", "gusts"])
def test_any_interleaving_of_frames_and_steps_has_the_bits_of_plain_stepping(
    kind: Kind, wind: WindSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    stepped = 0
    step = Autopilot.step

    def counted(*given: object) -> object:
        nonlocal stepped
        stepped += 1
        return step(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(Autopilot, "step", counted)
    for seed in range(3):
        scenario = game(kind, wind)
        happens = sorted(script(kind, np.random.default_rng(seed)), key=lambda one: one[0])
        counts, found = [], []
        for plain in (False, True):
            stepped = 0
            sent, motions, world = flown(scenario, happens, np.random.default_rng(seed + 100), plain=plain)
            counts.append(stepped)
            pilots = [vehicle.autopilot for vehicle in world.vehicles.values()]
            left = [(pilot.health.battery, pilot.motion, pilot.wind_filter.wind) for pilot in pilots]
            found.append((sent, motions, left))
        assert found[0] == found[1]
        assert counts[1] == STEPS * 2
        if wind == WindSpec():
            assert counts[0] < counts[1] - 50
