"""What would become of a way to fly: the evader's path against pursuers that are assumed to chase it.

The evader turns to a heading as fast as it may and holds it; each pursuer chases by the rule that explains
its present heading best, turning no faster than it declares. A fixed number of steps for every way.
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.game.views import EvaderView, heading_at
from onboard.core.geometry.cones import blocked_cones, free_ray_limited
from onboard.core.math.angles import wrap
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import TINY, Vec, clamp, distance, dot, scale, sub, unit, yaw_of

STEPS = (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12)  # instants of a path, the first one now
BEARING = 0  # a pursuer that keeps the bearing: parallel pursuit
PURE = 1  # straight at the evader
PAPER = 2  # rules 4 to 6 of 3.4.2
UNLIMITED = 1e9  # [rad/s]


class Instant(NamedTuple):
    """The evader at one instant of its path."""

    x: float  # [m; NED]
    y: float
    z: float
    hx: float  # heading, unit
    hy: float
    hz: float


class Wish(NamedTuple):
    """A way to fly: turn to a heading, hold it."""

    origin: Vec  # [m; NED]
    speed: float  # [m/s]
    yaw: float  # now [rad]
    turn: float  # to the wanted heading [rad], signed
    pitch: float  # wanted, flown at once [rad]
    rate: float  # of the turn, at most [rad/s]
    step: float  # between two instants [s]


class Hunt(NamedTuple):
    """What a pursuer is played against."""

    path: tuple[Instant, ...]
    speed: float  # of the evader [m/s]
    step: float  # [s]
    climb: float  # largest sine of a pursuer's pitch


class Hunted(NamedTuple):
    """A pursuer at the end of the path."""

    vehicle: Vehicle
    smallest: float  # distance to the evader on the way [m]


class Foreseen(NamedTuple):
    """What a way to fly comes to."""

    smallest: float  # distance of any pursuer [m]
    free: bool  # whether a ray is free at the end
    closeness: float  # cosine of that ray to the way to the target or away from the pursuers
    left: float  # distance of the nearest pursuer at the end [m]


def turning(rate: float) -> float:
    """A declared turn rate [rad/s] as a limit; 0 = not declared means none."""
    return rate if rate > 0.0 else UNLIMITED


def instant(number: int, _index: int, wish: Wish) -> Instant:
    """The evader after `number` steps (for `each`): an arc, then straight on."""
    t = number * wish.step
    level, climb = cos(wish.pitch), sin(wish.pitch)
    way = wish.speed * level
    reach = wish.rate * t
    turn = clamp(wish.turn, -reach, reach)
    yaw = wish.yaw + turn
    x, y = 0.0, 0.0
    arc = abs(turn) / wish.rate
    if abs(turn) > 1e-9 and arc > 0.0:
        radius = way * arc / turn
        x = radius * (sin(yaw) - sin(wish.yaw))
        y = radius * (cos(wish.yaw) - cos(yaw))
    straight = way * (t - arc)
    x += straight * cos(yaw)
    y += straight * sin(yaw)
    e = wish.origin
    hx, hy = level * cos(yaw), level * sin(yaw)
    return Instant(e.x + x, e.y + y, e.z - wish.speed * climb * t, hx, hy, -climb)


def chase(seen: Instant, p: Vec, v_e: float, v_p: float, model: int) -> Vec:
    """The direction in which a pursuer at `p` chases the evader; not normalised."""
    rx, ry, rz = seen.x - p.x, seen.y - p.y, seen.z - p.z
    far = sqrt(rx * rx + ry * ry + rz * rz)
    if far <= TINY or model == PURE:
        return Vec(rx, ry, rz)
    lx, ly, lz = rx / far, ry / far, rz / far
    away = seen.hx * lx + seen.hy * ly + seen.hz * lz  # −cos φ
    if model == PAPER and away >= 0.0 and v_p < v_e:
        return Vec(seen.hx, seen.hy, seen.hz)
    cx = v_e * (seen.hx - away * lx)
    cy = v_e * (seen.hy - away * ly)
    cz = v_e * (seen.hz - away * lz)
    lateral = cx * cx + cy * cy + cz * cz
    square = v_p * v_p
    if lateral < square:
        k = sqrt(square - lateral)
        return Vec(cx + k * lx, cy + k * ly, cz + k * lz)
    if model == PAPER and v_p < v_e:
        gamma = v_p / v_e
        sine = sqrt(max(0.0, 1.0 - away * away))
        k = far * (-away + sine * gamma / sqrt(1.0 - gamma * gamma))  # v_e T of (19)
        return Vec(rx + k * seen.hx, ry + k * seen.hy, rz + k * seen.hz)
    return Vec(cx, cy, cz)


def model_of(seen: Instant, pursuer: Vehicle, v_e: float) -> int:
    """The rule that explains a pursuer's present heading best; bearing where two do equally well."""
    heading = heading_at(pursuer)
    p, v_p = pursuer.position, pursuer.speed
    best = BEARING
    nearest = dot(unit(chase(seen, p, v_e, v_p, BEARING), heading), heading) + 1e-3
    pure = dot(unit(chase(seen, p, v_e, v_p, PURE), heading), heading)
    if pure > nearest:
        best = PURE
        nearest = pure
    if dot(unit(chase(seen, p, v_e, v_p, PAPER), heading), heading) > nearest:
        best = PAPER
    return best


