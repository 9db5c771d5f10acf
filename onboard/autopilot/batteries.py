"""The batteries that keep a vehicle in the air, told apart by id and function.

A payload's or the avionics' battery says nothing of how long the vehicle can fly; of several flight batteries
the emptiest speaks. What no BATTERY_STATUS of a flight battery tells, SYS_STATUS tells.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.autopilot.plausibility import Recent
from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.values import UNKNOWN, Battery, SysStatus

FLIGHT = (0, 1, 2)  # MAV_BATTERY_FUNCTION: not said, all of the vehicle, propulsion
FUNCTIONS = {0: "unknown", 1: "all", 2: "propulsion", 3: "avionics", 4: "payload"}
MOST = 16  # batteries told apart
STALE = 30.0  # [s] after which a battery that fell silent no longer speaks, where another one does


class Gauged(NamedTuple):
    """What one battery reports."""

    id: int
    function: int  # MAV_BATTERY_FUNCTION
    share: float  # 0…1, or UNKNOWN
    voltage: float  # [V], or UNKNOWN


class _Gauge:
    """Share and voltage of one battery, by its last few reports; UNKNOWN where it does not say."""

    def __init__(self) -> None:
        self.at = NEVER
        self._share, self._voltage = Recent(), Recent()
        self._knows = [False, False]

    def take(self, now: float, share: float, voltage: float) -> None:
        """Take in one more report at `now` [s, monotonic]."""
        self.at = now
        for index, (recent, value) in enumerate(((self._share, share), (self._voltage, voltage))):
            if value >= 0.0:
                recent.take(value)
                self._knows[index] = True

    @property
    def share(self) -> float:
        """0…1."""
        return self._share.value if self._knows[0] else UNKNOWN

    @property
    def voltage(self) -> float:
        """[V]."""
        return self._voltage.value if self._knows[1] else UNKNOWN


class Batteries:
    """The flight batteries of one vehicle."""

    def __init__(self) -> None:
        self._gauges: dict[int, _Gauge] = {}
        self._reports: dict[int, Gauged] = {}  # the last of each, whatever it is for
        self._status = _Gauge()
        self._now = NEVER
        self.share = self.voltage = UNKNOWN  # [0…1], [V] of the emptiest flight battery; UNKNOWN: nobody says

    def take(self, now: float, battery: Battery) -> None:
        """Take in a BATTERY_STATUS that came at `now` [s, monotonic]."""
        self._now = now
        if battery.id in self._reports or len(self._reports) < MOST:
            report = Gauged(battery.id, battery.function, battery.remaining, battery.voltage)
            self._reports[battery.id] = report
        if battery.function not in FLIGHT:
            self._gauges.pop(battery.id, None)
        elif battery.id in self._gauges or len(self._gauges) < MOST:
            self._gauges.setdefault(battery.id, _Gauge()).take(now, battery.remaining, battery.voltage)
        self._weigh()

    def take_status(self, status: SysStatus) -> None:
        """Take in a SYS_STATUS."""
        self._status.take(self._now, status.battery, status.voltage)
        self._weigh()

    def _weigh(self) -> None:
        """Take in what changed; what nobody says of the batteries, SYS_STATUS says."""
        gauge = self._emptiest()
        self.share = self._status.share if gauge is None or gauge.share == UNKNOWN else gauge.share
        self.voltage = self._status.voltage if gauge is None or gauge.voltage == UNKNOWN else gauge.voltage

    @property
    def each(self) -> tuple[Gauged, ...]:
        """The last report of every battery, by id."""
        return tuple(self._reports[id] for id in sorted(self._reports))

    def _emptiest(self) -> _Gauge | None:
        """The battery that speaks: the emptiest; where no share is known, the lowest voltage."""
        speaking = [gauge for gauge in self._gauges.values() if self._now - gauge.at <= STALE]

        def left(gauge: _Gauge) -> tuple[bool, float, float]:
            return gauge.share == UNKNOWN, gauge.share, gauge.voltage

        return min(speaking, key=left, default=None)
