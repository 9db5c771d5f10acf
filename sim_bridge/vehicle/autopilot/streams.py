"""Which messages are sent how often: defaults, SET_MESSAGE_INTERVAL and REQUEST_DATA_STREAM."""

from __future__ import annotations

from collections.abc import Mapping

NEVER = 1 << 62
SHORTEST_NS = 2_000_000  # 500 Hz: what no link asks for
LONGEST_NS = 2_147_483_647_000  # that MESSAGE_INTERVAL can report


class Streams:
    """The schedule of periodic messages. Due times keep a grid, so that the mean rate is the asked one."""

    def __init__(self, defaults_hz: Mapping[int, float], now_ns: int) -> None:
        self._defaults = {number: round(1e9 / hz) for number, hz in defaults_hz.items()}
        self._intervals = dict(self._defaults)
        self._due = dict.fromkeys(self._intervals, now_ns)
        self._first = now_ns

    def set(self, number: int, interval_us: float, now_ns: int) -> None:
        """SET_MESSAGE_INTERVAL: −1 switches off, 0 restores the default."""
        if interval_us == 0:
            interval = self._defaults.get(number, 0)
        else:
            interval = round(min(max(SHORTEST_NS, interval_us * 1000), LONGEST_NS)) if interval_us > 0 else 0
        if interval:
            if self._intervals.get(number) != interval:
                self._intervals[number] = interval
                self._due[number] = now_ns
        else:
            self._intervals.pop(number, None)
            self._due.pop(number, None)
        self._first = min(self._due.values(), default=NEVER)

    def interval_us(self, number: int) -> int:
        """For MESSAGE_INTERVAL: −1 where it is off."""
        interval = self._intervals.get(number)
        return -1 if interval is None else interval // 1000

    @property
    def first(self) -> int:
        """When the next message is due [ns]."""
        return self._first

    def due(self, now_ns: int) -> list[int]:
        """Numbers of the messages to be sent now."""
        if now_ns < self._first:
            return []
        numbers = []
        for number, at in self._due.items():
            if at <= now_ns:
                numbers.append(number)
                following = at + self._intervals[number]
                self._due[number] = following if following > now_ns else now_ns + self._intervals[number]
        self._first = min(self._due.values(), default=NEVER)
        return numbers
