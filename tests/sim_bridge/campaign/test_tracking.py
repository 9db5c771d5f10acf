"""A share of the tracking comparison, on the aircraft as flown: the whole is in docs/flight-model.md."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.route.tracking import Strategy
from onboard.game.route_file import load_route
from onboard.game.scenario import WindSpec
from onboard.runtime.resources import configs
from sim_bridge.campaign.tracking import Row, compare, fly_seed, table

ROUTE = load_route(configs() / "routes" / "twenty_km.toml")
WIND = WindSpec(speed=5.0, gust_sigma=3.0)

pytestmark = pytest.mark.timeout(600)  # the first test compiles the flight


@pytest.fixture(scope="module")
def rows() -> dict[str, Row]:
    return {row.way: row for row in compare(ROUTE, "nose", range(8), WIND)}


def test_every_waypoint_was_passed(rows: dict[str, Row]) -> None:
    assert [row.missed for row in rows.values()] == [0, 0, 0, 0]


def test_the_module_is_as_good_as_the_better_strategy(rows: dict[str, Row]) -> None:
    better = min(rows["Strategy 1 (30)"].J, rows["Strategy 2 (31)"].J)
    assert 1.05 * better >= rows["intelligent module"].J


def test_the_module_beats_straight_flight(rows: dict[str, Row]) -> None:
    module, straight = rows["intelligent module"], rows["straight flight"]
    assert module.time_error <= straight.time_error / 3.0
    assert module.deviation <= straight.deviation


def test_the_module_uses_both_strategies_and_does_not_chatter(rows: dict[str, Row]) -> None:
    module = rows["intelligent module"]
    assert 0.05 < module.pursuing < 0.95
    assert module.switches < 4 * 6  # a few a leg
    assert module.away < rows["Strategy 1 (30)"].away  # between the waypoints pursuit pays


def test_the_table_shows_all_four(rows: dict[str, Row]) -> None:
    assert len(table(list(rows.values())).splitlines()) == 6


def test_interpreted_and_compiled_flights_are_the_same() -> None:
    ours = fly_seed(ROUTE, "nose", Strategy.CHOOSE, 3, WIND, interpreted=True)
    theirs = fly_seed(ROUTE, "nose", Strategy.CHOOSE, 3, WIND)
    assert ours.tracked.passed == 6
    np.testing.assert_allclose(ours.deviations, theirs.deviations, atol=1e-9)
    np.testing.assert_allclose(ours.time_errors, theirs.time_errors, atol=1e-9)
    assert ours.tracked == pytest.approx(theirs.tracked, abs=1e-9)
