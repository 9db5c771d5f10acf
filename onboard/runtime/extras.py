"""What an installation without an extra lacks, told to who asked for it."""

from __future__ import annotations

import re

NAMES = {"PIL": "pillow", "zstandard": "mcap", "llvmlite": "numba"}  # modules by what brings them
NEEDS = re.compile(r"([\w.-]+).*extra == ['\"]([\w-]+)['\"]")


def lacking(module: str) -> str:
    """Which extra brings a module that was not found, in one line; "" where none of them does."""
    top = module.partition(".")[0]
    wanted = NAMES.get(top, top).lower()
    found = [match for match in map(NEEDS.match, _needs()) if match is not None]
    extras = sorted({match[2] for match in found if match[1].lower() == wanted})
    ways = " or ".join(f"'apollonius[{extra}]'" for extra in extras)
    return f"found no {top}, expected: pip install {ways}" if extras else ""


def _needs() -> list[str]:
    """What the extras bring, in the words of an installation's metadata; of a checkout that is run as it
    stands, by its pyproject.toml."""
    import tomllib  # as seldom needed as they are slow
    from importlib import metadata
    from pathlib import Path

    try:
        return metadata.requires("apollonius") or []
    except metadata.PackageNotFoundError:
        project = Path(__file__).parents[2] / "pyproject.toml"
    try:
        extras = tomllib.loads(project.read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    except (OSError, KeyError):
        return []
    return [f"{need} ; extra == '{extra}'" for extra, needs in extras.items() for need in needs]
