"""What the agent knows from the bus: setup, phase, the master's lease, tracks, team mates.

It subscribes to what its role may know and to nothing else: never to an opponent's own state, and to
the evader's brief only as the evader. Nothing that arrives raises; what is wrong is counted by cause.
"""

from __future__ import annotations

from collections import Counter, OrderedDict
from collections.abc import Callable
from typing import Any

from onboard.agent.clocks import MasterClock
from onboard.agent.journal import Journal
from onboard.core.math.constants import NEVER, NS_PER_S
from onboard.core.math.states import MateState
from onboard.core.math.vectors import Vec
from onboard.runtime.protocols import Bus, Clock, Sample, Subscription
from onboard.wire.bus import topics
from onboard.wire.bus.messages import (
    EvaderBrief,
    Health,
    Master,
    Outcome,
    PhaseChange,
    Role,
    Setup,
    State,
    Track,
)
from onboard.wire.bus.topics import Dispatcher

MASTERS_MAX = 8
SAY_AGAIN_S = 30.0  # a trouble that goes on is said again after this


class Heard:
    """A team mate's last state, and when it came."""

    def __init__(self, state: State, at: float) -> None:
        self.state = state
        self.at = at  # monotonic [s]


class Table:
    """The bus as one agent sees it."""

    def __init__(
        self, game: str, id: int, role: Role, nonce: int, clock: Clock, bus: Bus, journal: Journal
    ) -> None:
        self.drops: Counter[str] = Counter()
        self.setup: Setup | None = None
        self.setup_number = 0  # counts the setups heard
        self.phase: PhaseChange | None = None
        self.outcome: Outcome | None = None
        self.target: Vec | None = None
        self.briefed = False
        self.mates: dict[int, Heard] = {}
        self.clock = MasterClock()
        self.master_at = NEVER  # when the master was last heard [s, monotonic]
        self.on_track: Callable[[Track], None] = lambda track: None  # called as they arrive
        self._game, self._id, self._role, self._nonce = game, id, role, nonce
        self._clock, self._bus, self._journal = clock, bus, journal
        self._masters: OrderedDict[tuple[str, int], float] = OrderedDict()
        self._obeyed: tuple[str, int] | None = None
        self._said: dict[str, float] = {}
        self._fixed: list[Subscription] = []
        self._of_mates: dict[int, Subscription] = {}
        self._own_track = topics.TRACK.key(game, id)
        self._hear = (
            Dispatcher(self.drops)
            .on(topics.SETUP, self._take_setup)
            .on(topics.PHASE, self._take_phase)
            .on(topics.OUTCOME, self._take_outcome)
            .on(topics.EVADER_BRIEF, self._take_brief)
            .on(topics.MASTER, self._take_master)
            .on(topics.TRACK, self._take_track)
            .on(topics.STATE, self._take_mate)
            .on(topics.HEALTH, self._take_own_health)
        )

    def keys(self) -> tuple[str, ...]:
        """Every key and pattern that this agent listens to now."""
        mates = [topics.STATE.key(self._game, mate) for mate in sorted(self._of_mates)]
        return (*self._fixed_keys(), *mates)

    def _fixed_keys(self) -> list[str]:
        """Whatever the team mates are."""
        fixed: list[topics.Topic[Any]] = [topics.SETUP, topics.PHASE, topics.OUTCOME, topics.MASTER]
        if self._role is Role.EVADER:
            fixed.append(topics.EVADER_BRIEF)
        fixed.append(topics.TRACK)
        own = topics.HEALTH.key(self._game, self._id)
        return [*(topic.key(self._game) for topic in fixed), own]

    def open(self) -> None:
        """Subscribe."""
        self._fixed += [self._bus.subscribe(key, self._take) for key in self._fixed_keys()]

    def close(self) -> None:
        """Unsubscribe."""
        for subscription in (*self._fixed, *self._of_mates.values()):
            subscription.close()
        self._fixed.clear()
        self._of_mates.clear()

    def follow(self, mates: tuple[int, ...]) -> None:
        """Listen to these team mates' states, and to nobody else's."""
        for id in [id for id in self._of_mates if id not in mates]:
            self._of_mates.pop(id).close()
            self.mates.pop(id, None)
        for id in mates:
            if id not in self._of_mates and id != self._id:
                key = topics.STATE.key(self._game, id)
                self._of_mates[id] = self._bus.subscribe(key, self._take)

    def mate_states(self, base_ns: int) -> tuple[MateState, ...]:
        """What the team mates last said of themselves."""
        return tuple(
            MateState(
                heard.state.id,
                (heard.state.stamp_ns - base_ns) / NS_PER_S,
                Vec(*heard.state.position),
                Vec(*heard.state.velocity),
            )
            for heard in self.mates.values()
        )

    @property
    def now(self) -> float:
        """Monotonic time [s]."""
        return self._clock.monotonic_ns() / NS_PER_S

    def _take(self, sample: Sample) -> None:
        if sample.key != self._own_track:
            self._hear(sample)

    def _take_setup(self, setup: Setup) -> None:
        if setup == self.setup:
            return
        holder = self._obeyed
        if holder is not None and self._masters.get(holder, NEVER) >= self.now and setup.master != holder[0]:
            self._trouble("two_masters", f"setup from {setup.master}, but {holder[0]} is the master: ignored")
            return
        self.setup = setup
        self.setup_number += 1

    def _take_phase(self, phase: PhaseChange) -> None:
        if self.phase is not None and phase.stamp_ns < self.phase.stamp_ns:
            self.drops["old_phase"] += 1
            return
        self.phase = phase

    def _take_outcome(self, outcome: Outcome) -> None:
        self.outcome = outcome

    def _take_brief(self, brief: EvaderBrief) -> None:
        self.target = None if brief.target is None else Vec(*brief.target)
        self.briefed = True

    def _take_track(self, track: Track) -> None:
        if track.id not in self._of_mates:  # team mates tell of themselves
            self.on_track(track)

    def _take_mate(self, state: State) -> None:
        self.mates[state.id] = Heard(state, self.now)

    def _take_master(self, master: Master) -> None:
        now = self.now
        who = (master.name, master.nonce)
        lease = min(max(master.lease_s, 0.1), 60.0)
        for other in [other for other, until in self._masters.items() if until < now]:
            del self._masters[other]
        if who not in self._masters and len(self._masters) >= MASTERS_MAX:
            self.drops["masters_overflow"] += 1
            return
        first = next(iter(self._masters), who)
        self._masters[who] = now + lease
        if first != who:  # the one whose lease is older is obeyed; its clock counts
            self._trouble("two_masters", f"{first[0]} and {master.name} both say they are the master")
            return
        if who != self._obeyed:
            self._obeyed = who
            self.clock.restart()
            self._journal.info("master", f"{master.name} is the master")
        self.master_at = now
        if self.clock.hear(self._clock.wall_ns(), master.stamp_ns):
            offset = f"{self.clock.offset_s * 1e3:+.0f} ms against the master's clock"
            if self.clock.alert:
                self._journal.warning("clock_offset", f"{offset}: check the time service")
            else:
                self._journal.info("clock_offset", f"{offset}: in order again")

    def _take_own_health(self, health: Health) -> None:
        if health.nonce != self._nonce:
            self._trouble(
                "double_id", f"another agent with id {self._id} is on the bus ({health.role.value})"
            )

    def _trouble(self, kind: str, text: str) -> None:
        now = self.now
        if now - self._said.get(kind, NEVER) >= SAY_AGAIN_S:
            self._said[kind] = now
            self._journal.error(kind, text)
        self.drops[kind] += 1
