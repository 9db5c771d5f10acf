"""A trained policy is a strategy: read strictly, the same onboard and compiled, flown whole."""

from __future__ import annotations

from math import tanh
from pathlib import Path

import numpy as np
import pytest

from onboard.config.strict import ConfigError
from onboard.core.game.advance import begin
from onboard.core.game.referee import GameResult
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.game.views import Nearest, Team, evader_view, pursuer_view, sighted
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec
from onboard.core.strategy.features import Axes, Form, Steering
from onboard.core.strategy.policy import Net, Squash, run, weights_of
from onboard.core.strategy.registry import EVADERS
from onboard.game.plugins import demand_name, evader_strategy, pursuer_strategy
from onboard.game.policy_file import Policy, load, save
from onboard.game.scenario import load as load_scenario
from sim_bridge.campaign.compiled import campaign, starts_of
from sim_bridge.gym.batch import BatchedGames
from sim_bridge.gym.task import Wish, make_task
from sim_bridge.plane_game.setup import conditions_of, game_of
from sim_bridge.programs.campaigns.fingerprint import fingerprint
from sim_bridge.programs.fly import Options, fly
from tests.support.paths import ROOT

EXAMPLE = ROOT / "examples" / "train-pursuer"
TRAINED = EXAMPLE / "pursuer.npz"


def policy(role: str, inputs: int, form: Form, seed: int = 0) -> Policy:
    rng = np.random.default_rng(seed)
    outputs = 1 if form.steering == Steering.HEADING and form.planar else 2 if form.planar else 3
    layers = (
        (rng.normal(size=(8, inputs)), rng.normal(size=8)),
        (rng.normal(size=(outputs, 8)), np.zeros(outputs)),
    )
    return Policy(role, form, Squash.TANH, np.full(inputs, 10.0), layers)


def test_the_network_is_what_matrices_make_of_it() -> None:
    sizes = (3, 5, 4, 2)
    rng = np.random.default_rng(3)
    weights = rng.normal(size=weights_of(sizes))
    x = rng.normal(size=3)
    k = 0
    y = x
    for n, m in ((3, 5), (5, 4), (4, 2)):
        matrix, bias = weights[k : k + n * m].reshape(m, n), weights[k + n * m : k + n * m + m]
        y = matrix @ y + bias
        if m != 2:
            y = np.array([tanh(v) for v in y])
        k += (n + 1) * m
    np.testing.assert_allclose(run(Net(sizes, Squash.TANH), weights.tolist(), x.tolist()), y, rtol=1e-12)
    relu = run(Net((1, 1, 1), Squash.RELU), [2.0, 0.0, 1.0, 0.5], [-1.0])
    assert relu == [0.5]


@pytest.mark.parametrize("steering", list(Steering))
def test_a_file_flies_as_the_environment_acts(steering: Steering, tmp_path: Path) -> None:
    """A game in which the policy's strategy plays, and one whose actions come from its matrices outside."""
    form = Form(Axes.SIGHT, steering, True, 4.0, 0.05)
    file = tmp_path / "one.npz"
    save(file, policy("pursuer", 10, form))
    decide = pursuer_strategy(f"policy:{file}")
    words = {
        "scenario": "one-on-one",
        "evader": "straight",
        "axes": "sight",
        "actions": steering.name.lower(),
    }
    task = make_task(Wish(**words, spread=0.0))  # type: ignore[arg-type]
    outside = BatchedGames(task, 1, compiled=False)
    inside = BatchedGames(
        make_task(Wish(scenario="one-on-one", learn="evader", pursuers=f"policy:{file}", spread=0.0,
                       actions="velocity")), 1, compiled=False)  # fmt: skip
    arrays, other = outside.reset(1), inside.reset(1)
    stored = load(file)
    for _ in range(100):
        y = arrays.pursuers_see[0, 0] / stored.scale
        y = np.tanh(stored.layers[0][0] @ y + stored.layers[0][1])
        arrays.pursuers_act[0, 0] = stored.layers[1][0] @ y + stored.layers[1][1]
        other.evader_acts[0] = (1.0, 0.0)  # straight at the target, as the strategy does
        outside.step()
        inside.step()
        np.testing.assert_allclose(inside.places, outside.places, atol=1e-3)
    assert decide is pursuer_strategy(f"policy:{file}")  # read once


