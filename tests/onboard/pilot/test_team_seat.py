"""Who plans, whose plan counts, and what becomes of it when planner or bus are gone. No loop, no bus."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from onboard.core.game.rules import Rules, Target
from onboard.core.math.states import Mate, Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.team.plan_types import IDLE, Heights, Reason, Role
from onboard.core.strategy.team.planner import EVERY
from onboard.pilot.setup import GameSetup, Own, Player, Side
from onboard.pilot.team_seat import LEASE_S, OLD_S, Field, Known, TeamSeat

TEAM = (2, 3, 5)
TARGET = Vec(4000.0, 0.0, -500.0)
PLACES = {2: Vec(3800.0, 0.0, -500.0), 3: Vec(200.0, 900.0, -500.0), 5: Vec(-800.0, 0.0, -500.0)}
LIMITS = VehicleLimits(25.0, 45.0)


def setup(known: bool = True) -> GameSetup:
    evader = Player(1, Side.EVADER, 50.0, VehicleLimits(30.0, 55.0, -0.2, 0.2))
    players = tuple(Player(id, Side.PURSUER, 40.0, LIMITS) for id in TEAM)
    rules = Rules(25.0, 88.0, target_known=known)
    return GameSetup((evader, *players), rules, target=Target(True, TARGET))


@dataclass
class Squadron:
    """Seats that hear each other where `reach` says so, with states and plans that never age on the way."""

    now: float = 0.0
    game: GameSetup = field(default_factory=setup)
    silent: set[int] = field(default_factory=set)  # nobody hears them, they hear nobody
    unfit: set[int] = field(default_factory=set)
    blind: set[int] = field(default_factory=set)  # without a track of the evader
    heard_at: dict[int, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        field_ = Field(self.game, TEAM, Heights(300.0, 3000.0), 5.0)
        self.seats = {id: TeamSeat(id, field_) for id in TEAM}

    def planners(self, seconds: float) -> list[int]:
        """Let time pass in steps of 50 ms; who made plans, in order."""
        made = []
        for _ in range(round(seconds / 0.05)):
            self.now += 0.05
            for id in TEAM:
                if id not in self.silent:
                    self.heard_at[id] = self.now
            for id, seat in self.seats.items():
                plan = seat.work(self.known(id))
                if plan is None:
                    continue
                made.append(id)
                for other, theirs in self.seats.items():
                    if other != id and not {id, other} & self.silent:
                        theirs.heard(plan)
        return made

    def known(self, id: int) -> Known:
        mates = tuple(
            Mate(other, PLACES[other], ZERO, self.now - self.heard_at.get(other, -99.0))
            for other in TEAM
            if other != id and id not in self.silent
        )
        evader = None if id in self.blind else Vehicle(Vec(0.0, 0.0, -500.0), Vec(50.0, 0.0, 0.0), 50.0)
        own = Own(PLACES[id], Vec(40.0, 0.0, 0.0))
        unfit = frozenset(self.unfit)
        return Known(self.now, self.now, own, id not in self.unfit, mates, unfit, evader)

    def roles(self, id: int) -> list[Role]:
        dated = self.seats[id].counts(self.now)
        return [] if dated is None else [part.role for part in dated.plan.assignments]


def test_the_lowest_id_plans_twice_a_second_and_all_fly_by_its_plan() -> None:
    team = Squadron()
    assert team.planners(4.0) == [2] * round(4.0 / EVERY)
    parts = {id: team.seats[id].part(team.now) for id in TEAM}
    assert parts[2].role is Role.GOALKEEPER  # it alone is at the target first
    assert parts[2].reason is Reason.FIRST_AT_TARGET
    assert parts[5].role is Role.CHASER
    assert team.roles(2) == team.roles(3) == team.roles(5)


@pytest.mark.parametrize("how", ["silent", "unfit"])
def test_the_next_one_plans_when_the_planner_is_lost_and_hands_its_post_over(how: str) -> None:
    team = Squadron()
    team.planners(2.0)
    getattr(team, how).add(2)
    later = team.planners(LEASE_S + 2.0)
    after = [id for id in later if id != 2]
    assert set(after) == {3}
    assert len(after) >= 3
    dated = team.seats[5].counts(team.now)
    assert dated is not None
    assert dated.planner == 3
    assert dated.plan.assignments[0].role is Role.RESERVE
    assert dated.plan.assignments[0].reason is Reason.LOST


def test_who_comes_back_plans_again() -> None:
    team = Squadron()
    team.planners(2.0)
    team.silent.add(2)
    team.planners(4.0)
    team.silent.clear()
    assert set(team.planners(4.0)[6:]) == {2}
    assert team.seats[5].counts(team.now).planner == 2  # type: ignore[union-attr]


def test_cut_off_it_flies_on_the_last_plan_and_then_alone() -> None:
    team = Squadron()
    team.planners(2.0)
    role = team.seats[5].part(team.now).role
    team.silent.add(5)
    team.planners(LEASE_S + 2.0)
    assert team.seats[5].part(team.now).role is role
    assert team.seats[3].part(team.now).role is not Role.RESERVE  # the others know that it is lost
    team.planners(OLD_S)
    assert team.seats[5].part(team.now) == IDLE
    assert team.seats[3].counts(team.now) is not None


def test_who_hears_nobody_plans_for_nobody() -> None:
    team = Squadron()
    team.planners(2.0)
    team.silent |= {3, 5}
    assert set(team.planners(OLD_S + 1.0)[2:]) == set()
    assert {team.seats[id].part(team.now) for id in TEAM} == {IDLE}


def test_a_plan_of_another_team_is_no_plan() -> None:
    team = Squadron()
    team.planners(1.0)
    mine = team.seats[2].counts(team.now)
    assert mine is not None
    stranger = TeamSeat(3, Field(team.game, (3, 5), Heights(), 5.0))
    stranger.heard(mine)
    assert stranger.counts(team.now) is None


def test_a_target_that_the_rules_keep_secret_is_guarded_by_nobody() -> None:
    team = Squadron(game=setup(known=False))
    team.planners(2.0)
    assert Role.GOALKEEPER not in team.roles(3)


def test_a_plan_that_was_overtaken_on_its_way_does_not_count() -> None:
    team = Squadron()
    team.planners(1.0)
    old = team.seats[2].counts(team.now)
    team.planners(1.0)
    new = team.seats[3].counts(team.now)
    assert old is not None
    assert new is not None
    team.seats[3].heard(old._replace(at=team.now))
    assert team.seats[3].counts(team.now) == new


def test_a_planner_without_a_track_lets_its_plans_lapse_and_the_next_one_takes_over() -> None:
    team = Squadron()
    team.planners(2.0)
    team.blind.add(2)
    assert set(team.planners(4.0)) == {3}
    assert team.roles(5)[0] is Role.GOALKEEPER  # it flies on as the plan says
    team.blind.add(3)
    assert set(team.planners(6.0)[-2:]) == {5}
    team.blind.clear()
    assert set(team.planners(2.0)[2:]) == {2}
