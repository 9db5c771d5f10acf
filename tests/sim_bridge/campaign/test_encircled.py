"""Outcomes 1 and 2 of 3.4.2 as played: whoever is not encircled escapes; whoever is, often not."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.game.rules import NO_TARGET
from sim_bridge.campaign.encircled import RHO, draw_game, shares, table


@pytest.mark.parametrize("encircled", [False, True])
def test_a_drawn_game_begins_as_asked(encircled: bool) -> None:
    """By brute force: every tenth of a degree against every pursuer's cone at the safety distance."""
    game = draw_game(np.random.default_rng(3), 5, False, encircled, NO_TARGET)
    assert game is not None
    rays = np.radians(np.arange(0.0, 360.0, 0.1))
    free = np.ones(len(rays), dtype=bool)
    for pursuer in game.pursuers:
        x, y, _ = pursuer.position
        half = np.arcsin(pursuer.speed / game.evader.speed) + np.arcsin(RHO / np.hypot(x, y))
        off = np.abs((rays - np.arctan2(y, x) + np.pi) % (2.0 * np.pi) - np.pi)
        free &= off >= half
    assert free.any() == (not encircled)


def test_not_encircled_is_never_captured_and_encircled_not_always() -> None:
    found = shares(6, 1, (5,), compiled=False)
    for kind in found:
        if not kind.encircled:
            assert kind.captured == 0
    ringed = [kind for kind in found if kind.encircled and not kind.ring]
    captured, games = sum(k.captured for k in ringed), sum(k.games for k in ringed)
    assert 0 < captured < games
    assert f"{found[0].captured} of 6 = 0 %" in table(found)
