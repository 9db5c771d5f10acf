"""What strategies reach of a problem's value, from many starts near the file's, with 95 % intervals.

Our pursuers play against the optimal evader, our evaders against the optimal pursuers, all from the same
starts; the two optimal sides against each other show what steps of time and a capture radius cost.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from onboard.config.in_words import nearest
from onboard.config.strict import ConfigError
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.plugins import evader_strategy, plugin_names, pursuer_strategy
from onboard.runtime.progress import Tell, silent
from sim_bridge.classic.play import (
    ASIDES,
    Evader,
    Pursuers,
    Scene,
    evader_aside,
    ours,
    pursuers_aside,
    theirs,
)
from sim_bridge.classic.problem import Problem, drawn, play
from sim_bridge.programs.campaigns.until import wilson

OPTIMAL = "optimal"
BOTH, PURSUERS_SIDE, EVADERS_SIDE = "both", "pursuers", "evader"
T = TypeVar("T")
BOOTSTRAPS = 500
KNOWN = 0.95  # of the starts drawn again must hold something to have a share of
Array = NDArray[np.float64]


class Row(msgspec.Struct, frozen=True):
    """What one strategy reaches on one side; what `--json` prints."""

    problem: str
    side: str  # pursuers, evader, or both for the optimal play of both
    strategy: str
    opponents: int  # 1, or as many with those that begin aside: the worst game of each start counts
    starts: int
    games: int  # of those, theory gives the side's
    won: int  # of those, it won
    won_low: float  # 95 %, Wilson
    won_high: float
    value: float  # mean over the starts, in the problem's unit
    reached: float  # mean payoff over the starts
    difference: float  # reached − value
    difference_low: float  # 95 %
    difference_high: float
    share: float | None  # of the value for this side: 1 = all of it, None where nothing is to be had
    share_low: float | None  # 95 %, starts drawn again
    share_high: float | None


class Game(NamedTuple):
    """One game's value and end."""

    value: float
    theirs: bool  # whether theory gives it to the pursuers
    payoff: float
    won: bool  # by the pursuers


def starts_near(problem: Problem, start: Scene, count: int, seed: int) -> list[Scene]:
    """The file's start and `count` − 1 drawn around it. Raises ConfigError."""
    rng = np.random.default_rng(seed)
    return [start] + [drawn(problem, start, rng) for _ in range(count - 1)]


class Side(NamedTuple):
    """Who is measured: a strategy on a side, and the opponents that it meets, each from every start."""

    name: str  # as in Row
    strategy: str
    games: tuple[tuple[Callable[[], Evader], Callable[[], Pursuers]], ...]


def measured(
    problem: Problem,
    starts: Sequence[Scene],
    only: Sequence[str] = (),
    feints: bool = False,
    tell: Tell = silent,
) -> list[Row]:
    """A row for the optimal play, each pursuers' and each evader's strategy; `only` names those to take.

    With `feints` everybody also meets opponents that begin aside of optimal play (ASIDES), and the game that
    was worst for it counts: optimal play itself loses nothing by them.
    """
    chasers, evaders = chosen(problem, only)
    e, p = problem.evader, problem.pursuers
    asides = ASIDES if feints else ()
    opponents = (e, *(evader_aside(e, one) for one in asides))
    hunters = (p, *(pursuers_aside(p, one) for one in asides))
    sides = [Side(BOTH, OPTIMAL, ((_always(e), _always(p)),))]
    sides += [Side(PURSUERS_SIDE, n, tuple((_always(o), ours(n)) for o in opponents)) for n in chasers]
    sides += [Side(EVADERS_SIDE, n, tuple((theirs(n), _always(h)) for h in hunters)) for n in evaders]
    rows = []
    for number, side in enumerate(sides):
        tell(number / len(sides), f"{side.name} {side.strategy}")
        rows.append(row(problem, side, [_worst(problem, one, side) for one in starts]))
    return rows


def _always(plays: T) -> Callable[[], T]:
    return lambda: plays


def _worst(problem: Problem, start: Scene, side: Side) -> Game:
    """The game of all against a side's opponents that is the worst for it."""
    ends = [play(problem, start, evader(), pursuers()).end for evader, pursuers in side.games]
    sign = -problem.pursuers_want if side.name == EVADERS_SIDE else problem.pursuers_want
    worst = min(ends, key=lambda end: sign * end.payoff)
    value = problem.value(start)
    return Game(value, problem.won(start, value), worst.payoff, worst.won)


def chosen(problem: Problem, only: Sequence[str]) -> tuple[list[str], list[str]]:
    """Which strategies play as pursuers and as evaders: the problem's, or those named. Raises ConfigError."""
    if not only:
        return list(problem.chasers), list(problem.evaders)
    found: tuple[list[str], list[str]] = [], []
    for name in only:
        takes = [side for side, load in zip(found, (pursuer_strategy, evader_strategy), strict=True)
                 if _loads(load, name)]  # fmt: skip
        for side in takes:
            side.append(name)
        if not takes:
            known = list(dict.fromkeys((*PURSUERS, *EVADERS, *plugin_names())))
            hint = nearest(name, known)
            raise ConfigError(f"--strategy: found '{name}', expected one of: {', '.join(known)}{hint}")
    return found


def _loads(load: Callable[[str], object], name: str) -> bool:
    try:
        load(name)
    except ConfigError:
        return False
    return True


def row(problem: Problem, who: Side, games: Sequence[Game]) -> Row:
    """The figures of one strategy's games."""
    side, name = who.name, who.strategy
    due = [g for g in games if side == BOTH or g.theirs == (side == PURSUERS_SIDE)]
    won = sum(g.won == g.theirs for g in due)
    low, high = wilson(won, len(due))
    expected = np.array([problem.expected(g.value) for g in games])
    payoff = np.array([g.payoff for g in games])
    again = np.random.default_rng(1).integers(0, len(games), (BOOTSTRAPS, len(games)))
    upside_down = (problem.pursuers_want > 0) == (side == EVADERS_SIDE)

    def share(e: Array, p: Array) -> Any:
        top, bottom = (e, p) if upside_down else (p, e)
        with np.errstate(divide="ignore", invalid="ignore"):
            return top.mean(axis=-1) / bottom.mean(axis=-1)

    drawn_shares, gaps = share(expected[again], payoff[again]), (payoff - expected)[again].mean(axis=1)
    total = float(share(expected, payoff))
    finite = drawn_shares[np.isfinite(drawn_shares)]
    known = bool(np.isfinite(total)) and len(finite) > KNOWN * BOOTSTRAPS
    edges = np.percentile(finite, [2.5, 97.5]).tolist() if known else [None, None]
    least, most = np.percentile(gaps, [2.5, 97.5]).tolist()
    return Row(
        problem.name, side, name, len(who.games), len(games), len(due), won, low, high,
        float(expected.mean()), float(payoff.mean()), float((payoff - expected).mean()), least, most,
        total if known else None, edges[0], edges[1],
    )  # fmt: skip
