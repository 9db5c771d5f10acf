"""Progress of long work: a bar on a real terminal, lines elsewhere, nothing for short work."""

from __future__ import annotations

import io
import os
import pty
import re

import pytest

from onboard.runtime.progress import Progress, over, part


class Hand:
    """A clock that is turned by hand."""

    def __init__(self) -> None:
        self.s = 0.0

    def monotonic_ns(self) -> int:
        return round(self.s * 1e9)


def worked(progress: Progress, clock: Hand, seconds: float, step: float = 0.25) -> None:
    """Steady work of some seconds that tells how far it is at every step."""
    with progress:
        while clock.s < seconds:
            clock.s += step
            progress.show(clock.s / seconds, "games")


def test_elsewhere_a_line_comes_every_few_seconds() -> None:
    stream, clock = io.StringIO(), Hand()
    worked(Progress("prog", stream, clock), clock, 20.0)
    lines = stream.getvalue().splitlines()
    assert lines[0] == "prog:  15 % (games, 0:17 left)"
    assert len(lines) == 6
    assert "\r" not in stream.getvalue()


def test_short_work_shows_nothing() -> None:
    stream, clock = io.StringIO(), Hand()
    worked(Progress("prog", stream, clock), clock, 0.9)
    assert stream.getvalue() == ""


def test_on_a_terminal_a_bar_grows_and_goes_and_lines_stand_above_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "60")
    master, slave = pty.openpty()
    with os.fdopen(slave, "w") as stream:
        clock = Hand()
        progress = Progress("prog", stream, clock)
        clock.s = 2.0
        progress.show(0.5, "games")
        progress.aside(lambda line: print(line, file=stream, flush=True))("row 1")
        clock.s = 3.0
        progress.show(0.75, "games with names far longer than what is left of such a window")
        progress.clear()
        shown = ""
        while shown.count("\r\x1b[K") < 4:  # a terminal hands on what was written in pieces
            shown += os.read(master, 65536).decode()
    os.close(master)
    bar, line, rest = re.split(r"\r\x1b\[K", shown)[1:4]
    assert bar == "############------------  50 % games, 0:02 left"
    assert line == "row 1\r\n"
    assert rest.startswith("##################------  75 % games with")
    assert len(rest) == 59
    assert shown.endswith("\r\x1b[K")


@pytest.mark.parametrize("term", ["dumb", None])
def test_a_terminal_that_cannot_move_gets_lines(term: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TERM", raising=False)
    if term is not None:
        monkeypatch.setenv("TERM", term)
    master, slave = pty.openpty()
    with os.fdopen(slave, "w") as stream:
        clock = Hand()
        worked(Progress("prog", stream, clock), clock, 4.0)
        assert os.read(master, 65536) == b"prog:  75 % (games, 0:01 left)\r\n"
    os.close(master)


def test_a_stream_that_cannot_be_written_stops_no_work() -> None:
    clock = Hand()
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(os.dup(writing), "w", buffering=1) as gone:
        worked(Progress("prog", gone, clock), clock, 10.0)
        assert clock.s == 10.0
        with pytest.raises(BrokenPipeError):  # it could indeed not be written
            gone.flush()
        os.dup2(os.open(os.devnull, os.O_WRONLY), gone.fileno())
    os.close(writing)


def test_pieces_share_the_whole() -> None:
    told: list[float] = []
    for number in range(2):
        assert list(over("abc", part(lambda share, what: told.append(share), number, 2), "x")) == list("abc")
    assert told == pytest.approx([0, 1 / 6, 1 / 3, 1 / 2, 2 / 3, 5 / 6])
