"""Key patterns of the bus: `*` stands for one chunk, `**` for any number, none included."""

from __future__ import annotations


def matches(pattern: str, key: str) -> bool:
    """Whether a key (without wildcards) belongs to a pattern."""
    return intersects(pattern, key)


def intersects(one: str, other: str) -> bool:
    """Whether some key belongs to both patterns."""
    return _meet(tuple(one.split("/")), tuple(other.split("/")))


def _meet(a: tuple[str, ...], b: tuple[str, ...]) -> bool:
    if not a or not b:
        return all(chunk == "**" for chunk in a or b)
    if a[0] == "**":
        return _meet(a[1:], b) or _meet(a, b[1:])
    if b[0] == "**":
        return _meet(a, b[1:]) or _meet(a[1:], b)
    return (a[0] == b[0] or "*" in (a[0], b[0])) and _meet(a[1:], b[1:])
