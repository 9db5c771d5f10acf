"""Files that are there whole or not at all: on a full disk, after a kill, of two who begin at once."""

from __future__ import annotations

import multiprocessing
import os
import resource
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from onboard.config.strict import ConfigError
from onboard.runtime.whole_files import sweep, whole_or_nothing, write_first, write_whole

FULL = """
import resource, signal
from pathlib import Path
from onboard.runtime.program import run
from onboard.runtime.whole_files import write_whole
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
run(lambda: write_whole(Path("shard"), bytes(5000)), "prog")
"""


@contextmanager
def little_room(bytes_: int) -> Iterator[None]:
    """Files of this process get no longer; the kernel says so as it does where a disk is full."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_without_room_the_file_of_before_stays_and_the_error_names_it(tmp_path: Path) -> None:
    path = tmp_path / "shard.parquet"
    write_whole(path, b"before")
    for write in (
        lambda: write_whole(path, bytes(5000)),
        lambda: write_whole(path, bytes(5000), durable=True),
        lambda: whole_or_nothing(path, lambda part: part.write_text("x" * 5000)),
        lambda: write_first(tmp_path / "manifest.json", bytes(5000)),
    ):
        with little_room(1000), pytest.raises(ConfigError, match=r"(shard|manifest)\.\w+: file too large"):
            write()
        assert {one.name: one.read_bytes() for one in tmp_path.iterdir()} == {"shard.parquet": b"before"}


def test_a_program_that_finds_no_room_names_the_file_and_ends_by_74(tmp_path: Path) -> None:
    found = subprocess.run([sys.executable, "-c", FULL], cwd=tmp_path, capture_output=True, check=False)
    assert (found.returncode, found.stderr) == (74, b"prog: shard: file too large\n")


def test_what_the_dead_left_is_swept_and_what_the_living_write_is_not(tmp_path: Path) -> None:
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    host = socket.gethostname()
    dead = [f".manifest.{host}.{gone.pid}.part.json", f".shard-1.{host}.{gone.pid}.part.parquet"]
    others = [
        f".shard-2.{host}.{os.getpid()}.part.parquet", f".shard-3.elsewhere.{gone.pid}.part.parquet",
        "notes.part", ".part", "shard-4.parquet",
    ]  # fmt: skip
    for name in (*dead, *others):
        (tmp_path / name).write_bytes(b"")
    sweep(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(others)


def begin(path: Path, number: int) -> bool:
    """One of several that begin at once."""
    return write_first(path, b"%d" % number * 1000)


def test_of_those_who_begin_at_once_one_is_first_and_its_file_stays(tmp_path: Path) -> None:
    path = tmp_path / "manifest.json"
    with multiprocessing.get_context("fork").Pool(4) as pool:
        first = pool.starmap(begin, [(path, number) for number in range(8)])
    assert first.count(True) == 1
    assert path.read_bytes() == b"%d" % first.index(True) * 1000
    assert list(tmp_path.iterdir()) == [path]
