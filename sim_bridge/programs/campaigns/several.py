"""Games of several evaders or targets in a campaign: simple motion, compiled; a row tells of each evader."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from onboard.core.game.referee import GameResult
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario
from onboard.game.trials import WORST
from sim_bridge.campaign.many import ManyEnds, Size, many_campaign, starts_of
from sim_bridge.plane_game.several import conditions_of, game_of
from sim_bridge.programs.campaigns.playing import compiled_or_not
from sim_bridge.programs.campaigns.rows import EvaderRow, Row

RANKS = tuple(result.value for result in WORST)  # verdicts, the worst for the pursuers first


def games_of(number: int, games: list[Scenario], seeds: range) -> list[Row]:
    """Games of a cell, all in one call of the kernel."""
    ends = ends_of(games)
    return [
        whole(number, seed, [
            EvaderRow(GameResult(int(ends.verdicts[k, j])).name.lower(), float(ends.times[k, j]),
                      float(ends.smallest[k, j]), int(ends.captors[k, j]) + 1, float(ends.unsafe[k, j]))
            for j in range(ends.verdicts.shape[1])
        ])
        for k, seed in enumerate(seeds)
    ]  # fmt: skip


def ends_of(games: list[Scenario], keep: int = 0) -> ManyEnds:
    """How games of one size end; `keep` records everybody's places over the first so many steps."""
    conditions = [conditions_of(one) for one in games]
    starts = starts_of([game_of(one) for one in games], [one.targets for one in conditions])
    first = games[0]
    size = Size(len(first.evading), len(first.pursuers), len(conditions[0].targets[0]))
    play = _play(tuple(spec.strategy for spec in first.evading), first.pursuers[0].strategy, size)
    ends: ManyEnds = play(starts, conditions[0], keep)
    return ends


def whole(number: int, seed: int, evaders: list[EvaderRow]) -> Row:
    """A game's row. Of its evaders the worst for the pursuers decides it; it is captured where all were."""
    worst = min((one.verdict for one in evaders), key=RANKS.index)
    last = max(evaders, key=lambda one: one.time)
    return Row(
        number, seed, worst, last.time, min(one.smallest for one in evaders),
        last.captor if worst == "captured" else 0, sum(one.unsafe for one in evaders), -1, tuple(evaders),
    )  # fmt: skip


@cache
def _play(evaders: tuple[str, ...], pursuers: str, size: Size) -> Callable[..., Any]:
    """The play of many games, compiled; interpreted where a plug-in does not compile."""
    flee, chase = tuple(evader_strategy(name) for name in evaders), pursuer_strategy(pursuers)
    return compiled_or_not(evaders, pursuers, lambda kernel: many_campaign(flee, chase, size, kernel))