def test_an_evaders_policy_in_space_decides_within_its_limits(tmp_path: Path) -> None:
    form = Form(Axes.NED, Steering.VELOCITY, False, 4.0, 0.05)
    file = tmp_path / "evader.npz"
    save(file, policy("evader", 6 + 2 * 6, form))
    decide = evader_strategy(f"policy:{file}")
    limits = FREE._replace(pitch_min=-0.2, pitch_max=0.2, speed_min=3.0)
    for seed in range(20):
        rng = np.random.default_rng(seed)
        team = tuple(Vehicle(Vec(*rng.normal(0, 50, 3)), Vec(*rng.normal(0, 4, 3)), 4.0) for _ in range(2))
        own = Vehicle(ZERO, Vec(5.0, 0.0, 0.0), 5.0)
        view = evader_view(own, limits, team, Target(True, Vec(100.0, 0.0, 0.0)), ZERO, Rules(R=2.0, rho=4.0))
        decision = decide(view)
        assert np.linalg.norm(decision.direction) == pytest.approx(1.0)
        assert abs(decision.direction.z) <= np.sin(0.2) + 1e-9
        assert 3.0 <= decision.speed <= 5.0


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"role": "referee"}, "role: found 'referee', expected one of: pursuer, evader"),
        ({"axes": 3}, "axes: found"),
        ({"planar": 2}, "planar: found 2, expected 0 to 1"),
        ({"dt": float("nan")}, "dt: found nan"),
        ({"w0": np.zeros((8, 9))}, "w0: found the shape (8, 9), expected (8, 10)"),
        ({"b1": np.array([np.inf])}, "w1, b1: found a number that is not finite"),
        ({"scale": np.zeros(10)}, "scale: found 0, expected numbers above 0"),
        ({"scale": np.ones(9), "w0": np.zeros((8, 9))}, "found 9 inputs, expected 10"),
        ({"w1": None}, "b1: found, expected no such key"),
        ({"colour": 1}, "colour: found, expected no such key"),
        ({"format": 2}, "format: found 2"),
        ({"role": np.array([{}], dtype=object)}, "expected NumPy's .npz"),
    ],
)
def test_a_file_that_is_wrong_is_refused_in_one_line(change: dict, said: str, tmp_path: Path) -> None:
    file = tmp_path / "wrong.npz"
    save(file, policy("pursuer", 10, Form(Axes.NED, Steering.HEADING, True, 4.0, 0.05)))
    with np.load(file) as data:
        content = {key: data[key] for key in data.files} | change
    np.savez(file, **{key: value for key, value in content.items() if value is not None})
    with pytest.raises(ConfigError) as caught:
        load(file)
    assert str(file) in str(caught.value)
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_is_no_policy_at_all_is_refused(tmp_path: Path) -> None:
    for name, content in (("text", b"hello"), ("empty", b""), ("cut", TRAINED.read_bytes()[:500])):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ConfigError, match=name):
            demand_name(f"policy:{tmp_path / name}", "pursuer", "here")
    np.save(tmp_path / "one.npy", np.zeros(3))
    with pytest.raises(ConfigError, match="one array"):
        load(tmp_path / "one.npy")
    with pytest.raises(ConfigError, match=r"^here: strategy: .*nobody.npz: no such file"):
        demand_name(f"policy:{tmp_path}/nobody.npz", "pursuer", "here")
    with pytest.raises(ConfigError, match="is for the role 'pursuer', expected 'evader'"):
        evader_strategy(f"policy:{TRAINED}")


def test_the_trained_pursuer_leads_its_evader_where_a_chase_loses_it() -> None:
    """From starts that training never saw; the same games by pure pursuit."""
    scenario = load_scenario(EXAMPLE / "intercept.toml")
    conditions = conditions_of(scenario)
    rng = np.random.default_rng(11)
    template = game_of(scenario)
    games = []
    for _ in range(30):
        north, east = 90.0 + rng.normal(0.0, 25.0), 40.0 + rng.normal(0.0, 25.0)
        me = template.pursuers[0]
        games.append(begin(template.evader, (me._replace(position=Vec(north, east, 0.0)),), FREE, (FREE,)))
    starts = starts_of(games, [conditions.target.position] * len(games))
    won = {}
    for name in (f"policy:{TRAINED}", "pure-pursuit"):
        ends = campaign(EVADERS["straight"].decide, pursuer_strategy(name), 1, compiled=False)(
            starts, conditions
        )
        won[name] = int(np.sum(ends.verdicts == GameResult.CAPTURED))
    assert won[f"policy:{TRAINED}"] >= 24
    assert won["pure-pursuit"] <= 8


def test_a_policy_that_was_trained_again_is_another_one_to_campaigns(tmp_path: Path) -> None:
    form = Form(Axes.NED, Steering.HEADING, True, 4.0, 0.05)
    file = tmp_path / "one.npz"
    said = []
    for seed in (0, 1, 0):
        save(file, policy("pursuer", 10, form, seed))
        said.append(fingerprint((f"policy:{file}",), flown=False).plugins[f"policy:{file}"])
    assert said[0] == said[2] != said[1]


@pytest.mark.long
def test_compiled_a_policy_decides_as_onboard() -> None:
    import numba

    from sim_bridge.campaign.compiled import KERNELS, in_arrays, register, register_strategies

    decide = pursuer_strategy(f"policy:{TRAINED}")
    register(KERNELS)
    (same,) = in_arrays((decide,))
    register_strategies((same,))
    compiled = numba.njit(lambda view: same(view))
    rng = np.random.default_rng(5)
    for _ in range(50):
        own, e = (Vehicle(Vec(*rng.normal(0, 50, 2), 0.0), Vec(*rng.normal(0, 3, 2), 0.0), 4.0) for _ in "ab")
        team = Team(Nearest(False, ZERO), (own,), 0, Target(False, ZERO))
        view = pursuer_view(
            own, FREE, sighted(e, NORTH, 1.0), team, Control(), Rules(R=2.0, rho=4.0, planar=True)
        )
        np.testing.assert_allclose(compiled(view)[1], decide(view)[1], atol=1e-12)


@pytest.mark.game
def test_the_trained_pursuer_flies_a_copter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)  # the scenario names the policy's file from here
    text = (EXAMPLE / "intercept.toml").read_text(encoding="utf-8")
    short = tmp_path / "short.toml"
    short.write_text(text.replace("[90, 40]", "[50, 20]"), encoding="utf-8")
    flown = fly(short, Options(fast=True, runs=tmp_path, report=False, quiet=True))
    assert flown.summary.verdict == "captured"
    assert flown.summary.captor == 2
