"""What the agent knows from the bus: setup, phase, the master's lease, tracks, team mates.

It subscribes to what its role may know and to nothing else: never to an opponent's own state, and to
the evader's brief only as the evader. Nothing that arrives raises; what is wrong is counted by cause.
"""

from __future__ import annotations

from collections import Counter, OrderedDict
from typing import Any, NamedTuple

from onboard.agent.config import AgentConfig
from onboard.agent.core.clocks import MasterClock
from onboard.agent.core.events import Instant, Outbox, Subscribe, Unsubscribe
from onboard.agent.core.journal import Journal
from onboard.agent.core.masters import MASTERS_MAX, Hearing, Masters, Who, certified
from onboard.core.math.constants import NEVER
from onboard.core.math.each import new
from onboard.core.math.states import Mate, MateState, carried
from onboard.core.math.vectors import Vec
from onboard.wire.bus import topics
from onboard.wire.bus.messages import (
    EvaderBrief,
    Health,
    Master,
    Outcome,
    OwnBrief,
    Phase,
    PhaseChange,
    Role,
    Setup,
    State,
    Track,
    Triple,
)
from onboard.wire.bus.team_messages import TeamPlan

SAY_AGAIN_S = 30.0  # a trouble that goes on is said again after this
WATCHED_MAX = 8  # vehicles whose tracks are asked for one by one; of more, all tracks are


class Waiting(NamedTuple):
    """What was heard from one who is not the master: it counts once that one leads."""

    setup: Setup | None
    phase: PhaseChange | None


class Heard:
    """A team mate's last state, and when it came."""

    def __init__(self, state: State, at: float) -> None:
        self.state = state
        place, velocity = new(Vec, state.position), new(Vec, state.velocity)
        self.mate = MateState(state.id, at, place, velocity)  # `at`: monotonic [s]


