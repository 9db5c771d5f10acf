"""Scenario files: who plays, from where, how fast, under which parameters.

TOML. Positions are `[north, east]` or `[north, east, height]` in metres of the game frame
(height above the origin); a game is plane where every position has two numbers. `[flight]`
holds what only `serve` and `fly` need.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from hashlib import sha256
from pathlib import Path
from typing import Annotated

import msgspec

from onboard.config import strict as config
from onboard.config.bounds import (
    Altitude,
    ControlRate,
    Coordinate,
    Distance,
    Duration,
    Latitude,
    Longitude,
    NotNegative,
    PartialShare,
    PitchDeg,
    PositiveAcceleration,
    PositiveDistance,
    PositiveDuration,
    Rate,
    Seed,
    Share,
    Speed,
    SystemId,
    TimeStep,
    TurnRateDeg,
    YawDeg,
)
from onboard.config.derive import Key, core_from, struct_from
from onboard.config.names import Title
from onboard.config.strict import ConfigError, FieldError, StrictConfig, demand
from onboard.core.game.rules import Rules
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import Vec
from onboard.game.fence_file import GeoFence, read_fence
from onboard.game.fence_spec import FenceSpec, demand_start, fence_in
from onboard.pilot.predictor_choice import Predicting
from onboard.wire.geodesy import Frame

Point = Annotated[tuple[Coordinate, ...], msgspec.Meta(min_length=2, max_length=3)]


class Kind(Enum):
    """Which autopilot flies a vehicle."""

    PX4 = "px4"
    PX4_PLANE = "px4-plane"
    ARDUCOPTER = "arducopter"
    ARDUPLANE = "arduplane"


WINGED = frozenset((Kind.ARDUPLANE, Kind.PX4_PLANE))
"""The kinds that fly planes."""


class AirframeKind(Enum):
    """How a simulated vehicle moves."""

    KINEMATIC = "kinematic"  # (7)–(8) with limited turn rate, climb angle and acceleration
    NOSE = "nose"
    SLIP = "slip"
    COORDINATED = "coordinated"


class Transmitter(Enum):
    """The pilot's transmitter of simulated vehicles, and where its throttle stick stands."""

    CENTRED = "centred"
    LOW = "low"  # as software in the loop without one: channels are healthy, throttle at 1000
    NONE = "none"  # no channel was ever heard


class Firmware(Enum):
    """Which generation of parameter names and commands a simulated autopilot has."""

    OLDER = "older"  # ArduPilot 4.4
    RECORDED = "recorded"  # ArduPilot 4.5.6, PX4 1.16
    NEWER = "newer"  # ArduPilot 4.7, PX4 1.18


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
"""How `[parameters]` writes the core's Rules; `planar` follows from the positions."""

LIMIT_KEYS = {
    "speed_min": Key(Speed),
    "speed_max": Key(Speed, None),  # `speed` where it is not given
    "pitch_min": Key(PitchDeg, degrees=True),
    "pitch_max": Key(PitchDeg, degrees=True),
    "yaw_min": Key(YawDeg, degrees=True),
    "yaw_max": Key(YawDeg, degrees=True),
    "turn_rate": Key(TurnRateDeg, 60.0, degrees=True),
}
"""How a vehicle's table writes the core's VehicleLimits."""


class Parameters(struct_from(Rules, StrictConfig, RULE_KEYS, ("planar",))):  # type: ignore[misc]
    """The game's rules in the paper's symbols, and the time step `dt` of the plane and compiled games [s]."""

    def __post_init__(self) -> None:
        demand(self.rho is None or self.rho >= self.R, "rho", self.rho, f"at least R = {self.R:g} m")


DEFAULT_ACCELERATION = 4.0  # [m/s²]


