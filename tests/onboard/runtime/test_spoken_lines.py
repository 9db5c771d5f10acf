"""Lines for people wait for their reader behind a thread: neither a station nor a bridge stands still."""

from __future__ import annotations

import errno
import fcntl
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from onboard.runtime.file_writer import FileWriter
from onboard.runtime.spoken_lines import LINES_BYTES, SpokenLines
from tests.support.bus_stages import free_port
from tests.support.real_time import patience


class Slow:
    """A reader that takes nothing until it is told to."""

    def __init__(self) -> None:
        self.gate = threading.Event()
        self.content = b""

    def write(self, data: bytes, /) -> int:
        assert self.gate.wait(60.0)
        self.content += data
        return len(data)

    def close(self) -> None:
        pass


def test_who_speaks_waits_for_nobody_and_what_is_lost_is_counted() -> None:
    reader = Slow()
    lines = SpokenLines(writer=FileWriter(queue_bytes=1000), sink=reader)
    begun = time.monotonic()
    for number in range(1000):
        lines.say(f"line {number} \x1b[31m")
    assert time.monotonic() - begun < patience(0.2)
    assert lines.lost > 900
    reader.gate.set()
    assert lines.close(patience(5.0))
    said = reader.content.decode().splitlines()
    assert said[0] == "line 0 ·[31m"  # nothing that a terminal would obey
    assert len(said) == 1000 - lines.lost


def _reader_who_left() -> int:
    out, end = os.pipe()
    os.close(out)
    return end


def _full_disk() -> int:
    return os.open("/dev/full", os.O_WRONLY)


@pytest.mark.parametrize(("stream", "number"), [(_reader_who_left, errno.EPIPE), (_full_disk, errno.ENOSPC)])
def test_why_a_line_cannot_be_written_is_told_to_who_speaks(stream: Callable[[], int], number: int) -> None:
    """A reader who left ends a program quietly, a full disk with a line and another exit code."""
    with os.fdopen(stream(), "wb", buffering=0) as refusing:
        lines = SpokenLines(sink=refusing)
        lines.say("anybody?")
        deadline = time.monotonic() + patience(5.0)
        while not lines.lost and time.monotonic() < deadline:
            time.sleep(0.005)
        with pytest.raises(OSError) as told:
            lines.say("anybody?")
        assert told.value.errno == number


@pytest.mark.real
def test_a_bridge_whose_reader_stands_still_plays_on_and_ends_when_told(tmp_path: Path) -> None:
    """It is the master: were it to wait for its reader, its lease would end and nobody would referee."""
    ports = tmp_path / "ports.json"
    command = [
        sys.executable, "-m", "sim_bridge.cli", "serve", "one-on-one",
        "--bus", f"tcp/127.0.0.1:{free_port()}", "--ports", str(ports),
    ]  # fmt: skip
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        fcntl.fcntl(process.stdout.fileno(), fcntl.F_SETPIPE_SZ, 4096)
        held = os.open(f"/proc/self/fd/{process.stdout.fileno()}", os.O_WRONLY)
        os.set_blocking(held, False)
        os.write(held, bytes(4096))  # the pipe is full from the start
        deadline = time.monotonic() + patience(20.0)
        while not ports.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        assert ports.exists()
        process.send_signal(signal.SIGTERM)
        assert process.wait(patience(5.0)) == 0
        os.close(held)
    assert LINES_BYTES > 4096
