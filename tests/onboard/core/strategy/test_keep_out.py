"""Every strategy keeps out of zones: random fields, craft that turn no faster than they may, wind."""

from __future__ import annotations

from math import atan2, cos, hypot, radians, sin

import numpy as np
import pytest

from onboard.core.game.advance import Conditions, advance, begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.game.views import (
    NOTHING_HELD,
    Nearest,
    Team,
    evader_view,
    pursuer_view,
    sighted,
    with_limits,
)
from onboard.core.geometry.zones import Prism, Zones, least_clearance, zones_of
from onboard.core.math.angles import wrap
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import (
    NORTH,
    ZERO,
    Vec,
    add,
    along,
    clamp,
    direction,
    distance,
    scale,
    unit,
)
from onboard.core.strategy.keep_out import CLEARANCE, evader_keeps_out, margin_of, pursuer_keeps_out
from onboard.core.strategy.knowledge import RuleId
from onboard.core.strategy.registry import EVADERS, PURSUERS
from tests.onboard.core.geometry.test_zones import hull

DT = 0.2
PLANE = VehicleLimits(speed_min=12.0, pitch_min=-0.3, pitch_max=0.3, turn_rate=radians(25.0))
COPTER = VehicleLimits()


def field(seed: int, apart: float) -> Zones:
    """One to three zones that lie apart, about (250, 0) … (850, 0)."""
    rng = np.random.default_rng(seed)
    prisms = [
        Prism(hull(rng, (250.0 + (200.0 + apart) * k, float(rng.uniform(-80, 80))), 30.0), 0.0, 120.0)
        for k in range(int(rng.integers(1, 4)))
    ]
    return zones_of(prisms)


def steered(own: Vehicle, wanted: Vec, limits: VehicleLimits) -> Vehicle:
    """The vehicle after a step: its course turns no faster than it may."""
    velocity = scale(wanted, own.speed)
    if limits.turn_rate > 0.0:
        course = atan2(own.velocity.y, own.velocity.x)
        most = limits.turn_rate * DT
        course += clamp(wrap(atan2(wanted.y, wanted.x) - course), -most, most)
        level = hypot(velocity.x, velocity.y)
        velocity = Vec(level * cos(course), level * sin(course), velocity.z)
    return Vehicle(own.position, velocity, own.speed)


class Games:
    """Games over random fields, stepped here: the least clearance of everybody on the way."""

    def __init__(self, limits: VehicleLimits, wind: Vec, planar: bool) -> None:
        self.limits, self.wind, self.planar = limits, wind, planar
        self.least = 1e9
        self.rules: set[RuleId] = set()
        self.arrived = 0

    def play(self, seed: int, evade: str, pursue: str, steps: int = 350) -> None:
        """One game of two pursuers."""
        rng = np.random.default_rng(seed)
        zones = field(seed, 0.0 if self.limits == COPTER else 200.0)
        rules = Rules(2.0, 4.0, planar=self.planar, zones=zones)
        up = -50.0 if not self.planar else 0.0
        target = Target(True, Vec(1300.0, float(rng.uniform(-100, 100)), up))
        own = Vehicle(Vec(0.0, float(rng.uniform(-100, 100)), up), Vec(15.0, 0.0, 0.0), 15.0)
        team = [
            Vehicle(Vec(1250.0, float(rng.uniform(-400, 400)), up), Vec(-13.0, 0.0, 0.0), 13.0) for _ in "ab"
        ]
        for _ in range(steps):
            view = evader_view(own, self.limits, tuple(team), target, self.wind, rules)
            view = with_limits(view, (self.limits,) * 2)
            decided = evader_keeps_out(view, EVADERS[evade].decide(view))
            self.rules.add(decided.rule)
            flown = [steered(own, decided.direction, self.limits)]
            sighting = sighted(own, unit(own.velocity, NORTH), 1.0)
            for index, one in enumerate(team):
                mate = Nearest(False, one.position)
                mine = Team(mate, tuple(team), index, target, NOTHING_HELD, wind=self.wind)
                seen = pursuer_view(one, self.limits, sighting, mine, Control(DT), rules)
                answer = pursuer_keeps_out(seen, PURSUERS[pursue].decide(seen))
                self.rules.add(answer.rule)
                flown.append(steered(one, answer.direction, self.limits)._replace(speed=one.speed))
            moved = [
                one._replace(position=along(one.position, add(one.velocity, self.wind), DT)) for one in flown
            ]
            own, *team = moved
            near = min(least_clearance(zones, one.position, self.planar) for one in moved)
            self.least = min(self.least, near)
            if distance(own.position, target.position) < 10.0:
                self.arrived += 1
                return


