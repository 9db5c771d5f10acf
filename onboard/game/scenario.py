"""Scenario files: who plays, from where, how fast, under which parameters.

TOML. Positions are `[north, east]` or `[north, east, height]` in metres of the game frame
(height above the origin); a game is plane where every position has two numbers. `[flight]`
holds what only `serve` and `fly` need.
"""

from __future__ import annotations

from enum import Enum
from hashlib import sha256
from math import inf, radians
from pathlib import Path
from typing import Annotated

import msgspec

from onboard.config import strict as config
from onboard.config.strict import ConfigError
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import Vec
from onboard.pilot.predictor_choice import Predicting

Point = Annotated[tuple[float, ...], msgspec.Meta(min_length=2, max_length=3)]


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Base of all parts of a scenario: frozen and strict."""


class Kind(Enum):
    """Which autopilot flies a vehicle."""

    PX4 = "px4"
    ARDUCOPTER = "arducopter"
    ARDUPLANE = "arduplane"


class AirframeKind(Enum):
    """How a simulated vehicle moves."""

    KINEMATIC = "kinematic"  # (7)–(8) with limited turn rate, climb angle and acceleration
    NOSE = "nose"
    SLIP = "slip"
    COORDINATED = "coordinated"


class Parameters(Part, frozen=True, rename={"lambda_": "lambda"}):
    """The game's parameters, in the paper's symbols."""

    R: float = 2.0  # capture radius of (6) [m]
    rho: float | None = None  # safety distance ρ of (4) [m]; 2R where it is not given
    lambda_: float = 100.0  # λ of (21)–(22)
    beta: float = 1.0  # β of (22)
    epsilon_min: float = 1.0  # ε_min of (5) [m]
    dt: float = 0.05  # time step of the plane and compiled games [s]
    horizon: float = 100.0  # not captured until then = escaped [s]
    separation: float = 0.0  # between pursuers [m]; 0 = off (Figure 8b)


class VehicleSpec(Part, frozen=True):
    """One vehicle. Angles in degrees."""

    position: Point
    speed: float  # [m/s; air] what the game reckons with
    id: int | None = None  # evader 1, pursuers from 2 where not given
    strategy: str = ""  # "" = the default of the role
    target: Point | None = None  # the evader's alone
    heading_deg: float | None = None  # at the start; None = towards the target or the evader
    speed_min: float = 0.0
    speed_max: float | None = None  # None = speed
    pitch_min_deg: float = -90.0
    pitch_max_deg: float = 90.0
    yaw_min_deg: float = -180.0
    yaw_max_deg: float = 180.0
    turn_rate_deg: float = 60.0  # [deg/s] of the kinematic airframe
    acceleration: float = 4.0  # [m/s²] of the kinematic airframe
    autopilot: Kind | None = None  # None = the scenario's
    airframe: AirframeKind | None = None

    def start(self) -> Vec:
        """Start in the game frame."""
        return vec(self.position)

    def limits(self) -> VehicleLimits:
        """(2)–(3) for the core [rad]."""
        return VehicleLimits(
            self.speed_min,
            self.speed if self.speed_max is None else self.speed_max,
            radians(self.pitch_min_deg),
            radians(self.pitch_max_deg),
            radians(self.yaw_min_deg),
            radians(self.yaw_max_deg),
        )


class OriginSpec(Part, frozen=True):
    """Origin of the game frame (WGS-84; altitude above mean sea level)."""

    latitude_deg: float = 47.397742
    longitude_deg: float = 8.545594
    altitude_m: float = 488.0


class SensorSpec(Part, frozen=True):
    """The simulated sensor that publishes tracks."""

    rate_hz: float = 10.0
    sigma: float = 0.0  # position noise, one sigma an axis [m]
    sigma_velocity: float = 0.0  # velocity noise [m/s]
    delay_s: float = 0.0
    dropout: float = 0.0  # share of lost measurements


class ImpairmentSpec(Part, frozen=True):
    """What happens to datagrams (and, where `bus` says so, to the memory bus)."""

    loss: float = 0.0  # share
    delay_s: float = 0.0
    jitter_s: float = 0.0
    duplication: float = 0.0  # share
    reordering: float = 0.0  # share
    burst_rate: float = 0.0  # bursts per second
    burst_s: float = 0.0  # mean length of a burst in which all is lost
    bit_error: float = 0.0  # share of datagrams with a flipped bit
    bus: bool = False


class WindSpec(Part, frozen=True):
    """Wind. `from_deg` is the direction it comes from, as pilots say it."""

    speed: float = 0.0  # mean, at 6 m (20 ft) above ground [m/s]
    from_deg: float = 0.0
    shear: bool = False  # MIL-F-8785C profile
    gust_sigma: float = 0.0  # σ of the Dryden gusts [m/s]
    correlation_m: float = 0.0  # 0 = each vehicle its own gusts
    recorded: str = ""  # CSV file in place of the model


class FenceSpec(Part, frozen=True):
    """Geofence: polygon of [north, east] and a height band [m]."""

    polygon: tuple[tuple[float, float], ...]
    height_min: float
    height_max: float


class Flight(Part, frozen=True):
    """What only `serve` and `fly` need."""

    autopilot: Kind = Kind.ARDUCOPTER
    airframe: AirframeKind = AirframeKind.KINEMATIC
    origin: OriginSpec = OriginSpec()
    height: float = 50.0  # [m] at which a plane game is flown
    ground_start: bool = False
    ready_s: float = 5.0  # from ready to t₀
    timeout_s: float = 60.0  # to get everybody ready
    sensor: SensorSpec = SensorSpec()
    impairment: ImpairmentSpec = ImpairmentSpec()
    wind: WindSpec = WindSpec()
    fence: FenceSpec | None = None
    control_rate_hz: float = 20.0
    prediction: Predicting = Predicting.NETWORK  # what carries tracks forward in the agents
    field_profile: bool = False


class Expect(Part, frozen=True):
    """The paper's verdicts for a row of Table 1."""

    escapes: bool  # with the strategy of this paper
    escapes_earlier: bool  # with the strategy of [37]
    reaches: bool | None = None  # None: no target