class Player(StrictConfig, frozen=True):
    """Who plays and from where."""

    position: Point  # [m] where it starts
    speed: Speed  # [m/s; air] what the game reckons with
    id: SystemId | None = None  # evader 1, pursuers from 2 where not given
    strategy: str = ""  # "" = the default: paper for evaders, parallel-pursuit for pursuers
    target: Point | None = None  # the evader's alone
    heading_deg: YawDeg | None = None  # at the start; None = towards the target or the evader


class VehicleSpec(struct_from(VehicleLimits, Player, LIMIT_KEYS)):  # type: ignore[misc]
    """One vehicle: who plays, its limits, and how it is simulated. Angles in degrees."""

    acceleration: PositiveAcceleration = DEFAULT_ACCELERATION  # [m/s²] of the kinematic airframe
    autopilot: Kind | None = None  # None = the scenario's
    airframe: AirframeKind | None = None  # None = the scenario's
    tracked: bool = False  # the evader's alone: known by tracks, flown by no agent

    def __post_init__(self) -> None:
        speed, fastest = self.speed, self.speed_max
        demand(self.speed_min <= speed, "speed_min", self.speed_min, f"0 to speed = {speed:g} m/s")
        demand(fastest is None or fastest >= speed, "speed_max", fastest, f"at least speed = {speed:g} m/s")
        for angle in ("pitch", "yaw"):
            low, high = getattr(self, f"{angle}_min_deg"), getattr(self, f"{angle}_max_deg")
            demand(low <= high, f"{angle}_min_deg", f"{low:g} with {angle}_max_deg {high:g}", "min ≤ max")

    def start(self) -> Vec:
        """Start in the game frame."""
        return vec(self.position)

    def limits(self) -> VehicleLimits:
        """(2)–(3) for the core [rad]."""
        fastest = self.speed if self.speed_max is None else self.speed_max
        return core_from(self, VehicleLimits, LIMIT_KEYS, speed_max=fastest)


class OriginSpec(StrictConfig, frozen=True):
    """Origin of the game frame (WGS-84; altitude above mean sea level)."""

    latitude_deg: Latitude = 47.397742  # of the origin [deg]
    longitude_deg: Longitude = 8.545594  # of the origin [deg]
    altitude_m: Altitude = 488.0  # of the origin, above mean sea level [m]


class SensorSpec(StrictConfig, frozen=True):
    """The simulated sensor that publishes tracks."""

    rate_hz: Rate = 10.0  # measurements a second of each vehicle [Hz]
    sigma: Distance = 0.0  # position noise, one sigma an axis [m]
    sigma_velocity: Speed = 0.0  # velocity noise [m/s]
    delay_s: Duration = 0.0  # from a measurement to its track on the bus [s]
    dropout: PartialShare = 0.0  # share of lost measurements


class ImpairmentSpec(StrictConfig, frozen=True):
    """What happens to datagrams (and, where `bus` says so, to the memory bus)."""

    loss: Share = 0.0  # share
    delay_s: Duration = 0.0  # of every datagram [s]
    jitter_s: Duration = 0.0  # at most so much more, drawn for each [s]
    duplication: Share = 0.0  # share
    reordering: Share = 0.0  # share
    burst_rate: NotNegative = 0.0  # bursts per second
    burst_s: Duration = 0.0  # mean length of a burst in which all is lost
    bit_error: Share = 0.0  # share of datagrams with a flipped bit
    bus: bool = False  # whether the memory bus suffers too

    def __post_init__(self) -> None:
        demand((self.burst_rate > 0) == (self.burst_s > 0), "burst_rate", f"{self.burst_rate:g} with burst_s"
               f" {self.burst_s:g}", "both or neither")  # fmt: skip


