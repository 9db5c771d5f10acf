"""Whether an opponent's track is fresh and good enough to begin a game on: one judgement for all who ask."""

from __future__ import annotations

from math import sqrt

from onboard.core.math.constants import NS_PER_S
from onboard.core.safety.policy import Policy
from onboard.wire.bus.messages import Track

AGE_S = 3.0  # an older measurement is no track: sensors of the field report once in a second or two
AHEAD_S = 1.0  # a stamp farther ahead is a clock that is wrong
SIGMA = Policy().track_sigma  # worse than this nobody flies on it, either [m]
TRACKS_MAX = 256  # more than any roster


class TrackWatch:
    """The last measurement of each track, as its sensor states it."""

    def __init__(self) -> None:
        self._seen: dict[int, tuple[int, float]] = {}  # id → (instant [ns, wall], σ of the position [m])

    def heard(self, track: Track) -> None:
        """Take a measurement; an older one than the last changes nothing."""
        before = self._seen.get(track.id)
        if before is None and len(self._seen) >= TRACKS_MAX:
            return
        if before is None or track.stamp_ns > before[0]:
            self._seen[track.id] = (track.stamp_ns, sqrt(max(0.0, sum(track.covariance[:3]))))

    def lack(self, id: int, wall_ns: int) -> str:
        """What the track of `id` lacks at `wall_ns` [ns since the epoch], in words; "" if it is good."""
        seen = self._seen.get(id)
        if seen is None:
            return "no track heard"
        stamp_ns, sigma = seen
        age = (wall_ns - stamp_ns) / NS_PER_S
        if age < -AHEAD_S:
            return f"its track is stamped {-age:.0f} s ahead: compare the sensor's clock"
        if age > AGE_S:
            return f"its track is {age:.0f} s old"
        if not sigma <= SIGMA:
            return f"its track is good to {sigma:.0f} m only, expected at most {SIGMA:g} m"
        return ""
