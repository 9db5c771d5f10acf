"""Whether pursuers close the band of directions that the evader can fly, and where they do not.

The reachable band is every heading at every pitch that its limits, the floor and the ceiling allow. A pursuer
closes the cone of half-angle asin γ + asin(reach / d) about its line of sight, where `reach` is the capture
radius R less what delay, a turn of the nose and noise cost. Kernel style but for local lists.
"""

from __future__ import annotations

from math import acos, asin, atan2, ceil, cos, inf, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.game.views import heading_at
from onboard.core.geometry.cones import NOTHING, Cone, Seen, blocked_cone
from onboard.core.geometry.free_ray import free_ray_limited
from onboard.core.math.angles import TURN, wrap
from onboard.core.math.each import each
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import TINY, Vec, clamp, distance, pitch_of, yaw_of
from onboard.core.strategy.team.plan_types import Heights, Member, Situation

PITCHES = 5  # at which the width of a way out is measured
SIGMAS = 2.0  # of the track's noise that the margin holds


class WayOut(NamedTuple):
    """The widest way out of a ring, or its smallest overlap."""

    closed: bool  # no free ray at any pitch of the band
    gap: float  # [rad of heading]; negative: overlap
    bearing: float  # [rad, north to east] of its middle
    pitch: float  # [rad, up] where it is widest
    left: int  # the member before it, north to east; −1 = nobody
    right: int  # the member after it


def sight_cone(gamma: float, pitch: float) -> float:
    """Half the heading that one level pursuer closes at a `pitch` [rad]: acos(cos(asin γ) / cos θ), or 0.

    Two neighbours on a ring may so be twice that apart: G = 2 acos(cos(asin γ) / cos θ).
    """
    if gamma >= 1.0:
        return pi
    c = sqrt(1.0 - gamma * gamma) / max(cos(pitch), TINY)
    return acos(c) if c < 1.0 else 0.0


def least_number(gamma: float, pitch: float) -> int:
    """How many level pursuers a closed ring takes at least, out to a `pitch` [rad]; 0 where none suffice.

    In the plane (pitch 0) that is ⌈π / asin γ⌉.
    """
    half = sight_cone(gamma, pitch)
    if half <= 0.0:
        return 0
    return max(1, int(ceil(pi / half - 1e-12)))  # noqa: RUF046 (compiled code has no integer ceil)


def lag(member: Member, s: Situation) -> float:
    """What a pursuer loses before it flies as an evader at the edge of its cone demands [m].

    There it flies square to the line of sight. The turn to that costs, on the mean, half of what it flies
    meanwhile, less the time in which the evader turns to that edge itself; delay and noise come on top.
    """
    vehicle, limits, _fit = member
    e = s.evader
    turning = 0.0
    v = vehicle.velocity
    if limits.turn_rate > 0.0 and v.x * v.x + v.y * v.y > TINY:
        nose = atan2(v.y, v.x)
        ahead = heading_at(e)
        course = atan2(ahead.y, ahead.x)
        bearing = atan2(vehicle.position.y - e.position.y, vehicle.position.x - e.position.x)
        edge = asin(min(1.0, vehicle.speed / max(e.speed, TINY)))
        for k in range(2):
            side = 1.0 if k == 0 else -1.0
            own = abs(wrap(bearing + side * 0.5 * pi - nose)) / limits.turn_rate
            its = 0.0
            if s.evader_limits.turn_rate > 0.0:
                its = abs(wrap(bearing + side * edge - course)) / s.evader_limits.turn_rate
            turning = max(turning, own - its)
    return vehicle.speed * (s.margin.delay + 0.5 * turning) + SIGMAS * s.margin.sigma


def pitch_band(evader: Vehicle, limits: VehicleLimits, heights: Heights, far: float) -> VehicleLimits:
    """The limits of an evader that has `far` [m] to fly before it is past the ring.

    A straight climb of that length has to end below the ceiling, a descent above the floor.
    """
    up = (heights.ceiling + evader.position.z) / max(far, TINY)
    down = (heights.floor + evader.position.z) / max(far, TINY)
    high = max(0.0, min(limits.pitch_max, asin(clamp(up, 0.0, 1.0))))
    low = min(0.0, max(limits.pitch_min, asin(clamp(down, -1.0, 0.0))))
    return VehicleLimits(
        limits.speed_min, limits.speed_max, low, high, limits.yaw_min, limits.yaw_max, limits.turn_rate
    )