class BusView:
    """The bus as one agent sees it."""

    def __init__(
        self, config: AgentConfig, nonce: int, out: Outbox, journal: Journal, member: str = ""
    ) -> None:
        """`member` is the name of the field's member whose certificate may write as the master; "" = any."""
        self._member = member
        self.drops: Counter[str] = Counter()  # messages that did not count, by cause
        self.connected = True  # whether there is somebody to talk to, as far as the shell knows
        self.setup: Setup | None = None
        self.setup_number = 0  # counts the setups heard
        self.phase: PhaseChange | None = None
        self.outcome: Outcome | None = None
        self.targets: tuple[Vec, ...] = ()  # the own ones, as briefed [m; NED]
        self.briefed = False
        self._own_brief = False  # whether it has a brief of its own: in a game of several evaders
        self.mates: dict[int, Heard] = {}
        self.plans: dict[int, tuple[TeamPlan, float]] = {}  # by planner, with when each came [s, monotonic]
        self._plans = False  # whether plans are listened to
        self._mates_at = NEVER  # when `_mates` were carried forward to; NEVER = one has been heard since
        self._mates: tuple[Mate, ...] = ()
        self.clock = MasterClock()
        self.master_at = NEVER  # when the master was last heard [s, monotonic]
        self._game, self._id, self._role, self._nonce = config.game, config.id, config.role, nonce
        self._out, self._journal = out, journal
        self.masters = Masters()
        self._waiting: OrderedDict[Who, Waiting] = OrderedDict()
        self._said: dict[str, float] = {}
        self._followed: list[int] = []
        self._tracks: tuple[str, ...] = (topics.TRACK.key(self._game),)  # keys that are listened to
        # Keys of tracks that say nothing new: the own one, and those of mates, who tell of themselves.
        self._unheeded = frozenset((topics.TRACK.key(self._game, self._id),))
        self._now = Instant(NEVER, 0)  # of the message that is being taken
        self._track: Track | None = None  # that it brought
        self._hear = (
            topics.Dispatcher(self.drops)
            .on(topics.SETUP, self._take_setup)
            .on(topics.PHASE, self._take_phase)
            .on(topics.OUTCOME, self._take_outcome)
            .on(topics.EVADER_BRIEF, self._take_brief)
            .on(topics.OWN_BRIEF, self._take_own_brief)
            .on(topics.MASTER, self._take_master)
            .on(topics.TRACK, self._take_track)
            .on(topics.STATE, self._take_mate)
            .on(topics.HEALTH, self._take_own_health)
            .on(topics.PLAN, self._take_plan)
        )

    @property
    def nonce(self) -> int:
        """Of this agent's process."""
        return self._nonce

    def keys(self) -> tuple[str, ...]:
        """Every key and pattern that this agent listens to now."""
        fixed: list[topics.Topic[Any]] = [topics.SETUP, topics.PHASE, topics.OUTCOME, topics.MASTER]
        keys = [*(topic.key(self._game) for topic in fixed), *self._tracks]
        if self._role is Role.EVADER:
            keys.append(topics.EVADER_BRIEF.key(self._game))
        keys.append(topics.HEALTH.key(self._game, self._id))
        if self._own_brief:
            keys.append(topics.OWN_BRIEF.key(self._game, self._id))
        for mate in sorted(self._followed):
            keys += self._keys_of(mate)
        return tuple(keys)

    def open(self) -> None:
        """Subscribe to what the role may know."""
        for key in self.keys():
            self._out.put(Subscribe(key))

    def take(self, key: str, payload: bytes, now: Instant) -> Track | None:
        """Take a message that arrived; a good measurement of another vehicle is given back."""
        if key in self._unheeded:
            return None
        self._now, self._track = now, None
        self._hear((key, payload))
        return self._track

    def follow(self, mates: tuple[int, ...], plans: bool = False) -> None:
        """Listen to these team mates' states, with `plans` to their plans, and to nobody else's."""
        changed = plans is not self._plans
        for id in [id for id in self._followed if changed or id not in mates]:
            self._followed.remove(id)
            for key in self._keys_of(id):
                self._out.put(Unsubscribe(key))
            self.mates.pop(id, None)
            self.plans.pop(id, None)
            self._mates_at = NEVER
        self._plans = plans
        for id in mates:
            if id not in self._followed and id != self._id:
                self._followed.append(id)
                for key in self._keys_of(id):
                    self._out.put(Subscribe(key))
        known = (self._id, *self._followed)
        self._unheeded = frozenset(topics.TRACK.key(self._game, id) for id in known)

    def watch(self, opponents: tuple[int, ...]) -> None:
        """Listen to the tracks of these vehicles alone; before that, and of many, to all there are."""
        before, each = self._tracks, len(opponents) <= WATCHED_MAX
        key, game = topics.TRACK.key, self._game
        self._tracks = tuple(key(game, id) for id in opponents) if each else (key(game),)
        for gone in before:
            if gone not in self._tracks:
                self._out.put(Unsubscribe(gone))
        for wanted in self._tracks:
            if wanted not in before:
                self._out.put(Subscribe(wanted))

    def brief_alone(self, alone: bool) -> None:
        """Take the brief that is for this one of several evaders `alone`, or the one for the only evader."""
        if alone is self._own_brief:
            return
        key = topics.OWN_BRIEF.key(self._game, self._id)
        self._own_brief, self.briefed, self.targets = alone, False, ()
        self._out.put(Subscribe(key) if alone else Unsubscribe(key))

    def _keys_of(self, mate: int) -> list[str]:
        keys = [topics.STATE.key(self._game, mate)]
        return [*keys, topics.PLAN.key(self._game, mate)] if self._plans else keys

    def mates_at(self, now: float) -> tuple[Mate, ...]:
        """The team mates where they are at `now` [s, monotonic], carried forward from when they were heard.

        The strategy and the supervisor are both given this one result."""
        if now != self._mates_at:
            self._mates_at = now
            self._mates = tuple([carried(heard.mate, now) for heard in self.mates.values()])
        return self._mates

    @property
    def unfit(self) -> frozenset[int]:
        """Team mates that say that they do not follow the game."""
        return frozenset(id for id, heard in self.mates.items() if not heard.state.fit)

    def _take_setup(self, setup: Setup) -> None:
        if setup == self.setup or self._foreign(setup.master):
            return
        who = (setup.master, setup.nonce)
        if who != self.masters.leader:
            text = f"setup from {setup.master}, but {self.masters.name} is the master: ignored"
            self._wait(who, text, setup=setup)
            return
        self.setup = setup
        self.setup_number += 1

    def _take_phase(self, phase: PhaseChange) -> None:
        if self._foreign(phase.master):
            return
        who = (phase.master, phase.nonce)
        if who != self.masters.leader:
            text = f"phase {phase.phase.value} from '{phase.master}', but {self.masters.name} is the master"
            self._wait(who, text, phase=phase)
            return
        before = self.phase
        if before is not None and who == (before.master, before.nonce) and phase.number <= before.number:
            self.drops["old_phase"] += phase.number < before.number
            return
        self.phase = phase
        self.masters.game_runs = phase.phase is Phase.RUNNING

    def _wait(
        self, who: Who, text: str, setup: Setup | None = None, phase: PhaseChange | None = None
    ) -> None:
        """Keep what another than the master says: it may come to lead."""
        if self.masters.leader is not None and self.masters.holds(self._now.s):
            self._trouble("two_masters", text)
        kept = self._waiting.pop(who, Waiting(None, None))
        newer = phase is not None and (kept.phase is None or phase.number > kept.phase.number)
        self._waiting[who] = Waiting(setup or kept.setup, phase if newer else kept.phase)
        if len(self._waiting) > MASTERS_MAX:
            self._waiting.popitem(last=False)

    def _take_outcome(self, outcome: Outcome) -> None:
        self.outcome = outcome

    def _take_brief(self, brief: EvaderBrief) -> None:
        if self._role is Role.EVADER and not self._own_brief:  # nobody else asks for it
            only = () if brief.target is None else (brief.target,)
            self._be_briefed(brief.targets or only)

    def _take_own_brief(self, brief: OwnBrief) -> None:
        if brief.id == self._id and self._own_brief:
            self._be_briefed(brief.targets)

    def _be_briefed(self, targets: tuple[Triple, ...]) -> None:
        self.targets = tuple(Vec(*target) for target in targets)
        self.briefed = True

    def _take_track(self, track: Track) -> None:
        self._track = track

    def _take_mate(self, state: State) -> None:
        if state.id in self._followed:
            self.mates[state.id] = Heard(state, self._now.s)
            self._mates_at = NEVER

    def _take_plan(self, plan: TeamPlan) -> None:
        if self._plans and plan.id in self._followed:
            self.plans[plan.id] = (plan, self._now.s)

    def _take_master(self, master: Master) -> None:
        if self._foreign(master.name):
            return
        now = self._now
        who = (master.name, master.nonce)
        before = self.masters.leader
        found = self.masters.hear(master, now.s)
        if found is not Hearing.LEADS:
            self.drops[found.name.lower()] += 1
            if found is not Hearing.OVERFLOW:
                self._trouble("two_masters", f"{master.name} {found.value} {self.masters.name}")
            return
        if who != before:
            self.clock.restart()
            self._journal.info("master", f"{master.name} is the master")
            kept = self._waiting.pop(who, Waiting(None, None))
            if kept.setup is not None:
                self._take_setup(kept.setup)
            if kept.phase is not None:
                self._take_phase(kept.phase)
        self.master_at = now.s
        if self.clock.hear(now.wall_ns, master.stamp_ns):
            offset = f"{self.clock.offset_s * 1e3:+.0f} ms against the master's clock"
            if self.clock.alert:
                self._journal.warning("clock_offset", f"{offset}: check the time service")
            else:
                self._journal.info("clock_offset", f"{offset}: in order again")

    def _foreign(self, name: str) -> bool:
        """Whether a master's word comes under a name that the master's certificate does not have."""
        if certified(name, self._member):
            return False
        self._trouble("foreign_master", f"{name} speaks as the master, whose certificate is {self._member}'s")
        return True

    def _take_own_health(self, health: Health) -> None:
        if health.nonce != self._nonce:
            text = f"another agent with id {self._id} is on the bus ({health.role.value})"
            self._trouble("double_id", text)

    def _trouble(self, kind: str, text: str) -> None:
        now = self._now
        if now.s - self._said.get(kind, NEVER) >= SAY_AGAIN_S:
            self._said[kind] = now.s
            self._journal.error(kind, text)
        self.drops[kind] += 1
