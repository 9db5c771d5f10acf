"""What would become of a way to fly: the evader's path against pursuers that are assumed to chase it.

The evader turns to a heading as fast as it may and holds it; each pursuer chases by the rule that explains
its present heading best, turning no faster than it declares. A fixed number of steps for every way.
"""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt, tan
from typing import NamedTuple

from onboard.core.game.views import EvaderView, heading_at
from onboard.core.geometry.cones import blocked_cones
from onboard.core.geometry.free_ray import free_ray_limited
from onboard.core.math.angles import wrap
from onboard.core.math.each import each, each_pair
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import TINY, Vec, clamp, distance, dot, scale, sub, unit, yaw_of

STEPS = (0, 1, 2, 3, 4, 5, 6, 7, 8)  # instants of a path, the first one now
BEARING = 0  # a pursuer that keeps the bearing: parallel pursuit
PURE = 1  # straight at the evader
PAPER = 2  # rules 4 to 6 of 3.4.2
UNLIMITED = 1e9  # [rad/s]
STEEPEST = 1.5  # pitch of a pursuer [rad]


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
    climb: float  # largest slope of a pursuer's path: tan θ


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
    """The direction in which a pursuer at `p` chases the evader; not normalised. Written out in floats: an
    evader asks it a thousand times a decision."""
    x, y, z, hx, hy, hz = seen
    px, py, pz = p
    x -= px
    y -= py
    z -= pz
    square = x * x + y * y + z * z
    if square <= TINY or model == PURE:
        return Vec(x, y, z)
    away = hx * x + hy * y + hz * z  # −d cos φ
    if model == PAPER and away >= 0.0 and v_p < v_e:
        return Vec(hx, hy, hz)
    # The evader's velocity across the line of sight, and what is left of the own speed along it.
    k = away / square
    cx = v_e * (hx - k * x)
    cy = v_e * (hy - k * y)
    cz = v_e * (hz - k * z)
    left = v_p * v_p - cx * cx - cy * cy - cz * cz
    if left > 0.0:
        k = sqrt(left / square)
        return Vec(cx + k * x, cy + k * y, cz + k * z)
    if model == PAPER and v_p < v_e:
        gamma = v_p / v_e
        sine = sqrt(max(0.0, square - away * away))  # d sin φ
        k = -away + sine * gamma / sqrt(1.0 - gamma * gamma)  # v_e T of (19)
        return Vec(x + k * hx, y + k * hy, z + k * hz)
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
    path, v_e, step, climb = hunt
    (px, py, pz), velocity, v_p = pursuer
    model = model_of(path[0], pursuer, v_e)
    yaw = yaw_of(velocity)
    reach = turning(turn_rate) * step
    smallest = 1e300
    dx, dy, dz = velocity
    for number in range(len(path) - 1):
        x, y, z, _hx, _hy, _hz = path[number]
        dx, dy, dz = chase(path[number], Vec(px, py, pz), v_e, v_p, model)
        flat = sqrt(dx * dx + dy * dy)
        if abs(dz) > climb * flat:
            dz = climb * flat if dz > 0.0 else -climb * flat
        if reach < pi:
            yaw += clamp(wrap(atan2(dy, dx) - yaw), -reach, reach)
            dx = flat * cos(yaw)
            dy = flat * sin(yaw)
        n = sqrt(flat * flat + dz * dz)
        pace = v_p * step / n if n > TINY else 0.0
        # The closest approach within the step, both flying straight.
        rx = x - px
        ry = y - py
        rz = z - pz
        px += dx * pace
        py += dy * pace
        pz += dz * pace
        x, y, z, _hx, _hy, _hz = path[number + 1]
        mx = x - px - rx
        my = y - py - ry
        mz = z - pz - rz
        moved = mx * mx + my * my + mz * mz
        inward = rx * mx + ry * my + rz * mz
        if inward < 0.0 and moved > TINY:
            when = min(1.0, -inward / moved)
            rx += mx * when
            ry += my * when
            rz += mz * when
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
    steep = min(STEEPEST, max(view.limits.pitch_max, -view.limits.pitch_min))
    hunt = Hunt(path, wish.speed, wish.step, tan(steep))
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
