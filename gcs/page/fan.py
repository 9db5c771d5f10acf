"""Where the evader will be: its track carried forward for the page, with how sure that is.

The same filters as onboard, fed with the tracks of the picture: the mean way is that of the manoeuvre filter
(straight on and a steady turn, weighed by how well each explains the track), height and spread are those of
the track filter. What an agent's network has learnt is the agent's own: its word on that is in the detail.
"""

from __future__ import annotations

import numpy as np

from gcs.picture.current import current_tracks
from gcs.picture.values import Picture
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.pilot.predictor.manoeuvre import ManoeuvreFilter
from onboard.pilot.track_filter import Fate, TrackFilter
from onboard.wire.bus.messages import Track

AHEAD_S = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)  # after the newest measurement
MARKS_S = (1.0, 2.0, 4.0)  # instants that are drawn as rings
GAP_S = 2.0  # a longer silence, and a way back, begin anew: a recording may jump
FANS_MOST = 4
Document = dict[str, object]


class Fan:
    """One track's fan."""

    def __init__(self) -> None:
        self._origin_ns = 0
        self._newest_ns: int | None = None
        self._filter = TrackFilter()
        self._turning = ManoeuvreFilter()

    def take(self, track: Track) -> None:
        """Take the newest measurement; the same again changes nothing."""
        if self._newest_ns == track.stamp_ns:
            return
        newest = self._newest_ns
        if newest is None or not 0 < track.stamp_ns - newest <= GAP_S * NS_PER_S:
            self._origin_ns = track.stamp_ns
            self._filter, self._turning = TrackFilter(), ManoeuvreFilter()
        self._newest_ns = track.stamp_ns
        t = (track.stamp_ns - self._origin_ns) / NS_PER_S
        sample = (t, Vec(*track.position), Vec(*track.velocity), track.covariance)
        if self._filter.add(*sample) in (Fate.TAKEN, Fate.RESTARTED):
            self._turning.add(*sample)

    def rows(self) -> list[list[float]]:
        """Rows of seconds after the newest measurement, north, east, down [m], and σ: the root mean square
        distance from there [m]. None where nothing can be said."""
        if self._filter.empty:
            return []
        newest = self._filter.newest
        flat = self._turning.places([ahead + (newest - self._turning.newest) for ahead in AHEAD_S])
        found = []
        for after, (north, east) in zip(AHEAD_S, flat, strict=True):
            straight = self._filter.estimate(newest + after)
            found.append([after, north, east, straight.position.z, straight.sigma])
        return found if np.isfinite(found).all() else []


class Fans:
    """The fans of the evaders' tracks."""

    def __init__(self) -> None:
        self._fans: dict[int, Fan] = {}

    def take(self, picture: Picture) -> None:
        """Follow the tracks that are fed: those of evaders, all where the setup is not known."""
        setup = picture.game.setup
        evaders = None if setup is None else set(picture.game.evaders)
        if evaders is not None and len(evaders) > 1:
            evaders -= {fate.id for fate in picture.game.fates if fate.out}
        wanted = [t.track for t in current_tracks(picture) if evaders is None or t.id in evaders][:FANS_MOST]
        self._fans = {track.id: self._fans.get(track.id) or Fan() for track in wanted}
        for track in wanted:
            self._fans[track.id].take(track)

    def document(self) -> Document:
        """For browsers."""
        fans = [{"id": id, "rows": rows} for id, fan in self._fans.items() if (rows := fan.rows())]
        return {"what": "fans", "marks": list(MARKS_S), "fans": fans}
