"""Which messages at which rates a link can carry: asked for by priority within a budget of bytes.

The budget starts at the link's nominal capacity and follows what is measured: it falls by a fifth when
messages stay out or a radio's buffer fills, and rises by a twentieth while all is well, for a minute not up
to where it failed. All messages together are judged, over seconds: of a slow message on a lossy link a
second's count says nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.commands import CommandLong, Target, set_message_interval
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

    def forget(self) -> None:
        """Ask for everything again: the autopilot has started again, or another link is used."""
        self._stale = True

    def step(
        self, now: float, arrived: dict[str, float], buffer_free: float = 1.0, quality: float = 1.0
    ) -> list[CommandLong]:
        """Return the requests due at `now` [s, monotonic]; call about once a second.

        `arrived`: measured rates [Hz] by message, as they were sent; `quality`: the share of frames that
        comes through, by which they were estimated; `buffer_free`: of the telemetry radio, 0…1 (1 if none).
        """
        if not self._stale:
            self._heard.update(arrived)
            self._looks += 1
            span = now - self._judged_at
            if span < SETTLE:
                return []
            rates = {name: self._heard[name] / self._looks for name in self.rates}
            self._judged(now)
            silent = [name for name, rate in self.rates.items() if rate > 0.0 and rates[name] == 0.0]
            congested = buffer_free < BUFFER or self._short(rates, silent, span, quality)
            top = self._ceiling
            if now - self._failed[1] < REMEMBER:
                top = min(top, self._failed[0] * UNDER)
            if congested:
                self._failed = (self.budget, now)
                self.budget = max(self._floor(), self.budget * FALL)
            elif silent:  # the others come in full: it was the request that was lost
                return self._requests(silent)
            elif self.budget < top:
                self.budget = min(top, self.budget * RISE)
        planned = plan(self._needs, self.budget, signed=self._signed)
        changed = [name for name, rate in planned.items() if self._stale or self._differs(name, rate)]
        if changed:
            self._judged(now)
        self._stale = False
        self.rates.update({name: planned[name] for name in changed})
        return self._requests(changed)

    def _judged(self, now: float) -> None:
        self._judged_at, self._looks = now, 0
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
