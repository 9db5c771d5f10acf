"""What an installation without an extra lacks, told to who asked for it."""

from __future__ import annotations

import re

NAMES = {"PIL": "pillow", "zstandard": "mcap", "llvmlite": "numba"}  # modules by what brings them
NEEDS = re.compile(r"([\w.-]+).*extra == ['\"]([\w-]+)['\"]")


def lacking(module: str) -> str:
    """Which extra brings a module that was not found, in one line; "" where none of them does."""
    from importlib import metadata  # as seldom needed as it is slow

    top = module.partition(".")[0]
    wanted = NAMES.get(top, top).lower()
    try:
        needs = metadata.requires("apollonius") or []
    except metadata.PackageNotFoundError:
        return ""
    found = [match for match in map(NEEDS.match, needs) if match is not None]
    extras = sorted({match[2] for match in found if match[1].lower() == wanted})
    ways = " or ".join(f"'apollonius[{extra}]'" for extra in extras)
    return f"found no {top}, expected: pip install {ways}" if extras else ""
