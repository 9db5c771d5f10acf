"""Whom a pursuer is after where there are several evaders, and what it then sees."""

from __future__ import annotations

import pytest

from onboard.core.game.rules import Rules, Target
from onboard.core.game.views import PursuerView
from onboard.core.math.states import Mate
from onboard.core.math.vectors import Vec
from onboard.pilot.hunt import EVERY, Hunt, hunt_of
from onboard.pilot.memory import Memory
from onboard.pilot.pilot import PilotDecision, Question, Viewpoint
from onboard.pilot.predictor_choice import Predicting
from onboard.pilot.setup import GameSetup, Goals, Own, Player, Side, TrackSample

NORTH_ONE, SOUTH_ONE = 1, 9  # evaders, 400 m apart
ROSTER = (
    Player(NORTH_ONE, Side.EVADER, 5.0),
    *(Player(id, Side.PURSUER, 4.0) for id in (2, 3, 4)),
    Player(SOUTH_ONE, Side.EVADER, 5.0),
)
TARGETS = {
    NORTH_ONE: (Vec(200.0, 300.0, 0.0), Vec(200.0, -300.0, 0.0)),
    SOUTH_ONE: (Vec(-200.0, 900.0, 0.0),),  # it has farther to go: the others get the spare pursuer
}
GAME = GameSetup(
    ROSTER,
    Rules(R=2.0, rho=4.0, horizon=100.0, planar=True, target_known=True),
    goals=tuple(Goals(id, tuple(Target(True, at) for at in places)) for id, places in TARGETS.items()),
)
EAST = Vec(0.0, 5.0, 0.0)
PLACES = {2: Vec(210.0, 100.0, 0.0), 3: Vec(190.0, 100.0, 0.0), 4: Vec(-200.0, 100.0, 0.0)}


class Chase:
    """Pursuer 2's hunt, on tracks of both evaders that fly east."""

    def __init__(self, game: GameSetup = GAME) -> None:
        self.game = game
        self.hunt = Hunt(2, game)
        self.memory = Memory(Predicting.CONSTANT_VELOCITY)
        self.now = 0.0
        self.silent: set[int] = set()
        self.tracked = {NORTH_ONE, SOUTH_ONE}
        self.places = dict(PLACES)

    def sample(self, id: int) -> TrackSample:
        at = Vec(200.0 if id == NORTH_ONE else -200.0, 5.0 * self.now, 0.0)
        return TrackSample(id, self.now, at, EAST, (0.01,) * 6)

    def go(self, seconds: float) -> None:
        """Let time pass, a look each 50 ms."""
        for _ in range(round(seconds / 0.05)):
            self.now += 0.05
            self.memory.take(tuple(self.sample(id) for id in sorted(self.tracked)))
            self.hunt.left = 100.0 - self.now
            self.hunt.choose(self.now, self.own, self.mates, self.game, self.memory)

    @property
    def own(self) -> Own:
        return Own(self.places[2], Vec(0.0, -4.0, 0.0))

    @property
    def mates(self) -> tuple[Mate, ...]:
        ages = {id: 3.0 if id in self.silent else 0.0 for id in (3, 4)}
        return tuple(Mate(id, self.places[id], Vec(0.0, -4.0, 0.0), age) for id, age in ages.items())

    def seen(self) -> PursuerView:
        viewpoint = Viewpoint(2, Side.PURSUER)
        viewpoint.hunt = self.hunt
        found = viewpoint.look(self.now, self.own, self.mates, self.game, self.memory)
        assert isinstance(found, Question)
        assert isinstance(found.view, PursuerView)
        return found.view


def test_each_goes_for_the_evader_it_can_be_at_and_sees_a_game_against_that_one_alone() -> None:
    chase = Chase()
    chase.go(1.0)
    assert chase.hunt.quarry == NORTH_ONE
    assert chase.hunt.together == {2, 3}
    assert chase.hunt.why == f"after evader {NORTH_ONE} by its own reckoning"
    view = chase.seen()
    assert view.evader.position.x == pytest.approx(200.0)
    assert [m.position for m in view.members] == [PLACES[2], PLACES[3]]  # those of its quarry
    assert view.mate.position == PLACES[3]  # but it keeps off whoever is nearest
    assert view.target.position == TARGETS[NORTH_ONE][1]  # two pursuers stand in the way to the other


