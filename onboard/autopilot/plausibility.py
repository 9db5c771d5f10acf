"""One odd sample decides nothing: what a report must show before it counts.

A clock that falls back is a restart only with a second witness, a place that contradicts its velocity is not
flown on, and of reports that decide in flight the middle one of the last few speaks. Sans I/O.
"""

from __future__ import annotations

from collections import deque
from enum import Enum
from math import cos, hypot, radians

from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.values import EkfStatus, GlobalPosition

FALL = 3.0  # [s] by which a clock must fall back, or leap ahead, to be another one
QUIET = 1.0  # [s] of silence in which an autopilot may have started again
RUN, RAN = 3, 0.1  # stamps of another clock in a row, and [s] they must last, to show a restart
INSIST = 3.0  # [s] after which another clock counts though the silence before it was too short
LEAP_RATE = 10.0  # how much faster than ours a (simulated) clock may run
WRAP = 2**32 * 1e-3  # [s] where 32 bits of milliseconds begin again
STRANGERS, STRANGE_S = 10, (1.0, 3.0)  # odd stamps, and the [s] they span, that show two autopilots
STRANGE_GAP = 0.12  # [s] within which several odd stamps count once: at 40 a second ten span too little

JUMP = 10.0  # [m] between two samples that their velocities do not explain
JUMP_RATE = 5.0  # [m/s²] more for the time between them: half of the acceleration that may have been
GAP = 5.0  # [s] between two samples after which nothing is compared
WINDOW = 1.0  # [s] over which place and integrated velocity are compared at most
LEAST = 0.45  # … and at least: so long must a place stand still to be frozen
MOVED = 1.0  # [m] that velocity must have covered for a place to be frozen
STILL = 0.1  # share of it that a frozen place has moved at most
SETTLED = 3.0  # [s] of places that fit each other before they count again
METRES = 111_195.0  # in a degree of latitude

RECENT = 3  # reports of which the middle one speaks
RATIOS, RATIOS_S = 5, 2.0  # reports at least, and [s], of which most must reject a measurement


class Stamp(Enum):
    """What the stamp of a message says of the autopilot's clock."""

    GOOD = "good"
    ODD = "odd_stamp"  # of another clock, or far too old: the message does not count
    RESTART = "restart"  # the clock has begun again


