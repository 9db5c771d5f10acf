"""One pursuer's seat in its team: it plans where the plan is its to make, and knows the plan that counts.

One planner by lease: the member with the lowest id that is fit, was heard within `LEASE_S` and makes plans.
Whoever becomes the planner goes on from the plan that it heard last. The plan that counts is the one of the
lowest planner among those heard within `LEASE_S`, else the newest; older than `OLD_S` none counts, and a
pursuer chases alone. Who hears no mate at all plans for nobody: it is cut off, and flies on the last plan. No
input and no output.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import inf
from typing import NamedTuple

from onboard.core.game.rules import NO_TARGET, Target
from onboard.core.game.views import level, told
from onboard.core.math.states import Mate, Vehicle, VehicleLimits
from onboard.core.math.vectors import Vec, sub
from onboard.core.strategy.team.plan_types import (
    IDLE,
    NOBODY,
    OPEN,
    Assignment,
    Band,
    Heights,
    Margin,
    Member,
    Plan,
    Situation,
    nearest_staged,
)
from onboard.core.strategy.team.planner import EVERY, Planner, engaged, no_plan, plan
from onboard.core.strategy.team.quarry import Quarry, quarries_of
from onboard.pilot.setup import Crowd, GameSetup, Own, Side

LEASE_S = 1.0  # for which a member's or a planner's last word counts
OLD_S = 5.0  # beyond which a plan is no plan
DELAY_S = 0.17  # from a measurement to the pursuers' answer to it: a sensor's 0.12 s and a control step


class Known(NamedTuple):
    """What one member knows when it looks at its team."""

    now: float  # [s, monotonic]
    t: float  # [s] since t0
    own: Own
    fit: bool  # itself
    mates: tuple[Mate, ...]  # carried forward to now
    unfit: frozenset[int]  # mates that say that they do not follow the game
    evader: Vehicle | None  # through the air; None: no track of it
    crowd: Callable[[], Crowd] | None = None  # tells of everybody, where there are several evaders


class Field(NamedTuple):
    """What stays the same through a game."""

    game: GameSetup
    team: tuple[int, ...]  # ids of the members, in the roster's order
    heights: Heights
    sigma: float  # stated error of the evader's track [m]
    planner: Planner = engaged  # what the team does once the evader has set out


class Dated(NamedTuple):
    """A plan, and when it came."""

    planner: int
    plan: Plan  # of several evaders: with the widest of their bands
    at: float  # [s, monotonic]
    quarries: tuple[int, ...] = ()  # of several evaders: ids of whom each member is after, 0 = nobody
    bands: tuple[tuple[int, Band], ...] = ()  # of several evaders: each one's, by its id


class Thought(NamedTuple):
    """What a plan against one evader was made of."""

    evader: int  # id
    situation: Situation
    before: Plan
    made: Plan


class TeamSeat:
    """The seat of vehicle `id`."""

    def __init__(self, id: int, field: Field) -> None:
        self.id = id
        self.field = field
        self._heard: dict[int, Dated] = {}  # by planner
        self._planned_at = -1e9
        self._began = inf  # when it first looked at its team
        self.thoughts: tuple[Thought, ...] = ()  # of the last plan of its own

    def heard(self, dated: Dated) -> None:
        """A mate's plan came; one of another team is left out, and one overtaken."""
        planner, made = dated.planner, dated.plan
        before = self._heard.get(planner)
        overtaken = before is not None and made.time < before.plan.time
        if planner in self.field.team and len(made.assignments) == len(self.field.team) and not overtaken:
            self._heard[planner] = dated

    def counts(self, now: float) -> Dated | None:
        """The plan that counts at `now` [s, monotonic]; None where there is none, or only an old one."""
        fresh = [dated for dated in self._heard.values() if now - dated.at <= LEASE_S]
        if fresh:
            return min(fresh, key=lambda dated: dated.planner)
        newest = max(self._heard.values(), key=lambda dated: dated.at, default=None)
        return newest if newest is not None and now - newest.at <= OLD_S else None

    def part(self, now: float) -> Assignment:
        """The own part of the plan that counts; IDLE where none does: then it chases alone."""
        dated = self.counts(now)
        if dated is None or self.id not in self.field.team:
            return IDLE
        return dated.plan.assignments[self.field.team.index(self.id)]

    def turn(self, known: Known) -> bool:
        """Whether the plan is this member's to make now.

        It is where no lower id is fit, or where those have let their plans lapse: a planner that has lost
        the track, say. The next one waits for twice the lease, the one after it for twice as long."""
        team = self.field.team
        heard = {m.id for m in known.mates if m.age <= LEASE_S and m.id in team}
        cut_off = not heard and team != (self.id,)  # the others may well fly by a plan
        if cut_off or not known.fit or self.id not in team:
            return False
        lower = [id for id in heard - known.unfit if id < self.id]
        last = max((dated.at for dated in self._heard.values() if dated.planner < self.id), default=0.0)
        return not lower or known.now - max(last, self._began) > 2.0 * LEASE_S * len(lower)

    def work(self, known: Known) -> Dated | None:
        """Make a plan where one is due and it is this member's to make; it counts at once."""
        self._began = min(self._began, known.now)
        due = known.now - self._planned_at >= EVERY - 1e-6
        if not due or known.evader is None or not self.turn(known):
            return None
        self._planned_at = known.now
        situation = situation_of(self.id, self.field, known, known.evader)
        newest = max(self._heard.values(), key=lambda dated: dated.at, default=None)
        if newest is None:
            newest = Dated(self.id, no_plan(situation.team, known.t), known.now)
        if known.crowd is None:
            before = newest.plan
            made = Dated(self.id, plan(situation, before, self.field.planner), known.now)
            evading = next((p.id for p in self.field.game.opponents(Side.PURSUER)), 0)
            self.thoughts = (Thought(evading, situation, before, made.plan),)
        else:
            made = self._against_all(situation, newest, known, known.crowd())
        self._heard[self.id] = made
        return made

    def _against_all(self, situation: Situation, before: Dated, known: Known, crowd: Crowd) -> Dated:
        """A plan against several evaders: a quarry for each member, and for each quarry a plan of its own."""
        game, team = self.field.game, situation.team
        evaders = tuple(player.id for player in game.opponents(Side.PURSUER))
        number = {id: index for index, id in enumerate(evaders)}
        previous = tuple(number.get(id, NOBODY) for id in before.quarries) or (NOBODY,) * len(team)
        given = quarries_of(team, crowd.quarries, previous, game.rules, game.rules.horizon - known.t)
        bands = dict(before.bands)
        plans: dict[int, Plan] = {}
        thoughts = []
        for index, quarry in enumerate(crowd.quarries):
            if quarry.live:
                mine = tuple(m._replace(fit=m.fit and q == index) for m, q in zip(team, given, strict=True))
                alone = against(situation, quarry, mine, targets_told(game, evaders[index]))
                last = before.plan._replace(band=bands.get(evaders[index], OPEN))
                plans[index] = plan(alone, last, self.field.planner)
                thoughts.append(Thought(evaders[index], alone, last, plans[index]))
        if not plans:
            return before._replace(planner=self.id, at=known.now)
        self.thoughts = tuple(thoughts)
        whole = max(plans.values(), key=lambda one: (not one.band.closed, one.band.gap))
        parts = tuple(plans.get(q, whole).assignments[i] for i, q in enumerate(given))
        ids = tuple(0 if q == NOBODY else evaders[q] for q in given)
        each = tuple((evaders[index], one.band) for index, one in plans.items())
        return Dated(self.id, whole._replace(assignments=parts), known.now, ids, each)


