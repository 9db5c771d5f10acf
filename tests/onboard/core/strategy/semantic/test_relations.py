"""What holds between players, targets and regions, against definitions, simulated flights and limits."""

from __future__ import annotations

from math import acos, cos, inf, pi, sin

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from onboard.core.game.rules import NO_TARGET, Rules, Target
from onboard.core.geometry.apollonius import apollonius_sphere, disc_margin
from onboard.core.math.states import FREE, Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, ZERO, Vec, along, distance, scale, sub, unit
from onboard.core.strategy.semantic import relations as r
from onboard.core.strategy.semantic.graph import Held, Node, Scene, how_many, knowing
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Situation
from onboard.core.strategy.team.planner import no_plan, scene_of

FLAT = Rules(2.0, 4.0, horizon=100.0, planar=True, target_known=True)
PLANE = VehicleLimits(40.0, 50.0, -0.36, 0.36, turn_rate=0.08)

places = st.builds(Vec, st.floats(-200.0, 200.0), st.floats(-200.0, 200.0), st.just(0.0))
speeds = st.floats(1.0, 9.0)


def vehicle(place: Vec, speed: float) -> Vehicle:
    return Vehicle(place, scale(NORTH, speed), speed)


def scene(
    evader: Vehicle, pursuers: list[Vehicle], *goals: Vec, rules: Rules = FLAT, lost: tuple[int, ...] = ()
) -> Scene:
    team = tuple(Member(one, FREE, i not in lost) for i, one in enumerate(pursuers))
    targets = tuple(Target(True, goal) for goal in goals) or (NO_TARGET,)
    s = Situation(
        0.0, 0.0, evader, FREE, team, targets[0], ZERO, rules, Heights(), Margin(), evader.position, 40.0,
        targets,
    )  # fmt: skip
    return scene_of(s, no_plan(team, 0.0))


def arrival(start: Vec, speed: float, goal: Vec, dt: float = 0.01) -> float:
    """When somebody who flies straight is at a place, by flying it step by step [s]."""
    time, place = 0.0, start
    while distance(place, goal) > speed * dt:
        place = along(place, unit(sub(goal, place), NORTH), speed * dt)
        time += dt
    return time + distance(place, goal) / speed


@given(places, places, places, speeds, speeds)
@settings(max_examples=60)
def test_covers_is_by_how_much_a_flown_pursuer_is_there_first(
    e: Vec, p: Vec, goal: Vec, v_e: float, v_p: float
) -> None:
    assume(distance(e, goal) > 1.0)
    held = r.covers(scene(vehicle(e, v_e), [vehicle(p, v_p)], goal), 0, 0)
    its, own = arrival(e, v_e, goal), arrival(p, v_p, goal)
    assert held.strength == pytest.approx(max(0.0, 1.0 - own / its), abs=2e-3)
    if held.strength > 0.0:
        assert held.value == pytest.approx(its - own, abs=0.05)


@given(places, places, places, st.floats(0.5, 60.0), speeds, speeds)
@settings(max_examples=400)
def test_a_disc_is_held_exactly_where_every_point_of_it_is_reached_first(
    e: Vec, p: Vec, g: Vec, radius: float, v_e: float, v_p: float
) -> None:
    assume(distance(e, p) > 1.0)
    assume(abs(v_e - v_p) > 0.05)
    margin = disc_margin(g, radius, p, v_p, e, v_e)
    assume(apollonius_sphere(e, v_e, p, v_p).radius > 1.0)  # or it lies between two samples
    assume(abs(margin) > 0.01 * (radius + 1.0))
    rim = [Vec(g.x + radius * cos(a), g.y + radius * sin(a), 0.0) for a in
           (2.0 * pi * k / 720 for k in range(720))]  # fmt: skip
    within = [g, e] if distance(e, g) <= radius else [g]  # a faster pursuer leaves what is about the evader
    first = all(distance(p, x) * v_e <= distance(e, x) * v_p for x in (*rim, *within))
    if margin > 0.0:
        assert first
    elif margin < -1e-3 * radius - 0.02:  # the rim is sampled
        assert not first


