"""Separation from team mates.

Who can stop gives way where it closes in too fast to stop in time, each half of it. A plane cannot stop: see
`passing`.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.math.each import new
from onboard.core.math.states import Mate
from onboard.core.math.vectors import TINY, Vec
from onboard.core.safety.braking import stopping_speed
from onboard.core.safety.envelope import believable
from onboard.core.safety.passing import Moved, anybody, met, pass_clear, turning
from onboard.core.safety.policy import Policy

SLACK = 0.15  # of the distance, kept besides by who hovers
DRIFT = 0.5  # [m/s] by which gusts push two together until they answer


class Separated(NamedTuple):
    """The velocity that keeps apart, and whether that changed it."""

    velocity: Vec  # [m/s; ground]
    changed: bool


def kept_apart(
    v: Vec, position: Vec, velocity: Vec, own_id: int, mates: tuple[Mate, ...], policy: Policy
) -> Separated:
    """What becomes of `v` [m/s; ground] so that a vehicle that flies at `velocity` keeps apart."""
    if policy.envelope.hovers:
        return keep_apart(v, position, own_id, mates, policy)
    near = met(position, own_id, mates, policy)
    if not anybody(near):
        return new(Separated, (v, False))
    moving = velocity if velocity.x * velocity.x + velocity.y * velocity.y > 1.0 else v
    now = new(Moved, (moving, turning(policy.envelope), policy.reaction))
    found = pass_clear(v, now, position, near, policy)
    return new(Separated, (found, found.x != v.x or found.y != v.y or found.z != v.z))


def keep_apart(v: Vec, position: Vec, own_id: int, mates: tuple[Mate, ...], policy: Policy) -> Separated:
    """The velocity with its closing parts bounded by what still stops at the separation distance.

    Of an excess each of two vehicles takes half, and one whose mate has gone quiet takes it all and doubles
    the distance. Inside the distance both move apart, the higher one up; where they are level, the lower id.
    The distance is the separation and what lag and gusts take of it.
    """
    changed = False
    e = policy.envelope
    for mate in mates:
        if mate.id == own_id or not mate.age <= policy.mate_forget:
            continue
        if not believable(mate.position, mate.velocity):
            continue
        quiet = mate.age > policy.mate_age
        keep = policy.separation * (2.0 if quiet else 1.0) * (1.0 + SLACK) + DRIFT * policy.reaction
        x = mate.position.x - position.x
        y = mate.position.y - position.y
        z = mate.position.z - position.z
        d = sqrt(x * x + y * y + z * z)
        if d > 1e6:
            continue
        if d <= TINY:
            x, y, z, d = 0.0, 0.0, (1.0 if own_id < mate.id else -1.0), 1.0
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
        v = new(Vec, (v.x - share * ux, v.y - share * uy, v.z - share * uz))
        if d < keep and abs(z) < 0.5 * keep:
            up = z > 0.0 if abs(z) > 0.05 * keep else own_id < mate.id
            rise = e.climb_max if up else -e.sink_max
            v = new(Vec, (v.x, v.y, -rise))
    return new(Separated, (v, changed))
