"""Which rule fires, where it aims, and that everything stays within its limits."""

from __future__ import annotations

from math import radians

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.game.rules import Control, Rules, Target
from onboard.core.game.views import EvaderView, Nearest, PursuerView
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.states import FREE, Vehicle, VehicleLimits
from onboard.core.math.vectors import (
    NORTH,
    ZERO,
    Vec,
    add,
    angle_between,
    cross,
    distance,
    dot,
    norm,
    pitch_of,
    scale,
    sub,
    unit,
)
from onboard.core.strategy.evasion import EVADER, evader, resultant_force, straight
from onboard.core.strategy.knowledge import Rule, RuleId
from onboard.core.strategy.pursuit import (
    PURSUER,
    PURSUER_EARLIER,
    pursuer,
    pursuer_earlier,
    pursuer_navigation,
    pursuer_parallel,
    pursuer_predictive,
    pursuer_pure,
)
from onboard.core.strategy.registry import EVADERS, PURSUERS
from tests.support.random_situations import headings, points, pursuers

EAST = Vec(0.0, 1.0, 0.0)


def seen_by_evader(team, target=None, limits=FREE, planar=True):
    own = Vehicle(ZERO, scale(NORTH, 5.0), 5.0)
    cones = blocked_cones(own, team, 4.0)
    goal = ZERO if target is None else target
    rules = Rules(2.0, 4.0, planar=planar)
    return EvaderView(own, limits, team, cones, Target(target is not None, goal), rules, (0.0,) * len(team))


def seen_by_pursuer(place, heading=NORTH, speed=4.0, limits=FREE, mate=None, separation=0.0,
                    prediction=None, planar=True, velocity=ZERO):
    return PursuerView(
        Vehicle(place, velocity, speed), limits, Vehicle(ZERO, scale(heading, 5.0), 5.0), heading,
        prediction is not None, ZERO if prediction is None else prediction,
        Nearest(mate is not None, ZERO if mate is None else mate), Control(0.05, 2.0),
        Rules(2.0, 4.0, separation=separation, planar=planar),
    )  # fmt: skip


def at(north, east, speed=4.0):
    return Vehicle(Vec(north, east, 0.0), ZERO, speed)


class TestEvader:
    def test_heads_for_a_free_target(self):
        decision = evader(seen_by_evader((at(-50.0, 0.0),), Vec(100.0, 0.0, 0.0)))
        assert (decision.rule, decision.direction) == (RuleId.FREE_RAY_TO_TARGET, NORTH)
        assert decision.aim == Vec(100.0, 0.0, 0.0)
        assert decision.time == pytest.approx(20.0)

    def test_passes_a_pursuer_in_the_way_on_the_edge_of_its_cone(self):
        view = seen_by_evader((at(50.0, 1.0),), Vec(100.0, 0.0, 0.0))
        decision = evader(view)
        assert decision.rule == RuleId.FREE_RAY_TO_TARGET
        assert decision.direction.y < 0.0  # the pursuer stands a little to the right

    def test_without_a_target_flees_along_the_force(self):
        view = seen_by_evader((at(30.0, 40.0),))
        decision = evader(view)
        assert decision.rule == RuleId.FREE_RAY_FROM_PURSUERS
        assert angle_between(decision.direction, unit(resultant_force(view), NORTH)) < 1e-12

    def test_encircled_it_follows_the_resultant_force(self):
        team = (at(30.0, 0.0), at(0.0, 40.0), at(-50.0, 0.0), at(0.0, -60.0))
        for target in (None, Vec(100.0, 0.0, 0.0)):
            view = seen_by_evader(team, target)
            decision = evader(view)
            wanted = RuleId.RESULTANT_FORCE if target is None else RuleId.RESULTANT_FORCE_TO_TARGET
            assert decision.rule == wanted
            assert angle_between(decision.direction, unit(resultant_force(view), NORTH)) < 1e-12

    def test_the_force_is_21_and_22(self):
        team = (at(24.0, 0.0), at(0.0, -14.0))
        force = resultant_force(seen_by_evader(team))
        assert force == (pytest.approx(-100.0 / 20.0), pytest.approx(100.0 / 10.0), 0.0)
        goal = resultant_force(seen_by_evader(team, Vec(0.0, 50.0, 0.0)))
        assert goal.y == pytest.approx(10.0 + 1.0 + 1.0 / 50.0)

    def test_a_pursuer_within_2R_weighs_as_one_at_the_floor(self):
        force = resultant_force(seen_by_evader((at(3.0, 0.0),)))
        assert force.x == pytest.approx(-100.0 / 1e-3)

    def test_at_its_target_it_keeps_its_heading(self):
        decision = evader(seen_by_evader((at(-50.0, 0.0),), ZERO))
        assert (decision.rule, decision.direction) == (RuleId.FREE_RAY_TO_TARGET, NORTH)

    def test_straight_flight_goes_through_whoever_stands_there(self):
        assert straight(seen_by_evader((at(50.0, 0.0),), Vec(100.0, 0.0, 0.0))).direction == NORTH
        assert straight(seen_by_evader((at(50.0, 0.0),))).rule == RuleId.STRAIGHT_ON

    @settings(max_examples=300, deadline=None)
    @given(pursuers(), points(), st.floats(-60.0, 0.0), st.floats(0.0, 60.0))
    def test_keeps_its_pitch_band_whichever_rule_fires(self, team, target, low, high):
        limits = VehicleLimits(pitch_min=radians(low), pitch_max=radians(high))
        decision = evader(seen_by_evader(team, target, limits, planar=False))
        assert limits.pitch_min - 2e-9 <= pitch_of(decision.direction) <= limits.pitch_max + 2e-9
        assert norm(decision.direction) == pytest.approx(1.0, abs=1e-9)


