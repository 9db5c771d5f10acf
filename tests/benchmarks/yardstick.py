"""How fast this machine runs Python and compiled code just now, and what the benchmarks cost in that measure.

The same machine runs Python three times slower on another day, and a build of Python with profile-guided
optimisation (PGO) a third faster. So a cost is kept in rounds of a fixed loop that was timed beside it: in
Python for what is interpreted, compiled by numba for what is compiled. `make bench` collects them in
LATEST, and `python -m tests.benchmarks.compare` sets them beside the committed ones, COSTS.
"""

from __future__ import annotations

import sysconfig
from collections.abc import Callable
from enum import StrEnum
from functools import cache
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

import msgspec

from tests.support.paths import RESULTS

COSTS = RESULTS / "costs.json"  # committed
LATEST = RESULTS / "latest-costs.json"  # of the last `make bench`
TRIES = 5  # the best counts: what else the machine did only makes a loop slower
MEASURED = 3  # times, what is measured whole
ROUNDS_PYTHON, ROUNDS_COMPILED = 200_000, 5_000_000


class Yard(StrEnum):
    """What a cost is measured in."""

    PYTHON = "rounds of the Python loop"
    COMPILED = "rounds of the compiled loop"
    NONE = "ratio within the run"


class Rates(NamedTuple):
    """Millions of rounds a CPU-second."""

    python: float
    compiled: float | None  # None where numba is not installed


class Cost(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What something costs; less is better."""

    value: float
    yard: Yard


def _loop(count: int) -> float:
    x = 0.5
    for _ in range(count):
        x = 3.9 * x * (1.0 - x)
    return x


@cache
def _compiled() -> Callable[[int], Any] | None:
    try:
        import numba
    except ImportError:
        return None
    made: Callable[[int], Any] = numba.njit(_loop)
    made(1)
    return made


def _rate(loop: Callable[[int], object], count: int) -> float:
    """Millions of rounds a CPU-second, the best of some tries."""
    best = 0.0
    for _ in range(TRIES):
        begin = process_time()
        loop(count)
        best = max(best, count / 1e6 / (process_time() - begin))
    return best


def rates() -> Rates:
    """Both yardsticks, now: a fifth of a second."""
    compiled = _compiled()
    return Rates(_rate(_loop, ROUNDS_PYTHON), None if compiled is None else _rate(compiled, ROUNDS_COMPILED))


def build() -> str:
    """Whether this interpreter was built with profile-guided optimisation."""
    told = sysconfig.get_config_var("CONFIG_ARGS")
    if not told:
        return "build unknown"
    return "PGO build" if "--enable-optimizations" in told else "build that names no PGO"


def words() -> str:
    """Both yardsticks and the build, for the head of a page."""
    found = rates()
    compiled = "no numba" if found.compiled is None else f"{found.compiled:.0f} compiled"
    return f"{build()}; yardsticks {found.python:.1f} in Python, {compiled} (million rounds a CPU-second)"


def cost(name: str, seconds: float, yard: Yard = Yard.PYTHON) -> None:
    """Keep what something took, in CPU seconds; call it right after the measurement.

    Raises ValueError for a cost that is not above zero, or a yard that cannot be had here."""
    found = rates()
    rate = {Yard.PYTHON: found.python, Yard.COMPILED: found.compiled}.get(yard)
    if rate is None:
        raise ValueError(f"{name}: there is no rate for a cost in {yard.value}")
    _keep(name, seconds * rate * 1e6, yard)


def least(measure: Callable[[], float]) -> float:
    """The least of some measurements: one by itself has been twice another of the same state."""
    return min(measure() for _ in range(MEASURED))


def ratio(name: str, value: float) -> None:
    """Keep a cost that is a ratio to something else in the same run already."""
    _keep(name, value, Yard.NONE)


def _keep(name: str, value: float, yard: Yard, file: Path | None = None) -> None:
    if not 0.0 < value < float("inf"):
        raise ValueError(f"{name}: a cost must be above zero and finite, not {value}")
    file = LATEST if file is None else file
    kept = read(file) if file.exists() else {}
    kept[name] = Cost(float(f"{value:.4g}"), yard)
    write(file, kept)


def read(file: Path) -> dict[str, Cost]:
    """The costs in a file; ValueError names a file that holds something else."""
    try:
        return msgspec.json.decode(file.read_bytes(), type=dict[str, Cost])
    except msgspec.MsgspecError as problem:
        raise ValueError(f"{file}: {problem}") from None


def write(file: Path, costs: dict[str, Cost]) -> None:
    """Costs in order of name."""
    ordered = {name: costs[name] for name in sorted(costs)}
    file.write_bytes(msgspec.json.format(msgspec.json.encode(ordered), indent=1) + b"\n")