def past(s: Situation) -> float:
    """The least that the evader flies before it is past the nearest pursuer [m]: d cos φ / (1 − γ²) at the
    edge of its cone, where cos φ = √(1 − γ²); 0 with a pursuer that is as fast."""
    least = inf
    for member in s.team:
        if member.fit:
            gamma = member.vehicle.speed / max(s.evader.speed, TINY)
            if gamma >= 1.0:
                return 0.0
            least = min(
                least, distance(member.vehicle.position, s.evader.position) / sqrt(1.0 - gamma * gamma)
            )
    return least


def _cone(member: Member, _index: int, s: Situation) -> Cone:
    if not member.fit:
        return NOTHING
    # Who is late by more than its distance closes nothing: its cone is empty.
    far = distance(member.vehicle.position, s.evader.position)
    reach = max(s.rules.R - lag(member, s), -0.999 * far)
    return blocked_cone(member.vehicle, 0, Seen(s.evader.position, s.evader.speed, reach))


def half_width(cone: Cone, pitch: float) -> float:
    """Half the headings that a cone closes at a pitch [rad], 0…π."""
    if cone.cos < -1.0:
        return pi
    flat = sqrt(cone.axis.x * cone.axis.x + cone.axis.y * cone.axis.y) * cos(pitch)
    rise = cone.cos + sin(pitch) * cone.axis.z
    if cone.cos > 1.0 or rise >= flat:
        return 0.0
    if rise <= -flat:
        return pi
    return acos(rise / flat)


def way_out_at(cones: tuple[Cone, ...], pitch: float) -> WayOut:
    """The widest way out at one pitch [rad], `closed` by that pitch alone."""
    n = len(cones)
    starts = [0.0] * n
    ends = [0.0] * n
    who = [0] * n
    count = 0
    for i in range(n):
        half = half_width(cones[i], pitch)
        if half >= pi:
            return WayOut(True, -pi, 0.0, pitch, i, i)
        if half <= 0.0:
            continue
        start = wrap(yaw_of(cones[i].axis) - half)  # in order from south on, whichever arcs reach over it
        k = count
        while k > 0 and starts[k - 1] > start:
            starts[k] = starts[k - 1]
            ends[k] = ends[k - 1]
            who[k] = who[k - 1]
            k -= 1
        starts[k] = start
        ends[k] = start + 2.0 * half
        who[k] = i
        count += 1
    if count == 0:
        return WayOut(False, TURN, 0.0, pitch, -1, -1)
    reach = -inf
    last = 0
    for k in range(count):
        if ends[k] > reach:
            reach = ends[k]
            last = who[k]
    reach -= TURN
    widest = WayOut(False, -inf, 0.0, pitch, -1, -1)
    for k in range(count):
        gap = starts[k] - reach
        if gap > widest.gap:
            widest = WayOut(gap <= 0.0, gap, wrap(reach + 0.5 * gap), pitch, last, who[k])
        if ends[k] > reach:
            reach = ends[k]
            last = who[k]
    return widest


class _Reach(NamedTuple):
    """From how far a pursuer captures (for `each`)."""

    situation: Situation
    reach: float  # [m]


def _whole(member: Member, _index: int, shared: _Reach) -> Cone:
    if not member.fit:
        return NOTHING
    e = shared.situation.evader
    return blocked_cone(member.vehicle, 0, Seen(e.position, e.speed, shared.reach))


def escapes(s: Situation) -> bool:
    """Whether the evader has a free ray at its safety distance ρ, as a goalkeeper asks it."""
    cones = each(_whole, s.team, _Reach(s, s.rules.rho))
    return free_ray_limited(heading_at(s.evader), cones, s.evader_limits, s.rules.planar).exists


def cones_of(s: Situation) -> tuple[Cone, ...]:
    """What each member closes, with the margin."""
    return each(_cone, s.team, s)


def way_out(s: Situation) -> WayOut:
    """The widest way out of the whole band. `closed` is exact: it is asked of the free ray of all cones."""
    cones = cones_of(s)
    limits = s.evader_limits
    low = 0.0
    high = 0.0
    if not s.rules.planar:
        limits = pitch_band(s.evader, limits, s.heights, past(s))
        low = limits.pitch_min
        high = limits.pitch_max
    widest = way_out_at(cones, low)
    if high > low:
        for k in range(1, PITCHES):
            found = way_out_at(cones, low + (high - low) * k / (PITCHES - 1))
            if found.gap > widest.gap:
                widest = found
    ray = free_ray_limited(Vec(cos(widest.bearing), sin(widest.bearing), 0.0), cones, limits, s.rules.planar)
    if ray.exists and widest.gap <= 0.0:
        widest = way_out_at(cones, clamp(pitch_of(ray.direction), low, high))
    return WayOut(not ray.exists, widest.gap, widest.bearing, widest.pitch, widest.left, widest.right)
