"""MAVLink signing keys and stamps in files that only their owner may read."""

from __future__ import annotations

import threading
from pathlib import Path

import msgspec

from onboard.config.strict import ConfigError
from onboard.config.undecodable import UNDECODABLE
from onboard.runtime.file_writer import FileWriter
from onboard.runtime.secret_files import read_secret, write_secret
from onboard.wire.mavlink.signing import Stamps


def read_key(path: Path) -> bytes:
    """The 32-byte key in a file: raw bytes, or 64 hexadecimal digits in a line.

    Raises ConfigError where the file is missing, not a file, of the wrong length, or where anybody but
    its owner may read or write it.
    """
    content = read_secret(path, "signing key")
    if len(content) == 32:
        return content
    try:
        key = bytes.fromhex(content.decode("ascii").strip())
    except ValueError:
        key = b""
    if len(key) != 32:
        raise ConfigError(
            f"{path}: signing key: found {len(content)} bytes, expected 32 bytes or 64 hexadecimal digits"
        )
    return key


class _Saved(msgspec.Struct, frozen=True):
    own: int
    streams: list[tuple[int, int, int, int]]  # link id, system, component, stamp


class StampFile:
    """The stamps of one key in a file beside it: replaced in one piece, mode 0600.

    With a `writer` its thread does that, and the latest stamps go before all that waited. A file that cannot
    be read or written is a ConfigError at start (`load`) and a count afterwards (`failures`): flying on
    without a record is safer than falling silent.
    """

    def __init__(self, path: Path, writer: FileWriter | None = None) -> None:
        self.path = path
        self.failures = 0
        self._writer = writer
        self._latest: Stamps | None = None  # what is to be written; None = nothing waits
        self._lock = threading.Lock()

    def load(self) -> Stamps:
        """What was saved last; nothing at the first start."""
        try:
            saved = msgspec.json.decode(self.path.read_bytes(), type=_Saved)
        except FileNotFoundError:
            return Stamps(0, {})
        except OSError as error:
            raise ConfigError(f"{self.path}: stamps: {(error.strerror or str(error)).lower()}") from None
        except UNDECODABLE:
            raise ConfigError(
                f"{self.path}: stamps: found damaged content, expected what was saved here; "
                "remove the file if no recorded frame can be replayed"
            ) from None
        return Stamps(saved.own, {(link, system, comp): stamp for link, system, comp, stamp in saved.streams})

    def save(self, stamps: Stamps) -> None:
        """Replace the file; with a writer, soon."""
        with self._lock:
            waits, self._latest = self._latest is not None, stamps
        if self._writer is None:
            self._write()
        elif not waits and not self._writer.submit(self._write):
            self.failures += 1

    def _write(self) -> None:
        with self._lock:
            stamps, self._latest = self._latest, None
        if stamps is None:
            return
        saved = _Saved(stamps.own, [(*stream, stamp) for stream, stamp in stamps.streams.items()])
        try:
            write_secret(self.path, msgspec.json.encode(saved), durable=False)
        except ConfigError:
            self.failures += 1
