"""Columns of a recorded run for programs that reckon: NumPy arrays by name, with the units in the names.

Positions and velocities are in the game frame (north, east, down); `t_s` counts from t₀ (from the first
message where no game was started), `stamp_ns` is the wall instant that a value is of [ns since 1970, UTC] (of
a run on virtual time: from a made-up date). What is not known is NaN, or an empty text.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

KINDS: dict[str, Any] = {"stamp_ns": np.int64, "arrival_ns": np.int64, "id": np.int64, "number": np.int64,
                         "quarry_id": np.int64}
"""Columns of whole numbers; those in TEXTS are text, those in FLAGS yes or no, all others numbers."""
TEXTS = frozenset(
    ("role", "mode", "level", "module", "strategy", "rule", "supervisor", "reason", "predictor", "sensor",
     "stage", "version", "severity", "kind", "text")
)  # fmt: skip
FLAGS = frozenset(("armed", "ekf_ok"))


class Table(Mapping[str, NDArray[Any]]):
    """Columns of one length, in order of time: `table["north_m"]` is an array of shape (rows,)."""

    def __init__(self, name: str, columns: Mapping[str, NDArray[Any]]) -> None:
        self.name = name
        self._columns = dict(columns)

    def __getitem__(self, column: str) -> NDArray[Any]:
        if column not in self._columns:
            raise KeyError(f"{self.name}: found no column '{column}', expected one of {', '.join(self)}")
        return self._columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """How many columns there are."""
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<{self.name}: {self.rows} rows of {', '.join(self)}>"

    @property
    def rows(self) -> int:
        """How many rows there are."""
        return len(next(iter(self._columns.values()))) if self._columns else 0

    @property
    def ids(self) -> tuple[int, ...]:
        """The vehicles that it has rows of."""
        return tuple(int(id) for id in np.unique(self["id"]))

    def of(self, *ids: int) -> Table:
        """The rows of these vehicles alone."""
        kept = np.isin(self["id"], ids)
        return Table(self.name, {name: column[kept] for name, column in self.items()})

    def at(self, rows: NDArray[Any]) -> Table:
        """Some rows: by their numbers, or by a mask."""
        return Table(self.name, {name: column[rows] for name, column in self.items()})

    def frame(self) -> Any:
        """A pandas DataFrame of it. Raises ModuleNotFoundError where pandas is not installed."""
        import pandas

        return pandas.DataFrame(self._columns)


def table(name: str, columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> Table:
    """A table from rows, put in order of `stamp_ns` (those of one instant keep their order)."""
    by_column = list(zip(*rows, strict=True)) if rows else [()] * len(columns)
    found = {column: _array(column, values) for column, values in zip(columns, by_column, strict=True)}
    order = np.argsort(found["stamp_ns"], kind="stable")
    return Table(name, {column: values[order] for column, values in found.items()})


def _array(column: str, values: Sequence[Any]) -> NDArray[Any]:
    if column in TEXTS:
        return np.array(values, dtype=np.str_ if values else "<U1")
    if column in FLAGS:
        return np.array(values, dtype=np.bool_)
    return np.array(values, dtype=KINDS.get(column, np.float64))


def with_time(given: Table, zero_ns: int) -> Table:
    """The table with `t_s`, seconds since `zero_ns`, in front."""
    seconds = (given["stamp_ns"] - zero_ns) / 1e9
    return Table(given.name, {"t_s": seconds, **given})
