"""What may befall a vehicle in flight: each fault strikes, and gives what ends it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import numpy as np

from onboard.game.scenario import Kind
from onboard.runtime.impairment import CLEAR, CUT, Impairment
from onboard.wire.bus.topics import EVENTS, HEALTH, STATE, TRACK, Delivery
from onboard.wire.mavlink.commands import OwnHeartbeat
from onboard.wire.mavlink.frames import Sender
from sim_bridge.rehearsal import Rehearsal
from sim_bridge.vehicle.autopilot.health import Fault

Rng = np.random.Generator
Undo = Callable[[], None]
Strike = Callable[[Rehearsal, int, Rng], Undo]
STORM, STORM_S = 100, 0.1  # messages and datagrams at a time, as often [s]
GIVES = {Kind.PX4: "HOLD", Kind.PX4_PLANE: "HOLD", Kind.ARDUCOPTER: "GUIDED", Kind.ARDUPLANE: "GUIDED"}
PILOTS = {Kind.PX4: "POSCTL", Kind.PX4_PLANE: "POSCTL", Kind.ARDUCOPTER: "LOITER", Kind.ARDUPLANE: "LOITER"}


def rough(rng: Rng) -> Impairment:
    """An impairment of one kind or all."""
    share = float(rng.uniform(0.05, 0.5))
    time = float(rng.uniform(0.01, 0.3))
    kinds = (
        Impairment(loss=share),
        Impairment(delay_s=time, jitter_s=time),
        Impairment(duplication=share, jitter_s=0.05),
        Impairment(reordering=share),
        Impairment(burst_rate=0.5, burst_s=time),
        Impairment(bit_error=share),
        Impairment(loss=0.2, delay_s=0.05, jitter_s=0.05, duplication=0.1, reordering=0.1, bit_error=0.05),
        CUT,
    )
    return kinds[int(rng.integers(len(kinds)))]


def radio(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The link to the autopilot is rough, or cut."""
    game.impair(id, rough(rng))
    return lambda: game.impair(id, CLEAR)


def air(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The agent's way to the bus is rough, or cut."""
    bus = game.agents[id].bus
    channel = bus.channel  # type: ignore[attr-defined]
    channel.impairment = rough(rng)

    def undo() -> None:
        channel.impairment = CLEAR

    return undo


def bus(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The bus dies."""
    game.broker.kill()
    return game.broker.restore


def reboot(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The autopilot starts again."""
    game.bridge.world.vehicles[id].autopilot.reboot(game.bridge.world.elapsed_ns)
    return lambda: None


def gps(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """No satellites."""
    return _failing(game, id, Fault.GPS)


def ekf(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The estimator loses its position."""
    return _failing(game, id, Fault.EKF)


def battery(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The battery is nearly empty, until another one is there."""
    autopilot = game.bridge.world.vehicles[id].autopilot
    autopilot.set_battery(0.1)
    return lambda: autopilot.set_battery(1.0)


def pilot(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The safety pilot takes it, and gives it back by his switch: on PX4 to the ground, which resumes it."""
    kind, world = game.scenario.flight.autopilot, game.bridge.world
    autopilot = world.vehicles[id].autopilot
    autopilot.pilot_mode(world.elapsed_ns, PILOTS[kind])
    return lambda: autopilot.pilot_mode(world.elapsed_ns, GIVES[kind])


def killed(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The agent's process dies, and is started again later."""
    game.kill_agent(id)

    def undo() -> None:
        game.start_agent(id)

    return undo


def blind(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """The sensor sees nobody."""
    game.bridge.sensor.blind = True

    def undo() -> None:
        game.bridge.sensor.blind = False

    return undo


def storm(game: Rehearsal, id: int, rng: Rng) -> Undo:
    """Somebody floods the bus in the vehicle's and the sensor's name, and its link from another port."""
    agent, stranger = game.agents[id], game.broker.connect("storm")
    keys = [topic.key(game.game, id) for topic in (STATE, HEALTH, EVENTS, TRACK)]
    noise = [rng.bytes(int(rng.integers(1, 300))) for _ in range(20)]
    words = Sender(id, 1).pack(OwnHeartbeat())  # of another autopilot with the vehicle's id

    async def blow() -> None:
        while True:
            for n in range(STORM):
                key = keys[n % len(keys)]
                stranger.publish(key, noise[n % len(noise)], Delivery.LATEST)
                agent._arrived(0, noise[-1 - n % len(noise)] if n % 2 else words, ("storm", n))
            await asyncio.sleep(STORM_S)

    task = asyncio.get_running_loop().create_task(blow())

    def undo() -> None:
        task.cancel()
        game.broker.buses.remove(stranger)
        if game.agents[id] is agent:
            assert agent._link_limit.limited["link"] > 0, "a flood was not bounded"

    return undo


def _failing(game: Rehearsal, id: int, fault: Fault) -> Undo:
    autopilot = game.bridge.world.vehicles[id].autopilot
    autopilot.fail(fault)
    return lambda: autopilot.fail(fault, False)


OF_ONE: dict[str, Strike] = {
    "radio": radio, "air": air, "reboot": reboot, "gps": gps, "ekf": ekf, "battery": battery, "pilot": pilot,
    "killed": killed, "storm": storm,
}  # fmt: skip
OF_ALL: dict[str, Strike] = {"bus": bus, "blind": blind}
NAMES = (*OF_ONE, *OF_ALL)
