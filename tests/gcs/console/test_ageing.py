"""Nothing that is no longer fed is shown as current: no cell, no line and no clock."""

from __future__ import annotations

import asyncio
import re

import pytest

from gcs.console.app import Console
from gcs.console.detail import detail
from gcs.console.plain_lines import status
from gcs.console.plan import START, fitted, plan
from gcs.console.status_line import status_line
from gcs.console.vehicle_table import COLUMNS, Row, rows
from gcs.console.widgets import StatusBar, VehicleTable
from gcs.picture.current import current
from gcs.picture.values import Picture
from gcs.station import Station, StationSetup
from onboard.runtime.loop import run_virtual
from onboard.wire.bus import messages
from onboard.wire.bus.messages import Phase, SupervisorAction
from tests.gcs.console.test_console import Desk
from tests.support.sample_messages import START_NS, Tower, decision, health, phase, setup, state
from tests.support.small_scenarios import chase
from tests.support.whole_games import at_phase, game_of

HEADINGS = [column.heading for column in COLUMNS]
UNKNOWN = {"–", "0%"}
FED_BY_AUTOPILOT = ("mode", "batt", "link", "hgt", "m/s", "to ev")


def cells(picture: Picture) -> dict[int, dict[str, str]]:
    """What the table shows, by vehicle and heading."""
    table: list[Row] = rows(current(picture), "id", False)
    return {row.id: dict(zip(HEADINGS, row.cells, strict=True)) for row in table}


async def _play() -> list[Picture]:
    """A game under way; ten seconds after the bridge was killed; ten seconds after the agents were, too."""
    found = []
    async with game_of(chase()) as game:
        station = Station(game.broker.connect("gcs"), game.clock, StationSetup(game.game, "gcs/anna"))
        task = asyncio.create_task(station.run())
        await at_phase(game, Phase.RUNNING)
        await game.forward(4.0)
        found.append(station.picture())
        assert game._world is not None
        game._world.cancel()
        await asyncio.sleep(10.0)
        found.append(station.picture())
        for id in list(game.agents):
            game.kill_agent(id)
        await asyncio.sleep(10.0)
        found.append(station.picture())
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
    return found


@pytest.fixture(scope="module")
def played() -> list[Picture]:
    return run_virtual(_play())


def test_while_all_is_fed_all_is_shown(played: list[Picture]) -> None:
    for id, row in cells(played[0]).items():
        fed = [row[heading] for heading in FED_BY_AUTOPILOT if (id, heading) != (1, "to ev")]
        assert not UNKNOWN.intersection(fed)
    assert re.fullmatch(r"T\+4\.\d s", played[0].game.clock)


@pytest.mark.game
def test_ten_seconds_after_the_bridge_was_killed_no_cell_claims_what_it_fed(played: list[Picture]) -> None:
    for row in cells(played[1]).values():
        assert {row[heading] for heading in FED_BY_AUTOPILOT} <= UNKNOWN
        assert row["link"] == "0%"
        assert row["age"] == "<1"  # its agent lives, and says so
        assert row["stage"] == "held"
        assert row["rule"].startswith("END")  # what is in force, and no rule
    assert re.fullmatch(r"T\+[34]\.\d s when its master was last heard, 1\d s ago", played[1].game.clock)
    assert played[1].assessments == ()


@pytest.mark.game
def test_ten_seconds_after_all_was_killed_nothing_is_claimed(played: list[Picture]) -> None:
    for id, row in cells(played[2]).items():
        assert row.pop("id") == str(id)
        assert row.pop("role") in ("evad", "purs")
        assert (row.pop("health"), row.pop("age")) == ("LOST", "10")
        assert set(row.values()) == {"–"}
    for line in status(played[2])[1:]:
        assert re.search(r"LOST no mode no health link unknown battery unknown heard 10 s ago$", line)
    for id in (1, 2):
        said = "\n".join(text for text, _ in detail(played[2], id))
        for last in ("last at N ", "last mode GUIDED", "last battery "):
            assert re.search(rf"{last}.* \d+ s ago", said), said
        assert not re.search(r"^at N|m/s to|closing|link \d", said, re.MULTILINE)


async def drawn(tower: Tower) -> str:
    """Status line and table as the console has them."""
    app = Console(Desk(tower))
    async with app.run_test(size=(120, 30)) as pilot:
        await pilot.pause()
        return app.query_one(StatusBar).text + "\n" + app.query_one(VehicleTable).text


@pytest.mark.parametrize("seconds", [10.0, 100.0])
async def test_what_was_fed_last_makes_no_difference_to_what_is_shown_as_current(seconds: float) -> None:
    """Two fleets that differ in everything that may change, fallen silent at the same instant."""
    shown = []
    for other in (False, True):
        tower = Tower()
        tower.hear(setup(3), messages.Master("bridge", START_NS))
        tower.hear(phase(Phase.RUNNING, START_NS - 5_000_000_000))
        tower.wait(1.0)
        for i in (1, 2, 3):
            shift = 7.0 * i if other else 0.0
            tower.hear(
                state(i, tower.now_ns, position=(50.0 + shift, 20.0 - shift, -40.0 - shift),
                      velocity=(3.0 + shift, 0.0, 0.0), mode="GUIDED" if other else "LOITER"),
                decision(i, tower.now_ns, rule="parallel" if other else "intercept",
                         supervisor=SupervisorAction.HOLD if other else SupervisorAction.OK),
                health(i, tower.now_ns, battery=0.5 if other else 0.9, link_quality=0.8 if other else 1.0,
                       mode="GUIDED" if other else "LOITER"),
            )  # fmt: skip
        tower.hear(messages.Master("bridge", tower.now_ns))
        tower.wait(seconds)
        shown.append((await drawn(tower), status(tower.picture)))
    assert shown[0] == shown[1]


def test_a_clock_ends_with_its_game() -> None:
    tower = Tower()
    tower.hear(setup(2), messages.Master("bridge", START_NS, lease_s=1e3), phase(Phase.RUNNING, START_NS))
    tower.wait(30.0)
    tower.hear(
        messages.Outcome(messages.OutcomeResult.CAPTURED, 12.3, 2, 1.9, tower.now_ns),
        phase(Phase.ENDED, START_NS),
    )
    tower.wait(50.0)
    assert tower.picture.game.clock == "T+12.3 s"
    assert "T+12.3 s" in status_line(tower.picture, "live", "", 120)[0][0]


def test_on_the_plan_an_old_place_is_where_somebody_was() -> None:
    tower = Tower()
    tower.hear(setup(2))
    tower.fly(1.0, 1, 2)
    tower.hear(decision(2, tower.now_ns, aim=(0.0, 150.0, -50.0)))
    view = fitted(START, tower.picture, 60, 20)
    before = "\n".join("".join(text for text, _ in row) for row in plan(tower.picture, view, 60, 20, 2))
    for _ in range(10):  # the agent lives, its autopilot is silent
        tower.wait(1.0)
        tower.hear(health(2, tower.now_ns, heartbeat_age_s=9.0, telemetry_age_s=9.0))
    after = "\n".join("".join(text for text, _ in row) for row in plan(tower.picture, view, 60, 20, 2))
    assert "[2]" in before
    assert "✕[2]" not in before
    assert "✕[2]" in after
    assert ("×" in before, "×" in after) == (True, False)  # its aim
