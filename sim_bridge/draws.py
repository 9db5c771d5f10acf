"""Random numbers by counter: seed, vehicle, purpose and time step say what is drawn, and nothing else.

Threefry-2x32 with 20 rounds (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3",
SC11). No state: who draws, in which order, and who else draws changes nothing. Kernel style, over integers
of 64 bits that hold 32: the same functions run interpreted, compiled, and over arrays of NumPy.
"""

from __future__ import annotations

from enum import IntEnum
from math import log, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

WORD = 0xFFFFFFFF
PARITY = 0x1BD11BDA  # Skein's constant, of the key's third word
UNIT = 1.0 / 4294967296.0
CENTRE = 0.425  # half the share of the normal distribution that `central` is for
BLOCK = 256  # steps that a stream draws at once


class Purpose(IntEnum):
    """What numbers are drawn for; values are part of what a seed means, so none is ever used again."""

    GUST = 1  # five an instant of the gusts' grid
    SENSOR = 2  # one uniform and six normal a measurement
    PLACE = 3  # where a campaign's vehicle starts
    WIND = 4  # where a campaign's wind comes from (vehicle 0)
    ESTIMATE = 5  # what is wrong with an autopilot's estimate of the wind: five, once
    PLAN = 6  # which messages of a team's plan are lost (vehicle 0)


class Key(NamedTuple):
    """Two words of 32 bits: the key of a generator, or a pair of numbers drawn."""

    a: int
    b: int


def four_rounds(a: Any, b: Any, r: int, s: int, t: int, u: int) -> Any:
    """Four rounds of Threefry-2x32 by the rotations r, s, t, u."""
    a = (a + b) & WORD
    b = (((b << r) | (b >> (32 - r))) & WORD) ^ a
    a = (a + b) & WORD
    b = (((b << s) | (b >> (32 - s))) & WORD) ^ a
    a = (a + b) & WORD
    b = (((b << t) | (b >> (32 - t))) & WORD) ^ a
    a = (a + b) & WORD
    b = (((b << u) | (b >> (32 - u))) & WORD) ^ a
    return a, b


def threefry(k0: Any, k1: Any, c0: Any, c1: Any) -> Any:
    """Threefry-2x32-20 of a key and a counter: two words of 32 bits."""
    k2 = PARITY ^ k0 ^ k1
    a, b = four_rounds((c0 + k0) & WORD, (c1 + k1) & WORD, 13, 15, 26, 6)
    a, b = four_rounds((a + k1) & WORD, (b + k2 + 1) & WORD, 17, 29, 16, 24)
    a, b = four_rounds((a + k2) & WORD, (b + k0 + 2) & WORD, 13, 15, 26, 6)
    a, b = four_rounds((a + k0) & WORD, (b + k1 + 3) & WORD, 17, 29, 16, 24)
    a, b = four_rounds((a + k1) & WORD, (b + k2 + 4) & WORD, 13, 15, 26, 6)
    return (a + k2) & WORD, (b + k0 + 5) & WORD


def key_of(seed: int, vehicle: int, purpose: int) -> Key:
    """The key of one vehicle's numbers for one purpose; of `seed` 64 bits count."""
    a, b = threefry(seed & WORD, (seed >> 32) & WORD, vehicle, purpose)
    return Key(a, b)


def uniform(word: Any) -> Any:
    """A number in (0, 1), never an end of it: the middle of the word's share."""
    return (word + 0.5) * UNIT


def central(q: Any) -> Any:
    """Inverse of the normal distribution at 0.5 + q, for |q| ≤ CENTRE (Wichura's AS 241, PPND16)."""
    r = CENTRE * CENTRE - q * q
    above = 3.3430575583588128105e4 + r * 2.5090809287301226727e3
    above = 4.5921953931549871457e4 + r * (6.7265770927008700853e4 + r * above)
    above = 1.9715909503065514427e3 + r * (1.3731693765509461125e4 + r * above)
    above = 3.3871328727963666080e0 + r * (1.3314166789178437745e2 + r * above)
    below = 2.8729085735721942674e4 + r * 5.2264952788528545610e3
    below = 2.1213794301586595867e4 + r * (3.9307895800092710610e4 + r * below)
    below = 6.8718700749205790830e2 + r * (5.3941960214247511077e3 + r * below)
    return q * above / (1.0 + r * (4.2313330701600911252e1 + r * below))


def tail(p: float) -> float:
    """Minus the inverse of the normal distribution at a small `p` (AS 241), for p above 1e-11."""
    r = sqrt(-log(p)) - 1.6
    above = 2.27238449892691845833e-2 + r * 7.74545014278341407640e-4
    above = 1.27045825245236838258e0 + r * (2.41780725177450611770e-1 + r * above)
    above = 5.76949722146069140550e0 + r * (3.64784832476320460504e0 + r * above)
    above = 1.42343711074968357734e0 + r * (4.63033784615654529590e0 + r * above)
    below = 5.47593808499534494600e-4 + r * 1.05075007164441684324e-9
    below = 1.48103976427480074590e-1 + r * (1.51986665636164571966e-2 + r * below)
    below = 1.67638483018380384940e0 + r * (6.89767334985100004550e-1 + r * below)
    return above / (1.0 + r * (2.05319162663775882187e0 + r * below))


def normal(word: int) -> float:
    """The standard normal number of a word, by the inverse of its distribution."""
    p = uniform(word)
    q = p - 0.5
    if abs(q) <= CENTRE:
        return float(central(q))
    if q < 0.0:
        return -tail(p)
    return tail(1.0 - p)


def rows(key: Key, first: int, count: int, width: int) -> NDArray[np.int64]:
    """Words of the steps from `first` on: (count, width)."""
    steps = np.arange(first, first + count, dtype=np.int64)[:, None]
    pairs = np.arange((width + 1) // 2, dtype=np.int64)[None, :]
    a, b = threefry(key.a, key.b, steps & WORD, pairs)
    return np.stack([a, b], axis=2).reshape(count, -1)[:, :width]


def normals(words: NDArray[np.int64]) -> NDArray[np.float64]:
    """`normal` of an array, to the bit."""
    q = uniform(words) - 0.5
    found = np.asarray(central(q), dtype=np.float64)
    for place in zip(*np.nonzero(np.abs(q) > CENTRE), strict=True):
        found[place] = normal(int(words[place]))
    return found


class Stream:
    """The numbers of one key, `width` words a step, for who asks step by step in interpreted code."""

    def __init__(self, key: Key, width: int, uniforms: int = 0, block: int = BLOCK) -> None:
        """Of the words of a step the first `uniforms` become numbers in (0, 1), the others normal ones.

        `block` steps are drawn at once; it changes no number.
        """
        self._key, self._width, self._uniforms, self._block = key, width, uniforms, block
        self._first = 0
        self._rows: list[list[float]] = []

    def at(self, step: int) -> list[float]:
        """The numbers of a step; steps may be asked for in any order, and again."""
        row = step - self._first
        if not 0 <= row < len(self._rows):
            self._first, row = step - step % self._block, step % self._block
            words = rows(self._key, self._first, self._block, self._width)
            n = self._uniforms
            self._rows = np.concatenate([uniform(words[:, :n]), normals(words[:, n:])], axis=1).tolist()
        return self._rows[row]
