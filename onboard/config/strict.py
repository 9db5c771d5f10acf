"""Strict TOML into frozen structs; every fault names file, key, what was found and what was expected.

A range belongs to a field's type: `speed: Annotated[float, Meta(ge=0, le=1000, description="…")]` (the types
in `onboard.config.bounds`). What one field demands of another is said in the struct's `__post_init__` with
`demand`. So a value that no command could use is refused wherever it comes from.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from onboard.config.printable import printable

T = TypeVar("T")
S = TypeVar("S", bound=msgspec.Struct)

FILE_MAX = 1 << 20  # [bytes] a longer file is no configuration


class ConfigError(Exception):
    """A fault in a file or option of the user's: its text is the one printable line to say (exit code 2)."""

    def __str__(self) -> str:
        return printable(" ".join(super().__str__().split()))


class FieldError(ValueError):
    """What is wrong with one key of a struct; `convert` adds the file and the struct's own place in it."""

    def __init__(self, key: str, found: object, expected: str) -> None:
        super().__init__(key, found, expected)
        self.key = key
        self.found = found
        self.expected = expected

    def __str__(self) -> str:
        return f"{self.key}: found {self.found}, expected {self.expected}"


class StrictConfig(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Base of every struct that a file fills: frozen, and an unknown key is refused."""


def demand(ok: bool, key: str, found: object, expected: str) -> None:
    """Raise FieldError for `key` unless `ok`: for what a type cannot say, in a struct's `__post_init__`."""
    if not ok:
        raise FieldError(key, found, expected)


def read(path: Path, kind: type[T]) -> T:
    """Read a TOML file into `kind`.

    Raises ConfigError: `FILE: KEY: found …, expected …`.
    """
    return parse(_text(path), kind, str(path))


def parse(text: str, kind: type[T], name: str) -> T:
    """Parse TOML text into `kind`; `name` stands for the file in errors. Raises ConfigError."""
    return convert(_tables(text, name), kind, name)


def load(path: Path | None, kind: type[T], options: Mapping[str, Any]) -> T:
    """A file's contents with options over them; where `path` is None, options over the defaults.

    `options` maps a key's path ("bus.endpoint") to its value; None leaves the key as the file has it. Raises
    ConfigError that begins with the file's name, or with `options` where there is no file.
    """
    name = "options" if path is None else str(path)
    data = {} if path is None else _tables(_text(path), name)
    for at, value in options.items():
        *tables, key = at.split(".")
        table = data
        for part in tables if value is not None else ():
            table = table.setdefault(part, {})
            if not isinstance(table, dict):
                break  # the conversion tells of it
        if value is not None and isinstance(table, dict):
            table[key] = value
    return convert(data, kind, name)


def _text(path: Path) -> str:
    try:
        with path.open("rb") as file:
            data = file.read(FILE_MAX + 1)
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    if len(data) > FILE_MAX:
        raise ConfigError(f"{path}: found more than {FILE_MAX} bytes, expected a configuration file")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: not UTF-8 text") from None


def _tables(text: str, name: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ConfigError(f"{name}: nested too deeply") from None
    except ValueError as error:  # TOMLDecodeError, and numbers of too many digits
        raise ConfigError(f"{name}: not valid TOML: {' '.join(str(error).split())}") from None


def convert(data: Any, kind: type[T], name: str) -> T:
    """Convert plain data into `kind`, strictly. Raises ConfigError that begins with `name`.

    `kind` may be the type of a single value too, such as an option's: `convert(90.0, Latitude, "--lat")`.
    """
    try:
        for key, number in _not_finite(data):
            raise ConfigError(f"{_at(name, key)}: found {number}, expected a finite number")
        return msgspec.convert(data, kind, strict=True)
    except msgspec.ValidationError as error:
        raise ConfigError(_told(error, data, kind, name)) from None
    except RecursionError:
        raise ConfigError(f"{name}: nested too deeply") from None


def checked(config: S, name: str) -> S:
    """`config` where its values lie in their types' ranges: for one made or changed by a program.

    Raises ConfigError that begins with `name`.
    """
    return convert(_without_none(msgspec.to_builtins(config)), type(config), name)


def _without_none(data: Any) -> Any:
    """TOML knows no null: keys that are not given are left out."""
    if isinstance(data, dict):
        return {key: _without_none(value) for key, value in data.items() if value is not None}
    return data


def _not_finite(data: Any, key: str = "") -> Iterator[tuple[str, float]]:
    """The NaNs and infinities of plain data and their keys: msgspec lets them pass."""
    if isinstance(data, float):
        if not isfinite(data):
            yield key, data
    elif isinstance(data, dict):
        for inner, value in data.items():
            yield from _not_finite(value, f"{key}.{inner}" if key else str(inner))
    elif isinstance(data, (list, tuple)):
        for index, value in enumerate(data):
            yield from _not_finite(value, f"{key}[{index}]")


_LOCATED = re.compile(r"(?P<body>.*?)(?: - at `(?:key in )?\$\.?(?P<key>.*)`)?", re.DOTALL)
_ABOUT_A_FIELD = re.compile(r"Object (?P<what>contains unknown|missing required) field `(?P<field>.*)`")
_STEP = re.compile(r"\[(\d+)\]|([^.\[\]]+)")


def _told(error: msgspec.ValidationError, data: Any, kind: Any, name: str) -> str:
    located = _LOCATED.fullmatch(str(error))
    body, key = (located["body"], located["key"] or "") if located else (str(error), "")
    fault = error.__cause__
    if isinstance(fault, FieldError):
        key = f"{key}.{fault.key}" if key and fault.key else key or fault.key
        return f"{_at(name, key)}: found {fault.found}, expected {fault.expected}"
    from onboard.config.in_words import choices_of, expected, keys_of, nearest, shown  # only a fault needs it

    about, steps = _ABOUT_A_FIELD.fullmatch(body), _steps(key)
    if about:
        key = f"{key}.{about['field']}" if key else about["field"]
        if about["what"] == "missing required":
            return f"{_at(name, key)}: missing, but required"
        return f"{_at(name, key)}: unknown key{nearest(about['field'], keys_of(kind, steps))}"
    words, found = expected(kind, steps, another_type=", got `" in body), _value_at(data, steps)
    hint = nearest(found, choices_of(kind, steps)) if isinstance(found, str) else ""
    return f"{_at(name, key)}: found {shown(found)}, expected {words}{hint}"


def _at(name: str, key: str) -> str:
    return f"{name}: {key}" if key else name


def _steps(key: str) -> list[int | str]:
    return [int(step[1]) if step[1] else step[2] for step in _STEP.finditer(key)]


def _value_at(data: Any, steps: list[int | str]) -> Any:
    for step in steps:
        try:
            data = data[step]
        except (KeyError, IndexError, TypeError):
            break
    return data
