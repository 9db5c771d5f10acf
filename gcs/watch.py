"""The whole picture from one stream: fleet, alerts and commands, evaluated on a fixed grid of time.

Alerts are judged at every multiple of 0.1 s of the station's time, and a judgement at T sees exactly the
messages that came before T, no matter when anybody asks: so a replay of the recorded stream
(key, payload, now_ns) gives the live run's picture, alert for alert.
"""

from __future__ import annotations

from gcs.fleet import NS, Fleet
from gcs.picture import Picture
from onboard.wire.swarm import Message

GRID_NS = NS // 10


class Watch:
    """Feed it with `apply` in order of arrival and `tick` as time passes; look with `picture`."""

    def __init__(self, game: str) -> None:
        self.fleet = Fleet(game)
        self._next_ns = 0

    def apply(self, key: str, payload: bytes, now_ns: int) -> Message | None:
        """Take in one message of the bus or of the journal; the decoded message, None for a bad one."""
        self.tick(now_ns)
        return self.fleet.apply(key, payload, now_ns)

    def tick(self, now_ns: int) -> None:
        """Let time pass to `now_ns`."""
        if self._next_ns == 0:
            self._next_ns = -(-now_ns // GRID_NS) * GRID_NS
        while self._next_ns <= now_ns:
            self._next_ns += GRID_NS

    def picture(self, now_ns: int) -> Picture:
        """The picture now."""
        self.tick(now_ns)
        return Picture(
            now_ns=now_ns,
            game=self.fleet.game(now_ns),
            vehicles=self.fleet.vehicles(now_ns),
            tracks=self.fleet.tracks(now_ns),
            log=tuple(self.fleet.log),
            dropped=tuple(sorted(self.fleet.drops.items())),
            received=self.fleet.received,
        )
