"""Track filter: a constant-velocity Kalman filter over what a sensor really delivers.

Samples may be irregular, late, noisy, duplicated or out of order. The three axes of the game
frame are independent (a track's covariance is a diagonal), each with position and velocity as
its state and white acceleration as its process noise. The strength of that noise follows the
innovations: it rises while they are larger than the filter believes and falls while they are
smaller. A late sample is put where it belongs and the samples after it are replayed.

Nothing here raises on bad input: `add` says what became of a sample.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import Counter
from enum import IntEnum
from math import isfinite, sqrt
from typing import NamedTuple

from onboard.core.math.constants import NEVER
from onboard.core.math.each import new
from onboard.core.math.vectors import ZERO, Vec, along, distance, norm, scale
from onboard.pilot.kalman import Axes, Axis, Learning, Measured, Variance, carry, corrected

BOUND = 1e12  # no number of a sample is larger; NaN fails the comparison too


class Fate(IntEnum):
    """What became of a sample."""

    TAKEN = 0
    LATE = 1  # taken, and the samples after it replayed
    RESTARTED = 2  # several doubtful samples agreed with each other: the filter began anew with them
    DUPLICATE = 3  # refused: known already
    STALE = 4  # refused: older than the history kept
    JUMP = 5  # refused: farther away, or later, than the target can be
    NOT_FINITE = 6  # refused: NaN, infinite, beyond all bounds or with a negative variance
    REPEATED = 7  # refused: the last place under a new stamp, of a target that moves: nothing was measured


class Estimate(NamedTuple):
    """The track at one instant."""

    t: float  # [s]
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground, NED]
    sigma: float  # root mean square distance error of the position [m]
    sigma_velocity: float  # the same of the velocity [m/s]


class FilterSettings(NamedTuple):
    """Settings of a track filter."""

    density: float = 4.0  # white acceleration to begin with [m²/s³]
    density_min: float = 0.01
    density_max: float = 2000.0
    adaptation: float = 0.08  # how fast the density follows the innovations (per sample, logarithmic)
    history: float = 5.0  # samples this much older than the newest are kept for late ones [s]
    history_max: int = 400  # but no more of them
    speed_max: float = 150.0  # no target is faster [m/s]
    gap_max: float = 10.0  # a longer silence needs the samples after it to agree [s]
    resting: float = 0.1  # way within which a place may repeat itself to the last digit [m]
    agreeing: int = 3  # doubtful samples in a row that must agree before the filter restarts
    sigma_min: float = 0.01  # floor of a stated position error [m] and velocity error [m/s]
    velocity_unknown: float = 30.0  # velocity error before any was measured [m/s]


class _Sample(NamedTuple):
    t: float
    position: Vec
    velocity: Vec
    variance: Variance  # velocity entries < 0: not measured


class _Step(NamedTuple):
    """The filter after one sample."""

    sample: _Sample
    axes: Axes
    density: float  # [m²/s³]


class TrackFilter:
    """Filters one track.

    `estimate(t)` gives the track at any instant: between samples of the history interpolated from
    both sides, after the newest one carried forward at constant velocity with growing error.
    """

    def __init__(self, settings: FilterSettings | None = None) -> None:
        self.settings = FilterSettings() if settings is None else settings
        self.fates: Counter[Fate] = Counter()
        low, high, rate = self.settings.density_min, self.settings.density_max, self.settings.adaptation
        self._learning = Learning(low, high, rate)
        self._steps: list[_Step] = []
        self._doubts: list[_Sample] = []

    @property
    def empty(self) -> bool:
        """Whether no sample was ever taken."""
        return not self._steps

    @property
    def newest(self) -> float:
        """Instant of the newest sample taken [s]; −inf before the first."""
        return self._steps[-1].sample.t if self._steps else NEVER

    @property
    def oldest(self) -> float:
        """Instant of the oldest sample of the history [s]; +inf before the first."""
        return self._steps[0].sample.t if self._steps else float("inf")

    def before(self, t: float) -> float:
        """Instant of the newest sample before `t` [s]; −inf where the history has none."""
        index = bisect_left(self._steps, t, key=_instant) - 1
        return self._steps[index].sample.t if index >= 0 else NEVER

    @property
    def count(self) -> int:
        """Samples in the history."""
        return len(self._steps)

    @property
    def velocity_known(self) -> bool:
        """Whether the newest sample came with a measured velocity."""
        return bool(self._steps) and self._steps[-1].sample.variance[3] >= 0.0

    def add(self, t: float, position: Vec, velocity: Vec | None, variance: Variance) -> Fate:
        """Take a sample: instant [s], position [m; NED], velocity [m/s; ground] or None, error variances.

        A velocity with a negative variance counts as not measured. Variances of zero are raised to
        the floor of the settings."""
        fate = self._add(t, position, velocity, variance)
        self.fates[fate] += 1
        return fate

    def estimate(self, t: float) -> Estimate:
        """The track at instant `t` [s]. With no sample: position zero, infinite error."""
        steps = self._steps
        if not steps or not isfinite(t):
            return Estimate(t, ZERO, ZERO, float("inf"), float("inf"))
        if t >= steps[-1].sample.t:
            step = steps[-1]
            dt = t - step.sample.t
            return _carried(t, step.axes, dt, step.density)
        if t <= steps[0].sample.t:
            step = steps[0]
            return _estimate(t, _carry_back(step.axes, step.sample.t - t, step.density))
        index = self._index_before(t)
        return _between(steps[index], steps[index + 1], t)

    def measured(self, t: float) -> Vec:
        """Where the samples themselves say the target was at instant `t` [s], by a straight line between the
        two about it; beyond them the nearest. With no sample: zero."""
        steps = self._steps
        if not steps:
            return ZERO
        index = self._index_before(t)
        if index < 0 or index == len(steps) - 1:
            return steps[max(index, 0)].sample.position
        before, after = steps[index].sample, steps[index + 1].sample
        share = (t - before.t) / (after.t - before.t) if after.t > before.t else 0.0
        return along(scale(before.position, 1.0 - share), after.position, share)

    def _add(self, t: float, position: Vec, velocity: Vec | None, variance: Variance) -> Fate:
        for number in (t, *position, *variance, *(velocity or ())):
            if not -BOUND < number < BOUND:
                return Fate.NOT_FINITE
        if variance[0] < 0.0 or variance[1] < 0.0 or variance[2] < 0.0:
            return Fate.NOT_FINITE
        place = Vec(*map(float, position))
        speed = ZERO if velocity is None else Vec(*map(float, velocity))
        sample = _Sample(float(t), place, speed, self._floored(variance, velocity is not None))
        steps = self._steps
        if not steps:
            self._restart([sample])
            return Fate.TAKEN
        index = self._index_before(t)
        for step in steps[max(0, index - 3) : index + 2]:
            if _same(step.sample, sample):
                return Fate.DUPLICATE
        if index < 0:
            return self._doubt(sample, Fate.STALE)
        if self._repeated(index, sample):
            return Fate.REPEATED
        if not self._plausible(steps[index], sample):
            return self._doubt(sample, Fate.JUMP)
        self._doubts.clear()
        late = [step.sample for step in steps[index + 1 :]]
        del steps[index + 1 :]
        settings = self.settings
        for one in (sample, *late):
            steps.append(self._update(steps[-1], one))
        keep = steps[-1].sample.t - settings.history
        drop = max(0, len(steps) - settings.history_max)
        while drop < len(steps) - 1 and steps[drop].sample.t < keep:
            drop += 1
        del steps[:drop]
        return Fate.LATE if late else Fate.TAKEN

    def _floored(self, variance: Variance, with_velocity: bool) -> Variance:
        low = self.settings.sigma_min * self.settings.sigma_min
        if with_velocity and min(variance) >= low:
            return variance
        n, e, d, vn, ve, vd = variance
        if not with_velocity or min(vn, ve, vd) < 0.0:
            return (max(n, low), max(e, low), max(d, low), -1.0, -1.0, -1.0)
        return (max(n, low), max(e, low), max(d, low), max(vn, low), max(ve, low), max(vd, low))

    def _index_before(self, t: float) -> int:
        """Index of the newest step at or before `t`, −1 where there is none."""
        if self._steps and t >= self._steps[-1].sample.t:  # nearly always
            return len(self._steps) - 1
        return bisect_right(self._steps, t, key=_instant) - 1

    def _plausible(self, step: _Step, sample: _Sample) -> bool:
        """Whether the target can have come from `step` to `sample`."""
        dt = sample.t - step.sample.t
        if dt > self.settings.gap_max:
            return False
        here = _carried(sample.t, step.axes, dt, step.density)
        north, east, down, *_ = sample.variance
        noise = sqrt(north + east + down)
        reach = self.settings.speed_max * dt + 6.0 * (noise + min(here.sigma, self.settings.speed_max)) + 10.0
        return distance(here.position, sample.position) <= reach

    def _repeated(self, index: int, sample: _Sample) -> bool:
        """Whether `sample` tells again where the target was at an earlier step, while it moves.

        A receiver that hears nothing reports its last fix; two measurements are equal to the last digit only
        at rest."""
        step = self._steps[index]
        if step.sample.position != sample.position:
            return False
        while index > 0 and self._steps[index - 1].sample.position == sample.position:
            index -= 1
        since = sample.t - self._steps[index].sample.t
        if since > self.settings.gap_max:
            return False
        if sample.variance[3] >= 0.0:
            return norm(sample.velocity) * since > self.settings.resting
        here = _estimate(step.sample.t, step.axes)
        speed = norm(here.velocity)
        return speed > 2.0 * here.sigma_velocity and speed * since > self.settings.resting

    def _doubt(self, sample: _Sample, fate: Fate) -> Fate:
        """Keep a sample that does not fit; begin anew once enough of them fit each other."""
        doubts = self._doubts
        if doubts:
            last = doubts[-1]
            dt = sample.t - last.t
            noise = sqrt(sum(sample.variance[:3]) + sum(last.variance[:3]))
            reach = self.settings.speed_max * dt + 6.0 * noise + 10.0
            if _same(last, sample):
                return Fate.DUPLICATE
            if not (0.0 < dt <= self.settings.gap_max) or distance(last.position, sample.position) > reach:
                doubts.clear()
        doubts.append(sample)
        if len(doubts) < self.settings.agreeing:
            return fate
        self._restart(doubts)
        return Fate.RESTARTED

    def _restart(self, samples: list[_Sample]) -> None:
        self._steps = [self._first(samples[0])]
        for sample in samples[1:]:
            self._steps.append(self._update(self._steps[-1], sample))
        self._doubts = []

    def _first(self, sample: _Sample) -> _Step:
        unknown = self.settings.velocity_unknown * self.settings.velocity_unknown
        axes = []
        for i in range(3):
            measured = sample.variance[3 + i] >= 0.0
            vv = sample.variance[3 + i] if measured else unknown
            axes.append(Axis(sample.position[i], sample.velocity[i] if measured else 0.0,
                             sample.variance[i], 0.0, vv))
        return _Step(sample, (axes[0], axes[1], axes[2]), self.settings.density)

    def _update(self, step: _Step, sample: _Sample) -> _Step:
        """Carry to the sample's instant and correct; (x, v) are measured one after the other."""
        measured = Measured(sample.position, sample.velocity, sample.variance)
        dt = sample.t - step.sample.t
        found = corrected(carry(step.axes, dt, step.density), step.density, measured, self._learning)
        return _Step(sample, found.axes, found.density)


