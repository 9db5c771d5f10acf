"""Links: memory pairs in virtual time, UDP and a serial port for real."""

from __future__ import annotations

import asyncio
import os
import pty
import socket
import threading
from collections.abc import Hashable

import pytest

from onboard.config.strict import ConfigError
from onboard.runtime.links import PENDING_MAX, memory_pair, open_link, open_udp
from onboard.runtime.protocols import Link
from onboard.runtime.serial_link import BACKLOG_MAX, SerialLink
from onboard.runtime.tcp_link import CLIENTS_MAX, TcpServerLink
from onboard.runtime.udp_link import BATCH, UdpLink
from tests.support.real_time import patience, until
from tests.support.virtual_time import virtual


class Inbox:
    """Collects what a link receives; can be waited for."""

    def __init__(self, link: Link) -> None:
        self.got: list[tuple[bytes, Hashable]] = []
        self._more = asyncio.Event()
        link.receive(self._take)

    def _take(self, data: bytes, peer: Hashable) -> None:
        self.got.append((data, peer))
        self._more.set()

    async def until(self, count: int) -> list[tuple[bytes, Hashable]]:
        async with asyncio.timeout(patience(5.0)):
            while len(self.got) < count:
                self._more.clear()
                await self._more.wait()
        return self.got


@virtual
async def test_a_memory_pair_carries_both_ways_in_order() -> None:
    a, b = memory_pair("vehicle 2")
    at_a, at_b = Inbox(a), Inbox(b)
    for number in range(5):
        a.send(bytes([number]))
    b.send(b"back")
    assert at_b.got == []  # nothing arrives inside the call that sends it
    await asyncio.sleep(0)
    assert at_b.got == [(bytes([number]), "vehicle 2/a") for number in range(5)]
    assert at_a.got == [(b"back", "vehicle 2/b")]
    assert a.counters() == {"sent": 5, "received": 1}


@virtual
async def test_a_memory_link_is_bounded_and_says_what_it_dropped() -> None:
    a, b = memory_pair("flood")
    at_b = Inbox(b)
    for _ in range(PENDING_MAX + 10):
        a.send(b"x")
    await asyncio.sleep(0)
    assert len(at_b.got) == PENDING_MAX
    assert a.counters()["overflow"] == 10
    b.close()
    a.send(b"y")
    await asyncio.sleep(0)
    assert a.counters()["closed"] == 1
    assert len(at_b.got) == PENDING_MAX


@virtual
async def test_what_nobody_hears_is_counted() -> None:
    a, b = memory_pair("deaf")
    a.send(b"x")
    await asyncio.sleep(0)
    assert b.counters() == {"received": 1, "unheard": 1}


@pytest.mark.real
async def test_udp_answers_whom_it_last_heard() -> None:
    listener = await open_link("udpin://127.0.0.1:0")
    assert isinstance(listener, UdpLink)
    port = listener.address[1]
    caller = await open_link(f"udpout://127.0.0.1:{port}")
    at_listener, at_caller = Inbox(listener), Inbox(caller)
    try:
        listener.send(b"to nobody yet")
        assert listener.counters() == {"no_peer": 1}
        caller.send(b"hello")
        assert (await at_listener.until(1))[0][0] == b"hello"
        listener.send(b"welcome")
        assert (await at_caller.until(1))[0] == (b"welcome", ("127.0.0.1", port))
    finally:
        listener.close()
        caller.close()
    caller.send(b"late")
    assert caller.counters()["closed"] == 1


@pytest.mark.real
async def test_one_socket_serves_several_peers() -> None:
    vehicle = await open_udp("127.0.0.1", 0)
    agent, station = await open_udp("127.0.0.1", 0), await open_udp("127.0.0.1", 0)
    at_agent, at_station = Inbox(agent), Inbox(station)
    try:
        vehicle.send(b"for the agent", agent.address)
        vehicle.send(b"for the station", station.address)
        assert (await at_agent.until(1))[0][0] == b"for the agent"
        assert (await at_station.until(1))[0][0] == b"for the station"
    finally:
        for link in (vehicle, agent, station):
            link.close()


@pytest.mark.real
async def test_a_peer_that_is_not_there_is_counted_not_raised() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    link = await open_link(f"udpout://127.0.0.1:{port}")
    try:
        async with asyncio.timeout(patience(5.0)):
            while not link.counters().get("refused"):
                link.send(b"anybody?")
                await asyncio.sleep(0.01)
        link.send(b"x" * 70_000)  # more than a datagram holds
        await asyncio.sleep(0)
        assert link.counters()["error"] == 1
    finally:
        link.close()


