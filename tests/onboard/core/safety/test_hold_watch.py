"""A hold is what the vehicle does: still for two seconds, within ten of its mode, and from then on."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin

import pytest

from onboard.core.math.vectors import ZERO, Vec
from onboard.core.safety.hold_watch import HoldLimits, HoldState, HoldWatch, of_plane

Motion = Callable[[float], tuple[Vec, Vec]]
PLANE = of_plane(80.0, 15.0, 25.0)


def still(t: float) -> tuple[Vec, Vec]:
    return Vec(0.2 * sin(t), 0.0, -40.0), Vec(0.2 * cos(t), 0.0, 0.0)


def braking(t: float) -> tuple[Vec, Vec]:
    """From 8 m/s at 2 m/s²."""
    t = min(t, 4.0)
    return Vec(8.0 * t - t * t, 0.0, -40.0), Vec(8.0 - 2.0 * t, 0.0, 0.0)


def sinking(t: float) -> tuple[Vec, Vec]:
    """As ArduCopter in LOITER with the throttle low: 39.4 m in 16.5 s."""
    return Vec(0.0, 0.0, -39.4 + 2.4 * t), Vec(0.0, 0.0, 2.4)


def creeping_down(t: float) -> tuple[Vec, Vec]:
    return Vec(0.0, 0.0, -40.0 + 0.3 * t), Vec(0.0, 0.0, 0.3)


def drifting(t: float) -> tuple[Vec, Vec]:
    return Vec(1.8 * t, 0.0, -40.0), Vec(1.8, 0.0, 0.0)


def circling(t: float) -> tuple[Vec, Vec]:
    return Vec(80.0 * cos(t / 4), 80.0 * sin(t / 4), -100.0), Vec(-20.0 * sin(t / 4), 20.0 * cos(t / 4), 0.0)


def leaving(t: float) -> tuple[Vec, Vec]:
    return Vec(20.0 * t, 0.0, -100.0), Vec(20.0, 0.0, 0.0)


def story(limits: HoldLimits, motion: Motion, airspeed: float = 20.0) -> list[tuple[str, float]]:
    """What the watch says and when [s], over a minute at 20 Hz."""
    watch = HoldWatch(100.0, limits)
    told = []
    for k in range(1200):
        t = k * 0.05
        if watch.look(100.0 + t, *motion(t), airspeed):
            told.append((watch.state.value, t))
    return told


@pytest.mark.parametrize(
    ("limits", "motion", "states", "by"),
    [
        (HoldLimits(), still, ["held"], 2.1),
        (HoldLimits(), braking, ["held"], 7.0),
        (HoldLimits(), sinking, ["lost"], 10.1),
        (HoldLimits(), creeping_down, ["held", "lost"], 9.0),
        (HoldLimits(), drifting, ["lost"], 10.1),
        (PLANE, circling, ["held"], 2.1),
        (PLANE, leaving, ["held", "lost"], 26.0),
    ],
)
def test_what_holds_is_held_and_what_does_not_is_lost(
    limits: HoldLimits, motion: Motion, states: list[str], by: float
) -> None:
    told = story(limits, motion)
    assert [state for state, _ in told] == states
    assert told[-1][1] <= by


def test_a_plane_too_slow_does_not_hold() -> None:
    assert [state for state, _ in story(PLANE, circling, airspeed=9.0)] == ["lost"]


def test_one_odd_sample_loses_no_hold() -> None:
    watch = HoldWatch(0.0, HoldLimits())
    for k in range(100):
        watch.look(k * 0.05, *still(k * 0.05), None)
    assert watch.state is HoldState.HELD
    assert not watch.look(5.0, Vec(500.0, 0.0, 0.0), ZERO, None)
    assert not watch.look(5.05, *still(5.05), None)
