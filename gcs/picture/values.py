"""The values of the fleet picture: frozen, complete, taken at one instant.

Ages are seconds at `Picture.now_ns`; an age of something never heard is infinite. Instants are
integer nanoseconds. Positions and velocities as on the bus: game frame (north, east, down), SI.
"""

from __future__ import annotations

from enum import Enum
from math import sqrt

import msgspec

from onboard.game import sides
from onboard.wire.bus.knowledge_messages import Knowledge
from onboard.wire.bus.messages import (
    CommandKind,
    DecisionReport,
    Health,
    Master,
    Outcome,
    OutcomeResult,
    Phase,
    Role,
    Setup,
    Severity,
    State,
    SupervisorAction,
    Triple,
)
from onboard.wire.bus.messages import Track as TrackMessage
from onboard.wire.bus.team_messages import TeamPlan

INF = float("inf")
MASTER_OLD_S = 2.0  # a master that is silent for longer, and for its lease, keeps no clock


class Value(msgspec.Struct, frozen=True, kw_only=True):
    """Base of the picture's values."""


class Presence(Enum):
    """Whether a vehicle is there."""

    EXPECTED = "expected"  # in the roster, not heard yet
    PRESENT = "present"  # heard within the last second
    LOST = "lost"  # silent from all sources for longer


class VehicleView(Value, frozen=True):
    """One vehicle: its last messages and how old they are."""

    id: int
    role: Role | None
    presence: Presence
    age_s: float  # since any message of its agent
    token: bool  # its liveliness token is there
    first_ns: int  # when it was first heard, 0 = never
    state: State | None = None
    state_age_s: float = INF
    decision: DecisionReport | None = None
    decision_age_s: float = INF
    health: Health | None = None
    health_age_s: float = INF
    state_rate_hz: float = 0.0  # measured here, over the last whole second
    double_id: bool = False  # two processes speak under this id
    dropped: tuple[tuple[str, int], ...] = ()  # messages of this vehicle dropped here, by cause
    schema_age_s: float = INF  # since a message of another schema version
    missed_events: int = 0
    growing: tuple[tuple[str, int], ...] = ()  # counters of trouble that grow: name, number so far
    trail: tuple[tuple[float, float, float], ...] = ()  # (north, east, down) [m], oldest first

    @property
    def mode(self) -> str:
        """The autopilot's mode, from the newer of state and health."""
        newest = self._newest
        return newest.mode if newest else ""

    @property
    def armed(self) -> bool:
        """Armed, from the newer of state and health."""
        newest = self._newest
        return newest.armed if newest else False

    @property
    def _newest(self) -> State | Health | None:
        if self.state is None:
            return self.health
        if self.health is None:
            return self.state
        return self.health if self.health_age_s < self.state_age_s else self.state

    @property
    def position(self) -> Triple | None:
        """Last known position [m; NED]."""
        return self.state.position if self.state else None

    @property
    def groundspeed(self) -> float:
        """Horizontal speed over ground [m/s]; 0 where unknown."""
        if self.state is None:
            return 0.0
        north, east, _ = self.state.velocity
        return sqrt(north * north + east * east)

    @property
    def rule(self) -> str:
        """The rule in force, or what the supervisor does instead of it and why; "" = none reported."""
        if self.decision is None:
            return ""
        if self.decision.supervisor in (SupervisorAction.OK, SupervisorAction.CLIP):
            return self.decision.rule
        why = f": {self.decision.reason}" if self.decision.reason else ""
        return f"{self.decision.supervisor.value.upper()}{why}"


class TrackView(Value, frozen=True):
    """A track of a sensor."""

    id: int
    track: TrackMessage
    age_s: float
    rate_hz: float
    trail: tuple[tuple[float, float, float], ...] = ()