class ClockWatch:
    """The clock of one autopilot, by the stamps of its messages."""

    def __init__(self) -> None:
        self.boot_s = 0.0  # the newest stamp that counts
        self._at = NEVER  # when a stamp of this clock came last [s, monotonic]
        self._run = 0  # stamps of another clock since
        self._first = self._last = (NEVER, 0.0)  # arrival and stamp of the first and last of them
        self._odd: deque[float] = deque(maxlen=STRANGERS)

    def judge(self, now: float, stamp_s: float) -> Stamp:
        """Judge the stamp of a message that came at `now` [s, monotonic]."""
        silence, ahead = now - self._at, stamp_s - self.boot_s
        if self._at == NEVER:
            return self._keep(now, stamp_s, Stamp.GOOD)
        wrapped = abs(ahead + WRAP - silence) < FALL  # 49.7 days after its start
        if wrapped or 0.0 <= ahead <= FALL + LEAP_RATE * silence:
            return self._keep(now, stamp_s, Stamp.GOOD)
        if -FALL <= ahead < 0.0:
            return self._keep(now, self.boot_s, Stamp.GOOD)
        if ahead < 0.0 and silence >= QUIET and stamp_s <= silence:
            return self._keep(now, stamp_s, Stamp.RESTART)  # no longer up than it was silent
        self._strange(now)
        if self._other_clock(now, stamp_s):
            return self._keep(now, stamp_s, Stamp.RESTART if ahead < 0.0 else Stamp.GOOD)
        return Stamp.ODD

    def passed_over(self, now: float, stamp_s: float) -> None:
        """Look at the stamp of a frame that does not count: whether it is of this clock at all."""
        if self._at != NEVER and abs(stamp_s - self.boot_s) > FALL + LEAP_RATE * (now - self._at):
            self._strange(now)

    def two_clocks(self, now: float) -> bool:
        """Whether the stamps of lately come of two clocks at once."""
        least, most = STRANGE_S
        full = len(self._odd) == STRANGERS
        return full and now - self._odd[0] <= most and self._odd[-1] - self._odd[0] >= least

    def _strange(self, now: float) -> None:
        if not self._odd or now - self._odd[-1] >= STRANGE_GAP:
            self._odd.append(now)

    def _keep(self, now: float, boot_s: float, stamp: Stamp) -> Stamp:
        self.boot_s, self._at, self._run = boot_s, now, 0
        return stamp

    def _other_clock(self, now: float, stamp_s: float) -> bool:
        """Whether another clock has run on for long enough, without the known one, to be the autopilot's.

        A queue of late frames does not: it comes all at once, and its stamps are older than the silence.
        """
        at, stamp = self._last
        runs_on = self._run > 0 and -0.1 <= stamp_s - stamp <= FALL + LEAP_RATE * (now - at)
        if not runs_on:
            self._run, self._first = 0, (now, stamp_s)
        self._run += 1
        self._last = (now, stamp_s)
        begun, first = self._first
        ran = now - begun
        live = ran >= RAN and stamp_s - first <= 2.0 * LEAP_RATE * ran and ran >= 0.5 * (stamp_s - first)
        young = first <= begun - self._at + QUIET
        return self._run >= RUN and live and (young or ran >= INSIST)


class Sample:
    """One place with its velocity, as north, east and down [m] of the first sample of its run."""

    __slots__ = ("at", "down", "east", "north", "off", "velocity", "way_east", "way_north")

    def __init__(self, at: float, place: GlobalPosition, origin: GlobalPosition, narrow: float) -> None:
        """`narrow`: the cosine of the origin's latitude."""
        self.at = at  # on the autopilot's clock [s]
        self.north = (place.latitude_deg - origin.latitude_deg) * METRES
        away = (place.longitude_deg - origin.longitude_deg + 180.0) % 360.0 - 180.0
        self.east = away * METRES * narrow
        self.down = origin.altitude_m - place.altitude_m
        self.velocity = place.velocity
        self.way_north = self.way_east = 0.0  # covered by the velocities since the first sample [m]
        self.off = 0.0  # by which places missed where velocities led, summed since then [m]


class Track:
    """Samples that follow each other, and whether each fits those before."""

    def __init__(self) -> None:
        self._origin: GlobalPosition | None = None
        self._narrow = 1.0
        self._samples: deque[Sample] = deque()
        self.since = NEVER  # when the run of samples that fit began [s, the autopilot's clock]

    def clear(self) -> None:
        """Forget all samples."""
        self._samples.clear()

    def restart(self, at: float, place: GlobalPosition) -> None:
        """Begin with one sample, compared with nothing."""
        self._origin, self._narrow = place, cos(radians(place.latitude_deg))
        self._samples.clear()
        self._samples.append(Sample(at, place, place, self._narrow))
        self.since = at

    def fault(self, at: float, place: GlobalPosition) -> str:
        """Why a sample contradicts those before it; "" where it fits, and is kept."""
        samples = self._samples
        if not samples or self._origin is None or not 0.0 <= at - samples[-1].at <= GAP:
            self.restart(at, place)
            return ""
        new, last = Sample(at, place, self._origin, self._narrow), samples[-1]
        dt = at - last.at
        v, u = new.velocity, last.velocity
        way_north, way_east = 0.5 * (v.x + u.x) * dt, 0.5 * (v.y + u.y) * dt
        north = new.north - last.north - way_north
        east = new.east - last.east - way_east
        down = new.down - last.down - 0.5 * (v.z + u.z) * dt
        missed = hypot(north, east, down)
        if missed > JUMP + JUMP_RATE * dt * dt:
            return "position_jump"
        new.off = last.off + missed
        new.way_north, new.way_east = last.way_north + way_north, last.way_east + way_east
        samples.append(new)
        while len(samples) > 2 and at - samples[1].at >= WINDOW:
            samples.popleft()
        return "position_frozen" if self._frozen() else ""

    def _frozen(self) -> bool:
        """Whether the place has stood still in any window that ends now while velocity has covered a way.

        A place moves at least as far as velocities lead less what places miss of that."""
        last = self._samples[-1]
        if last.off - self._samples[0].off < (1.0 - STILL) * MOVED:
            return False
        at, north, east = last.at, last.north, last.east
        way_north, way_east = last.way_north, last.way_east
        for sample in self._samples:
            if at - sample.at < LEAST:
                break
            dn, de = north - sample.north, east - sample.east
            wn, we = way_north - sample.way_north, way_east - sample.way_east
            covered = wn * wn + we * we
            if dn * dn + de * de < STILL * STILL * covered and covered >= MOVED * MOVED:
                return True
        return False


