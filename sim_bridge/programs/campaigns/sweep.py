"""Sweep files: which values the keys of a scenario take in a campaign. TOML.

```toml
[list]                       # each value with each of every other key
"evader.speed" = [5.0, 6.0]
[range]                      # evenly spaced, both ends included
"parameters.R" = { from = 2.0, to = 20.0, count = 10 }
[latin-hypercube]            # or [sobol]: points that fill the space between
count = 64
seed = 1
between = { "pursuers.speed" = [3.0, 5.0], "flight.wind.speed" = [0.0, 10.0] }
```

A key is a path in the scenario file; `pursuers.speed` means all pursuers, `pursuers[0].speed` the first.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import product
from math import log2
from pathlib import Path
from typing import Annotated, Any

import msgspec

from onboard.config import strict
from onboard.config.bounds import Seed
from onboard.config.strict import ConfigError, StrictConfig, demand

POINTS_MAX = 100_000
Value = float | int | str | bool
Point = dict[str, Value]  # value of each swept key, by its path
Values = Annotated[list[Value], msgspec.Meta(min_length=1, description="one value or more")]
Interval = Annotated[tuple[float, float], msgspec.Meta(description="two numbers, from and to")]
PointCount = Annotated[int, msgspec.Meta(ge=1, le=POINTS_MAX, description=f"1 to {POINTS_MAX} points")]
StepCount = Annotated[int, msgspec.Meta(ge=2, le=POINTS_MAX, description=f"2 to {POINTS_MAX} values")]


class Range(StrictConfig, frozen=True, rename={"first": "from", "last": "to"}):
    """Evenly spaced values, both ends included."""

    first: float
    last: float
    count: StepCount

    def values(self) -> list[Value]:
        """All of them."""
        step = (self.last - self.first) / (self.count - 1)
        return [*(self.first + k * step for k in range(self.count - 1)), self.last]


class Filling(StrictConfig, frozen=True):
    """Points that fill the space between."""

    count: PointCount
    between: Mapping[str, Any]  # an interval, two numbers, for each key
    seed: Seed = 0

    def __post_init__(self) -> None:
        demand(bool(self.between), "between", "nothing", "a key or more with its interval")

    def intervals(self, name: str) -> dict[str, Interval]:
        """All intervals. Raises ConfigError that begins with `name`."""
        found: dict[str, Interval] = {}
        for key, ends in self.between.items():
            at = f"{name}: between.{key}"
            kind: Any = Interval
            low, high = strict.convert(ends, kind, at)
            if not low < high:
                raise ConfigError(f"{at}: found {low:g} to {high:g}, expected a growing interval")
            found[key] = (low, high)
        return found


class Sobol(Filling, frozen=True):
    """Points of a scrambled Sobol sequence."""

    def __post_init__(self) -> None:
        super().__post_init__()
        whole = log2(self.count).is_integer()
        demand(whole, "count", self.count, "a power of two, as the sequence is balanced there alone")


class Sweep(StrictConfig, frozen=True, rename={"hypercube": "latin-hypercube", "lists": "list",
                                               "ranges": "range"}):  # fmt: skip
    """A whole sweep file; the points are every combination of what its tables give."""

    lists: Mapping[str, Any] = msgspec.field(default_factory=dict)
    ranges: Mapping[str, Any] = msgspec.field(default_factory=dict)
    hypercube: Filling | None = None
    sobol: Sobol | None = None

    def __post_init__(self) -> None:
        demand(self.hypercube is None or self.sobol is None, "sobol", "beside latin-hypercube", "one of them")
        named = [*self.lists, *self.ranges]
        filling = self.hypercube or self.sobol
        named += [] if filling is None else list(filling.between)
        for key in named:
            demand(named.count(key) == 1, key, "a key in two tables", "each key once")
        demand(bool(named), "list", "no key at all", "a key or more with its values")


def load(path: Path) -> list[Point]:
    """All points of a sweep file. Raises ConfigError."""
    sweep = strict.read(path, Sweep)
    axes: list[list[Point]] = []
    for key, listed in sweep.lists.items():
        kind: Any = Values
        axes.append([{key: value} for value in strict.convert(listed, kind, f"{path}: list.{key}")])
    for key, table in sweep.ranges.items():
        one: Range = strict.convert(table, Range, f"{path}: range.{key}")
        axes.append([{key: value} for value in one.values()])
    filling = sweep.hypercube or sweep.sobol
    count = filling.count if filling is not None else 1
    for axis in axes:
        count *= len(axis)
    if count > POINTS_MAX:
        raise ConfigError(f"{path}: found {count} points, expected at most {POINTS_MAX}")
    if filling is not None:
        axes.append(filled(filling, str(path), sobol=sweep.sobol is not None))
    return [{key: value for part in parts for key, value in part.items()} for parts in product(*axes)]


def filled(filling: Filling, name: str, *, sobol: bool) -> list[Point]:
    """Points of a Latin hypercube or a Sobol sequence. Raises ConfigError that begins with `name`."""
    from scipy.stats import qmc

    intervals = filling.intervals(f"{name}: {'sobol' if sobol else 'latin-hypercube'}")
    keys = list(intervals)
    kind = qmc.Sobol if sobol else qmc.LatinHypercube
    unit = kind(d=len(keys), rng=filling.seed).random(filling.count)
    low, high = zip(*intervals.values(), strict=True)
    return [dict(zip(keys, map(float, row), strict=True)) for row in qmc.scale(unit, low, high)]


_STEP = re.compile(r"([A-Za-z_]\w*)(?:\[(\d+)\])?")


def steps_of(path: str) -> list[str | int] | None:
    """A key's path in its steps, `pursuers[0].speed` = ["pursuers", 0, "speed"]; None where it is no path."""
    steps: list[str | int] = []
    for part in path.split("."):
        found = _STEP.fullmatch(part)
        if found is None:
            return None
        steps += [found[1]] if found[2] is None else [found[1], int(found[2])]
    return steps


def put(data: Any, steps: list[str | int], value: Value) -> bool:
    """Put a value at a path of plain data, in every entry where a list stands without a number; whether
    there was such a place (that the key itself is known is for the conversion to say)."""
    step, *rest = steps
    if isinstance(data, list):
        if isinstance(step, int):
            return step < len(data) and put(data[step], rest, value)
        return bool(data) and all([put(entry, steps, value) for entry in data])
    if not isinstance(data, dict) or isinstance(step, int):
        return False
    if not rest:
        data[step] = value
        return True
    if step not in data and not isinstance(rest[0], int):
        data[step] = {}
    return step in data and put(data[step], rest, value)
