"""`gcs sign`: which key an autopilot on a link signs with, and a new one set.

It sends no heartbeat: a station that begins to beat and stops would set off a failsafe.
"""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Hashable, Iterable
from hashlib import sha256
from pathlib import Path

from onboard.config.strict import ConfigError
from onboard.runtime.clock import RealClock
from onboard.runtime.link_urls import Form, parse_link
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Link
from onboard.runtime.signing_keys import read_key
from onboard.wire.mavlink.commands import SetupSigning, Target
from onboard.wire.mavlink.frames import Packet, PeerFramers, Sender, marked_signed
from onboard.wire.mavlink.signing import MemoryStore, SignatureCheck, Signing, ticks
from onboard.wire.mavlink.values import Heartbeat

LISTEN_S = 4.0  # for heartbeats, and for frames that bear the new key
REPEATS = 3  # of the key, which no autopilot acknowledges
STATION, COMPONENT = 254, 190  # as whom it speaks


class Signer:
    """What one autopilot of a link says, and which key it says it with."""

    def __init__(self, system: int) -> None:
        self.system = system
        self.kind = ""
        self.armed = False
        self.frames: list[bytes] = []  # its last ones
        self.peer: Hashable = None

    def hears(self, packet: Packet, peer: Hashable) -> None:
        """Take a frame of it."""
        self.peer = peer
        self.frames = [*self.frames[-9:], packet.raw]
        if isinstance(packet.value, Heartbeat):
            self.kind, self.armed = packet.value.kind.value, packet.value.armed

    def key(self, keys: Iterable[tuple[str, bytes]], wall_ns: int) -> str:
        """The name of the key that its last frame bears: "" for none of these, "unsigned" for none at all."""
        frame = self.frames[-1]
        if not marked_signed(frame):
            return "unsigned"
        for name, key in keys:
            found = Signing(key, MemoryStore()).verify(frame, True, self.system, 1, wall_ns)
            if found is not SignatureCheck.WRONG:
                return name
        return ""


def known_keys(places: Iterable[Path]) -> list[tuple[str, bytes]]:
    """(name, key) of files, and of every `mavlink.key` below folders. Raises ConfigError."""
    found = []
    for place in places:
        files = sorted(place.glob("**/mavlink.key")) if place.is_dir() else [place]
        if not files:
            raise ConfigError(f"{place}: found no mavlink.key, expected the folder of gcs keys init")
        found += [(str(file), read_key(file)) for file in files]
    return found


async def sign(url: str, keys: list[Path], new: Path | None, system: int, sure: bool) -> int:
    """List who signs with what on a link; with `new` set that key on `system` (0: the only one).

    Exit code 1 where nobody is heard, or the autopilot does not sign with the new key. Raises ConfigError.
    """
    known = known_keys([*keys, *([] if new is None else [new])])
    loopback = any(host in url for host in ("127.0.0.1", "localhost", "[::1]"))
    local = loopback or parse_link(url).form is Form.SERIAL
    if new is not None and not (local or sure):
        raise ConfigError(
            f"{url}: found a link over a network, expected serial or USB: the key would be readable on its "
            "way (--yes sends it all the same)"
        )
    link = await open_link(url)
    try:
        heard = await _listen(link)
        for one in heard.values():
            print(_line(one, known))
        if not heard:
            print(f"gcs: no autopilot heard on {url} within {LISTEN_S:g} s", file=sys.stderr)
            return 1
        if new is None:
            return 0
        return await _set(link, heard, new, system)
    finally:
        link.close()


async def _set(link: Link, heard: dict[int, Signer], new: Path, system: int) -> int:
    if system == 0 and len(heard) > 1:
        raise ConfigError(f"--system: found {', '.join(map(str, sorted(heard)))}, expected which of them")
    target = heard.get(system or next(iter(heard)))
    if target is None:
        raise ConfigError(f"--system: found {system}, expected one of {', '.join(map(str, sorted(heard)))}")
    if target.armed:
        raise ConfigError(f"system {target.system}: found it armed, expected it disarmed, on the ground")
    key = read_key(new)
    clock, sender = RealClock(), Sender(STATION, COMPONENT)
    message = SetupSigning(Target(target.system, 1), key, ticks(clock.wall_ns()))
    for _ in range(REPEATS):
        link.send(sender.pack(message), target.peer)
        await asyncio.sleep(0.1)
    again = (await _listen(link)).get(target.system)
    done = again is not None and again.key([(str(new), key)], clock.wall_ns()) == str(new)
    if done:
        print(f"system {target.system} signs with {new} ({fingerprint(key)}) now")
        return 0
    said = f"gcs: system {target.system} does not sign with {new}: it may refuse keys on this link"
    print(said, file=sys.stderr)
    return 1


async def _listen(link: Link) -> dict[int, Signer]:
    """The autopilots that are heard within LISTEN_S."""
    framers, found = PeerFramers(), dict[int, Signer]()

    def arrived(data: bytes, peer: Hashable) -> None:
        for packet in framers.feed(peer, data):
            if packet.component != 1:
                continue
            if packet.system not in found and not isinstance(packet.value, Heartbeat):
                continue  # known by its heartbeat
            if len(found) < 250 or packet.system in found:
                found.setdefault(packet.system, Signer(packet.system)).hears(packet, peer)

    link.receive(arrived)
    await asyncio.sleep(LISTEN_S)
    return found


def _line(one: Signer, known: list[tuple[str, bytes]]) -> str:
    name = one.key(known, RealClock().wall_ns())
    if name == "unsigned":
        return f"system {one.system} ({one.kind}): unsigned"
    if not name:
        tried = f"none of {len(known)} keys tried" if known else "give --keys FOLDER to find with which"
        return f"system {one.system} ({one.kind}): signed, {tried}"
    return f"system {one.system} ({one.kind}): signed with {name} ({fingerprint(dict(known)[name])})"


def fingerprint(key: bytes) -> str:
    """Eight digits by which people compare keys, as `gcs keys show` prints them."""
    return sha256(key).hexdigest()[:8]
