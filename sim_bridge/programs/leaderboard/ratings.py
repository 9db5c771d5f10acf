"""Who beats whom: shares of wins, and a rating of each strategy by Bradley and Terry's model (Elo's scale).

An evader e wins against pursuers p in scenario s with probability 1 / (1 + exp(−(r_e − r_p + h_s))), h_s
being what the scenario itself favours. Intervals are the middle 95 % of fits to games drawn again with
replacement, seed by seed, so that what a seed makes easy for everybody is drawn for everybody.
"""

from __future__ import annotations

from math import log
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim_bridge.programs.campaigns.show import Results

ELO = 400.0 / log(10.0)  # points of Elo's scale for a unit of the logistic one
DRAWS = 200  # fits to games drawn again
PRIOR = 0.25  # half a drawn game, as it were, that keeps a rating finite where somebody always wins
STEPS = 60
DRAW = 0.5
Array = NDArray[np.float64]

EVADERS_SHARE = {"captured": 0.0, "denied": 0.0, "arrived": 1.0}
"""What a verdict gives the evader; the pursuers get the rest. An escape is the evader's where there is no
target to reach, and a draw where there is one."""


class Score(NamedTuple):
    """A strategy's rating with its interval, and its share of the points."""

    name: str
    rating: float
    low: float
    high: float
    share: float


class Board(NamedTuple):
    """The whole comparison."""

    scenarios: list[str]
    evaders: list[str]
    pursuers: list[str]
    points: Array  # (scenarios, evaders, pursuers): the evader's share
    captured: Array  # the same of captures alone
    games: int  # of each cell
    evader_scores: list[Score]  # best first
    pursuer_scores: list[Score]


def board(found: Results) -> Board:
    """The comparison of a campaign whose shards are all there."""
    plan = found.plan
    scenarios = [one.label for one in plan.scenarios]
    evaders = list(dict.fromkeys(pair.evader for pair in plan.pairs))
    pursuers = list(dict.fromkeys(pair.pursuers for pair in plan.pairs))
    shape = (len(scenarios), plan.games, len(evaders), len(pursuers))
    points, captured = np.zeros(shape), np.zeros(shape)
    for one in found.cells:
        cell = plan.cell(one.cell)
        at = (scenarios.index(cell.label), slice(None), evaders.index(cell.pair.evader),
              pursuers.index(cell.pair.pursuers))  # fmt: skip
        escape = DRAW if cell.scenario.evader.target else 1.0
        points[at] = [EVADERS_SHARE.get(verdict, escape) for verdict in one.verdicts]
        captured[at] = one.captured()
    mean = points.mean(axis=1)
    fitted = fit(mean)
    drawn = _drawn_again(points)
    e, p = len(evaders), len(pursuers)
    return Board(
        scenarios, evaders, pursuers, mean, captured.mean(axis=1), plan.games,
        _scores(evaders, fitted[:e], drawn[:, :e], mean.mean(axis=(0, 2))),
        _scores(pursuers, fitted[e : e + p], drawn[:, e : e + p], 1.0 - mean.mean(axis=(0, 1))),
    )  # fmt: skip


def _scores(names: list[str], fitted: Array, drawn: Array, shares: Array) -> list[Score]:
    low, high = np.percentile(drawn, [2.5, 97.5], axis=0)
    rows = [Score(*row) for row in zip(names, fitted.tolist(), low.tolist(), high.tolist(), shares.tolist(),
                                       strict=True)]  # fmt: skip
    return sorted(rows, key=lambda score: (-round(score.rating), score.name))


def _drawn_again(points: Array) -> Array:
    """Ratings of games drawn again: (DRAWS, evaders + pursuers)."""
    rng = np.random.default_rng(1)
    count, games = points.shape[:2]
    fits = []
    for _ in range(DRAWS):
        seeds = rng.integers(0, games, (count, games))
        again = np.take_along_axis(points, seeds[:, :, None, None], axis=1)
        fits.append(fit(again.mean(axis=1)))
    return np.array(fits)


def fit(mean: Array) -> Array:
    """Ratings of evaders, then pursuers, from the evaders' mean shares (scenarios, evaders, pursuers).

    Each side's mean is 0. Newton's method on the likelihood with a weak prior.
    """
    s, e, p = mean.shape
    design = _design(s, e, p)
    wins = mean.reshape(-1)
    penalty = np.full(e + p + s, PRIOR)
    weights = np.zeros(e + p + s)
    for _ in range(STEPS):
        chance = 1.0 / (1.0 + np.exp(-design @ weights))
        slope = design.T @ (wins - chance) - penalty * weights
        bend = (design.T * (chance * (1.0 - chance))) @ design + np.diag(penalty)
        step = np.linalg.solve(bend, slope)
        weights = weights + step * min(1.0, 2.0 / max(float(np.max(np.abs(step))), 1e-12))
        if float(np.max(np.abs(step))) < 1e-10:
            break
    ratings: Any = weights[: e + p]
    return ELO * np.concatenate([ratings[:e] - ratings[:e].mean(), ratings[e:] - ratings[e:].mean()])


def _design(s: int, e: int, p: int) -> Array:
    """Which weights a cell adds: its evader's, less its pursuers', and its scenario's."""
    rows = np.zeros((s * e * p, e + p + s))
    numbers = np.arange(s * e * p)
    rows[numbers, numbers // p % e] = 1.0
    rows[numbers, e + numbers % p] = -1.0
    rows[numbers, e + p + numbers // (e * p)] = 1.0
    return rows