def test_it_keeps_off_a_mate_with_another_quarry_too() -> None:
    chase = Chase()
    chase.go(1.0)
    chase.places[4] = Vec(210.0, 101.0, 0.0)
    assert chase.seen().mate.position == chase.places[4]


def test_a_lost_pursuer_is_replaced() -> None:
    chase = Chase()
    chase.go(1.0)
    chase.silent = {4}  # the only one at the other evader
    chase.go(2 * EVERY)
    assigned = {chase.hunt.quarry, *(q for id, q in chase.hunt._given.items() if id == 3)}
    assert assigned == {NORTH_ONE, SOUTH_ONE}
    assert 4 not in chase.hunt._given


def test_a_mate_that_does_not_follow_the_game_counts_as_lost() -> None:
    chase = Chase()
    chase.hunt.unfit = frozenset({4})
    chase.go(1.0)
    assert {chase.hunt._given[2], chase.hunt._given[3]} == {NORTH_ONE, SOUTH_ONE}


def test_who_is_out_is_left_at_once_and_nobody_is_left_to_chase_when_all_are_out() -> None:
    chase = Chase()
    chase.go(1.0)
    chase.hunt.out = frozenset({NORTH_ONE})
    chase.go(0.05)
    assert chase.hunt.quarry == SOUTH_ONE
    chase.hunt.out = frozenset({NORTH_ONE, SOUTH_ONE})
    chase.go(0.05)
    assert chase.hunt.quarry == 0
    viewpoint = Viewpoint(2, Side.PURSUER)
    viewpoint.hunt = chase.hunt
    found = viewpoint.look(chase.now, chase.own, (), chase.game, chase.memory)
    assert isinstance(found, PilotDecision)
    assert found.lacks == ("an evader that is still in the game",)


def test_an_evader_without_a_track_is_nobodys_quarry_until_it_is_seen() -> None:
    chase = Chase()
    chase.tracked = {SOUTH_ONE}
    chase.go(1.0)
    assert chase.hunt.quarry == SOUTH_ONE
    chase.tracked = {NORTH_ONE, SOUTH_ONE}
    chase.go(2 * EVERY)
    assert chase.hunt.quarry == NORTH_ONE


def test_without_a_track_of_anybody_it_stays_with_its_own() -> None:
    chase = Chase()
    chase.go(1.0)
    chase.memory = Memory(Predicting.CONSTANT_VELOCITY)
    chase.tracked = set()
    chase.go(1.0)
    assert chase.hunt.quarry == NORTH_ONE


def test_the_plan_that_counts_decides_until_it_names_who_is_out() -> None:
    chase = Chase()
    chase.go(1.0)
    chase.hunt.planner, chase.hunt.planned = 3, {2: SOUTH_ONE, 3: NORTH_ONE, 4: SOUTH_ONE}
    chase.go(0.05)
    assert chase.hunt.quarry == SOUTH_ONE
    assert chase.hunt.why == f"after evader {SOUTH_ONE} in the plan of 3"
    assert chase.hunt.together == {2, 4}
    chase.hunt.out = frozenset({SOUTH_ONE})
    chase.go(0.05)
    assert chase.hunt.quarry == NORTH_ONE
    assert chase.hunt.why.endswith("by its own reckoning")


def test_targets_that_the_rules_keep_secret_are_shown_to_nobody() -> None:
    rules = GAME.rules._replace(target_known=False)
    chase = Chase(GAME._replace(rules=rules))
    chase.go(1.0)
    assert not chase.seen().target.exists


def test_of_one_evader_with_one_target_there_is_no_choice() -> None:
    one = GAME._replace(roster=ROSTER[:4], goals=())
    assert hunt_of(2, one) is None
    assert hunt_of(2, one._replace(goals=GAME.goals[:1])) is not None
    assert hunt_of(2, GAME) is not None
