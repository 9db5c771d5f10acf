"""Whole games for flight stories: let time pass with `forward`, and look at what is to be seen.

A wait ends at once when the game fails: a task of it crashed, a vehicle told an error that the story does not
expect (the end of a stream by the supervisor among them), or the game was aborted against expectation. What
fails, the story's own assertions included, is told with the last events of each vehicle.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable
from typing import Any

from msgspec.structs import replace

from onboard.agent.shell import Agent
from onboard.autopilot.base import Stage
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec, distance, norm
from onboard.game.scenario import Scenario
from onboard.runtime.loop import virtual_clock
from onboard.runtime.protocols import Clock, Sample
from onboard.wire.bus import topics
from onboard.wire.bus.messages import (
    Command,
    CommandKind,
    CommandReply,
    Event,
    OutcomeResult,
    Phase,
    Quote,
    Severity,
)
from onboard.wire.bus.topics import COMMAND, everything
from sim_bridge.rehearsal import Options, Rehearsal
from sim_bridge.vehicle.autopilot.autopilot import Autopilot

STORY = ["staging", "ready", "running", "ended", "recovery"]
TO_START_S = 300.0  # of game time; planes fly to their places first
LAST_EVENTS = 20  # of each vehicle, in the text of a failure
SETPOINT = 84  # SET_POSITION_TARGET_LOCAL_NED, as the eighth byte of a frame tells


class GameError(AssertionError):
    """The game failed, or what a story waited for did not happen in time."""


class WholeGame(Rehearsal):
    """A rehearsal that fails as soon as something happens which the story does not expect.

    `any_error` expects every kind of error of every vehicle, for games that are full of faults.
    """

    def __init__(self, scenario: Scenario, clock: Clock, *, any_error: bool = False, **options: Any) -> None:
        super().__init__(scenario, clock, Options(**options))
        self._any_error = any_error
        self._begun_ns = self.clock.wall_ns()
        self._expected: set[tuple[int, str]] = set()
        self._aborts = False
        self._looked_at = 0  # events that were found to be expected

    def expects(self, vehicle: int, *kinds: str) -> None:
        """From now on these kinds of error events of a vehicle are a part of the story."""
        self._expected |= {(vehicle, kind) for kind in kinds}

    def expects_abort(self) -> None:
        """From now on the game may be given up."""
        self._aborts = True

    async def forward(self, seconds: float = 60.0, *, until: Callable[[], object] | None = None) -> None:
        """Let `seconds` of the game's time pass, or time until a condition holds, for `seconds` at most.

        Raises GameError as soon as the game fails, and where the condition does not come to hold; what
        ended a task of the game is raised as it is.
        """
        if not await self.until(until or (lambda: False), seconds) and until is not None:
            raise GameError(f"what was waited for did not happen within {seconds:g} s")

    async def until(self, holds: Callable[[], object], within_s: float) -> bool:
        """Let time pass until a condition holds; False where it did not within `within_s` [s]."""

        def looked() -> bool:
            self._look_at_events()
            return bool(holds())

        return await super().until(looked, within_s)

    async def __aenter__(self) -> WholeGame:
        await super().__aenter__()
        return self

    async def __aexit__(self, *what: object) -> None:
        await super().__aexit__(*what)
        error = what[1]
        if isinstance(error, Exception):
            error.add_note(self.story())

    def assert_near(self, vehicle: int, there: Vec, within: float) -> None:
        """The vehicle is, in truth, at most `within` [m] from a place [m; NED]."""
        here = place(self, vehicle)
        gap = distance(here, there)
        assert gap <= within, f"vehicle {vehicle} is at {here}, {gap:.2f} m from {there}, expected {within:g}"

    def story(self, last: int = LAST_EVENTS) -> str:
        """The state of the game and the last events of each vehicle, by seconds since it was staged."""
        lines = [f"game at {self.now:.2f} s, phase {self.phase.value}, {self.outcome or 'no outcome'}"]
        for id in self.scenario.ids:
            health = self.health.get(id)
            seen = f"stage {health.stage}, lacks {health.lacks}" if health else "never heard"
            lines.append(f"vehicle {id} in {mode(self, id)} at {place(self, id)}, agent: {seen}")
            own = [event for event in self.events if event.id == id]
            lines += [f"  {self._told(event)}" for event in own[-last:]] or ["  no event"]
        return "\n".join(lines)

    def _look_at_events(self) -> None:
        for event in self.events[self._looked_at :]:
            self._looked_at += 1
            expected = self._any_error or (event.id, event.kind) in self._expected
            if event.severity is Severity.ERROR and not expected:
                raise GameError(f"vehicle {event.id} told an error that nobody expects: {self._told(event)}")
        given_up = self.outcome is not None and self.outcome.verdict is OutcomeResult.ABORTED
        if given_up and not self._aborts:
            raise GameError(f"the game was given up: {self.outcome and self.outcome.reason}")

    def _told(self, event: Event) -> str:
        t = (event.stamp_ns - self._begun_ns) / NS_PER_S
        return f"{t:8.2f} s  {event.severity.value:7} {event.kind}: {event.text}"


class HeardOfGame:
    """Everything on the bus of a game, in order."""

    def __init__(self, game: Rehearsal) -> None:
        self.samples: list[Sample] = []
        game.bus.subscribe(everything(game.game), self.samples.append)


def game_of(scenario: Scenario, **options: Any) -> WholeGame:
    """The game of a scenario on the running virtual loop; options as Rehearsal's."""
    return WholeGame(scenario, virtual_clock(), **options)


