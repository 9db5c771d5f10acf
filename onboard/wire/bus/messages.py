"""The swarm's messages: frozen msgspec structs in MessagePack with a schema version.

Every payload is the pair [SCHEMA, message]. Additive changes (a new field with a default at
the end) keep SCHEMA; any other change raises it. Units: SI and radians, game frame (north,
east, down); wall instants are integer nanoseconds since the epoch. Vectors travel as
3-tuples (n, e, d).
"""

from __future__ import annotations

from collections import Counter
from enum import Enum
from typing import Generic, TypeVar

import msgspec

from onboard.config.derive import core_from, struct_from
from onboard.core.game.rules import Rules
from onboard.core.math.states import VehicleLimits
from onboard.wire.finite import all_finite

SCHEMA = 2

Triple = tuple[float, float, float]


class Message(msgspec.Struct, frozen=True, array_like=True):
    """Base of all swarm messages."""


class Role(Enum):
    EVADER = "evader"
    PURSUER = "pursuer"
    TRACKER = "tracker"


class Phase(Enum):
    STAGING = "staging"
    READY = "ready"
    RUNNING = "running"
    ENDED = "ended"
    RECOVERY = "recovery"


class Origin(Message, frozen=True):
    """Origin of the game frame: WGS-84 latitude and longitude, altitude above mean sea level."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float


class RulesMessage(struct_from(Rules, Message)):  # type: ignore[misc]
    """The core's Rules on the bus, field by field as the core has them."""

    def core(self) -> Rules:
        """The core's value."""
        return core_from(self, Rules)


class LimitsMessage(struct_from(VehicleLimits, Message)):  # type: ignore[misc]
    """The core's VehicleLimits on the bus, field by field as the core has them."""

    def core(self) -> VehicleLimits:
        """The core's value."""
        return core_from(self, VehicleLimits)


class Member(Message, frozen=True):
    """One vehicle of the roster with what it declares."""

    id: int  # its MAVLink system id
    role: Role
    speed: float  # maximum airspeed that the game reckons with [m/s]; 0 = not declared
    start: Triple  # [m; NED] staging place
    limits: LimitsMessage = LimitsMessage()
    strategy: str = ""  # name, "" = the default of the role


class Fence(Message, frozen=True):
    """Geofence: a polygon of (north, east) [m] and an altitude band above the origin [m]."""

    polygon: tuple[tuple[float, float], ...]
    altitude_min: float
    altitude_max: float


class Setup(Message, frozen=True):
    """`game/setup`: everything but the evader's target."""

    game: str  # name of the game, as in the topics
    scenario: str  # name
    scenario_hash: str  # fingerprint of its contents
    master: str  # who published it
    origin: Origin
    roster: tuple[Member, ...]
    rules: RulesMessage
    fence: Fence | None = None
    track_sigma: float = 0.0  # stated position error of the tracks, one sigma an axis [m]
    seed: int = 0
    field_profile: bool = False  # altitude layers, capture judged horizontally

    @property
    def flat(self) -> bool:
        """Whether heights do not count: a plane game, or the field profile."""
        return bool(self.rules.planar or self.field_profile)


class PhaseChange(Message, frozen=True):
    """`game/phase`. `t0_ns` is the wall instant of the game's start (0 before it is fixed)."""

    phase: Phase
    t0_ns: int
    stamp_ns: int
    resume: tuple[int, ...] = ()  # ids of restarted agents that may act again
    reason: str = ""


class Outcome(Message, frozen=True):
    """`game/outcome`."""

    verdict: str  # captured | arrived | escaped | aborted
    time: float  # [s] since t0
    captor: int  # id, 0 = nobody
    smallest_distance: float  # [m] over all pursuers
    stamp_ns: int
    reason: str = ""


class Master(Message, frozen=True):
    """`game/master`: the master's lease, and the clock the agents compare theirs with."""

    name: str
    stamp_ns: int
    lease_s: float = 2.0
    nonce: int = 0  # tells two masters of one name apart


class EvaderBrief(Message, frozen=True):
    """`roles/evader/brief`: for the evader alone."""

    target: Triple | None  # [m; NED]
    stamp_ns: int


class State(Message, frozen=True):
    """`vehicles/<id>/state`: own state in the game frame."""

    id: int
    role: Role
    stamp_ns: int
    position: Triple  # [m; NED]
    velocity: Triple  # [m/s; ground, NED]
    airspeed: float  # [m/s]
    wind: Triple  # [m/s; NED, where the air moves to]
    roll: float  # [rad]
    pitch: float  # [rad]
    yaw: float  # [rad]
    mode: str  # the autopilot's, in its own words
    armed: bool
    nonce: int = 0  # random per process: two agents with one id are told apart


