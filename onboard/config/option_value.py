"""One value typed on a command line, in the type and the range that a file's key of the same meaning has."""

from __future__ import annotations

from contextlib import suppress
from typing import Any, TypeVar

from msgspec import inspect

from onboard.config.in_words import bare
from onboard.config.strict import convert

T = TypeVar("T")


def parsed(text: Any, kind: type[T], name: str) -> T:
    """What was typed, as `kind`: a number with its range, an enum, a name.

    `name` is the option's, as it is typed. Raises ConfigError: `--seed: found -5, expected a whole number …`.
    """
    return convert(_read(text, bare(inspect.type_info(kind))), kind, name)


def _read(text: Any, node: inspect.Type) -> Any:
    """The text as plain data; as it is where it is no number, which the conversion tells."""
    ways = {inspect.IntType: (int,), inspect.FloatType: (int, float)}.get(type(node), ())
    for read in ways if isinstance(text, str) else ():
        with suppress(ValueError):  # also of more than 4300 digits
            return read(text)
    return text
