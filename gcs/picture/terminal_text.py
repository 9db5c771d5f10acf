"""Text from the network on a terminal."""

from __future__ import annotations

from onboard.config.printable import printable

__all__ = ["cut", "printable"]


def cut(text: str, width: int) -> str:
    """Text of at most `width` characters; one that was longer ends in "…"."""
    return text if len(text) <= width else f"{text[: max(0, width - 1)]}…"[:width]
