"""The game's master: lease, setup, phase, brief, resume of restarted agents, outcome. It does no I/O.

There is exactly one in a game: the bridge in simulation, the ground station in the field. It listens
first: who hears another master yields. Then it holds the lease, stages the vehicles, starts the game
when all are ready, judges it from positions it is given, and ends it. Time is an argument: `wall_ns`
stamps (nanoseconds since the epoch), `now_ns` is the monotonic clock that ages are taken from.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any, NamedTuple

from msgspec.structs import replace

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec
from onboard.game.heard_agent import HeardAgent
from onboard.game.phases import TRANSITIONS, PhaseEvent
from onboard.game.places import PlaceReport, PlaceWatch
from onboard.game.track_watch import TrackWatch
from onboard.game.trials import Trial, Trials, in_words
from onboard.wire.bus.codec import M
from onboard.wire.bus.messages import (
    AgentStage,
    EvaderBrief,
    EvaderOutcome,
    Health,
    Master,
    Message,
    Outcome,
    OutcomeResult,
    OwnBrief,
    Phase,
    PhaseChange,
    Setup,
    Track,
)
from onboard.wire.bus.topics import EVADER_BRIEF, MASTER, OUTCOME, OWN_BRIEF, PHASE, SETUP, Topic

LEASE_S = 2.0  # a master silent for longer is no master any more
LEASE_EVERY_NS = NS_PER_S // 2
LISTEN_NS = 12 * NS_PER_S // 10  # a master that holds the lease speaks twice in this time
HEALTH_NS = 3 * NS_PER_S  # an agent silent for longer is not there: six heartbeats lost in a row
SUPERSEDED_NS = 15 * NS_PER_S // 10  # an agent's earlier process counts as gone after this silence
READY_STAGES = (AgentStage.READY, AgentStage.ACTING)  # of agents that can begin


class Standing(Enum):
    """Whether this master is the game's master."""

    LISTENING = "listening"  # for another one, before the first word
    HOLDING = "holding"  # the lease
    YIELDED = "yielded"  # another one is the master: this one says nothing more


class Timing(NamedTuple):
    """The master's patience."""

    ready_s: float = 5.0  # from ready to t₀ at least; longer where a vehicle needs longer to its place
    timeout_s: float = 60.0  # to get everybody ready; 0 = for ever
    recovery_s: float = 3.0  # from the end to recovery
    auto_start: bool = True  # otherwise ready comes only after `start()`


class Publication(NamedTuple):
    """Something to be put on the bus."""

    topic: Topic[Any]
    message: Message
    id: int | None = None  # of the vehicle, where the topic's key holds one


Targets = Mapping[int, tuple[Vec, ...]]  # of evaders, by vehicle [m; NED]


