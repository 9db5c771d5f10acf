"""A share of the spatial campaign, played by the kernels that fly.

The whole, 200 seeds a scenario, is `make figures`.
"""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from pathlib import Path

import numpy as np
import pytest

from onboard.core.game.referee import GameResult
from onboard.core.math.states import VehicleLimits
from onboard.game.scenario import Scenario, load
from onboard.runtime.resources import configs
from sim_bridge.campaign.figures import draw_stages
from sim_bridge.campaign.sil_crosscheck import drawn
from sim_bridge.campaign.spatial_campaign import (
    Played,
    draw,
    filtered,
    mcnemar,
    play_seed,
    reversals,
    share,
    spatial,
)
from sim_bridge.campaign.spatial_game import Band, Evasion, banded

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
        assert radians(-25.0) <= reach.pitch_low <= reach.pitch_high <= radians(25.0)
        assert 0.79 <= reach.speed_low <= reach.speed_high <= 1.001
        assert reach.surface <= 1.0 + 1e-9
        assert reach.lowest > 200.0


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


def shorten(scenario: Scenario, horizon: float) -> Scenario:
    import msgspec

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


def test_the_pitch_limits_close_at_the_band_s_edges() -> None:
    limits = VehicleLimits(40.0, 50.0, radians(-20.0), radians(20.0))
    band = Band(300.0, 3000.0)
    middle = banded(limits, 1500.0, band)
    assert (middle.pitch_min, middle.pitch_max) == (limits.pitch_min, limits.pitch_max)
    assert banded(limits, 300.0, band).pitch_min == 0.0
    assert banded(limits, 250.0, band).pitch_min > 0.0  # back up
    assert banded(limits, 3010.0, band).pitch_max < 0.0


def test_the_track_noise_keeps_its_variance() -> None:
    noise = filtered(np.random.default_rng(0).standard_normal((40_000, 2)), 0.05)
    assert np.std(noise) == pytest.approx(1.0, abs=0.05)
    assert np.corrcoef(noise[:-1, 0], noise[1:, 0])[0, 1] == pytest.approx(np.exp(-0.05 / 0.8), abs=0.01)


def test_intervals_and_the_paired_test() -> None:
    assert share(30, 200) == "30 = 15 % (11–21)"  # Wilson: 0.107 to 0.206
    assert mcnemar(31, 0) < 1e-8
    assert mcnemar(0, 0) == 1.0


def test_a_seed_s_draw_can_be_flown_whole(tmp_path: Path) -> None:
    """Written out as a scenario file it says the same: places, wind, and who flies straight."""
    source = configs() / "scenarios" / "spatial" / "six.toml"
    path = tmp_path / "drawn.toml"
    path.write_text(drawn(source, 7, Evasion.STRAIGHT), encoding="utf-8")
    found, base = load(path), load(source)
    d = draw(base, 7)
    for spec, flown in zip(found.vehicles, d.players, strict=True):
        assert spec.start() == pytest.approx(flown.plane.position, abs=1e-3)
    assert found.evader.strategy == "straight"
    assert found.seed == 7
    assert found.parameters == base.parameters
    assert found.flight.fence == base.flight.fence
    assert (found.pursuers[0].position == base.pursuers[0].position) is False
    from sim_bridge.vehicle.wind.field import wind_vector

    wind = found.flight.wind
    assert wind_vector(wind.speed, wind.from_deg) == pytest.approx(d.start.climate.reference, abs=1e-4)
