"""The agent's configuration: strict TOML, every key with a default that works beside `sim-bridge serve`."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated, Any

from msgspec import Meta

from onboard.config import strict as config
from onboard.config.bounds import (
    Acceleration,
    ControlRate,
    Coordinate,
    Distance,
    Duration,
    GpsFix,
    PartialShare,
    PositiveAcceleration,
    Speed,
    SystemId,
)
from onboard.config.derive import Key, struct_from
from onboard.config.fence_check import demand_fence
from onboard.config.names import GameName
from onboard.config.strict import StrictConfig, demand
from onboard.core.safety.policy import Action, Policy
from onboard.game.plugins import demand_name
from onboard.pilot.predictor_choice import Predicting
from onboard.wire.bus.messages import Role
from onboard.wire.bus.topics import DEFAULT_GAME

BASE_PORT = 14539  # the autopilot of vehicle n sends to this port + n


# Ranges that only an agent has.
AgentTurnRate = Annotated[float, Meta(ge=0, le=3600, description="zero or more [deg/s], at most 3600")]
BankDeg = Annotated[float, Meta(gt=0, lt=80, description="an angle in (0, 80) deg")]
Corners = Annotated[
    tuple[tuple[Coordinate, Coordinate], ...], Meta(min_length=3, description="three corners or more")
]
StrategyAge = Annotated[float, Meta(gt=0, le=0.2, description="a time in (0, 0.2] s")]
Horizon = Annotated[float, Meta(gt=0, le=60, description="a time in (0, 60] s")]
TakeOffHeight = Annotated[float, Meta(ge=2, le=500, description="2 to 500 m above home")]
LinkId = Annotated[int, Meta(ge=0, le=255, description="a link id from 0 to 255")]
FileSize = Annotated[float, Meta(ge=1, le=1e5, description="1 to 100000 MB")]
CheckTime = Annotated[float, Meta(ge=0.5, le=600, description="0.5 to 600 s")]
Links = Annotated[tuple[str, ...], Meta(max_length=2, description="at most two links")]


class AdapterChoice(Enum):
    """Which adapter flies; `auto` is the one that fits the autopilot's heartbeat."""

    AUTO = "auto"
    VELOCITY = "velocity"
    ARDUPLANE = "arduplane"
    ARDUPLANE_PLAIN = "arduplane-plain"
    PX4_PLANE = "px4-plane"
    PX4_PLANE_COURSE = "px4-plane-course"
    MAVSDK = "mavsdk"


class Reaction(Enum):
    """What a fault may be answered with."""

    NOTHING = "nothing"
    HOLD = "hold"
    RETURN = "return"
    END = "end"

    def action(self) -> Action:
        """As the supervisor knows it."""
        return {"nothing": Action.PASS, "hold": Action.HOLD, "return": Action.RETURN, "end": Action.END}[
            self.value
        ]


class KnockOff(Enum):
    """What abort means: never disarming."""

    HOLD = "hold"
    RETURN = "return"


class EnvelopeConfig(StrictConfig, frozen=True):
    """What this aircraft can do. Where a key is missing, the game's setup says it. Airspeeds for planes."""

    speed_min: Speed | None = None  # [m/s]
    speed_max: Speed | None = None  # [m/s]
    climb_max: Speed | None = None  # [m/s]
    sink_max: Speed | None = None  # [m/s]
    turn_rate_deg: AgentTurnRate | None = None  # [deg/s]
    acceleration: Acceleration = 6.0  # [m/s²]; 0 = no limit
    deceleration: PositiveAcceleration = 2.0  # [m/s²] that braking may count on
    turn_radius: Distance | None = None  # [m], planes
    bank_max_deg: BankDeg = 45.0  # [deg], planes

    def __post_init__(self) -> None:
        if self.speed_min is not None and self.speed_max is not None:
            demand(self.speed_min <= self.speed_max, "speed_min", self.speed_min,
                   f"at most speed_max = {self.speed_max:g} m/s")  # fmt: skip


class FenceConfig(StrictConfig, frozen=True):
    """A geofence of one's own, beside the setup's: polygon of [north, east] and a height band [m]."""

    polygon: Corners
    height_min: Coordinate
    height_max: Coordinate

    def __post_init__(self) -> None:
        demand_fence(self.polygon, self.height_min, self.height_max)


POLICY_KEYS = {
    "fence": Key(FenceConfig, None),
    "fence_margin": Key(Distance),
    "height_margin": Key(Distance),
    "fence_far": Key(Distance),
    "reaction": Key(Duration, seconds=True),
    "separation": Key(Distance, None),  # the setup's where it is not given
    "mate_age": Key(Duration, seconds=True),
    "telemetry_age": Key(Duration, seconds=True),
    "heartbeat_age": Key(Duration, seconds=True),
    "heartbeat_alone": Key(Duration, seconds=True),
    "strategy_age": Key(StrategyAge, seconds=True),
    "track_sigma": Key(Distance),
    "track_action": Key(Reaction, Reaction.HOLD),
    "ground_age": Key(Duration, seconds=True),
    "ground_action": Key(Reaction, Reaction.NOTHING),
    "clock_jump": Key(Duration, seconds=True),
    "clock_hold": Key(Duration, seconds=True),
    "battery": Key(PartialShare),
    "gps_fix": Key(GpsFix),
    "settle": Key(Duration, seconds=True),
    "abort": Key(KnockOff, KnockOff.HOLD),
}
"""How `[safety]` writes the supervisor's Policy, with the fence and the meaning of an abort beside it."""

