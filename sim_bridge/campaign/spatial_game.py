"""The spatial game of 4.4 with the aircraft as flown, in its wind: one kernel, interpreted or compiled.

Everybody decides at the control rate from what they see, in the moving air; the aircraft and the gusts are
stepped by the same kernels that the bridge flies. Opponents are seen with the sensor's noise, own states
exactly. Pursuers see the evader's measured direction of flight, not its decision. Capture, arrival and
the safety distance are judged on ground positions.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.advance import Field, Game, Params, decide_one, judged, seats
from onboard.core.game.referee import GameResult
from onboard.core.geometry.apollonius import intercept
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import TINY, Vec, clamp, norm, scale
from onboard.core.strategy.evasion import EvaderView, evader, straight
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.pursuit import heading_at, pursuer
from sim_bridge.campaign.plane_in_wind import GUST_EVERY, Climate, Flown, blown, command_for, fly, wind_at
from sim_bridge.vehicle.flight.plane import Command, PlaneModel
from sim_bridge.vehicle.wind.dryden import GustNoise

Array = NDArray[np.float64]


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


def ground_target(params: Params, own: Vehicle, wind: Vec) -> Vec:
    """Where the target, which moves at −w in the air, will be met; the target itself where it cannot."""
    drift = norm(wind)
    if drift <= TINY:
        return params.target
    meeting = intercept(params.target, scale(wind, -1.0 / drift), drift, own.position, own.speed)
    if meeting.exists:
        return meeting.point
    return params.target


def decide_evader(game: Game, params: Params, wind: Vec, brave: bool) -> Decision:
    """The evader's decision: by its strategy, or straight at the target where it is `brave`."""
    view = EvaderView(
        game.evader,
        game.evader_limits,
        game.pursuers,
        blocked_cones(game.evader, game.pursuers, params.rho),
        params.has_target,
        ground_target(params, game.evader, wind),
        params.R,
        params.lambda_,
        params.beta,
        params.planar,
    )
    if brave:
        return straight(view)
    return evader(view)


def decide_pursuers(game: Game, params: Params) -> tuple[Decision, ...]:
    """All pursuers' decisions against the evader as they see it."""
    field = Field(game.evader, heading_at(game.evader), params, pursuer)
    return each(decide_one, seats(game, params), field)


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


def flown_on(
    flown: Flown,
    model: PlaneModel,
    command: Command,
    climate: Climate,
    gusts: Array,
    index: int,
    sample: int,
    count: int,
) -> Flown:
    """`count` samples of one aircraft, with the gusts' grid, from sample number `sample` on."""
    for k in range(sample, sample + count):
        if k % GUST_EVERY == 0 and k > 0:
            n = gusts[k // GUST_EVERY, index]
            drive = GustNoise(n[0], n[1], n[2], n[3], n[4])
            flown = blown(flown, GUST_EVERY * model.dt, drive)
        flown = fly(flown, model, command, climate)
    return flown


def play(
    game: Game,
    params: Params,
    players: list[Flown],
    commands: list[Command],
    fleet: Fleet,
    climate: Climate,
    sensor: Sensor,
    band: Band,
    brave: bool,
    gusts: Array,
    tracks: Array,
    log: Array,
) -> SpatialPlay:
    """Play a game out. Kernel style but for the lists, which it changes in place.

    `players` and `commands` (evader first), `gusts` (ticks, players, 5) standard normal, `tracks`
    (steps, players, 6) the tracks' errors in sigmas, `log` (steps, players, 5): position [m; NED],
    flown and decided course [rad].
    """
    ratio = int(params.dt / fleet.evader.dt + 0.5)
    reach = Envelope(0.0, 0.0, 1.0, 1.0, 1e300, 0.0)
    states = np.empty((len(players), 7))
    for i in range(len(players)):
        note(states, i, players[i])
    steps = 0
    sample = 0
    while game.score.verdict == GameResult.RUNNING:
        noise = tracks[steps]
        exact = Sight(states, climate, noise, 0.0, 0.0)
        noisy = Sight(states, climate, noise, sensor.position, sensor.velocity)
        own = seen(0, game.evader.speed, exact)
        others = each(seen_pursuer, game.pursuers, noisy)
        wind = wind_at(climate, own.position)
        limits = banded(game.evader_limits, -own.position.z, band)
        view = Game(game.time, own, others, limits, game.pursuer_limits, game.score)
        escape = decide_evader(view, params, wind, brave)
        spotted = seen(0, game.evader.speed, noisy)
        team = each(seen_pursuer, game.pursuers, exact)
        decisions = decide_pursuers(
            Game(
                game.time,
                spotted,
                team,
                game.evader_limits,
                each(banded_pursuer, game.pursuer_limits, Heights(states, band)),
                game.score,
            ),
            params,
        )
        commands[0] = order(escape, states[0, 6])
        for i in range(len(decisions)):
            commands[i + 1] = order(decisions[i], states[i + 1, 6])
        for i in range(len(players)):
            log[steps, i, 0] = states[i, 0]
            log[steps, i, 1] = states[i, 1]
            log[steps, i, 2] = states[i, 2]
            log[steps, i, 3] = states[i, 6]
            log[steps, i, 4] = commands[i].angle
        # Between two decisions nobody looks at anybody: each flies on alone.
        flown = flown_on(players[0], fleet.evader, commands[0], climate, gusts, 0, sample, ratio)
        reach = widened(reach, flown, fleet.evader, game.evader.speed)
        note(states, 0, flown)
        players[0] = flown
        for i in range(1, len(players)):
            flown = flown_on(players[i], fleet.pursuer, commands[i], climate, gusts, i, sample, ratio)
            reach = widened(reach, flown, fleet.pursuer, game.pursuers[i - 1].speed)
            note(states, i, flown)
            players[i] = flown
        sample += ratio
        after = Sight(states, climate, noise, 0.0, 0.0)
        game = judged(
            game, seen(0, game.evader.speed, after), each(seen_pursuer, game.pursuers, after), params
        )
        steps += 1
    return SpatialPlay(game, steps, sample, reach)