def hunted(pursuer: Vehicle, turn_rate: float, hunt: Hunt) -> Hunted:
    """A pursuer played along the evader's path (for `each_pair`)."""
    path, v_e, step = hunt.path, hunt.speed, hunt.step
    (px, py, pz), velocity, v_p = pursuer
    model = model_of(path[0], pursuer, v_e)
    yaw = yaw_of(velocity)
    reach = turning(turn_rate) * step
    smallest = 1e300
    dx, dy, dz = velocity
    for number in range(len(path) - 1):
        now, then = path[number], path[number + 1]
        dx, dy, dz = chase(now, Vec(px, py, pz), v_e, v_p, model)
        flat = sqrt(dx * dx + dy * dy)
        steep = hunt.climb * sqrt(flat * flat + dz * dz)
        if dz > steep or dz < -steep:
            dz = steep if dz > 0.0 else -steep
        if reach < pi:
            yaw = yaw + clamp(wrap(atan2(dy, dx) - yaw), -reach, reach)
            dx, dy = flat * cos(yaw), flat * sin(yaw)
        n = sqrt(dx * dx + dy * dy + dz * dz)
        pace = v_p * step / n if n > TINY else 0.0
        # The closest approach within the step, both flying straight.
        rx, ry, rz = now.x - px, now.y - py, now.z - pz
        px, py, pz = px + dx * pace, py + dy * pace, pz + dz * pace
        mx, my, mz = then.x - px - rx, then.y - py - ry, then.z - pz - rz
        moved = mx * mx + my * my + mz * mz  # [m²]
        when = clamp(-(rx * mx + ry * my + rz * mz) / moved, 0.0, 1.0) if moved > TINY else 0.0
        rx, ry, rz = rx + mx * when, ry + my * when, rz + mz * when
        smallest = min(smallest, rx * rx + ry * ry + rz * rz)
    n = sqrt(dx * dx + dy * dy + dz * dz)
    k = v_p / n if n > TINY else 0.0
    return Hunted(Vehicle(Vec(px, py, pz), Vec(dx * k, dy * k, dz * k), v_p), sqrt(smallest))


def vehicle_of(end: Hunted, _index: int, _shared: float) -> Vehicle:
    """The pursuer alone (for `each`)."""
    return end.vehicle


def foreseen(view: EvaderView, wish: Wish) -> Foreseen:
    """What the way to fly comes to at the end of its steps."""
    path = each(instant, STEPS, wish)
    hunt = Hunt(path, wish.speed, wish.step, sin(max(view.limits.pitch_max, -view.limits.pitch_min)))
    ends = each_pair(hunted, view.pursuers, view.turn_rates, hunt)
    last = path[-1]
    place = Vec(last.x, last.y, last.z)
    smallest, left = 1e300, 1e300
    for end in ends:
        smallest = min(smallest, end.smallest)
        left = min(left, distance(end.vehicle.position, place))
    if smallest <= view.rules.R:
        return Foreseen(smallest, False, -1.0, left)
    heading = Vec(last.hx, last.hy, last.hz)
    own = Vehicle(place, scale(heading, wish.speed), wish.speed)
    goal = heading
    if view.target.exists:
        goal = unit(sub(view.target.position, place), heading)
    cones = blocked_cones(own, each(vehicle_of, ends, 0.0), view.rules.rho)
    ray = free_ray_limited(goal, cones, view.limits, view.rules.planar)
    return Foreseen(smallest, ray.exists, ray.closeness, left)