@pytest.mark.parametrize("evade", EVADERS)
def test_no_evader_and_no_pursuer_enters_a_zone(evade: str) -> None:
    pursuers = sorted(PURSUERS)
    for limits, wind, planar in (
        (COPTER, ZERO, True),
        (PLANE, ZERO, True),
        (PLANE, Vec(3.0, -4.0, 0.0), True),
        (PLANE, Vec(-4.0, 3.0, 0.0), False),
    ):
        games = Games(limits, wind, planar)
        number = 3 * list(EVADERS).index(evade) + int(planar)
        games.play(number, evade, pursuers[number % len(pursuers)])
        assert games.least >= 0.0, (limits, wind, planar)


@pytest.mark.parametrize("pursue", PURSUERS)
def test_no_pursuer_enters_a_zone(pursue: str) -> None:
    games = Games(PLANE if list(PURSUERS).index(pursue) % 2 else COPTER, ZERO, True)
    for seed in (20, 21):
        games.play(seed, "straight", pursue, 250)
    assert games.least >= 0.0
    assert RuleId.ROUND_ZONE in games.rules


def test_without_pursuers_near_the_target_is_always_reached() -> None:
    for limits in (COPTER, PLANE):
        games = Games(limits, ZERO, True)
        for seed in range(40, 46):
            games.play(seed, "straight", "pure-pursuit", 700)
        assert games.arrived == 6
        assert games.least >= 0.0


def test_behind_a_wall_the_evader_flies_the_tangent_path() -> None:
    """A wall across the way: the length flown is that of the two tangents and the wall's end between them."""
    a, w, t, far = 300.0, 80.0, 10.0, 500.0
    wall = Prism(((a, -w), (a + t, -w), (a + t, w + 20.0), (a, w + 20.0)))
    rules = Rules(1.0, 2.0, epsilon_min=0.5, planar=True, horizon=200.0, zones=zones_of([wall]))
    v, dt = 10.0, 0.01
    evader = Vehicle(ZERO, Vec(v, 0.0, 0.0), v)
    outcast = Vehicle(Vec(-5000.0, 0.0, 0.0), ZERO, 1.0)  # far behind: it blocks nothing that matters
    target = Target(True, Vec(far, 0.0, 0.0))
    game = begin(evader, (outcast,), VehicleLimits(), (VehicleLimits(),))
    conditions = Conditions(rules, target, Control(dt))
    decide = EVADERS["paper"].decide, PURSUERS["paper"].decide
    while game.score.verdict == GameResult.RUNNING:
        game = advance(game, conditions, *decide)
    assert game.score.verdict == GameResult.ARRIVED
    beside = w + CLEARANCE  # the wall grown by what is kept to it
    length = (
        hypot(a - CLEARANCE, beside) + t + 2.0 * CLEARANCE + hypot(far - a - t - CLEARANCE, beside)
    )
    assert game.score.time * v == pytest.approx(length - rules.epsilon_min, rel=1e-3)


def test_the_evader_goes_for_a_target_before_the_wall() -> None:
    wall = zones_of([Prism(((101.0, -80.0), (110.0, -80.0), (110.0, 80.0), (101.0, 80.0)))])
    rules = Rules(1.0, 2.0, planar=True, zones=wall)
    own = Vehicle(ZERO, Vec(10.0, 0.0, 0.0), 10.0)
    view = evader_view(own, PLANE, (), Target(True, Vec(100.0, 0.0, 0.0)), ZERO, rules)
    decided = evader_keeps_out(view, EVADERS["straight"].decide(view))
    assert (decided.direction, decided.rule) == (NORTH, RuleId.STRAIGHT_TO_TARGET)


def test_a_free_ray_among_cones_and_zones_is_the_nearest_to_the_way_round() -> None:
    """A pursuer blocks the near side of a wall: the evader takes the far one, and says so."""
    wall = zones_of([Prism(((200.0, -60.0), (210.0, -60.0), (210.0, 50.0), (200.0, 50.0)))])
    rules = Rules(2.0, 4.0, planar=True, zones=wall)
    own = Vehicle(ZERO, Vec(10.0, 0.0, 0.0), 10.0)
    target = Target(True, Vec(400.0, 0.0, 0.0))
    alone = evader_view(own, COPTER, (Vehicle(Vec(-900.0, 0.0, 0.0), ZERO, 5.0),), target, ZERO, rules)
    free = evader_keeps_out(alone, EVADERS["paper"].decide(alone))
    assert free.direction.y / free.direction.x == pytest.approx(56.0 / 194.0, rel=1e-9)
    guard = Vehicle(Vec(120.0, 70.0, 0.0), ZERO, 4.0)
    met = evader_view(own, COPTER, (guard,), target, ZERO, rules)
    turned = evader_keeps_out(met, EVADERS["paper"].decide(met))
    assert turned.rule == RuleId.ROUND_ZONE
    assert turned.direction.y / turned.direction.x == pytest.approx(-66.0 / 194.0, rel=1e-9)