@given(places, places, places)
def test_as_fast_as_the_evader_a_disc_is_held_on_the_own_side_of_the_bisector(e: Vec, p: Vec, g: Vec) -> None:
    assume(distance(e, p) > 1.0)
    middle, towards = scale(Vec(e.x + p.x, e.y + p.y, 0.0), 0.5), unit(sub(p, e), NORTH)
    line = sub(g, middle)
    assert disc_margin(g, 3.0, p, 5.0, e, 5.0) == pytest.approx(
        line.x * towards.x + line.y * towards.y - 3.0, abs=1e-6
    )


@given(places, places, places, speeds, speeds)
def test_a_safe_side_is_where_a_pursuer_covers_a_point(
    e: Vec, p: Vec, goal: Vec, v_e: float, v_p: float
) -> None:
    assume(distance(e, goal) > 1.0)
    here = scene(vehicle(e, v_e), [vehicle(p, v_p)], goal)
    covered, inside = r.covers(here, 0, 0), r.inside(here, 0, 0)
    assume(abs(covered.value) > 1e-6)
    assert (covered.strength > 0.0) == (inside.strength > 0.0)
    assert inside.value == pytest.approx(
        v_p * (distance(e, goal) / v_e - distance(p, goal) / v_p), abs=1e-6
    )


@given(places, places, st.floats(0.0, 0.99), speeds, speeds)
def test_who_comes_nearer_to_a_target_covers_it_no_less(
    e: Vec, p: Vec, share: float, v_e: float, v_p: float
) -> None:
    goal = Vec(50.0, 20.0, 0.0)
    assume(distance(e, goal) > 1.0)
    nearer = along(p, sub(goal, p), share)
    held = [r.covers(scene(vehicle(e, v_e), [vehicle(x, v_p)], goal), 0, 0) for x in (p, nearer)]
    assert held[1].strength >= held[0].strength - 1e-12


@given(places, st.lists(st.tuples(places, st.floats(1.0, 4.9)), min_size=1, max_size=6), places)
@settings(max_examples=60)
@example(Vec(6.0, 1.0, 0.0), [(ZERO, 2.0), (Vec(0.0, 1.0, 0.0), 1.0)], ZERO)  # one cone in another, due south
def test_every_strength_is_a_share_and_what_holds_of_whom_turns_with_the_world(
    e: Vec, who: list[tuple[Vec, float]], goal: Vec
) -> None:
    assume(min(distance(e, p) for p, _ in who) > 5.0)
    assume(distance(e, goal) > 5.0)

    def edges(turn: float) -> dict[tuple[int, int, int], Held]:
        def turned(v: Vec) -> Vec:
            return Vec(v.x * cos(turn) - v.y * sin(turn), v.x * sin(turn) + v.y * cos(turn), 0.0)

        here = scene(vehicle(turned(e), 5.0), [vehicle(turned(p), v) for p, v in who], turned(goal))
        found = knowing(r.RELATIONS)(here)
        assert all(0.0 < edge.strength <= 1.0 for edge in found)
        return {(x.relation, x.source, x.sink): Held(x.strength, x.value) for x in found
                if x.strength > 1e-6 and x.relation != r.FLANKS}  # fmt: skip

    one, other = edges(0.0), edges(1.3)
    assert one.keys() == other.keys()
    for key, held in one.items():
        assert held.strength == pytest.approx(other[key].strength, abs=1e-6)


def test_blocked_is_the_straight_way_that_no_free_ray_is() -> None:
    """The cone of a pursuer ahead: half-angle asin γ + asin(ρ/d), the way d cos inside by what is left."""
    here = scene(vehicle(ZERO, 5.0), [vehicle(Vec(40.0, 0.0, 0.0), 4.0)], Vec(100.0, 10.0, 0.0))
    held = r.blocks(here, 0, 0)
    half = acos(0.6) + acos((1.0 - 0.01) ** 0.5)
    off = acos(100.0 / (100.0**2 + 10.0**2) ** 0.5)
    assert held.value == pytest.approx((half - off) * 180.0 / pi, abs=1e-6)
    assert held.strength == pytest.approx((half - off) / half)
    aside = scene(vehicle(ZERO, 5.0), [vehicle(Vec(40.0, 0.0, 0.0), 4.0)], Vec(-100.0, 0.0, 0.0))
    assert r.blocks(aside, 0, 0).strength == 0.0