@pytest.mark.real
async def test_what_the_kernel_had_no_room_for_is_counted() -> None:
    link = await open_udp("127.0.0.1", 0)
    inbox = Inbox(link)
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as flood:
            for _ in range(8000):  # while the loop does not turn
                flood.sendto(bytes(1400), link.address)
        await until(lambda: inbox.got)
        await asyncio.sleep(0.2)
        counts = link.counters()
        assert counts["received"] == len(inbox.got) < 8000
        assert counts["received"] + counts["overrun"] == 8000
    finally:
        link.close()
    assert "overrun" not in link.counters()


@pytest.mark.real
async def test_a_flood_leaves_the_loop_its_turns() -> None:
    link = await open_udp("127.0.0.1", 0)
    took: list[int] = []

    def take(data: bytes, peer: Hashable) -> None:
        took.append(len(data))

    link.receive(take)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as flood:
        for _ in range(600):
            flood.sendto(b"x", link.address)
    turns = []
    while len(took) < 600:
        before = len(took)
        await asyncio.sleep(0)
        turns.append(len(took) - before)
    link.close()
    assert max(turns) <= BATCH


@pytest.mark.real
async def test_a_port_in_use_is_one_clear_line() -> None:
    first = await open_link("udp://127.0.0.1:0")
    assert isinstance(first, UdpLink)
    try:
        url = f"udpin://127.0.0.1:{first.address[1]}"
        with pytest.raises(ConfigError, match=rf"^link: {url}: port in use by another program$"):
            await open_link(url)
    finally:
        first.close()


@pytest.mark.parametrize(
    ("url", "line"),
    [
        ("tcp://127.0.0.1:1", r"link: tcpout://127\.0\.0\.1:1: nobody listens there"),
        ("udpin://127.0.0.1", r"expected udpin:HOST:PORT"),
        ("udpin://127.0.0.1:99999", r"found port 99999, expected 1 to 65535"),
        ("udpout://127.0.0.1:0", r"found port 0, expected"),
        ("udpin://192.0.2.1:14550", r"no such address on this machine \(to send there: udpout"),
        ("serial:///dev/no-such-port:57600", r"no such device /dev/no-such-port"),
        ("serial:///dev/null:57600", r"/dev/null"),
        ("", r"found '', expected"),
    ],
)
async def test_a_wrong_url_is_one_clear_line(url: str, line: str) -> None:
    with pytest.raises(ConfigError, match=line) as caught:
        await open_link(url)
    assert "\n" not in str(caught.value)


@pytest.mark.real
@pytest.mark.parametrize("host", ["127.0.0.1", "[::1]"])
async def test_tcp_carries_both_ways_and_connects_again(host: str) -> None:
    server = await open_link(f"tcpin:{host}:0")
    assert isinstance(server, TcpServerLink)
    port = server.address[1]
    client = await open_link(f"tcp:{host}:{port}")
    there, here = Inbox(server), Inbox(client)
    try:
        client.send(b"ask")
        await until(lambda: there.got)
        server.send(b"answer")  # to whom it last heard
        await until(lambda: here.got)
        assert (there.got[0][0], here.got[0][0]) == (b"ask", b"answer")
        server.close()
        await until(lambda: client.counters().get("disconnected"))
        client.send(b"into the void")
        assert client.counters()["unconnected"] == 1
        again = await open_link(f"tcpin:{host}:{port}")
        back = Inbox(again)
        await until(lambda: client.counters().get("reconnected"))
        client.send(b"there again")
        await until(lambda: back.got)
        again.close()
    finally:
        client.close()
        server.close()


@pytest.mark.real
async def test_a_tcp_reader_that_does_not_read_loses_whole_messages_and_holds_up_nobody() -> None:
    server = await open_link("tcpin:127.0.0.1:0")
    assert isinstance(server, TcpServerLink)
    with socket.create_connection(server.address) as reader:
        reader.send(b"here I am")
        inbox = Inbox(server)
        await until(lambda: inbox.got)
        message = b"m" * 1000
        for _ in range(20000):
            server.send(message)
        counts = server.counters()
        assert counts["overflow"] > 0
        assert counts["sent"] + counts["overflow"] == 20000
        reader.settimeout(patience(5.0))
        heard = await asyncio.to_thread(_drained, reader, counts["sent"] * 1000)
        assert heard == message * counts["sent"]
    server.close()


