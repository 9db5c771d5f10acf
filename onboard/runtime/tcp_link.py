"""TCP links: a client that connects again when its connection ends, and a server of a few clients.

ArduPilot's simulation and many radios offer TCP alone. What a slow reader does not take is dropped by whole
messages, as on a serial port: telemetry is of no use late.
"""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Hashable
from typing import Any, Protocol

from onboard.runtime.receiving import Receiving

BACKLOG_MAX = 16384  # bytes that wait for a connection before the next message is dropped
RECONNECT_S = 1.0
CLIENTS_MAX = 8  # of a server; the next is turned away


class _Owner(Protocol):
    """A link, as its connections see it."""

    def opened(self, connection: _Connection) -> None:
        """A connection is open."""
        ...

    def heard(self, data: bytes, connection: _Connection) -> None:
        """Some bytes came."""
        ...

    def lost(self, connection: _Connection) -> None:
        """A connection has ended."""
        ...


class _Connection(asyncio.Protocol):
    """One connection, whichever side it was opened from."""

    def __init__(self, owner: _Owner) -> None:
        self.peer: Hashable = None
        self.transport: Any = None
        self._owner = owner

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """asyncio's: it is open."""
        self.transport = transport
        self.peer = transport.get_extra_info("peername")
        found = transport.get_extra_info("socket")
        if found is not None:
            found.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._owner.opened(self)

    def data_received(self, data: bytes) -> None:
        """asyncio's: some bytes came."""
        self._owner.heard(data, self)

    def connection_lost(self, exc: Exception | None) -> None:
        """asyncio's: it has ended."""
        self._owner.lost(self)

    def write(self, data: bytes) -> str:
        """Send a whole message or nothing; the cause why not, or "sent"."""
        transport = self.transport
        if transport is None or transport.is_closing():
            return "closed"
        if transport.get_write_buffer_size() + len(data) > BACKLOG_MAX:
            return "overflow"
        transport.write(data)
        return "sent"


class TcpClientLink(Receiving):
    """A connection to one server, opened again a second after it ends."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._where = ("", 0)
        self._connection: _Connection | None = None
        self._again: asyncio.Task[None] | None = None

    async def connect(self, host: str, port: int) -> None:
        """Open the connection. Raises OSError."""
        self._where = (host, port)
        loop = asyncio.get_running_loop()
        await loop.create_connection(lambda: _Connection(self), *self._where)

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """To the server, whatever the peer; counts `unconnected`, `overflow` and `closed`."""
        if self._closed:
            self._counts["closed"] += 1
        elif self._connection is None:
            self._counts["unconnected"] += 1
        else:
            self._counts[self._connection.write(data)] += 1

    def close(self) -> None:
        """End the connection."""
        self._closed = True
        if self._again is not None:
            self._again.cancel()
        if self._connection is not None:
            self._connection.transport.close()

    def opened(self, connection: _Connection) -> None:
        """A connection's: it is open."""
        if self._closed:
            connection.transport.abort()
        else:
            self._connection = connection

    def heard(self, data: bytes, connection: _Connection) -> None:
        """A connection's: some bytes came."""
        self._arrived(data, self._name)

    def lost(self, connection: _Connection) -> None:
        """A connection's: it has ended, and is opened again."""
        if connection is not self._connection:
            return
        self._connection = None
        if not self._closed:
            self._counts["disconnected"] += 1
            self._again = asyncio.get_running_loop().create_task(self._reconnect())  # ended by close

    async def _reconnect(self) -> None:
        while not self._closed and self._connection is None:
            await asyncio.sleep(RECONNECT_S)
            try:
                await self.connect(*self._where)
            except OSError:
                continue
            self._counts["reconnected"] += 1


class TcpServerLink(Receiving):
    """A listening socket: its peers are the clients' addresses."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._server: asyncio.Server | None = None
        self._clients: dict[Hashable, _Connection] = {}

    async def listen(self, host: str, port: int) -> None:
        """Open the socket. Raises OSError."""
        loop = asyncio.get_running_loop()
        self._server = await loop.create_server(lambda: _Connection(self), host, port)

    @property
    def address(self) -> tuple[str, int]:
        """Where the socket is bound."""
        assert self._server is not None
        host, port = self._server.sockets[0].getsockname()[:2]
        return str(host), int(port)

    def send(self, data: bytes, peer: Hashable | None = None) -> None:
        """To `peer`, else to whom we last heard, or to all while nobody has spoken.

        Counts `no_peer`, `overflow` and `closed`."""
        if self._closed:
            self._counts["closed"] += 1
            return
        to = self._last if peer is None else peer
        clients = list(self._clients.values()) if to is None else [self._clients.get(to)]
        for client in clients or [None]:
            self._counts["no_peer" if client is None else client.write(data)] += 1

    def close(self) -> None:
        """End the socket and its connections."""
        self._closed = True
        if self._server is not None:
            self._server.close()
        for client in list(self._clients.values()):
            client.transport.close()

    def opened(self, connection: _Connection) -> None:
        """A connection's: a client is there."""
        if self._closed or len(self._clients) >= CLIENTS_MAX:
            self._counts["turned_away"] += 1
            connection.transport.abort()
        else:
            self._clients[connection.peer] = connection

    def heard(self, data: bytes, connection: _Connection) -> None:
        """A connection's: some bytes came."""
        self._arrived(data, connection.peer)

    def lost(self, connection: _Connection) -> None:
        """A connection's: the client is gone."""
        if self._clients.get(connection.peer) is connection:
            del self._clients[connection.peer]