class GameMaster:
    """Give it time and messages; take `outgoing()` to the bus and `news()` to the people.

    `targets` are the evaders' [m; NED], by vehicle; of two masters the smaller `nonce` stays. `takes_over`
    names the master, silent now, whose running game a person lets this one lead on.
    """

    def __init__(
        self, setup: Setup, targets: Targets, name: str, nonce: int, timing: Timing, takes_over: str = ""
    ) -> None:
        self._takes_over = takes_over
        self.setup = setup
        self.name = name
        self.nonce = nonce
        self.standing = Standing.LISTENING
        self.phase = Phase.STAGING
        self.t0_ns = 0  # beginning of the game [ns, wall]; 0 = not set
        self.outcome: Outcome | None = None
        self._timing = timing
        self._trials = Trials(setup, targets)
        self._agents = {member.id: HeardAgent() for member in setup.roster if not member.tracked}
        self._tracked = tuple(member.id for member in setup.roster if member.tracked)
        self._tracks = TrackWatch()
        self._resume: tuple[int, ...] = ()
        self._began_ns = -1
        self._lease_ns = 0
        self._staged_ns = 0
        self._places = PlaceWatch()
        self._ended_ns = 0
        self._started = timing.auto_start
        self._outgoing: list[Publication] = []
        self._news: list[str] = []
        self._told: set[object] = set()
        self._words = self._phases = 0  # said so far

    @property
    def nearest(self) -> dict[int, float]:
        """Smallest distance of each pursuer to any evader so far [m]."""
        return self._trials.nearest

    @property
    def out(self) -> tuple[EvaderOutcome, ...]:
        """Of several evaders those whose game is over."""
        return self._trials.out

    # ------------------------------------------------------------------ what it hears

    def heard_master(self, message: Master, now_ns: int) -> None:
        """Take a master's lease from the bus: another master's, or the own echo."""
        if message.nonce == self.nonce or self.standing is Standing.YIELDED:
            return
        if self.standing is Standing.LISTENING or message.nonce < self.nonce:
            self.standing = Standing.YIELDED
            self._say(f"another master is at work: {message.name}; this one yields and publishes no game")
        else:
            self._say_once(
                ("second master", message.nonce), f"a second master speaks: {message.name}; this one goes on"
            )

    def heard_health(self, health: Health, now_ns: int) -> None:
        """Take an agent's heartbeat, which arrived at `now_ns` [monotonic]."""
        agent = self._agents.get(health.id)
        if agent is None:
            self._say_once(("stranger", health.id), f"vehicle {health.id} is not in the roster: ignored")
            return
        for nonce, heard in list(agent.nonces.items()):
            if nonce != health.nonce and now_ns - heard > SUPERSEDED_NS:
                del agent.nonces[nonce]
        agent.nonces[health.nonce] = now_ns
        agent.hear(health, now_ns)
        if len(agent.nonces) > 1 and health.nonce == agent.acting_nonce:
            self._say_once(
                ("double", health.id, max(agent.nonces)), f"two agents speak as vehicle {health.id}: stop one"
            )

    def heard_track(self, track: Track) -> None:
        """Take a measurement: what counts of a vehicle that no agent flies."""
        if track.id in self._trials.all:
            self._tracks.heard(track)

    def heard_phase(self, phase: PhaseChange) -> None:
        """Take a phase that a master told of: of a game that this one takes over, whose evaders are out."""
        silent = self.standing is Standing.LISTENING and self.phase is Phase.STAGING
        if silent and self._takes_over and phase.master == self._takes_over:
            self._trials.take_over(phase.out)

    def start(self) -> None:
        """Let the game begin as soon as everybody is ready."""
        self._started = True

    def abort(self, wall_ns: int, now_ns: int, reason: str) -> None:
        """End the game without a result, in any phase before its end."""
        if (self.phase, PhaseEvent.ABORT) in TRANSITIONS and self.standing is not Standing.YIELDED:
            self._end(PhaseEvent.ABORT, self._aborted(wall_ns, reason), now_ns)

    # ------------------------------------------------------------------ time passes

    def tick(self, wall_ns: int, now_ns: int) -> None:
        """Do what is due; call it a few times a second or more."""
        if self._began_ns < 0:
            self._began_ns = now_ns
        if self.standing is Standing.LISTENING and now_ns - self._began_ns >= LISTEN_NS:
            self.standing = Standing.HOLDING
            self._staged_ns = now_ns
            self._lease_ns = now_ns
            self._put(SETUP, replace(self.setup, master=self.name, nonce=self.nonce))
            self._brief(wall_ns)
            self._publish_phase(wall_ns, "")
        if self.standing is not Standing.HOLDING:
            return
        if now_ns >= self._lease_ns:
            self._words += 1
            word = Master(self.name, wall_ns, LEASE_S, self.nonce, self._words, self._takes_over)
            self._put(MASTER, word)
            self._lease_ns = max(self._lease_ns + LEASE_EVERY_NS, now_ns)
        if self.phase is Phase.STAGING:
            self._stage(wall_ns, now_ns)
        elif self.phase is Phase.READY:
            self._count_down(wall_ns, now_ns)
            self._trials.seen(now_ns)
        elif self.phase is Phase.RUNNING and not self._lose_sight(wall_ns, now_ns):
            self._look_after(wall_ns, now_ns)
        elif self.phase is Phase.ENDED and now_ns - self._ended_ns >= self._timing.recovery_s * NS_PER_S:
            self._follow(PhaseEvent.RECOVERY_DUE, wall_ns)

    def lacking(self, wall_ns: int, now_ns: int) -> dict[int, str]:
        """Why the game cannot start: vehicle → what it lacks."""
        lost = {id: self._tracks.lack(id, wall_ns) for id in self._tracked if not self._trials.is_out(id)}
        lacking = {id: why for id, why in lost.items() if why}
        for id, agent in self._agents.items():
            if self._trials.is_out(id):
                continue
            if agent.health is None:
                seen = id in self._trials.all and not self._tracks.lack(id, wall_ns)
                hint = ", but a good track: evader.tracked = true plays without its agent" if seen else ""
                lacking[id] = f"no agent heard{hint}"
            elif now_ns - agent.heard_ns > HEALTH_NS:
                lacking[id] = "agent silent"
            elif len(agent.nonces) > 1:
                lacking[id] = "two agents with this id"
            elif agent.health.stage not in READY_STAGES:
                why = ", ".join(agent.health.lacks) or "no reason given"
                lacking[id] = f"{agent.health.stage.value}: {why}"
        return lacking

    def observe(self, wall_ns: int, now_ns: int, positions: Mapping[int, Vec]) -> None:
        """Judge the game on positions [m; NED] of `wall_ns`, over all the time since the last call.

        A pursuer without a position takes no part until it has one again.
        """
        if self.phase is not Phase.RUNNING or self.standing is not Standing.HOLDING:
            return
        self._see_out(self._trials.observe(wall_ns, now_ns, self.t0_ns, positions), wall_ns, now_ns)

    # ------------------------------------------------------------------ what it says

    def outgoing(self) -> list[Publication]:
        """What is to be published now, in this order; each handed over once."""
        out, self._outgoing = self._outgoing, []
        return out

    def news(self) -> list[str]:
        """Lines for people; each handed over once."""
        out, self._news = self._news, []
        return out

    # ------------------------------------------------------------------ inside

    def _stage(self, wall_ns: int, now_ns: int) -> None:
        lacking = self.lacking(wall_ns, now_ns)
        patience_ns = self._timing.timeout_s * NS_PER_S
        if not lacking and self._started:
            for agent in self._agents.values():
                agent.acting_nonce = agent.health.nonce if agent.health else 0
            needed = max((a.health.place_s for a in self._agents.values() if a.health), default=0.0)
            self.t0_ns = wall_ns + round(max(self._timing.ready_s, needed) * NS_PER_S)
            self._places.begin(now_ns)
            self._follow(PhaseEvent.ALL_READY, wall_ns)
        elif lacking and patience_ns > 0 and now_ns - self._staged_ns > patience_ns:
            missing = "; ".join(f"vehicle {id}: {reason}" for id, reason in sorted(lacking.items()))
            outcome = self._aborted(wall_ns, f"not ready in time: {missing}")
            self._end(PhaseEvent.PATIENCE_OVER, outcome, now_ns)

    def _count_down(self, wall_ns: int, now_ns: int) -> None:
        lacking = self.lacking(wall_ns, now_ns)
        if lacking:
            self.t0_ns = 0
            self._staged_ns = now_ns
            id, reason = min(lacking.items())
            self._follow(PhaseEvent.NOT_READY, wall_ns, f"vehicle {id}: {reason}")
        elif wall_ns >= self.t0_ns:
            self._follow(PhaseEvent.BEGINNING, wall_ns)
        else:
            told = [PlaceReport(n, a.heard_ns, a.health.place_s) for n, a in self._agents.items() if a.health]
            put_off = self._places.look(now_ns, self.t0_ns - wall_ns, told)
            if put_off.more_ns:
                self.t0_ns += put_off.more_ns
                self._publish_phase(wall_ns, put_off.text)
            elif put_off.text:
                self._say_once("place", put_off.text)

    def _look_after(self, wall_ns: int, now_ns: int) -> None:
        """Agents that fell silent, came back, or were started again while the game runs."""
        resume = {id for id in self._resume if not self._trials.is_out(id)}
        for id, agent in self._agents.items():
            health = agent.health
            silent = now_ns - agent.heard_ns > HEALTH_NS
            if silent != agent.silent:
                agent.silent = silent
                self._say(f"agent {id} {'is silent' if silent else 'is back'}")
            if silent or health is None or self._trials.is_out(id):
                continue
            if health.nonce == agent.acting_nonce:
                if id in resume and health.stage is AgentStage.ACTING:
                    resume.discard(id)
            elif len(agent.nonces) == 1 and health.stage is AgentStage.ACTING:
                agent.acting_nonce = health.nonce  # by a person's word
            elif len(agent.nonces) == 1 and health.autopilot is not None:
                if agent.never_left(health, now_ns):
                    agent.acting_nonce = health.nonce
                    resume.add(id)
                    self._say(f"agent {id} was started again and may act again")
                else:
                    text = f"agent {id} was started again in {health.mode}: a person's resume is needed"
                    self._say_once(("restarted", id, health.nonce), text)
        if resume != set(self._resume):
            self._resume = tuple(sorted(resume))
            self._publish_phase(wall_ns, "resume" if self._resume else "")

    def _lose_sight(self, wall_ns: int, now_ns: int) -> bool:
        """Let evaders leave that nobody has seen for long; whether that ended the game."""
        lost = self._trials.lose_sight(now_ns, self._elapsed(wall_ns))
        self._see_out(lost, wall_ns, now_ns)
        return self.phase is not Phase.RUNNING

    def _see_out(self, ended: list[Trial], wall_ns: int, now_ns: int) -> None:
        """Tell whose game has ended just now; with the last one's the whole game ends."""
        if not ended:
            return
        if self._trials.playing:
            words = [in_words(trial.outcome) for trial in ended if trial.outcome is not None]
            self._publish_phase(wall_ns, "; ".join(words))
            self._news += words
            return
        outcome = self._trials.whole(wall_ns)
        aborted = outcome.verdict is OutcomeResult.ABORTED
        self._end(PhaseEvent.ABORT if aborted else PhaseEvent.RESULT, outcome, now_ns)

    def _elapsed(self, wall_ns: int) -> float:
        return max(0.0, (wall_ns - self.t0_ns) / NS_PER_S) if self.phase is Phase.RUNNING else 0.0

    def _aborted(self, wall_ns: int, reason: str) -> Outcome:
        return self._trials.aborted(wall_ns, self._elapsed(wall_ns), reason)

    def _brief(self, wall_ns: int) -> None:
        """Tell the evader where it goes; of several each its own targets alone."""
        for id, trial in self._trials.all.items():
            targets = tuple((target.x, target.y, target.z) for target in trial.targets)
            if len(self._trials.all) > 1:
                self._put(OWN_BRIEF, OwnBrief(id, wall_ns, targets), id)
            else:
                several = targets if len(targets) > 1 else ()
                self._put(EVADER_BRIEF, EvaderBrief(targets[0] if targets else None, wall_ns, several))

    def _end(self, event: PhaseEvent, outcome: Outcome, now_ns: int) -> None:
        self.outcome = outcome
        self._ended_ns = now_ns
        self._resume = ()
        self._put(OUTCOME, outcome)
        self._follow(event, outcome.stamp_ns, outcome.reason or outcome.verdict.value)

    def _follow(self, event: PhaseEvent, wall_ns: int, reason: str = "") -> None:
        """Enter the phase that an event leads to, and tell of it."""
        self.phase = TRANSITIONS[self.phase, event]
        self._publish_phase(wall_ns, reason)
        self._say(f"{self.phase.value}{': ' + reason if reason else ''}")

    def _publish_phase(self, wall_ns: int, reason: str) -> None:
        self._phases += 1
        phase = PhaseChange(
            phase=self.phase, t0_ns=self.t0_ns, stamp_ns=wall_ns, resume=self._resume, reason=reason,
            master=self.name, nonce=self.nonce, number=self._phases, out=self.out,
        )  # fmt: skip
        self._put(PHASE, phase)

    def _put(self, topic: Topic[M], message: M, id: int | None = None) -> None:
        self._outgoing.append(Publication(topic, message, id))

    def _say(self, line: str) -> None:
        self._news.append(line)

    def _say_once(self, about: object, line: str) -> None:
        if about not in self._told and len(self._told) < 1000:
            self._told.add(about)
            self._say(line)

