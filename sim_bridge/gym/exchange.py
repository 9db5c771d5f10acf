"""The arrays between games and learners."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.strategy.features import Form, action_width, evader_width, pursuer_width

Floats = NDArray[np.float32]


class Rewards(NamedTuple):
    """What a step earns; the four are added."""

    outcome: float = 1.0  # captured or denied: to every pursuer, else to the evader; the reverse to others
    closing: float = 0.01  # a metre: a pursuer nearer to the evader, the evader nearer to its target
    time: float = 0.0  # a second of the game: to the evader, from every pursuer
    unsafe: float = 0.0  # a second within the safety distance ρ: to every pursuer, from the evader


class Exchange(NamedTuple):
    """What goes into a step of many games and what comes out; a library that trains may give its own arrays.

    Of a game that a step ended, `verdicts`, `rewards`, `ends` and `…_last` are of the game that ended, and
    `…_sees` of the one that began in its place.
    """

    evader_acts: Floats  # (games, actions) in: see `ACTIONS`
    pursuers_act: Floats  # (games, pursuers, actions) in; rows of those who do not learn are not read
    evader_sees: Floats  # (games, numbers) out: see `EVADER_SEES`
    pursuers_see: Floats  # (games, pursuers, numbers) out: see `PURSUER_SEES`
    evader_last: Floats  # the same at the end of a game that the step ended
    pursuers_last: Floats
    rewards: Floats  # (games, players) out, evader first
    verdicts: NDArray[np.int64]  # (games,) out: `GameResult`, 0 of a game that goes on
    ends: Floats  # (games, 4) out, at an end: time [s], captor (−1: none), smallest distance [m], steps


def exchange(games: int, pursuers: int, form: Form) -> Exchange:
    """Arrays of the right shapes."""
    acts, sees, evader_sees = action_width(form), pursuer_width(form), evader_width(form, pursuers)
    shapes = ((games, acts), (games, pursuers, acts), (games, evader_sees), (games, pursuers, sees),
              (games, evader_sees), (games, pursuers, sees), (games, pursuers + 1))  # fmt: skip
    floats: Any = [np.zeros(shape, np.float32) for shape in shapes]
    return Exchange._make([*floats, np.zeros(games, np.int64), np.zeros((games, 4), np.float32)])


def demand_shapes(found: Exchange, expected: Exchange) -> None:
    """Raise ValueError for arrays that do not fit."""
    one: Any
    other: Any
    for name, one, other in zip(Exchange._fields, found, expected, strict=True):
        if one.shape != other.shape or one.dtype.kind != other.dtype.kind or not one.flags.c_contiguous:
            wanted = f"contiguous {other.dtype} of shape {other.shape}"
            raise ValueError(f"{name}: found {one.dtype} of shape {one.shape}, expected {wanted}")