def test_pressed_against_a_wall_rule_3_does_not_lead_into_it() -> None:
    """Every ray is blocked: along F_res, but not through the wall behind."""
    wall = zones_of([Prism(((-30.0, -400.0), (-10.0, -400.0), (-10.0, 400.0), (-30.0, 400.0)))])
    rules = Rules(2.0, 4.0, planar=True, zones=wall)
    own = Vehicle(ZERO, Vec(10.0, 0.0, 0.0), 10.0)
    team = tuple(Vehicle(Vec(60.0, y, 0.0), ZERO, 9.9) for y in (-40.0, 10.0, 45.0))
    view = evader_view(own, COPTER, team, Target(False, ZERO), ZERO, rules)
    bare = EVADERS["paper"].decide(view)
    assert bare.direction.x < -0.5, "away from them is into the wall"
    kept = evader_keeps_out(view, bare)
    assert kept.direction.x >= -CLEARANCE / 10.0 - 0.9
    reach = 4.0 / max(1e-9, -kept.direction.x)
    assert along(ZERO, kept.direction, min(reach, 300.0)).x >= -10.0 + CLEARANCE - 2.1


def test_where_pursuers_and_zones_block_every_ray_rule_3_speaks() -> None:
    """Pursuers leave rays into the wall alone: along F_res beside it, not along the ray that is blocked."""
    wall = zones_of([Prism(((-30.0, -400.0), (-10.0, -400.0), (-10.0, 400.0), (-30.0, 400.0)))])
    rules = Rules(2.0, 4.0, planar=True, zones=wall)
    own = Vehicle(ZERO, Vec(-10.0, 0.0, 0.0), 10.0)
    places = ((60.0, 0.0), (60.0, radians(-100.0)), (12.0, radians(90.0)))
    team = tuple(Vehicle(scale(direction(0.0, yaw), d), ZERO, 9.0) for d, yaw in places)
    target = Target(True, Vec(0.0, 500.0, 0.0))
    view = evader_view(own, COPTER, team, target, ZERO, rules)
    bare = EVADERS["paper"].decide(view)
    assert bare.rule == RuleId.FREE_RAY_TO_TARGET
    assert bare.direction.y > 0.05
    kept = evader_keeps_out(view, bare)
    assert (kept.rule, kept.direction.y < -0.5) == (RuleId.ROUND_ZONE, True)


def test_who_is_in_a_zone_leaves_it_by_the_shortest_way() -> None:
    block = zones_of([Prism(((-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)))])
    rules = Rules(2.0, 4.0, planar=True, zones=block)
    own = Vehicle(Vec(10.0, -42.0, 0.0), Vec(10.0, 0.0, 0.0), 10.0)
    view = evader_view(own, COPTER, (), Target(True, Vec(400.0, 0.0, 0.0)), ZERO, rules)
    out = evader_keeps_out(view, EVADERS["paper"].decide(view))
    assert (out.rule, out.direction) == (RuleId.LEAVE_ZONE, Vec(0.0, -1.0, 0.0))
    windy = evader_view(own, PLANE, (), Target(True, Vec(400.0, 0.0, 0.0)), Vec(6.0, 0.0, 0.0), rules)
    air = evader_keeps_out(windy, EVADERS["paper"].decide(windy)).direction
    assert unit(add(scale(air, 10.0), Vec(6.0, 0.0, 0.0)), NORTH).x == pytest.approx(0.0, abs=1e-12)


def test_a_turning_craft_keeps_its_circle() -> None:
    radius = 15.0 / PLANE.turn_rate
    assert margin_of(PLANE, 15.0, ZERO) > radius + CLEARANCE
    assert margin_of(PLANE, 15.0, Vec(5.0, 0.0, 0.0)) > radius * (4 / 3) ** 2 + CLEARANCE
    assert margin_of(COPTER, 15.0, ZERO) == CLEARANCE


def test_without_zones_a_decision_is_the_same_object() -> None:
    own = Vehicle(ZERO, Vec(10.0, 0.0, 0.0), 10.0)
    view = evader_view(own, COPTER, (), Target(True, Vec(40.0, 0.0, 0.0)), ZERO, Rules(1.0, 2.0))
    decided = EVADERS["paper"].decide(view)
    assert evader_keeps_out(view, decided) is decided
