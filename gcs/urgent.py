"""An abort's command line, read without Typer: making its parser takes longer than all the rest.

Whatever is not plainly an abort with the shared options is left to Typer, mistakes and `--help` included.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from gcs.options import Options
from onboard.wire.bus.messages import CommandKind

SHARED = {"--config": Path, "--game": str, "--bus": str, "--zenoh": Path, "--operator": str}
WITHIN_S = 10.0  # how long confirmations are waited for unless told


class Abort(NamedTuple):
    """What was typed."""

    options: Options
    ids: tuple[int, ...]  # empty: everybody
    within_s: float


def abort_of(arguments: list[str]) -> Abort | None:
    """The abort that these arguments of `gcs` order, None for anything else."""
    words: list[str] = []
    given: dict[str, Any] = {}
    within, everybody = WITHIN_S, False
    rest = iter(arguments)
    for argument in rest:
        name, equals, value = argument.partition("=")
        if argument in ("--all", "--yes"):
            everybody |= argument == "--all"
            if words[:1] != ["command"]:
                return None
        elif name in SHARED or name == "--within":
            value = value if equals else next(rest, "-")
            if value.startswith("-"):
                return None
            if name in SHARED:
                given[name.removeprefix("--")] = SHARED[name](value)
            elif words[:1] == ["command"] and _is_seconds(value):
                within = float(value)
            else:
                return None
        elif argument.startswith("-"):
            return None
        else:
            words.append(argument)
    ids = words[2:]
    plain = words[:2] == ["command", CommandKind.ABORT.value] and all(map(_is_system_id, ids))
    if not plain or bool(ids) == everybody or not 0.1 <= within <= 3600.0:
        return None
    return Abort(Options(**given), tuple(map(int, ids)), within)


def _is_system_id(text: str) -> bool:
    return text.isdecimal() and text.isascii() and 1 <= int(text) <= 250


def _is_seconds(text: str) -> bool:
    whole, _, part = text.partition(".")
    return f"{whole}{part}".isdecimal() and text.isascii()