class DecisionReport(Message, frozen=True):
    """`vehicles/<id>/decision`: what was decided and why."""

    id: int
    stamp_ns: int
    t: float  # [s] since t0
    level: str  # strategic | tactical | executive
    module: str  # intelligent | geometric
    strategy: str
    rule: str
    velocity: Triple  # [m/s; relative to the air, NED]
    aim: Triple  # [m; NED]
    time_to_aim: float  # [s]
    miss: float  # [m] predicted closest approach
    cones: tuple[tuple[float, float, float, float], ...] = ()  # axis (n, e, d), half-angle [rad]
    circles: tuple[tuple[float, float, float, float], ...] = ()  # centre (n, e, d), radius [m]
    supervisor: str = "ok"  # ok | the action in force
    reason: str = ""
    predictor: str = ""  # which predictor spoke
    predictor_sigma: float = 0.0  # [m] its stated error now
    setpoint: Triple = (0.0, 0.0, 0.0)  # [m/s; ground, NED] what was sent


class Health(Message, frozen=True):
    """`vehicles/<id>/health`: heartbeat of the agent."""

    id: int
    role: Role
    stamp_ns: int
    stage: str  # waiting | ready | acting | held | handed_over | ended …
    lacks: tuple[str, ...]  # what an agent with no game waits for
    autopilot: str  # kind, "" = none found
    mode: str
    armed: bool
    battery: float  # fraction 0…1, −1 = unknown
    link_quality: float  # fraction of expected telemetry received, 0…1
    telemetry_rate_hz: float
    setpoint_rate_hz: float
    clock_offset_s: float  # own − master
    gps_fix: int
    ekf_ok: bool
    supervisor: str
    version: str
    counters: dict[str, int]  # drops and overruns by cause
    telemetry_age_s: float = 0.0
    heartbeat_age_s: float = 0.0
    nonce: int = 0


class Severity(Enum):
    INFO = "info"
    WARNING = "warning"
    ERROR = "error"


class Event(Message, frozen=True):
    """`vehicles/<id>/events`: one thing that happened."""

    id: int
    number: int  # counts up from 1 in each process
    stamp_ns: int
    severity: Severity
    kind: str  # machine-readable, e.g. "take_over"
    text: str  # for a person
    level: str = ""
    module: str = ""
    nonce: int = 0


class CommandKind(Enum):
    START = "start"
    HOLD = "hold"
    RESUME = "resume"
    RETURN = "return"
    LAND = "land"
    ABORT = "abort"


class Command(Message, frozen=True):
    """Request on `vehicles/<id>/command`: idempotent by `command_id`."""

    command_id: str
    kind: CommandKind
    sender: str
    stamp_ns: int


class CommandReply(Message, frozen=True):
    """Reply: `state` is accepted | pending | confirmed | refused | superseded."""

    command_id: str
    id: int
    state: str
    reason: str
    obeyed: str  # sender of the command in force
    stamp_ns: int
    mode: str = ""


class Track(Message, frozen=True):
    """`tracks/<id>`: an opponent as a sensor reports it."""

    id: int
    stamp_ns: int  # instant the measurement is of
    position: Triple  # [m; NED]
    velocity: Triple  # [m/s; ground, NED]
    covariance: tuple[float, float, float, float, float, float]  # diagonal: position [m²], velocity [m²/s²]
    sensor: str = ""


M = TypeVar("M", bound=Message)


class Codec(Generic[M]):
    """Encodes and decodes one kind of message. Bad payloads give None and are counted by cause.

    The counter's causes: `undecodable`, `schema`, `not_finite`.
    """

    def __init__(self, kind: type[M]) -> None:
        self._decoder = msgspec.msgpack.Decoder(tuple[int, kind])  # type: ignore[valid-type]
        self._version = msgspec.msgpack.Decoder(tuple[int, msgspec.Raw])
        self._encoder = msgspec.msgpack.Encoder()

    def encode(self, message: M) -> bytes:
        """The payload of a message."""
        return self._encoder.encode((SCHEMA, message))

    def decode(self, payload: bytes, drops: Counter[str]) -> M | None:
        """The message of a payload; None (and one more in `drops`) for a bad one."""
        try:
            version, message = self._decoder.decode(payload)
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
            drops["schema" if self._other_version(payload) else "undecodable"] += 1
            return None
        if version != SCHEMA:
            drops["schema"] += 1
            return None
        if not all_finite(msgspec.structs.astuple(message)):
            drops["not_finite"] += 1
            return None
        return message

    def _other_version(self, payload: bytes) -> bool:
        try:
            version, _ = self._version.decode(payload)
        except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
            return False
        return version != SCHEMA


SETUP = Codec(Setup)
PHASE = Codec(PhaseChange)
OUTCOME = Codec(Outcome)
MASTER = Codec(Master)
EVADER_BRIEF = Codec(EvaderBrief)
STATE = Codec(State)
DECISION = Codec(DecisionReport)
HEALTH = Codec(Health)
EVENT = Codec(Event)
COMMAND = Codec(Command)
COMMAND_REPLY = Codec(CommandReply)
TRACK = Codec(Track)
