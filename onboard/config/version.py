"""The distribution's version."""

from __future__ import annotations

from importlib import metadata


def version() -> str:
    """As installed; `0+unknown` in a tree that is not."""
    try:
        return metadata.version("apollonius")
    except metadata.PackageNotFoundError:
        return "0+unknown"