def _drained(reader: socket.socket, size: int) -> bytes:
    heard = bytearray()
    while len(heard) < size:
        heard += reader.recv(1 << 20)
    return bytes(heard)


@pytest.mark.real
async def test_a_server_turns_away_more_clients_than_it_can_have() -> None:
    server = await open_link("tcpin:127.0.0.1:0")
    assert isinstance(server, TcpServerLink)
    clients = [socket.create_connection(server.address) for _ in range(CLIENTS_MAX + 2)]
    try:
        await until(lambda: server.counters().get("turned_away") == 2)
    finally:
        for client in clients:
            client.close()
        server.close()


@pytest.mark.real
@pytest.mark.parametrize("url", ["udpin:[::1]:0", "udpin://[::1]:0", "udpin:localhost:0"])
async def test_udp_speaks_ipv6_and_names(url: str) -> None:
    server = await open_link(url)
    assert isinstance(server, UdpLink)
    host, port = server.address
    client = await open_link(f"udpout:[{host}]:{port}" if ":" in host else f"udpout:{host}:{port}")
    there, here = Inbox(server), Inbox(client)
    try:
        client.send(b"ask")
        await until(lambda: there.got)
        server.send(b"answer", there.got[0][1])
        await until(lambda: here.got)
        assert here.got[0][0] == b"answer"
    finally:
        client.close()
        server.close()


@pytest.mark.real
async def test_a_serial_port_carries_both_ways_and_reports_the_cable_pulled() -> None:
    master, slave = pty.openpty()
    device = os.ttyname(slave)
    os.set_blocking(master, False)
    link = await open_link(f"serial://{device}:57600")
    inbox = Inbox(link)
    try:
        os.write(master, bytes(range(256)))
        await until(lambda: sum(len(data) for data, _ in inbox.got) >= 256)
        assert b"".join(data for data, _ in inbox.got) == bytes(range(256))
        link.send(b"\x00\x0a\x0d\x11\x13\xff")  # nothing may be translated on its way
        heard = b""
        async with asyncio.timeout(patience(5.0)):
            while len(heard) < 6:
                await asyncio.sleep(0.005)
                heard += _read(master)
        assert heard == b"\x00\x0a\x0d\x11\x13\xff"
        os.close(master)
        os.close(slave)
        await until(lambda: link.counters().get("unplugged"))
        link.send(b"into the void")
        assert link.counters()["unplugged_drop"] == 1
    finally:
        link.close()


@pytest.mark.real
async def test_a_serial_port_that_does_not_drain_drops_whole_messages() -> None:
    master, slave = pty.openpty()
    os.set_blocking(master, False)
    link = await open_link(f"serial://{os.ttyname(slave)}:57600")
    try:
        message = b"m" * 1000
        for _ in range(200):
            link.send(message)
        counts = link.counters()
        assert counts["overflow"] > 0
        assert counts["sent"] + counts["overflow"] == 200
        heard = b""
        async with asyncio.timeout(patience(5.0)):
            while len(heard) < counts["sent"] * 1000:
                heard += _read(master)
                await asyncio.sleep(0)
        assert heard == message * counts["sent"]
        assert counts["sent"] * 1000 >= BACKLOG_MAX - 1000
    finally:
        link.close()
        os.close(master)
        os.close(slave)


def _read(fd: int) -> bytes:
    try:
        return os.read(fd, 65536)
    except BlockingIOError:
        return b""


@pytest.mark.real
@pytest.mark.parametrize("url", ["udpout://field.example:14550", "serial:///dev/hangs:57600"])
async def test_a_resolver_or_a_driver_that_hangs_holds_up_neither_loop_nor_end(
    url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = threading.Event()

    def hang(*_: object, **__: object) -> None:
        answers.wait(60.0)
        raise OSError("too late")

    monkeypatch.setattr(socket, "getaddrinfo", hang)
    monkeypatch.setattr(SerialLink, "_opened", hang)
    turns = 0

    async def turn() -> None:
        nonlocal turns
        while True:
            await asyncio.sleep(0.005)
            turns += 1

    turning = asyncio.create_task(turn())
    with pytest.raises(ConfigError, match=r"within 0\.5 s"):
        await open_link(url, timeout_s=0.5)
    turning.cancel()
    answers.set()
    assert turns > 10
