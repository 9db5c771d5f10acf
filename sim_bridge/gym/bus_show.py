"""A game shown on the bus, in real time: consoles, pages and recorders hear it as they hear any other."""

from __future__ import annotations

import asyncio
import secrets
import threading
from typing import Any, NamedTuple

from onboard.core.game.referee import GameResult
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec, add, norm, pitch_of, yaw_of
from onboard.game.scenario import Scenario
from onboard.game.staging import flown, setup_of, target_of
from onboard.runtime.bus_zenoh import ZenohBus, open_zenoh
from onboard.runtime.clock import RealClock
from onboard.wire.bus.messages import (
    EvaderBrief,
    Master,
    Outcome,
    OutcomeResult,
    Phase,
    PhaseChange,
    Role,
    State,
    Track,
)
from onboard.wire.bus.topics import EVADER_BRIEF, MASTER, OUTCOME, PHASE, SETUP, STATE, TRACK, Topic

NAME = "gym"
OPEN_S = 10.0  # to open the bus
LATE_S = 0.5  # a game that is later than this starts its clock again


class Showing(NamedTuple):
    """A game at an instant."""

    time: float  # since its start [s]
    vehicles: tuple[Vehicle, ...]  # evader first, velocities through the air
    wind: Vec  # [m/s; NED, where the air moves to]
    verdict: GameResult
    captor: int  # index of the pursuer, −1 = none
    smallest: float  # [m]


class BusShow:
    """Publishes a game as it is played, no faster than real time. It listens at the endpoint, or joins."""

    def __init__(self, scenario: Scenario, game: str, endpoint: str | None) -> None:
        """Raises ConfigError for an endpoint that cannot be."""
        self._scenario, self._game = scenario, game
        self._clock = RealClock()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="bus", daemon=True)
        self._thread.start()
        self._nonce = secrets.randbits(31)
        self._number = 0
        self._phase = Phase.ENDED
        self._t0_ns = 0
        self._sleep = threading.Event()
        opening = asyncio.run_coroutine_threadsafe(open_zenoh(endpoint, listen=True), self._loop)
        try:
            self._bus: ZenohBus = opening.result(OPEN_S)
        except BaseException:
            self._end_loop()
            raise

    def show(self, now: Showing) -> None:
        """Publish an instant; waits until it has come."""
        wall = self._clock.wall_ns()
        if now.time == 0.0:
            self._t0_ns = wall
            self._begin(wall)
        due = self._t0_ns + round(now.time * NS_PER_S)
        if wall < due:
            self._sleep.wait((due - wall) / NS_PER_S)
        elif wall - due > LATE_S * NS_PER_S:
            self._t0_ns += wall - due
        self._put_vehicles(now)
        if now.verdict != GameResult.RUNNING and self._phase is Phase.RUNNING:
            self._finish(now)

    def close(self) -> None:
        """Leave the bus."""
        asyncio.run_coroutine_threadsafe(self._bus.close(), self._loop).result(OPEN_S)
        self._end_loop()

    def _end_loop(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(OPEN_S)
        self._loop.close()

    def _put(self, topic: Topic[Any], message: Any, id: int | None = None) -> None:
        key, payload = topic.key(self._game, id), topic.encode(message)
        self._loop.call_soon_threadsafe(self._bus.publish, key, payload, topic.delivery)

    def _change(self, phase: Phase, wall: int, reason: str = "") -> None:
        self._phase = phase
        self._number += 1
        self._put(PHASE, PhaseChange(phase, self._t0_ns, wall, (), reason, NAME, self._nonce, self._number))

    def _begin(self, wall: int) -> None:
        from msgspec.structs import replace

        self._put(SETUP, replace(setup_of(self._scenario, self._game, NAME), nonce=self._nonce))
        target = target_of(self._scenario)
        self._put(EVADER_BRIEF, EvaderBrief(None if target is None else (*target,), wall))
        self._change(Phase.RUNNING, wall)

    def _put_vehicles(self, now: Showing) -> None:
        wall = self._clock.wall_ns()
        self._put(MASTER, Master(NAME, wall, 2.0, self._nonce, self._number))
        scenario = self._scenario
        for index, (id, vehicle) in enumerate(zip(scenario.ids, now.vehicles, strict=True)):
            place, air = flown(scenario, vehicle.position), vehicle.velocity
            velocity = add(air, now.wind)
            role = Role.PURSUER if index else Role.EVADER
            attitude = (0.0, pitch_of(air), yaw_of(air))
            state = State(id, role, wall, (*place,), (*velocity,), norm(air), (*now.wind,), *attitude,
                          "SIMULATED", True, self._nonce)  # fmt: skip
            self._put(STATE, state, id)
            self._put(TRACK, Track(id, wall, (*place,), (*velocity,), (0.0,) * 6, NAME), id)

    def _finish(self, now: Showing) -> None:
        wall = self._clock.wall_ns()
        captor = self._scenario.ids[now.captor + 1] if now.captor >= 0 else 0
        result = OutcomeResult[now.verdict.name]
        self._put(OUTCOME, Outcome(result, now.time, captor, now.smallest, wall))
        self._change(Phase.ENDED, wall, result.value)
