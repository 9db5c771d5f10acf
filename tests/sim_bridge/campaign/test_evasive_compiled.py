"""The evader that plays its ways out decides the same compiled as interpreted."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.game.advance import Conditions
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign import encircled
from sim_bridge.campaign.compiled import campaign, starts_of


@pytest.mark.long
def test_evasive_games_are_the_same_compiled_and_interpreted() -> None:
    target = Target(True, encircled.TARGET)
    rng = np.random.default_rng(11)
    games = [encircled.draw_game(rng, 5, False, True, target) for _ in range(3)]
    starts = starts_of([game for game in games if game is not None], [encircled.TARGET] * 3)
    rules = Rules(encircled.R, encircled.RHO, horizon=20.0, planar=True)
    conditions = Conditions(rules, target, Control(0.1))
    strategies = EVADERS["evasive"].decide, PURSUERS["paper"].decide
    ours, theirs = (
        campaign(*strategies, 5, compiled)(starts, conditions, keep=200) for compiled in (False, True)
    )
    assert ours.verdicts.tolist() == theirs.verdicts.tolist()
    np.testing.assert_allclose(ours.trace, theirs.trace, rtol=0.0, atol=1e-6)
