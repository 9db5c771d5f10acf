"""A share of the spatial campaign, played by the kernels that fly.

The whole, 200 seeds a scenario, is `make figures`.
"""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, radians
from pathlib import Path

import msgspec
import numpy as np
import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.core import policy_from_config
from onboard.config.strict import ConfigError
from onboard.core.game.referee import GameResult
from onboard.game.scenario import AirframeKind, Kind, Scenario, load
from onboard.game.staging import setup_of
from onboard.runtime.resources import configs
from onboard.wire.bus.messages import Role
from sim_bridge.campaign.figures import draw_stages
from sim_bridge.campaign.sil_crosscheck import drawn
from sim_bridge.campaign.spatial_campaign import Played, mcnemar, play_seed, reversals, share
from sim_bridge.campaign.spatial_draw import (
    PLACE_SIGMA,
    draw,
    drawn_scenario,
    kernel_of,
    log_of,
    sky_of,
    spatial,
)
from sim_bridge.campaign.spatial_game import Evasion
from sim_bridge.campaign.tracks import track_of
from sim_bridge.draws import Purpose, Stream, key_of
from sim_bridge.vehicle.autopilot.arduplane import ArduPlane
from sim_bridge.vehicle.autopilot.make import autopilot_for
from sim_bridge.world.staging import calm, frame_of, starts

pytestmark = pytest.mark.timeout(
    600
)  # the first test compiles the game; on a busy machine that takes a while


@pytest.fixture(scope="module")
def five() -> Scenario:
    return spatial("five")


@pytest.fixture(scope="module")
def played(five: Scenario) -> Callable[[int, Evasion], Played]:
    games: dict[tuple[int, Evasion], Played] = {}

    def get(seed: int, evasion: Evasion) -> Played:
        if (seed, evasion) not in games:
            games[seed, evasion] = play_seed(five, seed, evasion, compiled=True)
        return games[seed, evasion]

    return get


def test_the_strategy_survives_where_straight_flight_is_captured(
    played: Callable[[int, Evasion], Played],
) -> None:
    ours = [played(seed, Evasion.STRATEGY).verdict for seed in range(12)]
    straight = [played(seed, Evasion.STRAIGHT).verdict for seed in range(12)]
    assert straight.count(GameResult.CAPTURED) >= 3
    assert ours.count(GameResult.CAPTURED) < straight.count(GameResult.CAPTURED)
    assert GameResult.ARRIVED in ours


def test_no_aircraft_leaves_its_limits(played: Callable[[int, Evasion], Played]) -> None:
    for seed in range(12):
        reach = played(seed, Evasion.STRATEGY).play.envelope
        assert radians(-26.0) <= reach.pitch_low <= reach.pitch_high <= radians(26.0)
        assert 0.79 <= reach.speed_low <= reach.speed_high <= 1.005
        assert reach.surface <= 1.0 + 1e-9
        assert reach.lowest > 200.0


def test_mates_keep_apart(five: Scenario, played: Callable[[int, Evasion], Played]) -> None:
    assert five.rules.separation == 100.0
    for seed in range(12):
        team = played(seed, Evasion.STRATEGY).log[:, 1:, :3]
        apart = np.linalg.norm(team[:, :, None] - team[:, None], axis=3) + 1e9 * np.eye(team.shape[1])
        assert float(np.min(apart)) >= 2.0 * five.rules.R


def test_reversals_are_rare(played: Callable[[int, Evasion], Played]) -> None:
    games = [played(seed, Evasion.STRATEGY) for seed in range(12)]
    minutes = sum(game.time for game in games) / 60.0
    assert sum(game.reversals for game in games) / minutes < 0.1
    assert sum(game.decided_reversals for game in games) / minutes < 2.0


def test_interpreted_and_compiled_games_are_the_same(five: Scenario) -> None:
    short = shorten(five, 25.0)
    ours = play_seed(short, 1, Evasion.STRATEGY, compiled=False)
    theirs = play_seed(short, 1, Evasion.STRATEGY, compiled=True)
    assert len(ours.log) == len(theirs.log) == 500
    np.testing.assert_allclose(ours.log, theirs.log, rtol=0.0, atol=1e-9)
    assert float(np.ptp(ours.log[:, 0, 0])) > 500.0


