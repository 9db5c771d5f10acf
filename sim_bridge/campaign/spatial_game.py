"""The spatial game of 4.4 with the aircraft as flown, in its wind: one kernel, interpreted or compiled.

Everybody decides at the control rate from what they see, in the moving air; the aircraft and the gusts are
stepped by the same kernels that the bridge flies. Opponents are seen with the sensor's noise, own states
exactly. Pursuers see the evader's measured direction of flight, not its decision. Capture, arrival and
the safety distance are judged on ground positions.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import Conditions, Game, decide_pursuers, judged
from onboard.core.game.referee import GameResult
from onboard.core.game.views import EvaderView, evader_view, heading_at, sighted
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import Vec, clamp, scale
from onboard.core.strategy.evasion import evader, straight
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.pursuit import pursuer
from sim_bridge.campaign.plane_in_wind import GUST_EVERY, Climate, Flown, blown, command_for, fly, wind_at
from sim_bridge.vehicle.flight.plane import Command, PlaneModel
from sim_bridge.vehicle.wind.dryden import GustNoise

Array = NDArray[np.float64]


class Evasion(IntEnum):
    """How the evader flies."""

    STRATEGY = 0  # by the strategy of 3.4.1
    STRAIGHT = 1  # straight at its target, whoever is in the way


class Fleet(NamedTuple):
    """The aircraft models: one for the evader, one for all pursuers."""

    evader: PlaneModel
    pursuer: PlaneModel


class Sensor(NamedTuple):
    """Noise of the tracks, one sigma an axis."""

    position: float  # [m]
    velocity: float  # [m/s]


class Band(NamedTuple):
    """Heights between which the game is played [m]."""

    low: float
    high: float


MARGIN = 150.0  # [m] over which the pitch limits close towards the band's edges
BACK = -0.25  # share of the pitch limits at which a vehicle beyond an edge must come back


class Envelope(NamedTuple):
    """How far the aircraft went, all of them together."""

    pitch_low: float  # [rad]
    pitch_high: float
    speed_low: float  # share of a vehicle's declared airspeed
    speed_high: float
    lowest: float  # height [m]
    surface: float  # largest share of a servo's stroke


def banded(limits: VehicleLimits, height: float, band: Band) -> VehicleLimits:
    """Limits (2)–(3) at `height` [m]: no descent at the band's lower edge, no climb at its upper one,
    and beyond them back into it."""
    down = clamp((height - band.low) / MARGIN, BACK, 1.0)
    up = clamp((band.high - height) / MARGIN, BACK, 1.0)
    return VehicleLimits(
        limits.speed_min,
        limits.speed_max,
        limits.pitch_min * down,
        limits.pitch_max * up,
        limits.yaw_min,
        limits.yaw_max,
        limits.turn_rate,
    )


class Heights(NamedTuple):
    """What bounds the pitch of a pursuer (for `each`)."""

    states: Array  # as in Sight
    band: Band


def banded_pursuer(limits: VehicleLimits, index: int, heights: Heights) -> VehicleLimits:
    """Pursuer `index`'s limits where it is (for `each`)."""
    return banded(limits, -heights.states[index + 1, 2], heights.band)


class SpatialPlay(NamedTuple):
    """How a game ended."""

    game: Game
    steps: int  # control steps
    samples: int  # of each aircraft
    envelope: Envelope


class Sight(NamedTuple):
    """What turns an aircraft into a vehicle as somebody sees it (for `each`)."""

    states: Array  # (players, 7): position [m], velocity over ground [m/s; NED], course through the air [rad]
    climate: Climate
    noise: Array  # (players, 6) in sigmas
    position: float  # sigma [m]
    velocity: float  # sigma [m/s]


def seen(index: int, speed: float, sight: Sight) -> Vehicle:
    """Player `index` as a vehicle in the moving air, with the sensor's noise."""
    s = sight.states[index]
    n = sight.noise[index]
    p = sight.position
    v = sight.velocity
    place = Vec(s[0], s[1], s[2])
    wind = wind_at(sight.climate, place)
    return Vehicle(
        Vec(place.x + p * n[0], place.y + p * n[1], place.z + p * n[2]),
        Vec(
            s[3] - wind.x + v * n[3],
            s[4] - wind.y + v * n[4],
            s[5] - wind.z + v * n[5],
        ),
        speed,
    )


def seen_pursuer(vehicle: Vehicle, index: int, sight: Sight) -> Vehicle:
    """Pursuer `index` (for `each`)."""
    return seen(index + 1, vehicle.speed, sight)


def decide_evader(view: EvaderView, evasion: Evasion) -> Decision:
    """The evader's decision."""
    if evasion == Evasion.STRAIGHT:
        return straight(view)
    return evader(view)


def order(decision: Decision, course: float) -> Command:
    """The autopilot's command for a decision: course and pitch through the air, airspeed."""
    return command_for(scale(decision.direction, decision.speed), course)


def note(states: Array, index: int, flown: Flown) -> None:
    """Write down where aircraft `index` is: what the others can see of it."""
    plane = flown.plane
    states[index, 0] = plane.position.x
    states[index, 1] = plane.position.y
    states[index, 2] = plane.position.z
    states[index, 3] = plane.velocity.x
    states[index, 4] = plane.velocity.y
    states[index, 5] = plane.velocity.z
    states[index, 6] = plane.course


