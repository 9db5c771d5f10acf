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
from collections.abc import Hashable
from functools import partial
from typing import Any

from onboard.config.strict import ConfigError
from onboard.runtime.off_loop import off_loop
from onboard.runtime.protocols import Link
from onboard.runtime.receiving import Receiving
from onboard.runtime.serial_link import SerialLink
from onboard.runtime.udp_link import UdpLink, open_socket

PENDING_MAX = 4096  # datagrams under way in a memory link before the next are dropped
_FORMS = "udpin://HOST:PORT, udpout://HOST:PORT or serial:///dev/NAME:BAUD"


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
    try:
        async with asyncio.timeout(timeout_s):
            found = await _resolved(host, port)
        link = UdpLink(name, open_socket(found, out=out), connected=out)
    except TimeoutError:
        raise ConfigError(f"link: {name}: no answer about host {host!r} within {timeout_s:g} s") from None
    except socket.gaierror:
        raise ConfigError(f"link: {name}: found host {host!r}, expected one that exists") from None
    except OSError as error:
        raise ConfigError(f"link: {name}: {_reason(error)}") from None
    return link


async def _resolved(host: str, port: int) -> tuple[Any, ...]:
    """A host by name, as `getaddrinfo` finds it. A resolver that does not answer is left behind."""
    found = await off_loop(partial(socket.getaddrinfo, host, port, type=socket.SOCK_DGRAM))
    return tuple(found[0])


def _reason(error: OSError) -> str:
    if error.errno == errno.EADDRINUSE:
        return "port in use by another program"
    if error.errno == errno.EADDRNOTAVAIL:
        return "no such address on this machine"
    if error.errno in (errno.EACCES, errno.EPERM):
        return "permission denied"
    return (error.strerror or str(error)).lower()
