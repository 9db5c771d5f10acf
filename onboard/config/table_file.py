"""Reads tables as people and their programs write them: CSV from spreadsheets, receivers and scripts.

A byte-order mark, UTF-16 and Latin-1 are understood, as are `;` or a tabulator for the comma, blanks around
cells, decimal commas beside `;`, comments that begin with `#`, and empty lines.
"""

from __future__ import annotations

import codecs
import csv
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from math import isfinite
from pathlib import Path
from statistics import median
from typing import NamedTuple

from onboard.config.strict import ConfigError

STEP_MAX_S = 30.0  # rows of a track lie closer together than this
BYTES_MAX = 1 << 30  # a larger file is no table of ours


class Row(NamedTuple):
    """A row of a table."""

    place: str  # file and line, for errors
    cells: Mapping[str, str]  # by column, without blanks around them

    def number(self, name: str, otherwise: float | None = None) -> float:
        """A finite number; `otherwise` where the cell is empty or missing. Raises ConfigError."""
        text = self.cells.get(name, "")
        if not text and otherwise is not None:
            return otherwise
        try:
            value = float(text)
        except ValueError:
            value = float("nan")
        if not isfinite(value):
            raise ConfigError(f"{self.place}: {name}: found {text!r}, expected a finite number")
        return value


def text_of(path: Path) -> str:
    """The text of a file whatever of the usual encodings it is in. Raises ConfigError."""
    try:
        if path.stat().st_size > BYTES_MAX:
            raise ConfigError(f"{path}: found {path.stat().st_size} bytes, expected at most {BYTES_MAX}")
        data = path.read_bytes()
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    for mark, name in ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"),
                       (codecs.BOM_UTF16_BE, "utf-16")):  # fmt: skip
        if data.startswith(mark):
            return data.decode(name, errors="replace")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def read_table(path: Path, aliases: Mapping[str, Iterable[str]], needed: Iterable[str]) -> list[Row]:
    """The rows of a table; `aliases` maps the names of columns to others that they are known by.

    Raises ConfigError, naming what was found, for a file without the `needed` columns.
    """
    lines = [(number, line) for number, line in enumerate(text_of(path).splitlines(), start=1)
             if line.strip(" \t,;\0") and not line.lstrip().startswith("#")]  # fmt: skip
    if not lines:
        raise ConfigError(f"{path}: found no rows, expected {','.join(needed)}")
    mark = max(",;\t", key=lines[0][1].count)
    try:
        head, *body = csv.reader([line for _, line in lines], delimiter=mark, skipinitialspace=True)
    except csv.Error as error:
        raise ConfigError(f"{path}: {error}") from None
    known = {other.lower(): name for name, others in aliases.items() for other in (name, *others)}
    columns = [known.get(cell.strip().lower(), cell.strip()) for cell in head]
    missing = [name for name in needed if name not in columns]
    if missing:
        found = ", ".join(cell.strip() for cell in head)
        raise ConfigError(f"{path}: {missing[0]}: found columns {found}, expected {','.join(needed)}")
    decimal = mark == ";"
    rows = []
    for (number, _), cells in zip(lines[1:], body, strict=True):
        texts = [cell.strip().replace(",", ".") if decimal else cell.strip() for cell in cells]
        rows.append(Row(f"{path}: line {number}", dict(zip(columns, texts, strict=False))))
    return rows


def demand_seconds(path: Path, times: Sequence[float]) -> None:
    """Refuse a track whose times cannot be seconds. Raises ConfigError."""
    ordered = sorted(set(times))
    if len(ordered) > 2:
        step = median(b - a for a, b in pairwise(ordered))
        if step > STEP_MAX_S:
            raise ConfigError(
                f"{path}: t: found steps of {step:g}, expected seconds, at most {STEP_MAX_S:g} from row to "
                "row: not milliseconds or microseconds"
            )
