"""The aircraft's kernel compiled: the same flight as interpreted, and an hour without drift."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from onboard.core.math.vectors import ZERO, Vec
from sim_bridge.campaign.compiled import register
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.vehicle.flight import KERNELS
from sim_bridge.vehicle.flight.aircraft import named
from sim_bridge.vehicle.flight.plane import Command, PlaneModel, PlaneState, start_state, step_plane, trimmed

Flight = Callable[[PlaneState, PlaneModel, Any, Any], PlaneState]


def fly(state: PlaneState, model: PlaneModel, orders: np.ndarray, gusts: np.ndarray) -> PlaneState:
    """Orders (n, 4): steer, angle, pitch, speed; gusts (n, 3)."""
    for k in range(orders.shape[0]):
        command = Command(int(orders[k, 0]), orders[k, 1], orders[k, 2], orders[k, 3])
        gust = Vec(gusts[k, 0], gusts[k, 1], gusts[k, 2])
        state = step_plane(state, model, command, Vec(3.0, -2.0, 0.0), gust)
    return state


def fly_still(state: PlaneState, model: PlaneModel, count: int) -> PlaneState:
    for _ in range(count):
        state = step_plane(state, model, Command(0, 0.0, 0.0, 45.0), ZERO, ZERO)
    return state


@pytest.fixture(scope="module")
def compiled() -> tuple[Flight, Any]:
    register(KERNELS)
    return kernel(fly), kernel(fly_still)


def flat(value: Any) -> list[float]:
    return [x for part in value for x in flat(part)] if isinstance(value, tuple) else [float(value)]


@pytest.mark.parametrize("name", ["nose", "slip", "coordinated"])
def test_interpreted_and_compiled_flights_are_the_same(name: str, compiled: tuple[Flight, Any]) -> None:
    rng = np.random.default_rng(7)
    count = 1500
    orders = np.column_stack(
        [
            np.repeat(rng.integers(0, 3, count // 50), 50),
            np.repeat(rng.uniform(-3.0, 3.0, count // 50), 50),
            np.repeat(rng.uniform(-0.5, 0.5, count // 50), 50),
            np.repeat(rng.uniform(30.0, 55.0, count // 50), 50),
        ]
    )
    gusts = 3.0 * rng.standard_normal((count, 3))
    model = named(name).model
    start = trimmed(start_state(Vec(1.0, 2.0, -300.0), 0.3, 45.0, ZERO), model)
    theirs = flat(compiled[0](start, model, orders, gusts))
    ours = flat(fly(start, model, orders, gusts))
    assert abs(ours[0]) > 50.0  # it went somewhere
    np.testing.assert_allclose(theirs, ours, rtol=0.0, atol=1e-9)


def test_an_hour_in_still_air_without_drift(compiled: tuple[Flight, Any]) -> None:
    model = named("nose").model
    start = trimmed(start_state(ZERO, 0.0, 45.0, ZERO), model)
    end = compiled[1](start, model, 360_000)
    assert end.position.x == pytest.approx(45.0 * 3600.0, abs=1e-3)
    assert (end.position.y, end.position.z) == (0.0, 0.0)
    assert (end.pitch.angle, end.yaw.angle) == (0.0, 0.0)
    assert end.speed == 45.0
