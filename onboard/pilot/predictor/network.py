"""Two layers of s-parabola neurons, trained by Levenberg–Marquardt with the analytic Jacobian.

Both layers carry the activation of (25)–(26); there are several outputs. For training the slope at
0, infinite in (23)–(24), is smoothed: √(2p) s / (s² + ε²)^¼. Training minimises the squared error
of the outputs; a mask leaves out targets that are not known yet.

The normal equations JᵀJ are summed from their structure, without the Jacobian itself: output
neurons share the first layer only, so the second layer's part is one small block an output.
"""

from __future__ import annotations

from collections.abc import Generator
from functools import cache
from typing import NamedTuple

import numpy as np

from onboard.pilot.predictor.activation import Array, SParabola, smooth_root, smooth_root_slope
from onboard.pilot.predictor.heading import Indices


class Weights(NamedTuple):
    """Weights of both layers; row 0 of each holds the biases."""

    first: Array  # (n + 1, m)
    second: Array  # (m + 1, o)


class Normal(NamedTuple):
    """Normal equations at some weights; parameters in the order first, second (both row by row)."""

    matrix: Array  # JᵀJ (P, P)
    gradient: Array  # Jᵀr (P,)
    cost: float  # Σ r²


class Batch(NamedTuple):
    """Samples to train on."""

    inputs: Array  # (k, n + 1), column 0 is 1
    targets: Array  # (k, o)
    mask: Array  # (k, o), 1 = known, 0 = not
    products: Array  # (k, n'(n'+1)/2) of each pair of inputs, n' = n + 1
    pair: Indices  # (n', n') where in `products` a pair is


def batch(inputs: Array, targets: Array, mask: Array) -> Batch:
    """A batch of inputs (k, n), targets (k, o) and mask (k, o)."""
    x = np.hstack([np.ones((len(inputs), 1)), inputs])
    a, b = _pairs(x.shape[1])
    return Batch(x, np.where(mask > 0.0, targets, 0.0), mask, x[:, a] * x[:, b], _square(x.shape[1]))


def output(act: SParabola, weights: Weights, inputs: Array, epsilon: float = 0.0) -> Array:
    """Outputs (k, o) for inputs (k, n + 1) whose column 0 is 1; smoothed where ε > 0."""
    hidden = _value(act, inputs @ weights.first, epsilon)
    return _value(act, weights.second[0] + hidden @ weights.second[1:], epsilon)


def jacobian(act: SParabola, weights: Weights, data: Batch, epsilon: float) -> Array:
    """∂output/∂parameters (k·o, P), written out in full: what `normal` sums up without it."""
    first, second = weights
    s1 = data.inputs @ first
    g1 = _slope(act, s1, epsilon)
    y1 = np.hstack([np.ones((len(s1), 1)), _value(act, s1, epsilon)])
    g2 = _slope(act, y1 @ second, epsilon) * data.mask
    k, outputs = g2.shape
    by_first = np.einsum("ko,jo,kj,ki->koij", g2, second[1:], g1, data.inputs).reshape(k * outputs, -1)
    by_second = np.einsum("ko,kl,op->kolp", g2, y1, np.eye(outputs)).reshape(k * outputs, -1)
    return np.hstack([by_first, by_second])


def normal(act: SParabola, weights: Weights, data: Batch, epsilon: float) -> Normal:
    """JᵀJ and Jᵀr by blocks."""
    first, second = weights
    n, m = first.shape
    outputs = second.shape[1]
    x = data.inputs
    count = len(x)
    s1 = x @ first
    g1 = _slope(act, s1, epsilon)  # (k, m)
    y1 = np.hstack([np.ones((count, 1)), _value(act, s1, epsilon)])  # (k, m + 1)
    s2 = y1 @ second
    g2 = _slope(act, s2, epsilon) * data.mask  # (k, o)
    r = (data.targets - _value(act, s2, epsilon)) * data.mask
    square = g2 * g2
    w = second[1:]  # (m, o)

    # First layer with itself: Σ_k x_i x_i' · g1_j g1_j' · Σ_o g2² w_jo w_j'o, symmetric in j and j'.
    a, b = _pairs(m)
    coupling = (square @ (w[a] * w[b]).T) * (g1[:, a] * g1[:, b])  # (k, m(m+1)/2)
    halves = data.products.T @ coupling  # (n(n+1)/2, m(m+1)/2)
    full = halves[data.pair][:, :, _square(m)]  # (n, n, m, m)
    top = full.transpose(0, 2, 1, 3).reshape(n * m, n * m)

    # First with second: Σ_k x_i g1_j y_l · g2² · w_jo.
    xg = (x[:, :, None] * g1[:, None, :]).reshape(count, n * m)  # (k, n·m)
    cross = np.empty((n, m, m + 1, outputs))
    for row in range(m + 1):  # one at a time: memory
        cross[:, :, row] = ((xg * y1[:, row : row + 1]).T @ square).reshape(n, m, outputs)
    cross = (cross * w[None, :, None, :]).reshape(n * m, (m + 1) * outputs)

    # Second with itself: one block an output.
    own = (y1[:, :, None] * y1[:, None, :]).reshape(count, -1).T @ square  # ((m+1)², o)
    size = n * m + (m + 1) * outputs
    matrix = np.zeros((size, size))
    matrix[: n * m, : n * m] = top
    matrix[: n * m, n * m :] = cross
    matrix[n * m :, : n * m] = cross.T
    low = matrix[n * m :, n * m :].reshape(m + 1, outputs, m + 1, outputs)
    each = np.arange(outputs)
    low[:, each, :, each] = own.reshape(m + 1, m + 1, outputs).transpose(2, 0, 1)

    rg = r * g2
    gradient = np.concatenate([(x.T @ ((rg @ w.T) * g1)).ravel(), (y1.T @ rg).ravel()])
    return Normal(matrix, gradient, float((r * r).sum()))


