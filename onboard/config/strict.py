"""Strict TOML into frozen structs; every fault names file, key and what was expected."""

from __future__ import annotations

import re
import tomllib
from math import isfinite
from pathlib import Path
from typing import Any, TypeVar

import msgspec

T = TypeVar("T")


class ConfigError(Exception):
    """A fault in a file or option of the user's: its text is the one line to print (exit code 2)."""


def read(path: Path, kind: type[T]) -> T:
    """Read a TOML file into `kind`.

    Raises ConfigError: `FILE: KEY: what was found and what was expected`.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise ConfigError(f"{path}: not UTF-8 text") from None
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    return parse(text, kind, str(path))


def parse(text: str, kind: type[T], name: str) -> T:
    """Parse TOML text into `kind`; `name` stands for the file in errors."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{name}: not valid TOML: {error}") from None
    return convert(data, kind, name)


def convert(data: Any, kind: type[T], name: str) -> T:
    """Convert plain data into `kind`, strictly."""
    reject_non_finite(data, name)
    try:
        return msgspec.convert(data, kind, strict=True)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{name}: {_plain(str(error))}") from None


def reject_non_finite(data: Any, name: str, key: str = "") -> None:
    """msgspec lets NaN and infinity pass: one walk rejects them."""
    if isinstance(data, float) and not isfinite(data):
        raise ConfigError(f"{name}: {key}: found {data}, expected a finite number")
    if isinstance(data, dict):
        for inner, value in data.items():
            reject_non_finite(value, name, f"{key}.{inner}" if key else str(inner))
    elif isinstance(data, (list, tuple)):
        for index, value in enumerate(data):
            reject_non_finite(value, name, f"{key}[{index}]")


def _plain(text: str) -> str:
    """msgspec says `Expected … - at `$.a[0].b``: say `a[0].b: expected …`."""
    found = re.fullmatch(r"(.*?)(?: - at `(?:key in )?\$?\.?(.*)`)?", text, re.DOTALL)
    body, where = (found.group(1), found.group(2)) if found else (text, None)
    body = body[0].lower() + body[1:] if body else body
    unknown = re.fullmatch(r"object contains unknown field `(.*)`", body)
    if unknown:
        at = f"{where}.{unknown.group(1)}" if where else unknown.group(1)
        return f"{at}: unknown key"
    missing = re.fullmatch(r"object missing required field `(.*)`", body)
    if missing:
        at = f"{where}.{missing.group(1)}" if where else missing.group(1)
        return f"{at}: missing, but required"
    body = body.replace("`", "")
    return f"{where}: {body}" if where else body
