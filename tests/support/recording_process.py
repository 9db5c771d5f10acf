"""Reading recordings in tests, and a process that is killed while it records."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

from mcap.reader import make_reader

from gcs.recording.reader import Recording
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from tests.support.chase_messages import EPOCH_NS

CHILD = Path(__file__).with_name("recording_child.py")


class Read(NamedTuple):
    """What a recording gave."""

    entries: list[tuple[str, bytes, int]]
    remarks: list[str]
    refusal: str  # why it could not be opened, "" = it was


def read(path: Path) -> Read:
    """Everything in a recording, or why there is nothing."""
    try:
        recording = Recording(path)
    except ConfigError as error:
        return Read([], [], str(error))
    return Read([tuple(entry) for entry in recording.entries()], recording.remarks, "")


class Killed(NamedTuple):
    """What was left of a recording whose process was killed."""

    missing_s: float  # seconds of flight that are not in the file
    messages: int  # that our reader found, viewers' included
    library: int  # that the mcap library's reader found
    remarks: list[str]


def kill_while_recording(path: Path, lines: int) -> Killed:
    """Kill a recording process (SIGKILL) as soon as it has told of `lines` messages."""
    told = 0
    with subprocess.Popen([sys.executable, str(CHILD), str(path), "100000"], stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        for _ in range(lines):
            told = int(child.stdout.readline())
        os.kill(child.pid, signal.SIGKILL)
        for line in child.stdout:
            if line.endswith(b"\n"):
                told = int(line)
    with path.open("rb") as file:
        library = sum(1 for _ in make_reader(file, validate_crcs=True).iter_messages())
    found = read(path)
    last_ns = found.entries[-1][2] if found.entries else EPOCH_NS
    messages = Recording(path).messages if found.entries else 0
    return Killed((told - last_ns) / NS_PER_S, messages, library, found.remarks)
