"""A recorded wind: CSV with a header, `time,north,east,down[,gust_north,gust_east,gust_down]`.

Times in seconds from the start of the simulation, rising; winds in m/s, where the air moves to. Linear
between rows, constant before the first and after the last.
"""

from __future__ import annotations

import csv
from bisect import bisect_right
from math import isfinite
from pathlib import Path

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import ZERO, Vec
from sim_bridge.vehicle.motion import Air

COLUMNS = ["time", "north", "east", "down"]
GUSTS = ["gust_north", "gust_east", "gust_down"]


class RecordedWind:
    """A wind over time, the same everywhere."""

    def __init__(self, rows: list[tuple[float, Air]]) -> None:
        self._times = [time for time, _ in rows]
        self._airs = [air for _, air in rows]

    def at(self, time: float) -> Air:
        """The air at `time` [s]."""
        after = bisect_right(self._times, time)
        if after == 0:
            return self._airs[0]
        if after == len(self._times):
            return self._airs[-1]
        t0, t1 = self._times[after - 1], self._times[after]
        share = (time - t0) / (t1 - t0)
        a, b = self._airs[after - 1], self._airs[after]
        return Air(_between(a.wind, b.wind, share), _between(a.gust, b.gust, share))


def _between(a: Vec, b: Vec, share: float) -> Vec:
    return Vec(a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z))


def read(path: Path) -> RecordedWind:
    """Read a recorded wind. Raises ConfigError with file, line, found and expected."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            lines = list(csv.reader(file))
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: not UTF-8 text") from None
    except (OSError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ConfigError(f"{path}: {reason.lower()}") from None
    header = [name.strip() for name in lines[0]] if lines else []
    if header not in (COLUMNS, COLUMNS + GUSTS):
        raise ConfigError(
            f"{path}: line 1: found {','.join(header) or 'nothing'}, expected {','.join(COLUMNS)} "
            f"(and {','.join(GUSTS)} where gusts were recorded)"
        )
    rows: list[tuple[float, Air]] = []
    for number, line in enumerate(lines[1:], start=2):
        if not line:
            continue
        try:
            values = [float(cell) for cell in line]
        except ValueError:
            values = []
        if len(values) != len(header) or not all(map(isfinite, values)):
            raise ConfigError(
                f"{path}: line {number}: found {','.join(line)}, expected {len(header)} finite numbers"
            )
        if rows and values[0] <= rows[-1][0]:
            raise ConfigError(
                f"{path}: line {number}: found time {values[0]:g}, expected more than {rows[-1][0]:g}"
            )
        gust = Vec(values[4], values[5], values[6]) if len(values) == 7 else ZERO
        rows.append((values[0], Air(Vec(values[1], values[2], values[3]), gust)))
    if not rows:
        raise ConfigError(f"{path}: found no rows, expected at least one")
    return RecordedWind(rows)
