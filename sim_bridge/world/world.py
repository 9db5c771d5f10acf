"""The world: simulated vehicles, each an autopilot, an airframe and its links, in one air.

`World.step` is plain: give it the time and it moves everything on by whole physics steps, on the
virtual loop and the real one alike; autopilots that have nothing to do in a step are left alone. What
arrives on a link is answered at once.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence

from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.game.scenario import Kind, Scenario, VehicleSpec
from onboard.runtime.protocols import Clock, Link
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.make import autopilot_for, options_of, parameter_names
from sim_bridge.vehicle.motion import CALM, Air, Airframe, Demand, Motion
from sim_bridge.world.staging import (
    Wind,
    airframe_of,
    calm,
    frame_of,
    generator,
    holding,
    kind_of,
    starts,
    wind_errors_of,
)

RATE_HZ = 100.0
STEP_S = round(NS_PER_S / RATE_HZ) / NS_PER_S
BEHIND_MAX = 50  # physics steps made up for in one call; beyond them time is lost, and counted


class SimVehicle:
    """One vehicle: what flies it, what moves it, and who hears it.

    Its autopilot is stepped where something is due for it or it was told something; in between the airframe
    flies on under what was demanded last, and the autopilot makes up for those steps before anything else.
    """

    def __init__(
        self, id: int, spec: VehicleSpec, autopilot: Autopilot, airframe: Airframe, links: Sequence[Link]
    ) -> None:
        self.id = id
        self.spec = spec
        self.airframe = airframe
        self.links = list(links)
        self.air = CALM
        self._autopilot = autopilot
        self._demand: Demand | None = None
        self._rests_ns = 0  # before which its autopilot is not stepped
        self._rested = 0  # steps that the autopilot rested through
        self._seen = airframe.motion  # at the beginning of the last of them
        self._at_ns = 0  # when that was
        self._shown = False

    @property
    def autopilot(self) -> Autopilot:
        """What flies it. Who has asked for it may look at any time: from then on it is stepped each time."""
        self._shown = True
        self._wake()
        return self._autopilot

    def move(self, now_ns: int, motion: Motion, air: Air) -> None:
        """One physics step of a vehicle that is in `motion`."""
        airframe, self.air = self.airframe, air
        if now_ns < self._rests_ns and self._demand is not None:
            self._rested += 1
            self._seen, self._at_ns = motion, now_ns
            airframe.step(self._demand, air, STEP_S)
            return
        if self._rested:
            self._wake()
        autopilot = self._autopilot
        self._demand = demand = autopilot.step(now_ns, motion, air)
        if not autopilot.landed:  # else it stands where it is
            airframe.step(demand, air, STEP_S)
        if not self._shown:
            self._rests_ns = autopilot.rests_until()
        if autopilot.speaks:
            self._flush()

    def hear(self, now_ns: int, data: bytes, peer: Hashable) -> None:
        """Take a datagram, and answer it at once."""
        self._wake()
        self._autopilot.receive(now_ns, data, peer)
        self._flush()

    def _wake(self) -> None:
        """Let the autopilot make up for what it rested through, and be stepped next time."""
        self._rests_ns = 0
        if self._rested:
            steps, self._rested = self._rested, 0
            self._autopilot.rested(steps, self._at_ns, self._seen, self.air)

    def _flush(self) -> None:
        frames = self._autopilot.outgoing()
        if frames:
            for link in self.links:
                for frame in frames:
                    link.send(frame)


class World:
    """All vehicles of a scenario. `links` are those on which each vehicle's autopilot speaks, by vehicle id.

    `wind` gives each vehicle its air; `battery_s` is a battery's time from full to empty in flight [s];
    `seed` draws the delays of answers (None: the scenario's). Raises ConfigError for an aircraft that its
    autopilot cannot fly, and for parameters that no autopilot of the scenario has.
    """

    def __init__(
        self,
        scenario: Scenario,
        clock: Clock,
        links: Mapping[int, Sequence[Link]],
        wind: Wind = calm,
        battery_s: float = 1200.0,
        seed: int | None = None,
    ) -> None:
        self.step_ns = round(NS_PER_S / RATE_HZ)
        self.lost_steps = 0
        self._clock = clock
        self._wind = wind
        self._start_ns = clock.monotonic_ns()
        self._epoch_ns = clock.wall_ns()
        self._done = 0  # physics steps
        self.vehicles: dict[int, SimVehicle] = {}
        frame, motions = frame_of(scenario), starts(scenario, wind)
        seed = scenario.seed if seed is None else seed
        asked = self._asked_parameters(scenario)
        for id, spec in zip(scenario.ids, scenario.vehicles, strict=True):
            start = motions[id]
            air = wind(id, start, 0.0)
            kind = kind_of(scenario, spec)
            options = options_of(scenario, generator(seed, f"answers-{id}"), asked[kind])._replace(
                epoch_ns=self._epoch_ns,
                battery_s=battery_s,
                wind_errors=wind_errors_of(scenario, seed, id),
            )
            airframe = airframe_of(scenario, spec, start, air)
            autopilot = autopilot_for(holding(spec, airframe), kind, id, frame, start, options)
            self.vehicles[id] = vehicle = SimVehicle(id, spec, autopilot, airframe, links.get(id, ()))
            vehicle.air = air
            for number, link in enumerate(vehicle.links):
                self._listen(vehicle, link, number)

    def _asked_parameters(self, scenario: Scenario) -> dict[Kind, dict[str, float]]:
        """The scenario's parameters, for each kind those that it has. Raises ConfigError for other names."""
        spec = scenario.flight.simulated
        kinds = {kind_of(scenario, vehicle) for vehicle in scenario.vehicles}
        names = {kind: parameter_names(kind, spec.firmware) for kind in kinds}
        for name, value in spec.parameters.items():
            if not any(name in known for known in names.values()):
                raise ConfigError(
                    f"{scenario.name}: flight.simulated.parameters.{name}: found {value:g}, expected a "
                    f"parameter of {', '.join(sorted(kind.value for kind in kinds))}"
                )
        return {
            kind: {name: value for name, value in spec.parameters.items() if name in known}
            for kind, known in names.items()
        }

    @property
    def motions(self) -> dict[int, Motion]:
        """The true motion of every vehicle."""
        return {id: vehicle.airframe.motion for id, vehicle in self.vehicles.items()}

    @property
    def elapsed_ns(self) -> int:
        """Time that has been simulated so far [ns]."""
        return self._done * self.step_ns

    @property
    def wall_ns(self) -> int:
        """The wall instant that the motions are of."""
        return self._epoch_ns + self.elapsed_ns

    def add_link(self, id: int, link: Link) -> None:
        """Let one more link hear and speak to a vehicle."""
        vehicle = self.vehicles[id]
        vehicle.links.append(link)
        self._listen(vehicle, link, len(vehicle.links) - 1)

    def step(self) -> None:
        """Move on to the clock's time, by whole physics steps."""
        due = (self._clock.monotonic_ns() - self._start_ns) // self.step_ns
        behind = due - self._done
        if behind > BEHIND_MAX:  # the process was stopped: do not spiral
            lost = behind - BEHIND_MAX
            self.lost_steps += lost
            self._start_ns += lost * self.step_ns
            self._epoch_ns += lost * self.step_ns
            behind = BEHIND_MAX
        for _ in range(behind):
            self._done += 1
            now_ns = self.elapsed_ns
            now_s = now_ns / NS_PER_S
            for vehicle in self.vehicles.values():
                motion = vehicle.airframe.motion
                vehicle.move(now_ns, motion, self._wind(vehicle.id, motion, now_s))

    def _listen(self, vehicle: SimVehicle, link: Link, number: int) -> None:
        def arrived(data: bytes, peer: Hashable) -> None:
            vehicle.hear(self.elapsed_ns, data, (number, peer))

        link.receive(arrived)
