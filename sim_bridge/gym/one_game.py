"""One game for the environments of the libraries: what they share."""

from __future__ import annotations

import warnings
from collections import deque
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from onboard.config.strict import ConfigError
from onboard.core.game.referee import GameResult
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import Vec
from sim_bridge.gym.bus_show import BusShow, Showing
from sim_bridge.gym.games import Games, games_of
from sim_bridge.gym.picture import SIZE, draw
from sim_bridge.gym.task import EVADER, Wish, make_task

RENDER_MODES = ("rgb_array", "human")
TRAIL = 4000  # places of each vehicle that a picture shows at most
SEEDS = 2**62

Numbers = NDArray[np.float32]


class Options(msgspec.Struct, frozen=True, kw_only=True):
    """What concerns one environment and not its game."""

    render_mode: str | None = None  # "rgb_array", or "human": over the bus, in real time
    compiled: bool = False  # ten times faster steps, after half a minute or more of compiling
    game: str = "game"  # name of the game on the bus
    bus: str | None = None  # Zenoh endpoint; None = tcp/127.0.0.1:7447


class OneGame:
    """A game at a time, by agents' names. Raises ConfigError for a wish or an option that cannot be."""

    def __init__(self, wish: dict[str, Any], options: Options) -> None:
        try:
            self.task = make_task(Wish(**wish))
        except TypeError as error:
            known = ", ".join((*Wish.__struct_fields__, *Options.__struct_fields__))
            raise ConfigError(f"{error}; known: {known}") from None
        if options.render_mode not in (None, *RENDER_MODES):
            words = ", ".join(RENDER_MODES)
            raise ConfigError(f"render_mode: found {options.render_mode!r}, expected one of: {words}")
        self.games: Games = games_of(self.task, 1, compiled=options.compiled)
        self.learners = self.task.learners
        self.rates = round(1.0 / self.task.form.dt)
        self._rows = {name: self.games.agents.index(name) for name in self.learners}
        self._options = options
        self._trail: deque[NDArray[np.float64]] = deque(maxlen=TRAIL)
        self._show: BusShow | None = None
        self.over = True

    def reset(self, rng: np.random.Generator, options: dict[str, Any] | None) -> dict[str, Any]:
        """Begin the game of a seed drawn from `rng`, or of `options["game"]`; what is to be known of it.

        The libraries have environments take any options; those that mean nothing here are warned of.
        """
        given = dict(options or {})
        seed = int(rng.integers(SEEDS))
        if "game" in given:
            seed = given.pop("game")
            if not isinstance(seed, int | np.integer) or not 0 <= seed < SEEDS:
                raise ValueError(f"options: game: found {seed!r}, expected a seed from 0 to 2^62 − 1")
        if given:
            warnings.warn(f"options: found {sorted(given)}, expected none but 'game'", stacklevel=3)
        self.games.reset(seeds=np.array([seed], dtype=np.int64))
        self.over = False
        self._trail.clear()
        self._tell()
        return {"seed": int(seed)}

    def step(self, actions: dict[str, Any]) -> dict[str, Any]:
        """One control step; how the game ended where it did. Raises ValueError for wrong actions."""
        if self.over:
            raise ValueError("step: the game has ended, expected reset()")
        if set(actions) != set(self.learners):
            raise ValueError(f"actions: found {sorted(actions)}, expected {sorted(self.learners)}")
        arrays = self.games.arrays
        for name, action in actions.items():
            row = (
                arrays.evader_acts[0]
                if name.startswith(EVADER)
                else arrays.pursuers_act[0, self._pursuer(name)]
            )
            given = np.asarray(action, dtype=np.float32)
            if given.shape != row.shape:
                raise ValueError(f"actions: {name}: found the shape {given.shape}, expected {row.shape}")
            row[:] = given
        self.games.step(again=False)
        verdict = GameResult(int(arrays.verdicts[0]))
        self.over = verdict != GameResult.RUNNING
        self._tell()
        if not self.over:
            return {}
        time, captor, smallest, steps = (float(value) for value in arrays.ends[0])
        return {"verdict": verdict.name.lower(), "time": time, "captor": int(captor), "smallest": smallest,
                "steps": int(steps)}  # fmt: skip

    @property
    def terminated(self) -> bool:
        """Whether the game ended for good: captured or arrived. At the horizon it was cut off."""
        return int(self.games.arrays.verdicts[0]) in (GameResult.CAPTURED, GameResult.ARRIVED)

    def sees(self, name: str) -> Numbers:
        """An agent's observation."""
        arrays = self.games.arrays
        row = (
            arrays.evader_sees[0] if name.startswith(EVADER) else arrays.pursuers_see[0, self._pursuer(name)]
        )
        found: Numbers = row.copy()
        return found

    def reward(self, name: str) -> float:
        """What an agent earned with the last step."""
        return float(self.games.arrays.rewards[0, self._rows[name]])

    def acts(self, name: str) -> int:
        """How many numbers an agent's action has."""
        arrays = self.games.arrays
        return int((arrays.evader_acts if name.startswith(EVADER) else arrays.pursuers_act).shape[-1])

    def state(self) -> Numbers:
        """Everybody's place [m; NED] and velocity through the air [m/s], the evader first."""
        both = np.concatenate([self.games.places[0], self.games.velocities[0]], axis=1)
        return both.astype(np.float32).ravel()

    def render(self) -> NDArray[np.uint8] | None:
        """The picture of now, (height, width, 3); None unless the mode is rgb_array."""
        if self._options.render_mode != "rgb_array":
            return None
        return draw(self.task.scenario, list(self._trail), SIZE)

    def close(self) -> None:
        """Leave the bus."""
        if self._show is not None:
            self._show.close()
            self._show = None

    def _pursuer(self, name: str) -> int:
        return self._rows[name] - 1

    def _tell(self) -> None:
        if self._options.render_mode is None:
            return
        places, velocities = self.games.places[0].copy(), self.games.velocities[0].copy()
        self._trail.append(places)
        if self._options.render_mode != "human":
            return
        if self._show is None:
            self._show = BusShow(self.task.scenario, self._options.game, self._options.bus)
        verdict = GameResult(int(self.games.arrays.verdicts[0])) if self.over else GameResult.RUNNING
        now = tuple(Vehicle(_vec(p), _vec(v), 0.0) for p, v in zip(places, velocities, strict=True))
        ends = self.games.arrays.ends[0]
        wind = Vec(float(self.games.winds[0, 0]), float(self.games.winds[0, 1]), 0.0)
        self._show.show(Showing(float(self.games.times[0]), now, wind, verdict, int(ends[1]), float(ends[2])))


def _vec(row: NDArray[np.float64]) -> Vec:
    return Vec(float(row[0]), float(row[1]), float(row[2]))