POLICY_ALONE = (
    "envelope",
    "fences",
    "zones",
    "coast",
    "mate_forget",
    "layered",
    "layer",
    "layer_band",
    "track_latched",
)
"""Fields of the Policy that `[safety]` does not hold."""


class SafetyConfig(struct_from(Policy, StrictConfig, POLICY_KEYS, POLICY_ALONE)):  # type: ignore[misc]
    """Thresholds of the supervisor (docs/safety.md)."""


class SigningConfig(StrictConfig, frozen=True):
    """MAVLink 2 signing: a key file of mode 0600, and where stamps are kept."""

    key: str
    stamps: str = ""  # missing = beside the key, with `.stamps`
    link_id: LinkId = 0


class AgentConfig(StrictConfig, frozen=True):
    """Everything an agent can be told."""

    id: SystemId = 2  # MAVLink system id, and its name on the bus
    role: Role = Role.PURSUER
    game: GameName = DEFAULT_GAME
    link: Links = ()  # missing = udpin://127.0.0.1:14539+id; two: the second stands by
    autopilot: AdapterChoice = AdapterChoice.AUTO
    bus: str = ""  # Zenoh endpoint; missing = tcp/127.0.0.1:7447
    zenoh: str = ""  # Zenoh configuration file (JSON5): of `gcs keys init`, or one for TLS, routers
    open_bus: bool = False  # with field = true: fly on a bus without keys all the same
    strategy: str = ""  # missing = the setup's, or the role's default
    route: str = ""  # route file of a tracker
    take_control: bool = False  # enter GUIDED / OFFBOARD by itself at the start
    may_arm: bool = False  # arm and take off for a ground start
    take_off_height: TakeOffHeight = 30.0  # [m] above home, after a ground start
    hold_mode: str = ""  # a multicopter's mode to hold in; missing = by its throttle stick
    mavsdk: str = ""  # the connection that MAVSDK opens for itself, for the adapter `mavsdk`
    dry_run: bool = False  # decide and publish, send no setpoint and no command
    control_rate_hz: ControlRate = 20.0
    decide_ahead: bool = False  # think before the next position has come
    lookahead_s: Horizon = 1.0  # of rule 6's alternative
    track_ahead_s: Horizon = 6.0  # how far a tracker's pursuit of its pseudo-target looks ahead
    prediction: Predicting = Predicting.NETWORK  # what carries tracks forward
    field: bool = False  # refuse what only a simulation may do (docs/safety.md)
    log: str = ""  # .tlog of the own link; missing = none
    events: str = ""  # file of everything that happens, for `gcs replay --decide`; missing = none
    events_max_mb: FileSize = 256.0  # its largest size [MB]: some two hours of a game of six
    envelope: EnvelopeConfig = EnvelopeConfig()
    safety: SafetyConfig = SafetyConfig()
    signing: SigningConfig | None = None

    def __post_init__(self) -> None:
        demand(len(set(self.link)) == len(self.link), "link", "the same link twice", "two that differ")
        demand(self.role is not Role.TRACKER or bool(self.route), "route", "none", "a tracker's route file")
        demand(self.role is Role.TRACKER or not self.route, "route", repr(self.route),
               f"none: a {self.role.value} follows no route")  # fmt: skip
        demand(self.autopilot is AdapterChoice.MAVSDK or not self.mavsdk, "mavsdk", repr(self.mavsdk),
               'none, or autopilot = "mavsdk"')  # fmt: skip
        plane = self.autopilot in (AdapterChoice.ARDUPLANE, AdapterChoice.ARDUPLANE_PLAIN)
        demand(not (plane and self.hold_mode), "hold_mode", repr(self.hold_mode),
               f'none with autopilot = "{self.autopilot.value}": a plane circles')  # fmt: skip

    @property
    def links(self) -> tuple[str, ...]:
        """The links' URLs, with the default filled in."""
        return self.link or (f"udpin://127.0.0.1:{BASE_PORT + self.id}",)


def load(path: Path | None, options: dict[str, Any]) -> AgentConfig:
    """The configuration of a file (or the defaults) with the command line's options over it.

    A strategy of a name that nobody has is refused here, not when the game is staged. Raises ConfigError, one
    line.
    """
    found = config.load(path, AgentConfig, options)
    if found.strategy and found.role is not Role.TRACKER:  # a tracker's is looked up where its route is
        demand_name(found.strategy, found.role.value, "options" if "strategy" in options else str(path))
    return found