async def under_way(game: WholeGame, seconds: float = 5.0) -> None:
    """Forward until the game has run for some seconds."""
    await game.forward(TO_START_S, until=lambda: game.phase is Phase.RUNNING and game.now >= seconds)


async def at_phase(game: WholeGame, phase: Phase, within_s: float = TO_START_S) -> None:
    """Forward until the game is in a phase."""
    await game.forward(within_s, until=lambda: game.phase is phase)


def autopilot(game: Rehearsal, id: int) -> Autopilot:
    """The simulated autopilot of a vehicle."""
    return game.bridge.world.vehicles[id].autopilot


def mode(game: Rehearsal, id: int) -> str:
    """The mode of a vehicle's autopilot, in truth."""
    return autopilot(game, id).mode_name


def choose_mode(game: Rehearsal, id: int, name: str) -> None:
    """A pilot chooses a mode by his transmitter."""
    autopilot(game, id).pilot_mode(game.bridge.world.elapsed_ns, name)


def speed(game: Rehearsal, id: int) -> float:
    """Speed of a vehicle over ground, in truth [m/s]."""
    velocity: Vec = game.bridge.world.motions[id].velocity
    return norm(velocity)


def place(game: Rehearsal, id: int) -> Vec:
    """Position of a vehicle, in truth [m; NED]."""
    return game.bridge.world.motions[id].position


def flies(agent: Agent) -> bool:
    """Whether the agent's setpoints count and go out."""
    verdict = agent.core.flight.output
    decided = agent.core.flight.playing and verdict is not None and verdict.stream
    return agent.core.vehicle.stage is Stage.ACTIVE and decided


def setpoints_heard(game: Rehearsal, vehicle: int) -> list[int]:
    """A list that from now on receives the instant of each velocity setpoint [ns since the world began].

    What counts is the arrival at the vehicle's autopilot.
    """
    heard: list[int] = []
    receive = autopilot(game, vehicle).receive

    def listening(now_ns: int, data: bytes, peer: Hashable) -> None:
        if data[7] == SETPOINT:
            heard.append(now_ns)
        receive(now_ns, data, peer)

    autopilot(game, vehicle).receive = listening  # type: ignore[method-assign]
    return heard


def phases(game: Rehearsal, id: int) -> list[str]:
    """The phases that an agent took in, as it told them."""
    told = [event.text for event in game.events if event.id == id and event.kind == "phase"]
    return [text.split(":")[0] for text in told]


def command(kind: CommandKind, id: str = "c-1", sender: str = "tower") -> Command:
    """A command from the ground."""
    return Command(id, kind, sender, 0)


def quoting(game: Rehearsal, vehicle: int, what: Command) -> Command:
    """The command with what a station quotes that has heard everything up to now."""
    core = game.agents[vehicle].core
    nonce, number = core.bus.masters.last or (core.facts.nonce, core.desk.number)
    return replace(what, quote=Quote(nonce, number, core.facts.nonce, core.orders.stopped_by))


async def order(game: Rehearsal, vehicle: int, what: Command, timeout_s: float = 0.5) -> CommandReply:
    """Send a command once, by somebody who has heard all there is to hear; the reply."""
    what = quoting(game, vehicle, what)
    replies = await game.bus.request(COMMAND.key(game.game, vehicle), topics.COMMAND.encode(what), timeout_s)
    reply = topics.COMMAND.decode_reply(replies[0], Counter())
    assert reply is not None
    return reply
