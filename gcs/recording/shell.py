"""The recorder at work beside a station: a run folder, its files, and an alert when the disk refuses."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from pathlib import Path

from gcs.recording.file import OpenDisk, OsFile, at_once
from gcs.recording.recorder import CLOSE_S, Recorder, RecorderStatus, remark_of
from gcs.recording.tlog import TlogRecorder
from gcs.station import Station
from onboard.runtime.file_writer import FileWriter
from onboard.runtime.protocols import Link

RECORDING = "recording.mcap"
TICK_S = 0.2


class StationRecorder:
    """Records what a station hears into a folder; `run` it as a task beside the station's.

    With a `writer`, which it closes, its thread does all that is done at the disk, so that a disk that hangs
    holds nobody up. Raises ConfigError where the recording cannot be made. `links` are MAVLink links to log;
    the caller owns them.
    """

    def __init__(
        self, station: Station, folder: Path, links: Sequence[Link] = (), *, opener: OpenDisk = OsFile,
        writer: FileWriter | None = None,
    ) -> None:  # fmt: skip
        self._station = station
        self._writer = writer
        self.recorder = Recorder(folder / RECORDING, station.game, opener=opener, writer=writer)
        self.tlogs = TlogRecorder(folder, run=at_once if writer is None else writer.submit)
        for link in links:
            self.tlogs.hear(link, station.now_ns)
        self._before = self.status()
        station.tap(self.recorder.record)

    def status(self) -> RecorderStatus:
        """How the recorder is doing."""
        status = self.recorder.status()
        if status.trouble or not self.tlogs.trouble:
            return status
        return RecorderStatus(
            str(self.tlogs.folder), status.recorded, status.lost, status.size, 0, self.tlogs.trouble
        )

    def tick(self) -> None:
        """Put on the disk what is due, and tell the station what has changed."""
        now_ns = self._station.now_ns()
        self.recorder.tick(now_ns)
        self.tlogs.tick(now_ns)
        status = self.status()
        remark = remark_of(self._before, status)
        self._before = status
        if remark is not None:
            self._station.remark(remark.severity, remark.kind, remark.text, remark.advice, remark.over)

    async def run(self) -> None:
        """Keep recording until cancelled; the files are closed then."""
        try:
            while True:
                self.tick()
                await asyncio.sleep(TICK_S)
        finally:
            self.close()

    def close(self) -> None:
        """End the recording; idempotent."""
        self.recorder.close()
        self.tlogs.close()
        if self._writer is not None:
            self._writer.close(CLOSE_S)
