"""What the pilot is told: the game as its setup says, the own state, and tracks."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.pilot.kalman import Variance


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
    height: float = 0.0  # [m above the origin] of its place: plane games are flown there; NaN: as it is


class GameSetup(NamedTuple):
    """The game as one pilot knows it; a pursuer knows the target only where the rules say so."""

    roster: tuple[Player, ...]
    rules: Rules
    control: Control = Control()
    target: Target = NO_TARGET

    def player(self, id: int) -> Player | None:
        """The roster's entry of a vehicle."""
        return next((player for player in self.roster if player.id == id), None)

    def opponents(self, side: Side) -> tuple[Player, ...]:
        """Everybody on the other side."""
        return tuple(player for player in self.roster if player.side is not side)


class Own(NamedTuple):
    """The own vehicle now, and the air around it."""

    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    wind: Vec = ZERO  # [m/s; NED, where the air moves to]; ZERO for multicopters
    nose: Vec = ZERO  # where a plane's nose points (unit); ZERO: not known, or a multicopter


class TrackSample(NamedTuple):
    """One measurement of an opponent."""

    id: int
    t: float  # the instant it is of [s]; the clock of `now`
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    variance: Variance  # a negative velocity variance: velocity not measured