class TestPursuer:
    def test_intercepts_where_the_ray_meets_the_sphere(self):
        decision = pursuer(seen_by_pursuer(Vec(50.0, 10.0, 0.0)))
        assert decision.rule == RuleId.INTERCEPT
        assert distance(decision.aim, Vec(50.0, 10.0, 0.0)) == pytest.approx(4.0 * decision.time)

    def test_approaches_where_it_comes_closer_but_cannot_be_met(self):
        decision = pursuer(seen_by_pursuer(Vec(20.0, 50.0, 0.0)))
        assert decision.rule == RuleId.CLOSEST_APPROACH
        assert decision.miss > 0.0

    @pytest.mark.parametrize("place", [Vec(0.0, 50.0, 0.0), Vec(-20.0, 30.0, 0.0)])
    def test_flies_parallel_when_it_moves_away(self, place):
        decision = pursuer(seen_by_pursuer(place))
        assert (decision.rule, decision.direction) == (RuleId.PARALLEL, NORTH)

    def test_or_heads_for_the_predicted_place(self):
        place = Vec(30.0, -5.0, 0.0)
        decision = pursuer_predictive(seen_by_pursuer(Vec(-20.0, 30.0, 0.0), prediction=place))
        assert (decision.rule, decision.aim) == (RuleId.PREDICTED_PLACE, place)
        assert pursuer_predictive(seen_by_pursuer(Vec(-20.0, 30.0, 0.0))).rule == RuleId.PARALLEL

    def test_the_earlier_paper_goes_straight_where_there_is_no_intercept(self):
        for place in (Vec(20.0, 50.0, 0.0), Vec(-20.0, 30.0, 0.0)):
            decision = pursuer_earlier(seen_by_pursuer(place))
            assert (decision.rule, decision.aim) == (RuleId.STRAIGHT_AT_EVADER, ZERO)

    def test_a_faster_pursuer_intercepts_from_behind(self):
        decision = pursuer(seen_by_pursuer(Vec(-50.0, 0.0, 0.0), speed=6.0))
        assert decision.rule == RuleId.INTERCEPT
        assert decision.time == pytest.approx(50.0)

    def test_keeps_off_a_near_team_mate_only_when_told(self):
        mate = Vec(51.0, 10.0, 0.0)
        place = Vec(50.0, 10.0, 0.0)
        kept = pursuer(seen_by_pursuer(place, mate=mate, separation=5.0))
        assert kept.rule == RuleId.KEEP_OFF_MATE
        assert dot(kept.direction, sub(place, mate)) > 0.0
        assert pursuer(seen_by_pursuer(place, mate=mate)).rule == RuleId.INTERCEPT

    @settings(max_examples=300, deadline=None)
    @given(points(), headings(), st.floats(-40, 0), st.floats(0, 40), st.sampled_from(sorted(PURSUERS)))
    def test_every_strategy_keeps_the_pitch_band(self, place, heading, low, high, name):
        limits = VehicleLimits(pitch_min=radians(low), pitch_max=radians(high))
        view = seen_by_pursuer(place, heading, limits=limits, prediction=Vec(1.0, 2.0, 300.0), planar=False)
        decision = PURSUERS[name].decide(view)
        assert limits.pitch_min - 2e-9 <= pitch_of(decision.direction) <= limits.pitch_max + 2e-9
        assert norm(decision.direction) == pytest.approx(1.0, abs=1e-9)

    @settings(max_examples=300, deadline=None)
    @given(points(planar=True), headings(planar=True), st.sampled_from(sorted(PURSUERS)))
    def test_every_strategy_stays_in_the_plane(self, place, heading, name):
        view = seen_by_pursuer(place, heading, prediction=Vec(1.0, 2.0, 0.0))
        assert PURSUERS[name].decide(view).direction.z == 0.0

    def test_coincident_players_give_a_unit_direction(self):
        for name, strategy in PURSUERS.items():
            decision = strategy.decide(seen_by_pursuer(ZERO, prediction=ZERO))
            assert norm(decision.direction) == pytest.approx(1.0), name


