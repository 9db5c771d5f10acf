"""Foreign text in a line: what a device, a peer, a plug-in or an exception says cannot steer a terminal."""

from __future__ import annotations

LENGTH_MAX = 500  # characters of an exception's words that are kept


def printable(text: str) -> str:
    """The text with everything replaced that could steer a terminal or forge a line of a log."""
    if text.isprintable():
        return text
    return "".join(sign if sign.isprintable() else "·" for sign in text)


def words_of(error: BaseException) -> str:
    """What an exception says, in one printable line of bounded length; its type's name where it says nothing.

    The exception may be anybody's: one whose own words raise is told by its type.
    """
    name = type(error).__name__
    try:
        said = " ".join(str(error)[: 4 * LENGTH_MAX].split())
    except BaseException as trouble:
        if isinstance(trouble, KeyboardInterrupt):
            raise
        said = ""
    return printable(said or name)[:LENGTH_MAX]


def named(error: BaseException) -> str:
    """An exception's type and words, as `ValueError: no such thing`."""
    name, said = printable(type(error).__name__), words_of(error)
    return name if said == name else f"{name}: {said}"[:LENGTH_MAX]
