"""Many strategies in one function, of which a number chooses: interpreted and compiled alike."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from sim_bridge.campaign.compiled import register_strategies
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.campaign.machine import FEW, among


def strategy(factor: float) -> Callable[[Any], Any]:
    def decide(view: Any) -> Any:
        return factor * view[0] - view[1]

    return decide


@pytest.mark.parametrize("count", [1, FEW, FEW + 3])
def test_the_number_chooses_the_strategy_in_both_ways(count: int) -> None:
    strategies = tuple(strategy(float(k + 2)) for k in range(count))
    chosen = among(strategies)

    def decided(view: tuple[float, float], number: int) -> float:
        found: float = chosen(view, number)
        return found

    register_strategies((*strategies, chosen))
    compiled = kernel(decided)
    for number, own in enumerate(strategies):
        assert decided((10.0, 3.0), number) == compiled((10.0, 3.0), number) == own((10.0, 3.0))