class Scenario(Part, frozen=True):
    """A whole scenario."""

    name: str
    evader: VehicleSpec
    pursuers: tuple[VehicleSpec, ...]
    description: str = ""
    seed: int = 0
    parameters: Parameters = Parameters()
    flight: Flight = Flight()
    expect: Expect | None = None

    @property
    def planar(self) -> bool:
        """Whether every position has two numbers."""
        points = [v.position for v in self.vehicles] + [self.evader.target or (0.0, 0.0)]
        return all(len(point) == 2 for point in points)

    @property
    def vehicles(self) -> tuple[VehicleSpec, ...]:
        """The evader, then the pursuers."""
        return (self.evader, *self.pursuers)

    @property
    def ids(self) -> tuple[int, ...]:
        """Ids of `vehicles`: MAVLink system ids."""
        return tuple(index + 1 if v.id is None else v.id for index, v in enumerate(self.vehicles))

    @property
    def rho(self) -> float:
        """Safety distance ρ of (4) [m]."""
        return 2.0 * self.parameters.R if self.parameters.rho is None else self.parameters.rho

    def hash(self) -> str:
        """Short fingerprint of the contents (not of the file's layout)."""
        return sha256(msgspec.json.encode(self, order="deterministic")).hexdigest()[:16]


def vec(point: Point) -> Vec:
    """A scenario's point in the game frame: height becomes down."""
    return Vec(point[0], point[1], -point[2] if len(point) == 3 else 0.0)


def load(path: Path) -> Scenario:
    """Read and check a scenario file. Raises ConfigError."""
    return check(config.read(path, Scenario), str(path))


