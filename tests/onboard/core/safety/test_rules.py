"""Each rule of the supervisor, as a flight story."""

from __future__ import annotations

from math import atan2, inf, nan

import pytest

from onboard.core.math.states import Mate
from onboard.core.math.vectors import ZERO, Vec, distance, norm
from onboard.core.safety.field_profile import field_policy
from onboard.core.safety.policy import Action, Cause, Command
from onboard.core.safety.supervisor import commanded, reordered
from onboard.core.safety.words import ACTIONS, CAUSES
from tests.support.paths import ROOT
from tests.support.supervised_vehicle import COPTER, PLANE, SupervisedVehicle

NORTH = Vec(4.0, 0.0, 0.0)


def copter(**policy: object) -> SupervisedVehicle:
    """A multicopter in the middle of a square fence, 30 m up, flying north at 4 m/s."""
    return SupervisedVehicle(COPTER._replace(**policy), Vec(0.0, 0.0, -30.0), NORTH)  # type: ignore[arg-type]


def plane() -> SupervisedVehicle:
    """A plane in the middle of its field, flying north."""
    return SupervisedVehicle(PLANE, Vec(0.0, 0.0, -150.0), Vec(20.0, 0.0, 0.0))


def test_a_decision_within_all_limits_passes_untouched() -> None:
    flight = copter()
    verdict = flight.fly(3.0, NORTH)
    assert (verdict.action, verdict.ground) == (Action.PASS, NORTH)
    assert flight.transitions == []


def test_a_decision_too_fast_is_clipped_to_the_greatest_speed() -> None:
    verdict = copter().fly(3.0, Vec(30.0, 40.0, 0.0))
    assert verdict.action == Action.CLIP
    assert verdict.cause == Cause.SPEED
    assert verdict.ground == pytest.approx((3.0, 4.0, 0.0))


def test_a_multicopter_climbs_no_faster_than_it_may() -> None:
    flight = copter()
    flight.step(Vec(0.0, 0.0, -4.5))
    verdict = flight.fly(1.5, Vec(0.0, 0.0, -4.5))
    assert verdict.cause == Cause.CLIMB
    assert verdict.ground.z == pytest.approx(-3.0)


def test_a_plane_told_to_climb_steeply_keeps_its_speed() -> None:
    flight = plane()
    verdict = flight.fly(3.0, Vec(0.0, 0.0, -20.0))
    assert verdict.air.z == pytest.approx(-4.0)
    assert norm(verdict.air) == pytest.approx(20.0)


def test_a_plane_never_goes_below_its_least_airspeed() -> None:
    verdict = plane().fly(5.0, Vec(2.0, 0.0, 0.0))
    assert norm(verdict.air) == pytest.approx(15.0)


def test_a_planes_demanded_course_turns_at_its_rate() -> None:
    flight = plane()
    verdict = flight.fly(1.0, Vec(-20.0, 0.1, 0.0))
    assert verdict.cause == Cause.TURN
    assert atan2(verdict.air.y, verdict.air.x) == pytest.approx(0.6 * 1.0, rel=0.06)


def test_a_multicopters_demand_changes_at_its_acceleration() -> None:
    flight = copter()
    verdict = flight.fly(0.5, Vec(-4.0, 0.0, 0.0))
    assert verdict.cause == Cause.ACCELERATION
    assert verdict.ground.x == pytest.approx(4.0 - 6.0 * 0.5)


def test_a_multicopter_stops_before_the_fence_and_slides_along_it() -> None:
    flight = copter()
    verdict = flight.fly(60.0, Vec(4.0, 1.0, 0.0))
    assert verdict.cause == Cause.FENCE_AHEAD
    assert 90.0 < flight.seen.position.x < 95.5
    assert verdict.ground.y == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize(
    ("climb", "height", "cause"), [(-3.0, 57.0, "CEILING_AHEAD"), (2.0, 13.0, "FLOOR_AHEAD")]
)
def test_floor_and_ceiling_are_not_reached(climb: float, height: float, cause: str) -> None:
    flight = copter()
    verdict = flight.fly(60.0, Vec(0.0, 0.0, climb))
    assert verdict.cause.name == cause
    assert -flight.seen.position.z == pytest.approx(height, abs=1.0)


def test_a_plane_turns_before_the_fence_and_stays_inside() -> None:
    flight = plane()
    farthest = 0.0
    for _ in range(120):
        flight.fly(1.0, Vec(25.0, 0.0, 0.0))
        farthest = max(farthest, flight.seen.position.x)
    assert ("CLIP", "FENCE_AHEAD") in flight.transitions
    assert 1200.0 < farthest < 1500.0


def test_outside_the_fence_the_way_leads_back_in() -> None:
    flight = SupervisedVehicle(COPTER, Vec(110.0, 0.0, -30.0))
    verdict = flight.step(NORTH)
    assert verdict.cause == Cause.OUTSIDE_FENCE
    flight.fly(15.0, ZERO)
    assert flight.seen.position.x < 100.0


