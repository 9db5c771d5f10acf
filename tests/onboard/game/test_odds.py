"""Go or no-go: what is said before a game, against the bound, geometry and games that no fit has seen."""

from __future__ import annotations

from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

from onboard.core.game.advance import Conditions, advance, begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.core.strategy.team.plan_types import Heights, Member, Situation
from onboard.game.go_or_no_go import engagement_of, lines
from onboard.game.odds import NAMES, chances, engagement, features, odds, table
from onboard.game.scenario import load
from onboard.runtime.resources import configs

RULES = Rules(R=2.0, rho=4.0, horizon=300.0, planar=True)


def team(places: list[tuple[float, float]]) -> tuple[Vehicle, ...]:
    return tuple(Vehicle(Vec(x, y, 0.0), Vec(4.0, 0.0, 0.0), 4.0) for x, y in places)


def situation(places: list[tuple[float, float]], goal: float = 120.0) -> Situation:
    evader = Member(Vehicle(ZERO, Vec(5.0, 0.0, 0.0), 5.0), FREE, True)
    members = tuple(Member(one, FREE, True) for one in team(places))
    return engagement(evader, members, Target(True, Vec(goal, 0.0, 0.0)), RULES, Heights(), 0.0)


def ring(count: int, radius: float, phase: float = 0.0) -> list[tuple[float, float]]:
    yaws = [phase + 2.0 * pi * k / count for k in range(count)]
    return [(radius * cos(a), radius * sin(a)) for a in yaws]


def test_a_closed_ring_is_a_go_and_three_behind_are_none() -> None:
    assert lines(situation(ring(5, 40.0)))[0].startswith("go: ")
    behind = [(-40.0, 10.0), (-45.0, 0.0), (-40.0, -12.0)]
    told = lines(situation(behind))
    assert told[0].startswith("no-go: bound: 4 such pursuers at least")
    assert odds(situation(behind)).needed == 4


def test_what_would_change_it_is_told_and_changes_it() -> None:
    """Four of which one stands beside another: a ring of them is closed."""
    found = odds(situation([(40.0, 0.0), (38.0, 8.0), (-10.0, 40.0), (-10.0, -40.0)]))
    before = found.chances["paper"].captured
    assert len(found.changes) >= 2
    assert max(change.captured.p for change in found.changes) > before.high


def test_beyond_the_table_it_says_so() -> None:
    told = lines(situation(ring(5, 40.0), goal=90_000.0))
    assert any("the table of odds says nothing here: far:" in line for line in told)
    no_target = situation(ring(5, 40.0))._replace(target=Target(False, ZERO))
    assert odds(no_target).beyond.startswith("no target")


def test_lengths_count_as_ratios_alone() -> None:
    """Twice the lengths with twice R and ρ is the same engagement, turned by 50° too."""
    a = features(situation(ring(4, 40.0, 0.3)))
    x = situation(ring(4, 80.0, 0.3), goal=240.0)
    b = features(x._replace(rules=RULES._replace(R=4.0, rho=8.0)))
    assert a == pytest.approx(b, rel=1e-6)
    assert len(a) == len(NAMES)


def test_new_games_end_as_often_as_the_table_says() -> None:
    """Sixty games that no fit has seen, interpreted: the said and the happened agree within their scatter."""
    rng = np.random.default_rng(99)
    said, happened = [], []
    while len(said) < 60:
        yaws = rng.uniform(-pi, pi) + 2.0 * pi * np.arange(4) / 4 + 0.3 * rng.standard_normal(4)
        far = 35.0 * (1.0 + 0.1 * rng.standard_normal(4))
        places = [(float(d * cos(a)), float(d * sin(a))) for a, d in zip(yaws, far, strict=True)]
        found = chances(situation(places), "paper")
        if found is None:
            continue
        game = begin(Vehicle(ZERO, Vec(5.0, 0.0, 0.0), 5.0), team(places), FREE, (FREE,) * 4)
        conditions = Conditions(RULES, Target(True, Vec(120.0, 0.0, 0.0)), Control(0.25))
        while game.score.verdict == GameResult.RUNNING and game.time < 80.0:
            game = advance(game, conditions, EVADERS["paper"].decide, PURSUERS[table().pursuers].decide)
        said.append(found.captured.p)
        happened.append(game.score.verdict == GameResult.CAPTURED)
    p, y = np.array(said), np.array(happened, float)
    assert abs(float((p - y).sum())) < 3.5 * float(np.sqrt((p * (1 - p)).sum() + 1.0))
    assert float(np.mean((p - y) ** 2)) < 0.6 * float(y.mean() * (1 - y.mean()))


SHIPPED = [
    path for path in sorted((configs() / "scenarios").rglob("*.toml")) if not load(path, several=True).several
]


@pytest.mark.parametrize("path", SHIPPED, ids=lambda p: p.stem)
def test_every_shipped_scenario_is_judged(path: Path) -> None:
    told = lines(engagement_of(load(path)))
    assert told[0].partition(":")[0] in ("go", "no-go", "open", "unknown")


@pytest.mark.parametrize("path", SHIPPED, ids=lambda p: p.stem)
def test_no_game_is_both_captured_and_arrived(path: Path) -> None:
    for one in odds(engagement_of(load(path)), changes=False).chances.values():
        assert one.captured.p + one.arrived.p <= 1.0 + 1e-12
        for said in one:
            assert 0.0 <= said.low <= said.p <= said.high <= 1.0


def shipped(name: str) -> Situation:
    """A spatial scenario at its start."""
    return engagement_of(load(configs() / "scenarios" / "spatial" / f"{name}.toml"))


def test_rings_in_space_are_a_go_and_open_starts_none() -> None:
    for name in ("ring-5", "ring-6"):
        s = shipped(name)
        assert lines(s)[0].startswith("go: ")
        assert odds(s).chances["paper"].captured.low > 0.8
        assert odds(s).chances["evasive"].captured.high < 0.3  # it dodges: nothing here answers it
    for name in ("five", "six"):
        s = shipped(name)
        assert lines(s)[0].startswith("no-go: ")
        found = odds(s)
        ringed = next(change for change in found.changes if change.words.startswith("a ring of 1496 m"))
        assert ringed.captured.low > found.chances["paper"].captured.high


def test_in_space_it_says_which_games_it_has_not_seen() -> None:
    s = shipped("ring-5")
    two = s._replace(team=s.team[:2])
    assert "pursuers: found 2, the table's games have 4 to 6" in odds(two).beyond
    nimble = s._replace(evader_limits=s.evader_limits._replace(turn_rate=4.0 * s.evader_limits.turn_rate))
    assert odds(nimble).beyond.startswith("the evader's turn: found 1.8")
    steep = s._replace(evader_limits=s.evader_limits._replace(pitch_max=1.0))
    assert odds(steep).beyond.startswith("the evader's pitch: found 1.00")
