"""The distribution's version; the build reads it here."""

from __future__ import annotations

VERSION = "0.1.0"


def version() -> str:
    """Of this tree. (An installation's metadata say the same, but bring the parser of e-mails.)"""
    return VERSION
