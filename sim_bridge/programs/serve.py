"""`sim-bridge serve`: the simulated autopilots on UDP, the sensor and the master on the bus, in real time."""

from __future__ import annotations

import asyncio
import contextlib
import secrets
import signal
from collections import Counter
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path

import msgspec

from onboard.config.names import game_name
from onboard.config.strict import ConfigError
from onboard.game.master import Standing
from onboard.game.scenario import Scenario, load
from onboard.runtime.bus_field import FieldBus
from onboard.runtime.bus_zenoh import ZenohBus, open_zenoh
from onboard.runtime.clock import RealClock, SteadyClock
from onboard.runtime.impairment import CLEAR, Impaired
from onboard.runtime.links import open_udp
from onboard.runtime.protocols import Bus, Link
from onboard.runtime.spoken_lines import SpokenLines
from onboard.runtime.tasks import Pace, periodic
from onboard.wire.bus.messages import Event, Outcome, Phase
from onboard.wire.bus.topics import DEFAULT_GAME, EVENTS, Dispatcher
from sim_bridge.world.bridge import Bridge
from sim_bridge.world.bridge import Options as BridgeOptions
from sim_bridge.world.radio import GROUND_STATIONS, Radio, agent_ports
from sim_bridge.world.staging import generator, impairment_of, kind_of

HOST = "127.0.0.1"
STOPPING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
Started = Callable[[Bridge, ZenohBus, dict[int, int]], None]  # the bridge, its bus, the agents' ports
Ending = Callable[[], Awaitable[None]]


class Options(msgspec.Struct, frozen=True, kw_only=True):
    """What `serve` can be told."""

    game: str = DEFAULT_GAME
    bus: str = ""  # Zenoh endpoint; "" = tcp/127.0.0.1:7447
    listen: bool = False  # be the one the others connect to
    zenoh: Path | None = None  # Zenoh configuration file
    host: str = HOST
    referee: bool = True  # be the game's master, unless another one is
    once: bool = False  # end when the game has ended
    seed: int | None = None  # in place of the scenario's
    ports: Path | None = None  # JSON file to write the agents' ports to
    ground_stations: bool = True  # send to 14550 too


def serve(scenario: Path, options: Options) -> Outcome | None:
    """Serve a scenario file until ctrl-C or SIGTERM (or the game's end); gives the outcome if there was one.

    Raises ConfigError: a wrong scenario, a port or a bus that cannot be.
    """
    lines = SpokenLines()
    try:
        return asyncio.run(serve_scenario(load(scenario, several=True), options, lines.say, scenario.parent))
    finally:
        lines.close()


async def serve_scenario(
    scenario: Scenario,
    options: Options,
    say: Callable[[str], None],
    folder: Path | None = None,
    started: Started | None = None,
    ending: Ending | None = None,
) -> Outcome | None:
    """Serve a scenario on the running loop; recordings of wind lie in `folder`.

    `started` is told once the bridge answers; `ending` is awaited before the vehicles stop flying.
    """
    game_name(options.game)
    loop, stop = asyncio.get_running_loop(), asyncio.Event()
    radios: dict[int, Radio] = {}
    bus: ZenohBus | None = None
    try:
        for number in STOPPING:
            with contextlib.suppress(ValueError, NotImplementedError):  # not on the main thread
                loop.add_signal_handler(number, stop.set)
        ports = agent_ports(scenario.ids, options.host)
        for id in scenario.ids:
            peers = [(options.host, ports[id])]
            if options.ground_stations:
                peers.append((options.host, GROUND_STATIONS))
            radios[id] = Radio(await open_udp(options.host, 0), peers)
        bus = await open_zenoh(options.bus or None, listen=options.listen, config_file=options.zenoh)
        links: dict[int, Sequence[Link]] = {id: (radio,) for id, radio in radios.items()}
        if (impairment := impairment_of(scenario)) != CLEAR:
            seed = scenario.seed if options.seed is None else options.seed
            for id, radio in radios.items():
                links[id] = (Impaired(radio, impairment, generator(seed, f"link-{id}")),)
        bridge_options = BridgeOptions(
            secrets.randbits(48), options.game, options.seed, folder, options.referee
        )
        if isinstance(bus, FieldBus):
            bridge_options = bridge_options._replace(name=bus.member.name)
        clock = SteadyClock(RealClock())  # a game outlives a clock that is set
        bridge = Bridge(scenario, clock, bus, links, bridge_options, say)
        _introduce(scenario, options, ports, radios, bus, say)
        if started is None:  # else somebody brings the agents
            say("agents: onboard-agent --id N --role ROLE --take-control; without it they wait for a start")
        _tell_of_doubles(bus, options.game, say)
        if started is not None:
            started(bridge, bus, ports)
        await _until_stopped(bridge, bus, options, stop, say, ending)
        bridge.close()
        return bridge.master.rules.outcome if bridge.master is not None else None
    finally:
        for number in STOPPING:
            with contextlib.suppress(ValueError, NotImplementedError):
                loop.remove_signal_handler(number)
        for radio in radios.values():
            radio.close()
        if bus is not None:
            await bus.close()


