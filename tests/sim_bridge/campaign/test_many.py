"""Games of several evaders compiled: every place of every step as interpreted, and as the core plays them."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.game.many import ManyConditions, ManyGame, begin_many
from onboard.core.game.rules import NO_TARGET, Control, Rules, Target
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, Vec, scale
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign.many import Size, many_campaign, starts_of

pytestmark = pytest.mark.timeout(480)  # compiling takes a while

SIZE = Size(2, 3, 2)
RULES = Rules(2.0, 4.0, horizon=40.0, planar=True, target_known=True)


def random_game(rng: np.random.Generator) -> tuple[ManyGame, tuple[tuple[Target, ...], ...]]:
    def place(far: float) -> Vec:
        return Vec(float(rng.uniform(-far, far)), float(rng.uniform(-far, far)), 0.0)

    def vehicle(far: float, low: float, high: float) -> Vehicle:
        speed = float(rng.uniform(low, high))
        return Vehicle(place(far), scale(NORTH, speed), speed)

    evaders = tuple(vehicle(80.0, 4.0, 5.0) for _ in range(SIZE.evaders))
    pursuers = tuple(vehicle(60.0, 3.5, 5.5) for _ in range(SIZE.pursuers))
    targets = (Target(True, place(90.0)), Target(True, place(90.0))), (Target(True, place(90.0)), NO_TARGET)
    return begin_many(evaders, pursuers, (FREE,) * 2, (FREE,) * SIZE.pursuers), targets


@pytest.mark.parametrize(
    "ways",
    [
        ("paper", "paper", "parallel-pursuit"),
        pytest.param(("paper", "straight", "team"), marks=pytest.mark.long),
    ],
)
def test_compiled_is_interpreted(ways: tuple[str, str, str]) -> None:
    rng = np.random.default_rng(3)
    games, targets = zip(*(random_game(rng) for _ in range(12)), strict=True)
    starts, conditions = starts_of(games, targets), ManyConditions(RULES, targets[0], Control(0.1))
    pair = (EVADERS[ways[0]].decide, EVADERS[ways[1]].decide), PURSUERS[ways[2]].decide
    one, two = (
        many_campaign(*pair, SIZE, compiled)(starts, conditions, keep=410) for compiled in (True, False)
    )
    assert (
        len(set(one.verdicts.ravel().tolist())) >= 3
    )  # captured, arrived, denied: not one story twelve times
    assert one.steps.min() > 5
    for name in ("verdicts", "captors", "steps"):
        assert getattr(one, name).tolist() == getattr(two, name).tolist()
    for name in ("times", "smallest", "unsafe"):
        assert abs(getattr(one, name) - getattr(two, name)).max() <= 1e-9
    assert (np.isfinite(one.trace) == np.isfinite(two.trace)).all()
    assert np.nan_to_num(abs(one.trace - two.trace)).max() <= 1e-9


def test_a_shape_that_is_not_the_games_is_refused() -> None:
    game, targets = random_game(np.random.default_rng(1))
    starts = starts_of([game], [targets])
    play = many_campaign((EVADERS["paper"].decide,) * 2, PURSUERS["team"].decide, SIZE, compiled=False)
    with pytest.raises(ValueError, match=r"targets: shape \(1, 2, 2, 3\), expected \(1, 2, 2, 4\)"):
        play(starts._replace(targets=starts.targets[..., :3]), ManyConditions(RULES, targets, Control()))
