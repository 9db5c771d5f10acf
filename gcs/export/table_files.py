"""Tables as files: CSV by the standard library, Parquet by pyarrow where it is installed."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcs.export.run_data import RunData
from gcs.export.tables import Table
from onboard.config.strict import ConfigError


def as_csv(data: RunData) -> dict[str, bytes]:
    """Each table as CSV (UTF-8, a header, unknown cells empty), by file name."""
    return {f"{each.name}.csv": _csv(each) for each in data.tables}


def _csv(given: Table) -> bytes:
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(given)
    writer.writerows(zip(*(_cells(column) for column in given.values()), strict=True))
    return file.getvalue().encode()


def _cells(column: NDArray[Any]) -> list[Any]:
    if column.dtype.kind == "f":  # shortest digits that read back to the same number
        return ["" if value != value else repr(value) for value in column.tolist()]
    if column.dtype.kind == "b":
        return ["true" if value else "false" for value in column.tolist()]
    found: list[Any] = column.tolist()
    return found


def as_parquet(data: RunData) -> dict[str, bytes]:
    """Each table as Parquet, by file name. Raises ConfigError where pyarrow is not installed."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ModuleNotFoundError:
        raise ConfigError(
            "--format parquet: found no pyarrow, expected it: pip install pyarrow; csv needs nothing"
        ) from None
    found = {}
    for each in data.tables:
        columns = {name: pyarrow.array(_nullable(column)) for name, column in each.items()}
        sink = io.BytesIO()
        pyarrow.parquet.write_table(pyarrow.table(columns), sink, compression="zstd")
        found[f"{each.name}.parquet"] = sink.getvalue()
    return found


def _nullable(column: NDArray[Any]) -> Any:
    """A column for Arrow: NaN stays NaN, as NumPy has it; text as objects."""
    return column.astype(np.object_) if column.dtype.kind == "U" and len(column) else column


WRITERS: dict[str, Callable[[RunData], dict[str, bytes]]] = {"csv": as_csv, "parquet": as_parquet}
