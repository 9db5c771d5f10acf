"""Text from the network on a terminal."""

from __future__ import annotations


def printable(text: str) -> str:
    """The text with everything replaced that could steer a terminal or forge a line of a log."""
    if text.isprintable():
        return text
    return "".join(sign if sign.isprintable() else "·" for sign in text)
