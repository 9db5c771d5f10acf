"""Slots of planes: the way there, turns and wind counted, takes just the time that there is."""

from __future__ import annotations

from math import cos, pi, radians, sin

import pytest

from onboard.core.game.rules import Rules, Target
from onboard.core.geometry.lead import lead
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, distance, yaw_of
from onboard.core.route.arrival import Pose, arrive
from onboard.core.strategy.team.parts import setting_out
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Situation
from onboard.core.strategy.team.ring import laid
from onboard.core.strategy.team.timed import LAST, WIDER, timed_swing

TURN, SPEED = radians(4.5), 40.0
CALM = ZERO


def place(bearing: float, out: float, down: float) -> Vec:
    return Vec(out * cos(bearing), out * sin(bearing), down)


def situation(seconds: float, wind: Vec) -> Situation:
    """Five aircraft 2.5 km north to east of an evader that stays about its place and then flies north."""
    limits = VehicleLimits(32.0, SPEED, radians(-20.0), radians(20.0), turn_rate=TURN)
    evader = Vehicle(Vec(0.0, 0.0, -1500.0), Vec(50.0, 0.0, 0.0), 50.0)
    team = tuple(
        Member(
            Vehicle(
                Vec(2500 * cos(b), 2500 * sin(b), -1500.0), Vec(-SPEED * cos(b), -SPEED * sin(b), 0.0), SPEED
            ),
            limits,
            True,
        )
        for b in (-1.2, -0.9, 0.8, 1.3, 2.1)
    )
    return Situation(
        0.0, seconds, evader, limits, team, Target(True, Vec(6000.0, 0.0, -1500.0)), wind,
        Rules(25.0, 88.0, separation=100.0), Heights(), Margin(), evader.position, 1500.0,
    )  # fmt: skip


@pytest.mark.parametrize("wind", [CALM, Vec(4.0, -6.0, 0.0)])
def test_the_way_to_a_slot_takes_the_time_that_there_is(wind: Vec) -> None:
    seconds = 120.0
    s = situation(seconds, wind)
    slots = laid(s)
    assert not any(slots.late)
    for member, aim in zip(s.team, slots.aims, strict=True):
        assert distance(aim, s.expected) >= s.nearest - 1e-6
        own = member.vehicle
        nose = yaw_of(lead(aim, SPEED, s.expected, setting_out(s)))
        goal = Pose(
            aim.x - own.position.x - wind.x * seconds, aim.y - own.position.y - wind.y * seconds, nose
        )
        start = Pose(0.0, 0.0, yaw_of(own.velocity))
        way = arrive(start, goal, WIDER * SPEED / TURN, SPEED * seconds, LAST * SPEED)
        assert (
            way.exact or SPEED * seconds - 0.25 * SPEED * seconds <= way.path.length <= SPEED * seconds + 1.0
        )


def test_more_time_reaches_more_bearings_and_too_little_none() -> None:
    spans = []
    for seconds in (10.0, 120.0, 240.0):
        s = situation(seconds, CALM)
        swung = timed_swing(s.team[0], s, -1.2)
        spans.append(swung.high - swung.low)
        assert swung.late == (seconds == 10.0)
    assert spans == sorted(spans)
    assert spans[0] == 0.0
    assert spans[-1] == pytest.approx(2.0 * pi, abs=0.2)
