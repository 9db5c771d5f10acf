"""Two links to one autopilot: which to listen to, which to speak on, and nothing heard twice.

An autopilot numbers its frames for each of its ports apart, and a router repeats the same frames on
several links. So telemetry counts from one link at a time, the active one; another takes over when that is
silent for longer than `LOSS`. What is not telemetry (answers, texts, parameters) counts from whichever link
brings it first. Setpoints go to the active link, commands and our heartbeat to all.
"""

from __future__ import annotations

from collections import OrderedDict
from typing import NamedTuple

from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.frames import Packet

LOSS = 0.25  # [s] of silence at 20 Hz telemetry: half of the age at which telemetry counts as lost
BACK = 5.0  # [s] the preferred link must be steady before it is active again
STEADY = 0.5  # [s] the longest gap of a steady link
MEMORY = 512  # frames remembered
TWICE = 2.0  # [s] within which equal content is the same frame
ONCE = frozenset(
    ("COMMAND_ACK", "STATUSTEXT", "PARAM_VALUE", "AUTOPILOT_VERSION", "HOME_POSITION", "TIMESYNC")
)


class Heard(NamedTuple):
    """What to do with a packet."""

    use: bool  # whether it counts; False: it was heard before, or came over a link that does not count
    took_over: bool = False  # the active link changed with this packet


def _content(raw: bytes) -> bytes:
    """What a frame says (who, which message, payload), without its number, checksum and signature."""
    return raw[5 : 10 + raw[1]] if raw[0] == 0xFD else raw[3 : 6 + raw[1]]


class Redundant:
    """Which of several links counts; they are numbered from 0, the preferred one first."""

    def __init__(self, links: int) -> None:
        self.active = 0
        self._heard_at = [NEVER] * links
        self._steady_since = [NEVER] * links
        self._recent: OrderedDict[bytes, float] = OrderedDict()

    def take(self, now: float, link: int, packet: Packet) -> Heard:
        """Judge a packet of the autopilot that came over `link` at `now` [s, monotonic]."""
        if now - self._heard_at[link] > STEADY:
            self._steady_since[link] = now
        self._heard_at[link] = now
        before = self.active
        silent = now - self._heard_at[before] > LOSS
        preferred = link < before and now - self._steady_since[link] >= BACK
        if link != before and (silent or preferred):
            self.active = link
        took_over = self.active != before
        once = packet.name in ONCE
        if self._seen(now, _content(packet.raw) if once else packet.raw):
            return Heard(False, took_over)
        return Heard(once or link == self.active, took_over)

    def _seen(self, now: float, content: bytes) -> bool:
        at = self._recent.get(content, NEVER)
        self._recent[content] = now
        self._recent.move_to_end(content)
        if len(self._recent) > MEMORY:
            self._recent.popitem(last=False)
        return now - at < TWICE
