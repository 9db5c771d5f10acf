"""The flight recorder: every message of the bus and of the station's journal into one MCAP file.

A plain class: the caller brings messages and the time. One channel per key, payloads byte for byte as
they came, log time = arrival in station time. Channels for viewers (`/scene`, `/tf`, `/position/<id>`,
`/location/<id>`, `/log`) are derived beside them, and a layout that shows these lies in the recording's
folder. The same input gives the same bytes.

The file is a complete MCAP after every half second: a kill at any moment loses at most what came since.
(After a power cut, what the operating system had not written yet is gone too.)
"""

from __future__ import annotations

from pathlib import Path

import msgspec

from gcs.picture.station_journal import HEARD_HERE, Remark
from gcs.recording.file import McapWriter, OpenDisk, OsFile, WholeFile, at_once
from gcs.recording.foxglove_layout import LayoutFile
from gcs.recording.schemas import Layout, layout_of
from gcs.recording.views import Views
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.file_writer import FileWriter
from onboard.wire.bus.messages import SCHEMA, Severity

FORMAT = 1  # of the recording: raised when an old reader would misread it
METADATA = "apollonius"  # name of the metadata record that says so
CHANNELS = "apollonius-channels"  # metadata records beside the chunks: number → key, so that a damaged
# chunk costs itself alone, and not the names of the channels that it defines
LIBRARY = "apollonius"
FLUSH_NS = NS_PER_S // 2
CHUNK_BYTES = 1 << 22
MOST_WAITING = 16 << 20  # [bytes] kept in memory while the disk refuses; what comes after that is lost
CLOSE_S = 1.0  # for what is on its way to the disk, twice, when a recording is closed
MOST_CHANNELS = 4096  # MCAP numbers channels with 16 bits, and keys come from the network
OTHER = "apollonius/other"  # what has no channel of its own: MessagePack of [key, payload]


class RecorderStatus(msgspec.Struct, frozen=True):
    """How a recorder is doing."""

    path: str
    recorded: int  # messages taken in
    lost: int  # messages that the disk had no room for
    size: int  # [bytes] on the disk
    waiting: int  # [bytes] in memory that the disk refused so far
    trouble: str  # why the disk refused, "" = all is well