def widened(e: Envelope, flown: Flown, model: PlaneModel, declared: float) -> Envelope:
    """The envelope with one more aircraft's state."""
    plane = flown.plane
    surface = max(
        abs(plane.pitch.surface) / model.pitch_law.surface_limit,
        abs(plane.yaw.surface) / model.yaw_law.surface_limit,
    )
    return Envelope(
        min(e.pitch_low, plane.pitch.angle),
        max(e.pitch_high, plane.pitch.angle),
        min(e.speed_low, plane.speed / declared),
        max(e.speed_high, plane.speed / declared),
        min(e.lowest, -plane.position.z),
        max(e.surface, surface),
    )


class Gusts(NamedTuple):
    """What drives the gusts that one aircraft meets."""

    climate: Climate
    noise: Array  # (ticks, players, 5) standard normal
    player: int  # the aircraft, 0 = the evader


def flown_on(
    flown: Flown, model: PlaneModel, command: Command, gusts: Gusts, sample: int, count: int
) -> Flown:
    """`count` samples of one aircraft, with the gusts' grid, from sample number `sample` on."""
    for k in range(sample, sample + count):
        if k % GUST_EVERY == 0 and k > 0:
            n = gusts.noise[k // GUST_EVERY, gusts.player]
            drive = GustNoise(n[0], n[1], n[2], n[3], n[4])
            flown = blown(flown, GUST_EVERY * model.dt, drive)
        flown = fly(flown, model, command, gusts.climate)
    return flown


class Start(NamedTuple):
    """A game before its first step, and what it is played under."""

    game: Game
    conditions: Conditions
    fleet: Fleet
    climate: Climate
    sensor: Sensor
    band: Band


class Noise(NamedTuple):
    """The random numbers of a game."""

    gusts: Array  # (ticks, players, 5) standard normal
    tracks: Array  # (steps, players, 6) errors of the tracks, in sigmas


def decide_all(
    start: Start, game: Game, states: Array, noise: Array, evasion: Evasion, commands: list[Command]
) -> None:
    """Everybody's decision as `commands`, evader first; `noise` (players, 6) is that of the tracks now."""
    climate, sensor, band, conditions = start.climate, start.sensor, start.band, start.conditions
    exact = Sight(states, climate, noise, 0.0, 0.0)
    noisy = Sight(states, climate, noise, sensor.position, sensor.velocity)
    own = seen(0, game.evader.speed, exact)
    others = each(seen_pursuer, game.pursuers, noisy)
    limits = banded(game.evader_limits, -own.position.z, band)
    wind = wind_at(climate, own.position)
    view = evader_view(own, limits, others, conditions.target, wind, conditions.rules)
    commands[0] = order(decide_evader(view, evasion), states[0, 6])
    spotted = seen(0, game.evader.speed, noisy)
    sighting = sighted(spotted, heading_at(spotted), conditions.control.lookahead)
    team = Game(
        game.time,
        spotted,
        each(seen_pursuer, game.pursuers, exact),
        game.evader_limits,
        each(banded_pursuer, game.pursuer_limits, Heights(states, band)),
        game.score,
    )
    decisions = decide_pursuers(team, sighting, conditions, pursuer)
    for i in range(len(decisions)):
        commands[i + 1] = order(decisions[i], states[i + 1, 6])


def write_down(log: Array, states: Array, commands: list[Command]) -> None:
    """Everybody's place, flown course and decided course into `log` (players, 5)."""
    for i in range(len(commands)):
        log[i, 0] = states[i, 0]
        log[i, 1] = states[i, 1]
        log[i, 2] = states[i, 2]
        log[i, 3] = states[i, 6]
        log[i, 4] = commands[i].angle


def play(
    start: Start, evasion: Evasion, players: list[Flown], commands: list[Command], noise: Noise, log: Array
) -> SpatialPlay:
    """Play a game out. Kernel style but for the lists, which it changes in place.

    `players` and `commands`: evader first; `log` (steps, players, 5): position [m; NED], flown and decided
    course [rad].
    """
    game, conditions, fleet, climate, _sensor, _band = start
    ratio = int(conditions.control.dt / fleet.evader.dt + 0.5)
    reach = Envelope(0.0, 0.0, 1.0, 1.0, 1e300, 0.0)
    states = np.empty((len(players), 7))
    for i in range(len(players)):
        note(states, i, players[i])
    steps = 0
    sample = 0
    while game.score.verdict == GameResult.RUNNING:
        decide_all(start, game, states, noise.tracks[steps], evasion, commands)
        write_down(log[steps], states, commands)
        # Between two decisions nobody looks at anybody: each flies on alone.
        gusts = Gusts(climate, noise.gusts, 0)
        flown = flown_on(players[0], fleet.evader, commands[0], gusts, sample, ratio)
        reach = widened(reach, flown, fleet.evader, game.evader.speed)
        note(states, 0, flown)
        players[0] = flown
        for i in range(1, len(players)):
            gusts = Gusts(climate, noise.gusts, i)
            flown = flown_on(players[i], fleet.pursuer, commands[i], gusts, sample, ratio)
            reach = widened(reach, flown, fleet.pursuer, game.pursuers[i - 1].speed)
            note(states, i, flown)
            players[i] = flown
        sample += ratio
        after = Sight(states, climate, noise.tracks[steps], 0.0, 0.0)
        e = seen(0, game.evader.speed, after)
        game = judged(game, e, each(seen_pursuer, game.pursuers, after), conditions)
        steps += 1
    return SpatialPlay(game, steps, sample, reach)
