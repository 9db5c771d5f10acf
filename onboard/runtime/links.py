"""Links: datagrams over UDP or in memory, a byte stream over a serial port, all behind one Protocol.

`open_link` takes a URL:

    udpin://HOST:PORT     (or udp://) listen there; answer whom we last heard
    udpout://HOST:PORT    send there
    serial:///dev/ttyUSB0:57600
"""

from __future__ import annotations

import asyncio
import errno
import re
import socket
from collections import Counter
from collections.abc import Hashable
from functools import partial
from typing import Any

from onboard.config.strict import ConfigError
from onboard.runtime.off_loop import off_loop
from onboard.runtime.protocols import Link, Receiver
from onboard.runtime.serial_link import SerialLink

PENDING_MAX = 4096  # datagrams under way in a memory link before the next are dropped
UDP_BUFFER = 65536  # bytes the kernel's transport may hold back before datagrams are dropped
_FORMS = "udpin://HOST:PORT, udpout://HOST:PORT or serial:///dev/NAME:BAUD"


class _Receiving:
    """What all links share: a name, counters, one receiver and the peer last heard."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._counts: Counter[str] = Counter()
        self._receiver: Receiver | None = None
        self._last: Hashable | None = None
        self._closed = False

    @property
    def name(self) -> str:
        """For people: the URL."""
        return self._name

    def receive(self, receiver: Receiver) -> None:
        """Set the one callback (data, peer)."""
        self._receiver = receiver

    def counters(self) -> dict[str, int]:
        """sent, received, and what was lost by cause."""
        return dict(self._counts)

    def _arrived(self, data: bytes, peer: Hashable) -> None:
        if self._closed:
            return
        self._counts["received"] += 1
        self._last = peer
        if self._receiver is None:
            self._counts["unheard"] += 1
        else:
            self._receiver(data, peer)


class MemoryLink(_Receiving):
    """One end of a pair in one process; what is sent arrives in the loop's next round."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._other: MemoryLink | None = None
        self._pending = 0

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """To the other end, whatever the peer; dropped and counted (`overflow`, `closed`) if it cannot be."""
        other = self._other
        if self._closed or other is None or other._closed:
            self._counts["closed"] += 1
        elif self._pending >= PENDING_MAX:
            self._counts["overflow"] += 1
        else:
            self._counts["sent"] += 1
            self._pending += 1
            asyncio.get_running_loop().call_soon(self._deliver, other, data)

    def _deliver(self, other: MemoryLink, data: bytes) -> None:
        self._pending -= 1
        other._arrived(data, self._name)

    def close(self) -> None:
        """Close this end; the other end counts what it sends from now on."""
        self._closed = True


def memory_pair(name: str) -> tuple[MemoryLink, MemoryLink]:
    """Two connected ends, `NAME/a` and `NAME/b`; each is the peer the other hears."""
    a, b = MemoryLink(f"{name}/a"), MemoryLink(f"{name}/b")
    a._other, b._other = b, a
    return a, b


class UdpLink(_Receiving, asyncio.DatagramProtocol):
    """A UDP socket: peers are (host, port)."""

    def __init__(self, name: str, connected: bool) -> None:
        super().__init__(name)
        self._connected = connected
        self._transport: Any = None  # asyncio's DatagramTransport, whose stub lacks half its methods

    @property
    def address(self) -> tuple[str, int]:
        """Where the socket is bound."""
        host, port = self._transport.get_extra_info("sockname")[:2]
        return str(host), int(port)

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """asyncio's: the socket is open."""
        self._transport = transport

    def datagram_received(self, data: bytes, addr: Hashable) -> None:
        """asyncio's: a datagram came."""
        self._arrived(data, addr)

    def error_received(self, exc: Exception) -> None:
        """asyncio's: the kernel reports on an earlier datagram; nobody listening yet is normal."""
        self._counts["refused" if isinstance(exc, ConnectionRefusedError) else "error"] += 1

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """To `peer`, else to whom we last heard; counts `no_peer`, `overflow`, `error` and `closed`."""
        transport = self._transport
        if self._closed or transport is None:
            self._counts["closed"] += 1
            return
        to = None if self._connected else (self._last if peer is None else peer)
        if to is None and not self._connected:
            self._counts["no_peer"] += 1
        elif transport.get_write_buffer_size() > UDP_BUFFER:
            self._counts["overflow"] += 1
        else:
            try:
                transport.sendto(data, to)
            except (OSError, ValueError, TypeError):
                self._counts["error"] += 1
            else:
                self._counts["sent"] += 1

    def close(self) -> None:
        """Close the socket."""
        self._closed = True
        if self._transport is not None:
            self._transport.close()


async def open_link(url: str, timeout_s: float = 5.0) -> Link:
    """Open a link by its URL.

    Raises ConfigError, one line: a URL of another form, a port in use, no such host or device.
    """
    serial = re.fullmatch(r"serial://(/.+?)(?::(\d+))?", url)
    if serial:
        return await SerialLink.open(url, serial.group(1), int(serial.group(2) or 57600), timeout_s)
    udp = re.fullmatch(r"(udp|udpin|udpout)://(\[[0-9a-fA-F:]+\]|[^:/\[\]]+):(\d+)/?", url)
    if udp is None:
        raise ConfigError(f"link: found {url!r}, expected {_FORMS}")
    form, host, port = udp.group(1), udp.group(2).strip("[]"), int(udp.group(3))
    if port > 65535 or (port == 0 and form == "udpout"):
        raise ConfigError(f"link: {url}: found port {port}, expected 1 to 65535")
    return await open_udp(host, port, url, out=form == "udpout", timeout_s=timeout_s)


async def open_udp(
    host: str, port: int, name: str = "", *, out: bool = False, timeout_s: float = 5.0
) -> UdpLink:
    """Bind to (host, port), port 0 = a free one; or, where `out`, send there. Raises ConfigError."""
    name = name or f"{'udpout' if out else 'udpin'}://{host}:{port}"
    loop = asyncio.get_running_loop()
    try:
        async with asyncio.timeout(timeout_s):
            address = await _resolved(host, port)
            _, link = await loop.create_datagram_endpoint(
                lambda: UdpLink(name, out),
                local_addr=None if out else address,
                remote_addr=address if out else None,
            )
    except TimeoutError:
        raise ConfigError(f"link: {name}: no answer about host {host!r} within {timeout_s:g} s") from None
    except socket.gaierror:
        raise ConfigError(f"link: {name}: found host {host!r}, expected one that exists") from None
    except OSError as error:
        raise ConfigError(f"link: {name}: {_reason(error)}") from None
    return link


async def _resolved(host: str, port: int) -> tuple[str, int]:
    """The address of a host by name. The resolver's thread is left behind where it does not answer."""
    found = await off_loop(partial(socket.getaddrinfo, host, port, type=socket.SOCK_DGRAM))
    where: Any = found[0][4]
    return str(where[0]), port


def _reason(error: OSError) -> str:
    if error.errno == errno.EADDRINUSE:
        return "port in use by another program"
    if error.errno == errno.EADDRNOTAVAIL:
        return "no such address on this machine"
    if error.errno in (errno.EACCES, errno.EPERM):
        return "permission denied"
    return (error.strerror or str(error)).lower()
