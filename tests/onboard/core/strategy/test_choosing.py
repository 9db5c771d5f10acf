"""Figure 8b's choice in pursuit: in gusts to the point held, otherwise to a new one."""

from __future__ import annotations

from math import atan2, degrees, radians

import numpy as np
import pytest

from onboard.core.game.rules import Control, Rules
from onboard.core.game.views import Held, Nearest, PursuerView
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import ZERO, Vec, along, direction, distance, scale
from onboard.core.strategy.choosing import held_after, pursuer_choosing
from onboard.core.strategy.knowledge import RuleId
from onboard.core.strategy.pursuit import pursuer

OWN = 40.0
EVADER = 50.0
PLACE = Vec(3000.0, 500.0, 0.0)  # ahead of the evader, that flies north from the origin


def view(airspeed: float = OWN, turned: float = 0.0, held: Held | None = None) -> PursuerView:
    """A pursuer that flies at `airspeed` and sees the evader's heading `turned` [deg] off north."""
    heading = direction(0.0, radians(turned))
    own = Vehicle(PLACE, Vec(-airspeed, 0.0, 0.0), OWN)
    evader = Vehicle(ZERO, scale(heading, EVADER), EVADER)
    shown = PursuerView(
        own, FREE, evader, heading, False, ZERO, Nearest(False, ZERO), Control(), Rules(25.0, 88.0)
    )
    return shown if held is None else shown._replace(held=held)


def held(corrected: bool = False) -> Held:
    """What the undisturbed decision leaves a twentieth of a second later, in still air."""
    first = pursuer(view())
    assert first.rule == RuleId.INTERCEPT
    rule = RuleId.POINT_BY_POINT if corrected else first.rule
    return held_after(rule, first.aim, first.time, 0.05, ZERO)


def course(decision_direction: Vec) -> float:
    return degrees(atan2(decision_direction.y, decision_direction.x))


def test_in_gusts_a_heading_that_trembles_does_not_move_the_course() -> None:
    calm = [pursuer_choosing(view(OWN, turned, held())) for turned in (-1.0, 0.0, 1.0)]
    gusty = [pursuer_choosing(view(OWN + 3.0, turned, held())) for turned in (-1.0, 0.0, 1.0)]
    assert {d.rule for d in calm} == {RuleId.INTERCEPT}
    assert {d.rule for d in gusty} == {RuleId.POINT_BY_POINT}
    assert np.ptp([course(d.direction) for d in calm]) > 0.5
    assert np.ptp([course(d.direction) for d in gusty]) == pytest.approx(0.0, abs=1e-9)
    for decision in gusty:  # at its time
        assert decision.time == pytest.approx(distance(PLACE, held().place) / OWN - 0.05, rel=1e-3)


def test_an_evader_that_turns_is_answered_in_gusts_too() -> None:
    decision = pursuer_choosing(view(OWN + 3.0, 10.0, held()))
    assert decision.rule == RuleId.INTERCEPT
    assert decision.direction == pursuer(view(OWN, 10.0)).direction


@pytest.mark.parametrize(("off", "before", "rule"), [
    (0.9, True, RuleId.INTERCEPT), (1.5, True, RuleId.POINT_BY_POINT), (1.5, False, RuleId.INTERCEPT),
    (-1.5, True, RuleId.POINT_BY_POINT), (-2.5, False, RuleId.POINT_BY_POINT),
])  # fmt: skip
def test_it_stays_with_what_it_does_between_the_thresholds(off: float, before: bool, rule: RuleId) -> None:
    assert pursuer_choosing(view(OWN + off, 0.5, held(before))).rule == rule


def test_near_the_meeting_and_with_nothing_held_it_is_the_paper_s() -> None:
    soon = held()._replace(left=3.0)
    for shown in (view(OWN + 3.0, 1.0, soon), view(OWN + 3.0, 1.0)):
        assert pursuer_choosing(shown) == pursuer(shown)


def test_what_is_held_lies_in_the_moving_air() -> None:
    first = pursuer(view())
    wind = Vec(3.0, -6.0, 0.0)
    later = held_after(first.rule, first.aim, first.time, 2.0, wind)
    assert later.place == along(first.aim, wind, 2.0)
    assert later.left == pytest.approx(first.time - 2.0)
    assert not held_after(RuleId.PARALLEL, first.aim, first.time, 0.05, wind).exists
    assert not held_after(RuleId.NONE, ZERO, 0.0, 0.05, wind).exists
