"""A disk or a reader of standard error that hangs: the agent flies on, says so, and ends when it is told."""

from __future__ import annotations

import fcntl
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from itertools import pairwise
from pathlib import Path

import pytest

from onboard.agent.config import AgentConfig, SigningConfig
from onboard.agent.opening import signing_of
from onboard.agent.shell import Equipment
from onboard.agent.written_files import WrittenFiles
from onboard.runtime.clock import VirtualClock
from onboard.runtime.file_writer import FileWriter
from onboard.runtime.loop import virtual_clock
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.support.real_time import patience
from tests.support.small_scenarios import PURSUER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import WholeGame, setpoints_heard, under_way

FROZEN_S = 5.0
GAP_S = 0.2
LONG_S = 60.0


class VirtualDisk:
    """Files in memory. While it is frozen, the loop's thread loses `FROZEN_S` in it, and any other waits."""

    def __init__(self, clock: VirtualClock) -> None:
        self.content = bytearray()
        self.thawed = threading.Event()
        self.thawed.set()
        self._clock = clock
        self._loop_thread = threading.get_ident()

    def write(self, data: bytes, /) -> int:
        if threading.get_ident() == self._loop_thread and not self.thawed.is_set():
            self._clock.advance_to(self._clock.monotonic_ns() + round(FROZEN_S * 1e9))
        assert self.thawed.wait(LONG_S) or threading.get_ident() == self._loop_thread
        self.content += data
        return len(data)

    def close(self) -> None:
        pass


class GameOnDisk(WholeGame):
    """A game whose pursuer writes everything that an agent can write to one disk."""

    disk: VirtualDisk
    files: WrittenFiles
    writer: FileWriter

    def equipment(self, id: int, config: AgentConfig) -> Equipment:
        given = super().equipment(id, config)
        if id != PURSUER:
            return given
        self.disk = VirtualDisk(virtual_clock())
        self.writer = FileWriter(opener=lambda path: self.disk)
        self.log = self.writer.open(Path("log"))
        self.files = WrittenFiles(config, disk=self.writer, lines=self.writer, errors=self.disk)
        return given._replace(
            log=self.files.line, record=lambda wall_ns, frame: bool(self.log.write(frame)) or None,
            counters=self.files.counters,
        )  # fmt: skip


@virtual
async def test_a_disk_frozen_for_five_seconds_leaves_no_gap_in_the_setpoints() -> None:
    async with GameOnDisk(chase(), virtual_clock()) as game:
        await under_way(game, 3.0)
        heard = setpoints_heard(game, PURSUER)
        before = len(game.disk.content)
        game.disk.thawed.clear()
        await game.forward(FROZEN_S)
        assert len(game.disk.content) - before <= 65536  # at most what was on its way
        game.disk.thawed.set()
        await game.forward(1.0)
        gaps = [(b - a) / 1e9 for a, b in pairwise(heard)]
        assert len(heard) > 100
        assert max(gaps) <= GAP_S
        assert game.files._disk.flush(LONG_S)
        assert game.log.lost == 0
        assert len(game.disk.content) > before


@pytest.mark.real
def test_nobody_who_writes_waits_and_what_is_lost_is_counted(tmp_path: Path) -> None:
    gate = threading.Event()

    class Frozen:
        def write(self, data: bytes, /) -> int:
            assert gate.wait(LONG_S)
            return len(data)

        def close(self) -> None:
            pass

    key = tmp_path / "key"
    key.write_bytes(bytes(32))
    key.chmod(0o600)
    config = AgentConfig(
        log=str(tmp_path / "log.tlog"), events=str(tmp_path / "a.events"), signing=SigningConfig(key=str(key))
    )
    disk = FileWriter(queue_bytes=10_000, opener=lambda path: Frozen())
    disk.open(Path("first")).write(b"in the way")  # the disk's thread now waits for the gate
    files = WrittenFiles(config, disk=disk, lines=FileWriter(queue_bytes=1000), errors=Frozen())
    signing = signing_of(config, files.stamps)
    assert signing is not None
    begun = time.monotonic()
    for number in range(1000):
        files.record(number, bytes(300))
        files.line("a line of some length \x1b[31m, \n forged")
        signing.next_stamp(time.time_ns() + number * 2 * 10**9)
    assert time.monotonic() - begun < patience(0.2)
    counters = files.counters()
    assert counters["log_lost"] > 900
    assert counters["lines_lost"] > 900
    assert counters["stamps_unsaved"] == 0  # one job waits, with the latest
    gate.set()
    assert disk.flush(LONG_S)
    assert signing_of(config) is not None
    assert files.stamps is not None
    assert files.stamps.load().own >= signing.next_stamp(0)
    files.close()
    assert 0 < (tmp_path / "log.tlog").stat().st_size < 20_000


@pytest.mark.real
def test_an_agent_whose_log_and_standard_error_hang_lives_and_ends_when_told(tmp_path: Path) -> None:
    log = tmp_path / "log"
    os.mkfifo(log)
    held = os.open(log, os.O_RDWR)  # a reader that never reads
    fcntl.fcntl(held, fcntl.F_SETPIPE_SZ, 4096)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as autopilot:
        autopilot.bind(("127.0.0.1", 0))
        autopilot.settimeout(patience(5.0))
        port = autopilot.getsockname()[1]
        command = [sys.executable, "-m", "onboard.cli", "--link", f"udpout://127.0.0.1:{port}",
                   "--bus", "tcp/127.0.0.1:1", "--log", str(log)]  # fmt: skip
        with subprocess.Popen(command, stderr=subprocess.PIPE) as process:
            assert process.stderr is not None
            fcntl.fcntl(process.stderr.fileno(), fcntl.F_SETPIPE_SZ, 4096)
            _, agent = autopilot.recvfrom(2000)
            sender = DialectSender(2, 1)
            for _ in range(1000):
                autopilot.sendto(sender.pack(dialect.MAVLink_heartbeat_message(2, 3, 0x89, 5, 4, 3)), agent)
            for _ in range(3):  # it still says its own heartbeat
                autopilot.recvfrom(2000)
            process.send_signal(signal.SIGTERM)
            assert process.wait(patience(2.5)) == 0
    os.close(held)


@pytest.mark.real
def test_a_signal_ends_a_process_whose_loop_hangs() -> None:
    code = (
        "from onboard.agent import program\n"
        "from onboard.agent.config import AgentConfig\n"
        "class Hangs(program.Agent):\n"
        "    async def run(self):\n"
        "        print('hangs', flush=True)\n"
        "        while True: pass\n"
        "program.Agent = Hangs; program.END_S = 0.3\n"
        "program.fly(AgentConfig(link=('udpin://127.0.0.1:0',), bus='tcp/127.0.0.1:1'))\n"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "hangs\n"
        process.send_signal(signal.SIGTERM)
        try:
            assert process.wait(patience(1.0)) == 1
        finally:
            process.kill()
