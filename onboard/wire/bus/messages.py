"""The messages of the bus: frozen msgspec structs in MessagePack with a schema version.

Every payload is the pair [SCHEMA, message]. Additive changes (a new field with a default at
the end) keep SCHEMA; any other change raises it. Units: SI and radians, game frame (north,
east, down); wall instants are integer nanoseconds since the epoch. Vectors travel as
3-tuples (n, e, d). What people read (stage, result, state of a command) is an enum whose values are
words, so that a recording can be read. The keys that messages travel on are in `topics`.
"""

from __future__ import annotations

from enum import Enum

from onboard.config.derive import core_from, struct_from
from onboard.core.game.rules import Rules
from onboard.core.math.states import VehicleLimits
from onboard.wire.autopilot_kind import Kind
from onboard.wire.bus.base import Message as Message
from onboard.wire.bus.base import Triple as Triple
from onboard.wire.bus.evader_messages import EvaderOutcome as EvaderOutcome
from onboard.wire.bus.evader_messages import EvaderTargets as EvaderTargets
from onboard.wire.bus.evader_messages import OutcomeResult as OutcomeResult
from onboard.wire.bus.evader_messages import OwnBrief as OwnBrief
from onboard.wire.bus.zone_messages import Zone as Zone
from onboard.wire.bus.zone_messages import core_zones

SCHEMA = 2


class Role(Enum):
    """What a vehicle does in a game."""

    EVADER = "evader"
    PURSUER = "pursuer"
    TRACKER = "tracker"


class Phase(Enum):
    """Where a game stands."""

    STAGING = "staging"  # the vehicles take their places
    READY = "ready"  # the start t₀ is fixed
    RUNNING = "running"
    ENDED = "ended"
    RECOVERY = "recovery"  # the vehicles are brought home


class AgentStage(Enum):
    """What an agent does with its vehicle."""

    WAITING = "waiting"  # something that it needs for a game is missing: `Health.lacks`
    READY = "ready"
    ACTING = "acting"  # its setpoints fly the vehicle
    HELD = "held"  # an order or the supervisor stopped the setpoints
    HANDED_OVER = "handed_over"  # a pilot flies the vehicle
    ENDED = "ended"


class DecisionLevel(Enum):
    """The level of control that decided."""

    NONE = ""  # not told
    STRATEGIC = "strategic"
    TACTICAL = "tactical"
    EXECUTIVE = "executive"


class DecisionModule(Enum):
    """The kind of reasoning that decided."""

    NONE = ""  # not told
    INTELLIGENT = "intelligent"  # rules of the knowledge base
    GEOMETRIC = "geometric"


class SupervisorAction(Enum):
    """What an agent's supervisor did with a decision."""

    OK = "ok"  # let it pass
    CLIP = "clip"  # brought it within the vehicle's limits
    HOLD = "hold"
    RETURN = "return"
    LAND = "land"
    END = "end"  # stopped sending setpoints


class Origin(Message, frozen=True):
    """Origin of the game frame: WGS-84 latitude and longitude, altitude above mean sea level."""

    latitude_deg: float
    longitude_deg: float
    altitude_m: float


class RulesMessage(struct_from(Rules, Message, leave_out=("zones",))):  # type: ignore[misc]
    """The core's Rules on the bus, field by field as the core has them; zones are the setup's."""

    @classmethod
    def of(cls, rules: Rules) -> RulesMessage:
        """From the core's value."""
        return cls(*(getattr(rules, field) for field in cls.__struct_fields__))


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
    tracked: bool = False  # known by tracks alone: no agent flies it
    heading: float | None = None  # of the nose at the start [rad, north to east]; None = any


class Fence(Message, frozen=True):
    """Geofence: a polygon of (north, east) [m] and an altitude band above the origin [m]."""

    polygon: tuple[tuple[float, float], ...]
    altitude_min: float
    altitude_max: float


