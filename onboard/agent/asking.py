"""What the agent asks of its autopilot: message rates, and the parameters that matter.

A rate is asked for again while less than it arrives; over a serial link all are scaled to what it carries.
"""

from __future__ import annotations

from collections import Counter

from onboard.agent.config import RatesConfig
from onboard.autopilot.parameters import WANTED
from onboard.wire import commands
from onboard.wire.commands import Target
from onboard.wire.mavlink import MavMessage
from onboard.wire.modes import Kind
from onboard.wire.values import ParamValue

ENOUGH = 0.7  # of a rate: below it is asked for again
REVIEW_S = 2.0  # between two looks at what arrives
PARAM_AGAIN_S = 0.5
PARAM_TRIES = 6
SERIAL_SHARE = 0.6  # of a serial link's capacity that telemetry may take
GLOBAL_POSITION, ATTITUDE, AIR_DATA, SYS_STATUS, GPS = 33, 30, 74, 1, 24
BATTERY, LANDED, HOME = 147, 245, 242
SIZES = {33: 40, 30: 40, 74: 32, 168: 24, 231: 52, 1: 43, 24: 64, 193: 38, 230: 54, 147: 66, 245: 14}  # bytes


def wanted_rates(rates: RatesConfig, kind: Kind, baud: int = 0) -> dict[int, float]:
    """Message id → rate [Hz] for a kind of autopilot; `baud` of a serial link limits the sum."""
    px4 = kind is Kind.PX4_MULTICOPTER
    found = {
        GLOBAL_POSITION: rates.position,
        ATTITUDE: rates.attitude,
        AIR_DATA: rates.air_data,
        231 if px4 else 168: rates.wind,
        SYS_STATUS: rates.status,
        GPS: rates.gps,
        230 if px4 else 193: rates.ekf,
        BATTERY: rates.battery,
        LANDED: rates.landed,
    }
    found = {message: rate for message, rate in found.items() if rate > 0.0}
    if baud > 0:
        load = sum(rate * SIZES[message] for message, rate in found.items())
        share = min(1.0, SERIAL_SHARE * baud / 10.0 / max(load, 1.0))
        found = {message: max(1.0, rate * share) for message, rate in found.items()}
    return found


class Asking:
    """Requests due now, for one autopilot."""

    def __init__(self, to: Target, kind: Kind, rates: dict[int, float], *, parameters: bool = True) -> None:
        self.rates = rates
        self.parameters: dict[str, float] = {}
        self.asked = 0
        self._to = to
        self._px4 = kind is Kind.PX4_MULTICOPTER
        self._arrived: Counter[int] = Counter()
        self._reviewed = -1e9
        self._missing = list(WANTED.get(kind, ())) if parameters else []
        self._tries = 0
        self._param_at = -1e9

    def arrived(self, message: int) -> None:
        """Count a message that came."""
        if message in self.rates:
            self._arrived[message] += 1

    def parameter(self, value: ParamValue) -> None:
        """Keep a parameter's value."""
        if value.name in self._missing:
            self._missing.remove(value.name)
            self.parameters[value.name] = value.bytewise if self._px4 else value.value

    def again(self) -> None:
        """Ask for everything anew: the autopilot has started again."""
        self._reviewed = -1e9

    def due(self, now: float) -> list[MavMessage]:
        """What to send at `now` [s, monotonic]."""
        messages: list[MavMessage] = []
        first = self._reviewed < -1e8
        if first or now - self._reviewed >= REVIEW_S:
            span = now - self._reviewed
            for message, rate in self.rates.items():
                if first or self._arrived[message] < ENOUGH * rate * span:
                    messages.append(commands.set_message_interval(self._to, message, rate))
            if first:
                messages.append(commands.request_message(self._to, HOME))
            self._arrived.clear()
            self._reviewed = now
            self.asked += len(messages)
        if self._missing and self._tries < PARAM_TRIES and now - self._param_at >= PARAM_AGAIN_S:
            self._tries += 1
            self._param_at = now
            messages += [commands.param_read(self._to, name) for name in self._missing]
        return messages
