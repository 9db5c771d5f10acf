"""What a situation promises without simulating it (3.4.2).

The gaps that the cones leave in the plane, the largest free cap they leave in space, who denies
the target, who can intercept and when. For people and reports: interpreted only.
"""

from __future__ import annotations

from math import acos, atan2, cos, pi, sin, sqrt
from typing import NamedTuple

from onboard.core.geometry.apollonius import in_time, intercept
from onboard.core.geometry.cones import Cone, blocked_cones, is_free, perpendicular
from onboard.core.math.angles import wrap
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import (
    NORTH,
    TINY,
    Vec,
    along,
    angle_between,
    cross,
    dot,
    norm,
    scale,
    unit,
)


class Gap(NamedTuple):
    """A gap in the plane: free headings from `start` on, `width` wide, north to east [rad]."""

    start: float
    width: float


class Cap(NamedTuple):
    """The largest free cap of directions in space; radius 0 where every ray is blocked."""

    axis: Vec  # unit
    radius: float  # [rad]


class Prospect(NamedTuple):
    """What one pursuer can do."""

    intercepts: bool  # of the evader's present heading
    time: float  # until then [s]; −1 = never
    denies_target: bool  # |p − g| / v_p ≤ |e − g| / v_e
    half_angle: float  # of its cone [rad]


class Assessment(NamedTuple):
    """A situation at a glance."""

    encircled: bool  # no free ray
    gaps: tuple[Gap, ...]  # in the plane, north–east
    largest_gap: float  # [rad]
    cap: Cap  # in space
    target_denied: bool  # by at least one pursuer
    prospects: tuple[Prospect, ...]


def half_angle(cone: Cone) -> float:
    """Half-angle of a cone [rad], 0…π."""
    if cone.cos < -1.0:
        return pi
    if cone.cos > 1.0:
        return 0.0
    return atan2(cone.sin, cone.cos)


def gaps(cones: tuple[Cone, ...]) -> tuple[Gap, ...]:
    """Free headings in the plane between cones whose axes lie in it; one full-circle gap without cones."""
    arcs = []
    for cone in cones:
        half = half_angle(cone)
        if half >= pi:
            return ()
        if half > 0.0:
            low = (atan2(cone.axis.y, cone.axis.x) - half) % (2.0 * pi)
            arcs.append((low, low + 2.0 * half))
    if not arcs:
        return (Gap(-pi, 2.0 * pi),)
    arcs.sort()
    found = []
    reach = arcs[0][1]
    for low, high in [*arcs[1:], (arcs[0][0] + 2.0 * pi, 0.0)]:
        if low > reach + 1e-12:
            found.append(Gap(wrap(reach), low - reach))
        reach = max(reach, high)
    # An arc that passes north again may cover gaps found at the start.
    over = max(high for _, high in arcs) - 2.0 * pi
    if over <= arcs[0][0]:
        return tuple(found)
    kept = []
    for gap in found:
        start = gap.start % (2.0 * pi)
        end = start + gap.width
        if end > over:
            cut = max(start, over) if start < over else start
            kept.append(Gap(wrap(cut), end - cut))
    return tuple(kept)


def largest_free_cap(cones: tuple[Cone, ...]) -> Cap:
    """The largest cap of free directions in space, exact.

    Its centre touches one cone (opposite its axis), two (on the great circle through both axes)
    or three (u·aᵢ = cos(hᵢ + r), linear in u for a given r).
    """
    halves = tuple(half_angle(cone) for cone in cones)
    if any(h >= pi for h in halves):
        return Cap(NORTH, 0.0)
    seats = tuple((cone.axis, h) for cone, h in zip(cones, halves, strict=True) if h > 0.0)
    if not seats:
        return Cap(NORTH, pi)
    best = Cap(NORTH, 0.0)
    for centre in _centres(seats):
        room = min(angle_between(centre, axis) - h for axis, h in seats)
        if room > best.radius:
            best = Cap(centre, room)
    return best


Seat = tuple[Vec, float]  # axis and half-angle of a cone


def _centres(seats: tuple[Seat, ...]) -> list[Vec]:
    """Where the centre of the largest cap can lie; each is measured, so none need be exact."""
    found = []
    for i, (a, ha) in enumerate(seats):
        found.append(scale(a, -1.0))
        for j in range(i):
            b, hb = seats[j]
            apart = angle_between(a, b)
            r = 0.5 * (2.0 * pi - apart - ha - hb)
            off = along(b, a, -dot(a, b))
            # Opposite axes leave a band between the cones: any way across it is as good.
            side = scale(off, 1.0 / norm(off)) if norm(off) > 1e-9 else perpendicular(a)
            if apart > TINY:  # away from b, around a
                found.append(along(scale(a, cos(r + ha)), side, -sin(r + ha)))
            for k in range(j):
                found.extend(_three(seats[i], seats[j], seats[k]))
    return found


