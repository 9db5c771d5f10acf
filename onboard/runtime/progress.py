"""How far long work is, on standard error: a bar on a terminal, elsewhere a line every few seconds."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Callable, Collection, Iterator
from types import TracebackType
from typing import Protocol, TextIO, TypeVar

from onboard.core.math.constants import NS_PER_S
from onboard.runtime.clock import RealClock

T = TypeVar("T")
Tell = Callable[[float, str], None]  # (share of the work that is done, what is worked at)
QUIET_S = 1.0  # work that is over sooner shows nothing
BAR_S, LINE_S = 0.1, 3.0  # between two tellings
BAR = 24  # characters


def silent(share: float, what: str) -> None:
    """A `Tell` that nobody hears."""


def part(tell: Tell, number: int, of: int) -> Tell:
    """`tell` for piece `number` (from 0) of `of` equal pieces."""
    return lambda share, what: tell((number + share) / of, what)


def over(pieces: Collection[T], tell: Tell, what: str) -> Iterator[T]:
    """Go through equal pieces of work and tell before each how many are done."""
    for number, piece in enumerate(pieces):
        tell(number / len(pieces), what)
        yield piece


class _Now(Protocol):
    def monotonic_ns(self) -> int: ...


class Progress:
    """Shows how far work is; a context, which takes the bar away at its end. Its `show` is a `Tell`.

    `name` is the program's, before each line; `stream` is standard error unless given. On a stream that
    cannot be written nothing is shown.
    """

    def __init__(self, name: str, stream: TextIO | None = None, clock: _Now | None = None) -> None:
        self._name = name
        self._stream = sys.stderr if stream is None else stream
        self._clock = RealClock() if clock is None else clock
        shows_bars = os.environ.get("TERM", "dumb") != "dumb"
        self._terminal = shows_bars and self._stream is not None and self._stream.isatty()
        self._begun = self._clock.monotonic_ns()
        self._told_s = 0.0
        self._open = False

    def __enter__(self) -> Progress:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.clear()

    def show(self, share: float, what: str) -> None:
        """Tell that `share` of the work is done, if it is time to tell it."""
        now_s = (self._clock.monotonic_ns() - self._begun) / NS_PER_S
        if now_s < QUIET_S or now_s - self._told_s < (BAR_S if self._terminal else LINE_S):
            return
        self._told_s = now_s
        share = min(max(share, 0.0), 1.0)
        left = f", {_clock_words(now_s * (1.0 - share) / share)} left" if share > 0.0 else ""
        if not self._terminal:
            self._write(f"{self._name}: {100 * share:3.0f} % ({what}{left})\n")
            return
        filled = round(BAR * share)
        line = f"{'#' * filled}{'-' * (BAR - filled)} {100 * share:3.0f} % {what}{left}"
        self._write(f"\r\x1b[K{line[: shutil.get_terminal_size().columns - 1]}")
        self._open = True

    def clear(self) -> None:
        """Take the bar away; it comes again with the next telling."""
        if self._open:
            self._write("\r\x1b[K")
            self._open = False

    def aside(self, say: Callable[[str], None]) -> Callable[[str], None]:
        """`say`, for lines that are printed while the bar is there."""

        def said(line: str) -> None:
            self.clear()
            say(line)

        return said

    def _write(self, text: str) -> None:
        if self._stream is not None:
            with contextlib.suppress(OSError, ValueError):  # full, closed, or its reader gone
                self._stream.write(text)
                self._stream.flush()


def _clock_words(seconds: float) -> str:
    """A time as 0:07 or 1:02:03."""
    whole = round(seconds)
    hours, rest = divmod(whole, 3600)
    minutes, rest = divmod(rest, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
