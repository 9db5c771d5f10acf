"""`gcs replay --decide`: flown agents fed again with what happened to them, and what they do otherwise.

Each agent recorded its configuration and its events (`onboard.agent.event_file`). The same machine is fed
the same events at the same instants: unless it was changed, it wants exactly the same done again. Each
question to a strategy is asked again, of the strategy that flew or of another one by name, and its answers
are compared with the recorded ones; the machine itself is always given the recorded answer, so that what was
flown stays the course of events.
"""

from __future__ import annotations

from collections import Counter
from math import degrees
from pathlib import Path
from typing import NamedTuple

from msgspec.structs import replace

from onboard.agent.core.events import Answered, AnyEvent, Idle, Load, Send, Think
from onboard.agent.core.machine import AgentCore
from onboard.agent.event_file import SUFFIX, AnyRecorded, Full, Happened, Head, Lost, Story, read, recorded
from onboard.agent.thinker import Thinker
from onboard.config.strict import ConfigError
from onboard.core.math.vectors import NORTH, TINY, angle_between, norm, scale, unit
from onboard.core.strategy.knowledge import Decision
from onboard.core.strategy.registry import evader_named, pursuer_named
from onboard.pilot.setup import Side
from onboard.runtime.clock import RealClock
from onboard.runtime.progress import Tell, silent
from onboard.runtime.signing_keys import read_key
from onboard.wire.bus.messages import Role
from onboard.wire.mavlink.signing import MemoryStore, Signing

ANGLE_DEG = 5.0  # directions closer than this are the same
SPEED = 0.5  # [m/s] and speeds
PAUSE_S = 0.5  # differences farther apart are told apart
SHOWN = 200  # characters of an effect that are shown



class Difference(NamedTuple):
    """One vehicle deciding otherwise for a while."""

    id: int
    start: float  # [s] since its part began
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


class Fed(NamedTuple):
    """One agent's file, fed again."""

    id: int
    name: str  # of the file
    events: int  # fed
    otherwise: int  # of them: events after which the machine wants something else done
    first: str  # the first of these in words, '' = none
    compared: int  # decisions
    same: int
    differences: tuple[Difference, ...]
    remarks: tuple[str, ...]  # what could not be fed or compared, and why

    def lines(self) -> list[str]:
        """For a person."""
        done = "does the same again" if not self.otherwise else f"does otherwise after {self.otherwise}"
        lines = [f"vehicle {self.id} ({self.name}): {self.events} events fed, {done}"]
        lines += [f"  first: {self.first}"] if self.first else []
        return lines + [f"  {remark}" for remark in self.remarks]


class Comparison(NamedTuple):
    """All agents of a run, fed again."""

    fed: tuple[Fed, ...]

    @property
    def compared(self) -> int:
        """Decisions compared."""
        return sum(fed.compared for fed in self.fed)

    @property
    def same(self) -> int:
        """Decisions that are the same."""
        return sum(fed.same for fed in self.fed)

    @property
    def differences(self) -> tuple[Difference, ...]:
        """Of all vehicles, in the order of time."""
        found = [difference for fed in self.fed for difference in fed.differences]
        return tuple(sorted(found, key=lambda d: (d.start, d.id)))

    def lines(self) -> list[str]:
        """For a person."""
        share = 100.0 * self.same / self.compared if self.compared else 0.0
        head = f"{self.compared} decisions compared, {self.same} the same ({share:.1f} %)"
        told = [line for fed in self.fed for line in fed.lines()]
        return [head, *told, *(difference.text() for difference in self.differences)]


def files_of(run: Path) -> list[Path]:
    """The agents' files of a run folder (or beside a recording). Raises ConfigError where there are none."""
    folder = run if run.is_dir() else run.parent
    found = sorted(folder.glob(f"*{SUFFIX}"))
    if not found:
        raise ConfigError(
            f"{folder}: found no vehicle-N{SUFFIX}, expected what the agents record (their option --events)"
        )
    return found


def decide(
    run: Path, strategies: dict[Role, str] | None = None, tell: Tell = silent
) -> Comparison:
    """Feed every agent of a run again. `strategies` names others for a role; without, the recorded ones.

    Raises ConfigError for a strategy that does not exist, and for files that cannot be read."""
    others = {role: name for role, name in (strategies or {}).items() if name}
    thinker = Thinker(RealClock())
    for role, name in others.items():  # a name that does not exist is told before anything else
        error = thinker.load(Load(Side.EVADER if role is Role.EVADER else Side.PURSUER, name)).error
        if error:
            raise ConfigError(error)
    files = files_of(run)
    fed = []
    for number, path in enumerate(files):
        story = read(path)
        again = _Again(story, path.name, others.get(story.head.config.role, ""), thinker)
        for share, record in story.records:
            tell((number + share) / len(files), f"vehicle {story.head.config.id}")
            if not again.take(record):
                break
        fed.append(again.result())
    return Comparison(tuple(fed))