class Setup(Message, frozen=True):
    """`game/setup`: everything but the evaders' targets, unless the rules say that the pursuers know them."""

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
    nonce: int = 0  # of the master's process, as in `Master`
    target: Triple | None = None  # the first evader's first [m; NED], where the pursuers may know it
    targets: tuple[EvaderTargets, ...] = ()  # all, where they may know them and there are more than that one
    zones: tuple[Zone, ...] = ()  # that everybody keeps out of

    @property
    def flat(self) -> bool:
        """Whether heights do not count: a plane game, or the field profile."""
        return bool(self.rules.planar or self.field_profile)

    def core_rules(self) -> Rules:
        """The rules for the core, zones among them."""
        return core_from(self.rules, Rules, zones=core_zones(self.zones))


class PhaseChange(Message, frozen=True):
    """`game/phase`. `t0_ns` is the wall instant of the game's start (0 before it is fixed)."""

    phase: Phase
    t0_ns: int
    stamp_ns: int
    resume: tuple[int, ...] = ()  # ids of restarted agents that may act again
    reason: str = ""
    master: str = ""  # who says so
    nonce: int = 0  # of the master's process, as in `Master`
    number: int = 0  # counts the master's phases: the greater one is the later one, whatever clocks say
    out: tuple[EvaderOutcome, ...] = ()  # of several evaders those whose game is over: they play no part


class Outcome(Message, frozen=True):
    """`game/outcome`. Of several evaders the worst for the pursuers decides the whole game: one that arrived,
    then one without a result, one that escaped, one that was denied; it is captured where all were."""

    verdict: OutcomeResult
    time: float  # [s] since t0; of several evaders the last one's
    captor: int  # id, 0 = nobody; of several captured the last one's
    smallest_distance: float  # [m] over all pursuers
    stamp_ns: int
    reason: str = ""
    evaders: tuple[EvaderOutcome, ...] = ()  # of several each one's own, in the roster's order


class Master(Message, frozen=True):
    """`game/master`: the master's lease, and the clock the agents compare theirs with."""

    name: str
    stamp_ns: int
    lease_s: float = 2.0
    nonce: int = 0  # tells two masters of one name apart
    number: int = 0  # counts up with each word: what an order quotes
    takes_over: str = ""  # name of the master whose running game a person took over


class EvaderBrief(Message, frozen=True):
    """`roles/evader/brief`: for the evader alone; several have an `OwnBrief` each."""

    target: Triple | None  # [m; NED] the first
    stamp_ns: int
    targets: tuple[Triple, ...] = ()  # [m; NED] all, where it has several: it may go to any


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
    fit: bool = True  # whether it follows the game: False while it is held, handed over, or lacks something


class DecisionReport(Message, frozen=True):
    """`vehicles/<id>/decision`: what was decided and why."""

    id: int
    stamp_ns: int
    t: float  # [s] since t0
    level: DecisionLevel
    module: DecisionModule
    strategy: str
    rule: str
    velocity: Triple  # [m/s; relative to the air, NED]
    aim: Triple  # [m; NED]
    time_to_aim: float  # [s]
    miss: float  # [m] predicted closest approach
    cones: tuple[tuple[float, float, float, float], ...] = ()  # axis (n, e, d), half-angle [rad]
    circles: tuple[tuple[float, float, float, float], ...] = ()  # centre (n, e, d), radius [m]
    supervisor: SupervisorAction = SupervisorAction.OK  # the action in force
    reason: str = ""
    predictor: str = ""  # which predictor spoke
    predictor_sigma: float = 0.0  # [m] its stated error now
    setpoint: Triple = (0.0, 0.0, 0.0)  # [m/s; ground, NED] what was sent
    quarry: int = 0  # id of the evader that a pursuer is after, where there are several; 0 = none


class LinkLock(Enum):
    """What keeps strangers off an agent's MAVLink links."""

    SILENT = "silent"  # a key is set; nothing of the autopilot's has been heard
    OPEN = "open"  # no key: whoever reaches a link can command the vehicle
    SIGNED = "signed"  # with the key that the agent has
    REFUSED = "refused"  # frames come, and their signatures are not good: nothing of them counts


