"""An autopilot's socket that times its companion: from a position sent to the setpoint that answers it.

The kernel stamps what arrives, so that this process being busy does not count.
"""

from __future__ import annotations

import asyncio
import socket
import struct
from collections import Counter
from collections.abc import Hashable
from time import time_ns

from onboard.runtime.protocols import Receiver

SO_TIMESTAMPNS = 35  # Linux: the arrival in CLOCK_REALTIME, as ancillary data
POSITION, SETPOINT = 33, 84  # GLOBAL_POSITION_INT, SET_POSITION_TARGET_LOCAL_NED
VELOCITY = slice(26, 38)  # of a setpoint's frame
_STAMP = struct.Struct("qq")


class Stopwatch:
    """A link to one UDP port of this machine. `latencies_ns`: of each position that was answered.

    `fresh`: only a setpoint with another velocity than the last counts as an answer (MAVSDK repeats the
    last one by a timer of its own)."""

    name = "stopwatch"

    def __init__(self, port: int, *, fresh: bool) -> None:
        self.latencies_ns: list[int] = []
        self.positions = 0
        self.arrivals_ns: list[int] = []  # of all setpoints [ns, wall], as the kernel stamped them
        self._to = ("127.0.0.1", port)
        self._fresh = fresh
        self._sent_ns = 0  # of the last position, until it is answered
        self._velocity = b""
        self._receiver: Receiver | None = None
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self._socket.setblocking(False)
        self._socket.bind(("127.0.0.1", 0))
        asyncio.get_running_loop().add_reader(self._socket, self._readable)

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """Send a frame; the clock runs from a position on."""
        if _number(data) == POSITION:
            self.positions += 1
            self._sent_ns = time_ns()
        self._socket.sendto(data, self._to)

    def receive(self, receiver: Receiver) -> None:
        """Set the one callback (data, peer)."""
        self._receiver = receiver

    def counters(self) -> dict[str, int]:
        """Nothing is dropped."""
        return dict(Counter())

    def restart(self) -> None:
        """Forget what was measured."""
        self.latencies_ns.clear()
        self.arrivals_ns.clear()
        self.positions = 0

    def lend(self) -> int:
        """The socket's descriptor, for another process that sends from the same port."""
        return self._socket.fileno()

    def close(self) -> None:
        """Close the socket."""
        asyncio.get_running_loop().remove_reader(self._socket)
        self._socket.close()

    def _readable(self) -> None:
        data, ancillary, _, peer = self._socket.recvmsg(65536, 256)
        stamps = [
            _STAMP.unpack(content[:16])
            for level, kind, content in ancillary
            if (level, kind) == (socket.SOL_SOCKET, SO_TIMESTAMPNS)
        ]
        if stamps and _number(data) == SETPOINT:
            self.arrivals_ns.append(stamps[0][0] * 1_000_000_000 + stamps[0][1])
        if stamps and _number(data) == SETPOINT and self._sent_ns:
            (seconds, nanoseconds), velocity = stamps[0], data[VELOCITY]
            if not self._fresh or velocity != self._velocity:
                self.latencies_ns.append(seconds * 1_000_000_000 + nanoseconds - self._sent_ns)
                self._sent_ns = 0
            self._velocity = velocity
        if self._receiver is not None:
            self._receiver(data, peer)


def _number(frame: bytes) -> int:
    return frame[7] | frame[8] << 8 | frame[9] << 16 if len(frame) > 9 and frame[0] == 0xFD else -1
