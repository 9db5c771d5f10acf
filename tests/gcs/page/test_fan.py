"""The fan of the evader's track against where the evader then is."""

from __future__ import annotations

import json
from itertools import pairwise
from math import cos, hypot, inf, sin

import numpy as np
import pytest

from gcs.page.fan import MARKS_S, Fan, Fans
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec, distance
from onboard.wire.bus.messages import Track
from tests.support.sample_messages import START_NS, Tower, setup, track

SPEED, SIGMA = 15.0, 1.0


def turning(t: float, rate: float) -> Vec:
    """Where somebody is who flies a level circle, and climbs 1 m/s: by hand."""
    return Vec(SPEED / rate * sin(rate * t), SPEED / rate * (1.0 - cos(rate * t)), -50.0 - t)


def sight(t: float, rate: float, rng: np.random.Generator) -> Track:
    """A sensor's sight of it at `t` [s]."""
    place = Vec(*(np.array(turning(t, rate)) + rng.normal(0.0, SIGMA, 3)).tolist())
    moving = (SPEED * cos(rate * t), SPEED * sin(rate * t), -1.0)
    noisy = tuple((np.array(moving) + rng.normal(0.0, 0.5, 3)).tolist())
    variance = (SIGMA**2,) * 3 + (0.25,) * 3
    return Track(1, START_NS + round(t * NS_PER_S), tuple(place), noisy, variance, "radar")


@pytest.mark.parametrize("rate", [-0.25, 0.15])
def test_it_bends_with_the_turn_and_its_rings_hold_the_truth(rate: float) -> None:
    rng, fan = np.random.default_rng(7), Fan()
    bent, straight, inside = [], [], []
    for i in range(200):
        t = 0.1 * i
        seen = sight(t, rate, rng)
        fan.take(seen)
        if i < 50:
            continue
        rows = {row[0]: row for row in fan.rows()}
        for after in MARKS_S:
            _, *place, sigma = rows[after]
            there = turning(t + after, rate)
            off = distance(Vec(*place), there)
            inside.append(off <= 2.0 * sigma)
            if after == MARKS_S[-1]:
                bent.append(off)
                on = Vec(*(np.array(seen.position) + after * np.array(seen.velocity)).tolist())
                straight.append(distance(on, there))
    assert np.mean(bent) < 0.5 * np.mean(straight)
    assert np.mean(inside) > 0.9


def test_a_jump_in_time_begins_anew_and_the_same_measurement_again_changes_nothing() -> None:
    rng, fan = np.random.default_rng(7), Fan()
    for i in range(60):
        fan.take(sight(0.1 * i, 0.2, rng))
    before = fan.rows()
    fan.take(sight(5.9, 0.2, rng))  # of the same instant
    assert fan.rows() == before
    for back in (1.0, 40.0):
        seen = sight(back, 0.2, rng)
        fan.take(seen)
        place = fan.rows()[0][1:4]
        assert place == pytest.approx(seen.position, abs=1e-6)
        ways = [row[1:3] for row in fan.rows()]
        angle = [np.arctan2(b[1] - a[1], b[0] - a[0]) for a, b in pairwise(ways)]
        assert np.ptp(np.unwrap(angle)) < 1e-4  # one measurement tells of no turn
    assert not Fan().rows()


def test_only_evaders_have_one_and_it_goes_with_the_track() -> None:
    tower, fans = Tower(), Fans()
    tower.hear(setup(), track(1), track(9))
    fans.take(tower.picture)
    told = fans.document()
    assert [fan["id"] for fan in told["fans"]] == [1]  # type: ignore[attr-defined]
    tower.hear(track(1, START_NS + NS_PER_S // 10, covariance=(inf,) * 6))
    fans.take(tower.picture)
    json.dumps(fans.document(), allow_nan=False)
    tower.wait(5.0)
    fans.take(tower.picture)
    assert fans.document()["fans"] == []


def test_its_rings_grow() -> None:
    rng, fan = np.random.default_rng(3), Fan()
    for i in range(30):
        fan.take(sight(0.1 * i, 0.1, rng))
    sigmas = [row[4] for row in fan.rows()]
    assert all(b > a for a, b in pairwise(sigmas))
    ways = np.diff([row[1:3] for row in fan.rows()], axis=0)
    assert [hypot(*way) for way in ways] == pytest.approx([SPEED * 0.5] * len(ways), rel=0.1)
