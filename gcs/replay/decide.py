"""`gcs replay --decide`: the strategies again over the recorded tracks, and where they decide otherwise.

Each control step is thought again at its own instant by `onboard.pilot.Pilot`, from what its agent knew
then: own state, team mates, the tracks that had arrived by then, wind, setup; predictors are trained at the
same pace. So a changed strategy, or another one by name, shows its differences on flown data. A recording
made on virtual time repeats nearly exactly; in a real one a track may have reached the agent a step
earlier or later than the recorder: the tolerances are for that.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from math import degrees
from typing import NamedTuple

from gcs.recording.reader import Entry
from onboard.core.math.states import Limits
from onboard.core.math.vectors import NORTH, TINY, ZERO, Vec, along, angle_between, norm, unit
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.pilot.memory import Memory
from onboard.pilot.pilot import Pilot, PilotDecision
from onboard.pilot.setup import GameSetup, MateState, Own, Player, Side, TrackSample
from onboard.runtime.plugins import evader_strategy, pursuer_strategy
from onboard.wire.bus import messages as swarm
from onboard.wire.bus import topics
from onboard.wire.bus.messages import (
    DecisionReport,
    Health,
    Phase,
    PhaseChange,
    Role,
    Setup,
    State,
    Track,
    Triple,
)

NS = 1_000_000_000
ANGLE_DEG = 5.0  # directions closer than this are the same
SPEED = 0.5  # [m/s] and speeds
PAUSE_S = 0.5  # differences farther apart are told apart
OLD_STATE_S = 1.0
SLICES = 2  # of training after each control step, as the agent gives them
WINGED = frozenset({"arduplane"})  # autopilots whose vehicles fly in the moving air mass
STEP_S = 0.05


class Difference(NamedTuple):
    """One vehicle deciding otherwise for a while."""

    id: int
    start: float  # [s] since t₀
    end: float
    decisions: int
    recorded: str  # rule at the start
    now: str
    angle_deg: float  # the largest between the directions
    speed: float  # [m/s] the largest between the speeds

    def text(self) -> str:
        """One line."""
        rules = self.now if self.recorded == self.now else f"{self.recorded} → {self.now}"
        many = f", {self.decisions} decisions" if self.decisions > 1 else ""
        return (
            f"T+{self.start:.1f} to {self.end:.1f} s  vehicle {self.id}  {rules}: "
            f"{self.angle_deg:.0f}° and {self.speed:.1f} m/s apart{many}"
        )


class Comparison(NamedTuple):
    """All recorded decisions against those thought now."""

    compared: int
    same: int
    differences: tuple[Difference, ...]
    skipped: tuple[tuple[str, int], ...]  # why decisions were not compared, and how many

    def lines(self) -> list[str]:
        """For a person."""
        share = 100.0 * self.same / self.compared if self.compared else 0.0
        head = f"{self.compared} decisions compared, {self.same} the same ({share:.1f} %)"
        left = [f"{count} not compared: {why}" for why, count in self.skipped]
        return [head, *left, *(difference.text() for difference in self.differences)]


def decide(entries: Iterable[Entry], strategies: dict[Role, str] | None = None) -> Comparison:
    """Think every recorded decision again. `strategies` names others for a role; without, the recorded ones.

    Raises ConfigError for a name that does not exist.
    """
    again = _Again(strategies or {})
    for entry in entries:
        again.take(entry)
    return again.comparison()


class _Mind:
    """One vehicle's pilot with its memory of those it asks for: its opponents."""

    def __init__(self, pilot: Pilot, opponents: list[int]) -> None:
        self.pilot = pilot
        self.memory = Memory(wanted=opponents)
        self.samples: list[TrackSample] = []
        self.thought: PilotDecision | None = None
        self.thought_ns = 0  # the step that it is of


class _Open:
    """A difference that may still go on."""

    def __init__(self, report: DecisionReport, thought: PilotDecision, angle: float, speed: float) -> None:
        self.start = self.end = report.t
        self.decisions = 1
        self.recorded, self.now = report.rule, thought.rule
        self.angle, self.speed = angle, speed

    def closed(self, vehicle: int) -> Difference:
        return Difference(
            vehicle, self.start, self.end, self.decisions, self.recorded, self.now, self.angle, self.speed
        )