def _instant(step: _Step) -> float:
    return step.sample.t


def _same(a: _Sample, b: _Sample) -> bool:
    return abs(a.t - b.t) < 1e-6 and a.position == b.position


def _carry_back(axes: Axes, dt: float, density: float) -> Axes:
    """The axes `dt` seconds earlier (before the history): as uncertain as the same time later."""
    turned = [Axis(a.x, -a.v, a.xx, -a.xv, a.vv) for a in axes]
    a, b, c = carry((turned[0], turned[1], turned[2]), dt, density)
    return (a._replace(v=-a.v, xv=-a.xv), b._replace(v=-b.v, xv=-b.xv), c._replace(v=-c.v, xv=-c.xv))


def _between(before: _Step, after: _Step, t: float) -> Estimate:
    """Cubic (Hermite) interpolation between two steps of the history."""
    dt = after.sample.t - before.sample.t
    if dt <= 0.0:
        return _estimate(t, after.axes)
    u = (t - before.sample.t) / dt
    a, b = _estimate(t, before.axes), _estimate(t, after.axes)
    h1, h2, h3 = u * u * (3.0 - 2.0 * u), u * (1.0 - u) * (1.0 - u) * dt, -u * u * (1.0 - u) * dt
    position = along(along(along(ZERO, a.position, 1.0 - h1), b.position, h1), a.velocity, h2)
    position = along(position, b.velocity, h3)
    velocity = along(along(ZERO, a.velocity, 1.0 - u), b.velocity, u)
    return Estimate(t, position, velocity, max(a.sigma, b.sigma), max(a.sigma_velocity, b.sigma_velocity))


