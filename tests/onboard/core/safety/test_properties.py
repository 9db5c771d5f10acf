"""Whatever comes in, including what is not a number: no setpoint leaves outside limits or fence."""

from __future__ import annotations

from math import atan2, cos, isfinite, pi, sin

from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.states import Mate
from onboard.core.math.vectors import Vec
from onboard.core.safety.envelope import slewed
from onboard.core.safety.fence import depth, fits, inside, outside_by, turn, turning_radius
from onboard.core.safety.health import HealthAction
from onboard.core.safety.policy import Action, Cause, Envelope, Fence, Policy, SupervisorInput
from onboard.core.safety.supervisor import SupervisorState, advance, handed_back, supervise
from tests.support.supervised_vehicle import COPTER, FIELD, PLANE, SupervisedVehicle, assert_within

anything = st.floats(allow_nan=True, allow_infinity=True)
any_vec = st.builds(Vec, anything, anything, anything)
sane = st.floats(-60.0, 60.0)
sane_vec = st.builds(Vec, sane, sane, sane)
vecs = st.one_of(any_vec, sane_vec)
mates = st.lists(st.builds(Mate, st.integers(1, 9), vecs, vecs, anything), max_size=3).map(tuple)
seens = st.builds(
    SupervisorInput,
    now=st.floats(0.0, 1e6),
    id=st.integers(1, 9),
    position=vecs,
    velocity=vecs,
    wind=vecs,
    mates=mates,
    telemetry_age=st.one_of(anything, st.floats(0.0, 0.5)),
    track_sigma=st.one_of(anything, st.just(0.0)),
    battery=st.one_of(anything, st.just(-1.0)),
    clock_jump_age=st.one_of(anything, st.just(1e9)),
    strategy_age=st.one_of(anything, st.floats(0.0, 0.3)),
)


@settings(max_examples=1500, deadline=None)
@given(wanted=vecs, seen=seens, copter=st.booleans(), before=vecs, gap=anything)
def test_no_setpoint_leaves_that_is_not_a_number_or_outside_the_limits(
    wanted: Vec, seen: SupervisorInput, copter: bool, before: Vec, gap: float
) -> None:
    policy = (COPTER if copter else PLANE)._replace(separation=10.0)
    demand = before if all(map(isfinite, before)) else Vec(1.0, 0.0, 0.0)
    watch = SupervisorState(demand=demand, stamp=seen.now - abs(gap))
    verdict = supervise(wanted, seen, policy, watch)
    assert all(map(isfinite, (*verdict.ground, *verdict.air)))
    if verdict.stream:
        assert_within(verdict, policy)
        assert seen.strategy_age <= policy.strategy_age
    else:
        assert verdict.ground == (0.0, 0.0, 0.0)


L_SHAPE = Fence(
    ((-120.0, -120.0), (120.0, -120.0), (120.0, 0.0), (0.0, 0.0), (0.0, 120.0), (-120.0, 120.0)), 5.0, 80.0
)
starts = st.tuples(st.floats(-90.0, -20.0), st.floats(-90.0, -20.0), st.floats(-60.0, -20.0))
wishes = st.lists(st.one_of(sane_vec, any_vec), min_size=1, max_size=8)