class PlaceWatch:
    """Whether a position may be flown on: against the velocity that came with it and before."""

    def __init__(self) -> None:
        self.doubt = ""  # why positions do not count now; "" while they do
        self._good, self._other = Track(), Track()

    def clear(self) -> None:
        """Forget all samples: the autopilot has started again."""
        self.doubt = ""
        self._good.clear()

    def judge(self, place: GlobalPosition) -> str:
        """Why a position does not count; "" where it does.

        Positions that fit each other, though not those before, count again after `SETTLED` seconds: the
        estimate has settled elsewhere.
        """
        at = place.time_boot_s
        if not self.doubt:
            self.doubt = self._good.fault(at, place)
            if self.doubt:
                self._other.restart(at, place)
            return self.doubt
        if self.doubt == "position_jump" and not self._good.fault(at, place):
            self.doubt = ""  # it was one odd sample, or a few
        elif self._other.fault(at, place):
            self._other.restart(at, place)
        elif at - self._other.since >= SETTLED:
            self._good, self._other = self._other, self._good
            self.doubt = ""
        return self.doubt


class Recent:
    """The last few values of one report: the middle one speaks, of two the earlier."""

    def __init__(self) -> None:
        self._values: deque[float] = deque(maxlen=RECENT)

    def take(self, value: float) -> None:
        """Take in one more."""
        self._values.append(value)

    @property
    def value(self) -> float:
        """The value that counts; ValueError before any came."""
        if len(self._values) == 2:
            return self._values[0]
        return sorted(self._values)[len(self._values) // 2]


class EstimatorWatch:
    """Whether the autopilot's position estimate is good, by its last few reports.

    The flags say what is estimated at all: two reports of three without it are enough. A fault or a test
    ratio above 1 is a rejected measurement: most reports of the last two seconds must have one.
    """

    def __init__(self) -> None:
        self._estimated = Recent()
        self._rejecting: deque[tuple[float, bool]] = deque(maxlen=100)
        self.ok = False  # whether the estimate is good

    def take(self, now: float, report: EkfStatus) -> None:
        """Take in one more report that came at `now` [s, monotonic]."""
        self._estimated.take(float(report.estimated))
        window = self._rejecting
        window.append((now, report.rejecting))
        while len(window) > RATIOS and now - window[0][0] > RATIOS_S:
            window.popleft()
        self.ok = self._judged()

    def _judged(self) -> bool:
        window = [rejecting for _, rejecting in self._rejecting]
        never_good = all(window) and len(window) < RATIOS  # no better report was heard yet
        rejecting = 2 * sum(window) > max(len(window), RATIOS)
        return self._estimated.value > 0.5 and not never_good and not rejecting