def test_limits_who_is_lost_counts_for_nothing_and_a_ring_encloses() -> None:
    ring = [vehicle(Vec(40.0 * cos(a), 40.0 * sin(a), 0.0), 4.0) for a in
            (0.1 + 2.0 * pi * k / 5 for k in range(5))]  # fmt: skip
    whole = scene(vehicle(ZERO, 5.0), ring, Vec(90.0, 0.0, 0.0))
    assert r.encloses(whole, 0, 0).strength == 1.0
    assert r.free(whole, 0, 0).strength == 0.0
    assert r.suffices(whole, 0, 0).strength > 0.0
    without = scene(vehicle(ZERO, 5.0), ring, Vec(90.0, 0.0, 0.0), lost=(0,))
    assert r.lost(without, 0, 0).strength == 1.0
    assert r.covers(without, 0, 0).strength == r.blocks(without, 0, 0).strength == 0.0
    assert r.free(without, 0, 0).strength == pytest.approx(1.0 - r.encloses(without, 0, 0).strength)
    gap = r.free(without, 0, 0).value
    assert {i for i in range(5) if r.flanks(without, i, 0).strength > 0.0} == {1, 4}
    assert gap > 0.0
    few = scene(vehicle(ZERO, 5.0), ring[:3], Vec(90.0, 0.0, 0.0))
    assert r.suffices(few, 0, 0).strength == 0.0  # 3 · 2 (53.1° + asin R/d) < 360°
    late = scene(vehicle(ZERO, 5.0), [vehicle(Vec(9e3, 0.0, 0.0), 4.0)] * 9, Vec(90.0, 0.0, 0.0))
    assert r.suffices(late, 0, 0).strength == 0.0  # nobody meets it before the horizon


def test_a_target_beyond_the_horizon_is_not_threatened() -> None:
    near, far = Vec(100.0, 0.0, 0.0), Vec(600.0, 0.0, 0.0)
    here = scene(vehicle(ZERO, 5.0), [vehicle(far, 4.0)], near, far)
    assert how_many(here, Node.TARGET) == 2
    assert r.threatens(here, 0, 0).value == pytest.approx((100.0 - FLAT.epsilon_min) / 5.0)
    assert r.threatens(here, 0, 1).strength == 0.0


def test_a_region_is_not_denied_by_who_is_first_in_its_middle() -> None:
    """The evader comes to the edge of a disc of 30 m long before a pursuer beyond it is there."""
    goal, rules = Vec(100.0, 0.0, 0.0), FLAT._replace(epsilon_min=30.0)
    behind = vehicle(Vec(130.0, 0.0, 0.0), 4.0)
    assert r.covers(scene(vehicle(ZERO, 5.0), [behind], goal), 0, 0).strength > 0.0
    assert r.covers(scene(vehicle(ZERO, 5.0), [behind], goal, rules=rules), 0, 0).strength == 0.0
    before = vehicle(Vec(100.0, 0.0, 0.0), 4.9)
    assert r.covers(scene(vehicle(ZERO, 5.0), [before], goal, rules=rules), 0, 0).strength > 0.0


def test_a_ceiling_takes_pitch() -> None:
    team = (Member(Vehicle(Vec(2000.0, 0.0, -1000.0), Vec(-40.0, 0.0, 0.0), 40.0), PLANE, True),)
    evader = Vehicle(Vec(0.0, 0.0, -1000.0), Vec(50.0, 0.0, 0.0), 50.0)
    rules = Rules(25.0, 88.0, horizon=400.0)
    found = []
    for ceiling in (inf, 1500.0, 1100.0):
        s = Situation(
            0.0, 0.0, evader, PLANE, team, NO_TARGET, ZERO, rules, Heights(0.0, ceiling), Margin(),
            evader.position, 1500.0,
        )  # fmt: skip
        found.append(r.confines(scene_of(s, no_plan(team, 0.0)), 0, 0).strength)
    assert 0.0 <= found[0] <= found[1] < found[2] < 1.0
