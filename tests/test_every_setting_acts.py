"""No setting is accepted and then ignored: each key of each kind of file is read where it is to act.

Every struct that a file fills is watched while the product uses one: a key that nobody reads is a promise
that nobody keeps. (That a value makes a difference is shown by the tests of what it sets.)
"""

from __future__ import annotations

import ast
import asyncio
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest

from gcs import settings as gcs_settings
from gcs.picture.thresholds import Thresholds
from onboard.agent import config as agent_config
from onboard.config.strict import StrictConfig, parse
from onboard.game import field_roster, flight_spec, route_file, scenario, vehicle_spec, zone_spec
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.resources import configs
from sim_bridge.plane_game.program import play, result, table1
from sim_bridge.programs.scenario_tools import check
from sim_bridge.rehearsal import Options, Rehearsal
from sim_bridge.vehicle.flight import aircraft

GAME = """
name = "every key"
description = "with everything in it"
seed = 3
[evader]
position = [0, 0]
speed = 5
target = [150, 0]
[[pursuers]]
position = [90, 40]
speed = 4
[[pursuers]]
position = [-90, 40]
speed = 40
autopilot = "arduplane"
airframe = "nose"
[[zones]]
name = "tower"
centre = [70, -60]
radius = 10
[parameters]
horizon = 1.0
[flight]
ready_s = 0.5
prediction = "constant-velocity"
[flight.fence]
polygon = [[-500, -500], [500, -500], [500, 500], [-500, 500]]
height_min = 0
height_max = 500
[flight.wind]
speed = 1.0
[flight.simulated.parameters]
WPNAV_SPEED = 900.0
"""
AGENT = """
field = true
open_bus = true
bus = "tcp/127.0.0.1:1"
log = "a.tlog"
events = "a.events"
[safety.fence]
polygon = [[-500, -500], [500, -500], [500, 500], [-500, 500]]
height_min = 0
height_max = 500
"""


def structs(*rooms: Any) -> set[type[msgspec.Struct]]:
    """The structs of modules that files fill: those that are defined there, or derived for them."""
    return {
        kind for room in rooms for kind in vars(room).values()
        if isinstance(kind, type) and issubclass(kind, StrictConfig) and kind.__module__ == room.__name__
    }  # fmt: skip


SCENARIO = (scenario, vehicle_spec, flight_spec, zone_spec)
OWN = (
    "__post_init__",
    "_demand_what_flies",
    "_demand_players",
)  # a struct that checks itself reads for nobody


class Watch:
    """Which keys of which structs were read, other than by the structs themselves."""

    def __init__(self) -> None:
        self.read: dict[str, set[str]] = defaultdict(set)

    def over(self, kinds: set[type[msgspec.Struct]], patch: pytest.MonkeyPatch) -> None:
        """Watch these structs."""
        for kind in kinds:
            patch.setattr(kind, "__getattribute__", self._watched(set(kind.__struct_fields__)), raising=False)

    def unread(self, kinds: set[type[msgspec.Struct]]) -> set[str]:
        """`Struct.key` of what nobody has read."""
        return {
            f"{kind.__name__}.{key}"
            for kind in kinds for key in kind.__struct_fields__ if key not in self.read[kind.__name__]
        }  # fmt: skip

    def _watched(self, keys: set[str]) -> Any:
        def look(struct: Any, name: str) -> Any:
            if name in keys and sys._getframe(1).f_code.co_name not in OWN:
                self.read[type(struct).__name__].add(name)
            return object.__getattribute__(struct, name)

        return look


@pytest.fixture
def watch() -> Iterator[Watch]:
    with pytest.MonkeyPatch.context() as patch:
        found = Watch()
        found.over(structs(*SCENARIO, agent_config, route_file, field_roster, gcs_settings, aircraft), patch)
        found.over({Thresholds}, patch)
        yield found


def test_every_key_of_scenario_aircraft_and_agent_is_read(
    watch: Watch, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    game_played(tmp_path)
    agent_checked_and_started(tmp_path)
    kinds = structs(*SCENARIO, aircraft, agent_config) - {vehicle_spec.Player}  # the base of VehicleSpec
    assert len(kinds) > 20
    elsewhere = {
        "AgentConfig.route", "AgentConfig.track_ahead_s",  # of a tracker: route_player
        "SigningConfig.link_id",  # of signed links: agent/core/machine
        "Spec.name", "Spec.description",  # printed by sim-bridge design
    }  # fmt: skip
    assert watch.unread(kinds) == elsewhere


def game_played(tmp_path: Path) -> None:
    """A game in the air, in the plane, and checked."""
    game = parse(GAME, scenario.Scenario, "game.toml")
    aircraft.load.cache_clear()

    async def flown() -> None:
        fenced = parse(AGENT, agent_config.AgentConfig, "agent.toml").safety
        options = Options(folder=tmp_path, configure={2: {"safety": fenced}})
        async with Rehearsal(game, virtual_clock(), options) as playing:
            await playing.until(lambda: playing.now > 0.2, 60.0)

    run_virtual(flown())
    check(game)
    for strategy in ("paper", "earlier"):
        result(play(scenario.load(table1()[0]), strategy, 1.0, keep=False))
    aircraft.load.cache_clear()


def agent_checked_and_started(tmp_path: Path) -> None:
    """An agent as a process has it: its preflight, its files, its links."""
    from onboard.agent.opening import refuse_open_bus, security
    from onboard.agent.preflight import preflight
    from tests.support.sim_bridge_process import free_port

    key = tmp_path / "key"
    key.write_bytes(bytes(32))
    key.chmod(0o600)
    (tmp_path / "agent.toml").write_text(
        f'link = ["udpin://127.0.0.1:{free_port()}"]\n{AGENT}[signing]\nkey = "{key}"\n', encoding="utf-8"
    )
    config = agent_config.load(tmp_path / "agent.toml", {})
    far = msgspec.structs.replace(config, bus="tcp/192.168.10.1:7447")
    refuse_open_bus(far, security(far))
    asyncio.run(asyncio.wait_for(preflight(config, 0.5, lambda line: None), 60.0))
    asyncio.run(agent_opened(config))


async def agent_opened(config: agent_config.AgentConfig) -> None:
    """What a started agent opens: its files, its links, its bus."""
    from onboard.agent.opening import close_bus, open_bus, open_links, signing_of
    from onboard.agent.written_files import WrittenFiles

    files = WrittenFiles(config)
    signing_of(config, files.stamps)
    for link in await open_links(config):
        link.close()
    await close_bus(await open_bus(config))
    assert files.close()


def test_every_key_of_a_route_and_of_a_roster_is_read(watch: Watch, tmp_path: Path) -> None:
    from gcs.keys import program

    route_file.load_route(configs() / "routes" / "twenty_km.toml")
    program.init(configs() / "field" / "roster.toml", tmp_path / "keys")
    program.sheet(tmp_path / "keys")
    checked = {"RouteSpec.ground"}  # by the struct itself: waypoints lie above it
    assert watch.unread(structs(route_file, field_roster)) == checked


def test_every_key_of_a_station_is_read() -> None:
    """A station is never run whole without a bus: here its sources are read for the keys instead."""
    kinds = structs(gcs_settings) | {Thresholds}
    read: set[str] = set()
    for path in (Path(gcs_settings.__file__).parent).rglob("*.py"):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and node.name in {kind.__name__ for kind in kinds}:
                continue
            read |= {inner.attr for inner in ast.walk(node) if isinstance(inner, ast.Attribute)}
    keys = {key for kind in kinds for key in kind.__struct_fields__}
    assert len(keys) > 20
    assert keys <= read
