"""The arena of the classical problems: who decides, how everybody moves, when it ends.

A problem has its own motion and its own end; both sides are functions from the scene to velocities, so that
a strategy of ours and the optimal play can take either side.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, inf, pi, sin
from typing import NamedTuple

from onboard.core.game.advance import (
    Conditions,
    Game,
    PursuerStrategy,
    decide_pursuers,
    positions,
    still_view,
)
from onboard.core.game.referee import passage
from onboard.core.game.views import NOTHING_HELD, Nearest, Team, heading_at, pursuer_view, sighted, told
from onboard.core.math.angles import wrap
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import ZERO, Vec, along, clamp, norm, scale, yaw_of
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Plan, Situation, nearest_staged
from onboard.core.strategy.team.planner import Planner, no_plan, plan
from onboard.core.strategy.team.planners import planner_for
from onboard.game.plugins import evader_strategy, pursuer_strategy

PLANS_EVERY = 0.5  # [s]


class Scene(NamedTuple):
    """A classical game at one instant."""

    game: Game
    conditions: Conditions  # the target is what both sides are shown of it now
    home: Vec = ZERO  # the target of the file: a set's centre, a border's point [m]
    flag: bool = False  # whether the attacker has the flag
    ward: Vehicle | None = None  # whom the defender protects
    seen: float = inf  # what the problem carries on from step to step: the nearest pass, the most at once
    wanted: float = 0.0  # k of k-capture: how many must be at the evader at once

    @property
    def evader(self) -> Vehicle:
        """The evader, attacker or intruder."""
        return self.game.evader

    @property
    def pursuers(self) -> tuple[Vehicle, ...]:
        """The pursuers or defenders."""
        return self.game.pursuers


Evader = Callable[[Scene], Vec]  # its velocity [m/s]
Pursuers = Callable[[Scene], tuple[Vec, ...]]  # theirs; the evader's new velocity is in the scene
Mover = Callable[[Scene, Vec, tuple[Vec, ...]], Scene]


class End(NamedTuple):
    """How a game ended."""

    payoff: float  # in the problem's unit
    time: float  # [s]
    won: bool  # by the pursuers


class Played(NamedTuple):
    """A game with its path."""

    end: End
    path: tuple[Scene, ...]


def theirs(name: str) -> Callable[[], Evader]:
    """The evader by a strategy of ours. Raises ConfigError for an unknown name."""
    decide = evader_strategy(name)

    def fly(scene: Scene) -> Vec:
        decision = decide(still_view(scene.game, scene.conditions))
        return scale(decision.direction, decision.speed)

    return lambda: fly


def ours(name: str) -> Callable[[], Pursuers]:
    """All pursuers by a strategy of ours; `team` with a plan of its own. Raises ConfigError."""
    decide = pursuer_strategy(name)

    def fly(scene: Scene) -> tuple[Vec, ...]:
        game, conditions = scene.game, scene.conditions
        seen = sighted(game.evader, heading_at(game.evader), conditions.control.lookahead)
        return tuple(scale(d.direction, d.speed) for d in decide_pursuers(game, seen, conditions, decide))

    planner = planner_for(decide)
    return (lambda: fly) if planner is None else lambda: Planned(decide, planner)


class Planned:
    """Pursuers who fly the team's plan, made anew twice a second and heard at once by all."""

    def __init__(self, decide: PursuerStrategy, planner: Planner) -> None:
        self.decide = decide
        self.planner = planner
        self.plan: Plan | None = None
        self.made = -inf

    def __call__(self, scene: Scene) -> tuple[Vec, ...]:
        """Their velocities [m/s]."""
        game, conditions = scene.game, scene.conditions
        target = told(conditions.target, conditions.rules)
        if game.time >= self.made + PLANS_EVERY - 1e-9 or self.plan is None:
            pairs = zip(game.pursuers, game.pursuer_limits, strict=True)
            members = tuple(Member(p, limits, True) for p, limits in pairs)
            now = Situation(
                game.time, 0.0, game.evader, game.evader_limits, members, target, ZERO, conditions.rules,
                Heights(), Margin(), game.evader.position, nearest_staged(conditions.rules),
            )  # fmt: skip
            before = self.plan or no_plan(members, game.time)
            self.plan, self.made = plan(now, before, self.planner), game.time
        seen = sighted(game.evader, heading_at(game.evader), conditions.control.lookahead)
        velocities = []
        for index, own in enumerate(game.pursuers):
            team = Team(Nearest(False, own.position), game.pursuers, index, target, NOTHING_HELD,
                        self.plan.assignments[index])  # fmt: skip
            view = pursuer_view(own, game.pursuer_limits[index], seen, team, conditions.control,
                                conditions.rules)  # fmt: skip
            decision = self.decide(view)
            velocities.append(scale(decision.direction, decision.speed))
        return tuple(velocities)


