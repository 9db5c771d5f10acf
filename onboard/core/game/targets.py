"""Which of its targets an evader goes for: the one it reaches soonest by a free ray. Kernel style."""

from __future__ import annotations

from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.geometry.cones import Cone
from onboard.core.geometry.free_ray import free_ray_limited
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, TINY, norm, sub, unit

NONE = -1  # in place of a number: no target
KEEP = 0.8  # another target is gone for where it is reached in less than this share of the time
SLOWEST = 0.1  # least share of the speed that counts as towards the target, however far aside the free ray


def time_to(
    own: Vehicle, limits: VehicleLimits, cones: tuple[Cone, ...], target: Target, planar: bool
) -> float:
    """How long an evader takes to a target [s], as fast as the free ray nearest to it brings it nearer.

    `cones` are what the pursuers block, and `target` [m; NED] is where it is met in the air the cones are in.
    Where no ray is free it is the time of the straight way: that is so for all targets alike.
    """
    line = sub(target.position, own.position)
    straight = norm(line) / max(own.speed, TINY)
    ray = free_ray_limited(unit(line, NORTH), cones, limits, planar)
    if not ray.exists:
        return straight
    return straight / max(ray.closeness, SLOWEST)


def chosen(
    own: Vehicle,
    limits: VehicleLimits,
    cones: tuple[Cone, ...],
    targets: tuple[Target, ...],
    planar: bool,
    before: int,
) -> int:
    """The number of the target that an evader goes for, NONE where it has none.

    `before` is the one that it goes for now (NONE: none yet), which it leaves for a clearly sooner one only.
    """
    if len(targets) == 1:
        return 0 if targets[0].exists else NONE
    best = NONE
    least = 1e300
    for k in range(len(targets)):
        if targets[k].exists:
            time = time_to(own, limits, cones, targets[k], planar)
            if k == before:
                time *= KEEP
            if time < least:
                least = time
                best = k
    return best


def at(targets: tuple[Target, ...], number: int) -> Target:
    """A target by its number, NO_TARGET for NONE."""
    if number < 0:
        return NO_TARGET
    return targets[number]
