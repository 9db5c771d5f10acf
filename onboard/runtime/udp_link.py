"""A UDP socket as a link.

What has arrived is read in batches, not one datagram a turn of the loop as asyncio's own transport does: a
flood then costs little, and the kernel's buffer, in which the autopilot's datagrams stand in line with a
stranger's, stays short.
"""

from __future__ import annotations

import asyncio
import contextlib
import socket
import struct
from collections.abc import Hashable
from typing import Any

from onboard.runtime.receiving import Receiving

BATCH = 256  # datagrams read in one turn of the loop, at most
BUFFER = 1 << 20  # bytes asked of the kernel for what waits; it gives what its administrator allows
SO_MEMINFO, DROPS = 55, 8  # Linux: the socket's memory, and in it what was dropped for want of room


class UdpLink(Receiving):
    """Peers are (host, port); `connected` to one of them it hears nobody else. On a running loop."""

    def __init__(self, name: str, sock: socket.socket, *, connected: bool) -> None:
        super().__init__(name)
        self._connected = connected
        self._socket = sock
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(sock, self._readable)

    @property
    def address(self) -> tuple[str, int]:
        """Where the socket is bound."""
        host, port = self._socket.getsockname()[:2]
        return str(host), int(port)

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """To `peer`, else to whom we last heard; what does not leave is counted by cause."""
        to: Any = self._last if peer is None else peer
        if self._closed:
            self._counts["closed"] += 1
        elif to is None and not self._connected:
            self._counts["no_peer"] += 1
        else:
            try:
                if self._connected:
                    self._socket.send(data)
                else:
                    self._socket.sendto(data, to)
            except (BlockingIOError, InterruptedError):
                self._counts["overflow"] += 1
            except ConnectionRefusedError:  # of an earlier datagram; nobody listening yet is normal
                self._counts["refused"] += 1
            except (OSError, ValueError, TypeError):
                self._counts["error"] += 1
            else:
                self._counts["sent"] += 1

    def counters(self) -> dict[str, int]:
        """sent, received, and what was lost by cause; `overrun`: what the kernel had no room for."""
        overrun = 0
        if not self._closed:
            with contextlib.suppress(OSError, struct.error):
                info = self._socket.getsockopt(socket.SOL_SOCKET, SO_MEMINFO, 4 * (DROPS + 1))
                overrun = struct.unpack_from("=I", info, 4 * DROPS)[0]
        return {**self._counts, **({"overrun": overrun} if overrun else {})}

    def close(self) -> None:
        """Close the socket."""
        if not self._closed:
            self._closed = True
            self._loop.remove_reader(self._socket)
            self._socket.close()

    def _readable(self) -> None:
        for _ in range(BATCH):
            try:
                data, peer = self._socket.recvfrom(65536)
            except (BlockingIOError, InterruptedError):
                return
            except ConnectionRefusedError:
                self._counts["refused"] += 1
                continue
            except OSError:
                self._counts["error"] += 1
                return
            self._arrived(data, peer)
            if self._closed:
                return


def open_socket(found: tuple[Any, ...], *, out: bool) -> socket.socket:
    """A socket bound to what `getaddrinfo` found, or where `out` connected to it. Raises OSError."""
    family, kind, protocol, _, address = found
    sock = socket.socket(family, kind, protocol)
    try:
        sock.setblocking(False)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER)
        if out:
            sock.connect(address)
        else:
            sock.bind(address)
    except BaseException:
        sock.close()
        raise
    return sock
