"""PettingZoo's parallel environment: evader_1, pursuer_1, pursuer_2, … act at the same time."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.spaces import Box
from gymnasium.utils import seeding
from pettingzoo import ParallelEnv

from sim_bridge.gym.one_game import RENDER_MODES, Numbers, OneGame, Options

By = dict[str, Any]


class GameParallelEnv(ParallelEnv[str, Numbers, Numbers]):  # type: ignore[misc]
    """A game of which every learner is an agent; `learn="all"` unless told otherwise.

    Keywords are those of `sim_bridge.gym.task.Wish` and `sim_bridge.gym.one_game.Options`; docs/gym.md says
    what observations, actions and rewards are. All agents' games end together.
    """

    metadata: By = {"name": "apollonius_v0", "render_modes": list(RENDER_MODES), "render_fps": 20}  # noqa: RUF012

    def __init__(
        self, render_mode: str | None = None, compiled: bool = False, game: str = "game",
        bus: str | None = None, **wish: Any,
    ) -> None:  # fmt: skip
        """Raises ConfigError for a wish that cannot be."""
        self.render_mode = render_mode
        options = Options(render_mode=render_mode, compiled=compiled, game=game, bus=bus)
        self._game = OneGame({"learn": "all", **wish}, options)
        self.metadata = {**self.metadata, "render_fps": self._game.rates}
        self.possible_agents = list(self._game.learners)
        self.agents: list[str] = []
        self.observation_spaces = {
            name: Box(-np.inf, np.inf, self._game.sees(name).shape, np.float32)
            for name in self.possible_agents
        }
        self.action_spaces = {
            name: Box(-1.0, 1.0, (self._game.acts(name),), np.float32) for name in self.possible_agents
        }
        self.state_space = Box(-np.inf, np.inf, self._game.state().shape, np.float32)
        self._rng = seeding.np_random(None)[0]

    def observation_space(self, agent: str) -> Box:
        """An agent's observations."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Box:
        """An agent's actions."""
        return self.action_spaces[agent]

    def reset(self, seed: int | None = None, options: By | None = None) -> tuple[dict[str, Numbers], By]:
        """Begin a game; its own seed is in the information, and `options={"game": seed}` begins it again."""
        if seed is not None:
            self._rng = seeding.np_random(seed)[0]
        info = self._game.reset(self._rng, options)
        self.agents = list(self.possible_agents)
        return self._sees(), {name: dict(info) for name in self.agents}

    def step(self, actions: dict[str, Numbers]) -> tuple[dict[str, Numbers], By, By, By, By]:
        """One control step. Raises ValueError for actions that miss, of another shape, or no numbers."""
        if not self.agents:
            return {}, {}, {}, {}, {}
        info = self._game.step(actions)
        over, terminated = self._game.over, self._game.terminated
        names = self.agents
        seen = self._sees()
        rewards = {name: self._game.reward(name) for name in names}
        if over:
            self.agents = []
        return (
            seen,
            rewards,
            dict.fromkeys(names, terminated),
            dict.fromkeys(names, over and not terminated),
            {name: dict(info) for name in names},
        )

    def state(self) -> Numbers:
        """Everybody's place [m; NED] and velocity through the air [m/s; NED], the evader first."""
        return self._game.state()

    def render(self) -> Any:
        """The picture of now in the mode rgb_array; in the mode human the bus has it already."""
        return self._game.render()

    def close(self) -> None:
        """Leave the bus."""
        self._game.close()

    def _sees(self) -> dict[str, Numbers]:
        return {name: self._game.sees(name) for name in self.possible_agents}


def parallel_env(**wish: Any) -> GameParallelEnv:
    """As libraries ask for it."""
    return GameParallelEnv(**wish)
