"""The table of a vehicle in a scenario file: who plays, from where, within which limits, how simulated."""

from __future__ import annotations

from enum import Enum
from typing import Annotated

import msgspec

from onboard.config.bounds import (
    Coordinate,
    PitchDeg,
    PositiveAcceleration,
    Speed,
    SystemId,
    TurnRateDeg,
    YawDeg,
)
from onboard.config.derive import Key, core_from, struct_from
from onboard.config.strict import StrictConfig, demand
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import Vec

Point = Annotated[tuple[Coordinate, ...], msgspec.Meta(min_length=2, max_length=3)]


Targets = Annotated[tuple[Point, ...], msgspec.Meta(max_length=8, description="at most 8 targets")]


class Kind(Enum):
    """Which autopilot flies a vehicle."""

    PX4 = "px4"
    PX4_PLANE = "px4-plane"
    ARDUCOPTER = "arducopter"
    ARDUPLANE = "arduplane"


WINGED = frozenset((Kind.ARDUPLANE, Kind.PX4_PLANE))
"""The kinds that fly planes."""


class AirframeKind(Enum):
    """How a simulated vehicle moves."""

    KINEMATIC = "kinematic"  # (7)–(8) with limited turn rate, climb angle and acceleration
    NOSE = "nose"
    SLIP = "slip"
    COORDINATED = "coordinated"


LIMIT_KEYS = {
    "speed_min": Key(Speed),
    "speed_max": Key(Speed, None),  # `speed` where it is not given
    "pitch_min": Key(PitchDeg, degrees=True),
    "pitch_max": Key(PitchDeg, degrees=True),
    "yaw_min": Key(YawDeg, degrees=True),
    "yaw_max": Key(YawDeg, degrees=True),
    "turn_rate": Key(TurnRateDeg, 60.0, degrees=True),
}
"""How a vehicle's table writes the core's VehicleLimits."""


DEFAULT_ACCELERATION = 4.0  # [m/s²]


class Player(StrictConfig, frozen=True):
    """Who plays and from where."""

    position: Point  # [m] where it starts
    speed: Speed  # [m/s; air] what the game reckons with
    id: SystemId | None = None  # evader 1, pursuers from 2 where not given
    strategy: str = ""  # "" = the default: paper for evaders, parallel-pursuit for pursuers
    target: Point | None = None  # an evader's alone
    targets: Targets = ()  # an evader's alone, in place of `target`: reaching any of them counts
    heading_deg: YawDeg | None = None  # at the start; None = towards the target or the evader


class VehicleSpec(struct_from(VehicleLimits, Player, LIMIT_KEYS)):  # type: ignore[misc]
    """One vehicle: who plays, its limits, and how it is simulated. Angles in degrees."""

    acceleration: PositiveAcceleration = DEFAULT_ACCELERATION  # [m/s²] of the kinematic airframe
    autopilot: Kind | None = None  # None = the scenario's
    airframe: AirframeKind | None = None  # None = the scenario's
    tracked: bool = False  # the evader's alone: known by tracks, flown by no agent

    def __post_init__(self) -> None:
        speed, fastest = self.speed, self.speed_max
        demand(self.speed_min <= speed, "speed_min", self.speed_min, f"0 to speed = {speed:g} m/s")
        demand(fastest is None or fastest >= speed, "speed_max", fastest, f"at least speed = {speed:g} m/s")
        for angle in ("pitch", "yaw"):
            low, high = getattr(self, f"{angle}_min_deg"), getattr(self, f"{angle}_max_deg")
            demand(low <= high, f"{angle}_min_deg", f"{low:g} with {angle}_max_deg {high:g}", "min ≤ max")
        demand(self.target is None or not self.targets, "targets", f"{len(self.targets)} beside target",
               "either of them")  # fmt: skip
        demand(len(set(self.targets)) == len(self.targets), "targets", list(self.targets),
               "places that differ")  # fmt: skip

    def start(self) -> Vec:
        """Start in the game frame."""
        return vec(self.position)

    def limits(self) -> VehicleLimits:
        """(2)–(3) for the core [rad]."""
        fastest = self.speed if self.speed_max is None else self.speed_max
        return core_from(self, VehicleLimits, LIMIT_KEYS, speed_max=fastest)


def vec(point: Point) -> Vec:
    """A scenario's point in the game frame: height becomes down."""
    return Vec(point[0], point[1], -point[2] if len(point) == 3 else 0.0)


def targets_of(spec: VehicleSpec) -> tuple[Vec, ...]:
    """An evader's targets in the game frame: none, `target`, or `targets`."""
    points = spec.targets if spec.target is None else (spec.target,)
    return tuple(map(vec, points))
