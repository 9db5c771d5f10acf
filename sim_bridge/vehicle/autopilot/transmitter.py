"""The pilot's transmitter as the receiver hears it: the throttle stick, its dead zone, and its loss."""

from __future__ import annotations

CHANNELS = 16
PWM_LOW, PWM_MID, PWM_HIGH = 1000, 1500, 2000  # [µs]
LOST_S = 0.5  # channels that have been still for so long are lost


class Transmitter:
    """One transmitter. `throttle` is 0…1, 0.5 centred; None where no channel is heard."""

    def __init__(self, throttle: float | None) -> None:
        self._throttle = throttle
        self._was_heard = throttle is not None
        self._switch = 1800  # [µs] of channel 5, which chooses the mode
        self._places: dict[str, int] = {}  # of that switch, by mode
        self._silent_ns = -1  # since when nothing is heard; −1: it is heard, or never was

    @property
    def throttle(self) -> float | None:
        """The throttle stick, 0…1; None where no channel is heard."""
        return self._throttle

    def put(self, throttle: float | None, now_ns: int) -> None:
        """Move the stick, or switch the transmitter off (None)."""
        if throttle is None and self._throttle is not None:
            self._silent_ns = now_ns
        elif throttle is not None:
            self._silent_ns = -1
            self._was_heard = True
        self._throttle = None if throttle is None else min(1.0, max(0.0, throttle))

    @property
    def silent(self) -> bool:
        """Whether it was heard once and is heard no more."""
        return self._silent_ns >= 0

    def choose(self, mode: str) -> None:
        """Turn the mode switch to a mode's place, one of six."""
        self._switch = 1165 + 133 * (self._places.setdefault(mode, len(self._places)) % 6)

    def lost(self, now_ns: int) -> bool:
        """Whether it was heard once and has been silent for LOST_S."""
        return self._silent_ns >= 0 and (now_ns - self._silent_ns) * 1e-9 >= LOST_S

    def climb_share(self, dead_zone: float) -> float:
        """The climb that the stick asks for: −1 (lowest, or not heard) … 1, 0 within the dead zone.

        `dead_zone` is that on either side of the middle, as a share of the whole travel.
        """
        if self._throttle is None:
            return -1.0
        off = self._throttle - 0.5
        if abs(off) <= dead_zone:
            return 0.0
        reach = max(1e-6, 0.5 - dead_zone)
        return (off - dead_zone) / reach if off > 0.0 else (off + dead_zone) / reach

    def channels(self) -> list[int]:
        """Pulse widths of channels 1 to 18 [µs]; 0 for those that are not heard."""
        if self._throttle is None:
            return [0] * 18
        stick = round(PWM_LOW + self._throttle * (PWM_HIGH - PWM_LOW))
        told = [PWM_MID, PWM_MID, stick, PWM_MID, self._switch, PWM_LOW, PWM_LOW, 1800]
        return told + [0] * (18 - len(told))