def _carried(t: float, axes: Axes, dt: float, density: float) -> Estimate:
    """`_estimate` at `t` [s] of what `carry` makes of the axes `dt` seconds later, without the covariances
    that nobody asks for."""
    (ax, av, axx, axv, avv), (bx, bv, bxx, bxv, bvv), (cx, cv, cxx, cxv, cvv) = axes
    third, more = density * dt / 3.0, density * dt
    axx = axx + dt * (2.0 * axv + dt * (avv + third))
    bxx = bxx + dt * (2.0 * bxv + dt * (bvv + third))
    cxx = cxx + dt * (2.0 * cxv + dt * (cvv + third))
    place, velocity = new(Vec, (ax + dt * av, bx + dt * bv, cx + dt * cv)), new(Vec, (av, bv, cv))
    sigma = sqrt(max(0.0, axx + bxx + cxx))
    sigma_velocity = sqrt(max(0.0, (avv + more) + (bvv + more) + (cvv + more)))
    estimate = new(Estimate, (t, place, velocity, sigma, sigma_velocity))
    return estimate


def _estimate(t: float, axes: Axes) -> Estimate:
    a, b, c = axes
    return Estimate(
        t,
        Vec(a.x, b.x, c.x),
        Vec(a.v, b.v, c.v),
        sqrt(max(0.0, a.xx + b.xx + c.xx)),
        sqrt(max(0.0, a.vv + b.vv + c.vv)),
    )
