"""The evader's rules (3.4.1) and its tables in the knowledge base.

Readings that reproduce Table 1: the preferred ray without a target is the direction of F_res
(21); blocked cones keep the safety distance ρ of (4); weight λ / max(d − 2R, 1e-3).
"""

from __future__ import annotations

from math import sqrt

from onboard.core.game.views import EvaderView, heading_at
from onboard.core.geometry.cones import Ray
from onboard.core.geometry.free_ray import free_ray_limited, within
from onboard.core.math.each import new
from onboard.core.math.vectors import NORTH, TINY, Vec, along, distance, sub, unit
from onboard.core.strategy.knowledge import Decision, Module, Rule, RuleId, fold, silent


def resultant_force(view: EvaderView) -> Vec:
    """F_res: (21), or (22) where there is a target. Not normalised."""
    e = view.own.position
    x = 0.0
    y = 0.0
    z = 0.0
    for pursuer in view.pursuers:
        dx = e.x - pursuer.position.x
        dy = e.y - pursuer.position.y
        dz = e.z - pursuer.position.z
        d = sqrt(dx * dx + dy * dy + dz * dz)
        if d > TINY:
            weight = view.rules.lambda_ / max(d - 2.0 * view.rules.R, 1e-3) / d
            x += weight * dx
            y += weight * dy
            z += weight * dz
    if view.target.exists:
        gx = view.target.position.x - e.x
        gy = view.target.position.y - e.y
        gz = view.target.position.z - e.z
        d = sqrt(gx * gx + gy * gy + gz * gz)
        if d > TINY:
            weight = (view.rules.beta + 1.0 / d) / d
            x += weight * gx
            y += weight * gy
            z += weight * gz
    return new(Vec, (x, y, z))


def target_direction(view: EvaderView) -> Vec:
    """F_g: unit vector from e to g; the present heading when the evader is at the target."""
    return unit(sub(view.target.position, view.own.position), heading_at(view.own))


def _along_ray(view: EvaderView, ray: Ray, rule: RuleId, length: float) -> Decision:
    aim = along(view.own.position, ray.direction, length)
    speed = view.own.speed
    time = length / speed if speed > TINY else 0.0
    return new(Decision, (True, ray.direction, speed, rule, aim, time, 0.0))


def free_ray_to_target(view: EvaderView) -> Decision:
    """Rules 1–2 of 3.4.1: the free ray F_esc closest to F_g."""
    if not view.target.exists:
        return silent(NORTH, view.target.position)
    goal = target_direction(view)
    ray = free_ray_limited(goal, view.cones, view.limits, view.rules.planar)
    if not ray.exists:
        return silent(goal, view.target.position)
    length = distance(view.own.position, view.target.position)
    return _along_ray(view, ray, RuleId.FREE_RAY_TO_TARGET, length)


def free_ray_from_pursuers(view: EvaderView) -> Decision:
    """Rules 1–2 without a target: the free ray closest to the direction of F_res (21)."""
    if view.target.exists:
        return silent(NORTH, view.target.position)
    away = unit(resultant_force(view), heading_at(view.own))
    ray = free_ray_limited(away, view.cones, view.limits, view.rules.planar)
    if not ray.exists:
        return silent(away, view.target.position)
    return _along_ray(view, ray, RuleId.FREE_RAY_FROM_PURSUERS, view.own.speed)


def resultant(view: EvaderView) -> Decision:
    """Rule 3 of 3.4.1: no free ray, so along F_res of (21), or (22) with a target."""
    force = unit(resultant_force(view), heading_at(view.own))
    ray = new(Ray, (True, within(force, view.limits, view.rules.planar), 1.0))
    if view.target.exists:
        return _along_ray(view, ray, RuleId.RESULTANT_FORCE_TO_TARGET, view.own.speed)
    return _along_ray(view, ray, RuleId.RESULTANT_FORCE, view.own.speed)


def straight_to_target(view: EvaderView) -> Decision:
    """For comparison: straight at the target, whoever is in the way."""
    if not view.target.exists:
        return silent(heading_at(view.own), view.target.position)
    ray = new(Ray, (True, within(target_direction(view), view.limits, view.rules.planar), 1.0))
    return _along_ray(view, ray, RuleId.STRAIGHT_TO_TARGET, distance(view.own.position, view.target.position))


def straight_on(view: EvaderView) -> Decision:
    """For comparison: straight on."""
    ray = new(Ray, (True, within(heading_at(view.own), view.limits, view.rules.planar), 1.0))
    return _along_ray(view, ray, RuleId.STRAIGHT_ON, view.own.speed)


EVADER: tuple[Rule[EvaderView], ...] = (
    Rule(
        RuleId.FREE_RAY_TO_TARGET,
        "there is a target, and a ray that meets no Apollonius sphere",
        "the free ray closest to F_g",
        "3.4.1, rules 1–2",
        Module.GEOMETRIC,
        free_ray_to_target,
    ),
    Rule(
        RuleId.FREE_RAY_FROM_PURSUERS,
        "there is no target, but a ray that meets no Apollonius sphere",
        "the free ray closest to F_res (21)",
        "3.4.1, rules 1–2, second option of the game",
        Module.GEOMETRIC,
        free_ray_from_pursuers,
    ),
    Rule(
        RuleId.RESULTANT_FORCE,
        "every ray is blocked",
        "along F_res: (21) without a target, (22) with one",
        "3.4.1, rule 3",
        Module.INTELLIGENT,
        resultant,
    ),
)

STRAIGHT: tuple[Rule[EvaderView], ...] = (
    Rule(
        RuleId.STRAIGHT_TO_TARGET,
        "there is a target",
        "straight at it",
        "for comparison",
        Module.GEOMETRIC,
        straight_to_target,
    ),
    Rule(RuleId.STRAIGHT_ON, "always", "straight on", "for comparison", Module.GEOMETRIC, straight_on),
)

evader = fold(EVADER)
straight = fold(STRAIGHT)
