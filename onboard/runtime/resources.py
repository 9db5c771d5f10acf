"""Where the files that come with the distribution lie (`configs/`)."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent.parent


def configs() -> Path:
    """The folder `configs/`: inside an installed wheel, or beside the packages in a checkout."""
    inside = _PACKAGE / "configs"
    return inside if inside.is_dir() else _PACKAGE.parent / "configs"
