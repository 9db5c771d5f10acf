"""The ground station, and for those who reckon with what it recorded: `gcs.load(run)`."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gcs.export.run_data import RunData


def load(run: str | os.PathLike[str]) -> RunData:
    """Read a run folder, or a recording, whole: tables of NumPy arrays, units in the names of columns.

    `load(run).states["north_m"]`; `.frame()` gives pandas. See `gcs.export.run_data`. Raises ConfigError with
    one line.
    """
    from gcs.export import run_data

    return run_data.load(run)