class WindSpec(StrictConfig, frozen=True):
    """Wind. `from_deg` is the direction it comes from, as pilots say it."""

    speed: Speed = 0.0  # mean, at 6 m (20 ft) above ground [m/s]
    from_deg: YawDeg = 0.0  # where it comes from, clockwise from north [deg]
    shear: bool = False  # MIL-F-8785C profile
    gust_sigma: Speed = 0.0  # σ of the Dryden gusts [m/s]
    correlation_m: Distance = 0.0  # 0 = each vehicle its own gusts
    recorded: str = ""  # CSV file in place of the model

    def __post_init__(self) -> None:
        modelled = self.speed or self.gust_sigma or self.correlation_m or self.shear
        demand(not (self.recorded and modelled), "recorded", f"{self.recorded!r} beside a modelled wind",
               "either of them")  # fmt: skip
        demand(self.gust_sigma > 0 or self.correlation_m == 0, "correlation_m", self.correlation_m,
               "0: there are no gusts (gust_sigma = 0)")  # fmt: skip
        demand(self.speed > 0 or not self.shear, "shear", "true", "false: there is no mean wind (speed = 0)")


class SimulatedSpec(StrictConfig, frozen=True):
    """What stands around every simulated autopilot, and how it is set up."""

    transmitter: Transmitter = Transmitter.CENTRED  # where every throttle stick stands
    answer_delay_s: Duration = 0.0  # least time from a command to its execution and answer
    answer_delay_max_s: Duration = 0.0  # most; each command draws its own, so that answers may cross
    batteries: Annotated[int, msgspec.Meta(ge=1, le=2, description="1 or 2 batteries")] = 1  # of each vehicle
    firmware: Firmware = Firmware.RECORDED  # generation of parameter names and commands
    gimbal: bool = False  # whether component 154 sends heartbeats with the vehicle's own system id
    other_station_hz: NotNegative = 0.0  # a second ground station asks for all streams at this rate; 0: none
    full_streams: bool = False  # whether PX4 streams by default what a real one does: 22 kB/s
    parameters: Mapping[str, float] = msgspec.field(default_factory=dict)  # of the autopilots that have them

    def __post_init__(self) -> None:
        most = self.answer_delay_max_s
        demand(most == 0.0 or most >= self.answer_delay_s, "answer_delay_max_s", most,
               f"0 or at least answer_delay_s = {self.answer_delay_s:g} s")  # fmt: skip


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


Pursuers = Annotated[tuple[VehicleSpec, ...], msgspec.Meta(min_length=1, description="at least one pursuer")]


