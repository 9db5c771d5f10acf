"""What is asked of the guarded parts, by name: to be compared, recorded or written out."""

from __future__ import annotations

import json
import traceback
from pathlib import Path

from tests.golden.arithmetic import probe
from tests.golden.parts import PARTS, RECORDED

ARITHMETIC = RECORDED / "arithmetic.json"


def chosen(only: str) -> list[str]:
    """The parts that a comma-separated list names, by their name or its beginning; all for "".

    Raises ValueError for a name that nothing has."""
    wanted = [word.strip() for word in only.split(",") if word.strip()]
    for word in wanted:
        if not any(_fits(name, word) for name in PARTS):
            raise ValueError(f"--only: found {word!r}, expected some of {', '.join(PARTS)}")
    return [name for name in PARTS if not wanted or any(_fits(name, word) for word in wanted)]


def _fits(name: str, word: str) -> bool:
    return name == word or name.startswith(f"{word}-") or name.startswith(word.removesuffix("s") + "-")


def same_arithmetic() -> list[str]:
    """In what this machine's arithmetic differs from that of the recording; empty = comparable."""
    recorded = json.loads(ARITHMETIC.read_text(encoding="utf-8"))
    return [
        f"{key}: recorded with {recorded[key]}, here {value}"
        for key, value in probe().items()
        if value != recorded[key]
    ]


def compare(name: str, found: Path) -> list[str]:
    """Run a part and compare: a line for each difference, details in the folder `found`."""
    try:
        return PARTS[name].compare(RECORDED, found)
    except Exception as error:  # whatever the product raises: the other parts are still to be compared
        told = "".join(traceback.format_exception(error, limit=-3)).rstrip()
        return [f"{name}: could not be run: {told}"]


def record(name: str, folder: Path) -> list[str]:
    """Run a part and write what is kept of it to `folder`; gives no lines."""
    PARTS[name].record(folder)
    return []


def show(name: str, folder: Path) -> list[str]:
    """Run a part and write all of it, decoded, to `folder`; gives no lines."""
    PARTS[name].show(folder)
    return []
