"""The background writer of files beside disks that stall, fill up and fail."""

from __future__ import annotations

import errno
import threading
from pathlib import Path
from time import monotonic

import pytest

from onboard.runtime.file_writer import FileWriter

LONG_S = 30.0  # nobody waits for so long unless something is broken
STALL_S = 5.0


class Disk:
    """Files in memory, whose writes wait at a gate, take a few bytes at a time, or fail."""

    def __init__(self, *, open_gate: bool = True, most: int = 1 << 30, room: int = 1 << 30) -> None:
        self.gate = threading.Event()
        if open_gate:
            self.gate.set()
        self.reached = threading.Event()  # somebody has come to the gate
        self.content: dict[str, bytearray] = {}
        self.closed: list[str] = []
        self.most, self.room = most, room

    def open(self, path: Path) -> DiskFile:
        self.content[path.name] = bytearray()
        return DiskFile(self, path.name)


class DiskFile:
    def __init__(self, disk: Disk, name: str) -> None:
        self.disk, self.name = disk, name

    def write(self, data: bytes, /) -> int:
        self.disk.reached.set()
        assert self.disk.gate.wait(LONG_S)
        if self.disk.room < len(data):
            raise OSError(errno.ENOSPC, "No space left on device")
        self.disk.room -= len(data)
        taken = data[: self.disk.most]
        self.disk.content[self.name] += taken
        return len(taken)

    def close(self) -> None:
        self.disk.closed.append(self.name)


def test_a_disk_that_stalls_for_five_seconds_makes_nobody_wait() -> None:
    disk = Disk(open_gate=False)
    writer = FileWriter(queue_bytes=1000, opener=disk.open)
    file = writer.open(Path("a"))
    release = threading.Timer(STALL_S, disk.gate.set)
    release.start()
    file.write(b"first     ")
    assert disk.reached.wait(LONG_S)
    slowest, taken = 0.0, 1
    for number in range(10_000):
        begun = monotonic()
        taken += file.write(b"%09d " % number)
        slowest = max(slowest, monotonic() - begun)
    assert not disk.gate.is_set()  # all of this while the disk stood still
    assert slowest < STALL_S / 2
    assert taken == 100  # the queue's bound, the record at the disk included
    assert file.lost == 10_001 - taken
    assert writer.close(LONG_S)
    release.join()
    assert (file.written, file.lost) == (100, 9901)
    assert bytes(disk.content["a"]) == b"first     " + b"".join(b"%09d " % n for n in range(99))


def test_records_of_several_files_keep_their_order_and_come_whole() -> None:
    disk = Disk(most=3)
    writer = FileWriter(opener=disk.open)
    files = [writer.open(Path(name)) for name in ("a", "b", "c")]
    for number in range(300):
        assert files[number % 3].write(b"%d;" % number)
    files[0].close()
    assert writer.flush(LONG_S)
    assert disk.closed == ["a"]
    assert not files[0].write(b"late")
    assert writer.close(LONG_S)
    assert sorted(disk.closed) == ["a", "b", "c"]
    for index, name in enumerate("abc"):
        assert bytes(disk.content[name]) == b"".join(b"%d;" % n for n in range(index, 300, 3))
    assert [file.counters() for file in files] == [
        {"written": 100, "lost": late, "beyond": 0} for late in (1, 0, 0)
    ]


def test_a_full_disk_is_told_and_later_records_are_counted() -> None:
    disk = Disk(room=25)
    writer = FileWriter(opener=disk.open)
    file, other = writer.open(Path("a")), writer.open(Path("b"))
    for _ in range(4):
        file.write(b"0123456789")
        assert writer.flush(LONG_S)
    assert not file.write(b"0123456789")
    assert (file.fault, file.written, file.lost) == ("no space left on device", 2, 3)
    assert other.write(b"small")
    assert writer.close(LONG_S)
    assert (bytes(disk.content["b"]), other.fault) == (b"small", "")


def test_a_file_that_cannot_be_made_is_told(tmp_path: Path) -> None:
    writer = FileWriter()
    file = writer.open(tmp_path / "no" / "such" / "folder")
    file.write(b"x")
    assert writer.close(LONG_S)
    assert (file.fault, file.written, file.lost) == ("no such file or directory", 0, 1)


@pytest.mark.parametrize(("size", "kept"), [(100, 9), (20, 1), (10, 0), (None, 50)])
def test_a_file_grows_to_its_bound_and_ends_with_its_mark(
    tmp_path: Path, size: int | None, kept: int
) -> None:
    writer = FileWriter()
    file = writer.open(tmp_path / "a", size_max=size, full_mark=b"-- FULL --")
    for number in range(50):
        assert file.write(b"%09d " % number) == (number < kept)
    assert writer.close(LONG_S)
    marked = b"" if size is None else b"-- FULL --"
    assert (tmp_path / "a").read_bytes() == b"".join(b"%09d " % n for n in range(kept)) + marked
    assert (file.full, file.beyond, file.lost) == (size is not None, 50 - kept, 0)


def test_the_mark_is_written_though_the_queue_is_full() -> None:
    disk = Disk(open_gate=False)
    writer = FileWriter(queue_bytes=20, opener=disk.open)
    file = writer.open(Path("a"), size_max=30, full_mark=b"full")
    assert file.write(b"0123456789")
    assert file.write(b"0123456789")
    assert not file.write(b"0123456789")
    disk.gate.set()
    assert writer.close(LONG_S)
    assert bytes(disk.content["a"]) == b"01234567890123456789full"


def test_an_end_that_waits_no_longer_counts_what_is_lost() -> None:
    disk = Disk(open_gate=False)
    writer = FileWriter(opener=disk.open)
    file = writer.open(Path("a"))
    assert file.write(b"x")
    assert disk.reached.wait(LONG_S)
    for _ in range(4):
        assert file.write(b"x")
    assert not writer.flush(0.01)
    assert not writer.close(0.01)
    assert file.lost == 4  # the first is at the disk
    assert not file.write(b"late")
    disk.gate.set()


def test_an_older_file_is_replaced(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"of yesterday, and longer")
    writer = FileWriter()
    writer.open(tmp_path / "a").write(b"new")
    assert writer.close(LONG_S)
    assert (tmp_path / "a").read_bytes() == b"new"