class TestComparisons:
    def test_pure_pursuit_points_at_the_evader(self):
        assert pursuer_pure(seen_by_pursuer(Vec(0.0, 50.0, 0.0))).direction == Vec(0.0, -1.0, 0.0)

    @settings(max_examples=300, deadline=None)
    @given(points(), headings(), st.floats(1.0, 9.0))
    def test_parallel_pursuit_keeps_the_line_of_sight_parallel(self, place, heading, speed):
        view = seen_by_pursuer(place, heading, speed=speed, planar=False)
        sight = unit(sub(ZERO, place), NORTH)
        across = sub(scale(heading, 5.0), scale(sight, dot(scale(heading, 5.0), sight)))
        decision = pursuer_parallel(view)
        if norm(across) < 0.999 * speed and distance(place, ZERO) > 1.0:
            relative = sub(scale(heading, 5.0), scale(decision.direction, speed))
            assert norm(cross(relative, sight)) < 1e-6

    @settings(max_examples=200, deadline=None)
    @given(points(), headings(), headings())
    def test_parallel_pursuit_asks_for_no_course_that_the_vehicle_cannot_turn_to(self, place, heading, own):
        """A second's turn at 4.5 deg/s, and towards the side where the line of sight stays parallel."""
        limits = VehicleLimits(turn_rate=radians(4.5))
        velocity = scale(unit(Vec(own.x, own.y, 0.0), NORTH), 4.0)
        place, heading = Vec(place.x, place.y, 0.0), unit(Vec(heading.x, heading.y, 0.0), NORTH)
        free = pursuer_parallel(seen_by_pursuer(place, heading, velocity=velocity))
        held = pursuer_parallel(seen_by_pursuer(place, heading, velocity=velocity, limits=limits))
        turn = angle_between(held.direction, unit(velocity, NORTH))
        assert turn <= radians(4.5) + 1e-9
        wanted = angle_between(free.direction, unit(velocity, NORTH))
        assert angle_between(held.direction, free.direction) == pytest.approx(
            max(0.0, wanted - radians(4.5)), abs=1e-7
        )

    def test_proportional_navigation_turns_thrice_as_fast_as_the_line_of_sight(self):
        place, velocity = Vec(0.0, -400.0, 0.0), scale(EAST, 4.0)
        decision = pursuer_navigation(seen_by_pursuer(place, NORTH, velocity=velocity))
        sight_rate = 5.0 / 400.0  # the evader crosses at right angles
        turned = angle_between(decision.direction, EAST)
        assert decision.direction.x > 0.0
        assert turned == pytest.approx(3.0 * sight_rate * 0.05, rel=1e-3)

    def test_proportional_navigation_flies_to_a_capture(self):
        e, p, ahead = ZERO, Vec(100.0, 300.0, 0.0), Vec(0.0, -1.0, 0.0)
        nearest = 1e9
        for _ in range(2000):
            view = seen_by_pursuer(sub(p, e), NORTH, velocity=scale(ahead, 4.0), speed=6.0)
            decision = pursuer_navigation(view)
            ahead = decision.direction
            p, e = add(p, scale(ahead, 6.0 * 0.05)), add(e, scale(NORTH, 5.0 * 0.05))
            nearest = min(nearest, distance(p, e))
        assert nearest < 1.0


class TestKnowledgeBase:
    def test_a_reader_sees_every_rule_with_its_source(self):
        for strategy in (*PURSUERS.values(), *EVADERS.values()):
            for rule in strategy.table:
                assert isinstance(rule, Rule)
                assert rule.when
                assert rule.then
                assert rule.source

    def test_the_table_is_the_program(self):
        """Asking the rows one after the other gives what the folded function gives."""

        def by_hand(table, view):
            answers = [row.apply(view) for row in table]
            return next((a for a in answers if a.fires), answers[-1])

        for place in (Vec(50.0, 10.0, 0.0), Vec(20.0, 50.0, 0.0), Vec(-20.0, 30.0, 0.0)):
            view = seen_by_pursuer(place)
            assert by_hand(PURSUER, view) == pursuer(view)
            assert by_hand(PURSUER_EARLIER, view) == pursuer_earlier(view)
        view = seen_by_evader((at(30.0, 1.0), at(-50.0, 3.0)), Vec(100.0, 0.0, 0.0))
        assert by_hand(EVADER, view) == evader(view)

