"""What the agent asks of its autopilot besides modes: message rates, parameters, its clock."""

from __future__ import annotations

from collections import Counter

from onboard.autopilot.flight_limits import still_wanted
from onboard.autopilot.parameters import ALIASES, PX4, WANTED
from onboard.autopilot.stream_rates import NEEDS, Need, Shortfall, StreamRates, capacity_of
from onboard.autopilot.timesync import TimesyncEstimator
from onboard.autopilot.unread_streams import UnreadStreams
from onboard.core.math.constants import NEVER, NS_PER_S
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Outgoing, ParamRead, Target
from onboard.wire.mavlink.ids import MessageId
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import MessageInterval, ParamValue
from onboard.wire.retry import CommandRetry, RetryPolicy

REVIEW_S = 1.0  # between two looks at the rates
LATE = 1.5  # times that, after which this process was late itself
PARAM_RETRY = RetryPolicy(0.5, patience=6, slow=5.0)  # [s] without end: the limits must come
VERSION_RETRY = RetryPolicy(1.0, patience=4, slow=30.0)  # [s] without end: a second autopilot answers, too
CLOCK_EVERY_S = 2.0
MORE_PATIENCE = 40  # tries at that pace where more is read than flying needs
PARAMS_AT_ONCE = 16  # asked for together: a narrow link has more to carry
FAST = ("GLOBAL_POSITION_INT", "ATTITUDE")  # follow the control rate above 20 Hz


def needs_of(kind: Kind, control_rate_hz: float) -> tuple[Need, ...]:
    """What a kind of autopilot is asked for, at a control rate."""
    return tuple(
        need._replace(rate=max(need.rate, control_rate_hz)) if need.message in FAST else need
        for need in NEEDS.get(kind, ())
    )


def baud_of(link: str) -> int:
    """Baud rate of a serial link by its name, 0 for other links."""
    if not link.startswith("serial:"):
        return 0
    tail = link.rsplit(":", 1)[-1]
    return int(tail) if tail.isascii() and tail.isdigit() else 57600


class Requests:
    """Requests due now, for one autopilot."""

    def __init__(self, to: Target, kind: Kind, control_rate_hz: float, link: str, signed: bool) -> None:
        baud = baud_of(link)
        self.parameters: dict[str, float] = {}
        self.revision = 0  # counts how often they were told
        self.clock = TimesyncEstimator()
        capacity, needs = capacity_of(baud) if baud else None, needs_of(kind, control_rate_hz)
        self._rates = StreamRates(kind, to, capacity, signed=signed, needs=needs)
        self._unread = UnreadStreams(to, [need.message for need in needs], capacity, signed)
        self._to = to
        self._px4 = kind in PX4
        self._taken_back: list[Outgoing] = []  # requests to be sent at once
        self._arrived: Counter[str] = Counter()
        self._reviewed = self._clock_at = NEVER
        self._kind = kind
        self._wanted = frozenset(WANTED.get(kind, ()))
        self._missing = list(WANTED.get(kind, ()))  # the next to be asked for first
        self._params = CommandRetry(PARAM_RETRY)
        self._version = CommandRetry(VERSION_RETRY)
        self._buffer_free = 1.0

    def arrived(self, message: str) -> None:
        """Count a message that came."""
        self._arrived[message] += 1

    def radio(self, buffer_free: float) -> None:
        """The telemetry radio's transmit buffer, as it reports it."""
        self._buffer_free = buffer_free

    def interval(self, now: float, value: MessageInterval) -> None:
        """The autopilot's word on how often it sends a message."""
        self._rates.granted(now, value.number, value.interval_s)
        self._taken_back += self._rates.taken_back(now)

    @property
    def shortfall(self) -> Shortfall:
        """Why less comes than was asked for."""
        return self._rates.cause

    @property
    def asked_off(self) -> tuple[str, ...]:
        """The streams that nobody here reads, and that were asked off or slower on a narrow link."""
        return self._unread.asked

    def parameter(self, value: ParamValue) -> None:
        """Keep a parameter's value."""
        if value.name not in self._wanted:
            return
        self.revision += 1
        self.parameters[value.name] = value.bytewise if self._px4 else value.value
        if value.name in self._missing:
            names = next((names for names in ALIASES if value.name in names), (value.name,))
            self._missing = [name for name in self._missing if name not in names]
            self._missing = still_wanted(self._kind, self.parameters, self._missing)

    def read_also(self, names: tuple[str, ...]) -> None:
        """Ask for more parameters than an agent needs; those that are asked for already are not again."""
        more = [name for name in names if name not in self._wanted]
        if more:
            self._wanted |= frozenset(more)
            self._missing += more
            self._params = CommandRetry(PARAM_RETRY._replace(patience=MORE_PATIENCE))

    def again(self) -> None:
        """Ask for everything anew: the autopilot has started again, or another link is used."""
        self._rates.forget()
        self._unread.forget()
        self._reviewed = NEVER

    def due(self, now: float, quality: float) -> list[Outgoing]:
        """What to send at `now` [s, monotonic]; `quality`: share of the autopilot's frames that arrive.

        What is lost on the way is no reason to ask for less: rates are judged by what was sent."""
        messages, self._taken_back = self._taken_back, []
        span = now - self._reviewed
        if span >= REVIEW_S:
            first = self._reviewed == NEVER
            late = not first and span > LATE * REVIEW_S
            share = max(0.1, quality)
            rates = {name: count / span / share for name, count in self._arrived.items()}
            messages += self._rates.step(now, rates, self._buffer_free, share, late)
            starving = self._rates.cause in (Shortfall.LINK, Shortfall.RADIO)
            messages += self._unread.step(now, self._arrived, span, starving)
            if first:
                messages.append(commands.request_message(self._to, MessageId.HOME_POSITION))
            self._arrived.clear()
            self._reviewed = now
        if self._missing and self._params.due(now):
            asked = self._missing[:PARAMS_AT_ONCE]
            self._missing = self._missing[PARAMS_AT_ONCE:] + asked
            messages += [ParamRead(self._to, name) for name in asked]
        if self._version.due(now):
            messages.append(commands.request_message(self._to, MessageId.AUTOPILOT_VERSION))
        if now - self._clock_at >= CLOCK_EVERY_S:
            self._clock_at = now
            messages.append(self.clock.ask(round(now * NS_PER_S)))
        return messages
