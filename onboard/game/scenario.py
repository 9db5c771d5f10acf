"""Scenario files: who plays, from where, how fast, under which parameters.

TOML. `[evader]` is the first evader, `[[evaders]]` are further ones. Positions are `[north, east]` or
`[north, east, height]` in metres of the game frame (height above the origin); a game is plane where every
position has two numbers. `[[zones]]` are kept out of. `[flight]` holds what only `serve` and `fly` need.
"""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import Annotated, Any

import msgspec

from onboard.config import strict as config
from onboard.config.bounds import (
    ControlRate,
    Distance,
    Duration,
    NotNegative,
    PositiveDistance,
    PositiveDuration,
    Seed,
    TimeStep,
)
from onboard.config.derive import Key, core_from, struct_from
from onboard.config.names import Title
from onboard.config.strict import ConfigError, FieldError, StrictConfig, demand
from onboard.core.game.rules import Rules
from onboard.game.fence_file import GeoFence, read_fence
from onboard.game.fence_spec import FenceSpec, demand_start, fence_in
from onboard.game.flight_spec import Firmware as Firmware  # read with the scenario, named from here
from onboard.game.flight_spec import ImpairmentSpec as ImpairmentSpec
from onboard.game.flight_spec import OriginSpec as OriginSpec
from onboard.game.flight_spec import SensorSpec as SensorSpec
from onboard.game.flight_spec import SimulatedSpec as SimulatedSpec
from onboard.game.flight_spec import Transmitter as Transmitter
from onboard.game.flight_spec import WindSpec as WindSpec
from onboard.game.vehicle_spec import DEFAULT_ACCELERATION
from onboard.game.vehicle_spec import WINGED as WINGED
from onboard.game.vehicle_spec import AirframeKind as AirframeKind
from onboard.game.vehicle_spec import Kind as Kind
from onboard.game.vehicle_spec import VehicleSpec as VehicleSpec
from onboard.game.vehicle_spec import targets_of as targets_of
from onboard.game.vehicle_spec import vec as vec
from onboard.game.zone_spec import ZoneSpec as ZoneSpec
from onboard.game.zone_spec import core_zones, demand_zones, zones_in
from onboard.pilot.predictor_choice import Predicting
from onboard.wire.bus.messages import Role
from onboard.wire.geodesy import Frame

RULE_KEYS = {
    "R": Key(PositiveDistance, 2.0),
    "rho": Key(PositiveDistance, None),  # 2R where it is not given
    "lambda_": Key(NotNegative, name="lambda"),
    "beta": Key(NotNegative),
    "epsilon_min": Key(PositiveDistance),
    "dt": Key(TimeStep, 0.05),  # of the plane and compiled games
    "horizon": Key(PositiveDuration),
    "separation": Key(Distance),
}
"""How `[parameters]` writes the core's Rules; `planar` follows from the positions, `zones` stand beside."""


class Parameters(struct_from(Rules, StrictConfig, RULE_KEYS, ("planar", "zones"))):  # type: ignore[misc]
    """The game's rules in the paper's symbols, and the time step `dt` of the plane and compiled games [s]."""

    def __post_init__(self) -> None:
        demand(self.rho is None or self.rho >= self.R, "rho", self.rho, f"at least R = {self.R:g} m")


class Flight(StrictConfig, frozen=True):
    """What only `serve` and `fly` need."""

    autopilot: Kind = Kind.ARDUCOPTER  # of every vehicle that names none
    airframe: AirframeKind = AirframeKind.KINEMATIC  # how every vehicle moves that says nothing else
    origin: OriginSpec = OriginSpec()
    height: Distance = 50.0  # [m] at which a plane game is flown
    ground_start: bool = False  # whether vehicles start on the ground and take off
    ready_s: Duration = 5.0  # from ready to t₀
    timeout_s: Duration = 60.0  # to get everybody ready
    sensor: SensorSpec = SensorSpec()
    impairment: ImpairmentSpec = ImpairmentSpec()
    wind: WindSpec = WindSpec()
    fence: FenceSpec | None = None
    control_rate_hz: ControlRate = 20.0  # of the agents: control steps a second [Hz]
    prediction: Predicting = Predicting.NETWORK  # what carries tracks forward in the agents
    field_profile: bool = False  # altitude layers, capture judged horizontally
    simulated: SimulatedSpec = SimulatedSpec()


class Expect(StrictConfig, frozen=True):
    """The paper's verdicts for a row of Table 1."""

    escapes: bool  # with the strategy of this paper
    escapes_earlier: bool  # with the strategy of [37]
    reaches: bool | None = None  # None: no target


Evaders = Annotated[
    tuple[VehicleSpec, ...], msgspec.Meta(max_length=15, description="at most 15 further evaders")
]
Pursuers = Annotated[tuple[VehicleSpec, ...], msgspec.Meta(min_length=1, description="at least one pursuer")]


