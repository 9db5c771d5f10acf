"""`serve` for real: UDP, Zenoh, signals. Vehicle ids above ten, so that ports are free ones."""

from __future__ import annotations

import asyncio
import json
import signal
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from onboard.config.strict import ConfigError
from onboard.game.scenario import Flight, ImpairmentSpec, Kind, Parameters, Scenario, VehicleSpec
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.clock import RealClock
from onboard.runtime.links import open_udp
from onboard.wire.bus.messages import Event, OutcomeResult, Severity
from onboard.wire.bus.topics import EVENTS, SETUP, TRACK
from onboard.wire.mavlink.commands import set_message_interval
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.programs.serve import Options, _tell_of_doubles, serve, serve_scenario
from sim_bridge.world.bridge import Bridge
from sim_bridge.world.radio import CALLERS_MAX, Radio, agent_ports
from tests.support.bus_stages import Heard, free_port
from tests.support.real_time import patience, until
from tests.support.scripted_agents import ScriptedAgent
from tests.support.scripted_companion import Companion

SCENARIO = Scenario(
    name="served",
    evader=VehicleSpec(position=(0.0, 0.0), speed=4.0, id=31, target=(50.0, 0.0)),
    pursuers=(VehicleSpec(position=(30.0, 0.0), speed=5.0, id=32),),
    parameters=Parameters(horizon=1.0),
    flight=Flight(autopilot=Kind.PX4, ready_s=0.5),
)
TOML = """
name = "served"
[evader]
id = 31
position = [0, 0]
speed = 4.0
target = [50, 0]
[[pursuers]]
id = 32
position = [30, 0]
speed = 5.0
"""


def test_the_first_ten_vehicles_have_the_ports_everybody_knows() -> None:
    ports = agent_ports([1, 2, 10, 11, 12], "127.0.0.1")
    assert [ports[id] for id in (1, 2, 10)] == [14540, 14541, 14549]
    assert len(set(ports.values())) == 5
    assert 14550 not in ports.values()


def test_a_host_that_is_not_ours_is_one_clear_line() -> None:
    with pytest.raises(ConfigError, match=r"^host: found 192\.0\.2\.1, "):
        agent_ports([11], "192.0.2.1")


@pytest.mark.real
async def test_a_radio_answers_who_calls_and_forgets_the_oldest() -> None:
    agent = await open_udp("127.0.0.1", 0)
    radio = Radio(await open_udp("127.0.0.1", 0), [agent.address])
    callers = [await open_udp("127.0.0.1", 0) for _ in range(CALLERS_MAX + 1)]
    heard: list[bytes] = []
    radio.receive(lambda data, peer: heard.append(data))
    try:
        for number, caller in enumerate(callers):
            caller.send(bytes([number]), radio.address)
            await until(lambda number=number: bytes([number]) in heard)  # type: ignore[misc]
        radio.send(b"to all")
        await until(lambda: all(caller.counters().get("received") for caller in callers[1:]))
        await until(lambda: agent.counters().get("received"))
        assert "received" not in callers[0].counters()
    finally:
        radio.close()
        for link in (agent, *callers):
            link.close()


