"""Trials of an abort in a whole game: real agents, simulated autopilots, every link and the bus impaired."""

from __future__ import annotations

import asyncio
from typing import NamedTuple

import numpy as np

from gcs.station import Station, StationSetup
from onboard.game.scenario import Flight, ImpairmentSpec, Parameters, Scenario, VehicleSpec
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.impairment import CLEAR, Impairment
from onboard.runtime.loop import run_virtual
from onboard.wire.bus.messages import AgentStage, CommandKind, Phase
from sim_bridge.rehearsal import Rehearsal
from tests.support.whole_games import at_phase, game_of

LOSS = 0.3
WITHIN_S = 2.0
PATIENCE_S = 60.0

# The pursuers never catch up, so that the game outlasts any number of trials.
CHASE = Scenario(
    name="chase",
    evader=VehicleSpec(position=(0.0, 0.0), speed=5.0),
    pursuers=tuple(VehicleSpec(position=(-200.0 - 20.0 * i, 40.0 * i), speed=2.0) for i in range(5)),
    parameters=Parameters(R=2.0, horizon=86400.0),
    flight=Flight(
        height=50.0,
        impairment=ImpairmentSpec(bus=True),
        prediction=Predicting.CONSTANT_VELOCITY,  # networks have no part in this, and take most of the time
    ),
)


class Trial(NamedTuple):
    """One abort of six vehicles."""

    took_s: float  # until the last of them confirmed
    unconfirmed: tuple[int, ...]  # after two seconds
    named: tuple[str, ...]  # the alerts that name them then


def trials(count: int, seed: int, loss: float = LOSS) -> list[Trial]:
    """`count` aborts, one after the other, in one game on virtual time."""
    return run_virtual(_trials(count, seed, loss))


async def _trials(count: int, seed: int, loss: float) -> list[Trial]:
    rng = np.random.default_rng([seed, 1])
    found = []
    async with game_of(CHASE, seed=seed, any_error=True) as game:
        station = Station(game.broker.connect("gcs"), game.clock, StationSetup(game.game))
        task = asyncio.create_task(station.run())
        ids = CHASE.ids
        await at_phase(game, Phase.RUNNING, PATIENCE_S)

        def acting_all() -> bool:
            return all(game.health[i].stage == AgentStage.ACTING for i in ids)

        for _ in range(count):
            await game.forward(PATIENCE_S, until=acting_all)
            impair(game, Impairment(loss=loss, delay_s=0.01, jitter_s=0.02))
            await game.forward(rng.random())
            found.append(await _abort(game, station, ids))
            impair(game, CLEAR)
            await game.forward(1.5)  # every vehicle's health says now that it was stopped: a resume quotes it
            resumed = station.command(CommandKind.RESUME, ids)
            await game.forward(PATIENCE_S, until=lambda c=resumed: done(station, c))
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
    return found


async def _abort(game: Rehearsal, station: Station, ids: tuple[int, ...]) -> Trial:
    command = station.command(CommandKind.ABORT, ids)
    start_ns = station.now_ns()
    unconfirmed: tuple[int, ...] = ()
    named: tuple[str, ...] = ()
    while not done(station, command):
        passed = (station.now_ns() - start_ns) / 1e9
        assert passed < PATIENCE_S, "an abort was never confirmed"
        if passed > WITHIN_S and not unconfirmed:
            view = station.reducer.book.view(command, station.now_ns())
            assert view is not None
            unconfirmed = view.unconfirmed
            await asyncio.sleep(0.2)  # a beat of the alerts
            named = tuple(a.text for a in station.picture().alerts if a.kind == "unconfirmed_abort")
        await asyncio.sleep(0.01)
    view = station.reducer.book.view(command, station.now_ns())
    assert view is not None
    return Trial(max(leg.took_s for leg in view.legs), unconfirmed, named)


def done(station: Station, command: str) -> bool:
    """Every vehicle has confirmed."""
    view = station.reducer.book.view(command, station.now_ns())
    return view is not None and view.confirmed


def impair(game: Rehearsal, impairment: Impairment) -> None:
    """Every link, and every connection to the bus."""
    for i in game.links:
        game.impair(i, impairment)
    for bus in game.broker.buses:
        assert bus.channel is not None
        bus.channel.impairment = impairment
