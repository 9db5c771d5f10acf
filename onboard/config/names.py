"""Names that people give: of games on the bus, and titles of scenarios and routes."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from onboard.config.strict import convert

# A chunk of a Zenoh key: `/` separates chunks, `* $ # ?` are reserved, `@` in front hides a chunk from `*`.
GameName = Annotated[
    str,
    Meta(
        min_length=1,
        max_length=64,
        pattern=r"\A[^\s/*$#?@\x00-\x1f\x7f]+\Z",
        description="a name without / * $ # ? @ or blanks, of at most 64 characters",
    ),
]
Title = Annotated[
    str,
    Meta(
        min_length=1,
        max_length=100,
        pattern=r"\A[^\x00-\x1f\x7f]+\Z",
        description="one line of text, of at most 100 characters",
    ),
]


def game_name(text: str, key: str = "game") -> str:
    """`text` where it can be a game's name on the bus. Raises ConfigError that begins with `key`."""
    return convert(text, GameName, key)


def file_name(title: str) -> str:
    """A title as a part of a file's name: its letters and digits, joined by hyphens."""
    return "-".join("".join(c if c.isalnum() else " " for c in title).split())
