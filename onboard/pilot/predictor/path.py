"""From mean velocities at a few horizons to a place and a velocity at any time between."""

from __future__ import annotations

from itertools import pairwise
from math import hypot, isfinite, isnan
from typing import NamedTuple

from onboard.core.math.each import new
from onboard.core.math.vectors import Vec, along
from onboard.pilot.predictor.forecast import Answer
from onboard.pilot.predictor.prediction import Prediction, PredictorKind
from onboard.pilot.track_filter import Estimate

Row = tuple[float, ...]


class Knot(NamedTuple):
    """One horizon of a path."""

    time: float  # ahead of the path's start [s]
    move: Vec  # displacement until then [m]
    velocity: Vec  # there [m/s]
    sigma: float  # root mean square distance error of the displacement [m]; NaN: not known
    kind: PredictorKind


class Path(NamedTuple):
    """A predicted path: cubic between knots, smooth in place and velocity."""

    t: float  # start [s]
    position: Vec
    sigma: float  # error of the start [m]
    knots: tuple[Knot, ...]  # the first at time 0


def path(start: Estimate, said: Answer, horizons: tuple[int, ...], step: float) -> Path:
    """The path of a forecast, from a track's estimate; horizons are counted in steps of `step` [s]."""
    t, position, (vx, vy, vz), sigma, _sigma_velocity = start
    means = zip(said.velocities, horizons, strict=True)
    moves: list[Row] = [(0.0, 0.0, 0.0), *[(x * h, y * h, z * h) for (x, y, z), h in means]]
    slopes = _slopes((0, *horizons), moves, (vx * step, vy * step, vz * step))
    kinds = (said.kinds[0], *said.kinds)
    errors = (0.0, *said.sigma)
    knots = [
        new(Knot, (h * step, Vec(*move), new(Vec, (x / step, y / step, z / step)), error, kind))
        for h, move, (x, y, z), error, kind in zip((0, *horizons), moves, slopes, errors, kinds, strict=True)
    ]
    return new(Path, (t, position, sigma, tuple(knots)))


def sound(line: Path, speed: float) -> bool:
    """Whether every number is finite and no mean velocity exceeds twice the given speed [m/s]."""
    for time, (x, y, z), (vx, vy, vz), _sigma, _kind in line.knots:
        if not isfinite(x + y + z + vx + vy + vz):
            return False
        if hypot(x, y, z) > (2.0 * speed + 1.0) * time:
            return False
    return True


def at(line: Path, t: float, steady_sigma: float) -> Prediction:
    """The prediction at instant `t` ≥ line.t [s]; `steady_sigma` is the error of constant velocity then [m],
    which stands in where no error was held out."""
    ahead = t - line.t
    knots = line.knots
    if ahead > knots[-1].time:
        return _beyond(line, ahead, steady_sigma)
    index = 1
    while knots[index].time < ahead:
        index += 1
    a, b = knots[index - 1], knots[index]
    width = b.time - a.time
    u = (ahead - a.time) / width
    # Hermite's cubic and its derivative
    h, near, far = u * u * (3.0 - 2.0 * u), u * (1.0 - u) * (1.0 - u) * width, -u * u * (1.0 - u) * width
    dh, dnear, dfar = 6.0 * u * (1.0 - u) / width, (1.0 - u) * (1.0 - 3.0 * u), u * (3.0 * u - 2.0)
    (x, y, z), (ax, ay, az), (bx, by, bz) = line.position, a.move, b.move
    (avx, avy, avz), (bvx, bvy, bvz) = a.velocity, b.velocity
    rx, ry, rz = bx - ax, by - ay, bz - az
    place = new(Vec, (
        x + ax + rx * h + avx * near + bvx * far,
        y + ay + ry * h + avy * near + bvy * far,
        z + az + rz * h + avz * near + bvz * far,
    ))
    speed = new(Vec, (
        rx * dh + avx * dnear + bvx * dfar,
        ry * dh + avy * dnear + bvy * dfar,
        rz * dh + avz * dnear + bvz * dfar,
    ))
    grown = a.sigma * (1.0 - u) + b.sigma * u
    sigma = steady_sigma if isnan(grown) else (line.sigma * line.sigma + grown * grown) ** 0.5
    return new(Prediction, (place, speed, sigma, b.kind, True))


def _beyond(line: Path, ahead: float, steady_sigma: float) -> Prediction:
    """Past the longest horizon: on with the last velocity, ever less sure."""
    end = line.knots[-1]
    known = (line.sigma * line.sigma + end.sigma * end.sigma) ** 0.5 * (ahead / end.time) ** 1.5
    sigma = steady_sigma if isnan(known) else known
    place = along(along(line.position, end.move, 1.0), end.velocity, ahead - end.time)
    return new(Prediction, (place, end.velocity, sigma, PredictorKind.CONSTANT_VELOCITY, True))


def _slopes(ahead: tuple[int, ...], moves: list[Row], first: Row) -> list[Row]:
    """Velocities (k, 3) at the knots: given at the first, of the parabola through three neighbours between,
    and at the last half as far beyond the last stretch's mean as that is beyond the knot before."""
    stretches = []
    for (t, (ax, ay, az)), (u, (bx, by, bz)) in pairwise(zip(ahead, moves, strict=True)):
        width = u - t
        stretches.append((width, (bx - ax) / width, (by - ay) / width, (bz - az) / width))
    out = [first]
    for (w, ax, ay, az), (v, bx, by, bz) in pairwise(stretches):
        both = w + v
        out.append(((w * bx + v * ax) / both, (w * by + v * ay) / both, (w * bz + v * az) / both))
    out.append(tuple(x + 0.5 * (x - y) for x, y in zip(stretches[-1][1:], out[-1], strict=True)))
    return out
