"""What the pilot is told: the game as its setup says, the own state, and tracks."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.team.plan_types import Member
from onboard.core.strategy.team.quarry import Quarry
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


class Goals(NamedTuple):
    """Where one evader goes: to any of its targets."""

    evader: int
    targets: tuple[Target, ...]


class GameSetup(NamedTuple):
    """The game as one pilot knows it; a pursuer knows targets only where the rules say so."""

    roster: tuple[Player, ...]
    rules: Rules
    control: Control = Control()
    target: Target = NO_TARGET  # of the only evader with one target
    goals: tuple[Goals, ...] = ()  # of several evaders, or of one with several targets: as far as known

    def with_targets(self, evader: int, places: tuple[Vec, ...]) -> GameSetup:
        """The game as an evader knows it that was told its own targets [m; NED]."""
        targets = tuple(Target(True, place) for place in places)
        several = len(targets) > 1 or len(self.opponents(Side.PURSUER)) > 1
        goals = (Goals(evader, targets),) if several else ()
        return self._replace(target=targets[0] if targets else NO_TARGET, goals=goals)

    def targets_of(self, evader: int) -> tuple[Target, ...]:
        """An evader's targets, as far as they are known."""
        for goals in self.goals:
            if goals.evader == evader:
                return goals.targets
        alone = len(self.opponents(Side.PURSUER)) == 1
        return (self.target,) if alone and self.target.exists else ()

    def player(self, id: int) -> Player | None:
        """The roster's entry of a vehicle."""
        for player in self.roster:
            if player.id == id:
                return player
        return None

    def opponents(self, side: Side) -> tuple[Player, ...]:
        """Everybody on the other side."""
        return tuple(player for player in self.roster if player.side is not side)


class Crowd(NamedTuple):
    """Everybody as one pursuer knows them at an instant, through the air."""

    team: tuple[Member, ...]  # the pursuers, in the roster's order
    quarries: tuple[Quarry, ...]  # the evaders, in the roster's order; not `live`: out, or without a track


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
