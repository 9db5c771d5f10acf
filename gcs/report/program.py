"""`gcs report RUN`: one page to open in any browser, without network, and pictures of the same."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from gcs.picture.thresholds import Thresholds
from gcs.recording.reader import Recording
from gcs.recording.shell import RECORDING
from gcs.report.data import Run, beside
from gcs.report.drawing import write_png
from gcs.report.figures import NAMED_LIKE, NAMES, figures
from gcs.report.from_recording import from_recording
from gcs.report.from_tlog import from_tlogs
from gcs.report.page import page
from onboard.config.strict import ConfigError
from onboard.runtime.progress import Tell, silent
from onboard.runtime.whole_files import write_whole

READ = 0.3  # of the work, about
PAGE, FIGURES = "report.html", "figures"


class Written(NamedTuple):
    """What a report consists of."""

    page: Path
    pictures: tuple[Path, ...]
    notes: tuple[str, ...]  # what was missing or damaged, one line each


def read_run(run: Path, limits: Thresholds | None = None, version: str = "") -> Run:
    """A run's values: of its recording, else of its telemetry logs.

    Raises ConfigError with one line where the folder has neither, or where a recording is foreign or of
    a newer version (logs are then no replacement).
    """
    if not run.exists():
        raise ConfigError(f"{run}: no such run")
    files = beside(run if run.is_dir() else run.parent)
    path = run / RECORDING if run.is_dir() else run
    if path.suffix == ".tlog":
        return from_tlogs(run, files, "a telemetry log alone")
    try:
        recording = Recording(path)
    except ConfigError as error:
        if not run.is_dir() or not any(run.glob("*.tlog")) or "version" in str(error):
            raise
        return from_tlogs(run, files, str(error))
    try:
        return from_recording(run, recording, files, limits, version)
    finally:
        recording.close()


def write_report(
    run: Path, limits: Thresholds | None = None, version: str = "", tell: Tell = silent
) -> Written:
    """Write `report.html` and `figures/*.png` into the run folder. Raises ConfigError with one line.

    Of a recording with a name of its own, `x.mcap`, they are `x-report.html` and `x-figures/*.png` beside it,
    so that no report takes another's place.
    """
    tell(0.0, "reading")
    values = read_run(run, limits, version)
    tell(READ, "drawing")
    folder = values.folder
    before = "" if run.is_dir() or run.name == RECORDING else f"{run.stem}-"
    html, room = folder / f"{before}{PAGE}", folder / f"{before}{FIGURES}"
    try:
        room.mkdir(exist_ok=True)
        for name in (*NAMES, *NAMED_LIKE):
            for old in room.glob(f"{name}.png"):
                old.unlink()  # of an earlier report
        drawings = figures(values)
        write_whole(html, page(values, drawings).encode())
        pictures = [room / f"{drawing.name}.png" for drawing in drawings]
        for number, (drawing, picture) in enumerate(zip(drawings, pictures, strict=True)):
            tell(READ + (1.0 - READ) * (1 + number) / (1 + len(pictures)), f"drawing {drawing.name}")
            write_png(drawing, values, picture)
    except OSError as error:
        raise ConfigError(f"{error.filename or folder}: {(error.strerror or str(error)).lower()}") from None
    return Written(html, tuple(pictures), values.notes)
