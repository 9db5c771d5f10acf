"""What is kept of a running game for its summary: health, events, the master's figures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping

from onboard.game.master import GameMaster
from onboard.game.scenario import Scenario
from onboard.runtime.protocols import Bus, Link
from onboard.wire.bus.messages import AgentStage, EvaderOutcome, Event, Health, Outcome
from onboard.wire.bus.topics import EVENTS, HEALTH, Dispatcher
from sim_bridge.world.sensor import Sensor
from sim_bridge.world.summary import EvaderSummary, Summary, VehicleSummary, kept, reached

EVENTS_MAX = 100_000
MEASURED = ("overrun", "skipped", "worst")  # counters with a part of the wall clock in them: timing.json's


class Observer:
    """Listens to a game on the bus; `summary` puts it into figures. `heard` is told each event."""

    def __init__(
        self,
        scenario: Scenario,
        seed: int,
        mode: str,
        game: str,
        bus: Bus,
        heard: Callable[[Event], None] | None = None,
    ) -> None:
        self.scenario = scenario
        self.seed = seed
        self.mode = mode
        self.events: list[Event] = []
        self.health: dict[int, Health] = {}
        self.drops: Counter[str] = Counter()
        self._flying: dict[int, Health] = {}  # the last health while setpoints flew the vehicle
        self._heard = heard
        hear = Dispatcher(self.drops).on(EVENTS, self._on_event).on(HEALTH, self._on_health)
        for topic in hear.topics:
            bus.subscribe(topic.key(game), hear)

    def kinds(self, id: int) -> list[str]:
        """Kinds of a vehicle's events so far, in order."""
        return [event.kind for event in self.events if event.id == id]

    def summary(
        self, master: GameMaster, outcome: Outcome | None, sensor: Sensor, links: Mapping[int, Link]
    ) -> Summary:
        """Everything that the game's summary tells; `links` give their counters, by vehicle id."""
        vehicles = []
        for id in self.scenario.ids:
            health = self.health.get(id)
            flying = self._flying.get(id, health)
            counters = links[id].counters() if id in links else {}
            vehicles.append(
                VehicleSummary(
                    id=id,
                    role=self.scenario.role_of(id).value,
                    autopilot=health.autopilot.value if health and health.autopilot else "",
                    stage=health.stage.value if health else "never heard",
                    mode=health.mode if health else "",
                    smallest_distance=kept(master.nearest.get(id)),
                    telemetry_rate_hz=round(flying.telemetry_rate_hz, 3) if flying else 0.0,
                    setpoint_rate_hz=round(flying.setpoint_rate_hz, 3) if flying else 0.0,
                    counters=_counted(health) if health else {},
                    link={cause: n for cause, n in sorted(counters.items()) if n},
                    events=sum(event.id == id for event in self.events),
                )
            )
        return Summary(
            scenario=self.scenario.name,
            scenario_hash=self.scenario.hash(),
            seed=self.seed,
            mode=self.mode,
            verdict=outcome.verdict.value if outcome else "none",
            reason=outcome.reason if outcome else "",
            time=round(outcome.time, 6) if outcome else 0.0,
            captor=outcome.captor if outcome else 0,
            smallest_distance=kept(outcome.smallest_distance if outcome else None),
            expected=reached(self.scenario),
            tracks_measured=sensor.measured,
            tracks_dropped=sensor.dropped,
            vehicles=tuple(vehicles),
            evaders=tuple(_ended(one) for one in outcome.evaders) if outcome else (),
        )

    def _on_event(self, event: Event) -> None:
        if len(self.events) < EVENTS_MAX:
            self.events.append(event)
            if self._heard is not None:
                self._heard(event)

    def _on_health(self, health: Health) -> None:
        self.health[health.id] = health
        if health.stage is AgentStage.ACTING:
            self._flying[health.id] = health


def _ended(end: EvaderOutcome) -> EvaderSummary:
    return EvaderSummary(
        id=end.id,
        verdict=end.verdict.value,
        time=round(end.time, 6),
        captor=end.captor,
        smallest_distance=kept(end.smallest_distance),
    )


def _counted(health: Health) -> dict[str, int]:
    counters = sorted(health.counters.items())
    return {cause: number for cause, number in counters if not any(word in cause for word in MEASURED)}