@pytest.mark.real
async def test_a_served_game_from_the_first_heartbeat_to_the_outcome(tmp_path: Path) -> None:
    endpoint, ports_file = f"tcp/127.0.0.1:{free_port()}", tmp_path / "ports.json"
    options = Options(bus=endpoint, listen=True, once=True, ports=ports_file, ground_stations=False)
    said: list[str] = []
    game = asyncio.create_task(serve_scenario(SCENARIO, options, said.append))
    await until(ports_file.exists)
    await until(lambda: any(line.startswith("bus: ") for line in said))
    ports = {int(id): port for id, port in json.loads(ports_file.read_bytes()).items()}
    links = {id: await open_udp("127.0.0.1", port) for id, port in ports.items()}
    bus = await open_zenoh(endpoint)
    try:
        companions = {id: Companion(link, id) for id, link in links.items()}
        await until(lambda: all(companion.heard("HEARTBEAT") for companion in companions.values()))
        assert {p.system for p in companions[32].packets} == {32}
        wish = dialect.MAVLINK_MSG_ID_GLOBAL_POSITION_INT
        companions[32].send(set_message_interval(companions[32].target, wish, 20.0))
        await until(lambda: companions[32].heard("COMMAND_ACK"))
        setup, tracks = Heard(bus, SETUP.key("game")), Heard(bus, TRACK.key("game", 31))
        agents = [ScriptedAgent(bus, RealClock(), "game", id) for id in (31, 32)]
        async with asyncio.TaskGroup() as group:
            beating = [group.create_task(agent.run()) for agent in agents]
            async with asyncio.timeout(patience(20.0)):
                outcome = await game
            for task in beating:
                task.cancel()
        assert outcome is not None
        assert outcome.verdict == OutcomeResult.DENIED
        assert setup.samples
        assert len(tracks.samples) > 5
        assert said[0] == "served: 2 vehicles, game 'game', seed 0"
        assert f"bus: listening at {endpoint}; nobody there" in said
    finally:
        game.cancel()
        for link in links.values():
            link.close()
        await bus.close()


@pytest.mark.real
@pytest.mark.parametrize("loss", [0.0, 1.0])
async def test_what_happens_to_datagrams_happens_in_real_time_too(loss: float) -> None:
    impairment = ImpairmentSpec(loss=loss, bus=True)
    flight = msgspec.structs.replace(SCENARIO.flight, impairment=impairment)
    scenario = msgspec.structs.replace(SCENARIO, flight=flight)
    said: list[str] = []
    served: list[tuple[Bridge, dict[int, int]]] = []
    options = Options(bus=f"tcp/127.0.0.1:{free_port()}", listen=True, ground_stations=False)
    game = asyncio.create_task(
        serve_scenario(
            scenario, options, said.append, None, lambda bridge, bus, ports: served.append((bridge, ports))
        )
    )
    await until(lambda: served)
    bridge, ports = served[0]
    agent = await open_udp("127.0.0.1", ports[31])
    link = bridge.world.vehicles[31].links[0]
    try:
        if loss:
            await until(lambda: link.counters().get("out_lost", 0) > 5)
            assert agent.counters().get("received", 0) == 0
        else:
            await until(lambda: agent.counters().get("received", 0) > 5)
        assert any(line.startswith("note: datagrams are impaired, the bus is not") for line in said)
    finally:
        game.cancel()
        agent.close()
        await asyncio.gather(game, return_exceptions=True)


@pytest.mark.real
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_cleanly(number: signal.Signals, tmp_path: Path) -> None:
    scenario = tmp_path / "served.toml"
    scenario.write_text(TOML)
    program = (
        "import sys; from pathlib import Path; from sim_bridge.programs.serve import Options, serve\n"
        f"serve(Path({str(scenario)!r}), Options(bus='tcp/127.0.0.1:{free_port()}', listen=True))\n"
        "print('ended')"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        assert child.stdout is not None
        for line in child.stdout:
            if line.startswith("bus: listening"):
                break
        child.send_signal(number)
        out, err = child.communicate(timeout=patience(10.0))
    finally:
        child.kill()
    assert child.returncode == 0, err
    assert out.endswith("ended\n")
    assert err == ""


def test_a_wrong_scenario_is_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"none\.toml: no such file"):
        serve(tmp_path / "none.toml", Options())


async def test_another_autopilot_with_a_simulated_vehicles_id_is_said_once() -> None:
    broker, said = MemoryBroker(), list[str]()
    _tell_of_doubles(broker.connect(), "g", said.append)
    agent = broker.connect()
    text = "two autopilots with system id 31: on one link; give each an id of its own"
    for number, kind in enumerate(("started", "second_autopilot", "second_autopilot")):
        event = Event(31, number + 1, 0, Severity.ERROR, kind, text)
        agent.publish(EVENTS.key("g", 31), EVENTS.encode(event), EVENTS.delivery)
    await until(lambda: bool(said))
    assert said == [f"vehicle 31: another autopilot has this id, its agent hears both: {text}"]
