"""The environments as the libraries' own checkers, and people, use them."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from msgspec.structs import replace
from pettingzoo.test import parallel_api_test, parallel_seed_test

from gcs.station import Station, StationSetup
from onboard.config.strict import ConfigError
from onboard.core.game.referee import GameResult
from onboard.game.scenario import Scenario, load
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.clock import RealClock
from onboard.runtime.resources import SCENARIOS, shipped_file
from onboard.wire.bus.messages import OutcomeResult, Phase
from sim_bridge.gym import register_envs
from sim_bridge.gym.exchange import Rewards
from sim_bridge.gym.parallel import parallel_env
from sim_bridge.gym.single import GameEnv
from tests.support.bus_stages import free_port
from tests.support.paths import ROOT
from tests.support.real_time import until

SMALL = {"scenario": "one-on-one", "compiled": False}


@pytest.fixture(autouse=True)
def _quiet_about_unbounded_boxes():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        yield


def shipped(name: str) -> Scenario:
    return load(shipped_file(Path(name), SCENARIOS))


def make(id: str = "apollonius/Plane-v0", **words: object) -> gymnasium.Env:
    register_envs()
    return gymnasium.make(id, **words)


@pytest.mark.parametrize("learn", ["pursuers", "evader", "pursuer_1"])
def test_gymnasium_finds_nothing_wrong(learn: str) -> None:
    check_env(GameEnv(learn=learn, render_mode="rgb_array", **SMALL), skip_render_check=False)


def test_a_team_as_one_learner_and_a_game_in_space_pass_too() -> None:
    check_env(GameEnv(scenario="plane", compiled=False), skip_render_check=True)
    check_env(
        GameEnv(scenario="space", compiled=False, axes="sight", actions="velocity"), skip_render_check=True
    )


@pytest.mark.parametrize("words", [{}, {"learn": ("evader_1", "pursuer_2"), "actions": "acceleration"}])
def test_pettingzoo_finds_nothing_wrong(words: dict) -> None:
    parallel_api_test(parallel_env(scenario="plane", compiled=False, **words), num_cycles=150)


def test_pettingzoo_finds_that_a_seed_says_it_all() -> None:
    parallel_seed_test(lambda: parallel_env(scenario="one-on-one", compiled=False), num_cycles=150)


def test_a_seed_fixes_a_row_of_games_and_another_seed_makes_others() -> None:
    one, two = make(compiled=False), make(compiled=False)
    first, info = one.reset(seed=4)
    again, told = two.reset(seed=4)
    assert first.tobytes() == again.tobytes()
    assert info["seed"] == told["seed"]
    assert one.reset()[1]["seed"] == two.reset()[1]["seed"] != info["seed"]
    assert one.reset(seed=5)[1]["seed"] != info["seed"]
    replay, _ = two.reset(options={"game": info["seed"]})
    assert replay.tobytes() == first.tobytes()
    with pytest.warns(UserWarning, match="wind"):
        one.unwrapped.reset(options={"wind": 3})
    with pytest.raises(ValueError, match="game"):
        one.unwrapped.reset(options={"game": -1})


def test_a_game_ends_by_capture_as_terminated_and_at_the_horizon_as_cut_off() -> None:
    env = GameEnv(scenario="one-on-one", evader="straight", axes="sight", compiled=False, spread=0.0)
    ends = []
    for act in (0.0, 0.5):  # at the evader, and away from it: the evader arrives
        env.reset(seed=1)
        over = False
        while not over:
            _, reward, terminated, truncated, info = env.step(np.array([act], np.float32))
            over = terminated or truncated
        ends.append((info["verdict"], terminated, np.sign(reward)))
        with pytest.raises(ValueError, match="reset"):
            env.step(np.array([act], np.float32))
    assert ends[1] == ("arrived", True, -1.0)
    free = shipped("one-on-one")
    free = replace(free, evader=replace(free.evader, target=None))
    for scenario, verdict, sign in ((free, "escaped", 1.0), ("one-on-one", "denied", -1.0)):
        away = GameEnv(scenario=scenario, learn="evader", actions="velocity", compiled=False, spread=0.0)
        away.reset(seed=1)
        over = False
        while not over:
            _, reward, terminated, truncated, info = away.step(np.array([-1.0, 0.2], np.float32))
            over = terminated or truncated
        assert (info["verdict"], terminated, truncated) == (verdict, False, True)
        assert sign * reward > 0.9


def test_gymnasium_makes_them_by_name_whichever_is_imported_first() -> None:
    for code in ("import sim_bridge.gym, gymnasium; name = ''", "import gymnasium; name = 'sim_bridge.gym:'"):
        code += "; print(gymnasium.make(name + 'apollonius/Plane-v0', compiled=False).reset(seed=1)[0].shape)"
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True
        )
        assert done.stdout == "(50,)\n"


def test_wrong_words_and_actions_are_named() -> None:
    wrong: tuple[tuple[dict[str, Any], str], ...] = (
        ({"scenarios": "plane"}, "scenarios"), ({"render_mode": "ansi"}, "render_mode"),
        ({"scenario": ""}, "scenario: found '', expected"), ({"scenario": None}, "scenario: found None"),
        ({"spread": "wide"}, "spread: found 'wide'"), ({"spread": np.nan}, "spread: found nan"),
        ({"rewards": None}, "rewards: found None"), ({"rewards": Rewards(time=np.inf)}, "rewards: .*inf"),
    )  # fmt: skip
    for words, said in wrong:
        with pytest.raises(ConfigError, match=said):
            GameEnv(compiled=False, **words)
    env = GameEnv(**SMALL)
    env.reset(seed=1)
    with pytest.raises(ValueError, match="shape"):
        env.step(np.zeros(3, np.float32))
    with pytest.raises(ValueError, match="finite"):
        env.step(np.array([np.nan], np.float32))
    team = parallel_env(**SMALL)
    team.reset(seed=1)
    with pytest.raises(ValueError, match="pursuer_1"):
        team.step({"evader_1": np.zeros(1, np.float32)})


def test_a_picture_shows_everybody_where_they_are() -> None:
    env = GameEnv(scenario="space", compiled=False, render_mode="rgb_array")
    env.reset(seed=1)
    before = env.render()
    for _ in range(200):
        env.step(np.zeros(env.action_space.shape, np.float32))
    after = env.render()
    assert before.shape == after.shape == (600, 480, 3)
    assert before.dtype == np.uint8
    reds = [np.argwhere((picture == (0xD1, 0x48, 0x0C)).all(axis=2)) for picture in (before, after)]
    assert len(reds[0]) > 20  # the evader's dot
    assert len(reds[1]) > len(reds[0])  # and its way


def place(station: Station, id: int) -> tuple[float, float, float]:
    return next(v for v in station.picture().vehicles if v.id == id).position


@pytest.mark.real
async def test_a_game_in_the_mode_human_is_seen_by_the_ground_station() -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    bus = await open_zenoh(endpoint, listen=True)
    station = Station(bus, RealClock(), StationSetup("training"))
    watching = asyncio.create_task(station.run())
    env = GameEnv("human", False, "training", endpoint, scenario="one-on-one", evader="straight", spread=0.0)

    def play() -> None:
        env.reset(seed=1)
        for _ in range(40):
            env.step(np.zeros(1, np.float32))

    try:
        began = RealClock().monotonic_ns()
        await asyncio.to_thread(play)
        assert RealClock().monotonic_ns() - began > 1.9e9  # two seconds of a game take two seconds
        await until(lambda: {1, 2} <= {v.id for v in station.picture().vehicles})
        picture = station.picture()
        assert picture.game.phase is Phase.RUNNING
        await until(lambda: abs(place(station, 1)[0] - 10.0) < 0.3)
        assert place(station, 1)[2] == -50.0
    finally:
        await asyncio.to_thread(env.close)
        watching.cancel()
        await asyncio.gather(watching, return_exceptions=True)
        await bus.close()


def test_programs_import_none_of_the_libraries() -> None:
    code = (
        "import sys, sim_bridge.cli, onboard.cli, gcs.cli, onboard.game.policy_file;"
        "print([m for m in ('gymnasium', 'pettingzoo', 'numba') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True)
    assert done.stdout.strip() == "[]"


def test_results_of_the_bus_and_the_game_have_the_same_names() -> None:
    for result in GameResult:
        assert result is GameResult.RUNNING or OutcomeResult[result.name]
