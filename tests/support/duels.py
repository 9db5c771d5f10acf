"""Short games that come to a verdict within seconds: for stories of whole games."""

from __future__ import annotations

from typing import Any

from onboard.game.scenario import Flight, Kind, Parameters, Scenario, VehicleSpec
from onboard.pilot.predictor_choice import Predicting
from onboard.runtime.protocols import Sample
from onboard.wire.bus.messages import Phase
from onboard.wire.bus.topics import everything
from sim_bridge.rehearsal import Rehearsal

HOLD = {Kind.PX4: "HOLD", Kind.ARDUCOPTER: "LOITER", Kind.ARDUPLANE: "LOITER"}
GUIDED = {Kind.PX4: "OFFBOARD", Kind.ARDUCOPTER: "GUIDED", Kind.ARDUPLANE: "GUIDED"}
STORY = ["staging", "ready", "running", "ended", "recovery"]


def duel(
    kind: Kind = Kind.ARDUCOPTER, *, mates: int = 0, horizon: float = 40.0, gap: float = 45.0, **flight: Any
) -> Scenario:
    """A faster pursuer ahead of an evader that flies straight on: a capture within `gap` / 8 seconds or so.

    `mates` more pursuers come from behind, too far away to matter. Planes are ten times as fast, and loiter
    until it begins: they start farther apart, and are judged by 40 m."""
    scale, R = (10.0, 40.0) if kind is Kind.ARDUPLANE else (1.0, 2.0)
    gap = 3.0 * gap if kind is Kind.ARDUPLANE else gap
    behind = [(-80.0, 50.0), (-80.0, -50.0), (-120.0, 0.0), (-120.0, 80.0)]
    return Scenario(
        name="duel",
        evader=VehicleSpec(
            position=(0.0, 0.0), speed=4.0 * scale, target=(300.0 * scale, 0.0), strategy="straight"
        ),
        pursuers=tuple(
            VehicleSpec(position=(x * scale, y * scale), speed=5.0 * scale)
            for x, y in [(gap, 1.0), *behind[:mates]]
        ),
        parameters=Parameters(R=R, horizon=horizon),
        flight=Flight(
            autopilot=kind,
            height=150.0,
            ready_s=2.0,
            prediction=Predicting.CONSTANT_VELOCITY,
            **flight,
        ),
    )


class Heard:
    """Everything on the bus of a game, in order."""

    def __init__(self, game: Rehearsal) -> None:
        self.samples: list[Sample] = []
        game.bus.subscribe(everything(game.game), self.samples.append)

    def of(self, key: str) -> list[bytes]:
        """The payloads of one key."""
        return [sample.payload for sample in self.samples if sample.key == key]


def phases(game: Rehearsal, id: int) -> list[str]:
    """The phases that an agent took in, as it told them."""
    told = [event.text for event in game.events if event.id == id and event.kind == "phase"]
    return [text.split(":")[0] for text in told]


async def at_phase(game: Rehearsal, phase: Phase, within_s: float = 60.0) -> None:
    """Until the game is in a phase."""
    assert await game.until(lambda: game.phase is phase, within_s), (game.phase, game.told[-5:])
