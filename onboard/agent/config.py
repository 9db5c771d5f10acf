"""The agent's configuration: strict TOML, every key with a default that works beside `sim-bridge serve`."""

from __future__ import annotations

from enum import Enum
from math import isfinite
from pathlib import Path
from typing import Any

import msgspec

from onboard.config import strict as config
from onboard.config.strict import ConfigError
from onboard.core.safety.policy import Action, Policy
from onboard.pilot.predictor_choice import Predicting
from onboard.wire.bus.messages import Role
from onboard.wire.bus.topics import DEFAULT_GAME

BASE_PORT = 14539  # the autopilot of vehicle n sends to this port + n


class Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Base of all parts: frozen and strict."""


class AdapterChoice(Enum):
    """Which adapter flies; `auto` is the one that fits the autopilot's heartbeat."""

    AUTO = "auto"
    VELOCITY = "velocity"
    ARDUPLANE = "arduplane"
    ARDUPLANE_PLAIN = "arduplane-plain"
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


class EnvelopeConfig(Part, frozen=True):
    """What this aircraft can do. Where a key is missing, the game's setup says it. Airspeeds for planes."""

    speed_min: float | None = None  # [m/s]
    speed_max: float | None = None  # [m/s]
    climb_max: float | None = None  # [m/s]
    sink_max: float | None = None  # [m/s]
    turn_rate_deg: float | None = None  # [deg/s]
    acceleration: float = 6.0  # [m/s²]; 0 = no limit
    deceleration: float = 2.0  # [m/s²] that braking may count on
    turn_radius: float | None = None  # [m], planes
    bank_max_deg: float = 45.0  # [deg], planes


class FenceConfig(Part, frozen=True):
    """A geofence of one's own, beside the setup's: polygon of [north, east] and a height band [m]."""

    polygon: tuple[tuple[float, float], ...]
    height_min: float
    height_max: float


_DEFAULT = Policy()


class SafetyConfig(Part, frozen=True):
    """Thresholds of the supervisor (docs/safety.md)."""

    fence: FenceConfig | None = None
    fence_margin: float = _DEFAULT.fence_margin  # [m]
    height_margin: float = _DEFAULT.height_margin  # [m]
    fence_far: float = _DEFAULT.fence_far  # [m]
    reaction_s: float = _DEFAULT.reaction
    separation: float | None = None  # [m]; missing = the setup's
    mate_age_s: float = _DEFAULT.mate_age
    telemetry_age_s: float = _DEFAULT.telemetry_age
    heartbeat_age_s: float = _DEFAULT.heartbeat_age
    heartbeat_alone_s: float = _DEFAULT.heartbeat_alone  # while other telemetry comes
    strategy_age_s: float = _DEFAULT.strategy_age
    track_sigma: float = _DEFAULT.track_sigma  # [m]
    track_action: Reaction = Reaction.HOLD
    ground_age_s: float = _DEFAULT.ground_age
    ground_action: Reaction = Reaction.NOTHING
    clock_jump_s: float = _DEFAULT.clock_jump
    clock_hold_s: float = _DEFAULT.clock_hold
    battery: float = _DEFAULT.battery  # share left; 0 = off
    gps_fix: int = _DEFAULT.gps_fix  # 0 = off
    settle_s: float = _DEFAULT.settle
    abort: KnockOff = KnockOff.HOLD


class SigningConfig(Part, frozen=True):
    """MAVLink 2 signing: a key file of mode 0600, and where stamps are kept."""

    key: str
    stamps: str = ""  # missing = beside the key, with `.stamps`
    link_id: int = 0


class AgentConfig(Part, frozen=True):
    """Everything an agent can be told."""

    id: int = 2  # MAVLink system id, and its name on the bus
    role: Role = Role.PURSUER
    game: str = DEFAULT_GAME
    link: tuple[str, ...] = ()  # missing = udpin://127.0.0.1:14539+id; two: the second stands by
    autopilot: AdapterChoice = AdapterChoice.AUTO
    bus: str = ""  # Zenoh endpoint; missing = tcp/127.0.0.1:7447
    zenoh: str = ""  # Zenoh configuration file (JSON5) for TLS, access control, routers
    strategy: str = ""  # missing = the setup's, or the role's default
    route: str = ""  # route file of a tracker
    take_control: bool = False  # enter GUIDED / OFFBOARD by itself at the start
    may_arm: bool = False  # arm and take off for a ground start
    take_off_height: float = 30.0  # [m] above home, after a ground start
    hold_mode: str = ""  # a multicopter's mode to hold in; missing = the adapter's (LOITER, HOLD)
    mavsdk: str = ""  # the connection that MAVSDK opens for itself, for the adapter `mavsdk`
    dry_run: bool = False  # decide and publish, send no setpoint and no command
    control_rate_hz: float = 20.0
    lookahead_s: float = 1.0  # of rule 6's alternative
    track_ahead_s: float = 6.0  # how far a tracker's pursuit of its pseudo-target looks ahead
    prediction: Predicting = Predicting.NETWORK  # what carries tracks forward
    field: bool = False  # refuse what only a simulation may do (docs/safety.md)
    log: str = ""  # .tlog of the own link; missing = none
    events: str = ""  # file of everything that happens, for `gcs replay --decide`; missing = none
    events_max_mb: float = 256.0  # its largest size [MB]: some two hours of a game of six
    envelope: EnvelopeConfig = EnvelopeConfig()
    safety: SafetyConfig = SafetyConfig()
    signing: SigningConfig | None = None

    @property
    def links(self) -> tuple[str, ...]:
        """The links' URLs, with the default filled in."""
        return self.link or (f"udpin://127.0.0.1:{BASE_PORT + self.id}",)


