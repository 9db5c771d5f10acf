"""How a game of a campaign ended: a row of a shard."""

from __future__ import annotations

from typing import NamedTuple


class EvaderRow(NamedTuple):
    """How a game ended for one of several evaders."""

    verdict: str
    time: float  # of the verdict [s]
    smallest: float  # distance of any pursuer [m]
    captor: int  # number of the pursuer, counted from 1; 0 = nobody
    unsafe: float  # time within the safety distance [s]; NaN where nobody measured it


class Row(NamedTuple):
    """How one game ended; a column of a shard each. Of several evaders the worst for the pursuers decides."""

    cell: int
    seed: int
    verdict: str
    time: float  # of the verdict [s]; of several evaders the last
    smallest: float  # distance of any pursuer [m]
    captor: int  # number of the pursuer, counted from 1; 0 = nobody
    unsafe: float  # time within the safety distance, of all evaders [s]; NaN where nobody measured it
    reversals: int  # of the evader's flown course; −1 where they are not counted
    evaders: tuple[EvaderRow, ...] = ()  # each of several, in the order of their ids
