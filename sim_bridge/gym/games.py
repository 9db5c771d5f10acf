"""Many games of a task, whichever way its vehicles move."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from sim_bridge.gym.aircraft import AircraftGames
from sim_bridge.gym.batch import BatchedGames
from sim_bridge.gym.exchange import Exchange
from sim_bridge.gym.task import Motion, Task


class Games(Protocol):
    """What all kinds of many games share; see `BatchedGames`."""

    task: Task
    games: int
    agents: tuple[str, ...]
    arrays: Exchange

    @property
    def places(self) -> NDArray[np.float64]: ...
    @property
    def velocities(self) -> NDArray[np.float64]: ...
    @property
    def seeds(self) -> NDArray[np.int64]: ...
    @property
    def winds(self) -> NDArray[np.float64]: ...
    @property
    def times(self) -> NDArray[np.float64]: ...
    def reset(self, seed: int = 0, seeds: NDArray[np.int64] | None = None) -> Exchange: ...
    def step(self, again: bool = True) -> Exchange: ...


def games_of(
    task: Task, games: int, arrays: Exchange | None = None, workers: int = 1, compiled: bool = True
) -> Games:
    """So many games of a task, stepped together: see `BatchedGames`."""
    if task.motion is Motion.AIRCRAFT:
        return AircraftGames(task, games, arrays, workers, compiled)
    return BatchedGames(task, games, arrays, workers, compiled)
