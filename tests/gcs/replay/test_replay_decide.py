"""`gcs replay --decide`: a flown game thought again, with the same strategies and with others."""

from __future__ import annotations

import asyncio

import pytest

from gcs.recording.reader import Entry, Recording
from gcs.replay.decide import Comparison, decide
from onboard.config.strict import ConfigError
from onboard.game.scenario import load
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.resources import configs
from onboard.wire.bus.messages import Role
from sim_bridge.rehearsal import Options, Rehearsal
from tests.support.chase_messages import chase


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> list[Entry]:
    """Twelve seconds of a game in which one pursuer hunts one evader, agents and all."""
    folder = tmp_path_factory.mktemp("run")
    scenario = load(configs() / "scenarios" / "flight" / "one-on-one.toml")

    async def fly() -> None:
        async with Rehearsal(scenario, virtual_clock(), Options(folder=folder)):
            await asyncio.sleep(16.0)

    run_virtual(fly())
    return list(Recording(folder / "recording.mcap").entries())


@pytest.fixture(scope="module")
def again(flown: list[Entry]) -> Comparison:
    return decide(flown)


def test_the_same_strategies_decide_the_same_again(again: Comparison) -> None:
    assert again.compared > 100
    assert again.same >= 0.97 * again.compared, "\n".join(again.lines())
    assert again.lines()[0].startswith(f"{again.compared} decisions compared, {again.same} the same")


def test_another_strategy_shows_where_it_differs_and_for_whom(flown: list[Entry], again: Comparison) -> None:
    other = decide(flown, {Role.PURSUER: "pure-pursuit"})
    assert other.compared == again.compared
    assert other.same < 0.7 * other.compared
    mine = [difference for difference in other.differences if difference.id == 2]
    assert mine
    assert all(difference.now == "pure_pursuit" for difference in mine)
    assert sum(d.decisions for d in other.differences if d.id == 1) <= 0.05 * other.compared
    assert "→ pure_pursuit" in "\n".join(other.lines())


def test_a_strategy_that_does_not_exist_is_told_before_anything_else() -> None:
    with pytest.raises(ConfigError, match="found 'wishful', expected one of: paper"):
        decide([], {Role.EVADER: "wishful"})


def test_what_cannot_be_compared_is_counted_by_its_reason() -> None:
    flight = [Entry(*item) for item in chase(4.0)]
    blind = decide([e for e in flight if not e.key.endswith("/state")])
    assert blind.compared == 0
    assert blind.skipped == (("no state of the vehicle at that time", 120),)
    lost = decide([e for e in flight if "/setup" not in e.key])
    assert lost.skipped == (("no setup that names the vehicle", 120),)
    untracked = decide([e for e in flight if "/tracks/" not in e.key])
    assert {why.split(" of ")[0] for why, _ in untracked.skipped} == {"lacks track"}


def test_made_up_decisions_are_found_out() -> None:
    comparison = decide([Entry(*item) for item in chase(4.0)])
    assert comparison.compared > 50
    assert {d.recorded for d in comparison.differences} >= {"towards_target"}
