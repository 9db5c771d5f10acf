"""What gusts make of the own way is taken out: the same decision over ground as in air that stands."""

from __future__ import annotations

from math import pi, radians

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.agent.core.to_place import own_state
from onboard.autopilot.base import Telemetry
from onboard.core.game.rules import NO_TARGET, Control, Rules
from onboard.core.game.views import PursuerView, Team, nearest_mate, pursuer_view, sighted
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import ZERO, Vec, add, angle_between, direction, distance, scale, unit
from onboard.core.strategy.own_air import drift
from onboard.core.strategy.pursuit import pursuer, pursuer_parallel
from onboard.core.strategy.registry import PURSUERS

SPEED = 40.0
WAYS = [("own-air", pursuer_parallel), ("paper-own-air", pursuer)]
angles = st.floats(-pi, pi)
gusts = st.builds(Vec, st.floats(-8.0, 8.0), st.floats(-8.0, 8.0), st.just(0.0))


def seen(place: Vec, nose: Vec, evader: Vec, moving: Vec, told: Vec) -> PursuerView:
    """A pursuer and an evader whose motions through the air around both, which moves, are known."""
    own = Vehicle(place, add(scale(nose, SPEED), moving), SPEED)
    quarry = Vehicle(ZERO, add(evader, moving), 50.0)
    sighting = sighted(quarry, unit(quarry.velocity, nose), 1.0)
    team = Team(nearest_mate(place, (place,), 0), (own,), 0, NO_TARGET, nose=told)
    return pursuer_view(own, FREE, sighting, team, Control(0.05), Rules(25.0, 88.0))


@settings(max_examples=200, deadline=None)
@given(angles, angles, angles, st.floats(200.0, 3000.0), gusts)
def test_a_gust_that_carries_both_leaves_the_way_through_it_as_it_is(
    bearing: float, nose: float, flown: float, far: float, moving: Vec
) -> None:
    """Over ground the vehicle goes as in still air and with the gust besides."""
    place, ahead = scale(direction(0.0, bearing), far), direction(0.0, nose)
    evader = scale(direction(0.0, flown), 50.0)
    for name, plain in WAYS:
        still = plain(seen(place, ahead, evader, ZERO, ZERO))
        blown = PURSUERS[name].decide(seen(place, ahead, evader, moving, ahead))
        assert blown.rule == still.rule
        over_ground = add(scale(still.direction, SPEED), moving)
        assert angle_between(blown.direction, unit(over_ground, ahead)) < 1e-6


def test_where_the_nose_is_not_known_nothing_is_taken_out() -> None:
    view = seen(Vec(0.0, 900.0, 0.0), direction(0.0, 1.0), Vec(50.0, 0.0, 0.0), Vec(5.0, -3.0, 0.0), ZERO)
    assert drift(view) == ZERO
    for name, plain in WAYS:
        assert PURSUERS[name].decide(view).direction == pytest.approx(plain(view).direction, abs=1e-12)


def test_the_nose_is_the_attitude_of_a_plane_while_it_is_fresh() -> None:
    flying = Telemetry(pitch=radians(10.0), yaw=radians(90.0), attitude_at=99.9, position_at=99.9)
    assert distance(own_state(100.0, flying, hovers=False).nose, direction(radians(10.0), pi / 2)) < 1e-12
    assert own_state(100.0, flying, hovers=True).nose == ZERO
    assert own_state(100.6, flying, hovers=False).nose == ZERO