class FateView(Value, frozen=True):
    """How the game ended for one evader."""

    id: int
    verdict: OutcomeResult
    captor: int  # id, 0 = nobody
    time_s: float  # since t₀

    @property
    def out(self) -> bool:
        """Whether it is out of the game: captured or at its target."""
        return self.verdict in (OutcomeResult.CAPTURED, OutcomeResult.ARRIVED)

    @property
    def words(self) -> str:
        """For people: `captured by 3 at 12.5 s`."""
        by = f" by {self.captor}" if self.captor else ""
        return f"{self.verdict.value}{by} at {self.time_s:.1f} s"


class GoalView(Value, frozen=True):
    """A target of an evader; ground only."""

    evader: int  # id, 0 = not told whose
    place: Triple  # [m; NED]


class GameView(Value, frozen=True):
    """The game as its master tells it."""

    name: str
    setup: Setup | None = None
    phase: Phase | None = None
    reason: str = ""  # of the phase
    t0_ns: int = 0
    time_s: float = 0.0  # since t₀; negative before, 0 where t₀ is not fixed
    outcome: Outcome | None = None
    targets: tuple[GoalView, ...] = ()  # of all evaders, by evader
    quarries: tuple[tuple[int, int], ...] = ()  # a pursuer's id, and the evader's that it is after
    fates: tuple[FateView, ...] = ()  # of evaders that are out, of all when the game has ended; by id
    master: Master | None = None
    master_age_s: float = INF
    two_masters: bool = False
    plan: TeamPlan | None = None  # that the pursuers fly by
    knowledge: tuple[Knowledge, ...] = ()  # what its planner knows, by evader

    @property
    def evaders(self) -> tuple[int, ...]:
        """The ids of the setup's evaders, ascending."""
        return sides.evaders(self.roles)

    @property
    def roles(self) -> dict[int, Role]:
        """Everybody's role in the setup, by id."""
        return {member.id: member.role for member in self.setup.roster} if self.setup else {}

    def targets_of(self, evader: int) -> tuple[Triple, ...]:
        """Where an evader wants to go [m; NED]; reaching any of them counts."""
        return tuple(goal.place for goal in self.targets if goal.evader in (evader, 0))

    def quarry_of(self, pursuer: int) -> int | None:
        """The evader that a pursuer is after; None where nobody says so."""
        return next((evader for id, evader in self.quarries if id == pursuer), None)

    def hunters_of(self, evader: int) -> tuple[int, ...]:
        """Who is after an evader."""
        return tuple(id for id, quarry in self.quarries if quarry == evader)

    def fate_of(self, evader: int) -> FateView | None:
        """How the game ended for an evader; None where it is still in it."""
        return next((fate for fate in self.fates if fate.id == evader), None)

    @property
    def clock(self) -> str:
        """Time of the game for a person: `T−3.2 s`, `T+12.5 s`, `–`.

        It stands still where the game has ended, and where its master has fallen silent, which it says.
        """
        if not self.t0_ns:
            return "–"
        if self.outcome is not None:
            return _clock(self.outcome.time)
        silent_s = self.master_age_s
        if self.master is None or silent_s <= max(self.master.lease_s, MASTER_OLD_S):
            return _clock(self.time_s)
        return f"{_clock(self.time_s - silent_s)} when its master was last heard, {silent_s:.0f} s ago"


def _clock(time_s: float) -> str:
    return f"T{'−' if time_s < 0 else '+'}{abs(time_s):.1f} s"


class Alert(Value, frozen=True):
    """Something a person should know, and what to do about it."""

    name: str  # unique: `kind:id`, or `kind` where it concerns no single vehicle
    kind: str
    id: int  # vehicle, 0 = none
    severity: Severity
    text: str
    advice: str
    raised_ns: int
    acknowledged: bool = False
    cleared_ns: int = 0  # 0 = in force


class LogLine(Value, frozen=True):
    """One line of the event log."""

    at_ns: int  # arrival
    id: int  # vehicle, 0 = station
    severity: Severity
    kind: str
    text: str
    event_ns: int = 0  # a vehicle's own stamp of its event, 0 = none

    @property
    def own_ns(self) -> int:
        """When it happened: by the vehicle's own stamp, else when it was heard."""
        return self.event_ns or self.at_ns


