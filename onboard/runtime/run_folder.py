"""Run folders: `PARENT/<UTC time>-<name>`."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

from onboard.config.names import file_name
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S


def made(folder: Path) -> Path:
    """Make a folder for results, where there is none yet. Raises ConfigError where that cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigError(f"{folder}: {(error.strerror or str(error)).lower()}") from None
    return folder


def new_run(parent: Path, name: str, now_ns: int) -> Path:
    """Make a new run folder at a wall instant [ns]. Raises ConfigError where that cannot be."""
    at = datetime.fromtimestamp(now_ns // NS_PER_S, UTC).strftime("%Y%m%dT%H%M%SZ")
    safe = file_name(name)
    for suffix in ("", *(f"-{n}" for n in range(2, 100))):
        folder = parent / f"{at}-{safe}{suffix}"
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            continue
        except OSError as error:
            raise ConfigError(f"{folder}: {(error.strerror or str(error)).lower()}") from None
        return folder
    raise ConfigError(f"{parent}: too many runs of {at}-{safe}")
