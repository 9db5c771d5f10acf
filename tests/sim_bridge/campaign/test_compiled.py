"""The same game interpreted and compiled: every place after every step agrees."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import asin, cos, radians, sin

import numpy as np
import pytest

from onboard.core.game.advance import Conditions, Game, begin, still_view
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.game.views import heading_at
from onboard.core.geometry.cones import is_free
from onboard.core.geometry.edges import free_ray
from onboard.core.math.states import FREE, Vehicle, VehicleLimits
from onboard.core.math.vectors import NORTH, ZERO, Vec, angle_between, dot, scale, sub, unit
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.scenario import load
from sim_bridge.campaign.compiled import Ends, Starts, campaign, starts_of
from sim_bridge.plane_game.program import play, table1
from sim_bridge.plane_game.setup import conditions_of, game_of

# Compiling takes a while, and so do ten games of 2000 steps interpreted.
pytestmark = pytest.mark.timeout(480)

TEAM = 5
KEEP = 2000
MARGIN = 1e-6  # a decision nearer than this to another may turn out differently in both modes
Play = Callable[..., Ends]


@pytest.fixture(scope="module")
def compiled() -> Play:
    return campaign(EVADERS["paper"].decide, PURSUERS["paper"].decide, TEAM)


@pytest.fixture(scope="module")
def interpreted() -> Play:
    return campaign(EVADERS["paper"].decide, PURSUERS["paper"].decide, TEAM, compiled=False)


def table() -> tuple[list[Game], list[Vec], list[Conditions]]:
    scenarios = [load(path) for path in table1()]
    conditions = [conditions_of(scenario) for scenario in scenarios]
    return [game_of(s) for s in scenarios], [p.target.position for p in conditions], conditions


def random_game(rng: np.random.Generator, planar: bool, limits: VehicleLimits = FREE) -> Game:
    def place(far: float) -> Vec:
        yaw, z = rng.uniform(-np.pi, np.pi), 0.0 if planar else rng.uniform(-1.0, 1.0)
        r = np.sqrt(1.0 - z * z)
        return Vec(float(far * r * cos(yaw)), float(far * r * sin(yaw)), float(far * z))

    team = tuple(Vehicle(place(rng.uniform(15.0, 120.0)), scale(NORTH, 4.0), 4.0) for _ in range(TEAM))
    return begin(Vehicle(ZERO, scale(NORTH, 5.0), 5.0), team, limits, (limits,) * TEAM)


def conditions_for(planar: bool, **changes: object) -> Conditions:
    rules = Rules(2.0, 4.0, horizon=40.0, planar=planar)._replace(**changes)  # type: ignore[arg-type]
    return Conditions(rules, Target(True, ZERO), Control())


def differing(mine: Ends, theirs: Ends) -> list[int]:
    """The games in which any place at any step, or the outcome, differs by more than 1e-9."""
    assert mine.steps.min() > 5
    kept = np.isfinite(mine.trace)
    assert kept.any(axis=(1, 2, 3)).all()
    found = []
    for game in range(len(mine.steps)):
        a, b = mine.trace[game], theirs.trace[game]
        same = np.array_equal(np.isfinite(a), np.isfinite(b))
        same = same and bool((np.nan_to_num(abs(a - b)) <= 1e-9).all())
        same = same and mine.verdicts[game] == theirs.verdicts[game]
        same = same and mine.captors[game] == theirs.captors[game]
        for name in ("times", "smallest", "unsafe"):
            same = same and abs(getattr(mine, name)[game] - getattr(theirs, name)[game]) <= 1e-9
        if not same:
            found.append(game)
    return found


def margin(game: Game, conditions: Conditions) -> float:
    """How far the decisions of this instant are from turning out otherwise.

    For the evader: from the preferred ray to the nearest cone's edge, and between the best two free
    points on the edges. For the pursuers: |φ − asin γ| and |cos φ|.
    """
    view = still_view(game, conditions)
    goal = unit(sub(conditions.target.position, game.evader.position), NORTH)
    found = [abs(dot(goal, c.axis) - c.cos) for c in view.cones]
    ranked = []
    for index, cone in enumerate(view.cones):
        alone = free_ray(goal, (cone,))
        others = view.cones[:index] + view.cones[index + 1 :]
        if is_free(alone.direction, others):
            ranked.append(alone.closeness)
        found += [abs(dot(alone.direction, c.axis) - c.cos) for c in others]
    ranked.sort()
    found += [b - a for a, b in pairwise(ranked) if b - a > 0.0][-1:]
    heading = heading_at(game.evader)
    for pursuer in game.pursuers:
        line = unit(sub(pursuer.position, game.evader.position), NORTH)
        c = dot(line, heading)
        found += [abs(c), abs(angle_between(line, heading) - asin(pursuer.speed / game.evader.speed))]
    return min(found)


def smallest_margin(starts: Starts, game: Game, ends: Ends, number: int, conditions: Conditions) -> float:
    """The smallest margin along a game's trace."""
    smallest = 1e9
    mine = conditions._replace(target=Target(True, Vec(*starts.targets[number])))
    for step in range(1, int(ends.steps[number])):
        before, now = ends.trace[number, step - 1], ends.trace[number, step]
        velocity = Vec(*((now[0] - before[0]) / conditions.control.dt))
        team = tuple(v._replace(position=Vec(*now[k + 1])) for k, v in enumerate(game.pursuers))
        there = game._replace(evader=Vehicle(Vec(*now[0]), velocity, game.evader.speed), pursuers=team)
        smallest = min(smallest, margin(there, mine))
    return smallest


