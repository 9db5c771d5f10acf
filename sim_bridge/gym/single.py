"""Gymnasium environments: one learner, be it the evader, a pursuer, or all pursuers as one."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box

from sim_bridge.gym.one_game import RENDER_MODES, Numbers, OneGame, Options


class GameEnv(gymnasium.Env[Numbers, Numbers]):
    """A game against named strategies. Several learners count as one: their observations and actions stand
    behind each other, and the reward is their mean.

    Keywords are those of `sim_bridge.gym.task.Wish` and `sim_bridge.gym.one_game.Options`; docs/gym.md says
    what observations, actions and rewards are.
    """

    metadata = {"render_modes": list(RENDER_MODES), "render_fps": 20}  # noqa: RUF012

    def __init__(
        self, render_mode: str | None = None, compiled: bool = False, game: str = "game",
        bus: str | None = None, **wish: Any,
    ) -> None:  # fmt: skip
        """Raises ConfigError for a wish that cannot be."""
        self.render_mode = render_mode
        options = Options(render_mode=render_mode, compiled=compiled, game=game, bus=bus)
        self._game = OneGame(wish, options)
        self.metadata = {**self.metadata, "render_fps": self._game.rates}
        names = self._game.learners
        width = sum(len(self._game.sees(name)) for name in names)
        self.observation_space = Box(-np.inf, np.inf, (width,), np.float32)
        self.action_space = Box(-1.0, 1.0, (sum(self._game.acts(name) for name in names),), np.float32)

    @property
    def agents(self) -> tuple[str, ...]:
        """Whose observations and actions stand behind each other."""
        return self._game.learners

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Numbers, dict[str, Any]]:
        """Begin a game; its own seed is in the information, and `options={"game": seed}` begins it again."""
        super().reset(seed=seed)
        info = self._game.reset(self.np_random, options)
        return self._sees(), info

    def step(self, action: Numbers) -> tuple[Numbers, float, bool, bool, dict[str, Any]]:
        """One control step. Raises ValueError for an action of another shape, or none of numbers."""
        given = np.asarray(action, dtype=np.float32)
        if given.shape != self.action_space.shape:
            raise ValueError(f"action: found the shape {given.shape}, expected {self.action_space.shape}")
        names = self._game.learners
        info = self._game.step(dict(zip(names, np.split(given, len(names)), strict=True)))
        reward = sum(self._game.reward(name) for name in names) / len(names)
        over, terminated = self._game.over, self._game.terminated
        return self._sees(), reward, terminated, over and not terminated, info

    def render(self) -> Any:
        """The picture of now in the mode rgb_array; in the mode human the bus has it already."""
        return self._game.render()

    def close(self) -> None:
        """Leave the bus."""
        self._game.close()

    def _sees(self) -> Numbers:
        return np.concatenate([self._game.sees(name) for name in self._game.learners])