class LegState(Enum):
    """How far a command to one vehicle has come: the agent's word, or the station's own."""

    SENT = "sent"  # no answer yet
    PENDING = "pending"
    CONFIRMED = "confirmed"
    REFUSED = "refused"
    SUPERSEDED = "superseded"
    EXPIRED = "expired"  # no longer repeated

    @property
    def words(self) -> str:
        """For people."""
        return "no answer" if self is LegState.SENT else self.value


class Leg(Value, frozen=True):
    """A command's way to one vehicle."""

    id: int
    state: LegState
    reason: str = ""
    mode: str = ""  # of the autopilot, as the answer gives it
    obeyed: str = ""  # whom the agent obeys now
    took_s: float = 0.0  # until the final answer, or so far

    @property
    def open(self) -> bool:
        """No final answer yet."""
        return self.state in (LegState.SENT, LegState.PENDING)


class CommandView(Value, frozen=True):
    """A command and who has confirmed it."""

    command_id: str
    kind: CommandKind
    sender: str
    issued_ns: int
    legs: tuple[Leg, ...]

    @property
    def confirmed(self) -> bool:
        """Every vehicle has confirmed."""
        return bool(self.legs) and all(leg.state is LegState.CONFIRMED for leg in self.legs)

    @property
    def unconfirmed(self) -> tuple[int, ...]:
        """Who has not confirmed."""
        return tuple(leg.id for leg in self.legs if leg.state is not LegState.CONFIRMED)


class ProspectView(Value, frozen=True):
    """What one pursuer can do against the evader's present heading."""

    id: int
    intercepts: bool
    time_s: float  # until then, −1 = never
    denies_target: bool


class AssessmentView(Value, frozen=True):
    """What the situation of one evader promises, by declared airspeeds and the last known positions."""

    evader: int  # its id
    encircled: bool  # no free ray
    gaps: tuple[tuple[float, float], ...]  # in the plane: start, width [rad], north to east
    largest_gap: float  # in the plane: its width; in space: of the largest free cap [rad]
    target_denied: bool
    prospects: tuple[ProspectView, ...]
    captured: tuple[float, float, float] | None = None  # chance, with its 95 % interval
    word: str = ""  # go, no-go, open, unknown; "" = not judged
    why: str = ""  # the bound, and the band; where it is not judged: why
    alone: bool = True  # the only evader of its game


class Picture(Value, frozen=True):
    """Everything, at one instant."""

    now_ns: int
    game: GameView
    vehicles: tuple[VehicleView, ...]  # by id
    tracks: tuple[TrackView, ...]  # by id
    alerts: tuple[Alert, ...] = ()  # in force, worst first
    past_alerts: tuple[Alert, ...] = ()  # cleared, newest last
    log: tuple[LogLine, ...] = ()  # newest last
    commands: tuple[CommandView, ...] = ()  # newest last
    dropped: tuple[tuple[str, int], ...] = ()  # messages dropped here, by cause
    bad_age_s: float = INF  # since the last of them
    received: int = 0
    assessments: tuple[AssessmentView, ...] = ()  # of the evaders in the game, by id

    def vehicle(self, vehicle_id: int) -> VehicleView | None:
        """The vehicle of an id."""
        return next((v for v in self.vehicles if v.id == vehicle_id), None)

    def assessment_of(self, evader: int) -> AssessmentView | None:
        """What an evader's situation promises; None where it is not known, or it is out of the game."""
        return next((found for found in self.assessments if found.evader == evader), None)

    @property
    def roles(self) -> dict[int, Role | None]:
        """Everybody's role, by id: what a vehicle says of itself, else the setup."""
        return {**self.game.roles, **{v.id: v.role for v in self.vehicles if v.role is not None}}
