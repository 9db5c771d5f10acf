"""The simulated sensor: what it is told to be, it is; measured, not believed."""

from __future__ import annotations

from collections import Counter
from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.core.math.vectors import Vec
from onboard.game.scenario import SensorSpec
from onboard.wire.bus import topics
from onboard.wire.bus.messages import Track
from sim_bridge.vehicle.motion import Motion
from sim_bridge.world.sensor import Sensor

MS = 1_000_000
START_NS = 1_767_225_600_000_000_000


def at(t: float) -> Motion:
    """A vehicle that flies north at 50 m/s."""
    return Motion(Vec(50.0 * t, 10.0, -300.0), Vec(50.0, 0.0, 0.0), 50.0, 0.0, 0.0, 0.0)


def watch(
    spec: SensorSpec, seconds: float, ids: tuple[int, ...] = (1, 2), seed: int = 7
) -> list[tuple[int, Track]]:
    """Every track with the instant at which it was published [ns since the start]."""
    sensor = Sensor(spec, ids, seed)
    seen = []
    for tick in range(round(seconds * 100) + 1):
        motions = {id: at(tick / 100) for id in ids}
        seen += [(tick * 10 * MS, track) for track in sensor.step(START_NS + tick * 10 * MS, motions)]
    return seen


def test_a_perfect_sensor_reports_the_truth_at_its_rate() -> None:
    seen = watch(SensorSpec(rate_hz=10), 2.0)
    for id in (1, 2):
        tracks = [(when, track) for when, track in seen if track.id == id]
        assert [when for when, _ in tracks] == [100 * MS * n for n in range(21)]
        for when, track in tracks:
            assert track.stamp_ns == START_NS + when
            assert track.position == pytest.approx(at(when * 1e-9).position)
            assert track.velocity == (50.0, 0.0, 0.0)


def test_noise_has_the_stated_size_and_says_so() -> None:
    seen = watch(SensorSpec(rate_hz=100, sigma=3.0, sigma_velocity=0.5), 50.0)
    position = np.array([np.subtract(t.position, at(when * 1e-9).position) for when, t in seen])  # (n, 3)
    velocity = np.array([np.subtract(t.velocity, (50.0, 0.0, 0.0)) for _, t in seen])  # (n, 3)
    n = len(seen)
    assert position.std(axis=0) == pytest.approx([3.0] * 3, rel=4 / sqrt(2 * n))
    assert velocity.std(axis=0) == pytest.approx([0.5] * 3, rel=4 / sqrt(2 * n))
    assert np.abs(position.mean(axis=0)).max() < 4 * 3.0 / sqrt(n)
    assert seen[0][1].covariance == (9.0, 9.0, 9.0, 0.25, 0.25, 0.25)


def test_a_late_sensor_stamps_the_instant_of_the_measurement() -> None:
    seen = watch(SensorSpec(rate_hz=10, delay_s=0.25), 2.0, ids=(1,))
    assert seen[0][0] == 250 * MS
    for when, track in seen:
        assert track.stamp_ns == START_NS + when - 250 * MS
        assert track.position[0] == pytest.approx(50.0 * (when * 1e-9 - 0.25))


def test_drop_outs_take_their_share_and_leave_the_rest_as_it_was() -> None:
    whole = {(t.id, t.stamp_ns): t for _, t in watch(SensorSpec(rate_hz=50, sigma=2.0), 40.0)}
    left = {(t.id, t.stamp_ns): t for _, t in watch(SensorSpec(rate_hz=50, sigma=2.0, dropout=0.3), 40.0)}
    share = 1 - len(left) / len(whole)
    assert abs(share - 0.3) < 5 * sqrt(0.3 * 0.7 / len(whole))
    assert all(whole[key] == track for key, track in left.items())


@given(st.floats(0.5, 100.0), st.floats(0.0, 1.0), st.floats(0.0, 0.9), st.integers(0, 2**32))
@settings(max_examples=25, deadline=None)
def test_the_seed_decides_and_tracks_pass_the_wire(
    rate: float, delay: float, dropout: float, seed: int
) -> None:
    spec = SensorSpec(rate_hz=rate, sigma=1.0, delay_s=delay, dropout=dropout)
    once = watch(spec, 3.0, seed=seed)
    assert once == watch(spec, 3.0, seed=seed)
    for _, track in once:
        assert topics.TRACK.decode(topics.TRACK.encode(track), Counter()) == track


def test_another_vehicle_in_the_game_does_not_change_the_noise_of_the_first() -> None:
    spec = SensorSpec(sigma=2.0)
    alone = [t for _, t in watch(spec, 2.0, ids=(1,)) if t.id == 1]
    together = [t for _, t in watch(spec, 2.0, ids=(1, 2, 3)) if t.id == 1]
    assert alone == together
