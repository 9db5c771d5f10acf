"""On flights that nothing was tuned on: no family is served badly, and the stated errors hold on each."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.math.vectors import Vec, distance
from onboard.pilot.predictor import TrackPredictor, Trainer
from onboard.pilot.predictor.model import ModelSettings
from tests.benchmarks.predictor.by_family import ALL, follow


@pytest.mark.long
@pytest.mark.timeout(900)
@pytest.mark.parametrize("family", ALL)
def test_stated_errors_hold(family: str) -> None:
    flown = [follow(ModelSettings(), family, seed) for seed in range(3000, 3006)]
    errors = np.concatenate([one.whole for one in flown])
    stated = np.concatenate([one.stated for one in flown])
    one, two = ((errors <= k * stated).mean(axis=0) for k in (1, 2))
    assert one.min() > 0.62, one  # 68 % of six flights, whose long forecasts are some twenty independent ones
    assert one.max() < 0.95, one
    assert two.min() > 0.92, two


@pytest.mark.long
def test_the_manoeuvre_filter_helps_where_targets_turn() -> None:
    ways = (ModelSettings(), ModelSettings(manoeuvres=False))
    seeds = range(3000, 3004)
    with_it, without = (
        np.mean([follow(way, "turns", seed).errors.mean(axis=0) for seed in seeds], axis=0) for way in ways
    )
    assert (with_it[:4] < 0.98 * without[:4]).all(), with_it / without


@pytest.mark.parametrize("rate", [1.0, 10.0])
@pytest.mark.parametrize("measured", [False, True])
def test_a_fix_told_again_under_new_stamps_is_no_measurement(rate: float, measured: bool) -> None:
    """A receiver of ADS-B repeats the last place of an aircraft at 60 m/s until it hears a new one."""
    track, trainer = TrackPredictor(1), Trainer()
    velocity = Vec(60.0, 0.0, 0.0) if measured else None
    variance = (900.0,) * 3 + ((4.0,) * 3 if measured else (-1.0,) * 3)
    worst = 0.0
    for k in range(int(90 * rate)):
        t = k / rate
        track.add(t, Vec(60.0 * (t // 3.0) * 3.0, 0.0, -100.0), velocity, variance)
        trainer.advance(t, {1: track}, 2)
        if t > 45.0:
            said = track.predict(t + 1.0)
            off = distance(said.position, Vec(60.0 * (t + 1.0), 0.0, -100.0))
            assert off <= max(2.0 * said.sigma, 1.0)
            worst = max(worst, off)
    assert worst < 15.0
