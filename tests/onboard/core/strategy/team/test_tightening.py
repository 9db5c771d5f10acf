"""A closed ring tightens by parallel pursuit: every overlap stays positive until the evader is captured.

The referee is the band of the plan, asked at every step. In simple motion, and with aircraft that turn.
"""

from __future__ import annotations

from math import asin, cos, degrees, inf, pi, radians, sin
from typing import NamedTuple

import numpy as np
import pytest

from onboard.core.game.rules import NO_TARGET, Rules
from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, along, distance, yaw_of
from onboard.core.strategy.team.closure import way_out
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Situation

FLAT = VehicleLimits(pitch_min=0.0, pitch_max=0.0)
DT = 0.25


class Told(NamedTuple):
    """How a ring tightened."""

    captured: bool
    widest: float  # [deg] of the widest way out ever; negative: the smallest overlap


def unit(course: float) -> Vec:
    return Vec(cos(course), sin(course), 0.0)


def tightened(
    n: int, far: float, speeds: tuple[float, float], courses: list[float], turn: float = inf
) -> Told:
    """A ring of n at `far` [m] against an evader that wants the courses one after the other, one a second.

    `speeds` are the evader's and the pursuers' [m/s]; `turn` [rad/s] is what all can turn. R is far / 100.
    """
    fast, slow = speeds
    e, course = ZERO, courses[0]
    places = [along(ZERO, unit(2.0 * pi * k / n), far) for k in range(n)]
    first = Vec(fast * cos(course), fast * sin(course), 0.0)
    noses = [yaw_of(lead(place, slow, e, first)) for place in places]
    rules = Rules(far / 100.0, far / 50.0, planar=True)
    widest = -inf
    for step in range(round(4.0 * far / slow / DT)):
        wanted = courses[min(int(step * DT), len(courses) - 1)]
        course += max(-turn * DT, min(turn * DT, wrap(wanted - course)))
        v = Vec(fast * cos(course), fast * sin(course), 0.0)
        team = tuple(Member(Vehicle(place, ZERO, slow), FLAT, True) for place in places)
        evader = Vehicle(e, v, fast)
        s = Situation(0.0, 0.0, evader, FLAT, team, NO_TARGET, ZERO, rules, Heights(), Margin(), e, far / 5.0)
        widest = max(widest, degrees(way_out(s).gap))
        for k, place in enumerate(places):
            off = wrap(yaw_of(lead(place, slow, e, v)) - noses[k])
            noses[k] += max(-turn * DT, min(turn * DT, off))
            places[k] = along(place, unit(noses[k]), slow * DT)
        e = along(e, v, DT)
        if min(distance(place, e) for place in places) <= rules.R:
            return Told(True, widest)
    return Told(False, widest)


@pytest.mark.parametrize("n", [4, 5, 6])
def test_every_overlap_stays_positive_until_capture(n: int) -> None:
    rng = np.random.default_rng(n)
    flights = [[2.0 * pi * k / 5.0] for k in range(5)]
    flights += [[0.3 + rate * t for t in range(200)] for rate in (0.02, 0.1, 0.5)]
    flights += [np.cumsum(rng.normal(0.0, 0.5, 200)).tolist() for _ in range(3)]
    at_first = degrees(2.0 * pi / n - 2.0 * asin(0.8) - 2.0 * asin(0.01))
    for courses in flights:
        told = tightened(n, 200.0, (5.0, 4.0), courses)
        assert told.captured
        assert told.widest < min(-2.0, at_first + 13.0)


def test_one_too_few_is_open_from_the_beginning_and_does_not_close() -> None:
    told = tightened(3, 200.0, (5.0, 4.0), [pi])
    assert not told.captured
    assert told.widest > 30.0


@pytest.mark.parametrize("n", [5, 6])
def test_aircraft_tighten_a_wide_ring_on_an_evader_that_flies_on(n: int) -> None:
    """4.5 deg/s at 50 against 40 m/s, circles of 509 m.

    An evader that turns by 57° on its way opens a ring of six: at equal turn rates nothing answers that.
    """
    rate = radians(4.5)
    for courses in ([0.0], [0.2], [pi / n]):
        told = tightened(n, 2500.0, (50.0, 40.0), courses, rate)
        assert told.captured
        assert told.widest < -20.0
    assert tightened(6, 2500.0, (50.0, 40.0), [0.0] * 8 + [1.0], rate).widest > 0.0
