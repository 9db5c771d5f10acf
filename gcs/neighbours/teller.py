"""Tells other programs of the field once a second what a session sees: by MAVLink, by Cursor-on-Target."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import AsyncExitStack
from urllib.parse import urlsplit

from gcs.neighbours.traffic import adsb, cot
from gcs.picture.values import Picture
from gcs.settings import NeighbourSettings
from onboard.config.strict import ConfigError
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Link
from onboard.wire.mavlink.commands import AdsbHeartbeat
from onboard.wire.mavlink.frames import Sender
from onboard.wire.mavlink.ids import ADSB

EACH_S = 1.0
SYSTEM = 254  # of the reports: no vehicle's, and not a ground station's usual 255


class Teller:
    """Sends the tracks of a picture to links and a CoT address; `run` it as a task."""

    def __init__(self, picture: Callable[[], Picture], links: Sequence[Link], cot: Link | None) -> None:
        self._picture = picture
        self._links = links
        self._cot = cot
        self._sender = Sender(SYSTEM, ADSB)

    async def run(self) -> None:
        """Tell, once a second, until cancelled."""
        while True:
            self.tell()
            await asyncio.sleep(EACH_S)

    def tell(self) -> None:
        """Send what is known now."""
        picture = self._picture()
        if self._links:
            frames = [self._sender.pack(AdsbHeartbeat())]
            frames += [self._sender.pack(report) for report in adsb(picture)]
            for link in self._links:
                for frame in frames:
                    link.send(frame)
        if self._cot is not None:
            for event in cot(picture):
                self._cot.send(event)


async def teller(
    picture: Callable[[], Picture], settings: NeighbourSettings, stack: AsyncExitStack
) -> Teller | None:
    """What tells the neighbours that the settings name; None where they name none. Raises ConfigError."""
    links = []
    for url in settings.adsb:
        link = await open_link(url)
        stack.callback(link.close)
        links.append(link)
    address = None
    if settings.cot:
        address = await open_link(cot_link(settings.cot))
        stack.callback(address.close)
    return Teller(picture, links, address) if links or address else None


def cot_link(url: str) -> str:
    """The link of a CoT address, `udp://HOST:PORT` or `tcp://HOST:PORT`. Raises ConfigError."""
    parts = urlsplit(url)
    try:
        port = parts.port
    except ValueError:
        port = None
    if parts.scheme not in ("udp", "tcp") or not parts.hostname or not port or parts.path not in ("", "/"):
        expected = "udp://HOST:PORT or tcp://HOST:PORT, the address that is to be told"
        raise ConfigError(f"neighbours.cot: found {url!r}, expected {expected}")
    host = f"[{parts.hostname}]" if ":" in parts.hostname else parts.hostname
    return f"{'udpout' if parts.scheme == 'udp' else 'tcp'}:{host}:{port}"