def load(path: Path | None, options: dict[str, Any]) -> AgentConfig:
    """The configuration of a file (or the defaults) with the command line's options over it.

    Raises ConfigError, one line.
    """
    found = AgentConfig() if path is None else config.read(path, AgentConfig)
    name = "options" if path is None else str(path)
    given = {key: value for key, value in options.items() if value is not None}
    if given:
        plain: dict[str, Any] = {
            key: value for key, value in msgspec.to_builtins(found).items() if value is not None
        }
        plain |= given
        found = config.convert(_dropped_none(plain), AgentConfig, name)
    return check(found, name)


def check(found: AgentConfig, name: str) -> AgentConfig:
    """Demand what types cannot say. Raises ConfigError with file, key, found and expected."""

    def demand(ok: bool, key: str, value: object, expected: str) -> None:
        if not ok:
            raise ConfigError(f"{name}: {key}: found {value}, expected {expected}")

    demand(1 <= found.id <= 250, "id", found.id, "a MAVLink system id from 1 to 250")
    demand(len(found.link) <= 2, "link", f"{len(found.link)} links", "at most two")
    demand(len(set(found.link)) == len(found.link), "link", "the same link twice", "two that differ")
    demand(
        bool(found.game) and not set(found.game) & set("/*$#? "), "game", f"'{found.game}'",
        "a name without / * $ # ? or blanks",
    )
    demand(
        0.0 < found.control_rate_hz <= 50.0, "control_rate_hz", found.control_rate_hz, "a rate in (0, 50] Hz"
    )
    demand(0.0 < found.track_ahead_s <= 60.0, "track_ahead_s", found.track_ahead_s, "a time in (0, 60] s")
    route = found.role is not Role.TRACKER or bool(found.route)
    demand(route, "route", "none", "a tracker's route file")
    size = found.events_max_mb
    demand(1.0 <= size <= 1e5, "events_max_mb", size, "1 to 100000 MB")
    height = found.take_off_height
    demand(2.0 <= height <= 500.0, "take_off_height", height, "2 to 500 m above home")
    demand(0.0 < found.lookahead_s <= 60.0, "lookahead_s", found.lookahead_s, "a time in (0, 60] s")
    for part, keys in (
        ("envelope", ("speed_min", "speed_max", "climb_max", "sink_max", "turn_rate_deg", "turn_radius",
                      "acceleration", "deceleration")),
        ("safety", ("fence_margin", "height_margin", "fence_far", "reaction_s", "separation", "mate_age_s",
                    "telemetry_age_s", "heartbeat_age_s", "heartbeat_alone_s", "strategy_age_s",
                    "track_sigma", "ground_age_s", "clock_jump_s", "clock_hold_s", "battery", "settle_s")),
    ):  # fmt: skip
        for key in keys:
            value = getattr(getattr(found, part), key)
            demand(value is None or (isfinite(value) and value >= 0), f"{part}.{key}", value, "zero or more")
    e, s = found.envelope, found.safety
    if e.speed_min is not None and e.speed_max is not None:
        demand(e.speed_min <= e.speed_max, "envelope.speed_min", e.speed_min, f"at most {e.speed_max:g} m/s")
    demand(e.deceleration > 0.0, "envelope.deceleration", e.deceleration, "a positive deceleration [m/s²]")
    demand(0.0 < e.bank_max_deg < 80.0, "envelope.bank_max_deg", e.bank_max_deg, "an angle in (0, 80) deg")
    demand(s.battery < 1.0, "safety.battery", s.battery, "a share below 1")
    demand(0.0 < s.strategy_age_s <= 0.2, "safety.strategy_age_s", s.strategy_age_s, "a time in (0, 0.2] s")
    if s.fence is not None:
        corners = len(s.fence.polygon)
        demand(corners >= 3, "safety.fence.polygon", corners, "three corners or more")
        demand(s.fence.height_min < s.fence.height_max, "safety.fence.height_min", s.fence.height_min,
               f"less than height_max = {s.fence.height_max:g} m")
    return found


def _dropped_none(data: Any) -> Any:
    """TOML knows no null: keys that are not given are left out."""
    if isinstance(data, dict):
        return {key: _dropped_none(value) for key, value in data.items() if value is not None}
    return data
