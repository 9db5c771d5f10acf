"""Links: datagrams over UDP or in memory, byte streams over TCP or a serial port, all behind one Protocol.

`open_link` takes them as people write them: `link_urls`.
"""

from __future__ import annotations

import asyncio
import errno
import socket
from collections.abc import AsyncIterator, Hashable
from contextlib import asynccontextmanager
from functools import partial
from typing import Any

from onboard.config.strict import ConfigError
from onboard.runtime.link_urls import Form, LinkUrl, parse_link
from onboard.runtime.off_loop import off_loop
from onboard.runtime.protocols import Link
from onboard.runtime.receiving import Receiving
from onboard.runtime.serial_link import SerialLink
from onboard.runtime.tcp_link import TcpClientLink, TcpServerLink
from onboard.runtime.udp_link import UdpLink, open_socket

PENDING_MAX = 4096  # datagrams under way in a memory link before the next are dropped


class MemoryLink(Receiving):
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


async def open_link(url: str, timeout_s: float = 5.0) -> Link:
    """Open a link as people write it (`link_urls`).

    Raises ConfigError, one line: a URL of another form, a port in use, no such host or device, nobody there.
    """
    link = parse_link(url)
    if link.form is Form.SERIAL:
        return await SerialLink.open(link.name, link.device, link.baud, timeout_s)
    if link.form in (Form.TCP_IN, Form.TCP_OUT):
        return await _open_tcp(link, timeout_s)
    return await open_udp(link.host, link.port, link.name, out=link.form is Form.UDP_OUT, timeout_s=timeout_s)


async def _open_tcp(link: LinkUrl, timeout_s: float) -> Link:
    client, server = TcpClientLink(link.name), TcpServerLink(link.name)
    async with _clear_errors(link.name, link.host, timeout_s):
        host, port = (await _resolved(link.host, link.port))[4][:2]
        if link.form is Form.TCP_OUT:
            await client.connect(host, port)
        else:
            await server.listen(host, port)
    return client if link.form is Form.TCP_OUT else server


async def open_udp(
    host: str, port: int, name: str = "", *, out: bool = False, timeout_s: float = 5.0
) -> UdpLink:
    """Bind to (host, port), port 0 = a free one; or, where `out`, send there. Raises ConfigError."""
    name = name or f"{'udpout' if out else 'udpin'}://{host}:{port}"
    async with _clear_errors(name, host, timeout_s):
        sock = open_socket(await _resolved(host, port), out=out)
    return UdpLink(name, sock, connected=out)


@asynccontextmanager
async def _clear_errors(name: str, host: str, timeout_s: float) -> AsyncIterator[None]:
    """Whatever hinders opening a socket, as a ConfigError of one line."""
    try:
        async with asyncio.timeout(timeout_s):
            yield
    except TimeoutError:
        raise ConfigError(f"link: {name}: no answer about host {host!r} within {timeout_s:g} s") from None
    except socket.gaierror:
        raise ConfigError(f"link: {name}: found host {host!r}, expected one that exists") from None
    except OSError as error:
        raise ConfigError(f"link: {name}: {_reason(error)}") from None


async def _resolved(host: str, port: int) -> tuple[Any, ...]:
    """A host by name, as `getaddrinfo` finds it. A resolver that does not answer is left behind."""
    found = await off_loop(partial(socket.getaddrinfo, host, port, type=socket.SOCK_DGRAM))
    return tuple(found[0])


def _reason(error: OSError) -> str:
    if error.errno == errno.EADDRINUSE:
        return "port in use by another program"
    if error.errno == errno.EADDRNOTAVAIL:
        return "no such address on this machine (to send there: udpout, to connect there: tcp)"
    if error.errno == errno.ECONNREFUSED:
        return "nobody listens there"
    if error.errno in (errno.EACCES, errno.EPERM):
        return "permission denied"
    return (error.strerror or str(error)).lower()