@settings(max_examples=60, deadline=None)
@given(wishes=wishes, start=starts)
def test_no_multicopter_leaves_its_fence_whatever_its_strategy_wants(
    wishes: list[Vec], start: tuple[float, float, float]
) -> None:
    flight = SupervisedVehicle(COPTER._replace(fences=(L_SHAPE,)), Vec(*start))
    for n in range(1200):
        flight.step(wishes[(n // 40) % len(wishes)])
        assert outside_by(flight.seen.position, L_SHAPE) == 0.0
        assert inside(flight.seen.position.x, flight.seen.position.y, L_SHAPE.polygon)


@settings(max_examples=40, deadline=None)
@given(
    wishes=st.lists(sane_vec, min_size=1, max_size=8),
    heading=st.floats(-pi, pi),
    wind=st.builds(Vec, st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), st.just(0.0)),
    outwards=st.booleans(),
)
def test_no_plane_leaves_its_fence_in_wind_whatever_its_strategy_wants(
    wishes: list[Vec], heading: float, wind: Vec, outwards: bool
) -> None:
    start = Vec(20.0 * cos(heading) + wind.x, 20.0 * sin(heading) + wind.y, 0.0)
    flight = SupervisedVehicle(PLANE, Vec(0.0, 0.0, -150.0), start, wind)
    for n in range(3000):
        at = flight.seen.position
        away = atan2(at.y, at.x) + wishes[0].x / 60.0
        wish = Vec(25.0 * cos(away), 25.0 * sin(away), 0.0) if outwards else wishes[(n // 100) % len(wishes)]
        verdict = flight.step(wish)
        assert verdict.stream
        assert outside_by(flight.seen.position, FIELD) == 0.0


demands = st.builds(
    lambda action, cause, latched: HealthAction(action, cause, latched and action >= Action.HOLD),
    st.sampled_from(Action), st.sampled_from(Cause), st.booleans(),
)


@settings(max_examples=300, deadline=None)
@given(st.lists(demands, min_size=1, max_size=40))
def test_nothing_milder_than_the_demand_is_ever_in_force_and_latches_hold(story: list[HealthAction]) -> None:
    watch = SupervisorState()
    now = 0.0
    floor = Action.PASS
    for demand in story:
        now += 0.05
        watch = advance(watch, demand, now, 1.0)
        floor = max(floor, demand.action) if demand.latched else floor
        assert watch.action >= demand.action
        assert watch.action >= floor
    calm = advance(handed_back(watch), HealthAction(Action.PASS, Cause.NONE, False), now + 0.05, 1.0)
    assert calm.action == Action.PASS


def test_a_fence_too_small_for_a_planes_circle_is_known_before_flight() -> None:
    small = Fence(((0.0, 0.0), (150.0, 0.0), (150.0, 150.0), (0.0, 150.0)), 10.0, 100.0)
    assert fits(FIELD, PLANE.envelope, 20.0, 5.0)
    assert not fits(small, PLANE.envelope, 20.0, 0.0)
    assert fits(small, COPTER.envelope, 20.0, 0.0)


situations = st.tuples(
    st.booleans(),
    st.builds(Vec, st.floats(-320.0, 320.0), st.floats(-320.0, 320.0), st.floats(-125.0, -15.0)),
    st.builds(Vec, st.floats(-20.0, 20.0), st.floats(-20.0, 20.0), st.just(0.0)),
    st.builds(Vec, st.floats(-8.0, 8.0), st.floats(-8.0, 8.0), st.just(0.0)),
    st.builds(Vec, st.floats(-300.0, 300.0), st.floats(-300.0, 300.0), st.just(-50.0)),
    st.builds(Vec, st.floats(-25.0, 25.0), st.floats(-25.0, 25.0), st.floats(-4.0, 4.0)),
)


@settings(max_examples=1500, deadline=None)
@given(situations)
def test_near_a_fence_and_in_wind_the_speed_limit_is_the_last_word(
    situation: tuple[bool, Vec, Vec, Vec, Vec, Vec]
) -> None:
    hovers, position, velocity, wind, mate, wanted = situation
    envelope = Envelope(
        hovers=hovers, speed_min=0.0 if hovers else 12.0, speed_max=10.0 if hovers else 20.0,
        turn_rate=0.6, turn_radius=0.0 if hovers else 60.0,
    )  # fmt: skip
    square = Fence(((-300.0, -300.0), (300.0, -300.0), (300.0, 300.0), (-300.0, 300.0)), 20.0, 120.0)
    policy = Policy(envelope=envelope, fences=(square,), separation=10.0 if hovers else 0.0)
    seen = SupervisorInput(
        now=10.0, id=2, position=position, velocity=velocity, wind=Vec(0.0, 0.0, 0.0) if hovers else wind,
        mates=(Mate(3, mate, Vec(0.0, 0.0, 0.0), 0.1),),
    )  # fmt: skip
    verdict = supervise(wanted, seen, policy, SupervisorState())
    if verdict.stream:
        x, y, z = verdict.air
        assert (x * x + y * y + z * z) ** 0.5 <= envelope.speed_max * (1.0 + 1e-6)
        assert -envelope.climb_max - 1e-6 <= z <= envelope.sink_max + 1e-6


@given(
    course=st.floats(-pi, pi),
    change=st.floats(-pi, pi),
    level=st.floats(5.0, 60.0),
    climb=st.floats(-20.0, 20.0),
    dt=st.floats(0.01, 1.0),
)
def test_a_turn_is_cut_at_its_rate_and_another_left_as_it_is(
    course: float, change: float, level: float, climb: float, dt: float
) -> None:
    e = PLANE.envelope._replace(turn_rate=0.4, acceleration=0.0)
    before = Vec(level * cos(course), level * sin(course), 0.0)
    wanted = Vec(level * cos(course + change), level * sin(course + change), climb)
    found = slewed(wanted, before, dt, e)
    kept = max(-e.turn_rate * dt, min(e.turn_rate * dt, change))
    if abs(change) < pi - 1e-6:
        expected = (level * cos(course + kept), level * sin(course + kept), climb)
        assert max(abs(a - b) for a, b in zip(found.velocity, expected, strict=True)) < 1e-4
    assert (found.cause == Cause.TURN) == (abs(change) > e.turn_rate * dt * (1.0 + 1e-6)) or (
        abs(abs(change) - e.turn_rate * dt) < 1e-5 * e.turn_rate * dt + 1e-9
    )


@given(
    x=st.floats(2700.0, 2999.0),  # near a wall
    y=st.floats(-2900.0, 2900.0),
    course=st.floats(-pi, pi),
    wanted=st.floats(-pi, pi),
)
def test_a_plane_is_turned_where_no_circle_fits_and_only_there(
    x: float, y: float, course: float, wanted: float
) -> None:
    square = ((-3000.0, -3000.0), (3000.0, -3000.0), (3000.0, 3000.0), (-3000.0, 3000.0))
    policy = PLANE._replace(fences=(Fence(square, 5.0, 900.0),))
    speed = policy.envelope.speed_max
    now, asked = (Vec(speed * cos(a), speed * sin(a), 0.0) for a in (course, wanted))
    found = turn(asked, Vec(x, y, -300.0), now, 3.0, policy)
    radius = turning_radius(policy.envelope, 3.0)
    gone = max(-1.0, min(1.0, speed / radius * policy.reaction / max(1e-12, abs(_turn(wanted - course)))))
    later = course + gone * _turn(wanted - course)
    px, py = x + speed * policy.reaction * cos(later), y + speed * policy.reaction * sin(later)
    sides = (radius, -radius)
    room = max(depth(px - r * sin(later), py + r * cos(later), square) for r in sides)
    if abs(room - radius - policy.fence_margin) > 1e-6:
        assert (found.cause == Cause.NONE) == (room >= radius + policy.fence_margin)


def _turn(angle: float) -> float:
    return atan2(sin(angle), cos(angle))