class _Again:
    def __init__(self, strategies: dict[Role, str]) -> None:
        for role, name in strategies.items():
            _pilot(0, role, name)  # a name that does not exist is told before anything else
        self._strategies = strategies
        self._drops: Counter[str] = Counter()
        self._setup: Setup | None = None
        self._phase: PhaseChange | None = None
        self._target: Triple | None = None
        self._states: dict[int, State] = {}
        self._heights: dict[int, float] = {}  # of each vehicle at its first decision [m]
        self._winged: set[int] = set()
        self._minds: dict[int, _Mind] = {}
        self._base_ns = 0
        self._skipped: Counter[str] = Counter()
        self._open: dict[int, _Open] = {}
        self._found: list[Difference] = []
        self._compared = self._same = 0

    def take(self, entry: Entry) -> None:
        topic = topics.topic_of(entry.key)
        self._base_ns = self._base_ns or entry.stamp_ns
        if topic is topics.STATE:
            state: State | None = swarm.STATE.decode(entry.payload, self._drops)
            if state is not None:
                self._states[state.id] = state
                self._step(state)
        elif topic is topics.TRACK:
            track: Track | None = swarm.TRACK.decode(entry.payload, self._drops)
            if track is not None:
                self._take_track(track)
        elif topic is topics.DECISION:
            report: DecisionReport | None = swarm.DECISION.decode(entry.payload, self._drops)
            if report is not None:
                self._compare(report)
        elif topic is topics.HEALTH:
            health: Health | None = swarm.HEALTH.decode(entry.payload, self._drops)
            if health is not None and health.autopilot.lower() in WINGED:
                self._winged.add(health.id)
        elif topic is topics.SETUP:
            setup = swarm.SETUP.decode(entry.payload, self._drops)
            if setup is not None and setup != self._setup:
                self._setup = setup
                players = [m for m in setup.roster if m.role is not Role.TRACKER]
                self._minds = {
                    m.id: _Mind(
                        _pilot(m.id, m.role, self._strategies.get(m.role) or m.strategy),
                        [other.id for other in players if other.role is not m.role],
                    )
                    for m in players
                }
        elif topic is topics.PHASE:
            phase = swarm.PHASE.decode(entry.payload, self._drops)
            self._phase = phase or self._phase
        elif topic is topics.EVADER_BRIEF:
            brief = swarm.EVADER_BRIEF.decode(entry.payload, self._drops)
            self._target = brief.target if brief is not None else self._target

    def comparison(self) -> Comparison:
        for vehicle, opened in sorted(self._open.items()):
            self._found.append(opened.closed(vehicle))
        self._open = {}
        found = tuple(sorted(self._found, key=lambda d: (d.start, d.id)))
        return Comparison(self._compared, self._same, found, tuple(sorted(self._skipped.items())))

    def _take_track(self, track: Track) -> None:
        sample = TrackSample(
            track.id,
            self._seconds(track.stamp_ns),
            Vec(*track.position),
            Vec(*track.velocity),
            track.covariance,
        )
        for vehicle, mind in self._minds.items():
            if vehicle != track.id:
                mind.samples.append(sample)

    def _step(self, state: State) -> None:
        """The control step that published this state."""
        mind = self._minds.get(state.id)
        if mind is None or self._setup is None:
            return
        phase = self._phase
        if phase is not None and phase.phase is Phase.RUNNING and state.stamp_ns >= phase.t0_ns:
            self._think(mind, state, state.stamp_ns, self._setup)
        else:
            mind.memory.take(tuple(mind.samples))
            mind.samples.clear()
        mind.memory.train(self._seconds(state.stamp_ns), SLICES)

    def _compare(self, report: DecisionReport) -> None:
        setup, state, mind = self._setup, self._states.get(report.id), self._minds.get(report.id)
        if setup is None or mind is None:
            self._skipped["no setup that names the vehicle"] += 1
            return
        if report.rule in ("", "none"):
            self._skipped["the agent had nothing to decide"] += 1
            return
        if state is None or abs(report.stamp_ns - state.stamp_ns) > OLD_STATE_S * NS:
            self._skipped["no state of the vehicle at that time"] += 1
            return
        wanted = self._strategies.get(state.role) or report.strategy
        thought = mind.thought
        if wanted and mind.pilot.strategy != wanted:  # configured onboard, or changed in flight
            mind.pilot = _pilot(report.id, state.role, wanted)
            thought = None
        if thought is None or mind.thought_ns != report.stamp_ns:
            thought = self._think(mind, state, report.stamp_ns, setup)
        if not thought.decides:
            self._skipped[f"lacks {', '.join(thought.lacks)}"] += 1
            return
        self._judge(report, thought)

    def _think(self, mind: _Mind, state: State, at_ns: int, setup: Setup) -> PilotDecision:
        self._heights.setdefault(state.id, -state.position[2])
        now = self._seconds(at_ns)
        late = min(max(0.0, now - self._seconds(state.stamp_ns)), 0.5)
        own = Own(along(Vec(*state.position), Vec(*state.velocity), late), Vec(*state.velocity))
        wind = Vec(*state.wind) if state.id in self._winged else ZERO
        mates = tuple(
            MateState(s.id, self._seconds(s.stamp_ns), Vec(*s.position), Vec(*s.velocity))
            for s in self._states.values()
            if s.role is state.role and s.id != state.id
        )
        game = self._game(setup, state.role is Role.EVADER)
        thought, mind.memory = mind.pilot.step(now, own, tuple(mind.samples), mates, game, wind, mind.memory)
        mind.samples.clear()
        mind.thought, mind.thought_ns = thought, at_ns
        return thought

    def _judge(self, report: DecisionReport, thought: PilotDecision) -> None:
        was = Vec(*report.velocity)
        angle = 0.0
        if norm(was) > TINY and norm(thought.velocity) > TINY:
            angle = degrees(angle_between(unit(was, NORTH), unit(thought.velocity, NORTH)))
        speed = abs(norm(was) - norm(thought.velocity))
        self._compared += 1
        opened = self._open.get(report.id)
        if thought.rule == report.rule and angle <= ANGLE_DEG and speed <= SPEED:
            self._same += 1
            return
        if opened is not None:
            goes_on = report.t - opened.end <= PAUSE_S
            if goes_on and (opened.recorded, opened.now) == (report.rule, thought.rule):
                opened.end = report.t
                opened.decisions += 1
                opened.angle, opened.speed = max(opened.angle, angle), max(opened.speed, speed)
                return
            self._found.append(opened.closed(report.id))
        self._open[report.id] = _Open(report, thought, angle, speed)

    def _game(self, setup: Setup, evader: bool) -> GameSetup:
        """The game as the agent told it to its pilot; the target for the evader alone."""
        players = tuple(
            Player(
                m.id,
                Side.EVADER if m.role is Role.EVADER else Side.PURSUER,
                m.speed_max,
                Limits(m.speed_min, m.speed_max, m.pitch_min, m.pitch_max),
                -m.start[2] if -m.start[2] >= 1.0 else self._heights.get(m.id, -m.start[2]),
            )
            for m in setup.roster
            if m.role is not Role.TRACKER
        )
        target = self._target if evader else None
        return GameSetup(
            roster=players,
            R=setup.capture_radius,
            rho=setup.safety_distance,
            lambda_=setup.lambda_,
            beta=setup.beta,
            separation=setup.separation,
            planar=setup.planar or setup.field_profile,
            has_target=target is not None,
            target=Vec(*target) if target is not None else ZERO,
            dt=STEP_S,
        )

    def _seconds(self, stamp_ns: int) -> float:
        return (stamp_ns - self._base_ns) / NS


def _pilot(vehicle: int, role: Role, name: str) -> Pilot:
    """The pilot of a vehicle. Raises ConfigError for a strategy that does not exist."""
    if role is Role.EVADER:
        evade = evader_strategy(name)
        return Pilot(vehicle, Side.EVADER, name, evader=None if name in ("", *EVADERS) else evade)
    pursue = pursuer_strategy(name)
    return Pilot(vehicle, Side.PURSUER, name, pursuer=None if name in ("", *PURSUERS) else pursue)
