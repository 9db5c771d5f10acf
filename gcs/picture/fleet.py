"""The fleet as a reducer of messages: pure, time passed in.

`now_ns` is the station's time: the wall instant of its start advanced by the monotonic clock, so that
one integer serves for ages (it never jumps), for the game's t₀ and for the recording. Feed messages
in order of arrival; the same stream gives the same picture.

Most callers want `gcs.picture.reducer.PictureReducer`, which adds alerts and commands to this.
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Callable, Iterator
from typing import Any

from gcs.picture import knowledge
from gcs.picture.current import HEALTH_OLD_S, MOTION_OLD_S
from gcs.picture.plausible import plausible
from gcs.picture.records import TrackRecord, VehicleRecord, age_s
from gcs.picture.several import fates, goals, quarries, verdict_in_words
from gcs.picture.station_journal import HEARD_HERE, PRESENCE, REMARK, Presence, Remark
from gcs.picture.team import Plans, counting
from gcs.picture.values import GameView, LogLine, TrackView, VehicleView
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus import topics
from onboard.wire.bus.knowledge_messages import Knowledge
from onboard.wire.bus.messages import (
    DecisionReport,
    EvaderBrief,
    Event,
    Health,
    LinkLock,
    Master,
    Outcome,
    OwnBrief,
    Phase,
    PhaseChange,
    Quote,
    Setup,
    Severity,
    State,
    Track,
)
from onboard.wire.bus.team_messages import TeamPlan
from onboard.wire.bus.topics import Delivery, Heard, Party, Topic

LOG_LENGTH = 500
TRACK_KEPT_NS = 30 * NS_PER_S
MOST_VEHICLES = topics.IDS_MOST  # nothing on the bus can make the picture grow without end
JUDGED_AT_ONCE = 250  # vehicles, ten times a second
NO_PAYLOAD = (Delivery.REQUEST, Delivery.TOKEN)  # nobody publishes messages on such topics
OWN_WORD = (Party.OWN_AGENT,)  # writers of what a vehicle's agent says of its vehicle


class Fleet:
    """The picture's memory. `apply` messages, take values with `game`, `vehicles`, `tracks`."""

    def __init__(self, game: str) -> None:
        self.name = game
        self.received = 0  # messages, good and bad
        self.bad_ns: int | None = None  # the last message that was foreign or bad
        self.drops: Counter[str] = Counter()  # messages dropped, by cause
        self.log: deque[LogLine] = deque(maxlen=LOG_LENGTH)
        self._entries: dict[int, VehicleRecord] = {}
        self._tracks: dict[int, TrackRecord] = {}
        self._now_dropped: Counter[str] = Counter()  # of the message that is being taken in
        self._setup: Setup | None = None
        self._phase: PhaseChange | None = None
        self._outcome: Outcome | None = None
        self._plans: Plans = {}
        self._knowledge: knowledge.Heard = {}
        self._brief: EvaderBrief | None = None
        self._own_briefs: dict[int, OwnBrief] = {}  # by evader, where there are several
        self._master: Master | None = None
        self._master_ns: int | None = None
        self._masters: dict[tuple[str, int], int] = {}

    # ---- messages in

    def apply(self, key: str, payload: bytes, now_ns: int) -> Heard | None:
        """Take one message in; what was heard, or None where it was foreign or bad (then counted)."""
        self.received += 1
        heard = self._decoded(key, payload, now_ns)
        if heard is None:
            self.bad_ns = now_ns
            return None
        take = _TAKERS.get(heard.topic)
        if take is not None:
            take(self, heard.message, now_ns)
        elif heard.topic.writers == OWN_WORD and heard.id is not None:
            self._life(heard.id, 0, now_ns)
        return heard

    def _decoded(self, key: str, payload: bytes, now_ns: int) -> Heard | None:
        place = HEARD_HERE.find(key)
        if (
            place is None
            or place.game != self.name
            or place.topic.delivery in NO_PAYLOAD
            or (place.id is not None and place.id > MOST_VEHICLES)
        ):
            self.drops["foreign"] += 1
            return None
        drops = self._now_dropped
        heard = HEARD_HERE.told(place, payload, drops)
        if heard is not None and not plausible(heard.message):
            drops["implausible"] += 1
            heard = None
        if heard is None:
            self.drops.update(drops)
            if place.id is not None and place.topic.writers == OWN_WORD:
                entry = self._entry(place.id, now_ns)
                entry.drops.update(drops)
                if drops["schema"]:
                    entry.schema_ns = now_ns
            drops.clear()
        return heard

    def _entry(self, vehicle_id: int, now_ns: int) -> VehicleRecord:
        entry = self._entries.get(vehicle_id)
        if entry is None:
            entry = self._entries[vehicle_id] = VehicleRecord(now_ns)
        return entry

    def _life(self, vehicle_id: int, nonce: int, now_ns: int) -> VehicleRecord:
        """Any good message counts as life; the nonce (0 = not told) tells processes of one id apart."""
        entry = self._entry(vehicle_id, now_ns)
        if entry.heard_ns is None:
            entry.first_ns = now_ns
        entry.heard_ns = now_ns
        if nonce == 0 or nonce == entry.nonce:
            return entry
        if nonce in entry.old_nonces:  # a restart never comes back to an old nonce: two of them speak
            entry.double_ns = now_ns
        elif entry.nonce:
            self._say(now_ns, vehicle_id, Severity.WARNING, "restarted", "the agent was started again")
        if entry.nonce and entry.nonce not in entry.old_nonces:
            entry.old_nonces.append(entry.nonce)
        entry.nonce = nonce
        return entry

    def _say(self, now_ns: int, vehicle_id: int, severity: Severity, kind: str, text: str) -> None:
        self.log.append(LogLine(at_ns=now_ns, id=vehicle_id, severity=severity, kind=kind, text=text))

    def _on_state(self, state: State, now_ns: int) -> None:
        entry = self._life(state.id, state.nonce, now_ns)
        entry.rate.tick(now_ns)
        old = entry.state
        if old is not None and state.stamp_ns < old.stamp_ns and state.nonce == old.nonce:
            entry.drops["late"] += 1
            return
        if old is not None and (old.armed, old.mode) != (state.armed, state.mode):
            armed = "armed" if state.armed else "disarmed"
            self._say(now_ns, state.id, Severity.INFO, "mode", f"{state.mode}, {armed}")
        entry.state, entry.state_ns, entry.role = state, now_ns, state.role
        entry.trail.add(state.position, now_ns)

    def _on_decision(self, decision: DecisionReport, now_ns: int) -> None:
        entry = self._life(decision.id, 0, now_ns)
        if entry.decision is not None and decision.stamp_ns < entry.decision.stamp_ns - NS_PER_S:
            entry.drops["late"] += 1
            return
        entry.decision, entry.decision_ns = decision, now_ns

    def _on_plan(self, plan: TeamPlan, now_ns: int) -> None:
        self._plans[plan.id] = (plan, now_ns)

    def _on_knowledge(self, word: Knowledge, now_ns: int) -> None:
        knowledge.keep(self._knowledge, word, now_ns)

    def _on_health(self, health: Health, now_ns: int) -> None:
        entry = self._life(health.id, health.nonce, now_ns)
        entry.health, entry.health_ns = health, now_ns
        entry.growth.take(health, now_ns)
        if entry.role is None:
            entry.role = health.role

    def _on_event(self, event: Event, now_ns: int) -> None:
        entry = self._life(event.id, 0, now_ns)
        if entry.take_event(event):
            line = LogLine(
                at_ns=now_ns, id=event.id, severity=event.severity, kind=event.kind, text=event.text,
                event_ns=event.stamp_ns if 0 < event.stamp_ns < 1 << 62 else 0,
            )  # fmt: skip
            self.log.append(line)

    def _on_track(self, track: Track, now_ns: int) -> None:
        known = self._tracks.get(track.id)
        if known is None:
            known = self._tracks[track.id] = TrackRecord(track, now_ns)
        known.rate.tick(now_ns)
        restarted = now_ns - known.heard_ns > NS_PER_S  # a sensor may come back with another clock
        if track.stamp_ns >= known.track.stamp_ns or restarted:
            known.track = track
            known.trail.add(track.position, now_ns)
        known.heard_ns = now_ns

    def _on_setup(self, setup: Setup, now_ns: int) -> None:
        if self._setup is None or setup.scenario_hash != self._setup.scenario_hash:
            who = f"{len(setup.roster)} vehicles, from {setup.master}"
            self._say(now_ns, 0, Severity.INFO, "setup", f"game {setup.scenario}: {who}")
        self._setup = setup
        for member in setup.roster:
            if 1 <= member.id <= MOST_VEHICLES:
                entry = self._entry(member.id, now_ns)
                if entry.state is None:
                    entry.role = member.role

    def _on_phase(self, phase: PhaseChange, now_ns: int) -> None:
        if self._phase is None or self._phase.phase is not phase.phase:
            reason = f": {phase.reason}" if phase.reason else ""
            self._say(now_ns, 0, Severity.INFO, "phase", f"game {phase.phase.value}{reason}")
        known = {fate.id for fate in fates(None, self._phase, None)}
        for fate in fates(None, phase, None):
            if fate.out and fate.id not in known:
                self._say(now_ns, 0, Severity.INFO, "out", f"evader {fate.id} {fate.words}")
        self._phase = phase

    def _on_outcome(self, outcome: Outcome, now_ns: int) -> None:
        if self._outcome is None or outcome.stamp_ns != self._outcome.stamp_ns:
            reason = f": {outcome.reason}" if outcome.reason else ""
            text = f"{verdict_in_words(outcome)} after {outcome.time:.1f} s{reason}"
            self._say(now_ns, 0, Severity.INFO, "outcome", text)
        self._outcome = outcome

    def _on_brief(self, brief: EvaderBrief, now_ns: int) -> None:
        self._brief = brief

    def _on_own_brief(self, brief: OwnBrief, now_ns: int) -> None:
        self._own_briefs[brief.id] = brief

    def quote(self, id: int, now_ns: int) -> Quote:
        """What an order to a vehicle quotes, given now: its agent's state, and the newest word of the master,
        or of the agent where the master's lease has ended."""
        entry = self._entries.get(id)
        health = entry.health if entry is not None else None
        if health is None:
            return Quote()
        master = self._master
        age = age_s(self._master_ns, now_ns)
        if master is not None and age <= master.lease_s:
            return Quote(master.nonce, master.number, health.nonce, health.stopped_by)
        return Quote(health.nonce, health.number, health.nonce, health.stopped_by)

    def _on_master(self, master: Master, now_ns: int) -> None:
        if self._master is None or (master.name, master.nonce) != (self._master.name, self._master.nonce):
            self._masters = {who: at for who, at in self._masters.items() if now_ns - at < 2 * NS_PER_S}
            if len(self._masters) < 8:
                self._masters[(master.name, master.nonce)] = now_ns
        else:
            self._masters[(master.name, master.nonce)] = now_ns
        self._master, self._master_ns = master, now_ns

    def _on_presence(self, presence: Presence, now_ns: int) -> None:
        place = topics.TOPICS.find(presence.key)
        if place is None or place.id is None or place.id > MOST_VEHICLES:
            self.drops["foreign"] += 1
            return
        self._entry(place.id, now_ns).token = presence.alive
        if presence.alive:
            self._life(place.id, 0, now_ns)

    def _on_remark(self, remark: Remark, now_ns: int) -> None:
        if not remark.advice:  # with advice it becomes an alert, logged as such
            self._say(now_ns, 0, remark.severity, remark.kind, remark.text)

    # ---- values out

    @property
    def grid_steps(self) -> int:
        """Steps of the grid of time from one judgement to the next: one for each 250 vehicles begun."""
        return max(1, -(-len(self._entries) // JUDGED_AT_ONCE))

    def bad_age_s(self, now_ns: int) -> float:
        """Since the last message that was foreign or bad [s]."""
        return age_s(self.bad_ns, now_ns)

    def game(self, now_ns: int) -> GameView:
        """The game as its master tells it."""
        phase = self._phase
        over = phase is not None and phase.phase in (Phase.ENDED, Phase.RECOVERY)
        outcome = self._outcome if over else None
        if outcome is not None and phase is not None and outcome.stamp_ns < phase.t0_ns:
            outcome = None  # cached from a game before this one
        t0_ns = phase.t0_ns if phase else 0
        plan = None if over else counting(self._plans, now_ns)
        known = fates(self._setup, phase, outcome)
        alive = sum(now_ns - at < 2 * NS_PER_S for at in self._masters.values())
        return GameView(
            name=self.name,
            setup=self._setup,
            phase=phase.phase if phase else None,
            reason=phase.reason if phase else "",
            t0_ns=t0_ns,
            time_s=(now_ns - t0_ns) / NS_PER_S if t0_ns else 0.0,
            outcome=outcome,
            targets=goals(self._setup, self._brief, self._own_briefs),
            quarries=() if over else quarries(self._setup, plan, self._decided(now_ns), known),
            fates=known,
            master=self._master,
            master_age_s=age_s(self._master_ns, now_ns),
            two_masters=alive > 1,
            plan=plan,
            knowledge=knowledge.counting(self._knowledge, plan, now_ns, known),
        )

    def _decided(self, now_ns: int) -> Iterator[tuple[int, int]]:
        """Each vehicle's quarry, as its newest decision says, while it is fresh."""
        for id, entry in self._entries.items():
            if entry.decision is not None and age_s(entry.decision_ns, now_ns) <= MOTION_OLD_S:
                yield id, entry.decision.quarry

    def vehicles(self, now_ns: int) -> tuple[VehicleView, ...]:
        """Every vehicle heard or expected, by id."""
        return tuple(self._entries[i].view(i, now_ns) for i in sorted(self._entries))

    def link_locks(self, now_ns: int) -> list[LinkLock]:
        """What keeps strangers off the MAVLink links of each agent that is heard."""
        return [
            entry.health.link_lock for entry in self._entries.values()
            if entry.health is not None and age_s(entry.health_ns, now_ns) <= HEALTH_OLD_S
        ]  # fmt: skip

    def tracks(self, now_ns: int) -> tuple[TrackView, ...]:
        """Every track of the last half minute, by id."""
        return tuple(
            known.view(i, now_ns)
            for i, known in sorted(self._tracks.items())
            if now_ns - known.heard_ns < TRACK_KEPT_NS
        )


_TAKERS: dict[Topic[Any], Callable[[Fleet, Any, int], None]] = {
    topics.SETUP: Fleet._on_setup,
    topics.PHASE: Fleet._on_phase,
    topics.OUTCOME: Fleet._on_outcome,
    topics.MASTER: Fleet._on_master,
    topics.EVADER_BRIEF: Fleet._on_brief,
    topics.OWN_BRIEF: Fleet._on_own_brief,
    topics.STATE: Fleet._on_state,
    topics.DECISION: Fleet._on_decision,
    topics.PLAN: Fleet._on_plan,
    topics.KNOWLEDGE: Fleet._on_knowledge,
    topics.HEALTH: Fleet._on_health,
    topics.EVENTS: Fleet._on_event,
    topics.TRACK: Fleet._on_track,
    PRESENCE: Fleet._on_presence,
    REMARK: Fleet._on_remark,
}
