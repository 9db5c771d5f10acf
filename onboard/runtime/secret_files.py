"""Files that only their owner may read, written in one piece; symbolic links are never followed."""

from __future__ import annotations

import os
import secrets
import stat
from pathlib import Path

from onboard.config.strict import ConfigError

FILE_MAX = 1 << 20  # [bytes] a longer file holds no key


def write_secret(path: Path, content: bytes, *, durable: bool = True) -> None:
    """Write a file of mode 0600 in place of what was there; `durable` waits for the disk.

    Raises ConfigError, one line.
    """
    beside = path.with_name(f".{path.name}.{secrets.token_hex(4)}")
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
    try:
        try:
            with os.fdopen(os.open(beside, flags, 0o600), "wb") as file:
                file.write(content)
                if durable:
                    file.flush()
                    os.fsync(file.fileno())
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None


def read_secret(path: Path, what: str) -> bytes:
    """A file's content; `what` names it in errors.

    Raises ConfigError where the file is missing, not a regular file, too long, or where anybody but its
    owner may read or write it.
    """
    try:
        with os.fdopen(os.open(path, os.O_RDONLY | os.O_NONBLOCK), "rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            content = file.read(FILE_MAX + 1) if stat.S_ISREG(mode) else b""
    except OSError as error:
        raise ConfigError(f"{path}: {what}: {(error.strerror or str(error)).lower()}") from None
    if not stat.S_ISREG(mode):
        raise ConfigError(f"{path}: {what}: found no regular file, expected one")
    if mode & 0o077:
        raise ConfigError(
            f"{path}: {what}: found mode {stat.S_IMODE(mode):04o}, expected 0600 or 0400: "
            f"others may read it; run chmod 600 {path} and consider a new key"
        )
    if len(content) > FILE_MAX:
        raise ConfigError(f"{path}: {what}: found more than {FILE_MAX} bytes, expected a key")
    return content


def make_private_folder(path: Path) -> None:
    """Make a folder of mode 0700, or use one that is there. Raises ConfigError."""
    try:
        path.mkdir(mode=0o700, parents=True, exist_ok=True)
        path.chmod(0o700)
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
