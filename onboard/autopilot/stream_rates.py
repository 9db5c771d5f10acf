"""Which messages at which rates a link can carry: asked for by priority within a budget of bytes.

The budget starts at the link's nominal capacity and follows what is measured: it falls by a fifth when
messages stay out or a radio's buffer fills, and rises by a twentieth while all is well, for a minute not up
to where it failed. All messages together are judged, over seconds: of a slow message on a lossy link a
second's count says nothing.

What stays out has several causes, and only a link that carries too little is a reason to ask for less.
Another station may have asked for slower streams: the autopilot then says another interval than ours
(MESSAGE_INTERVAL), and is asked again. A link that carried everything within one of the seconds can carry
it. Frames lost on the way are counted by their numbers, and this computer's own lateness is not the link's.
Before the budget falls everything is asked for once more, and where less asked brings less, it goes back up.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from enum import Enum
from math import sqrt
from typing import NamedTuple

from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.commands import CommandLong, Target, get_message_interval, set_message_interval
from onboard.wire.mavlink.ids import frame_size, message_number
from onboard.wire.mavlink.modes import Kind

SHARE = 0.75  # of a link's capacity to plan with: the rest is for answers, texts and what is not asked for
FULL = 0.9  # share of the expected messages that must arrive
BUFFER = 0.2  # of a radio's transmit buffer free, or it is congested
FALL, RISE = 0.8, 1.05
UNDER, REMEMBER = 0.9, 60.0  # stay this far under a budget that failed, for so long [s]
SETTLE = 3.0  # [s] that are judged at once, and after a change
SIGMAS = 2.0  # of what chance takes on a lossy link before less counts as too little
SURPLUS = 1.2  # more of one message than asked for does not make up for another's lack
ASK_AGAIN = 0.15  # change of a rate that is worth asking for
SLOW = 0.75  # of its rate, within a second, under which a message is asked about
ASKED_ABOUT = 2.0  # [Hz] from which a second's count says something
QUESTIONS = 2  # at once: a narrow link has more to carry
PATIENT = (1.0, 30.0)  # [s] between two requests for what another took: at first, and at most
HELPED = 0.9  # of what came before, under which asking for less did not help
LOSSY = 0.9  # share of the frames that arrive, under which loss is worth a word


class Shortfall(Enum):
    """Why less comes than was asked for."""

    NONE = ""
    RADIO = "the telemetry radio's buffer is full"
    STATION = "the autopilot sends at other rates than asked: another station's requests"
    LATE = "this computer is too busy to listen"
    LOSS = "frames are lost on the way"
    LINK = "the link carries less than is asked for"


REMEDIES = {
    Shortfall.RADIO: "a faster radio, or a lower control_rate_hz",
    Shortfall.STATION: "MAVProxy: --streamrate=-1 or a higher one; in other stations let streams alone",
    Shortfall.LATE: "end other programs on this computer",
    Shortfall.LOSS: "a better radio link or cable",
    Shortfall.LINK: "a faster link, or a lower control_rate_hz",
}
"""What to do about each."""


class Need(NamedTuple):
    """A message the agent reads."""

    message: str  # its name
    rate: float  # [Hz] wanted
    least: float  # [Hz] without which it is no use


# In the order of importance: what is cut is cut from the end. Of GPS and estimator two reports decide: at
# 5 Hz that is sooner than half a second without a position.
_COMMON = (
    Need("HEARTBEAT", 1.0, 1.0),
    Need("GLOBAL_POSITION_INT", 20.0, 5.0),
    Need("ATTITUDE", 20.0, 5.0),
    Need("SYS_STATUS", 2.0, 0.5),
    Need("GPS_RAW_INT", 5.0, 0.5),
)
_HUD = Need("VFR_HUD", 5.0, 1.0)
_EXTENDED = (Need("EXTENDED_SYS_STATE", 1.0, 0.2),)
_EKF = (Need("EKF_STATUS_REPORT", 5.0, 0.5),)
_STICKS = (Need("RC_CHANNELS", 2.0, 1.0),)  # whether LOITER would hold, and whose hands fly: `pilot_hands`
NEEDS: dict[Kind, tuple[Need, ...]] = {
    Kind.PX4_MULTICOPTER: (*_COMMON, Need("ESTIMATOR_STATUS", 5.0, 0.5), *_STICKS, _HUD, *_EXTENDED),
    Kind.PX4_PLANE: (
        *_COMMON, Need("ESTIMATOR_STATUS", 5.0, 0.5), Need("WIND_COV", 5.0, 1.0), *_STICKS, _HUD, *_EXTENDED,
    ),
    Kind.ARDUCOPTER: (*_COMMON, *_EKF, *_STICKS, _HUD, *_EXTENDED),
    Kind.ARDUPLANE: (
        *_COMMON, Need("VFR_HUD", 20.0, 5.0), Need("WIND", 5.0, 1.0), *_EKF, *_STICKS, *_EXTENDED,
    ),
}  # fmt: skip


def capacity_of(baud: int) -> float:
    """Bytes a second of a serial line with 8 data bits, one start and one stop bit."""
    return baud / 10.0


def plan(needs: Sequence[Need], budget: float, *, signed: bool = False) -> dict[str, float]:
    """Rates [Hz] by message within `budget` [bytes/s], the most important first served.

    Everybody gets the least first, in order, while it lasts (then 0: not asked for); what is left goes to
    full rates, in order.
    """
    rates: dict[str, float] = {}
    left = budget
    for need in needs:
        cost = need.least * frame_size(need.message, signed)
        rates[need.message] = need.least if cost <= left else 0.0
        left -= cost if cost <= left else 0.0
    for need in needs:
        if rates[need.message] > 0.0:
            size = frame_size(need.message, signed)
            more = max(0.0, min(need.rate - need.least, left / size))
            rates[need.message] += more
            left -= more * size
    return rates


class StreamRates:
    """The message rates that one autopilot is asked for; they adapt to what arrives."""

    def __init__(
        self,
        kind: Kind,
        to: Target,
        capacity: float | None = None,
        *,
        signed: bool = False,
        needs: Sequence[Need] | None = None,
    ) -> None:
        self._needs = NEEDS[kind] if needs is None else needs
        self._to = to
        self._signed = signed
        most = sum(need.rate * frame_size(need.message, signed) for need in self._needs)
        self._ceiling = min(most, capacity * SHARE) if capacity is not None else most
        self.budget = self._ceiling  # [bytes/s] now planned with
        self.rates: dict[str, float] = {}  # [Hz] asked for
        self._judged_at = 0.0  # the last judgement, or change
        self._heard: Counter[str] = Counter()  # rates since then, summed up over `_looks`
        self._looks = 0
        self._failed = (0.0, NEVER)  # the budget that last was too much, and when
        self._stale = True  # ask for everything, whatever was asked before
        self.cause = Shortfall.NONE  # of what stays out now
        self._taken: dict[str, float] = {}  # messages at another interval than ours → when last asked again
        self._patience: dict[str, float] = {}  # … → until the next time [s]
        self._granted_at: dict[str, float] = {}  # when the autopilot last said that it does as asked
        self._had: set[str] = set()  # messages that came once as asked
        self._station_at = NEVER  # when another station's doing was last seen
        self._slow: list[str] = []  # that came too slowly within the last second
        self._carried = False  # everything came within one of the seconds
        self._again = False  # asked once more since all was well
        self._before: tuple[float, float] | None = None  # the budget before it fell, and what came then
        self._stuck_at = NEVER  # when asking for less brought less

    def forget(self) -> None:
        """Ask for everything again: the autopilot has started again, or another link is used."""
        self._stale = True

    def granted(self, now: float, number: int, interval_s: float) -> None:
        """Hear the interval [s] at which the autopilot says it sends a message; 0: not at all."""
        for name, rate in self.rates.items():
            if message_number(name) != number or rate <= 0.0:
                continue
            if abs(interval_s * rate - 1.0) > ASK_AGAIN:
                self._taken.setdefault(name, NEVER)
            else:
                self._forget_taken(name)
                self._granted_at[name] = now

    def step(
        self,
        now: float,
        arrived: dict[str, float],
        buffer_free: float = 1.0,
        quality: float = 1.0,
        late: bool = False,
    ) -> list[CommandLong]:
        """Return the requests due at `now` [s, monotonic]; call about once a second.

        `arrived`: measured rates [Hz] by message, as they were sent; `quality`: the share of frames that
        comes through, by which they were estimated; `buffer_free`: of the telemetry radio, 0…1 (1 if none);
        `late`: this process was late itself, so that its counts say nothing.
        """
        if self._stale:
            self._taken.clear()
            self._had.clear()
            return self._replan(now)
        if late:
            self.cause = Shortfall.LATE
            self._judged(now)
            return []
        self._heard.update(arrived)
        self._looks += 1
        self._carried = self._carried or not self._short(
            {name: arrived.get(name, 0.0) for name in self.rates}, (), 1.0, quality
        )
        self._slow = [
            name
            for name, rate in self.rates.items()
            if rate >= ASKED_ABOUT and arrived.get(name, 0.0) < SLOW * rate
        ]
        self._had.update(name for name in self.rates if name not in self._slow)
        self._settle_taken(now)
        again = self.taken_back(now)
        if again:
            return again
        span = now - self._judged_at
        if span < SETTLE:
            return self._questions(now)
        return self._judge(now, span, buffer_free, quality)

    def _judge(self, now: float, span: float, buffer_free: float, quality: float) -> list[CommandLong]:
        """Judge what came in `span` [s]: plan anew, or ask again for what stayed out."""
        rates = {name: self._heard[name] / self._looks for name in self.rates}
        carried = self._carried
        self._judged(now)
        silent = [name for name, rate in self.rates.items() if rate > 0.0 and rates[name] == 0.0]
        full = buffer_free < BUFFER
        if full or self._short(rates, silent, span, quality):
            if self._taken and not full:
                return self._questions(now)  # another station's doing: to ask for less helps nobody
            if not full and (carried or not self._again):
                self._again = not carried
                if carried and self._had.intersection(self._slow):
                    self.cause, self._station_at = Shortfall.STATION, now
                return self._requests([name for name, rate in self.rates.items() if rate > 0.0])
            self.cause = Shortfall.RADIO if full else Shortfall.LINK
            self._fall(now, self._bytes(rates), sticky=full)
            return self._replan(now)
        self.cause = Shortfall.LOSS if quality < LOSSY else Shortfall.NONE
        self._again, self._before = False, None
        if silent:  # the others come in full: it was the request that was lost
            return self._requests(silent)
        top = self._ceiling
        if now - self._failed[1] < REMEMBER:
            top = min(top, self._failed[0] * UNDER)
        if self.budget < top:
            self.budget = min(top, self.budget * RISE)
        return self._replan(now)

    def _fall(self, now: float, came: float, *, sticky: bool) -> None:
        """Ask for less, unless that has just brought less; `came` [bytes/s]."""
        if not sticky and now - self._stuck_at < REMEMBER:
            return
        if not sticky and self._before is not None and came < HELPED * self._before[1]:
            self.budget, self._before, self._stuck_at = self._before[0], None, now
            return
        self._before = (self.budget, came)
        self._failed = (self.budget, now)
        self.budget = max(self._floor(), self.budget * FALL)

    def _replan(self, now: float) -> list[CommandLong]:
        """Requests for what the budget has changed."""
        planned = plan(self._needs, self.budget, signed=self._signed)
        changed = [name for name, rate in planned.items() if self._stale or self._differs(name, rate)]
        if changed:
            self._judged(now)
        self._stale = False
        self.rates.update({name: planned[name] for name in changed})
        return self._requests(changed)

    def _settle_taken(self, now: float) -> None:
        """What comes as asked is taken no more; near a station that takes, whatever is slow was taken."""
        for name in [
            name for name in self._taken if name not in self._slow and self.rates[name] >= ASKED_ABOUT
        ]:
            self._forget_taken(name)
        if now - self._station_at < REMEMBER:
            for name in self._slow:
                self._taken.setdefault(name, NEVER)

    def _forget_taken(self, name: str) -> None:
        self._taken.pop(name, None)
        self._patience.pop(name, None)

    def taken_back(self, now: float) -> list[CommandLong]:
        """Requests for what another station took; more and more patient with one that takes it again."""
        due = [name for name, at in self._taken.items() if now - at >= self._patience.get(name, 0.0)]
        for name in due:
            self._taken[name] = now
            self._patience[name] = min(PATIENT[1], max(PATIENT[0], 2.0 * self._patience.get(name, 0.0)))
        if not due:
            return []
        if self._had.intersection(due):  # else it may be our request that was lost
            self.cause, self._station_at = Shortfall.STATION, now
        self._judged(now)
        return self._requests([*due, *(name for name in self._slow if name not in self._taken)])

    def _questions(self, now: float) -> list[CommandLong]:
        """Ask at which interval the autopilot sends what comes too slowly, and what another took."""
        names = [
            name
            for name in [*self._taken, *self._slow]
            if now - self._granted_at.get(name, NEVER) >= SETTLE and self.rates[name] > 0.0
        ]
        asked = list(dict.fromkeys(names))[:QUESTIONS]
        return [get_message_interval(self._to, message_number(name)) for name in asked]

    def _bytes(self, rates: dict[str, float]) -> float:
        return sum(rate * frame_size(name, self._signed) for name, rate in rates.items())

    def _judged(self, now: float) -> None:
        self._judged_at, self._looks, self._carried = now, 0, False
        self._heard.clear()

    def _short(self, rates: dict[str, float], silent: Sequence[str], span: float, quality: float) -> bool:
        """Whether less comes than asked for, beyond what chance explains; the silent count if all are."""
        speaking = [name for name, rate in self.rates.items() if rate > 0.0 and name not in silent]
        if not speaking:
            return bool(silent)
        wanted = sum(self.rates[name] for name in speaking)
        came = sum(min(rates[name], SURPLUS * self.rates[name]) for name in speaking)
        share = min(1.0, max(0.1, quality))
        chance = sqrt((1.0 - share) / (share * wanted * span))
        return came < (FULL - SIGMAS * chance) * wanted

    def _differs(self, name: str, rate: float) -> bool:
        return abs(rate - self.rates[name]) > ASK_AGAIN * max(rate, self.rates[name])

    def _floor(self) -> float:
        """The least of the three that matter most."""
        return sum(need.least * frame_size(need.message, self._signed) for need in self._needs[:3])

    def _requests(self, names: Sequence[str]) -> list[CommandLong]:
        return [set_message_interval(self._to, message_number(name), self.rates[name]) for name in names]
