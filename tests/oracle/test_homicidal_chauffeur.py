"""The homicidal chauffeur: the closed form against its barrier integrated, our strategies against both."""

from __future__ import annotations

from math import acos, atan2, cos, hypot, pi, sin

import numpy as np
import pytest

from onboard.core.game.rules import NO_TARGET, Rules
from onboard.core.game.views import evader_view, with_limits
from onboard.core.geometry.chauffeur import sure_radius
from onboard.core.math.states import FREE, Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.registry import EVADERS


def slope(state: np.ndarray, w: float) -> np.ndarray:
    """Backwards along the right barrier, the pursuer in a hard turn: reduced coordinates and their normal."""
    x, y, nx, ny = state
    return np.array([y - w * nx, 1.0 - x - w * ny, ny, -nx])


def narrowest(w: float, radius: float) -> float:
    """The least x of the right barrier on its way out; turning radius and pursuer's speed are 1."""
    s = acos(w)
    state = np.array([radius * sin(s), radius * cos(s), sin(s), cos(s)])
    h, least = pi / 4000, 1e9
    for _ in range(4000):
        a = slope(state, w)
        b = slope(state + 0.5 * h * a, w)
        c = slope(state + 0.5 * h * b, w)
        d = slope(state + h * c, w)
        state = state + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        least = min(least, float(state[0]))
    return least


@pytest.mark.parametrize("w", [0.3, 0.5, 0.8])
def test_at_the_sure_radius_the_barriers_just_touch(w: float) -> None:
    radius = sure_radius(w, 1.0, 1.0)
    assert narrowest(w, radius) == pytest.approx(0.0, abs=1e-6)
    assert narrowest(w, 0.9 * radius) < 0.0 < narrowest(w, 1.1 * radius)


def chased(name: str, w: float, radius: float, start: float) -> float:
    """For how long [s] an evader lives, at most 40: the pursuer turns towards it at 1 rad/s at speed 1."""
    limits = VehicleLimits(turn_rate=1.0)
    x, y, yaw = 0.0, 0.0, 0.0
    ex, ey = 5.0 * cos(start), 5.0 * sin(start)
    course, dt = 0.0, 0.04
    rules = Rules(R=radius, rho=2.0 * radius, planar=True)
    for step in range(1000):
        own = Vehicle(Vec(ex, ey, 0.0), Vec(w * cos(course), w * sin(course), 0.0), w)
        hunter = Vehicle(Vec(x, y, 0.0), Vec(cos(yaw), sin(yaw), 0.0), 1.0)
        view = with_limits(evader_view(own, FREE, (hunter,), NO_TARGET, ZERO, rules), (limits,))
        ahead = EVADERS[name].decide(view).direction
        course = atan2(ahead.y, ahead.x)
        ex, ey = ex + w * dt * cos(course), ey + w * dt * sin(course)
        wanted = atan2(ey - y, ex - x)
        yaw += float(np.clip(np.angle(np.exp(1j * (wanted - yaw))), -dt, dt))
        x, y = x + dt * cos(yaw), y + dt * sin(yaw)
        if hypot(ex - x, ey - y) <= radius:
            return step * dt
    return 40.0


def test_far_below_the_sure_radius_the_agile_evader_slips_aside() -> None:
    """Where the theory has an escape ours finds it, and running straight away does not."""
    radius = 0.3 * sure_radius(0.5, 1.0, 1.0)
    assert chased("paper", 0.5, radius, 0.4) < 20.0
    assert chased("evasive", 0.5, radius, 0.4) == 40.0


def test_above_the_sure_radius_nothing_helps() -> None:
    radius = 2.0 * sure_radius(0.5, 1.0, 1.0)
    for start in (0.4, 2.0):
        assert chased("evasive", 0.5, radius, start) < 40.0
