"""What `each` writes out of many items, and what it loops over: strategies would compile for minutes."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from onboard.core.game import advance, many, referee, views
from onboard.core.geometry import cones
from onboard.core.strategy import foresight
from sim_bridge.campaign.each_compiled import _is_short


@pytest.mark.parametrize(
    "function",
    [advance.position_of, advance.speed_of, advance.move_one, views.turn_rate_of, cones.blocked_cone,
     referee.smallest_square],
)  # fmt: skip
def test_what_costs_less_than_a_loop_about_it_is_written_out(function: Callable[..., Any]) -> None:
    assert _is_short(SimpleNamespace(typing_key=function))


@pytest.mark.parametrize("function", [advance.decide_one, many.chase_one, many.flee, foresight.hunted])
def test_strategies_are_looped_over(function: Callable[..., Any]) -> None:
    assert not _is_short(SimpleNamespace(typing_key=function))
