"""What is remembered of one vehicle and of one track, and how the picture shows it."""

from __future__ import annotations

from collections import Counter, deque
from math import inf

from gcs.picture.values import Presence, TrackView, VehicleView
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import DecisionReport, Event, Health, Role, State, Track

LOST_NS = 1 * NS_PER_S  # silence from all sources after which a vehicle is lost
DOUBLE_NS = 3 * NS_PER_S  # a double id is reported until this long after its last sign
TRAIL_STEP_NS = NS_PER_S // 2
TRAIL_LENGTH = 120
PROCESSES = 8  # earlier processes of an agent that are remembered
GROWING_NS = 5 * NS_PER_S  # a counter counts as growing for so long
GROWING_MAX = 64  # counters of one agent that are watched
RECORDS_LOST = ("log_lost", "lines_lost", "events_unrecorded", "stamps_unsaved")
EVENTS_KEPT = 1000  # numbers of events remembered, of each process


class Rate:
    """Messages in the last whole second."""

    __slots__ = ("count", "last", "start_ns")

    def __init__(self, now_ns: int) -> None:
        self.start_ns = now_ns
        self.count = 0
        self.last = -1.0

    def tick(self, now_ns: int) -> None:
        """Count a message that came at `now_ns`."""
        passed = now_ns - self.start_ns
        if passed >= NS_PER_S:
            self.last = self.count * NS_PER_S / passed
            self.start_ns, self.count = now_ns, 0
        self.count += 1

    def value(self, now_ns: int) -> float:
        """[Hz]; 0 after two silent seconds, and until a whole second has been seen."""
        return max(0.0, self.last) if now_ns - self.start_ns < 2 * NS_PER_S else 0.0


class Trail:
    """Thinned positions, a bounded number of them."""

    __slots__ = ("last_ns", "points", "taken")

    def __init__(self) -> None:
        self.points: deque[tuple[float, float, float]] = deque(maxlen=TRAIL_LENGTH)
        self.last_ns = -TRAIL_STEP_NS
        self.taken: tuple[tuple[float, float, float], ...] | None = ()

    def add(self, position: tuple[float, float, float], now_ns: int) -> None:
        """Take a position [m; NED] in where the last one taken is half a second old."""
        if now_ns - self.last_ns >= TRAIL_STEP_NS:
            self.points.append(position)
            self.last_ns = now_ns
            self.taken = None

    def view(self) -> tuple[tuple[float, float, float], ...]:
        """The positions kept [m; NED], oldest first."""
        if self.taken is None:
            self.taken = tuple(self.points)
        return self.taken


class Growth:
    """Which of an agent's counters of trouble have grown lately."""

    def __init__(self) -> None:
        self._last: dict[str, int] = {}
        self._grew_ns: dict[str, int] = {}
        self._nonce = 0

    def take(self, health: Health, now_ns: int) -> None:
        """Compare a report's counters with those of the report before it; a new process begins at zero."""
        watched = {name: n for name, n in health.counters.items() if watch(name)}
        if health.nonce != self._nonce:
            self._nonce, self._last = health.nonce, {}
        for name, n in watched.items():
            room = len(self._grew_ns) < GROWING_MAX or name in self._grew_ns
            if n > self._last.get(name, 0) and room:
                self._grew_ns[name] = now_ns
        self._last = watched
        self._grew_ns = {name: at for name, at in self._grew_ns.items() if now_ns - at < GROWING_NS}

    def view(self, now_ns: int) -> tuple[tuple[str, int], ...]:
        """Name and number of those that grew in the last `GROWING_NS`."""
        if not self._grew_ns:
            return ()
        grew = sorted(name for name, at in self._grew_ns.items() if now_ns - at < GROWING_NS)
        return tuple((name, self._last.get(name, 0)) for name in grew)


def watch(name: str) -> bool:
    """Whether a counter of an agent tells of trouble while it grows."""
    return name.startswith("signature_") or "limited_" in name or name in RECORDS_LOST


class VehicleRecord:
    """What is known of one vehicle."""

    def __init__(self, now_ns: int) -> None:
        self.first_ns = 0
        self.heard_ns: int | None = None
        self.token = False
        self.role: Role | None = None
        self.state: State | None = None
        self.state_ns: int | None = None
        self.decision: DecisionReport | None = None
        self.decision_ns: int | None = None
        self.health: Health | None = None
        self.health_ns: int | None = None
        self.rate = Rate(now_ns)
        self.trail = Trail()
        self.drops: Counter[str] = Counter()
        self.schema_ns: int | None = None
        self.nonce = 0
        self.old_nonces: deque[int] = deque(maxlen=PROCESSES)
        self.double_ns: int | None = None
        self.events: dict[int, set[int]] = {}  # numbers seen, by nonce
        self.missed_events = 0
        self.growth = Growth()

    def view(self, vehicle_id: int, now_ns: int) -> VehicleView:
        """As the picture shows it."""
        if self.heard_ns is None:
            presence, silent_s = Presence.EXPECTED, inf
        else:
            presence = Presence.LOST if now_ns - self.heard_ns > LOST_NS else Presence.PRESENT
            silent_s = age_s(self.heard_ns, now_ns)
        return VehicleView(
            id=vehicle_id,
            role=self.role,
            presence=presence,
            age_s=silent_s,
            token=self.token,
            first_ns=self.first_ns,
            state=self.state,
            state_age_s=age_s(self.state_ns, now_ns),
            decision=self.decision,
            decision_age_s=age_s(self.decision_ns, now_ns),
            health=self.health,
            health_age_s=age_s(self.health_ns, now_ns),
            state_rate_hz=self.rate.value(now_ns),
            double_id=self.double_ns is not None and now_ns - self.double_ns < DOUBLE_NS,
            dropped=tuple(sorted(self.drops.items())) if self.drops else (),
            schema_age_s=age_s(self.schema_ns, now_ns),
            missed_events=self.missed_events,
            growing=self.growth.view(now_ns),
            trail=self.trail.view(),
        )

    def take_event(self, event: Event) -> bool:
        """Recovered events come twice or late: True for a new one. Gaps are counted until they fill."""
        seen = self.events.get(event.nonce)
        if seen is None:
            if len(self.events) >= PROCESSES:
                self.events.pop(next(iter(self.events)))
            seen = self.events[event.nonce] = set()
        if event.number in seen:
            self.drops["duplicate"] += 1
            return False
        if seen and event.number < max(seen):
            self.missed_events = max(0, self.missed_events - 1)
        elif seen:
            self.missed_events += event.number - max(seen) - 1
        seen.add(event.number)
        if len(seen) > EVENTS_KEPT:
            seen.discard(min(seen))
        return True


class TrackRecord:
    """What is known of one track."""

    def __init__(self, track: Track, now_ns: int) -> None:
        self.track = track
        self.heard_ns = now_ns
        self.rate = Rate(now_ns)
        self.trail = Trail()

    def view(self, track_id: int, now_ns: int) -> TrackView:
        """As the picture shows it."""
        return TrackView(
            id=track_id,
            track=self.track,
            age_s=age_s(self.heard_ns, now_ns),
            rate_hz=self.rate.value(now_ns),
            trail=self.trail.view(),
        )


def age_s(at_ns: int | None, now_ns: int) -> float:
    """Since an instant [s]; infinite where there was none."""
    return inf if at_ns is None else (now_ns - at_ns) / NS_PER_S
