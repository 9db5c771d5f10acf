"""A pursuer learns where to meet a faster evader: `python train.py FILE.npz`, then it flies.

Proximal policy optimisation (Schulman et al. 2017) in one file, in the manner of CleanRL, on the batched
games. It needs PyTorch; what it writes does not. The scenario beside it names the file that is committed.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import torch
from torch import nn

from onboard.config.bounds import Count, Seed
from onboard.config.option_value import parsed
from onboard.config.strict import ConfigError
from onboard.core.game.referee import GameResult
from onboard.core.strategy.policy import Squash
from onboard.game.policy_file import Policy, save
from onboard.runtime.program import run
from sim_bridge.gym.batch import BatchedGames
from sim_bridge.gym.exchange import Rewards
from sim_bridge.gym.task import Wish, make_task

HERE = Path(__file__).parent
GAMES, LENGTH, EPOCHS, PARTS = 512, 64, 4, 4
GAMMA, LAMBDA, CLIP = 0.995, 0.95, 0.2
HIDDEN = 32


def network(inputs: int, outputs: int) -> nn.Sequential:
    """Two hidden layers, the last one small: the first actions are near the line of sight."""
    net = nn.Sequential(
        nn.Linear(inputs, HIDDEN), nn.Tanh(), nn.Linear(HIDDEN, HIDDEN), nn.Tanh(), nn.Linear(HIDDEN, outputs)
    )
    with torch.no_grad():
        net[4].weight *= 0.01
        net[4].bias *= 0.0
    return net


class Learner:
    """Actor, critic and their optimiser."""

    def __init__(self, inputs: int, outputs: int, scale: np.ndarray) -> None:
        self.actor, self.critic = network(inputs, outputs), network(inputs, 1)
        self.spread = nn.Parameter(torch.full((outputs,), -1.5))
        self.scale = torch.tensor(scale, dtype=torch.float32)
        parameters = [*self.actor.parameters(), *self.critic.parameters(), self.spread]
        self.optimiser = torch.optim.Adam(parameters, lr=1e-3, eps=1e-5)
        self.parameters = parameters

    def law(self, seen: torch.Tensor) -> torch.distributions.Normal:
        """The distribution of actions."""
        return torch.distributions.Normal(self.actor(seen / self.scale), self.spread.exp())

    def value(self, seen: torch.Tensor) -> torch.Tensor:
        """What the critic expects."""
        return self.critic(seen / self.scale).squeeze(-1)

    def update(self, seen: torch.Tensor, acted: torch.Tensor, said: torch.Tensor, gains: torch.Tensor,
               returns: torch.Tensor) -> None:  # fmt: skip
        """Some epochs of PPO on one batch."""
        for _ in range(EPOCHS):
            for rows in torch.randperm(len(seen)).chunk(PARTS):
                law = self.law(seen[rows])
                ratio = (law.log_prob(acted[rows]).sum(-1) - said[rows]).exp()
                a = gains[rows]
                a = (a - a.mean()) / (a.std() + 1e-8)
                clipped = ratio.clamp(1.0 - CLIP, 1.0 + CLIP)
                loss = -torch.min(ratio * a, clipped * a).mean()
                loss = loss + 0.5 * (self.value(seen[rows]) - returns[rows]).square().mean()
                self.optimiser.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(self.parameters, 0.5)
                self.optimiser.step()


def train(rounds: int, seed: int) -> tuple[Learner, BatchedGames]:
    """Learn for so many rounds of GAMES × LENGTH steps."""
    torch.manual_seed(seed)
    wish = Wish(scenario=HERE / "intercept.toml", learn="pursuers", axes="sight", spread=25.0,
                rewards=Rewards(outcome=1.0, closing=0.002))  # fmt: skip
    task = make_task(wish)
    games = BatchedGames(task, GAMES)
    arrays = games.reset(seed)
    inputs = arrays.pursuers_see.shape[2]
    scale = np.array([5.0, 5.0, 50.0, 50.0, 5.0, 5.0] + [50.0] * (inputs - 6))
    learner = Learner(inputs, arrays.pursuers_act.shape[2], scale)
    won = ended = 0
    for number in range(rounds):
        seen, acted, said, gained, values, after = [], [], [], [], [], []
        for _ in range(LENGTH):
            now = torch.tensor(arrays.pursuers_see[:, 0])
            with torch.no_grad():
                law = learner.law(now)
                action = law.sample()
                values.append(learner.value(now))
            arrays.pursuers_act[:, 0] = action.numpy()
            games.step()
            over = torch.tensor(arrays.verdicts != GameResult.RUNNING)
            won += int((arrays.verdicts == GameResult.CAPTURED).sum())
            ended += int(over.sum())
            seen.append(now)
            acted.append(action)
            said.append(law.log_prob(action).sum(-1))
            gained.append(torch.tensor(arrays.rewards[:, 1]))
            after.append(over)
        with torch.no_grad():
            following = learner.value(torch.tensor(arrays.pursuers_see[:, 0]))
        gains = advantages(gained, values, after, following)
        returns = gains + torch.stack(values)
        learner.update(torch.cat(seen), torch.cat(acted), torch.cat(said), gains.flatten(), returns.flatten())
        if number % 10 == 9:
            spread = learner.spread.exp().mean()
            print(f"round {number + 1}: {won} of {ended} games captured, spread {spread:.2f}", flush=True)
            won = ended = 0
    return learner, games


def advantages(
    gained: list[torch.Tensor], values: list[torch.Tensor], over: list[torch.Tensor], following: torch.Tensor
) -> torch.Tensor:
    """Generalised advantages; a game that ended is worth nothing afterwards."""
    found = [torch.zeros_like(following)] * len(gained)
    sum_ = torch.zeros_like(following)
    for k in reversed(range(len(gained))):
        goes_on = (~over[k]).float()
        error = gained[k] + GAMMA * following * goes_on - values[k]
        sum_ = error + GAMMA * LAMBDA * goes_on * sum_
        found[k] = sum_
        following = values[k]
    return torch.stack(found)


def main() -> None:
    """Train and write the policy."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path, help="where to write the policy")
    parser.add_argument("--rounds", type=lambda text: parsed(text, Count, "--rounds"), default=120)
    parser.add_argument("--seed", type=lambda text: parsed(text, Seed, "--seed"), default=1)
    told = parser.parse_args()
    if not told.file.parent.is_dir():  # told before the training, not after it
        raise ConfigError(f"{told.file}: found no folder {told.file.parent}, expected one to write into")
    learner, games = train(told.rounds, told.seed)
    layers = tuple(
        (layer.weight.detach().numpy().astype(float), layer.bias.detach().numpy().astype(float))
        for layer in learner.actor
        if isinstance(layer, nn.Linear)
    )
    scale = learner.scale.numpy().astype(float)
    save(told.file, Policy("pursuer", games.task.form, Squash.TANH, scale, layers))
    print(f"{told.file}: {told.file.stat().st_size} bytes")


if __name__ == "__main__":
    run(main, "train.py")
