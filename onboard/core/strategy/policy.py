"""A trained policy as a strategy: a small network between observation and action. Kernel style.

`weights` holds, layer after layer, the matrix (row after row, a row an output) and then the biases. It is a
list onboard and an array where the strategy is compiled.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from math import tanh
from typing import NamedTuple

from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.game.views import EvaderView, PursuerView
from onboard.core.strategy.features import Form, answer, evader_features, pursuer_features
from onboard.core.strategy.knowledge import Decision


class Squash(IntEnum):
    """What follows each hidden layer."""

    TANH = 0
    RELU = 1


class Net(NamedTuple):
    """The shape of a network."""

    sizes: tuple[int, ...]  # inputs, hidden layers, outputs
    squash: Squash


def weights_of(sizes: Sequence[int]) -> int:
    """How many weights a network of these sizes has."""
    return sum((sizes[k] + 1) * sizes[k + 1] for k in range(len(sizes) - 1))


def run(net: Net, weights: Sequence[float], inputs: list[float]) -> list[float]:
    """The outputs of a network."""
    values = inputs
    first = 0
    last = len(net.sizes) - 2
    for layer in range(last + 1):
        n, m = net.sizes[layer], net.sizes[layer + 1]
        out = [0.0] * m
        for j in range(m):
            total = weights[first + n * m + j]
            for i in range(n):
                total += weights[first + j * n + i] * values[i]
            if layer < last:
                if net.squash == Squash.TANH:
                    total = tanh(total)
                elif total < 0.0:
                    total = 0.0
            out[j] = total
        first += (n + 1) * m
        values = out
    return values


def pursuer_policy(net: Net, form: Form, weights: Sequence[float]) -> PursuerStrategy:
    """The pursuers' strategy of a network whose outputs are actions of `form`."""

    def decide(view: PursuerView) -> Decision:
        seen = [0.0] * net.sizes[0]
        turn = pursuer_features(view, form, seen)
        return answer(view.own, view.limits, run(net, weights, seen), turn, form)

    return decide


def evader_policy(net: Net, form: Form, weights: Sequence[float]) -> EvaderStrategy:
    """The evader's strategy of a network whose outputs are actions of `form`."""

    def decide(view: EvaderView) -> Decision:
        seen = [0.0] * net.sizes[0]
        turn = evader_features(view, form, seen)
        return answer(view.own, view.limits, run(net, weights, seen), turn, form)

    return decide
