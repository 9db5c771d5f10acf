"""The strategies that deny a target are the same interpreted and compiled, to the last place."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.game.advance import Conditions
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.math.vectors import ZERO
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign.compiled import campaign, starts_of
from tests.benchmarks.team_plane import TEAM, random_games


@pytest.mark.timeout(480)
@pytest.mark.parametrize("way", [
    pytest.param("goalkeeper", marks=pytest.mark.long), pytest.param("blocking-line", marks=pytest.mark.long),
    "own-air",
])  # fmt: skip
def test_every_place_of_a_game_is_the_same(way: str) -> None:
    drawn = random_games(6, seed=5)
    rules = Rules(2.0, 4.0, horizon=30.0, planar=True, target_known=True)
    conditions = Conditions(rules, Target(True, ZERO), Control(0.1))
    starts = starts_of(drawn.games, drawn.targets)
    found = [
        campaign(EVADERS["paper"].decide, PURSUERS[way].decide, TEAM, compiled)(starts, conditions, keep=300)
        for compiled in (False, True)
    ]
    assert list(found[0].verdicts) == list(found[1].verdicts)
    np.testing.assert_allclose(found[0].trace, found[1].trace, atol=1e-9)
