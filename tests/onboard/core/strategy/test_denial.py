"""A known target is kept by who can be there first, and nobody leaves a closed ring for it."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sin, tau

import pytest

from onboard.core.game.advance import Conditions, advance, begin, moved
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.game.views import PursuerView, Team, nearest_mate, pursuer_view, sighted
from onboard.core.math.states import FREE, Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, ZERO, Vec, distance, norm, scale, sub
from onboard.core.strategy.denial import at_post, goal_post, keeper, line_post, spare, way_out
from onboard.core.strategy.knowledge import Level, RuleId, level_of
from onboard.core.strategy.registry import EVADERS, PURSUERS

PLANE = Rules(2.0, 4.0, horizon=300.0, planar=True, target_known=True)
AIRCRAFT = VehicleLimits(32.0, 40.0, radians(-20.0), radians(20.0), -pi, pi, radians(4.5))
GOAL = Vec(100.0, 0.0, 0.0)
GOALKEEPER, LINE = PURSUERS["goalkeeper"].decide, PURSUERS["blocking-line"].decide


def at(north: float, east: float, speed: float = 4.0, velocity: Vec = ZERO) -> Vehicle:
    return Vehicle(Vec(north, east, 0.0), velocity, speed)


def seen(
    members: tuple[Vehicle, ...], index: int, target: Vec | None = GOAL, *, limits: VehicleLimits = FREE,
    evader: Vehicle | None = None, rules: Rules = PLANE,
) -> PursuerView:  # fmt: skip
    quarry = Vehicle(ZERO, scale(NORTH, 5.0), 5.0) if evader is None else evader
    goal = NO_TARGET if target is None else Target(True, target)
    places = tuple(member.position for member in members)
    team = Team(nearest_mate(places[index], places, index), members, index, goal)
    return pursuer_view(members[index], limits, sighted(quarry, NORTH, 1.0), team, Control(0.1), rules)


def test_the_one_that_is_first_keeps_the_goal_and_the_others_chase() -> None:
    team = (at(60.0, 50.0), at(40.0, -60.0), at(-30.0, 10.0))
    rules = [GOALKEEPER(seen(team, index)).rule for index in range(3)]
    assert rules.count(RuleId.KEEP_GOAL) == 1
    assert rules[0] is RuleId.KEEP_GOAL  # 64 m and 16 s for it, 20 s for the evader; 85 m for the next
    assert level_of(RuleId.KEEP_GOAL) is Level.STRATEGIC
    assert spare(team[0], Vehicle(ZERO, ZERO, 5.0), GOAL) == pytest.approx(20.0 - hypot(40.0, 50.0) / 4.0)


def test_who_flies_to_the_goal_already_goes_on_where_another_is_as_near() -> None:
    team = (at(60.0, 50.0), at(60.0, -50.0, velocity=Vec(2.5, 3.1, 0.0)))
    assert keeper(seen(team, 0), GOAL) == 1


def test_without_a_known_target_in_time_or_a_way_out_everybody_chases() -> None:
    team = (at(60.0, 50.0), at(40.0, -60.0), at(-30.0, 10.0))
    late = (at(-90.0, 50.0), at(-80.0, -60.0), at(-70.0, 10.0))
    ring = tuple(at(50.0 * cos(k * tau / 5), 50.0 * sin(k * tau / 5)) for k in range(5))
    assert not way_out(seen(ring, 0))
    for view in (
        *(seen(team, k, None) for k in range(3)),
        *(seen(late, k) for k in range(3)),
        *(seen(ring, k) for k in range(5)),
    ):
        for decide in (GOALKEEPER, LINE):
            assert decide(view).rule not in (RuleId.KEEP_GOAL, RuleId.HOLD_LINE)


def test_blockers_stand_beside_the_keeper_so_near_that_their_cones_overlap() -> None:
    team = (at(95.0, 5.0), at(92.0, 30.0), at(93.0, -28.0), at(-60.0, 0.0))
    rules = [LINE(seen(team, k)).rule for k in range(4)]
    assert rules[:3] == [RuleId.KEEP_GOAL, RuleId.HOLD_LINE, RuleId.HOLD_LINE]
    assert rules[3] not in (RuleId.KEEP_GOAL, RuleId.HOLD_LINE)  # behind the evader
    posts = [line_post(seen(team, k), 0).place for k in (1, 2)]
    assert posts[0].y > 0.0 > posts[1].y
    for place in posts:  # γ = 0.8: a cone of 53.1° to each side; seen from the evader, keeper at 0°
        assert 0.0 < abs(place.y) / place.x < 1.0


def test_who_cannot_stand_circles_a_post_before_the_target() -> None:
    rules = Rules(25.0, 88.0, epsilon_min=50.0, target_known=True)
    evader = Vehicle(Vec(-6000.0, 0.0, -1500.0), scale(NORTH, 50.0), 50.0)
    own = Vehicle(Vec(300.0, 900.0, -1400.0), Vec(0.0, 40.0, 0.0), 40.0)
    goal = Vec(0.0, 0.0, -1500.0)
    view = seen((own,), 0, goal, limits=AIRCRAFT, evader=evader, rules=rules)
    post = goal_post(view)
    assert distance(post, goal) == pytest.approx(3.5 * 88.0)
    assert post.x < 0.0  # towards the evader
    far = []
    for step in range(4000):
        here = seen((own,), 0, goal, limits=AIRCRAFT, evader=evader, rules=rules)
        decision = at_post(here, post, RuleId.KEEP_GOAL)
        assert decision.speed == 40.0
        own = moved(own, decision, 0.1)
        if step >= 1500:
            far.append(distance(own.position, post))
    assert max(far) - min(far) < 40.0
    assert min(far) > 40.0 / radians(4.5)  # no turn narrower than it can fly
    assert abs(own.position.z - post.z) < 20.0


def test_a_kept_target_is_not_reached_whatever_the_evader_does() -> None:
    """The keeper captures at 2 m who has to come within 1 m; here with the evader's own strategies."""
    for name, result in (("paper", GameResult.DENIED), ("straight", GameResult.CAPTURED)):
        team = (at(70.0, 30.0, 3.0), at(-60.0, 50.0, 3.0))
        game = begin(Vehicle(ZERO, scale(NORTH, 5.0), 5.0), team, FREE, (FREE, FREE))
        conditions = Conditions(PLANE._replace(horizon=60.0), Target(True, GOAL), Control(0.1))
        while game.score.verdict == GameResult.RUNNING:
            game = advance(game, conditions, EVADERS[name].decide, GOALKEEPER)
        assert game.score.verdict == result
        if result == GameResult.DENIED:
            assert norm(sub(game.pursuers[0].position, GOAL)) < 0.5
