"""Bounds of the supervisor's rules on both their sides, against reckoning of our own."""

from __future__ import annotations

from itertools import pairwise
from math import inf, nan, sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onboard.core.math.states import Mate
from onboard.core.math.vectors import ZERO, Vec, norm
from onboard.core.safety.envelope import bounded
from onboard.core.safety.fence import keep_height, turn
from onboard.core.safety.field_profile import layers
from onboard.core.safety.policy import Action, Cause, Envelope, Fence, Policy, SupervisorInput
from onboard.core.safety.separation import DRIFT, SLACK, keep_apart
from onboard.core.safety.supervisor import SupervisorState, supervise

POLICY = Policy(envelope=Envelope(speed_max=10.0, deceleration=2.0), separation=10.0, reaction=0.5)
BAND = Fence(((-500.0, -500.0), (500.0, -500.0), (500.0, 500.0), (-500.0, 500.0)), 20.0, 120.0)


def mate(north: float, age: float) -> Mate:
    return Mate(3, Vec(north, 0.0, -50.0), ZERO, age)


def toward(north: float, age: float) -> float:
    """How fast a vehicle that wants to fly north at 10 m/s may do so with a mate `north` metres ahead."""
    kept = keep_apart(Vec(10.0, 0.0, 0.0), Vec(0.0, 0.0, -50.0), 2, (mate(north, age),), POLICY)
    assert kept.changed == (kept.velocity.x != 10.0)
    return kept.velocity.x


def test_a_mate_silent_for_minutes_is_no_longer_where_it_was() -> None:
    assert toward(12.0, 0.1) < 10.0
    assert toward(12.0, 10.0) < 10.0
    assert toward(12.0, 10.01) == 10.0
    assert toward(12.0, 180.0) == 10.0
    assert toward(12.0, nan) == 10.0


def test_a_mate_becomes_quiet_after_one_second_and_not_sooner() -> None:
    assert toward(22.0, 1.0) > toward(22.0, 1.001)


@pytest.mark.parametrize("gap", [0.5, 3.0, 8.0])
def test_who_closes_in_can_still_stop_at_the_separation_distance(gap: float) -> None:
    kept = 10.0 * (1.0 + SLACK) + DRIFT * 0.5
    v = toward(kept + gap, 2.0 - 1.5)  # heard half a second ago: each takes half of the excess
    most = 2.0 * (sqrt(0.25 + gap) - 0.5)  # v t + v²/2a = gap
    assert v == pytest.approx(10.0 - 0.5 * (10.0 - most))
    quiet = toward(kept + 10.0 * (1.0 + SLACK) + gap, 5.0)  # twice the distance, and all of the excess
    assert quiet == pytest.approx(most)


def test_at_and_inside_the_separation_distance_both_move_apart() -> None:
    assert toward(10.0, 5.0) < 0.0  # twice the distance counts: well inside
    inside = keep_apart(ZERO, Vec(0.0, 0.0, -50.0), 2, (mate(9.0, 0.1),), POLICY)
    assert inside.changed
    assert inside.velocity.x < 0.0


@given(up=st.floats(20.5, 119.5), sink=st.floats(0.0, 6.0))
def test_who_sinks_can_still_stop_above_the_floor(up: float, sink: float) -> None:
    e = Envelope(deceleration=2.0, sink_max=6.0)
    kept = keep_height(Vec(0.0, 0.0, sink), Vec(0.0, 0.0, -up), BAND, 3.0, 0.5, e)
    v = kept.velocity.z
    assert 0.0 <= v <= sink
    room = up - 3.0 - 20.0
    if v > 0.0:  # with half the deceleration, after half a second
        assert v * 0.5 + v * v / 2.0 <= room + 1e-9
    assert (kept.cause == Cause.FLOOR_AHEAD) == (v < sink)
    if room > sink * 0.5 + sink * sink / 2.0 + 1e-6:
        assert v == sink


def test_the_nearer_the_floor_the_slower_the_descent() -> None:
    def sinks(up: float) -> float:
        return keep_height(Vec(0, 0, 2), Vec(0, 0, -up), BAND, 3.0, 0.5, Envelope()).velocity.z

    speeds = [sinks(up) for up in (30.0, 26.0, 25.0, 24.0, 23.5, 23.0)]
    assert all(a >= b for a, b in pairwise(speeds))
    assert speeds[0] == 2.0
    assert speeds[-1] == 0.0


def seen(**what: object) -> SupervisorInput:
    return SupervisorInput(10.0, 2, Vec(0.0, 0.0, -50.0), Vec(1.0, 0.0, 0.0))._replace(**what)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("what", "cause"),
    [
        ({"position": Vec(nan, 0.0, -50.0)}, Cause.TELEMETRY),
        ({"position": Vec(0.0, 0.0, nan)}, Cause.TELEMETRY),
        ({"velocity": Vec(0.0, nan, 0.0)}, Cause.TELEMETRY),
        ({"velocity": Vec(0.0, 0.0, inf)}, Cause.TELEMETRY),
        ({"telemetry_age": nan}, Cause.TELEMETRY),
        ({"telemetry_age": 0.5001}, Cause.TELEMETRY),
        ({"heartbeat_age": nan}, Cause.HEARTBEAT),
        ({"strategy_age": nan}, Cause.STRATEGY),
        ({"strategy_age": 0.2001}, Cause.STRATEGY),
        ({"battery": nan}, Cause.BATTERY),
        ({"battery": 0.1999}, Cause.BATTERY),
        ({"track_sigma": nan}, Cause.TRACKS),
        ({"clock_jump_age": nan}, Cause.CLOCK),
        ({"clock_jump_age": 1.999}, Cause.CLOCK),
    ],
)
def test_what_is_unknown_or_just_over_its_bound_is_a_fault(what: dict[str, object], cause: Cause) -> None:
    found = supervise(Vec(1.0, 0.0, 0.0), seen(**what), POLICY, SupervisorState())
    assert not found.stream
    assert found.cause is cause


