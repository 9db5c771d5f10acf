"""One evader's game as the master judges it, and what the games of several evaders come to together.

Each evader is judged by itself against all pursuers, by the core's referee: over the time since its position
was known last. Who is captured, has arrived or is lost from sight leaves the game; the others' goes on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import repeat
from math import inf, sqrt

from msgspec.structs import replace

from onboard.core.game.referee import GameResult, Score, Step, closest, judge_any, opening
from onboard.core.game.rules import Rules, Target
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.each import new
from onboard.core.math.vectors import Vec, along, sub
from onboard.wire.bus.evader_messages import EvaderOutcome, OutcomeResult
from onboard.wire.bus.messages import Outcome, Role, Setup

RESULTS = {
    GameResult.CAPTURED: OutcomeResult.CAPTURED,
    GameResult.ARRIVED: OutcomeResult.ARRIVED,
    GameResult.ESCAPED: OutcomeResult.ESCAPED,
    GameResult.DENIED: OutcomeResult.DENIED,
}
UNSEEN_NS = 10 * NS_PER_S  # an evader whom nobody sees for so long cannot be judged
WORST = (
    OutcomeResult.ARRIVED,
    OutcomeResult.ABORTED,
    OutcomeResult.ESCAPED,
    OutcomeResult.DENIED,
    OutcomeResult.CAPTURED,
)
"""Verdicts of single evaders, the worst for the pursuers first: it is the whole game's."""

Places = tuple[Vec, ...]  # [m; NED]


class Trial:
    """One evader's game. `targets` are its [m; NED], `judged` the same as they are judged, in a plane game
    without heights; `speeds` what everybody declares [m/s], by vehicle."""

    def __init__(
        self, id: int, targets: Places, judged: Places, speeds: Mapping[int, float]
    ) -> None:
        self.id = id
        self.targets = targets
        self._goals = tuple(Target(True, place) for place in judged)
        self.outcome: EvaderOutcome | None = None  # None while it is in the game
        self.seen_ns = 0  # when its position was last known [ns, monotonic]
        self._speeds = speeds
        self._score: Score | None = None
        self._before: dict[int, Vec] = {}
        self._before_ns = 0

    @property
    def smallest(self) -> float:
        """Smallest distance of any pursuer to it so far [m]; −1 where it was not judged yet."""
        return -1.0 if self._score is None else self._score.smallest

    def observe(
        self, wall_ns: int, t0_ns: int, here: dict[int, Vec], pursuers: Sequence[int], rules: Rules
    ) -> dict[int, float]:
        """Judge it on places [m] of `wall_ns`, its own among them, over all the time since the last call.

        The smallest distances of the pursuers in that time are given back, by vehicle."""
        nearest: dict[int, float] = {}
        if self._score is None:
            self._score = opening(here[self.id], tuple(here[id] for id in pursuers if id in here))
        elif wall_ns > self._before_ns:
            start, dt = (self._before_ns - t0_ns) / NS_PER_S, (wall_ns - self._before_ns) / NS_PER_S
            ids = tuple([id for id in pursuers if id in self._before and id in here])
            nearest = self._judge(start, dt, here, ids, rules)
        self._before, self._before_ns = here, wall_ns
        return nearest

    def leave(self, verdict: OutcomeResult, time: float, captor: int = 0) -> None:
        """Its game is over at `time` [s since t0]."""
        self.outcome = EvaderOutcome(self.id, verdict, time, captor, self.smallest)

    def _judge(
        self, start: float, dt: float, here: dict[int, Vec], ids: tuple[int, ...], rules: Rules
    ) -> dict[int, float]:
        assert self._score is not None
        before, after = tuple([self._before[id] for id in ids]), tuple([here[id] for id in ids])
        e0, e1 = self._before[self.id], here[self.id]
        speeds = tuple([self._speeds[id] for id in ids])
        step = Step(start, dt, e0, e1, before, after, self._speeds[self.id], speeds)
        self._score = score = judge_any(self._score, step, rules, self._goals)
        if score.verdict != GameResult.RUNNING:
            captor = ids[score.captor] if score.captor >= 0 else 0
            self.leave(RESULTS[GameResult(score.verdict)], score.time, captor)
            played = min(1.0, (score.time - start) / dt)  # a game ends within a step
            e1, after = _part(e0, e1, played), tuple(map(_part, before, after, repeat(played)))
        return {
            id: sqrt(closest(p0, p1, e0, e1).square) for id, p0, p1 in zip(ids, before, after, strict=True)
        }


