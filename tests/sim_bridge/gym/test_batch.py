"""Games as arrays: the same game as the core's, whoever acts, in whichever batch, compiled or not."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np
import pytest
from msgspec.structs import replace

from onboard.config.strict import ConfigError
from onboard.core.game.advance import advance, decide
from onboard.core.game.referee import GameResult
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign.spatial_draw import Spread, drawn_scenario
from sim_bridge.draws import Purpose, Stream, key_of
from sim_bridge.gym.batch import BatchedGames, first_seed
from sim_bridge.gym.exchange import Rewards, exchange
from sim_bridge.gym.task import Wish, make_task
from sim_bridge.plane_game.setup import conditions_of, game_of
from sim_bridge.world.sensor import SENSOR_WORDS

EVADER, PURSUER = EVADERS["paper"].decide, PURSUERS["paper"].decide


def batch(games: int = 1, **wish: object) -> BatchedGames:
    return BatchedGames(make_task(Wish(**wish)), games, compiled=False)  # type: ignore[arg-type]


@pytest.mark.parametrize("learn", ["pursuers", "evader", "all", "pursuer_3"])
def test_who_acts_as_the_strategies_decide_plays_the_cores_own_game(learn: str) -> None:
    games = batch(learn=learn, actions="velocity", spread=0.0, scenario="table1/row05")
    scenario = games.task.scenario
    arrays = games.reset(3)
    conditions, game = conditions_of(scenario), game_of(scenario)
    limits = 0
    while game.score.verdict == GameResult.RUNNING:
        decisions = decide(game, conditions, EVADER, PURSUER)
        arrays.evader_acts[0] = decisions.evader.direction[:2]
        for k, decision in enumerate(decisions.pursuers):
            arrays.pursuers_act[0, k] = decision.direction[:2]
        games.step(again=False)
        game = advance(game, conditions, EVADER, PURSUER)
        for k, vehicle in enumerate((game.evader, *game.pursuers)):
            np.testing.assert_allclose(games.places[0, k], vehicle.position, atol=2e-3)
        limits += 1
        if learn != "all" and limits == 60:
            return
    assert limits > 100
    assert arrays.verdicts[0] == game.score.verdict
    ended = (game.score.time, game.score.captor, game.score.smallest, limits)
    np.testing.assert_allclose(arrays.ends[0], ended, atol=5e-3)


def test_a_pursuer_sees_where_the_evader_will_turn_before_it_acts() -> None:
    games = batch(spread=0.0)
    seen = games.reset(1).pursuers_see[0, 0]
    scenario = games.task.scenario
    game = game_of(scenario)
    own = decide(game, conditions_of(scenario), EVADER, PURSUER).evader
    me, e = game.pursuers[0], game.evader
    np.testing.assert_allclose(seen[:2], me.velocity[:2], atol=1e-6)
    np.testing.assert_allclose(seen[2:4], np.subtract(e.position, me.position)[:2], atol=1e-5)
    np.testing.assert_allclose(seen[4:6], np.multiply(own.direction, e.speed)[:2], atol=1e-5)
    others = [np.subtract(p.position, me.position)[:2] for p in game.pursuers[1:]]
    np.testing.assert_allclose(seen[6:8], min(others, key=np.linalg.norm), atol=1e-5)
    np.testing.assert_allclose(seen[8:], 0.0)  # the target is the evader's secret


def test_axes_along_the_line_of_sight_turn_observations_and_actions_alike() -> None:
    ned, sight = batch(spread=0.0, learn="all"), batch(spread=0.0, learn="all", axes="sight")
    a, b = ned.reset(1), sight.reset(1)
    assert b.pursuers_see[0, 1, 2] == pytest.approx(np.hypot(75.0, 50.0))
    assert b.pursuers_see[0, 1, 3] == pytest.approx(0.0, abs=1e-5)
    bearing = np.arctan2(-50.0, -75.0)
    a.pursuers_act[0, 1] = (bearing + 0.3) / pi
    b.pursuers_act[0, 1] = 0.3 / pi  # to the right of the line of sight
    ned.step()
    sight.step()
    np.testing.assert_allclose(ned.places[0, 2], sight.places[0, 2], atol=1e-5)
    assert a.evader_sees.shape == b.evader_sees.shape == (1, 4 + 4 * 5)


def test_along_the_line_of_sight_ahead_is_at_the_evader_and_right_is_right_of_it() -> None:
    games = batch(spread=0.0, axes="sight", actions="velocity", scenario="plane")
    arrays = games.reset(1)
    line = games.places[0, 0] - games.places[0, 2]
    line /= np.linalg.norm(line)
    arrays.pursuers_act[0, 1] = (0.6, 0.8)
    games.step()
    right = np.array([-line[1], line[0], 0.0])  # north, east: east is right of north
    np.testing.assert_allclose(games.velocities[0, 2], 4.0 * (0.6 * line + 0.8 * right), atol=1e-5)


def test_an_acceleration_changes_the_velocity_by_no_more_than_the_vehicle_can() -> None:
    games = batch(spread=0.0, actions="acceleration")
    arrays = games.reset(1)
    before = games.velocities[0, 1].copy()
    arrays.pursuers_act[0, 0] = (3.0, 4.0)  # longer than 1: cut
    games.step()
    change = games.velocities[0, 1] - before
    np.testing.assert_allclose(change, np.array([0.6, 0.8, 0.0]) * 4.0 * 0.05, atol=1e-6)


def test_a_seed_draws_the_places_of_campaigns_and_the_wind_carries_everybody() -> None:
    task = make_task(Wish(scenario="space", learn="all", actions="velocity", spread=20.0))
    games = BatchedGames(task, 3, compiled=False)
    games.reset(seeds=np.array([7, 8, 7]))
    for g, seed in enumerate((7, 8, 7)):
        drawn = drawn_scenario(task.scenario, seed, Spread(20.0, 4.0))
        np.testing.assert_allclose(games.places[g], [v.start() for v in drawn.vehicles], atol=1e-9)
    before = games.places.copy()
    games.arrays.evader_acts[:] = games.arrays.pursuers_act[:] = 0.0  # at the least speed: none
    games.step()
    angle = radians(drawn_scenario(task.scenario, 7).flight.wind.from_deg)
    drift = 3.0 * 0.05 * np.array([-cos(angle), -sin(angle), 0.0])
    np.testing.assert_allclose(games.places[0] - before[0], np.tile(drift, (6, 1)), atol=1e-9)


def test_tracks_are_noisy_and_late_by_as_much_as_the_sensor_says() -> None:
    task = make_task(Wish(scenario="space", learn="evader", spread=0.0, pursuers="pure-pursuit"))
    games = BatchedGames(task, 1, compiled=False)
    arrays = games.reset(1)
    off = []
    for _ in range(300):
        games.step()
        seen = arrays.evader_sees[0, 6:].reshape(5, 2, 3)[:, 0]
        off.append(seen - (games.places[0, 1:] - games.places[0, 0]))
    spread = np.std(off)
    assert 0.15 < spread < 1.0  # below the sensor's 1 m, for the filter smooths; not nothing


def test_batches_of_any_size_play_the_same_games_and_next_games_have_next_seeds() -> None:
    short = make_task(Wish(scenario="one-on-one", evader="straight", spread=10.0))
    rng = np.random.default_rng(0)
    acts = rng.uniform(-1.0, 1.0, (700, 4, 1, 1)).astype(np.float32)
    whole, halves = BatchedGames(short, 4, compiled=False), BatchedGames(short, 4, workers=2, compiled=False)
    alone = BatchedGames(short, 1, compiled=False)
    one, two = whole.reset(5), halves.reset(5)
    alone.reset(seeds=whole.seeds[2:3].copy())
    assert whole.seeds[0] == first_seed(5)
    for k in range(700):
        one.pursuers_act[:] = two.pursuers_act[:] = acts[k]
        alone.arrays.pursuers_act[:] = acts[k, 2:3]
        whole.step()
        halves.step()
        if alone.arrays.verdicts[0] == GameResult.RUNNING:
            alone.step(again=False)
            assert alone.places[0].tobytes() == whole.places[2].tobytes() or whole.arrays.verdicts[2]
            assert alone.arrays.verdicts[0] == whole.arrays.verdicts[2]
    assert whole.places.tobytes() == halves.places.tobytes()
    assert one.rewards.tobytes() == two.rewards.tobytes()
    assert (whole.seeds - first_seed(5)).tolist() == [4, 5, 6, 7]  # each ended once and went on as a new game


def test_the_end_of_a_game_is_told_with_its_last_observation_and_the_next_game_begins() -> None:
    games = batch(2, scenario="one-on-one", evader="straight", spread=5.0, actions="velocity",
                  rewards=Rewards(outcome=1.0, closing=0.0, time=0.01))  # fmt: skip
    arrays = games.reset(1)
    arrays.pursuers_act[:] = 0.0
    gained = 0.0
    for _ in range(2000):
        games.step()
        gained += arrays.rewards[0, 0]
        if arrays.verdicts[0]:
            break
    assert arrays.verdicts[0] == GameResult.ARRIVED
    assert gained == pytest.approx(1.0 + 0.01 * arrays.ends[0, 0], rel=1e-4)
    assert arrays.rewards[0, 1] == pytest.approx(-arrays.rewards[0, 0])
    assert np.hypot(*arrays.pursuers_last[0, 0, 2:4]) < np.hypot(*arrays.pursuers_see[0, 0, 2:4])
    assert games.times[0] == 0.0


def test_what_is_wrong_is_refused_by_name() -> None:
    games = batch(2)
    with pytest.raises(ValueError, match="reset"):
        games.step()
    arrays = games.reset(1)
    before = games.places.copy()
    arrays.pursuers_act[1, 3] = np.nan
    with pytest.raises(ValueError, match="game 1"):
        games.step()
    assert before.tobytes() == games.places.tobytes()
    form = games.task.form
    with pytest.raises(ValueError, match="evader_acts"):
        BatchedGames(games.task, 3, exchange(2, 5, form), compiled=False)
    for key, value, said in (
        ("learn", "pursuer_9", "pursuer_9"), ("actions", "thrust", "actions"), ("axes", "body", "axes"),
        ("motion", "real", "motion"), ("scenario", "nowhere", "scenario"), ("pursuers", "paper", "all of"),
        ("evader", "nobody", "nobody"), ("spread", -1.0, "spread"), ("scenario", "spatial/five", "shear"),
    ):  # fmt: skip
        with pytest.raises(ConfigError, match=said):
            make_task(Wish(**{key: value}))  # type: ignore[arg-type]


def test_compiled_games_are_the_interpreted_ones() -> None:
    task = make_task(Wish(scenario="one-on-one", evader="straight", spread=10.0))
    rng = np.random.default_rng(1)
    one, two = BatchedGames(task, 5, workers=2), BatchedGames(task, 5, compiled=False)
    one.reset(2)
    two.reset(2)
    for _ in range(800):
        one.arrays.pursuers_act[:] = two.arrays.pursuers_act[:] = rng.uniform(-1.0, 1.0, (5, 1, 1))
        one.step()
        two.step()
    np.testing.assert_allclose(one.places, two.places, atol=1e-9)
    np.testing.assert_allclose(one.arrays.pursuers_see, two.arrays.pursuers_see, atol=1e-4)
    assert one.seeds.tolist() == two.seeds.tolist() != (first_seed(2) + np.arange(5)).tolist()


@pytest.mark.parametrize("count", [1, 9])
def test_the_noise_is_that_of_the_bridges_sensor_whoever_shares_the_block(count: int) -> None:
    """Eight vehicles are drawn at a time: nine pursuers and the evader take two blocks."""
    space = make_task(Wish(scenario="space")).scenario
    calm = replace(space.flight, wind=replace(space.flight.wind, speed=0.0))
    sensor = replace(calm.sensor, dropout=0.25)
    team = [replace(space.pursuers[k % 5], id=k + 2) for k in range(count)]
    scenario = replace(space, pursuers=team, flight=replace(calm, sensor=sensor))
    games = BatchedGames(make_task(Wish(scenario=scenario, learn="all", spread=0.0)), 8, compiled=False)
    games.reset(seeds=np.arange(8))
    kept = []
    for g in range(8):
        for player, id in enumerate(scenario.ids):
            stream = Stream(key_of(g + scenario.seed, id, Purpose.SENSOR), SENSOR_WORDS, 1)
            chance, *noise = stream.at(0)
            here = np.concatenate([games.places[g, player], games.velocities[g, player]])
            expected = here + noise * np.repeat([sensor.sigma, sensor.sigma_velocity], 3)
            waiting = games._table.waiting[g, 0, player]
            np.testing.assert_allclose(waiting[:6], expected, rtol=0.0, atol=1e-12)
            kept.append(waiting[6])
            assert waiting[6] == (chance >= 0.25)
    assert 0.0 in kept
    assert 1.0 in kept