def targets_told(game: GameSetup, evader: int) -> tuple[Target, ...]:
    """An evader's targets as its pursuers know them; one that does not exist where they know none."""
    planar = game.rules.planar
    known = (told(one, game.rules) for one in game.targets_of(evader))
    found = tuple(one._replace(position=level(one.position, planar)) for one in known)
    return found or (NO_TARGET,)


def against(
    situation: Situation, quarry: Quarry, team: tuple[Member, ...], targets: tuple[Target, ...]
) -> Situation:
    """The situation of those who are after one of several evaders."""
    return situation._replace(
        evader=quarry.vehicle, evader_limits=quarry.limits, target=quarry.target, team=team,
        expected=quarry.vehicle.position, targets=targets,
    )  # fmt: skip


def situation_of(id: int, field: Field, known: Known, evader: Vehicle) -> Situation:
    """The situation that a planner reckons with, in the moving air."""
    game, planar = field.game, field.game.rules.planar
    wind = level(known.own.wind, planar)

    def there(position: Vec, velocity: Vec, speed: float) -> Vehicle:
        return Vehicle(level(position, planar), sub(level(velocity, planar), wind), speed)

    mates: Mapping[int, Mate] = {mate.id: mate for mate in known.mates}
    team = []
    for member in field.team:
        player = game.player(member)
        limits = VehicleLimits() if player is None else player.limits
        speed = 0.0 if player is None else player.speed
        if member == id:
            own = there(known.own.position, known.own.velocity, speed)
            team.append(Member(own, limits, known.fit))
        elif member in mates:
            mate = mates[member]
            fit = mate.age <= LEASE_S and member not in known.unfit
            team.append(Member(there(mate.position, mate.velocity, speed), limits, fit))
        else:
            team.append(Member(there(known.own.position, known.own.velocity, speed), limits, False))
    evading = next(iter(game.opponents(Side.PURSUER)), None)
    return Situation(
        known.t,
        0.0,
        evader,
        VehicleLimits() if evading is None else evading.limits,
        tuple(team),
        told(game.target, game.rules),
        wind,
        game.rules,
        field.heights,
        Margin(DELAY_S, field.sigma),
        evader.position,
        nearest_staged(game.rules),
        targets_told(game, evading.id) if evading is not None and game.goals else (NO_TARGET,),
    )