class Trials:
    """The games of a roster's evaders. `targets` are theirs [m; NED], by vehicle."""

    def __init__(self, setup: Setup, targets: Mapping[int, tuple[Vec, ...]]) -> None:
        speeds = {member.id: member.speed for member in setup.roster}  # declared [m/s]; 0 = not
        evaders = tuple(member.id for member in setup.roster if member.role is Role.EVADER)
        self._flat = setup.flat
        goals = {id: targets.get(id, ()) for id in evaders}
        self.all = {id: Trial(id, g, tuple(map(self._judged, g)), speeds) for id, g in goals.items()}
        self.nearest: dict[int, float] = {}  # smallest distance of each pursuer to any evader so far [m]
        self._pursuers = tuple(member.id for member in setup.roster if member.role is Role.PURSUER)
        self._rules = setup.core_rules()

    @property
    def playing(self) -> list[Trial]:
        """Those that are not over."""
        return [trial for trial in self.all.values() if trial.outcome is None]

    @property
    def out(self) -> tuple[EvaderOutcome, ...]:
        """Of several evaders those whose game is over."""
        ends = tuple(trial.outcome for trial in self.all.values() if trial.outcome is not None)
        return ends if len(self.all) > 1 else ()

    def is_out(self, id: int) -> bool:
        """Whether a vehicle is an evader whose game is over."""
        return id in self.all and self.all[id].outcome is not None

    def observe(self, wall_ns: int, now_ns: int, t0_ns: int, positions: Mapping[int, Vec]) -> list[Trial]:
        """Judge everybody on places [m; NED] of `wall_ns`; those whose game that ended."""
        judged = self._judged
        here = {id: judged(positions[id]) for id in (*self.all, *self._pursuers) if id in positions}
        looked_at = [trial for trial in self.playing if trial.id in here]
        for trial in looked_at:
            trial.seen_ns = now_ns
            near = trial.observe(wall_ns, t0_ns, here, self._pursuers, self._rules)
            for id, distance in near.items():
                if distance < self.nearest.get(id, inf):
                    self.nearest[id] = distance
        return [trial for trial in looked_at if trial.outcome is not None]

    def seen(self, now_ns: int) -> None:
        """Count everybody as seen now: before t0 nobody is looked for."""
        for trial in self.all.values():
            trial.seen_ns = now_ns

    def lose_sight(self, now_ns: int, time: float) -> list[Trial]:
        """Let evaders leave at `time` [s since t0] whom nobody has seen for long; those."""
        lost = [trial for trial in self.playing if now_ns - trial.seen_ns > UNSEEN_NS]
        for trial in lost:
            trial.leave(OutcomeResult.ABORTED, time)
        return lost

    def whole(self, wall_ns: int) -> Outcome:
        """The outcome of a game all of whose evaders' games are over, stamped `wall_ns`; see `Outcome`."""
        ends = tuple(trial.outcome for trial in self.all.values() if trial.outcome is not None)
        worst = min(ends, key=lambda end: WORST.index(end.verdict))
        last = max(ends, key=lambda end: end.time)
        captor = last.captor if worst.verdict is OutcomeResult.CAPTURED else 0
        smallest = min((end.smallest_distance for end in ends if end.smallest_distance >= 0.0), default=-1.0)
        lost = [str(end.id) for end in ends if end.verdict is OutcomeResult.ABORTED]
        reason = f"nobody has seen vehicle {', '.join(lost)} for {UNSEEN_NS // NS_PER_S} s" if lost else ""
        return Outcome(worst.verdict, last.time, captor, smallest, wall_ns, reason, self.out)

    def aborted(self, wall_ns: int, time: float, reason: str) -> Outcome:
        """The outcome of a game that is ended at `time` [s since t0]; who was out keeps its verdict."""
        for trial in self.playing:
            trial.leave(OutcomeResult.ABORTED, time)
        outcome = self.whole(wall_ns)
        return replace(outcome, verdict=OutcomeResult.ABORTED, time=time, captor=0, reason=reason)

    def take_over(self, out: Sequence[EvaderOutcome]) -> None:
        """Take in whose game was over already, as another master told."""
        for end in out:
            if end.id in self.all:
                self.all[end.id].outcome = end

    def _judged(self, position: Vec) -> Vec:
        """Plane games and field profiles are judged horizontally."""
        if not self._flat:
            return position
        level = new(Vec, (position.x, position.y, 0.0))
        return level


def in_words(end: EvaderOutcome) -> str:
    """How one evader's game ended, for people."""
    by = f" by {end.captor}" if end.captor else ""
    return f"evader {end.id} {end.verdict.value}{by} after {end.time:.1f} s"


def _part(a: Vec, b: Vec, share: float) -> Vec:
    return along(a, sub(b, a), share)
