"""A `.tlog` for each vehicle heard over MAVLink: what QGroundControl and pymavlink read.

Frames go to the file of their sender's system id, `vehicle-<id>.tlog`, stamped with station time and put
on the disk at least every half second. A file only grows, so what a full disk took of it is a
beginning that the rest continues when there is room again.
"""

from __future__ import annotations

import os
import threading
from collections import Counter
from collections.abc import Callable, Hashable
from contextlib import suppress
from functools import partial
from pathlib import Path

from gcs.recording.file import SILENT, SILENT_CALLS, Run, at_once
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Link
from onboard.wire.mavlink.frames import Packet, PeerFramers
from onboard.wire.mavlink.tlog import STAMP

FLUSH_NS = NS_PER_S // 2
MOST_PEERS = 256
MOST_FILES = 255  # MAVLink's system ids
MOST_WAITING = 4 << 20  # [bytes] a file's frames kept while the disk refuses

Write = Callable[[int, bytes], int]  # descriptor, data → how many bytes fit; raises OSError


class _Log:
    """One growing file. `settle`, `close` and what they use belong to whoever is at the disk."""

    def __init__(self, folder: Path, system: int, write: Write) -> None:
        self.waiting = bytearray()  # belongs to the station
        self.taken = 0  # bytes of it that the disk took in the attempt that is done
        self.trouble = ""  # of that attempt
        self._folder, self._system = folder, system
        self._descriptor = -1
        self._write = write

    def settle(self, data: bytes) -> None:
        """Put bytes on the disk; `taken` and `trouble` tell how that went."""
        self.trouble = ""
        try:
            if self._descriptor < 0:
                self._descriptor = self._open()
            while self.taken < len(data):
                done = self._write(self._descriptor, data[self.taken :])
                if done <= 0:
                    raise OSError("nothing was written")
                self.taken += done
        except OSError as error:
            self.trouble = (error.strerror or str(error)).lower()

    def close(self) -> None:
        """Release the file."""
        if self._descriptor >= 0:
            os.close(self._descriptor)

    def _open(self) -> int:
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC
        for number in ("", *(f"-{n}" for n in range(2, 10))):  # never write into somebody's log
            with suppress(FileExistsError):
                return os.open(self._folder / f"vehicle-{self._system}{number}.tlog", flags, 0o644)
        raise OSError(f"too many logs of vehicle {self._system}")


class TlogRecorder:
    """Feed it with `datagram` (or `hear` a link), let time pass with `tick`, end with `close`.

    Nothing raises; `trouble` says why the disk refused, "" = all is well.
    """

    def __init__(self, folder: Path, *, write: Write = os.write, run: Run = at_once) -> None:
        self.folder = folder
        self.trouble = ""
        self.causes: Counter[str] = Counter()  # bad frames by cause; `lost` = no room
        self._write = write
        self._run = run
        self._attempt: threading.Event | None = None  # set when what is on its way to the disk is there
        self._looks = 0  # flushes that found it under way
        self._framers = PeerFramers(MOST_PEERS, causes=self.causes)
        self._logs: dict[int, _Log] = {}
        self._flushed_ns = 0

    def hear(self, link: Link, now_ns: Callable[[], int]) -> None:
        """Record all that arrives on a link from now on."""
        link.receive(lambda data, peer: self.datagram(data, (link.name, peer), now_ns()))

    def datagram(self, data: bytes, peer: Hashable, now_ns: int) -> None:
        """Take in what one peer sent at `now_ns`."""
        for packet in self._framers.feed(peer, data, now_ns):
            self.packet(packet, now_ns)
        self.tick(now_ns)

    def packet(self, packet: Packet, now_ns: int) -> None:
        """Take in one good frame."""
        log = self._logs.get(packet.system)
        if log is None:
            log = self._logs[packet.system] = _Log(self.folder, packet.system, self._write)
        if len(log.waiting) > MOST_WAITING:
            self.causes["lost"] += 1
            return
        log.waiting += STAMP.pack(now_ns // 1000) + packet.raw

    def tick(self, now_ns: int) -> None:
        """Let time pass: puts on the disk what is due."""
        if now_ns - self._flushed_ns >= FLUSH_NS:
            self._flushed_ns = now_ns
            self.flush()

    def flush(self) -> None:
        """Have everything put on the disk, unless it is still busy with what came before."""
        if not self._reaped():
            self._looks += 1
            if self._looks >= SILENT_CALLS:
                self.trouble = SILENT
            return
        self._looks = 0
        pieces = [(log, bytes(log.waiting)) for log in self._logs.values() if log.waiting]
        attempt = self._attempt = threading.Event()
        if not pieces or not self._run(partial(_settle, pieces, attempt)):
            attempt.set()
        self._reaped()

    def close(self) -> None:
        """Release the files, once what waits is there; idempotent."""
        self.flush()
        self._run(partial(_close, list(self._logs.values())))
        self._logs = {}

    def _reaped(self) -> bool:
        """Whether nothing is on its way; takes in how that went."""
        if self._attempt is not None and self._attempt.is_set():
            self._attempt = None
            self.trouble = ""
            for log in self._logs.values():
                del log.waiting[: log.taken]
                log.taken = 0
                self.trouble = log.trouble or self.trouble
        return self._attempt is None


def _settle(pieces: list[tuple[_Log, bytes]], done: threading.Event) -> None:
    try:
        for log, data in pieces:
            log.settle(data)
    finally:
        done.set()


def _close(logs: list[_Log]) -> None:
    for log in logs:
        with suppress(OSError):
            log.close()
