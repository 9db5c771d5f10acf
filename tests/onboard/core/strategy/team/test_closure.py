"""Whether a ring is closed, against flights tried out one by one: no formula of cones is shared."""

from __future__ import annotations

from math import acos, asin, cos, degrees, inf, pi, radians, sin

import numpy as np
import pytest
from numpy.typing import NDArray

from onboard.core.game.rules import Rules, Target
from onboard.core.geometry.cones import Cone
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.team.closure import least_number, sight_cone, way_out, way_out_at
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Situation

SPEED = 50.0
STEP = 2.0  # [deg]
HEADINGS = np.radians(np.arange(0.0, 360.0, STEP))
TIMES = np.r_[0.0, np.geomspace(0.5, 900.0, 300)]


def situation(
    places: list[tuple[float, float, float]],
    speed: float,
    pitch: float,
    heights: Heights = Heights(),  # noqa: B008
    margin: Margin = Margin(),  # noqa: B008
) -> Situation:
    """An evader at 1500 m that turns at once, and pursuers at places relative to it [m; up] that do."""
    limits = VehicleLimits(pitch_min=-pitch, pitch_max=pitch)
    evader = Vehicle(Vec(0.0, 0.0, -1500.0), Vec(SPEED, 0.0, 0.0), SPEED)
    team = tuple(
        Member(Vehicle(Vec(x, y, -1500.0 - up), Vec(speed, 0.0, 0.0), speed), VehicleLimits(), True)
        for x, y, up in places
    )
    rules = Rules(25.0, 88.0, planar=pitch == 0.0)
    target = Target(False, ZERO)
    return Situation(
        0.0, 0.0, evader, limits, team, target, ZERO, rules, heights, margin, evader.position, 880.0
    )


def escapes(s: Situation, pitch: float) -> NDArray[np.bool_]:
    """For each heading tried: whether straight flight at a pitch is met by nobody at any time tried."""
    free = np.ones(len(HEADINGS), bool)
    u = np.stack(
        [np.cos(HEADINGS) * cos(pitch), np.sin(HEADINGS) * cos(pitch), np.full(len(HEADINGS), -sin(pitch))], 1
    )
    e = np.array(s.evader.position)
    for member in s.team:
        p = np.array(member.vehicle.position)
        away = np.linalg.norm(e + SPEED * TIMES[None, :, None] * u[:, None, :] - p, axis=2)
        free &= ~(away <= member.vehicle.speed * TIMES + s.rules.R).any(axis=1)
    return free


def widest(free: NDArray[np.bool_]) -> float:
    """Degrees of the longest run of free headings, round the circle."""
    if free.all():
        return 360.0
    longest = run = 0
    for one in np.r_[free, free]:
        run = run + 1 if one else 0
        longest = max(longest, run)
    return longest * STEP


@pytest.mark.parametrize("pitch_deg", [0.0, 20.8])
@pytest.mark.parametrize("pursuers", [3, 4, 5, 6])
def test_closed_and_open_bands_as_flights_find_them(pursuers: int, pitch_deg: float) -> None:
    rng = np.random.default_rng([pursuers, int(pitch_deg)])
    pitch = radians(pitch_deg)
    seen = set()
    for trial in range(6):
        phase = rng.uniform(0.0, 2.0 * pi)
        angles = (
            phase
            + 2.0 * pi * np.arange(pursuers) / pursuers
            + rng.normal(0.0, 0.02 if trial % 2 else 0.6, pursuers)
        )
        far = rng.uniform(500.0, 3000.0, pursuers)
        up = rng.uniform(-0.1, 0.1, pursuers) * far if pitch > 0.0 else np.zeros(pursuers)
        places = [(r * cos(a), r * sin(a), h) for r, a, h in zip(far, angles, up, strict=True)]
        s = situation(places, 40.0, pitch)
        pitches = np.linspace(-pitch, pitch, 5) if pitch else [0.0]
        found = max(widest(escapes(s, float(one))) for one in pitches)
        way = way_out(s)
        if abs(degrees(way.gap)) > 4.0:
            assert way.closed == (found == 0), (places, way, found)
            seen.add(way.closed)
        if not way.closed:
            assert degrees(way.gap) == pytest.approx(found, abs=4.0)
    assert seen == ({False} if pursuers == 3 else {True, False})