class Scenario(StrictConfig, frozen=True):
    """A whole scenario."""

    name: Title  # of the game, for people and for run folders
    evader: VehicleSpec  # the first
    pursuers: Pursuers
    evaders: Evaders = ()  # further ones
    zones: tuple[ZoneSpec, ...] = ()  # that everybody keeps out of
    description: str = ""  # for people
    seed: Seed = 0  # of noise, losses, gusts and training
    parameters: Parameters = Parameters()
    flight: Flight = Flight()
    expect: Expect | None = None

    def __post_init__(self) -> None:
        self._demand_players()
        self._demand_what_flies()
        if self.flight.fence is not None and self.flight.fence.polygon:
            for key, one in self._flown().items():
                up = one.position[2] if len(one.position) == 3 else self.flight.height
                demand_start(self.flight.fence, key, one.position, None if self.flight.ground_start else up)
        ids = self.ids
        key = "evaders.id" if self.evaders else "pursuers.id"
        demand(len(set(ids)) == len(ids), key, list(ids), "ids that differ")
        demand(max(ids) <= 250, "pursuers", f"{len(self.pursuers)} pursuers", "system ids up to 250")

    def _demand_players(self) -> None:
        """Demand that everybody's part in the game is one that it can have."""
        for key, one in self._evaders_keyed().items():
            demand(one.speed > 0, f"{key}.speed", one.speed, "a positive speed [m/s]")
        known = self.parameters.target_known
        demand(not known or any(map(targets_of, self.evading)), "parameters.target_known", "true",
               f"false: {'no' if self.evaders else 'this'} evader has {'a' if self.evaders else 'no'} target"
               " that the pursuers could know")  # fmt: skip
        demand(self.expect is None or not self.evaders, "expect", "given",
               "none: the paper's table knows games of one evader")  # fmt: skip
        for key, one in self._pursuers_keyed().items():
            demand(one.target is None, f"{key}.target", one.target, "no target: only the evader has one")
            demand(not one.targets, f"{key}.targets", one.targets, "no targets: only the evader has some")
            demand(not one.tracked, f"{key}.tracked", "true",
                   "false: only the evader may be known by tracks alone")  # fmt: skip
        axes = len(self.evader.position)
        places = {f"{key}.position": one.position for key, one in self.keyed().items()}
        for key, one in self._evaders_keyed().items():
            places |= {f"{key}.target": one.target} if one.target else {}
            places |= {f"{key}.targets[{k}]": place for k, place in enumerate(one.targets)}
        for key, place in places.items():
            demand(len(place) == axes, key, f"{len(place)} numbers",
                   f"{axes} as in evader.position: a game is plane or in space")  # fmt: skip
        demand_zones(self.zones, places, self.planar)

    def _demand_what_flies(self) -> None:
        """Demand that what `[flight]` and the vehicles say goes together and has an effect."""
        flight = self.flight
        demand(self.planar or flight.height == Flight().height, "flight.height", flight.height,
               "none: this game is in space, its positions have heights")  # fmt: skip
        kinds = [v.autopilot or flight.autopilot for v in self.vehicles]
        px4 = Kind.PX4 in kinds or Kind.PX4_PLANE in kinds
        demand(px4 or not flight.simulated.full_streams, "flight.simulated.full_streams", "true",
               "false: it is PX4 that streams so, and none is here")  # fmt: skip
        for (at, vehicle), kind in zip(self.keyed().items(), kinds, strict=True):
            frame = vehicle.airframe or flight.airframe
            if frame is AirframeKind.KINEMATIC:
                continue
            demand(kind is Kind.ARDUPLANE, f"{at if vehicle.airframe else 'flight'}.airframe",
                   f"{frame.value} under {kind.value}",
                   "kinematic: the transfer-function aircraft are arduplanes")  # fmt: skip
            demand(not flight.ground_start, "flight.ground_start", f"true with airframe {frame.value}",
                   "false: its transfer functions hold in flight alone")  # fmt: skip
            demand(vehicle.acceleration == DEFAULT_ACCELERATION, f"{at}.acceleration", vehicle.acceleration,
                   f"none with airframe {frame.value}: its file says how it flies")  # fmt: skip

    def _evaders_keyed(self) -> dict[str, VehicleSpec]:
        keys = ("evader", *(f"evaders[{k}]" for k in range(len(self.evaders))))
        return dict(zip(keys, self.evading, strict=True))

    def _pursuers_keyed(self) -> dict[str, VehicleSpec]:
        return {f"pursuers[{k}]": one for k, one in enumerate(self.pursuers)}

    def keyed(self) -> dict[str, VehicleSpec]:
        """`vehicles`, in their order, by the keys of their tables: `evader`, `pursuers[0]`, `evaders[0]`."""
        first, *others = self._evaders_keyed().items()
        return dict((first, *self._pursuers_keyed().items(), *others))

    def _flown(self) -> dict[str, VehicleSpec]:
        """Those whom an agent flies, by the keys of their positions."""
        return {f"{key}.position": one for key, one in self.keyed().items() if not one.tracked}

    @property
    def planar(self) -> bool:
        """Whether every position has two numbers."""
        return len(self.evader.position) == 2

    @property
    def vehicles(self) -> tuple[VehicleSpec, ...]:
        """The evader, the pursuers, then the further evaders."""
        return (self.evader, *self.pursuers, *self.evaders)

    @property
    def evading(self) -> tuple[VehicleSpec, ...]:
        """All evaders, `[evader]` first."""
        return (self.evader, *self.evaders)

    @property
    def ids(self) -> tuple[int, ...]:
        """Ids of `vehicles`: MAVLink system ids."""
        return tuple(index + 1 if v.id is None else v.id for index, v in enumerate(self.vehicles))

    @property
    def several(self) -> bool:
        """Whether there are several evaders, or targets of which any counts."""
        return bool(self.evaders or self.evader.targets)

    @property
    def evader_ids(self) -> tuple[int, ...]:
        """Ids of `evading`."""
        return (self.ids[0], *self.ids[1 + len(self.pursuers) :])

    @property
    def pursuer_ids(self) -> tuple[int, ...]:
        """Ids of `pursuers`."""
        return self.ids[1 : 1 + len(self.pursuers)]

    def role_of(self, id: int) -> Role:
        """On which side a vehicle plays. Raises KeyError for an id of nobody."""
        if id not in self.ids:
            raise KeyError(f"vehicle {id}: expected one of {list(self.ids)}")
        return Role.EVADER if id in self.evader_ids else Role.PURSUER

    @property
    def flown_ids(self) -> tuple[int, ...]:
        """Ids of those whom an agent flies: all but evaders that are known by tracks alone."""
        return tuple(id for id, v in zip(self.ids, self.vehicles, strict=True) if not v.tracked)

    @property
    def rules(self) -> Rules:
        """The rules for the core."""
        p = self.parameters
        rho = 2.0 * p.R if p.rho is None else p.rho
        return core_from(p, Rules, RULE_KEYS, rho=rho, planar=self.planar, zones=core_zones(self.zones))

    def contents(self) -> dict[str, Any]:
        """Everything as plain data, without the keys of `OMITTED` where they are empty.

        So a file that does not use them keeps its fingerprint, its run folder and its campaigns.
        """
        data = msgspec.json.decode(msgspec.json.encode(self, order="deterministic"))
        found: dict[str, Any] = _without_empty(data)
        return found

    def hash(self) -> str:
        """Short fingerprint of the contents (not of the file's layout)."""
        return sha256(msgspec.json.encode(self.contents())).hexdigest()[:16]


