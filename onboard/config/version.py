"""The distribution's version."""

from __future__ import annotations


def version() -> str:
    """As installed; `0+unknown` in a tree that is not."""
    from importlib import metadata  # it brings the parser of e-mails, which an abort does not wait for

    try:
        return metadata.version("apollonius")
    except metadata.PackageNotFoundError:
        return "0+unknown"
