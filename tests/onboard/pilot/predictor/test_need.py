"""Training follows need: a manoeuvre brings it about, steady flight does not."""

from __future__ import annotations

from math import cos, sin

import numpy as np
import pytest

from onboard.core.math.vectors import Vec
from onboard.pilot.predictor import TrackPredictor, Trainer
from onboard.pilot.predictor.calibration import Off
from onboard.pilot.predictor.need import FALLING, RISING, Need

VARIANCE = (0.25, 0.25, 0.25, -1.0, -1.0, -1.0)


class Flight:
    """A target at 15 m/s, seen at 10 Hz with 0.5 m of noise, turning at a rate [rad/s] that may change."""

    def __init__(self, seed: int) -> None:
        self.track, self.trainer = TrackPredictor(seed), Trainer()
        self._rng = np.random.default_rng(seed)
        self._north = self._east = self._heading = self.t = 0.0

    def fly(self, seconds: float, rate: float = 0.0) -> list[float]:
        """Instants at which a training began [s]."""
        begun = []
        for _ in range(round(10.0 * seconds)):
            self.t += 0.1
            self._heading += 0.1 * rate
            self._north += 1.5 * cos(self._heading)
            self._east += 1.5 * sin(self._heading)
            n, e, d = self._rng.normal(0.0, 0.5, 3).tolist()
            self.track.add(self.t, Vec(self._north + n, self._east + e, d - 50.0), None, VARIANCE)
            before = self.track.trainings
            self.trainer.advance(self.t, {1: self.track}, 2)
            begun += [self.t] * (self.track.trainings - before)
        return begun


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_manoeuvre_asks_for_training_and_a_straight_flight_does_not(seed: int) -> None:
    flight = Flight(seed)
    growing = flight.fly(45.0)
    assert 4 <= len(growing) <= 7  # each learns from twice as much
    assert flight.fly(80.0) == []
    since = flight.t
    turning = flight.fly(12.0, 0.6)
    assert turning[0] - since < 6.0
    assert len(turning) >= 2  # and it goes on while the model is off
    flight.fly(60.0, 0.6)
    assert flight.fly(40.0, 0.6) == []  # the circle is known now


def offs(times: float, since: int, count: int) -> list[Off]:
    return [Off(0, since + k, times) for k in range(count)]


def test_it_asks_above_one_bound_and_until_below_another() -> None:
    need = Need((1,), (8, 30))
    assert need.asks(8, 200)
    need.trained(200, 1000)
    assert not need.asks(200, 200)
    between = 0.5 * (RISING + FALLING)
    need.hear(offs(between, 1000, 60))
    assert not need.asks(200, 200)
    need.hear(offs(1.05 * RISING, 1060, 60))
    assert need.asks(200, 200)
    need.hear(offs(between, 1120, 60))
    assert need.asks(200, 200)
    need.hear(offs(0.95 * FALLING, 1180, 60))
    assert not need.asks(200, 200)


def test_what_a_forerunner_said_is_not_held_against_a_model() -> None:
    need = Need((1,), (8, 30))
    need.trained(200, 1000)
    need.hear(offs(100.0, 900, 90))
    assert not need.asks(200, 200)


def test_errors_far_below_the_stated_ones_ask_as_well() -> None:
    need = Need((1, 5), (8, 30))
    need.trained(200, 0)
    need.hear([Off(i, k, 0.1) for k in range(60) for i in (0, 1)])
    assert need.asks(200, 200)


def test_a_grid_that_doubled_or_began_anew_or_reached_another_method_asks() -> None:
    need = Need((1,), (8, 30))
    for learnt, steps in ((60, (60, 119, 120)), (190, (190, 199, 200)), (20, (20, 29, 30))):
        need.trained(learnt, 0)
        assert [need.asks(points, 200) for points in steps] == [False, False, True]
    assert need.asks(10, 200)  # shorter than what was learnt from: a silence made it begin anew
