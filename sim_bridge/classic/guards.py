"""Problems of defence: a disc, a border in the plane and in space, by faster defenders."""

from __future__ import annotations

from collections.abc import Callable

from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import DOWN, NORTH, Vec, along, distance, dot, scale, sub, unit
from sim_bridge.classic.play import End, Scene, touch
from sim_bridge.classic.problem import Problem, aimed_at
from sim_bridge.classic.values.regions import balls_of, lowest, nearest_to

GIVES_GROUND = (
    "pure pursuit gives ground; a faster pursuer blocks every heading, so that 'paper' and 'evasive' flee"
    " and never attack"
)
Short = Callable[[Scene, Vec], float]  # how far a place is short of what is guarded [m]
SOUTH = Vec(-1.0, 0.0, 0.0)
DEFENDERS = ("paper", "parallel-pursuit", "goalkeeper", "blocking-line", "team", "pure-pursuit")
BEYOND_ZERO = 2.0  # capture radii: a value nearer to zero says neither side's game, as it is played


def to_place(one: Vehicle, place: Vec) -> Vec:
    """The velocity straight to a place [m/s]."""
    return scale(unit(sub(place, one.position), unit(one.velocity, NORTH)), one.speed)


def all_to(scene: Scene, place: Vec) -> tuple[Vec, ...]:
    """Velocities of all pursuers straight to a place [m/s]."""
    return tuple(to_place(p, place) for p in scene.pursuers)


def kept(_start: Scene, payoff: float) -> bool:
    """Whether the defenders keep what they guard."""
    return payoff > 0.0


def is_clear(value: float, scene: Scene) -> bool:
    """Whether a value is the game of one side with a capture radius that is not zero."""
    return abs(value) > BEYOND_ZERO * scene.conditions.rules.R


def ends_short(short: Short) -> Callable[[Scene, Scene], End | None]:
    """Capture short of what is guarded, or arrival: the payoff is how far short [m], 0 there."""

    def end(before: Scene, after: Scene) -> End | None:
        seen, dt = touch(before, after), before.conditions.control.dt
        if seen.share <= 1.0 and short(before, seen.evader) > 0.0:
            return End(short(before, seen.evader), before.game.time + seen.share * dt, True)
        return End(0.0, after.game.time, False) if short(after, after.evader.position) <= 0.0 else None

    return end


def late_short(short: Short) -> Callable[[Scene], End]:
    """At the horizon it is kept: the payoff is how far short the attacker is then [m]."""
    return lambda scene: End(short(scene, scene.evader.position), scene.game.time, True)


# ---------------------------------------------------------------- guarding a convex target


def short_of_disc(scene: Scene, place: Vec) -> float:
    """From a place to the target's edge [m]; negative within it."""
    return distance(place, scene.home) - scene.conditions.rules.epsilon_min


def _disc_point(scene: Scene) -> Vec:
    return nearest_to(scene.home, balls_of(scene.evader, scene.pursuers)[0])


def _disc_value(scene: Scene) -> float:
    ball = balls_of(scene.evader, scene.pursuers)[0]
    return short_of_disc(scene, ball.centre) - ball.radius


CONVEX = Problem(
    "convex-target", "Guarding a convex target",
    "A faster defender meets an attacker as far from a disc as it can.",
    "Isaacs 1965, 1.9; Lee and Bakolas, arXiv 2104.00717 and 2109.07075",
    "distance from the target at capture", "m", +1,
    _disc_value, kept, lambda s: to_place(s.evader, _disc_point(s)), lambda s: all_to(s, _disc_point(s)),
    ends_short(short_of_disc), late_short(short_of_disc),
    GIVES_GROUND,
    admits=lambda s: is_clear(_disc_value(s), s) and short_of_disc(s, s.evader.position) > 0.0,
    floor=0.0, chasers=DEFENDERS,
)  # fmt: skip


# ---------------------------------------------------------------- half-space and border


def down_of(scene: Scene) -> Vec:
    """Towards the border: down in space, south in the plane (unit)."""
    return SOUTH if scene.conditions.rules.planar else DOWN


def border(scene: Scene) -> float:
    """How far along `down_of` the border lies from the frame's origin [m]."""
    edge = along(scene.home, down_of(scene), -scene.conditions.rules.epsilon_min)
    return dot(edge, down_of(scene))


def above(scene: Scene, place: Vec) -> float:
    """How far short of the border a place is [m]."""
    return border(scene) - dot(place, down_of(scene))


def _foot(scene: Scene) -> Scene:
    """Both sides are shown the border's point nearest to the attacker."""
    place = scene.evader.position
    return aimed_at(scene, along(place, down_of(scene), above(scene, place)))


def lowest_point(scene: Scene) -> Vec:
    """Where the evader comes farthest towards the border, if it is met there [m]."""
    place = scene.evader.position
    return lowest(balls_of(scene.evader, scene.pursuers), down_of(scene), place)


def _border_value(scene: Scene) -> float:
    return above(scene, lowest_point(scene))


HALF_SPACE = Problem(
    "half-space", "Half-space with two defenders, in space",
    "Two faster defenders meet an attacker as high above the ground as they can.",
    "Yan, Shi and Zhong, arXiv 1904.01113",
    "height above the ground at capture", "m", +1,
    _border_value, kept, lambda s: to_place(s.evader, lowest_point(s)), lambda s: all_to(s, lowest_point(s)),
    ends_short(above), late_short(above),
    GIVES_GROUND,
    "its target is a plane, and `bench` plays games in space with aircraft, not in simple motion",
    shown=_foot, admits=lambda s: is_clear(_border_value(s), s), floor=0.0, teams=(1, 2), chasers=DEFENDERS,
)  # fmt: skip

BORDER = HALF_SPACE._replace(
    name="border-defence", title="Border defence with many pursuers",
    rule="Several faster pursuers meet an evader as far from a border as they can.",
    reference="Von Moll, Garcia, Casbeer, Suresh and Swar, J. Aerosp. Inf. Syst. 2020",
    payoff="distance from the border at capture",
    why=GIVES_GROUND,
    left_out="", teams=(1, 20),
)  # fmt: skip
