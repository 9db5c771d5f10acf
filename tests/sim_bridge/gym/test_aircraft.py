"""Games with the aircraft as flown: those of the campaigns, whoever acts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace

from onboard.config.strict import ConfigError
from onboard.core.game.referee import GameResult
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.scenario import Scenario, load
from onboard.runtime.resources import SCENARIOS, shipped_file
from sim_bridge.campaign.spatial_campaign import play_drawn
from sim_bridge.campaign.spatial_draw import Spread, draw, drawn_scenario
from sim_bridge.gym.batch import first_seed
from sim_bridge.gym.games import games_of
from sim_bridge.gym.single import GameEnv
from sim_bridge.gym.task import Wish, make_task


def short(horizon: float, name: str = "spatial/two") -> Scenario:
    found = load(shipped_file(Path(name), SCENARIOS))
    return replace(found, parameters=replace(found.parameters, horizon=horizon))


def test_without_learners_it_is_the_campaigns_game_to_the_bit() -> None:
    scenario = short(2.0)
    task = make_task(Wish(scenario=scenario, motion="aircraft", learn="all", spread=200.0))
    task = task._replace(learners=(), evader=EVADERS["paper"].decide, pursuers=PURSUERS["paper"].decide)
    games = games_of(task, 1, compiled=False)
    games.reset(seeds=np.array([6]))
    drawn = drawn_scenario(scenario, 6, Spread(200.0, 40.0))
    np.testing.assert_array_equal(games.places[0], [v.start() for v in drawn.vehicles])
    played = play_drawn(draw(drawn, 0, compiled=False), 0, False)
    ends = played.play.game
    for _ in range(40):
        games.step(again=False)
    arrays = games.arrays
    assert arrays.verdicts[0] == ends.score.verdict == GameResult.DENIED
    np.testing.assert_array_equal(games.places[0, 0], ends.evader.position)
    np.testing.assert_array_equal(games.places[0, 1:], [p.position for p in ends.pursuers])
    assert arrays.ends[0, 2] == np.float32(ends.score.smallest)
    assert arrays.ends[0, 3] == played.play.steps == 40


def test_actions_steer_the_aircraft_through_their_autopilots() -> None:
    words = {"scenario": short(60.0), "motion": "aircraft", "learn": "pursuer_1", "spread": 0.0}
    env = GameEnv(compiled=False, **words)
    env.reset(seed=3)
    state = env._game.state().reshape(-1, 6)
    course = np.arctan2(state[1, 4], state[1, 3])
    for _ in range(100):
        seen, *_ = env.step(np.array([(course + 0.4) / np.pi, 0.0], np.float32))
    state = env._game.state().reshape(-1, 6)
    turned = np.arctan2(state[1, 4], state[1, 3]) - course
    assert 0.1 < turned < 0.6  # to the right by about 4.5°/s for five seconds, not at once
    truth = state[0, :3] - state[1, :3]
    assert 0.0 < np.linalg.norm(seen[3:6] - truth) < 60.0  # by a track with 10 m of noise
    env.close()


def test_what_is_not_flown_is_refused() -> None:
    with pytest.raises(ConfigError, match="airframe"):
        games_of(make_task(Wish(scenario="plane", motion="aircraft")), 1, compiled=False)
    with pytest.raises(ConfigError, match="plan"):
        games_of(
            make_task(Wish(scenario="spatial/two", motion="aircraft", learn="evader", pursuers="team")), 1
        )


@pytest.mark.long
@pytest.mark.timeout(600)
def test_compiled_flights_are_the_interpreted_ones_and_ended_games_begin_anew() -> None:
    scenario = short(1.5, "spatial/five")
    task = make_task(
        Wish(scenario=scenario, motion="aircraft", learn="all", actions="velocity", axes="sight")
    )
    one, two = games_of(task, 2, workers=2), games_of(task, 2, compiled=False)
    one.reset(4)
    two.reset(4)
    rng = np.random.default_rng(2)
    for _ in range(40):
        for name in ("evader_acts", "pursuers_act"):
            acts = rng.uniform(-1.0, 1.0, getattr(one.arrays, name).shape)
            getattr(one.arrays, name)[:] = getattr(two.arrays, name)[:] = acts
        one.step()
        two.step()
        np.testing.assert_array_equal(one.arrays.verdicts, two.arrays.verdicts)
    assert one.seeds.tolist() == two.seeds.tolist() != (first_seed(4) + np.arange(2)).tolist()
    np.testing.assert_allclose(one.places, two.places, atol=1e-6)
    np.testing.assert_allclose(one.arrays.pursuers_see, two.arrays.pursuers_see, atol=1e-2)
