"""A share of the soak of endings (`make soak`) in every test run: four games of each kind of autopilot."""

from __future__ import annotations

import pytest

from onboard.game.scenario import Kind
from tests.soak import endings
from tests.support.flown_autopilot import ENDED

SHARE = {
    Kind.ARDUCOPTER: ("kill", "abort", "pilot, restart", "battery"),
    Kind.ARDUPLANE: ("kill", "hold", "SIGTERM", "no GPS"),
    Kind.PX4: ("kill", "restart", "game over", "no EKF"),
    Kind.PX4_PLANE: ("kill", "abort", "pilot", "no bus"),
}


@pytest.mark.parametrize("kind", ENDED)
@pytest.mark.game
def test_however_a_flight_ends_the_vehicle_is_left_well_and_the_end_has_its_words(kind: Kind) -> None:
    first = 3 * len(ENDED) + ENDED.index(kind)
    for nth, how in enumerate(SHARE[kind]):
        ended = endings.play(first + nth * len(ENDED), 2, how, watch_s=9.0)
        assert ended.kind is kind
        assert not ended.problem, ended.problem


def test_a_vehicle_that_sinks_in_a_mode_that_holds_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The oracle itself: a pursuer that is ordered to land, were LAND a mode that holds."""
    monkeypatch.setattr(endings, "COMES_DOWN", frozenset())
    ended = endings.play(ENDED.index(Kind.ARDUCOPTER), 2, "land", watch_s=9.0)
    assert "sinks in LAND" in ended.problem