def test_everybody_flies_by_the_strategy_that_the_scenario_names(five: Scenario) -> None:
    replace = msgspec.structs.replace
    short = shorten(five, 8.0)
    named = replace(short, evader=replace(short.evader, strategy="straight"))
    as_straight = play_seed(named, 1, Evasion.STRATEGY, compiled=False)
    straight = play_seed(short, 1, Evasion.STRAIGHT, compiled=False)
    assert np.array_equal(as_straight.log, straight.log)
    last = replace(short.pursuers[-1], strategy="pure-pursuit")
    mixed = play_seed(replace(short, pursuers=(*short.pursuers[:-1], last)), 1, Evasion.STRAIGHT, False)
    # Before anybody has turned, only the last one decides otherwise.
    assert np.array_equal(mixed.log[0, :-1, 4], straight.log[0, :-1, 4])
    assert mixed.log[0, -1, 4] != straight.log[0, -1, 4]


def shorten(scenario: Scenario, horizon: float) -> Scenario:
    return msgspec.structs.replace(
        scenario, parameters=msgspec.structs.replace(scenario.parameters, horizon=horizon)
    )


def test_the_same_seed_plays_the_same_game(five: Scenario, played: Callable[[int, Evasion], Played]) -> None:
    again = play_seed(five, 2, Evasion.STRATEGY)
    assert again.time == played(2, Evasion.STRATEGY).time
    assert np.array_equal(again.log, played(2, Evasion.STRATEGY).log)
    assert played(1, Evasion.STRATEGY).time != played(2, Evasion.STRATEGY).time


def test_figures_show_both_stages(
    five: Scenario, played: Callable[[int, Evasion], Played], tmp_path: Path
) -> None:
    paths = draw_stages(five, played(1, Evasion.STRATEGY), tmp_path, "five")
    assert [path.suffix for path in paths] == [".png", ".svg"]
    assert all(path.stat().st_size > 10_000 for path in paths)


def test_six_pursuers_are_ready_too() -> None:
    six = spatial("six")
    assert len(six.pursuers) == 6
    assert not six.planar
    assert six.rules.rho == 88.0


def test_a_reversal_is_a_turn_and_its_return() -> None:
    still = np.zeros(200)
    assert reversals(still, 40) == 0
    turned = np.concatenate([np.zeros(100), np.full(100, radians(40.0))])
    assert reversals(turned, 40) == 0
    there_and_back = turned.copy()
    there_and_back[115:] = 0.0
    assert reversals(there_and_back, 40) == 1
    slow = np.interp(np.arange(400), [0, 100, 200], [0.0, radians(15.0), 0.0])
    assert reversals(slow, 40) == 0


def test_the_supervisor_s_policy_is_that_of_an_agent_by_its_defaults(five: Scenario) -> None:
    setup = setup_of(five, "game", "master")
    start = draw(five, 0, 0.0, compiled=False).start
    for id, spec, ours, autopilot in zip(
        five.ids, five.vehicles, start.policies, start.autopilots, strict=True
    ):
        role = Role.EVADER if spec is five.evader else Role.PURSUER
        config = AgentConfig(id=id, role=role, game="game")
        assert ours == policy_from_config.policy_of(config, setup, False)
        made = autopilot_for(spec, Kind.ARDUPLANE, id, frame_of(five), starts(five, calm)[id])
        assert isinstance(made, ArduPlane)
        limits = [made.parameters[name] for name in ("ROLL_LIMIT_DEG", "TECS_CLMB_MAX", "TECS_SINK_MAX")]
        assert [degrees(autopilot.bank_max), *autopilot[1:]] == pytest.approx(limits)


def test_what_the_compiled_game_does_not_play_is_refused(five: Scenario) -> None:
    replace = msgspec.structs.replace
    wind = replace(five.flight.wind, correlation_m=200.0)
    with pytest.raises(ConfigError, match=r"wind\.correlation_m: found 200, expected 0"):
        draw(replace(five, flight=replace(five.flight, wind=wind)), 0)
    with pytest.raises(ConfigError, match="airframe: found kinematic"):
        draw(replace(five, flight=replace(five.flight, airframe=AirframeKind.KINEMATIC)), 0)


