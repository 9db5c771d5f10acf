"""A kernel of many strategies plays the games that a kernel of each pair plays, to the last bit."""

from __future__ import annotations

from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onboard.core.game.advance import Conditions
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign.compiled import Ends, Starts, campaign, starts_of
from sim_bridge.campaign.matrix import matrix
from sim_bridge.plane_game.setup import conditions_of, game_of
from sim_bridge.programs.campaigns.command import Options, plan_of
from sim_bridge.programs.campaigns.play import PAIRS, drawn, rows, simple_games


def games(horizon: float, seeds: range) -> tuple[Starts, Conditions]:
    """Games of Table 1's first row, cut short."""
    cell = plan_of(Options((Path("table1/row01"),)), until=False).cell(0)
    scenarios = [drawn(cell, seed) for seed in seeds]
    conditions = conditions_of(scenarios[0])
    conditions = conditions._replace(rules=conditions.rules._replace(horizon=horizon))
    starts = starts_of([game_of(one) for one in scenarios], [conditions.target.position] * len(seeds))
    return starts, conditions


def alike(one: Ends, other: Ends) -> None:
    """Every number of how games ended."""
    for name in ("verdicts", "times", "captors", "smallest", "unsafe", "steps"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def compared(evaders: list[str], pursuers: list[str], horizon: float, compiled: bool) -> list[Any]:
    """Each pair by both; how near anybody came, pair by pair."""
    starts, conditions = games(horizon, range(1, 3))
    sides = tuple(EVADERS[e].decide for e in evaders), tuple(PURSUERS[p].decide for p in pursuers)
    play = matrix(*sides, 5, compiled)
    found = []
    for e, p in product(range(len(evaders)), range(len(pursuers))):
        together = play(starts, conditions, e, p)
        alike(together, campaign(sides[0][e], sides[1][p], 5, compiled)(starts, conditions))
        found.append(together.smallest.tolist())
    return found


def test_interpreted_every_pair_plays_its_own_game() -> None:
    pursuers = ["paper", "pure-pursuit", "goalkeeper", "team"]
    found = compared(["paper", "straight", "dodge"], pursuers, 3.0, False)
    assert len({tuple(one) for one in found}) >= 6  # they do differ


def test_compiled_it_plays_as_interpreted() -> None:
    starts, conditions = games(10.0, range(1, 3))
    pursuers = "pure-pursuit", "parallel-pursuit"
    sides = (EVADERS["straight"].decide,), tuple(PURSUERS[p].decide for p in pursuers)
    compiled, interpreted = matrix(*sides, 5), matrix(*sides, 5, compiled=False)
    ends = [compiled(starts, conditions, 0, p) for p in (0, 1)]
    for p in (0, 1):
        alike(ends[p], interpreted(starts, conditions, 0, p))
    assert ends[0].smallest.tolist() != ends[1].smallest.tolist()


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_compiled_every_pair_plays_its_own_game() -> None:
    compared(["paper", "straight"], ["paper", "pure-pursuit", "team"], 40.0, True)


@pytest.mark.long
@pytest.mark.timeout(1200)
def test_a_campaign_of_many_pairs_has_the_rows_of_its_cells_alone() -> None:
    names = ("paper", "pure-pursuit", "parallel-pursuit", "proportional-navigation")
    options = Options((Path("table1/row01"),), ("paper", "straight"), names, games=3)
    plan = plan_of(options, until=False)
    assert plan.cell_count > PAIRS
    [shard] = plan.shards()
    alone = [row for n in shard.cells for row in simple_games(plan.cell(n), shard.seeds)]
    assert list(rows(plan, shard)) == alone
