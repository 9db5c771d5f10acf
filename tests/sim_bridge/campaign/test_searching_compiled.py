"""Strategies that search (an evader that plays its ways out, pursuers abreast) decide the same compiled."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.game.advance import Conditions
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign import encircled
from sim_bridge.campaign.compiled import Ends, campaign, starts_of


@pytest.mark.parametrize(
    ("evader", "pursuers", "closed", "otherwise"),
    [
        pytest.param("evasive", "paper", True, ("paper", "paper"), marks=pytest.mark.long),
        ("straight", "abreast", False, ("straight", "parallel-pursuit")),
    ],
)
def test_games_are_the_same_compiled_and_interpreted_and_others_than_without_it(
    evader: str, pursuers: str, closed: bool, otherwise: tuple[str, str]
) -> None:
    target = Target(True, encircled.TARGET)
    rng = np.random.default_rng(12)
    games = [encircled.draw_game(rng, 5, False, closed, target) for _ in range(4)]
    starts = starts_of([game for game in games if game is not None], [encircled.TARGET] * 4)
    rules = Rules(encircled.R, encircled.RHO, horizon=25.0, planar=True)
    conditions = Conditions(rules, target, Control(0.1))

    def of(names: tuple[str, str], compiled: bool) -> Ends:
        play = campaign(EVADERS[names[0]].decide, PURSUERS[names[1]].decide, 5, compiled)
        return play(starts, conditions, keep=250)

    ours, theirs = of((evader, pursuers), False), of((evader, pursuers), True)
    assert ours.verdicts.tolist() == theirs.verdicts.tolist()
    np.testing.assert_allclose(ours.trace, theirs.trace, rtol=0.0, atol=1e-6)
    assert not np.allclose(ours.trace, of(otherwise, False).trace, equal_nan=True)
