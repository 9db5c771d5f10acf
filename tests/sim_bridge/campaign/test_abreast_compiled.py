"""Pursuers abreast decide the same compiled as interpreted, and they do come abreast in the games played."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.game.advance import Conditions
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign import encircled
from sim_bridge.campaign.compiled import campaign, starts_of


@pytest.mark.long
def test_games_of_a_wall_are_the_same_compiled_and_interpreted() -> None:
    target = Target(True, encircled.TARGET)
    rng = np.random.default_rng(12)
    games = [encircled.draw_game(rng, 5, False, False, target) for _ in range(4)]
    starts = starts_of([game for game in games if game is not None], [encircled.TARGET] * 4)
    rules = Rules(encircled.R, encircled.RHO, horizon=25.0, planar=True)
    conditions = Conditions(rules, target, Control(0.1))
    evader = EVADERS["straight"].decide
    ours, theirs = (
        campaign(evader, PURSUERS["abreast"].decide, 5, compiled)(starts, conditions, keep=250)
        for compiled in (False, True)
    )
    assert ours.verdicts.tolist() == theirs.verdicts.tolist()
    np.testing.assert_allclose(ours.trace, theirs.trace, rtol=0.0, atol=1e-6)
    other = campaign(evader, PURSUERS["parallel-pursuit"].decide, 5, False)(starts, conditions, keep=250)
    assert not np.allclose(ours.trace, other.trace, equal_nan=True)