def check(scenario: Scenario, name: str) -> Scenario:
    """Demand what types cannot say. Raises ConfigError with file, key, found and expected."""

    def demand(ok: bool, key: str, found: object, expected: str) -> None:
        if not ok:
            raise ConfigError(f"{name}: {key}: found {found}, expected {expected}")

    demand(scenario.seed >= 0, "seed", scenario.seed, "zero or more")
    demand(len(scenario.pursuers) > 0, "pursuers", "none", "at least one pursuer")
    p = scenario.parameters
    demand(p.R > 0, "parameters.R", p.R, "a positive distance [m]")
    demand(p.rho is None or p.rho >= p.R, "parameters.rho", p.rho, f"at least R = {p.R:g} m")
    demand(p.lambda_ >= 0, "parameters.lambda", p.lambda_, "zero or more")
    demand(p.beta >= 0, "parameters.beta", p.beta, "zero or more")
    demand(p.epsilon_min > 0, "parameters.epsilon_min", p.epsilon_min, "a positive distance [m]")
    demand(p.separation >= 0, "parameters.separation", p.separation, "zero or more [m]")
    demand(0 < p.dt <= 1, "parameters.dt", p.dt, "a time step in (0, 1] s")
    demand(0 < p.horizon <= 86400, "parameters.horizon", p.horizon, "a duration in (0, 86400] s")
    for index, v in enumerate(scenario.vehicles):
        at = "evader" if index == 0 else f"pursuers[{index - 1}]"
        demand(v.speed >= 0, f"{at}.speed", v.speed, "zero or more [m/s]")
        demand(index > 0 or v.speed > 0, f"{at}.speed", v.speed, "a positive speed [m/s]")
        high = inf if v.speed_max is None else v.speed_max
        demand(0 <= v.speed_min <= v.speed, f"{at}.speed_min", v.speed_min, f"0 to speed = {v.speed:g} m/s")
        demand(high >= v.speed, f"{at}.speed_max", v.speed_max, f"at least speed = {v.speed:g} m/s")
        demand(-90 <= v.pitch_min_deg <= v.pitch_max_deg <= 90, f"{at}.pitch_min_deg",
               f"{v.pitch_min_deg:g} with pitch_max_deg {v.pitch_max_deg:g}", "−90 ≤ min ≤ max ≤ 90")
        demand(-360 <= v.yaw_min_deg <= v.yaw_max_deg <= 360, f"{at}.yaw_min_deg",
               f"{v.yaw_min_deg:g} with yaw_max_deg {v.yaw_max_deg:g}", "−360 ≤ min ≤ max ≤ 360")
        demand(v.turn_rate_deg > 0, f"{at}.turn_rate_deg", v.turn_rate_deg, "a positive rate [deg/s]")
        demand(v.acceleration > 0, f"{at}.acceleration", v.acceleration, "a positive acceleration [m/s²]")
        demand(v.target is None or index == 0, f"{at}.target", v.target, "no target: only the evader has one")
        demand(v.id is None or 1 <= v.id <= 250, f"{at}.id", v.id, "a MAVLink system id from 1 to 250")
    ids = scenario.ids
    demand(len(set(ids)) == len(ids), "pursuers.id", list(ids), "ids that differ")
    demand(max(ids) <= 250, "pursuers", f"{len(scenario.pursuers)} pursuers", "system ids up to 250")
    f = scenario.flight
    demand(-90 < f.origin.latitude_deg < 90, "flight.origin.latitude_deg", f.origin.latitude_deg, "−90 to 90")
    demand(-180 <= f.origin.longitude_deg <= 180, "flight.origin.longitude_deg", f.origin.longitude_deg,
           "−180 to 180")
    demand(f.sensor.rate_hz > 0, "flight.sensor.rate_hz", f.sensor.rate_hz, "a positive rate [Hz]")
    demand(0 < f.control_rate_hz <= 50, "flight.control_rate_hz", f.control_rate_hz, "a rate in (0, 50] Hz")
    for key in ("ready_s", "timeout_s"):
        demand(getattr(f, key) >= 0, f"flight.{key}", getattr(f, key), "zero or more [s]")
    for key in ("sigma", "sigma_velocity", "delay_s"):
        demand(getattr(f.sensor, key) >= 0, f"flight.sensor.{key}", getattr(f.sensor, key), "zero or more")
    demand(0 <= f.sensor.dropout < 1, "flight.sensor.dropout", f.sensor.dropout, "a share in [0, 1)")
    for key in ("loss", "duplication", "reordering", "bit_error"):
        share = getattr(f.impairment, key)
        demand(0 <= share <= 1, f"flight.impairment.{key}", share, "a share in [0, 1]")
    for key in ("delay_s", "jitter_s", "burst_rate", "burst_s"):
        value = getattr(f.impairment, key)
        demand(value >= 0, f"flight.impairment.{key}", value, "zero or more")
    demand(f.wind.speed >= 0, "flight.wind.speed", f.wind.speed, "zero or more [m/s]")
    demand(f.wind.gust_sigma >= 0, "flight.wind.gust_sigma", f.wind.gust_sigma, "zero or more [m/s]")
    if f.fence is not None:
        demand(len(f.fence.polygon) >= 3, "flight.fence.polygon", len(f.fence.polygon), "three or more")
        demand(f.fence.height_min < f.fence.height_max, "flight.fence.height_min", f.fence.height_min,
               f"less than height_max = {f.fence.height_max:g} m")
    return scenario
