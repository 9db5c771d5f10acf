"""`gcs take-off`: brings the vehicles of a scenario up and to their places, one after the other."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Hashable

from gcs.rise import Place, Rise, Step
from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec
from onboard.game.scenario import Scenario
from onboard.game.staging import flown
from onboard.runtime.clock import RealClock
from onboard.runtime.links import open_link
from onboard.runtime.protocols import Clock
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.frames import PeerFramers, Sender

STATION, COMPONENT = 254, 190  # as whom it speaks
LOOK_S = 0.05
TELL_S = 5.0


def places_of(scenario: Scenario, ids: tuple[int, ...]) -> list[Place]:
    """Where the vehicles of these ids begin. Raises ConfigError for an id that the scenario does not have."""
    origin = scenario.flight.origin
    frame = Frame(origin.latitude_deg, origin.longitude_deg, origin.altitude_m)
    known = dict(zip(scenario.ids, scenario.vehicles, strict=True))
    found = []
    for id in ids:
        spec = known.get(id)
        if spec is None:
            raise ConfigError(f"--link: found vehicle {id}, expected one of {', '.join(map(str, known))}")
        place = flown(scenario, spec.start())
        if -place.z < 2.0:
            raise ConfigError(f"vehicle {id}: found a place {-place.z:g} m above the origin, expected 2 m")
        found.append(Place(id, Vec(*place), frame))
    return found


def links_of(pairs: tuple[str, ...]) -> dict[int, str]:
    """ID=URL pairs. Raises ConfigError."""
    found: dict[int, str] = {}
    for pair in pairs:
        id, _, url = pair.partition("=")
        if not url or not (id.isascii() and id.isdecimal()) or not 1 <= int(id) <= 250 or int(id) in found:
            raise ConfigError(
                f"--link: found '{pair}', expected ID=URL, each id once, e.g. 2=udpin://0.0.0.0:14551"
            )
        found[int(id)] = url
    return found


async def take_off(scenario: Scenario, links: dict[int, str], *, may_arm: bool, within_s: float) -> int:
    """Bring them up in the order of their ids; exit code 0 when every one is at its place.

    A vehicle that does not get there within `within_s` [s] ends it: the others stay on the ground.
    """
    clock = RealClock()
    for place in places_of(scenario, tuple(sorted(links))):
        rise = Rise(place, may_arm=may_arm)
        await _bring(rise, links[place.id], clock, within_s)
        told = f"vehicle {place.id}: {rise.step.value}: {rise.why}"
        if rise.step is not Step.THERE:
            print(f"gcs: {told}", file=sys.stderr)
            return 1
        print(told, flush=True)
    return 0


async def _bring(rise: Rise, url: str, clock: Clock, within_s: float) -> None:
    """Carry the bytes of one vehicle until it is there, left alone, or the time is up."""
    link = await open_link(url)
    framers, sender = PeerFramers(), Sender(STATION, COMPONENT)
    peer: Hashable = None

    def arrived(data: bytes, sender_of: Hashable) -> None:
        nonlocal peer
        for packet in framers.feed(sender_of, data):
            if packet.system == rise.place.id:
                peer = sender_of
            rise.take(packet, clock.monotonic_ns() / 1e9)

    link.receive(arrived)
    begun = told = clock.monotonic_ns() / 1e9
    try:
        while not rise.over and (now := clock.monotonic_ns() / 1e9) - begun < within_s:
            for message in rise.due(now):
                link.send(sender.pack(message), peer)
            if now - told >= TELL_S:
                told = now
                print(f"  vehicle {rise.place.id} {rise.step.value}: {rise.why}", file=sys.stderr, flush=True)
            await asyncio.sleep(LOOK_S)
    finally:
        link.close()
