"""Two network namespaces joined by a link that really loses IP packets, both ways: for root on Linux.

Each end is a process in a namespace of its own with a TUN device; this one carries the packets between them
and drops some, one by one or in bursts. Needs no kernel module beyond TUN.
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import selectors
import socket
import struct
import subprocess
import sys
import threading
from collections.abc import Sequence
from random import Random
from typing import NamedTuple

ADDRESSES = ("10.9.0.1", "10.9.0.2")
_TUNSETIFF = 0x400454CA
_IFF_TUN_NO_PI = 0x1001
_CLONE_NEWNET = 0x40000000


class Loss(NamedTuple):
    """A Gilbert–Elliott channel: in its bad state every packet is lost."""

    share: float  # of packets lost on the long run
    burst: float = 0.0  # mean number of packets in a burst; 0: each packet for itself

    def __str__(self) -> str:
        return f"{self.share:.0%} lost both ways" + (f", bursts of {self.burst:g}" if self.burst else "")


class Channel:
    """One direction."""

    def __init__(self, loss: Loss, rng: Random) -> None:
        self.loss = loss
        self._rng = rng
        self._bad = False

    def lost(self) -> bool:
        """Whether the next packet is lost."""
        share, burst = self.loss
        if burst <= 1.0:
            return self._rng.random() < share
        leave = 1.0 / burst
        enter = leave * share / (1.0 - share)
        self._bad = self._rng.random() >= leave if self._bad else self._rng.random() < enter
        return self._bad


class LossyLink:
    """Runs one command at each end; `loss` may be changed while they run."""

    def __init__(self, loss: Loss, seed: int = 1) -> None:
        self.carried = 0
        self.dropped = 0
        self._channels = [Channel(loss, Random(seed + side)) for side in (0, 1)]
        self._devices: list[int] = []
        self.processes: list[subprocess.Popen[bytes]] = []
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    def run(self, commands: Sequence[Sequence[str]]) -> None:
        """Start both commands; the first has ADDRESSES[0]."""
        for address, command in zip(ADDRESSES, commands, strict=True):
            ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
            control = theirs.fileno()
            entry = [sys.executable, "-m", "tests.support.lossy_link", address, str(control), *command]
            self.processes.append(subprocess.Popen(entry, pass_fds=[control]))
            theirs.close()
            _, fds, _, _ = socket.recv_fds(ours, 16, 1)
            ours.close()
            if not fds:
                raise RuntimeError("no TUN device: root on Linux is needed")
            os.set_blocking(fds[0], False)
            self._devices.append(fds[0])
        self._thread = threading.Thread(target=self._carry, daemon=True)
        self._thread.start()

    def change(self, loss: Loss) -> None:
        """Another channel from now on."""
        for channel in self._channels:
            channel.loss = loss

    def close(self) -> None:
        """End what still runs."""
        for process in self.processes:
            if process.poll() is None:
                process.kill()
            process.wait()
        self._stop.set()
        if self._thread is not None:
            self._thread.join()
        for device in self._devices:
            os.close(device)

    def _carry(self) -> None:
        selector = selectors.DefaultSelector()
        for side, device in enumerate(self._devices):
            selector.register(device, selectors.EVENT_READ, side)
        while not self._stop.is_set():
            for key, _ in selector.select(0.2):
                try:
                    while True:
                        packet = os.read(key.fd, 65536)
                        if self._channels[key.data].lost():
                            self.dropped += 1
                            continue
                        self.carried += 1
                        os.write(self._devices[1 - key.data], packet)
                except (BlockingIOError, OSError):
                    continue


def available() -> bool:
    """Whether this machine lets us make such a link."""
    return os.geteuid() == 0 and os.access("/dev/net/tun", os.R_OK | os.W_OK)


def _enter(address: str, control: int) -> None:
    if ctypes.CDLL(None, use_errno=True).unshare(_CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), "unshare")
    device = os.open("/dev/net/tun", os.O_RDWR)
    fcntl.ioctl(device, _TUNSETIFF, struct.pack("16sH", b"lossy", _IFF_TUN_NO_PI))
    for words in ("link set lo up", f"addr add {address}/24 dev lossy", "link set lossy up"):
        subprocess.run(["ip", *words.split()], check=True)
    with socket.socket(fileno=control) as channel:
        socket.send_fds(channel, [b"tun"], [device])


if __name__ == "__main__":
    _enter(sys.argv[1], int(sys.argv[2]))
    os.execvp(sys.argv[3], sys.argv[3:])