class Health(Message, frozen=True):
    """`vehicles/<id>/health`: heartbeat of the agent."""

    id: int
    role: Role
    stamp_ns: int
    stage: AgentStage
    lacks: tuple[str, ...]  # what an agent with no game waits for
    autopilot: Kind | None  # None = none found
    mode: str
    armed: bool
    battery: float  # fraction 0…1, −1 = unknown
    link_quality: float  # fraction of expected telemetry received, 0…1
    telemetry_rate_hz: float
    setpoint_rate_hz: float
    clock_offset_s: float  # own − master
    gps_fix: int
    ekf_ok: bool
    supervisor: SupervisorAction
    version: str
    counters: dict[str, int]  # drops and overruns by cause
    telemetry_age_s: float = 0.0
    heartbeat_age_s: float = 0.0
    nonce: int = 0
    number: int = 0  # counts up in each process: what an order quotes where there is no master
    stopped_by: str = ""  # id of the last order obeyed that stops; '' = none by this process
    link_lock: LinkLock = LinkLock.OPEN
    failsafe: bool = False  # handed over: to the autopilot's own failsafe, not to a person
    hold_lost: str = ""  # why the mode in which it was left does not hold it; '' = it does, or none was left
    return_m: float = -1.0  # height above home of the autopilot's way home, −1 = as high as it is, or unknown
    loiter_m: float = 0.0  # radius of its circle when it holds; 0 of those that hover
    place_s: float = 0.0  # time that the vehicle needs to its place; before t₀, by which it would be late


class Severity(Enum):
    """How much an event matters to a person."""

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
    level: DecisionLevel = DecisionLevel.NONE
    module: DecisionModule = DecisionModule.NONE
    nonce: int = 0


class CommandKind(Enum):
    """What a ground station may order a vehicle to do."""

    START = "start"
    HOLD = "hold"
    RESUME = "resume"
    RETURN = "return"
    LAND = "land"
    ABORT = "abort"


class Quote(Message, frozen=True):
    """What the sender of an order had heard when it was given: its age and place in order."""

    nonce: int = 0  # of the master's process (of the agent's, where there is no master)
    number: int = 0  # of its newest word: `Master.number`, or `Health.number`
    agent: int = 0  # `Health.nonce` of the agent's process that the order is for
    after: str = ""  # `Health.stopped_by`


class Command(Message, frozen=True):
    """Request on `vehicles/<id>/command`: once by id, sender and kind; docs/commands.md says the rest."""

    command_id: str
    kind: CommandKind
    sender: str
    stamp_ns: int  # for people: no age is taken from it
    mode: str = ""  # the autopilot's, as a person saw it who named this vehicle alone; "": not confirmed
    quote: Quote = Quote()


class CommandState(Enum):
    """How far an agent has come with a command."""

    PENDING = "pending"  # taken; the autopilot does not report the state ordered yet
    CONFIRMED = "confirmed"  # the autopilot reports the state ordered
    REFUSED = "refused"
    SUPERSEDED = "superseded"  # by a later command
    EXPIRED = "expired"  # it set off, and the autopilot did not report it in time: it never acts any more


class CommandReply(Message, frozen=True):
    """Reply to a command on `vehicles/<id>/command`."""

    command_id: str
    id: int
    state: CommandState
    reason: str
    obeyed: str  # sender of the command in force
    stamp_ns: int
    mode: str = ""


class Alive(Message, frozen=True):
    """`vehicles/<id>/alive`: a liveliness token, which carries no payload."""


class Track(Message, frozen=True):
    """`tracks/<id>`: an opponent as a sensor reports it."""

    id: int
    stamp_ns: int  # instant the measurement is of
    position: Triple  # [m; NED]
    velocity: Triple  # [m/s; ground, NED]
    covariance: tuple[float, float, float, float, float, float]  # diagonal: position [m²], velocity [m²/s²]
    sensor: str = ""
