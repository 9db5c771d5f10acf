"""`gcs export RUN`: a run in formats that other programs read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from gcs.export import earth_files, table_files
from gcs.export.formats import Format
from gcs.export.geojson import as_geojson
from gcs.export.run_data import RunData, load
from gcs.recording.foxglove_layout import LAYOUT, layout_of_viewer
from onboard.config.strict import ConfigError
from onboard.runtime.whole_files import write_whole

FOLDER = "export"


def as_foxglove(data: RunData) -> dict[str, bytes]:
    """A layout over the recording's vehicles that told their states."""
    return {LAYOUT: layout_of_viewer(data.states.ids, data.roles)}


OTHERS = {"geojson": as_geojson, "foxglove": as_foxglove}
WRITERS = {**table_files.WRITERS, **earth_files.WRITERS, **OTHERS}


def export(
    run: Path, formats: Sequence[Format], to: Path | None, ids: tuple[int, ...]
) -> tuple[list[Path], tuple[str, ...]]:
    """Write a run in these formats; the files, and what was missing or damaged, one line each.

    `to` is the folder (None: `export` in the run folder, or beside a recording that has another name);
    `ids` the vehicles (empty: all). Each file is written whole or not at all. Raises ConfigError.
    """
    data = load(run)
    if ids:
        data = data.only(ids)
    if to is None:
        to = data.folder / (FOLDER if run.is_dir() or run.stem == "recording" else f"{run.stem}-{FOLDER}")
    files = [found for each in formats for found in WRITERS[each.value](data).items()]
    written = []
    try:
        to.mkdir(parents=True, exist_ok=True)
        for name, content in files:
            write_whole(to / name, content)
            written.append(to / name)
    except OSError as error:
        raise ConfigError(f"{error.filename or to}: {(error.strerror or str(error)).lower()}") from None
    return written, data.notes