class Recorder:
    """Feed it with `record`, let time pass with `tick`, end with `close`.

    With a `writer` its thread does all that is done at the disk, and `close` alone waits for it, twice
    `CLOSE_S` at most. `path` must not exist. Raises ConfigError where it cannot be made; after that nothing
    raises: a full disk shows in `status()`, and recording goes on when there is room again.
    """

    def __init__(
        self,
        path: Path,
        game: str,
        *,
        opener: OpenDisk = OsFile,
        views: bool = True,
        most_waiting: int = MOST_WAITING,
        writer: FileWriter | None = None,
    ) -> None:
        try:
            run = at_once if writer is None else writer.submit
            self._file = WholeFile(opener(path), run)
        except OSError as error:
            raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
        self.path = path
        self._most_waiting = most_waiting
        self._disk_thread = writer
        self._views = Views() if views else None
        self._layout = LayoutFile(path.parent, run)
        self._writer = McapWriter(self._file, LIBRARY, CHUNK_BYTES)
        self._writer.metadata(METADATA, {"format": str(FORMAT), "schema": str(SCHEMA), "game": game})
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._unnamed: dict[str, str] = {}  # new channels since the last flush
        self._last_ns = 0
        self._flushed_ns = 0
        self._due_ns = 0  # when `tick` has something to do
        self._other = -1  # the channel of what has no channel of its own
        self._recorded = self._lost = 0
        self._closed = False
        self._file.settle()

    def record(self, key: str, payload: bytes, stamp_ns: int) -> None:
        """Take in one message that arrived at `stamp_ns` (station time, never running back)."""
        if stamp_ns >= self._due_ns:
            self.tick(stamp_ns)
        elif stamp_ns > self._last_ns:
            self._last_ns = stamp_ns
        if self._closed or (self._file.waiting_bytes > self._most_waiting and self._full):
            self._lost += 1
            return
        self._recorded += 1
        channel = self._channels.get(key)
        if channel is None:
            channel = self._open_channel(key)
        if channel == self._other:
            payload = msgspec.msgpack.encode((key, payload))
        self._writer.message(channel, self._last_ns, payload, self._recorded & 0xFFFFFFFF)
        if self._views is not None:
            view = self._views.note(key, payload, self._last_ns)
            if view is not None:
                self._put(view.topic, view.layout, view.payload, self._last_ns)

    def tick(self, now_ns: int) -> None:
        """Let time pass: draws for viewers, and puts on the disk what is due. Call it at least at 5 Hz."""
        if self._last_ns == 0:
            self._flushed_ns = now_ns
        self._last_ns = max(self._last_ns, now_ns)
        if self._closed:
            return
        if self._views is not None and self._last_ns >= self._views.next_ns and not self._full:
            for at_ns, view in self._views.due(self._last_ns):
                self._put(view.topic, view.layout, view.payload, at_ns)
        if self._last_ns - self._flushed_ns >= FLUSH_NS:
            self.flush()
        self._due_ns = self._flushed_ns + FLUSH_NS
        if self._views is not None:
            self._due_ns = min(self._due_ns, self._views.next_ns)

    def flush(self) -> None:
        """Put everything on the disk now."""
        if not self._closed:
            self._flushed_ns = self._last_ns
            if self._unnamed:
                self._writer.metadata(CHANNELS, self._unnamed)
                self._unnamed = {}
            self._writer.flush()
            self._file.settle()
            if self._views is not None:
                self._layout.hold(self._views.roles)

    def close(self) -> None:
        """Write the index and release the file; idempotent. Without room for the index the file stays
        whole without one."""
        if self._closed:
            return
        self._wait()
        self.flush()
        self._closed = True
        self._wait()
        if not self._file.busy and not self._file.trouble:
            self._writer.finish()
            self._file.settle(final=True)
        self._file.close()

    def status(self) -> RecorderStatus:
        """How it is doing."""
        waiting = self._file.waiting_bytes if self._file.trouble else 0
        return RecorderStatus(
            str(self.path), self._recorded, self._lost, self._file.size, waiting, self._file.trouble
        )

    @property
    def _full(self) -> bool:
        file = self._file
        return file.waiting_bytes > self._most_waiting and (bool(file.trouble) or file.busy)

    def _wait(self) -> None:
        if self._disk_thread is not None:
            self._disk_thread.flush(CLOSE_S)

    def _open_channel(self, key: str) -> int:
        place = HEARD_HERE.find(key)
        if place is None or len(self._channels) >= MOST_CHANNELS:
            self._other = self._channel(OTHER, Layout("", "msgpack", b""))
            return self._other
        return self._channel(key, layout_of(place.topic))

    def _put(self, topic: str, layout: Layout, payload: bytes, stamp_ns: int) -> None:
        self._writer.message(self._channel(topic, layout), stamp_ns, payload)

    def _channel(self, topic: str, layout: Layout) -> int:
        channel = self._channels.get(topic)
        if channel is None:
            schema = self._schemas.get(layout.name, 0)
            if not schema and layout.name:
                schema = self._writer.schema(layout.name, layout.schema)
                self._schemas[layout.name] = schema
            channel = self._channels[topic] = self._writer.channel(topic, layout.encoding, schema)
            self._unnamed[str(channel)] = topic
        return channel


def remark_of(before: RecorderStatus, now: RecorderStatus) -> Remark | None:
    """What the station should say about the recorder, given how it was doing before; None = nothing new."""
    if now.trouble and not before.trouble:
        return Remark(
            Severity.ERROR,
            "recorder",
            f"recording stopped: {now.trouble} ({now.path})",
            "make room on the disk; recording goes on by itself when there is room",
        )
    if before.trouble and not now.trouble:
        lost = f", {now.lost} messages lost" if now.lost else ", nothing lost"
        return Remark(Severity.INFO, "recorder", f"recording goes on{lost}", over=True)
    return None