def test_the_widest_way_out_is_the_same_whichever_way_the_ring_is_turned() -> None:
    """Random cones of random widths, some within others, turned about: over north, over south, anywhere."""
    rng = np.random.default_rng(1)
    for _ in range(400):
        middles = rng.uniform(-pi, pi, rng.integers(1, 7))
        halves = rng.uniform(0.02, 1.2, len(middles))
        for turn in (0.0, pi - middles[0], float(rng.uniform(-pi, pi))):
            yaws = middles + turn
            cones = tuple(
                Cone(Vec(cos(yaw), sin(yaw), 0.0), cos(half), sin(half))
                for yaw, half in zip(yaws, halves, strict=True)
            )
            fine = np.radians(np.arange(0.0, 360.0, 0.1))
            off = np.abs((fine[:, None] - yaws + pi) % (2.0 * pi) - pi)
            free = (off > halves).all(axis=1)
            found = way_out_at(cones, 0.0)
            longest = run = 0
            for one in np.r_[free, free]:
                run = run + 1 if one else 0
                longest = max(longest, run)
            if free.any():
                assert degrees(found.gap) == pytest.approx(0.1 * min(longest, len(fine)), abs=0.25)
                away = np.abs((found.bearing - yaws + pi) % (2.0 * pi) - pi)
                assert (away > halves).all()  # its middle is free
            else:
                assert found.gap <= radians(0.25)


def test_the_gap_of_neighbours_is_the_formula_of_the_band() -> None:
    """G = 2 acos(cos(asin γ) / cos θ): 100.1° at γ = 0.8 and θ = 20.8°; four level pursuers suffice."""
    half = sight_cone(0.8, radians(20.8))
    assert 2.0 * degrees(half) == pytest.approx(2.0 * degrees(acos(0.6 / cos(radians(20.8)))), abs=1e-9)
    assert 2.0 * degrees(half) == pytest.approx(100.1, abs=0.1)
    assert least_number(0.8, radians(20.8)) == 4


@pytest.mark.parametrize("gamma", [0.2, 0.5, 0.6, 0.8, 0.95])
def test_the_least_number_in_the_plane_closes_and_one_less_never_does(gamma: float) -> None:
    n = least_number(gamma, 0.0)
    assert n == int(np.ceil(pi / asin(gamma) - 1e-9))
    for count, closes in ((n, True), (n - 1, False)):
        if count < 1:
            continue
        angles = [2.0 * pi * k / count for k in range(count)]
        places = [(1e6 * cos(a), 1e6 * sin(a), 0.0) for a in angles]
        assert way_out(situation(places, gamma * SPEED, 0.0)).closed == closes
    assert least_number(0.3, radians(20.8)) == 0  # asin 0.3 = 17.5° never covers ±20.8°
    assert least_number(1.0, 1.0) == 1


def test_floor_and_ceiling_narrow_the_band_of_a_far_ring() -> None:
    """Three at 6 km cannot close ±20.8°, but the evader cannot climb 20° for 10 km under a ceiling."""
    places = [(6000.0 * cos(a), 6000.0 * sin(a), 0.0) for a in (0.0, 2.0 * pi / 3, -2.0 * pi / 3)]
    free = way_out(situation(places, 44.0, radians(20.8)))
    low = way_out(situation(places, 44.0, radians(20.8), Heights(1300.0, 1700.0)))
    assert not free.closed
    assert low.closed
    assert low.gap < free.gap


def test_delay_and_noise_take_their_share_of_the_overlap() -> None:
    places = [(2000.0 * cos(a), 2000.0 * sin(a), 0.0) for a in (0.0, pi / 2, pi, -pi / 2)]
    sure = way_out(situation(places, 40.0, radians(20.8)))
    wary = way_out(situation(places, 40.0, radians(20.8), margin=Margin(0.5, 20.0)))
    assert sure.closed
    assert wary.gap > sure.gap
    # 0.5 s at 40 m/s and 2 σ of 20 m are 60 m, of a reach of 25 m at 2 km: 60 / 2000 rad for each of two.
    assert wary.gap - sure.gap == pytest.approx(2 * 60.0 / 2000.0, rel=0.3)
    assert way_out(situation(places, 40.0, radians(20.8), margin=Margin(9.0, 0.0))).closed is False


def test_a_faster_pursuer_closes_everything_and_nobody_closes_nothing() -> None:
    assert way_out(situation([(3000.0, 0.0, 0.0)], 60.0, radians(20.0))).closed
    alone = situation([(3000.0, 0.0, 0.0)], 40.0, radians(20.0))
    nobody = alone._replace(team=tuple(m._replace(fit=False) for m in alone.team))
    assert not way_out(nobody).closed
    assert way_out(nobody).gap == pytest.approx(2.0 * pi)
    assert way_out(alone).gap < inf
