"""LSTM and GRU of 32 units in PyTorch, given everything the predictor that flies is given.

Same windows in heading frames, mirrored copies, innovations over constant velocity, all horizons at
once; early stopping on the newest quarter of the windows. One thread.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from torch import nn

from onboard.pilot.predictor.heading import turn, windows
from tests.benchmarks.predictor.families import Array

UNITS = 32
EPOCHS = 400
PATIENCE = 15
RATE = 0.01

torch.set_num_threads(1)


class Net(nn.Module):
    """A recurrent layer over the moves, oldest first, and a linear output."""

    def __init__(self, kind: str, inputs: int, outputs: int) -> None:
        super().__init__()
        layer: Any = nn.LSTM if kind == "LSTM" else nn.GRU
        self.layer = layer(inputs, UNITS, batch_first=True)
        self.out = nn.Linear(UNITS, outputs)

    def forward(self, x: Any) -> Any:
        """(k, L, inputs) → (k, outputs)"""
        hidden, _ = self.layer(x)
        return self.out(hidden[:, -1])


class Recurrent:
    """One network for one trajectory."""

    def __init__(self, kind: str, horizons: tuple[int, ...], points: int = 20) -> None:
        self.kind, self.horizons, self.points = kind, np.array(horizons), points

    def fit(self, positions: Array, velocities: Array, seed: int) -> None:
        """Train on positions (n, 3) and velocities (n, 3) [m a step]."""
        torch.manual_seed(seed)
        total, last = len(positions), int(self.horizons[-1])
        origins = np.arange(self.points - 1, total)
        view = windows(positions, velocities, origins, self.points)
        self.axes = [0, 1, 2] if np.abs(view.moves[:, :, 2]).max() > 1e-9 else [0, 1]
        ahead = origins[:, None] + self.horizons
        known = ahead < total
        ends = positions[np.minimum(ahead, total - 1)]
        mean = (ends - positions[origins][:, None]) / self.horizons[None, :, None]
        wanted = turn(mean, view.cos, view.sin) - view.moves[:, :1]
        x, y = view.moves[:, ::-1][:, :, self.axes], wanted[:, :, self.axes]
        self.middle = x.mean(axis=(0, 1)) * (np.array(self.axes) != 1)
        self.scale = (x - self.middle).std(axis=(0, 1)) + 1e-9
        mask = np.repeat(known[:, :, None], len(self.axes), axis=2)
        self.spread = np.sqrt((y**2 * mask).sum(axis=0) / mask.sum(axis=0)) + 1e-9
        x, y = (x - self.middle) / self.scale, y / self.spread * mask
        cut = max(1, (len(x) - last) * 3 // 4)
        mirror = np.where(np.array(self.axes) == 1, -1.0, 1.0)

        def both(part: slice) -> tuple[Any, Any, Any]:
            xs, ys, ms = x[part], y[part], mask[part]
            copies = ((xs, xs * mirror), (ys, ys * mirror), (ms, ms))
            a, b, c = (torch.tensor(np.concatenate(pair), dtype=torch.float32) for pair in copies)
            return a, b, c

        train, test = both(slice(0, cut)), both(slice(cut, len(x)))
        net = Net(self.kind, len(self.axes), y[0].size)
        optimiser = torch.optim.Adam(net.parameters(), lr=RATE)

        def loss(data: tuple[Any, Any, Any]) -> Any:
            said = net(data[0]).reshape(data[1].shape)
            return (((said - data[1]) * data[2]) ** 2).sum() / data[2].sum()

        best, waited, kept = float("inf"), 0, net.state_dict()
        for _ in range(EPOCHS):
            optimiser.zero_grad()
            loss(train).backward()
            optimiser.step()
            with torch.no_grad():
                now = float(loss(test))
            if now < best * 0.999:
                best, waited = now, 0
                kept = {name: value.clone() for name, value in net.state_dict().items()}
            else:
                waited += 1
                if waited >= PATIENCE:
                    break
        net.load_state_dict(kept)
        self.net = net.eval()

    def predict(self, positions: Array, velocity: Array) -> Array:
        """Places (H, 3) from the last positions and the velocity now [m a step]."""
        recent = positions[-self.points :]
        newest = np.broadcast_to(velocity, recent.shape)
        view = windows(recent, newest, np.array([self.points - 1]), self.points)
        x = (view.moves[:, ::-1][:, :, self.axes] - self.middle) / self.scale
        with torch.no_grad():
            raw = self.net(torch.tensor(x, dtype=torch.float32)).numpy().reshape(len(self.horizons), -1)
        innovation = np.zeros((len(self.horizons), 3))
        innovation[:, self.axes] = raw * self.spread
        mean = velocity + turn(innovation[None], view.cos, -view.sin)[0]
        out: Array = positions[-1] + mean * self.horizons[:, None]
        return out
