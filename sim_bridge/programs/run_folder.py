"""The run folder that `fly` leaves: what was played, with what, and how it ended."""

from __future__ import annotations

import os
import platform
import shutil
from importlib import metadata
from pathlib import Path
from typing import Any

import msgspec

from onboard.config.strict import ConfigError

PACKAGES = ("apollonius", "numpy", "pymavlink", "eclipse-zenoh", "msgspec", "numba", "scipy", "control")


def discard(folder: Path) -> None:
    """Remove a run folder in which nothing was flown; where there is a log it stays, for it may tell why."""
    if any(path.suffix in (".log", ".tlog") and path.stat().st_size for path in folder.iterdir()):
        return
    shutil.rmtree(folder, ignore_errors=True)


def write(path: Path, value: object) -> None:
    """Write JSON, whole or not at all. Raises ConfigError."""
    data = msgspec.json.format(msgspec.json.encode(value), indent=1) + b"\n"
    write_bytes(path, data)


def write_bytes(path: Path, data: bytes) -> None:
    """Write bytes, whole or not at all. Raises ConfigError."""
    part = path.with_name(f".{path.name}.part")
    try:
        part.write_bytes(data)
        os.replace(part, path)
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    finally:
        part.unlink(missing_ok=True)


def versions() -> dict[str, str]:
    """Of Python and of what matters."""
    found = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


def toml_of(settings: dict[str, Any]) -> str:
    """Flat settings as TOML: strings, numbers, booleans and lists of strings are written as in JSON."""
    return "".join(f"{key} = {msgspec.json.encode(value).decode()}\n" for key, value in settings.items())
