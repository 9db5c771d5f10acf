"""Which of several evaders a pursuer is after, and which target each of them is taken to go for.

The assignment is the core's (`core/strategy/team/quarry`), from the tracks and from what mates say of
themselves, made twice a second and at once where a quarry leaves the game. By a team's plan it is the
planner's; who flies by none makes it for everybody, and keeps to its own part. No input and no output.
"""

from __future__ import annotations

from collections.abc import Mapping

from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.game.targets import NONE, at, chosen
from onboard.core.game.views import level, told
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.states import FREE, Mate, Vehicle
from onboard.core.math.vectors import Vec, sub
from onboard.core.strategy.team.plan_types import NOBODY, Member
from onboard.core.strategy.team.quarry import Quarry, quarries_of
from onboard.pilot.memory import Memory
from onboard.pilot.setup import Crowd, GameSetup, Own, Player, Side

EVERY = 0.5  # [s] between two assignments, as between two plans
HEARD_S = 1.0  # a mate's last word counts for so long
UNSEEN = Quarry(Vehicle(Vec(0.0, 0.0, 0.0), Vec(0.0, 0.0, 0.0), 0.0), FREE, False, NO_TARGET)


class Hunt:
    """A pursuer's choice in games of several evaders."""

    def __init__(self, id: int, game: GameSetup) -> None:
        self.id = id
        self.evaders = game.opponents(Side.PURSUER)
        self.ids = frozenset(player.id for player in self.evaders)
        self.pursuers = game.opponents(Side.EVADER)
        self.out: frozenset[int] = frozenset()  # evaders whose game is over
        self.unfit: frozenset[int] = frozenset()  # mates that say that they do not
        self.planned: Mapping[int, int] = {}  # by the plan that counts: pursuer → evader
        self.planner = 0  # whose plan that is
        self.left = game.rules.horizon  # how long the game still lasts [s]
        self.quarry = 0  # id of the own evader; 0 = nobody's
        self.why = ""  # in words
        self._given: dict[int, int] = {}  # pursuer → evader, by the last assignment of its own
        self._aims: dict[int, int] = {}  # evader → number of the target that it is taken to go for
        self._at = -1e9

    @property
    def together(self) -> frozenset[int]:
        """The pursuers that are after the same evader, itself among them."""
        given = {**self._given, **self.planned}
        return frozenset(id for id, quarry in given.items() if quarry == self.quarry) | {self.id}

    def target_of(self, evader: int, game: GameSetup) -> Target:
        """The target that an evader is taken to go for [m; NED, on the ground]; see `told`."""
        return at(game.targets_of(evader), self._aims.get(evader, NONE))

    def choose(self, now: float, own: Own, mates: tuple[Mate, ...], game: GameSetup, memory: Memory) -> bool:
        """Look at `now` [s] whether another evader is to be gone for; whether it is another one now."""
        lost = self.quarry in self.out or self.quarry == 0
        planned = self.planned.get(self.id, 0)
        if planned in self.out:  # its plan is older than that
            planned = 0
        if not lost and now - self._at < EVERY - 1e-6 and planned in (0, self.quarry):
            return False
        self._at = now
        crowd = self.crowd(now, own, mates, game, memory)
        by_plan = planned != 0
        if not by_plan:
            self._given = self.assigned(crowd, self._given, game)
        before = self.quarry
        kept = 0 if before in self.out else before  # without a track of anybody it stays with its own
        mine = self._given.get(self.id) or kept
        self.quarry = planned if by_plan else mine
        if len(self.evaders) > 1:
            whose = f"in the plan of {self.planner}" if by_plan else "by its own reckoning"
            self.why = f"after evader {self.quarry} {whose}" if self.quarry else ""
        return self.quarry != before

    def assigned(self, crowd: Crowd, before: Mapping[int, int], game: GameSetup) -> dict[int, int]:
        """Everybody's evader, by pursuer; who is lost has none."""
        number = {player.id: index for index, player in enumerate(self.evaders)}
        previous = tuple(number.get(before.get(player.id, 0), NOBODY) for player in self.pursuers)
        found = quarries_of(crowd.team, crowd.quarries, previous, game.rules, self.left)
        pairs = zip(self.pursuers, found, strict=True)
        return {player.id: self.evaders[index].id for player, index in pairs if index != NOBODY}

    def crowd(
        self, now: float, own: Own, mates: tuple[Mate, ...], game: GameSetup, memory: Memory
    ) -> Crowd:
        """Everybody at `now` [s], each evader with the target that it is taken to go for."""
        planar, wind = game.rules.planar, level(own.wind, game.rules.planar)

        me = game.player(self.id)
        own_speed = 0.0 if me is None else me.speed

        def there(position: Vec, velocity: Vec, speed: float) -> Vehicle:
            return Vehicle(level(position, planar), sub(level(velocity, planar), wind), speed or own_speed)

        heard = {mate.id: mate for mate in mates if mate.age <= HEARD_S and mate.id not in self.unfit}
        team = []
        for player in self.pursuers:
            mate = heard.get(player.id)
            if player.id == self.id:  # it asks: whatever it is to others, it needs a quarry
                team.append(Member(there(own.position, own.velocity, player.speed), player.limits, True))
            elif mate is None:
                team.append(Member(there(own.position, own.velocity, player.speed), player.limits, False))
            else:
                vehicle = there(mate.position, mate.velocity, player.speed)
                team.append(Member(vehicle, player.limits, True))
        flying = tuple(member.vehicle for member in team if member.fit)
        quarries = (self._quarry(player, now, flying, wind, game, memory) for player in self.evaders)
        return Crowd(tuple(team), tuple(quarries))

    def _quarry(
        self, player: Player, now: float, team: tuple[Vehicle, ...], wind: Vec, game: GameSetup,
        memory: Memory,
    ) -> Quarry:  # fmt: skip
        seen = None if player.id in self.out else memory.predict(player.id, now)
        if seen is None:
            return UNSEEN
        planar = game.rules.planar
        velocity = sub(level(seen.velocity, planar), wind)
        speed = player.speed if player.speed > 0.0 else memory.top_speed(player.id, now, velocity)
        vehicle = Vehicle(level(seen.position, planar), velocity, speed)
        goals = levelled(game.targets_of(player.id), planar)
        cones = blocked_cones(vehicle, team, game.rules.rho)
        before = self._aims.get(player.id, NONE)
        self._aims[player.id] = chosen(vehicle, player.limits, cones, goals, planar, before)
        return Quarry(vehicle, player.limits, True, told(at(goals, self._aims[player.id]), game.rules))


def levelled(targets: tuple[Target, ...], planar: bool) -> tuple[Target, ...]:
    """Targets as the game counts them."""
    return tuple(target._replace(position=level(target.position, planar)) for target in targets)


def hunt_of(id: int, game: GameSetup) -> Hunt | None:
    """A pursuer's choice; None where there is none: one evader, of whom it knows one target at most."""
    several = len(game.opponents(Side.PURSUER)) > 1 or any(len(goal.targets) > 1 for goal in game.goals)
    return Hunt(id, game) if several else None