async def _until_stopped(
    bridge: Bridge,
    bus: ZenohBus,
    options: Options,
    stop: asyncio.Event,
    say: Callable[[str], None],
    ending: Ending | None,
) -> None:
    last = bus.status()

    def watch() -> None:
        nonlocal last
        status = bus.status()
        if status != last:
            last = status
            say(f"bus: {status}")
        rules = bridge.master.rules if bridge.master is not None else None
        over = rules is not None and (rules.phase is Phase.RECOVERY or rules.standing is Standing.YIELDED)
        if options.once and over:
            stop.set()

    async with asyncio.TaskGroup() as group:
        tasks = [
            group.create_task(bridge.run(), name="world"),
            group.create_task(periodic(Pace("watch", 0.5), watch, RealClock()), name="watch"),
        ]
        await stop.wait()
        if ending is not None:
            await ending()
        for task in tasks:
            task.cancel()


def _tell_of_doubles(bus: Bus, game: str, say: Callable[[str], None]) -> None:
    """Say where another autopilot, a real one perhaps, has a simulated vehicle's id: agents hear both."""
    told: set[int] = set()

    def hear(event: Event) -> None:
        if event.kind == "second_autopilot" and event.id not in told and len(told) < 250:
            told.add(event.id)
            say(f"vehicle {event.id}: another autopilot has this id, its agent hears both: {event.text}")

    bus.subscribe(EVENTS.key(game), Dispatcher(Counter()).on(EVENTS, hear))


def _introduce(
    scenario: Scenario,
    options: Options,
    ports: dict[int, int],
    radios: dict[int, Radio],
    bus: ZenohBus,
    say: Callable[[str], None],
) -> None:
    say(
        f"{scenario.name}: {len(scenario.ids)} vehicles, game '{options.game}', seed "
        f"{scenario.seed if options.seed is None else options.seed}"
    )
    for id, spec in zip(scenario.ids, scenario.vehicles, strict=True):
        role = scenario.role_of(id).value
        say(
            f"  vehicle {id:3d}  {role:8s} {kind_of(scenario, spec).value:10s}  agent on udp {options.host}:"
            f"{ports[id]}  autopilot at {radios[id].address[1]}"
        )
    if options.ground_stations:
        say(f"  ground stations on udp {options.host}:{GROUND_STATIONS}")
    if scenario.flight.impairment.bus:
        say("note: datagrams are impaired, the bus is not: impairment.bus counts with fly --fast alone")
    say(f"bus: {bus.status()}")
    if options.ports is not None:
        try:
            options.ports.write_bytes(msgspec.json.encode({str(id): port for id, port in ports.items()}))
        except OSError as error:
            raise ConfigError(f"{options.ports}: {(error.strerror or str(error)).lower()}") from None
