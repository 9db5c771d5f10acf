"""What the pilot is told: the game as its setup says, own state, tracks and team mates."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.pilot.track_filter import Variance


class Side(Enum):
    """Roles a pilot can think in."""

    EVADER = "evader"
    PURSUER = "pursuer"


class Player(NamedTuple):
    """One vehicle of the roster."""

    id: int
    side: Side
    speed: float  # [m/s; air] declared maximum; 0 = not declared
    limits: VehicleLimits = VehicleLimits()
    height: float = 0.0  # of its staging place above the origin [m]; plane games are flown there


class GameSetup(NamedTuple):
    """The game as one pilot knows it; the target only where it is the evader."""

    roster: tuple[Player, ...]
    R: float  # capture radius [m]
    rho: float  # safety distance ρ [m]
    lambda_: float = 100.0
    beta: float = 1.0
    separation: float = 0.0  # [m]; 0 = off
    planar: bool = False
    has_target: bool = False
    target: Vec = ZERO  # [m; NED]
    dt: float = 0.05  # control step [s]
    lookahead: float = 1.0  # of rule 6's alternative [s]

    def player(self, id: int) -> Player | None:
        """The roster's entry of a vehicle."""
        return next((player for player in self.roster if player.id == id), None)

    def opponents(self, side: Side) -> tuple[Player, ...]:
        """Everybody on the other side."""
        return tuple(player for player in self.roster if player.side is not side)


class Own(NamedTuple):
    """The own vehicle now."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]


class TrackSample(NamedTuple):
    """One measurement of an opponent."""

    id: int
    t: float  # the instant it is of [s]; the clock of `now`
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    variance: Variance  # a negative velocity variance: velocity not measured


class MateState(NamedTuple):
    """What a team mate said of itself."""

    id: int
    t: float  # when [s]; the clock of `now`
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