def test_far_outside_the_fence_the_autopilot_flies_home_until_handed_back() -> None:
    flight = SupervisedVehicle(COPTER, Vec(140.0, 0.0, -30.0))
    assert flight.step(NORTH).action == Action.RETURN
    flight.seen = flight.seen._replace(position=Vec(0.0, 0.0, -30.0))
    assert flight.fly(10.0, NORTH).action == Action.RETURN
    flight.hand_back()
    assert flight.fly(0.1, NORTH).stream


def test_two_multicopters_that_fly_at_each_other_stay_apart() -> None:
    policy = COPTER._replace(separation=10.0)
    one = SupervisedVehicle(policy, Vec(-40.0, 0.0, -30.0), Vec(4.0, 0.0, 0.0))
    two = SupervisedVehicle(policy, Vec(40.0, 0.3, -30.0), Vec(-4.0, 0.0, 0.0))
    two.seen = two.seen._replace(id=3)
    least = inf
    for _ in range(600):
        a, b = one.seen, two.seen
        one.step(Vec(4.0, 0.0, 0.0), mates=(Mate(3, b.position, b.velocity, 0.05),))
        two.step(Vec(-4.0, 0.0, 0.0), mates=(Mate(2, a.position, a.velocity, 0.05),))
        least = min(least, distance(one.seen.position, two.seen.position))
    assert ("CLIP", "SEPARATION") in one.transitions
    assert least > 8.0


def test_a_quiet_team_mate_gets_twice_the_distance() -> None:
    flight = copter(separation=10.0)
    mate = Mate(3, Vec(60.0, 0.0, -30.0), ZERO, 5.0)
    for _ in range(600):
        flight.step(NORTH, mates=(mate,))
    assert 35.0 < flight.seen.position.x < 41.0


@pytest.mark.parametrize(
    ("fault", "action", "cause"),
    [
        ({"telemetry_age": 0.6}, Action.HOLD, Cause.TELEMETRY),
        ({"position": Vec(nan, 0.0, 0.0)}, Action.HOLD, Cause.TELEMETRY),
        ({"heartbeat_age": 2.1, "telemetry_age": 0.6}, Action.END, Cause.HEARTBEAT),
        ({"heartbeat_age": 6.1}, Action.END, Cause.HEARTBEAT),
        ({"strategy_age": 0.21}, Action.END, Cause.STRATEGY),
        ({"track_sigma": 101.0}, Action.HOLD, Cause.TRACKS),
        ({"track_sigma": nan}, Action.HOLD, Cause.TRACKS),
        ({"ground_age": 5.1}, Action.RETURN, Cause.GROUND_STATION),
        ({"clock_jump_age": 0.0}, Action.HOLD, Cause.CLOCK),
        ({"ekf_ok": False}, Action.END, Cause.EKF),
        ({"gps_fix": 2}, Action.END, Cause.GPS),
        ({"order": Action.HOLD}, Action.HOLD, Cause.ORDER),
        ({"order": Action.RETURN}, Action.RETURN, Cause.ORDER),
        ({"order": Action.LAND}, Action.LAND, Cause.ORDER),
    ],
)
def test_a_fault_takes_hold_at_once_and_leaves_a_second_after_it_is_gone(
    fault: dict[str, object], action: Action, cause: Cause
) -> None:
    flight = copter(ground_action=Action.RETURN)
    flight.fly(1.0, NORTH)
    good = flight.seen
    verdict = flight.step(NORTH, **fault)
    assert (verdict.action, verdict.cause, verdict.stream) == (action, cause, False)
    healthy = {key: getattr(good, key) for key in fault}
    assert flight.fly(0.9, NORTH, **healthy).action == action
    assert flight.fly(0.3, NORTH).stream
    assert flight.transitions[0] == (action.name, cause.name)
    flight.fly(4.0, NORTH)
    assert flight.transitions[-1] == ("PASS", "NONE")


def test_in_the_field_profile_a_silent_master_means_hold_and_after_a_minute_home_for_good() -> None:
    flight = copter(**field_policy(COPTER, 30.0)._asdict())
    assert flight.fly(1.0, NORTH, ground_age=4.9).stream
    verdict = flight.fly(1.0, NORTH, ground_age=5.1)
    assert (verdict.action, verdict.cause) == (Action.HOLD, Cause.GROUND_STATION)
    assert flight.fly(2.0, NORTH, ground_age=0.1).stream  # it was heard again in time
    verdict = flight.fly(1.0, NORTH, ground_age=59.9)
    assert verdict.action is Action.HOLD
    verdict = flight.fly(1.0, NORTH, ground_age=60.1)
    assert (verdict.action, verdict.command) == (Action.RETURN, Command.RELEASE_TO_RETURN)
    assert flight.fly(3.0, NORTH, ground_age=0.1).action is Action.RETURN  # until somebody gives it back
    flight.hand_back()
    assert flight.fly(3.0, NORTH).stream
    assert copter().fly(1.0, NORTH, ground_age=1e9).stream  # elsewhere nobody asked for it


