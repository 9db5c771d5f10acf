"""Files that are there whole or not at all, whatever happens while they are written."""

from __future__ import annotations

import contextlib
import os
import socket
from collections.abc import Callable, Iterator
from pathlib import Path

from onboard.config.strict import ConfigError


def write_whole(path: Path, data: bytes, *, durable: bool = False) -> None:
    """Put bytes there in one piece; `durable` waits for the disk. Raises ConfigError."""
    whole_or_nothing(path, lambda part: part.write_bytes(data), durable=durable)


def whole_or_nothing(path: Path, write: Callable[[Path], object], *, durable: bool = False) -> None:
    """Have `write` write a neighbour of `path`, of the same ending, and give it that name.

    A process that dies meanwhile leaves the neighbour behind: see `sweep`. Raises ConfigError.
    """
    with _named(path), _part(path) as part:
        write(part)
        if durable:
            _synchronise(part)
        os.replace(part, path)
    if durable:
        with contextlib.suppress(OSError):  # not every file system lets a folder be synchronised
            _synchronise(path.parent)


def write_first(path: Path, data: bytes) -> bool:
    """`write_whole`, durable, where nobody else has put a file there: else False. Raises ConfigError."""
    with _named(path), _part(path) as part:
        part.write_bytes(data)
        _synchronise(part)
        try:
            os.link(part, path)  # of several processes one alone succeeds
        except FileExistsError:
            return False
        except OSError:  # a file system without links
            if path.exists():
                return False
            os.replace(part, path)
    return True


def sweep(folder: Path) -> None:
    """Remove what processes of this host that are no more had begun to write."""
    for path in folder.glob(".*.part*"):
        before, host, rest = path.name.rpartition(f".{socket.gethostname()}.")
        number = rest.partition(".")[0]
        if before and host and number.isdecimal() and not _alive(int(number)):
            path.unlink(missing_ok=True)


@contextlib.contextmanager
def _named(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None


@contextlib.contextmanager
def _part(path: Path) -> Iterator[Path]:
    part = path.with_name(f".{path.stem}.{socket.gethostname()}.{os.getpid()}.part{path.suffix}")
    try:
        yield part
    finally:
        part.unlink(missing_ok=True)


def _synchronise(path: Path) -> None:
    file = os.open(path, os.O_RDONLY)
    try:
        os.fsync(file)
    finally:
        os.close(file)


def _alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True