class Aside(NamedTuple):
    """How a player leaves a way of playing for a while at the start, to see what the other makes of it."""

    angle: float  # by which its velocity is turned, right positive [rad]
    until: float  # [s]


ASIDES = (Aside(0.6, 4.0), Aside(-0.6, 4.0), Aside(1.5, 2.0), Aside(-1.5, 2.0))


def turned(v: Vec, angle: float) -> Vec:
    """A velocity turned to the right [rad] in the horizontal plane."""
    return Vec(v.x * cos(angle) - v.y * sin(angle), v.x * sin(angle) + v.y * cos(angle), v.z)


def evader_aside(plays: Evader, aside: Aside) -> Evader:
    """The same evader, led aside at first."""

    def fly(scene: Scene) -> Vec:
        return turned(plays(scene), aside.angle) if scene.game.time < aside.until else plays(scene)

    return fly


def pursuers_aside(plays: Pursuers, aside: Aside) -> Pursuers:
    """The same pursuers, led aside at first."""

    def fly(scene: Scene) -> tuple[Vec, ...]:
        wishes = plays(scene)
        if scene.game.time >= aside.until:
            return wishes
        return tuple(turned(wish, aside.angle) for wish in wishes)

    return fly


def held_to(velocity: Vec, speed: float) -> Vec:
    """A velocity no faster than `speed` [m/s]."""
    fast = norm(velocity)
    return velocity if fast <= speed else scale(velocity, speed / fast)


def simple_motion(scene: Scene, evader: Vec, pursuers: tuple[Vec, ...]) -> Scene:
    """Everybody flies its velocity for a step, no faster than it can."""
    dt = scene.conditions.control.dt

    def moved(one: Vehicle, velocity: Vec) -> Vehicle:
        velocity = held_to(velocity, one.speed)
        return one._replace(position=along(one.position, velocity, dt), velocity=velocity)

    team = tuple(moved(one, v) for one, v in zip(scene.pursuers, pursuers, strict=True))
    game = scene.game._replace(time=scene.game.time + dt, evader=moved(scene.evader, evader), pursuers=team)
    return scene._replace(game=game)


def driven(one: Vehicle, wish: Vec, rate: float, dt: float) -> Vehicle:
    """A car after a step at its speed: on the arc that turns to a wished course as far as it can."""
    course = yaw_of(one.velocity)
    turn = wrap(yaw_of(wish) - course) if norm(wish) > 0.0 else 0.0
    turn = clamp(turn, -rate * dt, rate * dt)
    chord = one.speed * dt * (sin(0.5 * turn) / (0.5 * turn) if abs(turn) > 1e-9 else 1.0)
    middle, after = course + 0.5 * turn, course + turn
    place = along(one.position, Vec(cos(middle), sin(middle), 0.0), chord)
    return one._replace(position=place, velocity=Vec(one.speed * cos(after), one.speed * sin(after), 0.0))


def cars(agile: bool) -> Mover:
    """Motion of pursuers that are cars; the evader turns at once where it is `agile`, else as a car."""

    def move(scene: Scene, evader: Vec, pursuers: tuple[Vec, ...]) -> Scene:
        game, dt = scene.game, scene.conditions.control.dt
        team = tuple(driven(one, v, limits.turn_rate, dt) for one, v, limits in
                     zip(game.pursuers, pursuers, game.pursuer_limits, strict=True))  # fmt: skip
        own = driven(game.evader, evader, pi / dt if agile else game.evader_limits.turn_rate, dt)
        return scene._replace(game=game._replace(time=game.time + dt, evader=own, pursuers=team))

    return move


class Touch(NamedTuple):
    """The first contact within a step."""

    share: float  # of the step, 0 … 1; 2 = none
    evader: Vec  # where the evader is then [m]
    smallest: float  # distance of any pursuer within the step [m]


def touch(before: Scene, after: Scene) -> Touch:
    """Whether a pursuer comes within R of the evader in a step, and where that is."""
    share, smallest = 2.0, inf
    a, b = before.evader.position, after.evader.position
    for p, q in zip(positions(before.pursuers), positions(after.pursuers), strict=True):
        seen = passage(p, q, a, b, before.conditions.rules.R)
        smallest = min(smallest, seen.smallest)
        if seen.enters:
            share = min(share, seen.entry)
    part = min(share, 1.0)
    return Touch(share, Vec(*(m + (n - m) * part for m, n in zip(a, b, strict=True))), smallest)
