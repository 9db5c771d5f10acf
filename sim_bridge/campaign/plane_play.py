"""A plane game of a scenario played compiled: the same end, to the last bit, as interpreted."""

from __future__ import annotations

from onboard.config.strict import ConfigError
from onboard.core.game.advance import Game
from onboard.core.game.referee import GameResult, Score
from onboard.core.math.vectors import Vec
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario
from sim_bridge.campaign.kernel_folder import any_kept
from sim_bridge.plane_game.program import Played, Result, cut
from sim_bridge.plane_game.program import result as figures_of
from sim_bridge.plane_game.setup import conditions_of, game_of

MOST = 500_000  # steps of a game whose places are kept: 72 MB for six vehicles
KERNEL = "play"  # the kernel's name on disk


def result(scenario: Scenario, strategy: str, dt: float | None, compile: bool = False) -> Result | None:
    """The figures of the game under a pursuers' strategy, compiled; `dt` [s] overrides its time step.

    None where it would have to be compiled first, unless `compile` demands that, or is too long to keep.
    Raises ConfigError where `compile` demands what cannot be: numba is missing, a plug-in does not compile.
    """
    conditions = conditions_of(scenario, dt)
    most = conditions.rules.horizon / conditions.control.dt
    if most > MOST or not (compile or any_kept(KERNEL)):
        return None
    try:
        from numba.core.errors import NumbaError
    except ImportError:
        raise ConfigError("--compile: found no numba, expected: pip install 'apollonius[sim]'") from None
    from sim_bridge.campaign import compiled

    pair = evader_strategy(scenario.evader.strategy), pursuer_strategy(strategy)
    game = game_of(scenario)
    starts = compiled.starts_of([game], [conditions.target.position])
    if not (compile or compiled.needs_no_compiling(*pair, starts, conditions)):
        return None
    try:
        play = compiled.campaign(*pair, len(game.pursuers))
        ends = play(starts, conditions, keep=int(most) + 2)
    except NumbaError:
        raise ConfigError(
            f"--compile: '{scenario.evader.strategy}' or '{strategy}' does not compile,"
            " expected strategies in kernel style (docs/tutorial.md)"
        ) from None
    steps = int(ends.steps[0])
    times = [0.0, game.time]  # of the last two instants, added up as the game does
    for _ in range(steps):
        times = [times[1], times[1] + conditions.control.dt]
    score = Score(
        GameResult(int(ends.verdicts[0])), float(ends.times[0]), int(ends.captors[0]),
        float(ends.smallest[0]), float(ends.unsafe[0]),
    )  # fmt: skip
    before, after = (
        _at(game, time, score, ends.trace[0, step].tolist())
        for time, step in zip(times, (steps - 1, steps), strict=True)
    )
    return figures_of(Played(scenario, strategy, conditions, (), cut(before, after)))


def _at(game: Game, time: float, score: Score, places: list[list[float]]) -> Game:
    """The game at an instant, by places and score; velocities are still those of the start."""
    evader, *pursuers = (Vec(*place) for place in places)
    moved = tuple(p._replace(position=place) for p, place in zip(game.pursuers, pursuers, strict=True))
    return game._replace(
        time=time, evader=game.evader._replace(position=evader), pursuers=moved, score=score
    )