def _three(one: Seat, two: Seat, three: Seat) -> list[Vec]:
    """Directions u with u·aᵢ = cos(hᵢ + r): linear in u for a given r, and |u| = 1 gives r."""
    (a, ha), (b, hb), (c, hc) = one, two, three
    bc, ca, ab = cross(b, c), cross(c, a), cross(a, b)
    volume = dot(a, bc)
    if abs(volume) <= 1e-6:
        return _three_coplanar(one, two, three)

    def solve(x: float, y: float, z: float) -> Vec:
        return scale(along(along(scale(bc, x), ca, y), ab, z), 1.0 / volume)

    p = solve(cos(ha), cos(hb), cos(hc))
    q = solve(sin(ha), sin(hb), sin(hc))
    pp, qq, pq = dot(p, p), dot(q, q), dot(p, q)
    # u = p cos r − q sin r, so (pp+qq)/2 − 1 + (pp−qq)/2 cos 2r − pq sin 2r = 0.
    m, n = 0.5 * (pp - qq), -pq
    length = sqrt(m * m + n * n)
    level = 1.0 - 0.5 * (pp + qq)
    if length <= TINY or abs(level) > length:
        return []
    phase = atan2(n, m)
    swing = acos(level / length)
    found = []
    for sign in (-1.0, 1.0):
        r = 0.5 * ((phase + sign * swing) % (2.0 * pi))
        found.append(unit(along(scale(p, cos(r)), q, -sin(r)), NORTH))
        found.append(scale(found[-1], -1.0))
    return found


def _three_coplanar(one: Seat, two: Seat, three: Seat) -> list[Vec]:
    """Axes in one plane: c = x a + y b turns the third equation into one for r alone."""
    for (a, ha), (b, hb), (c, hc) in ((one, two, three), (two, three, one), (three, one, two)):
        normal = cross(a, b)
        square = dot(normal, normal)
        if square <= 1e-12:
            continue
        x = dot(cross(c, b), normal) / square
        y = dot(cross(a, c), normal) / square
        r = atan2(cos(hc) - x * cos(ha) - y * cos(hb), sin(hc) - x * sin(ha) - y * sin(hb)) % pi
        ka, kb, ab = cos(ha + r), cos(hb + r), dot(a, b)
        base = along(scale(a, (ka - kb * ab) / square), b, (kb - ka * ab) / square)
        rise = sqrt(max(0.0, (1.0 - dot(base, base)) / square))
        return [unit(along(base, normal, sign * rise), NORTH) for sign in (-1.0, 1.0)]
    return []


class Goal(NamedTuple):
    """Where the evader wants to be."""

    exists: bool
    place: Vec  # [m; NED]
    disc: float = 0.0  # radius about it that must be held as a whole [m]; 0: its middle (`goal_disc`)


NO_GOAL = Goal(False, NORTH)


def prospect(pursuer: Vehicle, cone: Cone, evader: Vehicle, heading: Vec, goal: Goal) -> Prospect:
    """What one pursuer can do against the evader's present heading and target."""
    meeting = intercept(evader.position, heading, evader.speed, pursuer.position, pursuer.speed)
    closing = dot(heading, Vec(
        pursuer.position.x - evader.position.x,
        pursuer.position.y - evader.position.y,
        pursuer.position.z - evader.position.z,
    ))
    meets = meeting.exists and (closing > 0.0 or pursuer.speed >= evader.speed)
    denies = goal.exists and in_time(
        goal.place, pursuer.position, pursuer.speed, evader.position, evader.speed, goal.disc
    )
    return Prospect(meets, meeting.time if meets else -1.0, denies, half_angle(cone))


def assess(
    evader: Vehicle, pursuers: tuple[Vehicle, ...], rho: float, goal: Goal, planar: bool
) -> Assessment:
    """The assessment of a situation; `rho` is the safety distance ρ of (4) [m]."""
    cones = blocked_cones(evader, pursuers, rho)
    heading = unit(evader.velocity, NORTH)
    prospects = tuple(
        prospect(p, cone, evader, heading, goal)
        for p, cone in zip(pursuers, cones, strict=True)
    )
    open_gaps = gaps(cones) if planar else ()
    cap = Cap(NORTH, 0.0) if planar else largest_free_cap(cones)
    return Assessment(
        not open_gaps if planar else cap.radius <= 0.0 and not any(is_free(c.axis, cones) for c in cones),
        open_gaps,
        max((gap.width for gap in open_gaps), default=0.0),
        cap,
        any(p.denies_target for p in prospects),
        prospects,
    )
