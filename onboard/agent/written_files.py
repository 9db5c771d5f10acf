"""Everything that an agent writes in flight, lines, telemetry log, events, stamps: none of it is waited for.

Lines to standard error have a thread of their own: a disk that hangs does not silence them.
"""

from __future__ import annotations

from pathlib import Path

from onboard.agent.config import AgentConfig
from onboard.agent.event_file import EventFile, WriterSink, unused
from onboard.agent.opening import stamps_of
from onboard.config.printable import printable
from onboard.config.strict import ConfigError
from onboard.runtime.file_writer import FileWriter, Sink, WrittenFile
from onboard.runtime.spoken_lines import ERROR, LINES_BYTES, StandardStream
from onboard.wire.mavlink.tlog import STAMP

CLOSE_S = 0.5  # for what waits to reach the disk, when the agent ends


class WrittenFiles:
    """The files of one agent's process. Raises ConfigError for one that cannot be opened.

    `disk` and `lines` replace the writers, for tests.
    """

    def __init__(
        self, config: AgentConfig, *, disk: FileWriter | None = None, lines: FileWriter | None = None,
        errors: Sink | None = None,
    ) -> None:  # fmt: skip
        self._disk = disk or FileWriter()
        self._line_writer = lines or FileWriter(queue_bytes=LINES_BYTES)
        self._lines = self._line_writer.open(Path("standard error"), sink=errors or StandardStream(ERROR))
        self._log: WrittenFile | None = None
        if config.log:
            self._log = self._disk.open(Path(config.log), sink=_appending(Path(config.log)))
        self.events: EventFile | None = None
        if config.events:
            sink = WriterSink(unused(Path(config.events)), self._disk)
            self.events = EventFile(sink, round(config.events_max_mb * 1e6))
        self.stamps = stamps_of(config, self._disk)

    @property
    def logs(self) -> bool:
        """Whether MAVLink frames are logged."""
        return self._log is not None

    def line(self, text: str) -> None:
        """One line to standard error, made printable here: the journal's place under systemd."""
        self._lines.write(printable(text).encode("utf-8", errors="backslashreplace") + b"\n")

    def record(self, wall_ns: int, frame: bytes) -> None:
        """One MAVLink frame into the telemetry log (`.tlog`)."""
        if self._log is not None:
            self._log.write(STAMP.pack(wall_ns // 1000) + frame)

    def counters(self) -> dict[str, int]:
        """For health reports: what could not be written, by file."""
        return {
            "log_lost": 0 if self._log is None else self._log.lost,
            "lines_lost": self._lines.lost,
            "stamps_unsaved": 0 if self.stamps is None else self.stamps.failures,
        }

    def close(self) -> bool:
        """Write what waits, at most for `CLOSE_S` each; False where a disk or a reader did not take it."""
        if self._log is not None:
            self._log.close()
        written = self._disk.close(CLOSE_S)
        return self._line_writer.close(CLOSE_S) and written


def _appending(path: Path) -> Sink:
    try:
        return path.open("ab", buffering=0)
    except OSError as error:
        raise ConfigError(f"log: {path}: {(error.strerror or str(error)).lower()}") from None
