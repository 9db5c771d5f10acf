"""The keys of a scenario file, docs/scenario-reference.md: `python -m onboard.game.describe` prints it.

Made from the types themselves: names, ranges and defaults as files are checked by them, words from the
comments beside the fields.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from typing import Any

import msgspec
from msgspec import inspect as types

from onboard.config.in_words import bare, expected
from onboard.core.game.rules import Rules
from onboard.core.math.states import VehicleLimits
from onboard.game import scenario

HEAD = """# Keys of a scenario file

Made from the types that check the files: `python -m onboard.game.describe`. Positions are `[north, east]` or
`[north, east, height]` in metres of the game frame, angles in degrees. A key without a default is required;
"–" may be left out and then follows from other keys. An unknown key is an error.
"""
FIELD = re.compile(r'^\s+"?(\w+)"?: .*?#\s*(.+)$', re.MULTILINE)
INTRODUCTIONS = {
    "": "The file itself",
    "evader": "`[evader]`, each `[[evaders]]` and each `[[pursuers]]`",
    "zones": "Each of `[[zones]]`",
}


def described() -> str:
    """The page, in Markdown."""
    parts = [HEAD]
    for place, kind in _tables(scenario.Scenario, ""):
        title = INTRODUCTIONS.get(place, f"`[{place}]`")
        parts += [f"\n## {title}\n\n{(kind.__doc__ or '').strip().splitlines()[0]}\n\n", *_rows(kind)]
    return "".join(parts)


def _tables(kind: type[Any], place: str) -> Iterator[tuple[str, type[Any]]]:
    """Every struct of the file with its place, from the outside in; vehicles alike once."""
    yield place, kind
    for field in types.type_info(kind).fields:  # type: ignore[attr-defined]
        inner = bare(field.type)
        if field.encode_name == "zones" and isinstance(inner, types.VarTupleType):
            inner = bare(inner.item_type)
        if isinstance(inner, types.StructType):
            yield from _tables(inner.cls, f"{place}.{field.encode_name}" if place else field.encode_name)


def _rows(kind: type[Any]) -> Iterator[str]:
    yield "| key | what it may be | default | what it says |\n|---|---|---|---|\n"
    words = _comments(kind)
    for field in types.type_info(kind).fields:  # type: ignore[attr-defined]
        if isinstance(bare(field.type), types.StructType) or field.encode_name in ("pursuers", "evaders"):
            continue
        said = words.get(field.name) or words.get(field.name.removesuffix("_deg"), "")
        if field.name.endswith("_deg"):
            said = said.replace("[rad", "[deg").replace("2π", "360")
        may = expected(kind, [field.encode_name], another_type=False)
        yield f"| `{field.encode_name}` | {may} | {_default(field)} | {said.replace('|', '/')} |\n"


def _comments(kind: type[Any]) -> dict[str, str]:
    """The comment beside each field: of the struct and its bases, the core's types, the tables of keys."""
    sources = [inspect.getsource(core) for core in (Rules, VehicleLimits)]
    sources.append(inspect.getsource(scenario).partition("class Parameters")[0])
    written = (one for one in reversed(kind.__mro__) if one.__module__.startswith("onboard.game."))
    sources += [
        inspect.getsource(one) for one in written if one.__name__ in vars(sys.modules[one.__module__])
    ]
    return {name: said.strip() for source in sources for name, said in FIELD.findall(source)}


def _default(field: types.Field) -> str:
    value = field.default
    if field.default_factory is not msgspec.NODEFAULT:
        return "empty"
    if value is msgspec.NODEFAULT:
        return "**required**"
    if value is None or value == "":
        return "–"
    plain = msgspec.to_builtins(value)
    return f"`{msgspec.json.encode(plain).decode()}`"


if __name__ == "__main__":
    print(described(), end="")
