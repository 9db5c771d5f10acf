"""What carries tracks forward is chosen in the agent's configuration and in a scenario."""

from __future__ import annotations

from math import sin
from pathlib import Path

import pytest

from onboard.agent.config import load as load_agent
from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec
from onboard.game.scenario import load
from onboard.pilot.memory import Memory
from onboard.pilot.predictor import PredictorKind
from onboard.pilot.predictor_choice import Predicting
from onboard.pilot.setup import TrackSample
from onboard.runtime.clock import VirtualClock
from onboard.runtime.resources import configs
from sim_bridge.rehearsal import Rehearsal

SHARP = (1e-4, 1e-4, 1e-4, -1.0, -1.0, -1.0)  # velocity not measured


def watched(memory: Memory, seconds: float = 30.0) -> Memory:
    """A weaving target 1 and a bystander 3, seen at 10 Hz, with time to learn after each."""
    for n in range(round(10 * seconds)):
        t = n / 10
        weave = Vec(15.0 * t, 20.0 * sin(0.5 * t), -50.0)
        memory.take(tuple(TrackSample(id, t, weave, Vec(15.0, 0.0, 0.0), SHARP) for id in (1, 3)))
        memory.train(t, 4)
    return memory


@pytest.mark.parametrize(
    ("predicting", "speaks"),
    [
        (Predicting.NETWORK, {PredictorKind.NETWORK, PredictorKind.RIDGE}),
        (Predicting.RIDGE, {PredictorKind.RIDGE}),
        (Predicting.CONSTANT_VELOCITY, {PredictorKind.CONSTANT_VELOCITY}),
    ],
    ids=lambda value: value.value if isinstance(value, Predicting) else "",
)
def test_the_chosen_one_speaks(predicting: Predicting, speaks: set[PredictorKind]) -> None:
    memory = watched(Memory(predicting))
    prediction = memory.predict(1, 30.5)
    assert prediction is not None
    assert prediction.source in speaks
    learns = predicting is not Predicting.CONSTANT_VELOCITY
    assert (memory.tracks[1].trainings > 0) == learns
    assert (len(memory.tracks[1].grid) > 0) == learns


def test_what_nobody_asks_for_is_not_learnt() -> None:
    memory = watched(Memory(wanted=(1,)), 5.0)
    assert set(memory.tracks) == {1}
    assert memory.predict(3, 5.0) is None


def test_after_training_the_next_prediction_is_ready() -> None:
    memory = watched(Memory())
    assert memory.tracks[1].ready
    assert memory.predict(1, 30.2) is not None


def test_agent_and_scenario_are_told_by_the_same_words(tmp_path: Path) -> None:
    file = tmp_path / "agent.toml"
    for predicting in Predicting:
        file.write_text(f'prediction = "{predicting.value}"\n', encoding="utf-8")
        assert load_agent(file, {}).prediction is predicting
    file.write_text('prediction = "tea leaves"\n', encoding="utf-8")
    with pytest.raises(ConfigError, match="prediction"):
        load_agent(file, {})


def test_a_scenarios_choice_reaches_its_agents(tmp_path: Path) -> None:
    text = (configs() / "scenarios" / "flight" / "one-on-one.toml").read_text(encoding="utf-8")
    assert "[flight]" in text
    file = tmp_path / "game.toml"
    file.write_text(text.replace("[flight]", '[flight]\nprediction = "ridge"'), encoding="utf-8")
    scenario = load(file)
    assert scenario.flight.prediction is Predicting.RIDGE
    game = Rehearsal(scenario, VirtualClock(0))
    assert {config.prediction for config in game.configuration().values()} == {Predicting.RIDGE}
