"""The fleet picture as a reducer of bus messages: pure, time passed in.

`now_ns` is the station's time: the wall instant of its start advanced by the monotonic clock, so that
one integer serves for ages (it never jumps), for the game's t₀ and for the recording. Feed messages
in order of arrival; the same stream gives the same picture.

Most callers want `gcs.picture.watch.Watch`, which adds alerts and commands to this.
"""

from __future__ import annotations

from collections import Counter, deque

from gcs.picture import journal
from gcs.picture.records import TrackRecord, VehicleRecord, age_s
from gcs.picture.values import GameView, LogLine, TrackView, VehicleView
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus import messages as swarm
from onboard.wire.bus import topics
from onboard.wire.bus.messages import Master, Message, Phase, Severity, State

LOG_LENGTH = 500
FARTHEST = 1e6  # [m] and [m/s]: no game is larger, nothing flies so fast
TRACK_KEPT_NS = 30 * NS_PER_S
MOST_VEHICLES = 250  # MAVLink's system ids: nothing on the bus can make the picture grow without end


class Fleet:
    """The picture's memory. `apply` messages, take values with `game`, `vehicles`, `tracks`."""

    def __init__(self, game: str) -> None:
        self.name = game
        self.received = 0
        self.bad_ns: int | None = None  # the last message that was foreign or bad
        self.drops: Counter[str] = Counter()
        self.log: deque[LogLine] = deque(maxlen=LOG_LENGTH)
        self._entries: dict[int, VehicleRecord] = {}
        self._tracks: dict[int, TrackRecord] = {}
        self._setup: swarm.Setup | None = None
        self._phase: swarm.PhaseChange | None = None
        self._outcome: swarm.Outcome | None = None
        self._brief: swarm.EvaderBrief | None = None
        self._master: Master | None = None
        self._master_ns: int | None = None
        self._masters: dict[tuple[str, int], int] = {}
        self._handlers = {
            topics.SETUP: self._on_setup,
            topics.PHASE: self._on_phase,
            topics.OUTCOME: self._on_outcome,
            topics.MASTER: self._on_master,
            topics.EVADER_BRIEF: self._on_brief,
        }

    # ---- messages in

    def apply(self, key: str, payload: bytes, now_ns: int) -> Message | None:
        """Take one message in; what it was, or None where it was foreign or bad (then counted)."""
        message = self._apply(key, payload, now_ns)
        self.received += 1
        if message is None:
            self.bad_ns = now_ns
        return message

    def _apply(self, key: str, payload: bytes, now_ns: int) -> Message | None:
        parts = key.split("/")
        if len(parts) < 4 or parts[0] != topics.ROOT or parts[1] != self.name:
            self.drops["foreign"] += 1
            return None
        if parts[2] == "gcs":
            return self._on_journal(parts[3], payload, now_ns)
        topic = topics.topic_of(key)
        if topic is None:
            self.drops["foreign"] += 1
            return None
        general = self._handlers.get(topic)
        if general is not None:
            return general(payload, now_ns)
        vehicle_id = topics.vehicle_of(key)
        if vehicle_id is None or not 1 <= vehicle_id <= MOST_VEHICLES:
            self.drops["foreign"] += 1
            return None
        if topic is topics.TRACK:
            return self._on_track(vehicle_id, payload, now_ns)
        if topic is topics.STATE:
            return self._on_state(vehicle_id, payload, now_ns)
        if topic is topics.DECISION:
            return self._on_decision(vehicle_id, payload, now_ns)
        if topic is topics.HEALTH:
            return self._on_health(vehicle_id, payload, now_ns)
        if topic is topics.EVENTS:
            return self._on_event(vehicle_id, payload, now_ns)
        self.drops["foreign"] += 1
        return None

    def _entry(self, vehicle_id: int, now_ns: int) -> VehicleRecord:
        entry = self._entries.get(vehicle_id)
        if entry is None:
            entry = self._entries[vehicle_id] = VehicleRecord(now_ns)
        return entry

    def _bad(self, entry: VehicleRecord, drops: Counter[str], now_ns: int) -> None:
        self.drops.update(drops)
        entry.drops.update(drops)
        if drops["schema"]:
            entry.schema_ns = now_ns

    def _life(self, entry: VehicleRecord, vehicle_id: int, nonce: int, now_ns: int) -> None:
        """Any good message counts as life; the nonce tells processes of one id apart."""
        if entry.heard_ns is None:
            entry.first_ns = now_ns
        entry.heard_ns = now_ns
        if nonce == 0 or nonce == entry.nonce:
            return
        if nonce in entry.old_nonces:  # a restart never comes back to an old nonce: two of them speak
            entry.double_ns = now_ns
        elif entry.nonce:
            self._say(now_ns, vehicle_id, Severity.WARNING, "restarted", "the agent was started again")
        if entry.nonce and entry.nonce not in entry.old_nonces:
            entry.old_nonces.append(entry.nonce)
        entry.nonce = nonce

    def _say(self, now_ns: int, vehicle_id: int, severity: Severity, kind: str, text: str) -> None:
        self.log.append(LogLine(at_ns=now_ns, id=vehicle_id, severity=severity, kind=kind, text=text))

    def _decoded(
        self, codec: swarm.Codec[swarm.M], vehicle_id: int, payload: bytes, now_ns: int
    ) -> tuple[VehicleRecord, swarm.M] | None:
        drops: Counter[str] = Counter()
        message = codec.decode(payload, drops)
        if message is not None and message.id != vehicle_id:  # type: ignore[attr-defined]
            drops["wrong_id"] += 1
            message = None
        elif isinstance(message, State) and not _sane(*message.position, *message.velocity, *message.wind):
            drops["implausible"] += 1
            message = None
        if message is None:
            self._bad(self._entry(vehicle_id, now_ns), drops, now_ns)
            return None
        return self._entry(vehicle_id, now_ns), message

    def _on_state(self, vehicle_id: int, payload: bytes, now_ns: int) -> Message | None:
        found = self._decoded(swarm.STATE, vehicle_id, payload, now_ns)
        if found is None:
            return None
        entry, state = found
        self._life(entry, vehicle_id, state.nonce, now_ns)
        entry.rate.tick(now_ns)
        old = entry.state
        if old is not None and state.stamp_ns < old.stamp_ns and state.nonce == old.nonce:
            entry.drops["late"] += 1
            return state
        if old is not None and (old.armed, old.mode) != (state.armed, state.mode):
            armed = "armed" if state.armed else "disarmed"
            self._say(now_ns, vehicle_id, Severity.INFO, "mode", f"{state.mode}, {armed}")
        entry.state, entry.state_ns, entry.role = state, now_ns, state.role
        entry.trail.add(state.position, now_ns)
        return state

    def _on_decision(self, vehicle_id: int, payload: bytes, now_ns: int) -> Message | None:
        found = self._decoded(swarm.DECISION, vehicle_id, payload, now_ns)
        if found is None:
            return None
        entry, decision = found
        self._life(entry, vehicle_id, 0, now_ns)
        if entry.decision is not None and decision.stamp_ns < entry.decision.stamp_ns - NS_PER_S:
            entry.drops["late"] += 1
            return decision
        entry.decision, entry.decision_ns = decision, now_ns
        return decision

    def _on_health(self, vehicle_id: int, payload: bytes, now_ns: int) -> Message | None:
        found = self._decoded(swarm.HEALTH, vehicle_id, payload, now_ns)
        if found is None:
            return None
        entry, health = found
        self._life(entry, vehicle_id, health.nonce, now_ns)
        entry.health, entry.health_ns = health, now_ns
        if entry.role is None:
            entry.role = health.role
        return health

    def _on_event(self, vehicle_id: int, payload: bytes, now_ns: int) -> Message | None:
        found = self._decoded(swarm.EVENT, vehicle_id, payload, now_ns)
        if found is None:
            return None
        entry, event = found
        self._life(entry, vehicle_id, 0, now_ns)
        if entry.take_event(event):
            self._say(now_ns, vehicle_id, event.severity, event.kind, event.text)
        return event

    def _on_track(self, track_id: int, payload: bytes, now_ns: int) -> Message | None:
        track = swarm.TRACK.decode(payload, self.drops)
        if track is None:
            return None
        if track.id != track_id:
            self.drops["wrong_id"] += 1
            return None
        if not _sane(*track.position, *track.velocity):
            self.drops["implausible"] += 1
            return None
        known = self._tracks.get(track_id)
        if known is None:
            known = self._tracks[track_id] = TrackRecord(track, now_ns)
        known.rate.tick(now_ns)
        restarted = now_ns - known.heard_ns > NS_PER_S  # a sensor may come back with another clock
        if track.stamp_ns >= known.track.stamp_ns or restarted:
            known.track = track
            known.trail.add(track.position, now_ns)
        known.heard_ns = now_ns
        return track

    def _on_setup(self, payload: bytes, now_ns: int) -> Message | None:
        setup = swarm.SETUP.decode(payload, self.drops)
        if setup is None:
            return None
        lengths = (setup.rules.R, setup.rules.rho, setup.rules.separation)
        sizes = (*lengths, *(member.speed for member in setup.roster))
        if not _sane(*sizes) or min(sizes) < 0.0:
            self.drops["implausible"] += 1
            return None
        if self._setup is None or setup.scenario_hash != self._setup.scenario_hash:
            who = f"{len(setup.roster)} vehicles, from {setup.master}"
            self._say(now_ns, 0, Severity.INFO, "setup", f"game {setup.scenario}: {who}")
        self._setup = setup
        for member in setup.roster:
            if 1 <= member.id <= MOST_VEHICLES:
                entry = self._entry(member.id, now_ns)
                if entry.state is None:
                    entry.role = member.role
        return setup

    def _on_phase(self, payload: bytes, now_ns: int) -> Message | None:
        phase = swarm.PHASE.decode(payload, self.drops)
        if phase is None:
            return None
        if self._phase is None or self._phase.phase is not phase.phase:
            reason = f": {phase.reason}" if phase.reason else ""
            self._say(now_ns, 0, Severity.INFO, "phase", f"game {phase.phase.value}{reason}")
        self._phase = phase
        return phase

    def _on_outcome(self, payload: bytes, now_ns: int) -> Message | None:
        outcome = swarm.OUTCOME.decode(payload, self.drops)
        if outcome is None:
            return None
        if self._outcome is None or outcome.stamp_ns != self._outcome.stamp_ns:
            by = f" by {outcome.captor}" if outcome.captor else ""
            reason = f": {outcome.reason}" if outcome.reason else ""
            text = f"evader {outcome.verdict}{by} after {outcome.time:.1f} s{reason}"
            self._say(now_ns, 0, Severity.INFO, "outcome", text)
        self._outcome = outcome
        return outcome

    def _on_brief(self, payload: bytes, now_ns: int) -> Message | None:
        brief = swarm.EVADER_BRIEF.decode(payload, self.drops)
        if brief is not None and brief.target is not None and not _sane(*brief.target):
            self.drops["implausible"] += 1
            return None
        self._brief = brief or self._brief
        return brief

    def _on_master(self, payload: bytes, now_ns: int) -> Message | None:
        master = swarm.MASTER.decode(payload, self.drops)
        if master is None:
            return None
        if self._master is None or (master.name, master.nonce) != (self._master.name, self._master.nonce):
            self._masters = {who: at for who, at in self._masters.items() if now_ns - at < 2 * NS_PER_S}
            if len(self._masters) < 8:
                self._masters[(master.name, master.nonce)] = now_ns
        else:
            self._masters[(master.name, master.nonce)] = now_ns
        self._master, self._master_ns = master, now_ns
        return master

    def _on_journal(self, name: str, payload: bytes, now_ns: int) -> Message | None:
        if name == "presence":
            presence = journal.PRESENCE.decode(payload, self.drops)
            if presence is not None:
                self._on_token(presence, now_ns)
            return presence
        if name == "remark":
            remark = journal.REMARK.decode(payload, self.drops)
            if remark is not None and not remark.advice:  # with advice it becomes an alert, logged as such
                self._say(now_ns, 0, remark.severity, remark.kind, remark.text)
            return remark
        if name == "sent":
            return journal.SENT.decode(payload, self.drops)
        if name == "replied":
            return journal.REPLIED.decode(payload, self.drops)
        if name == "acknowledged":
            return journal.ACKNOWLEDGED.decode(payload, self.drops)
        self.drops["foreign"] += 1
        return None

    def _on_token(self, presence: journal.Presence, now_ns: int) -> None:
        vehicle_id = topics.vehicle_of(presence.key)
        if vehicle_id is None or not 1 <= vehicle_id <= MOST_VEHICLES:
            self.drops["foreign"] += 1
            return
        entry = self._entry(vehicle_id, now_ns)
        entry.token = presence.alive
        if presence.alive:
            self._life(entry, vehicle_id, 0, now_ns)

    # ---- values out

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
        alive = sum(now_ns - at < 2 * NS_PER_S for at in self._masters.values())
        return GameView(
            name=self.name,
            setup=self._setup,
            phase=phase.phase if phase else None,
            reason=phase.reason if phase else "",
            t0_ns=t0_ns,
            time_s=(now_ns - t0_ns) / NS_PER_S if t0_ns else 0.0,
            outcome=outcome,
            target=self._brief.target if self._brief else None,
            master=self._master,
            master_age_s=age_s(self._master_ns, now_ns),
            two_masters=alive > 1,
        )

    def vehicles(self, now_ns: int) -> tuple[VehicleView, ...]:
        """Every vehicle heard or expected, by id."""
        return tuple(self._entries[i].view(i, now_ns) for i in sorted(self._entries))

    def tracks(self, now_ns: int) -> tuple[TrackView, ...]:
        """Every track of the last half minute, by id."""
        return tuple(
            known.view(i, now_ns)
            for i, known in sorted(self._tracks.items())
            if now_ns - known.heard_ns < TRACK_KEPT_NS
        )


def _sane(*values: float) -> bool:
    """Whether these can be places and speeds of a game: what cannot would only break sums further on."""
    return all(-FARTHEST < value < FARTHEST for value in values)