def test_a_decision_that_is_not_a_number_holds() -> None:
    flight = copter()
    verdict = flight.step(Vec(nan, 0.0, inf))
    assert (verdict.action, verdict.cause, verdict.ground) == (Action.HOLD, Cause.NOT_FINITE, ZERO)


def test_a_low_battery_sends_home_for_good() -> None:
    flight = copter()
    flight.fly(1.0, NORTH, battery=0.5)
    assert flight.step(NORTH, battery=0.19).cause == Cause.BATTERY
    assert flight.fly(10.0, NORTH, battery=0.25).action == Action.RETURN


def test_when_a_pilot_takes_over_hands_go_off_until_he_hands_back() -> None:
    flight = copter()
    flight.fly(1.0, NORTH)
    assert flight.step(NORTH, pilot=True).action == Action.END
    verdict = flight.fly(30.0, NORTH, pilot=False)
    assert (verdict.action, verdict.cause) == (Action.END, Cause.PILOT)
    flight.hand_back()
    assert flight.step(NORTH).stream


def test_a_graver_fault_on_top_and_gone_again_leaves_the_latched_one_in_force() -> None:
    flight = copter()
    flight.step(NORTH, battery=0.1)
    assert flight.step(NORTH, heartbeat_age=3.0).action == Action.RETURN
    assert flight.step(NORTH, heartbeat_age=7.0).action == Action.END
    verdict = flight.fly(2.0, NORTH, heartbeat_age=0.1, battery=0.9)
    assert (verdict.action, verdict.cause) == (Action.RETURN, Cause.BATTERY)


def test_in_the_field_profile_a_vehicle_climbs_to_its_layer_and_stays_there() -> None:
    flight = copter(layered=True, layer=50.0)
    flight.fly(20.0, Vec(1.0, 0.0, 2.0))
    assert -flight.seen.position.z == pytest.approx(50.0, abs=0.5)
    assert flight.transitions[0] == ("CLIP", "LAYER")


def test_in_the_field_profile_who_loses_the_tracks_breaks_off_for_good() -> None:
    flight = copter(track_latched=True)
    flight.step(NORTH, track_sigma=500.0)
    assert flight.fly(20.0, NORTH, track_sigma=1.0).cause == Cause.TRACKS


def test_every_action_and_cause_has_its_words() -> None:
    assert set(ACTIONS) == set(Action)
    assert set(CAUSES) == set(Cause)
    assert len(set(CAUSES.values())) == len(Cause)


def test_the_document_names_every_cause() -> None:
    page = (ROOT / "docs" / "safety.md").read_text(encoding="utf-8")
    rows = {line.split("|")[1].strip() for line in page.splitlines() if line.startswith("|")}
    assert {cause.name for cause in Cause if cause != Cause.NONE} <= rows


@pytest.mark.parametrize(
    ("action", "cause", "order", "copter_does", "plane_does"),
    [
        (Action.HOLD, Cause.TRACKS, Action.PASS, Command.HOVER, Command.RELEASE_TO_HOLD),
        (Action.HOLD, Cause.ORDER, Action.HOLD, Command.RELEASE_TO_HOLD, Command.RELEASE_TO_HOLD),
        (Action.RETURN, Cause.BATTERY, Action.HOLD, Command.RELEASE_TO_RETURN, Command.RELEASE_TO_RETURN),
        (Action.LAND, Cause.ORDER, Action.LAND, Command.RELEASE_TO_LAND, Command.RELEASE_TO_LAND),
        (Action.END, Cause.EKF, Action.PASS, Command.END_STREAM, Command.RELEASE_TO_HOLD),
        (Action.END, Cause.EKF, Action.LAND, Command.RELEASE_TO_LAND, Command.RELEASE_TO_LAND),
        (Action.END, Cause.PILOT, Action.LAND, Command.HANDS_OFF, Command.HANDS_OFF),
    ],
)
def test_what_the_adapter_is_commanded_where_no_decision_goes_out(
    action: Action, cause: Cause, order: Action, copter_does: Command, plane_does: Command
) -> None:
    assert commanded(action, cause, order, hovers=True) is copter_does
    assert commanded(action, cause, order, hovers=False) is plane_does


def test_a_milder_order_that_follows_a_graver_one_counts_at_once() -> None:
    flight = copter()
    assert flight.step(NORTH, order=Action.LAND).command is Command.RELEASE_TO_LAND
    flight.state = reordered(flight.state)
    assert flight.step(NORTH, order=Action.HOLD).command is Command.RELEASE_TO_HOLD
