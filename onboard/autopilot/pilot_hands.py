"""What a pilot's transmitter tells of its pilot: whether his hands fly, and whether he has turned a switch.

A mode names no one who chose it. A switch that moved together with the mode is the pilot's; a mode that
changed alone was chosen by a ground station, another companion or the autopilot itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from onboard.autopilot.base import Telemetry
from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.modes import Kind

HEARD_S = 2.0  # after which what was heard of the transmitter is no news
MOVED_S = 10.0  # so long after a stick has moved it is in somebody's hand
TURNED_S = 2.5  # between a switch and the mode that it chose, either first: channels come twice a second
STICKS = 4  # channels 1 to 4 are sticks, those above are switches
STICK_US, SWITCH_US = 25, 100  # [µs] that count as moved
THROTTLE, BOTTOM_US = 2, 1100  # the throttle stick's index, and where it has fallen to the bottom
LEAST_US, MOST_US = 800, 2200  # of a channel that is heard
LOW = 0.1  # share of its travel above which a throttle stick is not at the bottom
RECEIVER_BAD = 65536  # MAV_SYS_STATUS_SENSOR_RC_RECEIVER, among the unhealthy

_PX4 = frozenset(("MANUAL", "ALTCTL", "POSCTL", "ACRO", "STABILIZED", "RATTITUDE"))
FLOWN_BY_HAND: dict[Kind, frozenset[str]] = {
    Kind.ARDUCOPTER: frozenset(
        (
            "STABILIZE", "ACRO", "ALT_HOLD", "LOITER", "DRIFT", "SPORT", "FLIP", "AUTOTUNE", "POSHOLD",
            "FLOWHOLD", "ZIGZAG", "TURTLE",
        )
    ),
    Kind.ARDUPLANE: frozenset(
        (
            "MANUAL", "STABILIZE", "TRAINING", "ACRO", "FBWA", "FBWB", "CRUISE", "AUTOTUNE", "QSTABILIZE",
            "QHOVER", "QLOITER", "QAUTOTUNE", "QACRO",
        )
    ),
    Kind.PX4_MULTICOPTER: _PX4,
    Kind.PX4_PLANE: _PX4,
}  # fmt: skip
"""Modes in which the sticks move the vehicle."""


class PilotHands:
    """Watches the channels of one transmitter. Instants are local monotonic seconds."""

    def __init__(self) -> None:
        self.stick_at = self.switch_at = NEVER  # when a stick, or a switch, was last seen to have moved
        self._heard_at = NEVER
        self._before: list[int] = []  # [µs] of each channel when it last moved

    def take(self, telemetry: Telemetry) -> None:
        """Look at what the receiver hears now."""
        at, channels = telemetry.channels_at, telemetry.channels
        if at == NEVER or at == self._heard_at:
            return
        self._heard_at = at
        before = self._before
        before += [0] * (len(channels) - len(before))
        for index, (was, now) in enumerate(zip(before, channels, strict=False)):
            if abs(now - was) < (STICK_US if index < STICKS else SWITCH_US):
                continue
            before[index] = now
            fallen = index == THROTTLE and now < BOTTOM_US  # no hand is needed for that
            if fallen or not (_heard(was) and _heard(now)):
                continue  # it begins to be heard, or is lost
            if index < STICKS:
                self.stick_at = at
            else:
                self.switch_at = at

    @property
    def at(self) -> float:
        """When a stick or a switch was last seen to have moved."""
        return max(self.stick_at, self.switch_at)

    def turned(self, now: float, changed_at: float) -> bool:
        """Whether a switch was turned about when the mode changed."""
        return self.switch_at != NEVER and abs(self.switch_at - changed_at) <= TURNED_S and now >= changed_at

    def moving(self, now: float) -> bool:
        """Whether a stick has moved lately."""
        return self.stick_at != NEVER and now - self.stick_at <= MOVED_S


def _heard(pulse: int) -> bool:
    return LEAST_US <= pulse <= MOST_US


class Throttle(NamedTuple):
    """The throttle stick, as the receiver hears it [µs]."""

    pulse: int
    least: float
    most: float


def fresh(now: float, t: Telemetry) -> bool:
    """Return whether the receiver has told lately what it hears, and is well."""
    lately = t.channels_at != NEVER and 0.0 <= now - t.channels_at <= HEARD_S
    return lately and not t.unhealthy & RECEIVER_BAD


def throttle(now: float, t: Telemetry, parameters: Mapping[str, float]) -> Throttle | None:
    """Return where the throttle stick stands; None where no channel says so, or none lately."""
    if not fresh(now, t):
        return None
    channel = round(parameters.get("RCMAP_THROTTLE", 3.0))
    if not 1 <= channel <= len(t.channels) or not _heard(t.channels[channel - 1]):
        return None
    own = channel == 3  # of other channels the travel is not read
    least, most = parameters.get("RC3_MIN", 1000.0), parameters.get("RC3_MAX", 2000.0)
    return Throttle(t.channels[channel - 1], least if own else 1000.0, most if own else 2000.0)


def live(now: float, t: Telemetry, parameters: Mapping[str, float], hands: PilotHands) -> bool:
    """Whether somebody holds the transmitter: its sticks move, or the throttle is not at the bottom.

    A receiver without a transmitter, and software in the loop, report healthy channels with the throttle low.
    """
    if not fresh(now, t):
        return False
    stick = throttle(now, t, parameters)
    raised = stick is not None and stick.pulse > stick.least + LOW * (stick.most - stick.least)
    return raised or hands.moving(now)


def flown_by_hand(t: Telemetry) -> bool:
    """Whether the vehicle is in a mode in which the sticks move it."""
    return t.mode in FLOWN_BY_HAND.get(t.kind, frozenset())
