"""The simulated sensor: tracks with noise, at a rate, late, and now and then none at all."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from onboard.core.math.constants import NS_PER_S
from onboard.game.scenario import SensorSpec
from onboard.wire.bus.messages import Track
from sim_bridge.vehicle.motion import Motion

if TYPE_CHECKING:
    from numpy.random import Generator

NAME = "sim-bridge"
UNDER_WAY_MAX = 1000  # measurements of one vehicle on their way before the oldest is lost


class Sensor:
    """Measures every vehicle; give it true motions each step and publish what it returns.

    Every vehicle has a generator of its own, and every measurement takes as many random numbers as
    any other: so a drop-out rate does not change the noise of what is left.
    """

    def __init__(self, spec: SensorSpec, ids: Sequence[int], rng: Generator) -> None:
        self._spec = spec
        self._period_ns = round(NS_PER_S / spec.rate_hz)
        self._delay_ns = round(spec.delay_s * NS_PER_S)
        self._rngs = dict(zip(ids, rng.spawn(len(ids)), strict=True))
        self._due_ns: dict[int, int] = {}
        self._under_way: deque[Track] = deque()
        self._most = UNDER_WAY_MAX * len(self._rngs)
        p, v = spec.sigma**2, spec.sigma_velocity**2
        self._covariance = (p, p, p, v, v, v)
        self.blind = False  # while True every measurement is lost
        self.measured = 0
        self.dropped = 0

    def step(self, wall_ns: int, motions: Mapping[int, Motion]) -> list[Track]:
        """Measure whoever is due at `wall_ns`; give the tracks whose delay is over."""
        for id, rng in self._rngs.items():
            due = self._due_ns.setdefault(id, wall_ns)
            if wall_ns < due:
                continue
            missed = (wall_ns - due) // self._period_ns
            self._due_ns[id] = due + (missed + 1) * self._period_ns
            self._measure(id, wall_ns, motions[id], rng)
        tracks: list[Track] = []
        while self._under_way and self._under_way[0].stamp_ns + self._delay_ns <= wall_ns:
            tracks.append(self._under_way.popleft())
        return tracks

    def _measure(self, id: int, wall_ns: int, motion: Motion, rng: Generator) -> None:
        spec = self._spec
        lost = rng.random() < spec.dropout or self.blind
        noise = rng.standard_normal(6).tolist()
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