def demand_agreement(
    games: list[Game], targets: list[Vec], conditions: Conditions, both: tuple[Play, Play]
) -> Ends:
    """All games agree whose margins stay above 1e-6; the others are few."""
    starts = starts_of(games, targets)
    mine, theirs = (play(starts, conditions, keep=KEEP) for play in both)
    close = [
        k for k in differing(mine, theirs)
        if smallest_margin(starts, games[k], mine, k, conditions) < MARGIN
    ]  # fmt: skip
    assert differing(mine, theirs) == close
    assert len(close) <= len(games) // 10
    return mine


def test_table_1_agrees_in_every_step(compiled: Play, interpreted: Play) -> None:
    games, targets, conditions = table()
    verdicts = []
    for has_target in (True, False):
        rows = [k for k, p in enumerate(conditions) if p.target.exists == has_target]
        starts = starts_of([games[k] for k in rows], [targets[k] for k in rows])
        mine, theirs = (play(starts, conditions[rows[0]], keep=KEEP) for play in (interpreted, compiled))
        assert differing(mine, theirs) == []
        verdicts += list(mine.verdicts)
        # Not only close: the same to the last bit.
        np.testing.assert_array_equal(mine.trace, theirs.trace)
    assert sorted(set(verdicts)) == [r for r in GameResult if r != GameResult.RUNNING]


@pytest.mark.parametrize("planar", [True, False])
def test_random_games_agree_in_every_step(planar: bool, compiled: Play, interpreted: Play) -> None:
    rng = np.random.default_rng(4 + planar)
    games = [random_game(rng, planar) for _ in range(24)]
    targets = [Vec(float(x), float(y), 0.0) for x, y in rng.uniform(-150.0, 150.0, (24, 2))]
    mine = demand_agreement(games, targets, conditions_for(planar), (interpreted, compiled))
    assert (mine.trace[:, :5, :, 2] != 0.0).any() != planar


def test_games_within_a_pitch_band_agree_and_keep_it(compiled: Play, interpreted: Play) -> None:
    band = VehicleLimits(pitch_min=radians(-20.0), pitch_max=radians(20.0))
    rng = np.random.default_rng(6)
    games = [random_game(rng, False, band) for _ in range(10)]
    targets = [Vec(100.0, float(y), -60.0) for y in rng.uniform(-80.0, 80.0, 10)]
    ends = demand_agreement(games, targets, conditions_for(False, horizon=20.0), (interpreted, compiled))
    moves = np.diff(ends.trace, axis=1)
    rise = moves[..., 2] / np.linalg.norm(moves, axis=-1)
    assert np.nanmax(abs(rise)) <= sin(radians(20.0)) + 1e-8
    assert np.nanmax(abs(rise)) > 0.3  # some climb as steeply as they may


def test_games_with_a_separation_between_pursuers_agree(compiled: Play, interpreted: Play) -> None:
    rng = np.random.default_rng(7)
    games = [random_game(rng, True) for _ in range(8)]
    conditions = conditions_for(True, separation=40.0, horizon=20.0)
    targets = [Vec(100.0, 0.0, 0.0)] * 8
    kept = demand_agreement(games, targets, conditions, (interpreted, compiled))
    apart = conditions._replace(rules=conditions.rules._replace(separation=0.0))
    free = compiled(starts_of(games, targets), apart, keep=KEEP)
    assert (np.nan_to_num(kept.trace) != np.nan_to_num(free.trace)).any()


def test_a_compiled_game_is_the_plane_game_of_the_command(compiled: Play) -> None:
    """The campaign's arrays carry everything over: verdict and time as `sim-bridge planar` has them."""
    games, targets, conditions = table()
    ends = compiled(starts_of(games[:1], targets[:1]), conditions[0])
    command = play(load(table1()[0]), "paper", keep=False)
    assert ends.verdicts[0] == command.verdict
    assert ends.times[0] == command.final.score.time
    assert ends.smallest[0] == command.final.score.smallest


def test_two_threads_play_what_one_plays(compiled: Play) -> None:
    rng = np.random.default_rng(8)
    games = [random_game(rng, False) for _ in range(40)]
    starts = starts_of(games, [Vec(100.0, 20.0, 5.0)] * 40)
    one, two = (compiled(starts, conditions_for(False), workers=n, keep=10) for n in (1, 2))
    for a, b in zip(one, two, strict=True):
        np.testing.assert_array_equal(a, b)


def test_arrays_of_the_wrong_shape_are_refused(interpreted: Play) -> None:
    rng = np.random.default_rng(9)
    starts = starts_of([random_game(rng, True)], [ZERO])
    with pytest.raises(ValueError, match=r"speeds: shape \(1, 5\), expected \(1, 6\)"):
        interpreted(starts._replace(speeds=starts.speeds[:, 1:]), conditions_for(True))
