"""What strategies reach of a problem's value, from many starts near the file's, with 95 % intervals.

Our pursuers play against the optimal evader, our evaders against the optimal pursuers, all from the same
starts; the two optimal sides against each other show what steps of time and a capture radius cost.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from onboard.config.in_words import nearest
from onboard.config.strict import ConfigError
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.plugins import evader_strategy, plugin_names, pursuer_strategy
from onboard.runtime.progress import Tell, silent
from sim_bridge.classic.play import Evader, Pursuers, Scene, ours, theirs
from sim_bridge.classic.problem import Problem, drawn, play
from sim_bridge.programs.campaigns.until import wilson

OPTIMAL = "optimal"
BOOTSTRAPS = 500
KNOWN = 0.95  # of the starts drawn again must hold something to have a share of
Array = NDArray[np.float64]


class Row(msgspec.Struct, frozen=True):
    """What one strategy reaches on one side; what `--json` prints."""

    problem: str
    side: str  # pursuers, evader, or both for the optimal play of both
    strategy: str
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


def measured(
    problem: Problem, starts: Sequence[Scene], only: Sequence[str] = (), tell: Tell = silent
) -> list[Row]:
    """A row for the optimal play, each pursuers' and each evader's strategy; `only` names those to take."""
    chasers, evaders = chosen(problem, only)
    sides: list[tuple[str, str, Callable[[], Evader], Callable[[], Pursuers]]] = [
        ("both", OPTIMAL, lambda: problem.evader, lambda: problem.pursuers)
    ]
    sides += [("pursuers", name, lambda: problem.evader, ours(name)) for name in chasers]
    sides += [("evader", name, theirs(name), lambda: problem.pursuers) for name in evaders]
    rows = []
    for number, (side, name, evader, pursuers) in enumerate(sides):
        tell(number / len(sides), f"{side} {name}")
        rows.append(row(problem, side, name, [_game(problem, one, evader(), pursuers()) for one in starts]))
    return rows


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


def _game(problem: Problem, start: Scene, evader: Evader, pursuers: Pursuers) -> Game:
    value, end = problem.value(start), play(problem, start, evader, pursuers).end
    return Game(value, problem.won(start, value), end.payoff, end.won)


def row(problem: Problem, side: str, name: str, games: Sequence[Game]) -> Row:
    """The figures of one strategy's games."""
    due = [g for g in games if side == "both" or g.theirs == (side == "pursuers")]
    won = sum(g.won == g.theirs for g in due)
    low, high = wilson(won, len(due))
    expected = np.array([problem.expected(g.value) for g in games])
    payoff = np.array([g.payoff for g in games])
    again = np.random.default_rng(1).integers(0, len(games), (BOOTSTRAPS, len(games)))
    upside_down = (problem.pursuers_want > 0) == (side == "evader")

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
        problem.name, side, name, len(games), len(due), won, low, high, float(expected.mean()),
        float(payoff.mean()), float((payoff - expected).mean()), least, most, total if known else None,
        edges[0], edges[1],
    )  # fmt: skip
