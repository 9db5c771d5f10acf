"""Why a computed game ended without capture: the moment is checked by planning again from it."""

from __future__ import annotations

from math import pi
from pathlib import Path

import numpy as np
import pytest

from onboard.game.hindsight import Ways, missed
from onboard.game.scenario import Parameters, Scenario, VehicleSpec
from sim_bridge.campaign.plane_in_wind import climate_of, wind_at
from sim_bridge.campaign.spatial_draw import spatial
from sim_bridge.campaign.why_not import ways_of, why_not
from sim_bridge.plane_game.program import play

HEADINGS = np.linspace(-pi, pi, 2881)


def lost() -> Scenario:
    """One pursuer that stands beside the way to the target, and one behind."""
    return Scenario(
        name="two that came late",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0, target=(200.0, 0.0)),
        pursuers=tuple(VehicleSpec(position=at, speed=4.0) for at in ((60.0, 45.0), (-20.0, 5.0))),
        parameters=Parameters(R=2.0, rho=4.0, horizon=90.0),
    )


def ways_flown(scenario: Scenario) -> Ways:
    played = play(scenario, "parallel-pursuit")
    places = [[g.evader.position, *(p.position for p in g.pursuers)] for g in played.frames]
    return ways_of(scenario, np.array(places), played.conditions.control.dt, False)


def nearest(ways: Ways, pursuer: int, t: float) -> float:
    """The least distance to the way flown of who leaves at t on the best of all headings [m]."""
    later = np.linspace(t, ways.t[-1], 900)
    place = [np.interp(t, ways.t, ways.pursuers[pursuer, :, axis]) for axis in range(2)]
    e = [np.interp(later, ways.t, ways.evader[:, axis]) for axis in range(2)]
    gone = ways.speeds[pursuer] * (later - t)
    x = place[0] + np.cos(HEADINGS)[:, None] * gone - e[0]
    y = place[1] + np.sin(HEADINGS)[:, None] * gone - e[1]
    return float(np.hypot(x, y).min())


def test_before_the_moment_a_course_captures_and_after_it_none(tmp_path: Path) -> None:
    scenario = lost()
    ways = ways_flown(scenario)
    found = missed(ways)
    assert found.who >= 0
    assert nearest(ways, found.who, found.t - 0.3) <= ways.R + 0.1
    for pursuer in range(2):
        assert nearest(ways, pursuer, found.t + 0.3) > ways.R
    words = why_not(scenario, ways, tmp_path / "why.png")
    assert f"Until {found.t:.1f} s pursuer {scenario.ids[1 + found.who]} could still" in words
    assert (tmp_path / "why.png").stat().st_size > 10_000


def test_aircraft_are_looked_at_in_the_moving_air() -> None:
    """Everybody is carried by the mean wind alone: in the air nobody has moved."""
    scenario = spatial("two")
    wind = np.array(wind_at(climate_of(scenario.flight.wind), scenario.evader.start()))
    assert np.hypot(*wind[:2]) > 1.0
    first = np.array([v.start() for v in scenario.vehicles])
    places = first + np.arange(40)[:, None, None] * 0.05 * wind
    ways = ways_of(scenario, places, 0.05, True)
    assert np.ptp(ways.evader, axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
    assert np.ptp(ways.pursuers, axis=1) == pytest.approx(np.zeros((2, 3)), abs=1e-9)