def test_a_pursuer_more_changes_nobody_s_draw(five: Scenario) -> None:
    fewer = msgspec.structs.replace(five, pursuers=five.pursuers[:-1])
    many, few = (draw(scenario, 3, 2.0, compiled=False) for scenario in (five, fewer))
    count = len(few.players)
    assert many.players[:count] == few.players
    assert many.start.climate == few.start.climate
    for ours, theirs in zip(many.tracks, few.tracks, strict=True):
        part = ours[:, :count] if ours.ndim == 3 else ours[:count]
        np.testing.assert_array_equal(part, theirs)
    assert float(np.ptp(few.tracks.filters[:, 0])) > 0.0


def test_everybody_is_at_its_place_at_the_beginning(five: Scenario) -> None:
    d = draw(five, 5, 3.0, compiled=False)
    scenario = drawn_scenario(five, 5)
    for index, (spec, flown) in enumerate(zip(scenario.vehicles, d.players, strict=True)):
        assert flown.plane.position == pytest.approx(spec.start(), abs=1e-9)
        track = track_of(d.tracks, index, d.start.pace.t0, d.start.fleet.evader.dt)
        assert np.subtract(track.position, spec.start()) == pytest.approx([0.0] * 3, abs=12.0)
        assert float(np.linalg.norm(flown.plane.drift)) > 0.05  # gusts have carried it for a while


def test_intervals_and_the_paired_test() -> None:
    assert share(30, 200) == "30 = 15 % (11–21)"  # Wilson: 0.107 to 0.206
    assert mcnemar(31, 0) < 1e-8
    assert mcnemar(0, 0) == 1.0


def test_a_seed_s_draw_can_be_flown_whole(tmp_path: Path) -> None:
    """Written out as a scenario file it says the same: places, wind, seed, and who flies straight."""
    source = configs() / "scenarios" / "spatial" / "six.toml"
    path = tmp_path / "drawn.toml"
    path.write_text(drawn(source, 7, Evasion.STRAIGHT), encoding="utf-8")
    found, base = load(path), load(source)
    ours = drawn_scenario(base, 7)
    assert [spec.position for spec in found.vehicles] == [tuple(spec.position) for spec in ours.vehicles]
    assert found.evader.strategy == "straight"
    assert found.seed == ours.seed == base.seed + 7
    assert found.parameters == base.parameters
    assert found.flight == ours.flight
    assert found.flight.wind.from_deg != base.flight.wind.from_deg
    assert found.pursuers[0].position != base.pursuers[0].position
    assert drawn_scenario(base, 0) == base


def test_a_log_of_another_width_is_refused_and_not_written_beyond(five: Scenario) -> None:
    d = draw(five, 1, 0.2, compiled=False)
    play = kernel_of(d.sides.evaders, d.sides.pursuers, False)
    log = log_of(d)
    for wrong in (log[:, :, :5], log[:, :4], log[:, :, 0]):
        with pytest.raises(ValueError, match=r"log: shape .*, expected \(steps, 6, 6\)"):
            play(d.start, d.sides.chosen, sky_of(d, False), wrong)


def test_a_scenario_draws_as_a_stream_does_and_each_its_own(five: Scenario) -> None:
    found = drawn_scenario(five, 3)
    for spec, old, id in zip(found.pursuers, five.pursuers, five.ids[1:], strict=True):
        x, y, _z, _spare = Stream(key_of(five.seed + 3, id, Purpose.PLACE), 4).at(0)
        assert spec.position[0] == old.position[0] + PLACE_SIGMA * x
        assert spec.position[1] == old.position[1] + PLACE_SIGMA * y
    # What is kept of a scenario from seed to seed is that scenario's alone.
    rules = msgspec.structs.replace(five.parameters, horizon=77.0)
    other = msgspec.structs.replace(five, parameters=rules)
    for scenario, horizon in (
        (five, five.parameters.horizon),
        (other, 77.0),
        (five, five.parameters.horizon),
    ):
        d = draw(scenario, 2, 0.2, compiled=False)
        assert d.start.conditions.rules.horizon == horizon
        assert d.start.gusts[1] == key_of(scenario.seed + 2, scenario.ids[1], Purpose.GUST)
        assert d.start.eye.keys[1] == key_of(scenario.seed + 2, scenario.ids[1], Purpose.SENSOR)