def cost(act: SParabola, weights: Weights, data: Batch, epsilon: float) -> float:
    """Σ r² over known targets."""
    r = (data.targets - output(act, weights, data.inputs, epsilon)) * data.mask
    return float((r * r).sum())


def start(
    act: SParabola, data: Batch, neurons: int, rng: np.random.Generator, epsilon: float, ridge: float
) -> Weights:
    """A random first layer, and the ridge solution of the second through the inverse activation."""
    n = data.inputs.shape[1]
    first = rng.normal(0.0, 1.0, (n, neurons)) / np.sqrt(n)
    y1 = np.hstack([np.ones((len(data.inputs), 1)), _value(act, data.inputs @ first, epsilon)])
    wanted = act.inverse(data.targets)
    second = np.empty((neurons + 1, data.targets.shape[1]))
    for o in range(second.shape[1]):
        known = y1 * data.mask[:, o : o + 1]
        gram = known.T @ known
        second[:, o] = np.linalg.solve(
            gram + ridge * (np.trace(gram) / len(gram) + 1e-9) * np.eye(len(gram)), known.T @ wanted[:, o]
        )
    return Weights(first, second)


def train(
    act: SParabola, weights: Weights, data: Batch, iterations: int, epsilon: float, decay: float
) -> Generator[None, None, Weights]:
    """Levenberg–Marquardt: yields after each set of equations and each step, returns the best weights.

    `decay` pulls the weights towards zero (a prior of as many samples' worth); the damping follows
    success and failure. A step that does not lower the cost is not taken."""
    best = weights
    damping = 0.01
    shape = weights.first.shape
    split = weights.first.size
    each = np.arange(split + weights.second.size)
    for _ in range(iterations):
        eq = normal(act, best, data, epsilon)
        yield
        theta = np.concatenate([best.first.ravel(), best.second.ravel()])
        here = eq.cost + decay * float(theta @ theta)
        gradient = eq.gradient - decay * theta
        diagonal = np.diag(eq.matrix) + decay
        for _ in range(3):
            loaded = eq.matrix.copy()
            loaded[each, each] += decay + damping * diagonal
            step = np.linalg.solve(loaded, gradient)
            moved = theta + step
            tried = Weights(moved[:split].reshape(shape), moved[split:].reshape(best.second.shape))
            if cost(act, tried, data, epsilon) + decay * float(moved @ moved) < here:
                best = tried
                damping = max(damping * 0.3, 1e-7)
                break
            damping = min(damping * 5.0, 1e7)
            yield
        else:
            return best  # no step lowers the cost: this is a minimum
        yield
    return best


@cache
def _pairs(size: int) -> tuple[Indices, Indices]:
    """Rows and columns of an upper triangle, read only: the sizes are those of a few models."""
    a, b = np.triu_indices(size)
    a.flags.writeable = b.flags.writeable = False
    return a, b


@cache
def _square(size: int) -> Indices:
    """(size, size), read only: the place of each pair among `_pairs`."""
    out = np.zeros((size, size), dtype=np.intp)
    a, b = _pairs(size)
    out[a, b] = out[b, a] = np.arange(len(a))
    out.flags.writeable = False
    return out


def _value(act: SParabola, s: Array, epsilon: float) -> Array:
    if epsilon <= 0.0:
        return act.value(s)
    out: Array = np.sqrt(2.0 * act.p) * smooth_root(s, epsilon) + act.beta
    return out


def _slope(act: SParabola, s: Array, epsilon: float) -> Array:
    if epsilon <= 0.0:
        return act.slope(s)
    out: Array = np.sqrt(2.0 * act.p) * smooth_root_slope(s, epsilon)
    return out
