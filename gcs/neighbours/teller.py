"""Tells other programs of the field once a second what a session sees: by MAVLink, by Cursor-on-Target."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import AsyncExitStack
from urllib.parse import urlsplit

from gcs.neighbours.traffic import adsb, cot
from gcs.picture.values import Picture, Presence
from gcs.settings import NeighbourSettings
from onboard.config.strict import ConfigError
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Link
from onboard.wire.mavlink.commands import AdsbHeartbeat
from onboard.wire.mavlink.frames import Sender
from onboard.wire.mavlink.ids import ADSB

EACH_S = 1.0
NOBODY = 254  # system id of reports while no own vehicle is known
VEHICLES_MOST = 32  # in whose name one second's reports are sent


class Teller:
    """Sends the tracks of a picture to links and a CoT address; `run` it as a task.

    By MAVLink they come from an ADS-B receiver aboard each own vehicle (its system id, component 156): ground
    stations show traffic only of the vehicle that they look at.
    """

    def __init__(self, picture: Callable[[], Picture], links: Sequence[Link], cot: Link | None) -> None:
        self._picture = picture
        self._links = links
        self._cot = cot
        self._senders: dict[int, Sender] = {}

    async def run(self) -> None:
        """Tell, once a second, until cancelled."""
        while True:
            self.tell()
            await asyncio.sleep(EACH_S)

    def tell(self) -> None:
        """Send what is known now."""
        picture = self._picture()
        for sender in self._aboard(picture) if self._links else ():
            frames = [sender.pack(AdsbHeartbeat())]
            frames += [sender.pack(report) for report in adsb(picture)]
            for link in self._links:
                for frame in frames:
                    link.send(frame)
        if self._cot is not None:
            for event in cot(picture):
                self._cot.send(event)


    def _aboard(self, picture: Picture) -> list[Sender]:
        """The senders of this second: one for each own vehicle that is there and is not itself a track."""
        tracked = {track.id for track in picture.tracks}
        there = [v.id for v in picture.vehicles if v.presence is Presence.PRESENT and v.id not in tracked]
        ids = there[:VEHICLES_MOST] or [NOBODY]
        return [self._senders.setdefault(id, Sender(id, ADSB)) for id in ids]


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
