"""A `.tlog` for each vehicle heard over MAVLink: what QGroundControl and pymavlink read.

Frames go to the file of their sender's system id, `vehicle-<id>.tlog`, stamped with station time and put
on the disk at least every half second. A file only grows, so what a full disk took of it is a
beginning that the rest continues when there is room again.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Hashable
from contextlib import suppress
from pathlib import Path

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.protocols import Link
from onboard.wire.mavlink.frames import Framer, Packet
from onboard.wire.mavlink.tlog import STAMP

FLUSH_NS = NS_PER_S // 2
MOST_PEERS = 256
MOST_FILES = 255  # MAVLink's system ids
MOST_WAITING = 4 << 20  # [bytes] a file's frames kept while the disk refuses

Write = Callable[[int, bytes], int]  # descriptor, data → how many bytes fit; raises OSError


class _Log:
    """One growing file."""

    def __init__(self, descriptor: int, write: Write) -> None:
        self._descriptor = descriptor
        self._write = write
        self.waiting = bytearray()

    def settle(self) -> None:
        """Put what waits on the disk. Raises OSError; what did not fit stays."""
        while self.waiting:
            done = self._write(self._descriptor, bytes(self.waiting))
            if done <= 0:
                raise OSError("nothing was written")
            del self.waiting[:done]

    def close(self) -> None:
        with suppress(OSError):
            self.settle()
        os.close(self._descriptor)


class TlogRecorder:
    """Feed it with `datagram` (or `hear` a link), let time pass with `tick`, end with `close`.

    Nothing raises; `trouble` says why the disk refused, "" = all is well.
    """

    def __init__(self, folder: Path, *, write: Write = os.write) -> None:
        self.folder = folder
        self.trouble = ""
        self.causes: Counter[str] = Counter()  # bad frames by cause; `lost` = no room, `peers` = too many
        self._write = write
        self._framers: dict[Hashable, Framer] = {}
        self._logs: dict[int, _Log] = {}
        self._flushed_ns = 0

    def hear(self, link: Link, now_ns: Callable[[], int]) -> None:
        """Record all that arrives on a link from now on."""
        link.receive(lambda data, peer: self.datagram(data, (link.name, peer), now_ns()))

    def datagram(self, data: bytes, peer: Hashable, now_ns: int) -> None:
        """Take in what one peer sent at `now_ns`."""
        framer = self._framers.get(peer)
        if framer is None:
            if len(self._framers) >= MOST_PEERS:
                self.causes["peers"] += 1
                return
            framer = self._framers[peer] = Framer(causes=self.causes)
        for packet in framer.feed(data, now_ns):
            self.packet(packet, now_ns)
        self.tick(now_ns)

    def packet(self, packet: Packet, now_ns: int) -> None:
        """Take in one good frame."""
        log = self._logs.get(packet.system) or self._open(packet.system)
        if log is None or len(log.waiting) > MOST_WAITING:
            self.causes["lost"] += 1
            return
        log.waiting += STAMP.pack(now_ns // 1000) + packet.raw

    def tick(self, now_ns: int) -> None:
        """Let time pass: puts on the disk what is due."""
        if now_ns - self._flushed_ns >= FLUSH_NS:
            self._flushed_ns = now_ns
            self.flush()

    def flush(self) -> None:
        """Put everything on the disk now."""
        trouble = ""
        for log in self._logs.values():
            try:
                log.settle()
            except OSError as error:
                trouble = _why(error)
        self.trouble = trouble

    def close(self) -> None:
        """Release the files; idempotent."""
        for log in self._logs.values():
            log.close()
        self._logs = {}

    def _open(self, system: int) -> _Log | None:
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC
        for suffix in ("", *(f"-{n}" for n in range(2, 10))):  # never write into somebody's log
            try:
                descriptor = os.open(self.folder / f"vehicle-{system}{suffix}.tlog", flags, 0o644)
            except FileExistsError:
                continue
            except OSError as error:
                self.trouble = _why(error)
                return None
            log = self._logs[system] = _Log(descriptor, self._write)
            return log
        self.trouble = f"too many logs of vehicle {system}"
        return None


def _why(error: OSError) -> str:
    return (error.strerror or str(error)).lower()
