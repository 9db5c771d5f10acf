"""What an evader can reach before faster pursuers do: an intersection of Apollonius balls, and its extremes.

Point capture, simple motion, every pursuer faster than the evader. The ball of a pursuer holds the points
that the evader reaches first (Isaacs, Differential Games, 6.5); of several pursuers the balls' intersection
is left. What is best for the evader lies on it in closed form: on one ball, or on the circle of two (in the
plane their two corners), which is all there is for a linear aim in the plane, and for two pursuers in space.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from onboard.core.geometry.apollonius import Sphere, apollonius_sphere
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import TINY, Vec, along, distance, dot, norm, scale, sub, unit

INSIDE = 1e-7  # of a length: what still counts as inside a ball


class Corner(NamedTuple):
    """The circle that two balls share: in the plane, two points."""

    exists: bool
    centre: Vec  # [m]
    radius: float  # [m]
    axis: Vec  # unit vector along both balls' centres


def balls_of(evader: Vehicle, pursuers: tuple[Vehicle, ...]) -> tuple[Sphere, ...]:
    """Each pursuer's Apollonius ball around the evader; none of a pursuer that is not faster."""
    found = [apollonius_sphere(evader.position, evader.speed, p.position, p.speed)
             for p in pursuers if p.speed > evader.speed]  # fmt: skip
    return tuple(ball for ball in found if ball.exists)


def corner(a: Sphere, b: Sphere) -> Corner:
    """The circle in which two spheres meet."""
    line = sub(b.centre, a.centre)
    d = norm(line)
    if d <= TINY:
        return Corner(False, a.centre, 0.0, line)
    axis = scale(line, 1.0 / d)
    s = 0.5 * (d + (a.radius * a.radius - b.radius * b.radius) / d)
    square = a.radius * a.radius - s * s
    if square < 0.0:
        return Corner(False, a.centre, 0.0, axis)
    return Corner(True, along(a.centre, axis, s), sqrt(square), axis)


def within(point: Vec, balls: tuple[Sphere, ...]) -> bool:
    """Whether a point [m] lies in every ball."""
    return all(distance(point, ball.centre) <= ball.radius * (1.0 + INSIDE) + INSIDE for ball in balls)


def extremes(balls: tuple[Sphere, ...], ways: tuple[Vec, ...]) -> tuple[Vec, ...]:
    """Points of the intersection that may be the best for an aim with these gradients there (units).

    `ways` has one direction for each ball, in which the aim grows; corners take both ends across it.
    """
    found = [along(ball.centre, way, ball.radius) for ball, way in zip(balls, ways, strict=True)]
    for i in range(len(balls)):
        for j in range(i):
            circle = corner(balls[i], balls[j])
            if circle.exists:
                aside = unit(Vec(-circle.axis.y, circle.axis.x, 0.0), Vec(1.0, 0.0, 0.0))
                for way in (ways[i], ways[j]):
                    across = unit(along(way, circle.axis, -dot(way, circle.axis)), aside)
                    found += [along(circle.centre, across, k * circle.radius) for k in (1.0, -1.0)]
    return tuple(point for point in found if within(point, balls))


def lowest(balls: tuple[Sphere, ...], down: Vec, otherwise: Vec) -> Vec:
    """The point of the balls' intersection farthest along `down` (unit) [m].

    Border defence (Von Moll, Garcia, Casbeer, Suresh and Swar, J. Aerosp. Inf. Syst. 2020) in the plane, the
    half-space with two defenders (Yan, Shi and Zhong, arXiv 1904.01113) in space.
    """
    best, farthest = otherwise, -1e300
    for point in extremes(balls, (down,) * len(balls)):
        if dot(point, down) > farthest:
            best, farthest = point, dot(point, down)
    return best


def farthest_from(place: Vec, balls: tuple[Sphere, ...]) -> Vec:
    """The point of the balls' intersection farthest from a place in it [m], in the plane.

    Two cutters and a fugitive ship (Isaacs, 6.8; Weintraub, Pachter and Garcia, arXiv 2003.05013, section V):
    there the ship is caught, by one cutter or by both at once.
    """
    ways = tuple(unit(sub(ball.centre, place), Vec(1.0, 0.0, 0.0)) for ball in balls)
    best, farthest = place, -1.0
    for point in extremes(balls, ways):
        if distance(point, place) > farthest:
            best, farthest = point, distance(point, place)
    return best


def nearest_to(place: Vec, ball: Sphere) -> Vec:
    """The point of a ball's surface nearest to a place outside it [m]; from inside the same ray's.

    Guarding a convex target (Lee and Bakolas, arXiv 2104.00717 and 2109.07075): the defender meets the
    attacker there when the ball does not touch the target; for a disc or ball of radius ρ around `place` the
    value is |centre − place| − radius − ρ.
    """
    return along(ball.centre, unit(sub(place, ball.centre), Vec(1.0, 0.0, 0.0)), ball.radius)