@pytest.mark.parametrize("age", [nan, 60.0001])
def test_a_silence_of_the_master_that_is_no_number_counts_as_the_longest(age: float) -> None:
    field = POLICY._replace(ground_age=5.0, ground_action=Action.HOLD, ground_return=60.0)
    found = supervise(Vec(1.0, 0.0, 0.0), seen(ground_age=age), field, SupervisorState())
    assert (found.action, found.cause) == (Action.RETURN, Cause.GROUND_STATION)
    holds = field._replace(ground_return=inf)
    found = supervise(Vec(1.0, 0.0, 0.0), seen(ground_age=age), holds, SupervisorState())
    assert (found.action, found.cause) == (Action.HOLD, Cause.GROUND_STATION)
    found = supervise(Vec(1.0, 0.0, 0.0), seen(ground_age=5.0), field, SupervisorState())
    assert found.action is Action.PASS


@pytest.mark.parametrize(
    "what",
    [
        {"telemetry_age": 0.5}, {"strategy_age": 0.2}, {"battery": 0.2}, {"battery": -1.0},
        {"heartbeat_age": 6.0}, {"track_sigma": 100.0}, {"clock_jump_age": 2.0}, {"gps_fix": 3},
    ],
)  # fmt: skip
def test_what_is_just_within_its_bound_passes(what: dict[str, object]) -> None:
    found = supervise(Vec(1.0, 0.0, 0.0), seen(**what), POLICY, SupervisorState())
    assert (found.action, found.cause) == (Action.PASS, Cause.NONE)


PLANE = Envelope(
    hovers=False, speed_min=12.0, speed_max=20.0, climb_max=3.0, sink_max=2.0, turn_rate=0.6, turn_radius=60.0
)


def test_every_cause_has_a_number_of_its_own() -> None:
    assert [int(cause) for cause in Cause] == list(range(len(Cause.__members__)))
    assert [int(action) for action in Action] == list(range(len(Action.__members__)))


def test_a_plane_too_slow_is_made_faster_in_its_own_direction() -> None:
    found = bounded(Vec(3.0, -4.0, 1.0), Vec(1.0, 0.0, 0.0), PLANE)
    assert found.cause is Cause.SPEED
    k = 12.0 / sqrt(26.0)
    assert found.velocity == pytest.approx((3.0 * k, -4.0 * k, min(1.0 * k, 2.0)), rel=1e-2)
    assert norm(found.velocity) == pytest.approx(12.0)


def test_a_plane_told_to_stand_still_flies_level_on_its_course() -> None:
    assert bounded(ZERO, Vec(0.0, 5.0, 2.0), PLANE).velocity == Vec(0.0, 12.0, 0.0)
    assert bounded(ZERO, ZERO, PLANE).velocity == Vec(12.0, 0.0, 0.0)


def test_a_demand_too_large_to_square_keeps_its_direction() -> None:
    found = bounded(Vec(3e200, -4e200, 0.0), ZERO, POLICY.envelope)
    assert found.cause is Cause.SPEED
    assert found.velocity == pytest.approx((6.0, -8.0, 0.0))
    assert bounded(Vec(0.0, 0.0, -5e200), ZERO, POLICY.envelope).velocity == pytest.approx((0.0, 0.0, -3.0))


@pytest.mark.parametrize(
    ("east", "free"), [(60.0, True), (-60.0, True), (0.0, False), (24.0, False), (-26.0, True)]
)
def test_a_plane_is_free_while_a_whole_circle_to_one_side_fits(east: float, free: bool) -> None:
    """A corridor 200 m wide, circles of 60 m and a margin of 5 m: one fits from 35 m beside its middle on."""
    corridor = Fence(((-9000.0, -100.0), (9000.0, -100.0), (9000.0, 100.0), (-9000.0, 100.0)), 20.0, 120.0)
    policy = Policy(envelope=PLANE, fences=(corridor,), fence_margin=5.0, reaction=0.5)
    v = Vec(20.0, 0.0, 0.0)
    found = turn(v, Vec(0.0, east, -50.0), v, 0.0, policy)
    assert (found.cause is Cause.NONE) == free
    assert (found.velocity == v) == free


def test_a_clip_whose_reason_changes_each_step_is_one_event() -> None:
    state, changes = SupervisorState(), 0
    fast, steep = Vec(25.0, 0.0, 0.0), Vec(2.0, 0.0, -5.0)
    policy = POLICY._replace(envelope=POLICY.envelope._replace(acceleration=0.0))
    for step in range(81):
        found = supervise(fast if step % 2 else steep, seen(now=10.0 + 0.05 * step), policy, state)
        assert found.action is Action.CLIP
        state, changes = found.state, changes + found.changed
    assert changes == 1
    for step in range(81, 121):  # the other reason alone, for two seconds: it is told, once
        found = supervise(fast, seen(now=10.0 + 0.05 * step), policy, state)
        state, changes = found.state, changes + found.changed
    assert (changes, state.cause) == (2, Cause.SPEED)


def test_layers_are_the_starting_heights_or_evenly_apart() -> None:
    assert layers((70.0, 10.0, 40.0), 20.0) == (70.0, 10.0, 40.0)
    assert layers((50.0, 30.0), 20.0) == (50.0, 30.0)
    assert layers((70.0, 30.0, 45.0), 20.0) == (30.0, 50.0, 70.0)