class Scenario(StrictConfig, frozen=True):
    """A whole scenario."""

    name: Title  # of the game, for people and for run folders
    evader: VehicleSpec
    pursuers: Pursuers
    description: str = ""  # for people
    seed: Seed = 0  # of noise, losses, gusts and training
    parameters: Parameters = Parameters()
    flight: Flight = Flight()
    expect: Expect | None = None

    def __post_init__(self) -> None:
        demand(self.evader.speed > 0, "evader.speed", self.evader.speed, "a positive speed [m/s]")
        known = self.parameters.target_known
        demand(self.evader.target is not None or not known, "parameters.target_known", "true",
               "false: this evader has no target that the pursuers could know")  # fmt: skip
        for index, v in enumerate(self.pursuers):
            demand(v.target is None, f"pursuers[{index}].target", v.target,
                   "no target: only the evader has one")  # fmt: skip
            demand(not v.tracked, f"pursuers[{index}].tracked", "true",
                   "false: only the evader may be known by tracks alone")  # fmt: skip
        axes = len(self.evader.position)
        places = {f"pursuers[{i}].position": one.position for i, one in enumerate(self.pursuers)}
        places |= {"evader.target": self.evader.target} if self.evader.target else {}
        for key, place in places.items():
            demand(len(place) == axes, key, f"{len(place)} numbers",
                   f"{axes} as in evader.position: a game is plane or in space")  # fmt: skip
        self._demand_what_flies()
        if self.flight.fence is not None and self.flight.fence.polygon:
            for key, one in self._flown().items():
                up = one.position[2] if len(one.position) == 3 else self.flight.height
                demand_start(self.flight.fence, key, one.position, None if self.flight.ground_start else up)
        ids = self.ids
        demand(len(set(ids)) == len(ids), "pursuers.id", list(ids), "ids that differ")
        demand(max(ids) <= 250, "pursuers", f"{len(self.pursuers)} pursuers", "system ids up to 250")

    def _demand_what_flies(self) -> None:
        """Demand that what `[flight]` and the vehicles say goes together and has an effect."""
        flight = self.flight
        demand(self.planar or flight.height == Flight().height, "flight.height", flight.height,
               "none: this game is in space, its positions have heights")  # fmt: skip
        kinds = [v.autopilot or flight.autopilot for v in self.vehicles]
        px4 = Kind.PX4 in kinds or Kind.PX4_PLANE in kinds
        demand(px4 or not flight.simulated.full_streams, "flight.simulated.full_streams", "true",
               "false: it is PX4 that streams so, and none is here")  # fmt: skip
        for index, (vehicle, kind) in enumerate(zip(self.vehicles, kinds, strict=True)):
            at = f"pursuers[{index - 1}]." if index else "evader."
            frame = vehicle.airframe or flight.airframe
            if frame is AirframeKind.KINEMATIC:
                continue
            demand(kind is Kind.ARDUPLANE, f"{at if vehicle.airframe else 'flight.'}airframe",
                   f"{frame.value} under {kind.value}",
                   "kinematic: the transfer-function aircraft are arduplanes")  # fmt: skip
            demand(not flight.ground_start, "flight.ground_start", f"true with airframe {frame.value}",
                   "false: its transfer functions hold in flight alone")  # fmt: skip
            demand(vehicle.acceleration == DEFAULT_ACCELERATION, f"{at}acceleration", vehicle.acceleration,
                   f"none with airframe {frame.value}: its file says how it flies")  # fmt: skip

    def _flown(self) -> dict[str, VehicleSpec]:
        """Those whom an agent flies, by the keys of their positions."""
        found = {"evader.position": self.evader}
        found |= {f"pursuers[{i}].position": one for i, one in enumerate(self.pursuers)}
        return {key: one for key, one in found.items() if not one.tracked}

    @property
    def planar(self) -> bool:
        """Whether every position has two numbers."""
        return len(self.evader.position) == 2

    @property
    def vehicles(self) -> tuple[VehicleSpec, ...]:
        """The evader, then the pursuers."""
        return (self.evader, *self.pursuers)

    @property
    def ids(self) -> tuple[int, ...]:
        """Ids of `vehicles`: MAVLink system ids."""
        return tuple(index + 1 if v.id is None else v.id for index, v in enumerate(self.vehicles))

    @property
    def flown_ids(self) -> tuple[int, ...]:
        """Ids of those whom an agent flies: all but an evader that is known by tracks alone."""
        return tuple(id for id, v in zip(self.ids, self.vehicles, strict=True) if not v.tracked)

    @property
    def rules(self) -> Rules:
        """The rules for the core."""
        p = self.parameters
        rho = 2.0 * p.R if p.rho is None else p.rho
        return core_from(p, Rules, RULE_KEYS, rho=rho, planar=self.planar)

    def hash(self) -> str:
        """Short fingerprint of the contents (not of the file's layout)."""
        return sha256(msgspec.json.encode(self, order="deterministic")).hexdigest()[:16]


def vec(point: Point) -> Vec:
    """A scenario's point in the game frame: height becomes down."""
    return Vec(point[0], point[1], -point[2] if len(point) == 3 else 0.0)


def load(path: Path) -> Scenario:
    """Read a scenario file. Raises ConfigError that names file, key, found and expected."""
    scenario = config.read(path, Scenario)
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
        return msgspec.structs.replace(scenario, flight=msgspec.structs.replace(flight, fence=fence))
    except FieldError as error:
        raise ConfigError(f"{name}: {error}") from None
