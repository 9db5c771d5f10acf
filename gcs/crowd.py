"""Whether many who hold, abort or return at once keep apart: a roster, as its vehicles report themselves.

Ways home cross wherever they may, so their heights differ by the separation; circles of planes that hold at
one height lie apart, or the game is flown in layers. One line for each vehicle.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from typing import NamedTuple

from onboard.core.math.vectors import Vec
from onboard.core.safety.field_profile import SPACING, layers
from onboard.game.scenario import Scenario
from onboard.game.staging import flown
from onboard.wire.bus.messages import Health

LEAST = 5.0  # [m] between heights where the scenario names no separation: what barometers may differ by


class Seat(NamedTuple):
    """One vehicle of the roster, as far as keeping apart goes."""

    id: int
    place: Vec  # [m; NED] at t₀
    health: Health | None  # None: not heard

    @property
    def height(self) -> float:
        """Of its game above the origin [m]."""
        return -self.place.z


class Line(NamedTuple):
    """What is said of one vehicle."""

    id: int
    well: bool
    text: str


def seats_of(scenario: Scenario, heard: Mapping[int, Health | None]) -> list[Seat]:
    """The roster with what was heard; in the field profile each at the height of its layer."""
    places = [flown(scenario, spec.start()) for spec in scenario.vehicles]
    if scenario.flight.field_profile:
        heights = layers(tuple(-place.z for place in places))
        places = [Vec(p.x, p.y, -height) for p, height in zip(places, heights, strict=True)]
    return [Seat(id, place, heard.get(id)) for id, place in zip(scenario.ids, places, strict=True)]


def compare(scenario: Scenario, heard: Mapping[int, Health | None]) -> list[Line]:
    """One line for each vehicle, in the roster's order."""
    seats = seats_of(scenario, heard)
    gap = max(LEAST, scenario.rules.separation)
    return [_line(seat, [other for other in seats if other.id != seat.id], gap) for seat in seats]


def _line(seat: Seat, others: list[Seat], gap: float) -> Line:
    health = seat.health
    if health is None or health.autopilot is None:
        return Line(seat.id, False, "not heard" if health is None else "no autopilot found")
    faults = [fault for other in others if other.health is not None for fault in _between(seat, other, gap)]
    known = health.return_m >= 0.0
    home = f"returns at {health.return_m:g} m" if known else "returns as high as it is, or says no height"
    circle = f", holds in a circle of {health.loiter_m:g} m" if health.loiter_m else ""
    return Line(seat.id, not faults, "; ".join([home + circle, *faults]))


def _between(seat: Seat, other: Seat, gap: float) -> list[str]:
    """What is wrong between two vehicles."""
    faults = []
    own, theirs = seat.health, other.health
    assert own is not None and theirs is not None  # noqa: PT018
    if abs(_return_height(seat) - _return_height(other)) < gap:
        faults.append(f"as vehicle {other.id}, within {gap:g} m: set RTL heights that differ by {gap:g} m")
    apart = hypot(seat.place.x - other.place.x, seat.place.y - other.place.y)
    room = 2.0 * (own.loiter_m + theirs.loiter_m) + gap  # a circle lies anywhere about where it was begun
    both = own.loiter_m > 0.0 and theirs.loiter_m > 0.0
    if both and apart < room and abs(seat.height - other.height) < min(SPACING, 2.0 * gap):
        faults.append(
            f"its circle may meet that of vehicle {other.id}, {apart:.0f} m away at one height: "
            "field_profile = true, or heights of their own"
        )
    return faults


def _return_height(seat: Seat) -> float:
    """Of the way home above the origin, as far as is known [m]: never lower than the game is flown."""
    assert seat.health is not None
    return max(seat.health.return_m, seat.height)
