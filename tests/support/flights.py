"""Small games for stories about agents: one evader, one or two pursuers, everything in virtual time."""

from __future__ import annotations

from collections import Counter
from typing import Any

from onboard.agent.shell import Agent
from onboard.autopilot.base import Stage
from onboard.core.math.vectors import Vec, norm
from onboard.game.scenario import (
    FenceSpec,
    Flight,
    ImpairmentSpec,
    Kind,
    Parameters,
    Scenario,
    VehicleSpec,
)
from onboard.runtime.loop import virtual_clock
from onboard.wire.bus import messages as swarm
from onboard.wire.bus.messages import Command, CommandKind, CommandReply, Phase
from onboard.wire.bus.topics import COMMAND, key
from sim_bridge.rehearsal import Rehearsal
from sim_bridge.vehicle.autopilot.autopilot import Autopilot

EVADER, PURSUER, MATE = 1, 2, 3
PLANES = (Kind.ARDUPLANE,)


def chase(kind: Kind = Kind.ARDUCOPTER, *, pursuers: int = 1, **flight: Any) -> Scenario:
    """A chase that goes on for a minute or more: the pursuers start behind a faster evader."""
    scale = 10.0 if kind in PLANES else 1.0
    places = ((-60.0, 40.0), (-60.0, -40.0), (-90.0, 0.0))
    return Scenario(
        name="chase",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0 * scale, target=(400.0 * scale, 0.0)),
        pursuers=tuple(
            VehicleSpec(position=(x * scale, y * scale), speed=4.0 * scale) for x, y in places[:pursuers]
        ),
        parameters=Parameters(horizon=100.0),
        flight=Flight(autopilot=kind, height=120.0, ready_s=2.0, **flight),
    )


def lossy(loss: float) -> ImpairmentSpec:
    """Loss in both directions of every link."""
    return ImpairmentSpec(loss=loss, delay_s=0.02, jitter_s=0.02)


def fenced() -> FenceSpec:
    """A fence that the evader's way leaves."""
    return FenceSpec(((-200.0, -200.0), (150.0, -200.0), (150.0, 200.0), (-200.0, 200.0)), 50.0, 200.0)


def game_of(scenario: Scenario, **kinds: Any) -> Rehearsal:
    """The rehearsal of a scenario on the running virtual loop."""
    return Rehearsal(scenario, virtual_clock(), **kinds)


async def under_way(game: Rehearsal, seconds: float = 5.0) -> None:
    """Until the game has run for some seconds."""
    assert await game.until(lambda: game.phase is Phase.RUNNING and game.now >= seconds, 60.0), game.told[-5:]


async def passes(game: Rehearsal, seconds: float) -> None:
    """Let time pass."""
    await game.until(lambda: False, seconds)


def autopilot(game: Rehearsal, id: int) -> Autopilot:
    """The simulated autopilot of a vehicle."""
    return game.bridge.world.vehicles[id].autopilot


def mode(game: Rehearsal, id: int) -> str:
    """Its mode, as it is in truth."""
    return autopilot(game, id).mode_name


def choose_mode(game: Rehearsal, id: int, name: str) -> None:
    """A pilot chooses a mode by his transmitter."""
    autopilot(game, id).pilot_mode(game.bridge.world.elapsed_ns, name)


def speed(game: Rehearsal, id: int) -> float:
    """Speed over ground, in truth [m/s]."""
    velocity: Vec = game.bridge.world.motions[id].velocity
    return norm(velocity)


def place(game: Rehearsal, id: int) -> Vec:
    """Position, in truth."""
    return game.bridge.world.motions[id].position


def flies(agent: Agent) -> bool:
    """Whether setpoints count and go out."""
    verdict = agent.core.flight.output
    decided = agent.core.flight.playing and verdict is not None and verdict.stream
    return agent.core.vehicle.stage is Stage.ACTIVE and decided


def command(kind: CommandKind, id: str = "c-1", sender: str = "tower") -> Command:
    """A command from the ground."""
    return Command(id, kind, sender, 0)


async def order(game: Rehearsal, vehicle: int, what: Command, timeout_s: float = 0.5) -> CommandReply:
    """Send a command once; the reply."""
    replies = await game.bus.request(key(game.game, COMMAND, vehicle), swarm.COMMAND.encode(what), timeout_s)
    reply = swarm.COMMAND_REPLY.decode(replies[0], Counter())
    assert reply is not None
    return reply