OMITTED = frozenset(("evaders", "targets", "zones"))
"""Keys of scenarios that came later: empty ones are left out of `contents`."""


def _without_empty(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: _without_empty(one) for key, one in data.items() if one or key not in OMITTED}
    return [_without_empty(one) for one in data] if isinstance(data, (list, tuple)) else data


def demand_one_evader(scenario: Scenario, name: str) -> None:
    """Raise ConfigError that begins with `name` for a scenario of several evaders or several targets.

    For what plays or tells of one evader with one target.
    """
    if scenario.evaders:
        raise ConfigError(f"{name}: evaders: found {len(scenario.evading)} evaders, expected one: {SEVERAL}")
    if scenario.evader.targets:
        found = len(scenario.evader.targets)
        raise ConfigError(f"{name}: evader.targets: found {found} targets, expected `target`, one: {SEVERAL}")


SEVERAL = "this command knows games of one evader with one target"


def load(path: Path, several: bool = False) -> Scenario:
    """Read a scenario file; `several`: whether the caller knows what to do with several evaders or targets.

    Raises ConfigError that names file, key, found and expected.
    """
    scenario = config.read(path, Scenario)
    if not several:
        demand_one_evader(scenario, str(path))
    fence = scenario.flight.fence
    if fence is None or not fence.file:
        return scenario
    return with_fence(scenario, read_fence(path.parent / fence.file), f"{path}: flight.fence.file")


def with_fence(scenario: Scenario, found: GeoFence, name: str) -> Scenario:
    """A scenario with another tool's fence, in the scenario's frame and height band.

    Raises ConfigError that begins with `name`.
    """
    flight = scenario.flight
    frame = Frame(flight.origin.latitude_deg, flight.origin.longitude_deg, flight.origin.altitude_m)
    fence = fence_in(frame, flight.fence, found, name)
    try:
        zones = (*scenario.zones, *zones_in(frame, found, name))
        flight = msgspec.structs.replace(flight, fence=fence)
        return msgspec.structs.replace(scenario, flight=flight, zones=zones)
    except FieldError as error:
        raise ConfigError(f"{name}: {error}") from None