class _Again:
    """One agent, fed again."""

    def __init__(self, story: Story, name: str, strategy: str, thinker: Thinker) -> None:
        self._head = story.head
        self._name = name
        self._remarks: Counter[str] = Counter()
        self._core = AgentCore(story.head.config, story.head.facts, self._signing(story.head))
        self._strategy = strategy
        self._thinker = thinker
        self._asked: Think | None = None
        self._start: float | None = None
        self._events = self._otherwise = 0
        self._first = ""
        self._decisions = _Decisions(story.head.config.id)

    def take(self, record: Happened | Full | Lost) -> bool:
        """Feed one record; False where no more can be fed."""
        if isinstance(record, Full):
            size = record.limit / 1e6
            self._remarks[f"the file was full at {size:g} MB: what came later is not in it"] += 1
            return False
        if isinstance(record, Lost):
            self._remarks["the disk was too slow in flight: from here on records are missing"] += 1
            return False
        event, now = record.event, record.now
        self._start = now.s if self._start is None else self._start
        if isinstance(event, Answered):
            self._ask_again(event, self._core.part.time(now.wall_ns))
        wanted = self._core.idle(now) if isinstance(event, Idle) else self._core.handle(event, now)
        for effect in wanted:
            if isinstance(effect, Think):
                self._asked = effect
        self._events += 1
        found = self._comparable(recorded(wanted))
        expected = self._comparable(record.effects)
        if found != expected:
            self._otherwise += 1
            if not self._first:
                self._first = _told(now.s - self._start, event, expected, found)
        return True

    def result(self) -> Fed:
        """What came of it."""
        decisions = self._decisions
        remarks = tuple(f"{n} × {why}" if n > 1 else why for why, n in sorted(self._remarks.items()))
        return Fed(
            self._head.config.id, self._name, self._events, self._otherwise, self._first, decisions.compared,
            decisions.same, decisions.close(), remarks,
        )  # fmt: skip

    def _ask_again(self, answer: Answered, time: float) -> None:
        asked = self._asked
        if asked is None or asked.number != answer.number:
            self._remarks["an answer to a question that the machine no longer asks"] += 1
            return
        if answer.decision is None:
            self._remarks[f"the strategy failed in flight: {answer.error}"] += 1
            return
        name = self._strategy or asked.strategy
        if (asked.side, name) not in self._thinker.strategies:
            error = self._thinker.load(Load(asked.side, name)).error
            if error:
                self._remarks[f"not compared: {error}"] += 1
                return
        again = self._thinker.answer(Think(asked.number, asked.side, name, asked.view))
        if again.decision is None:
            named = evader_named(name) if asked.side is Side.EVADER else pursuer_named(name)
            self._remarks[f"the strategy {named} fails now: {again.error}"] += 1
            return
        self._decisions.judge(time, answer.decision, again.decision)

    def _comparable(self, effects: tuple[AnyRecorded, ...]) -> tuple[AnyRecorded, ...]:
        """Effects as they can be compared: without signatures, whose stamps belong to the flight."""
        return _unsigned(effects) if self._head.facts.signed else effects

    def _signing(self, head: Head) -> Signing | None:
        if not head.facts.signed or head.config.signing is None:
            return None
        return Signing(read_key(Path(head.config.signing.key)), MemoryStore())


def _unsigned(effects: tuple[AnyRecorded, ...]) -> tuple[AnyRecorded, ...]:
    return tuple(
        replace(effect, frame=effect.frame[:-13]) if isinstance(effect, Send) else effect
        for effect in effects
    )


def _told(
    at: float, event: AnyEvent, expected: tuple[AnyRecorded, ...], found: tuple[AnyRecorded, ...]
) -> str:
    """The first effect that differs, in words."""
    for was, now in zip(expected, found, strict=False):
        if was != now:
            return f"{at:.3f} s after its start, {_short(event)}: recorded {_short(was)}, now {_short(now)}"
    longer, word = (expected, "no longer") if len(expected) > len(found) else (found, "now also")
    extra = longer[min(len(expected), len(found))]
    return f"{at:.3f} s after its start, {_short(event)}: {word} {_short(extra)}"


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}…"


class _Decisions:
    """Compares one vehicle's decisions, and joins differences that go on."""

    def __init__(self, id: int) -> None:
        self.compared = self.same = 0
        self._id = id
        self._open: Difference | None = None
        self._found: list[Difference] = []

    def judge(self, time: float, was: Decision, now: Decision) -> None:
        """Compare the recorded decision at `time` [s] with the one made now."""
        before, after = scale(was.direction, was.speed), scale(now.direction, now.speed)
        angle = 0.0
        if norm(before) > TINY and norm(after) > TINY:
            angle = degrees(angle_between(unit(before, NORTH), unit(after, NORTH)))
        speed = abs(norm(before) - norm(after))
        self.compared += 1
        if now.rule == was.rule and angle <= ANGLE_DEG and speed <= SPEED:
            self.same += 1
            return
        rules = (was.rule.name.lower(), now.rule.name.lower())
        last = self._open
        if last is not None and time - last.end <= PAUSE_S and (last.recorded, last.now) == rules:
            self._open = last._replace(
                end=time, decisions=last.decisions + 1, angle_deg=max(last.angle_deg, angle),
                speed=max(last.speed, speed),
            )  # fmt: skip
            return
        self.close()
        self._open = Difference(self._id, time, time, 1, *rules, angle, speed)

    def close(self) -> tuple[Difference, ...]:
        """All differences; the one that may still go on ends."""
        if self._open is not None:
            self._found.append(self._open)
            self._open = None
        return tuple(self._found)
