"""Separation from team mates.

Who can stop gives way where it closes in too fast to stop in time, each half of it. A plane cannot stop: it
gives way where it will pass too near, as early as its turn takes, the higher id alone while there is time.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.math.states import Mate
from onboard.core.math.vectors import TINY, Vec
from onboard.core.safety.envelope import believable
from onboard.core.safety.fence import stopping_speed
from onboard.core.safety.policy import Policy

EARLY = 1.6  # times the turn that it takes: so much earlier a plane gives way
BESIDE = 0.3  # sine of the angle from its course at which the mate's place counts as beside it
FIRM = 1.0  # of its speed across that a plane asks for at least when it gives way


class Separated(NamedTuple):
    """The velocity that keeps apart, and whether that changed it."""

    velocity: Vec  # [m/s; ground]
    changed: bool


def keep_apart(v: Vec, position: Vec, own_id: int, mates: tuple[Mate, ...], policy: Policy) -> Separated:
    """The velocity with its closing parts bounded by what still stops at the separation distance.

    Of an excess each of two vehicles takes half, and one whose mate has gone quiet takes it all and doubles
    the distance. Inside the distance both move apart; where they are level, the lower id goes up. Planes
    outside the distance `pass_clear`.
    """
    changed = False
    e = policy.envelope
    for mate in mates:
        if mate.id == own_id or not mate.age <= policy.mate_forget:
            continue
        if not believable(mate.position, mate.velocity):
            continue
        quiet = mate.age > policy.mate_age
        keep = policy.separation * (2.0 if quiet else 1.0)
        x = mate.position.x - position.x
        y = mate.position.y - position.y
        z = mate.position.z - position.z
        d = sqrt(x * x + y * y + z * z)
        if d > 1e6:
            continue
        if d <= TINY:
            x, y, z, d = 0.0, 0.0, (1.0 if own_id < mate.id else -1.0), 1.0
        if d > keep and not e.hovers:
            way = pass_clear(v, Vec(x, y, z), mate, own_id, keep, quiet, policy)
            v = way.velocity
            changed = changed or way.changed
            continue
        ux, uy, uz = x / d, y / d, z / d
        closing = (v.x - mate.velocity.x) * ux + (v.y - mate.velocity.y) * uy + (v.z - mate.velocity.z) * uz
        if d > keep:
            most = stopping_speed(d - keep, e.deceleration, policy.reaction)
        else:
            most = -min(0.5 * e.speed_max, 0.5 + 0.5 * (keep - d))
        excess = closing - most
        if excess <= 1e-6:
            continue
        changed = True
        share = excess if quiet else 0.5 * excess
        v = Vec(v.x - share * ux, v.y - share * uy, v.z - share * uz)
        if d < keep and abs(z) < 0.5 * keep:
            rise = e.climb_max if own_id < mate.id else -e.sink_max
            v = Vec(v.x, v.y, -rise)
    return Separated(v, changed)


def pass_clear(  # noqa: PLR0913  (compiled code takes no bundles)
    v: Vec, line: Vec, mate: Mate, own_id: int, keep: float, quiet: bool, policy: Policy
) -> Separated:
    """The velocity with which a plane passes a mate at the distance `keep` [m] or farther.

    `line` leads from the own place to the mate's [m]. Both are taken to fly on straight. What the distance
    lacks when they are nearest is won by speed across, away from where the mate will be then; where that is
    ahead or behind, away from where it is; head on to the right. A turn wins ½ a t² across, a = v ω; nothing
    is changed while there is EARLY times as long to go. The higher id gives way alone as long as it can do so
    in time, else both do.
    """
    e = policy.envelope
    wx = mate.velocity.x - v.x
    wy = mate.velocity.y - v.y
    wz = mate.velocity.z - v.z
    square = wx * wx + wy * wy + wz * wz
    away = -(line.x * wx + line.y * wy + line.z * wz)
    if square <= TINY or away <= 0.0:
        return Separated(v, False)
    time = away / square
    cx = line.x + wx * time
    cy = line.y + wy * time
    cz = line.z + wz * time
    miss = sqrt(cx * cx + cy * cy + cz * cz)
    lacks = keep - miss
    if lacks <= 0.0:
        return Separated(v, False)
    across = max(e.speed_max * min(e.turn_rate, e.speed_max / max(e.turn_radius, 1.0)), 0.1)  # a [m/s²]
    alone = EARLY * (policy.reaction + sqrt(2.0 * lacks / across))
    both = EARLY * (policy.reaction + sqrt(lacks / across))
    mine = quiet or own_id > mate.id
    if time > (alone if mine else both):
        return Separated(v, False)
    level = max(sqrt(v.x * v.x + v.y * v.y), TINY)
    nx, ny = -v.y / level, v.x / level  # to the right
    beside = (cx * nx + cy * ny) / max(miss, TINY) if miss > 1e-3 * keep else 0.0
    if abs(beside) < BESIDE:
        beside = (line.x * nx + line.y * ny) / max(sqrt(line.x * line.x + line.y * line.y), TINY)
    side = 1.0 if beside <= 1e-3 else -1.0
    speed = max(lacks / max(time, 0.1), FIRM * e.speed_max)
    return Separated(Vec(v.x + side * speed * nx, v.y + side * speed * ny, v.z), True)
