"""The simulated sensor: tracks with noise, at a rate, late, and now and then none at all."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence

from onboard.core.math.constants import NS_PER_S
from onboard.game.scenario import SensorSpec
from onboard.wire.bus.messages import Track
from sim_bridge.draws import Purpose, Stream, key_of
from sim_bridge.vehicle.motion import Motion

NAME = "sim-bridge"
SENSOR_WORDS = 7  # random numbers a measurement: whether it is lost, then its six errors
UNDER_WAY_MAX = 1000  # measurements of one vehicle on their way before the oldest is lost


class Sensor:
    """Measures every vehicle; give it true motions each step and publish what it returns.

    What a measurement draws depends on seed, vehicle and the instant's number, counted from the first one
    (`sim_bridge.draws`): drop-outs and other vehicles do not change the noise of what is left, and the
    compiled games draw the same.
    """

    def __init__(self, spec: SensorSpec, ids: Sequence[int], seed: int) -> None:
        self._spec = spec
        self._period_ns = round(NS_PER_S / spec.rate_hz)
        self._delay_ns = round(spec.delay_s * NS_PER_S)
        self._streams = {id: Stream(key_of(seed, id, Purpose.SENSOR), SENSOR_WORDS, 1) for id in ids}
        self._first_ns = -1  # the first measurement's instant
        self._due_ns: dict[int, int] = {}
        self._under_way: deque[Track] = deque()
        self._most = UNDER_WAY_MAX * len(self._streams)
        p, v = spec.sigma**2, spec.sigma_velocity**2
        self._covariance = (p, p, p, v, v, v)
        self.blind = False  # while True every measurement is lost
        self.measured = 0
        self.dropped = 0

    def step(self, wall_ns: int, motions: Mapping[int, Motion]) -> list[Track]:
        """Measure whoever is due at `wall_ns`; give the tracks whose delay is over."""
        if self._first_ns < 0:
            self._first_ns = wall_ns
        for id, stream in self._streams.items():
            due = self._due_ns.setdefault(id, wall_ns)
            if wall_ns < due:
                continue
            missed = (wall_ns - due) // self._period_ns
            self._due_ns[id] = due + (missed + 1) * self._period_ns
            number = (wall_ns - self._first_ns) // self._period_ns
            self._measure(id, wall_ns, motions[id], stream.at(number))
        tracks: list[Track] = []
        while self._under_way and self._under_way[0].stamp_ns + self._delay_ns <= wall_ns:
            tracks.append(self._under_way.popleft())
        return tracks

    def _measure(self, id: int, wall_ns: int, motion: Motion, drawn: Sequence[float]) -> None:
        spec = self._spec
        chance, *noise = drawn
        lost = chance < spec.dropout or self.blind
        if lost:
            self.dropped += 1
            return
        self.measured += 1
        if len(self._under_way) >= self._most:
            self._under_way.popleft()
        p, v = motion.position, motion.velocity
        s, sv = spec.sigma, spec.sigma_velocity
        self._under_way.append(
            Track(
                id,
                wall_ns,
                (p.x + s * noise[0], p.y + s * noise[1], p.z + s * noise[2]),
                (v.x + sv * noise[3], v.y + sv * noise[4], v.z + sv * noise[5]),
                self._covariance,
                NAME,
            )
        )
