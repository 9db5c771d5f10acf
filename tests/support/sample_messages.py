"""What vehicles, sensors and masters say on the bus, for tests of the ground station."""

from __future__ import annotations

import msgspec

from gcs.picture import station_journal
from gcs.picture.reducer import PictureReducer
from gcs.picture.station_journal import HEARD_HERE
from gcs.picture.thresholds import Thresholds
from gcs.picture.values import Picture, VehicleView
from onboard.core.game.rules import Rules
from onboard.core.math.constants import NS_PER_S
from onboard.wire.autopilot_kind import Kind
from onboard.wire.bus import messages, topics
from onboard.wire.bus.codec import M
from onboard.wire.bus.messages import AgentStage, Message, Phase, Role
from onboard.wire.bus.topics import Topic

START_NS = 1_700_000_000 * NS_PER_S
GAME = "test"

TOPIC = {topic.message: topic for topic in HEARD_HERE}


def role_of(i: int) -> Role:
    """The evader has id 1."""
    return Role.EVADER if i == 1 else Role.PURSUER


def on_bus(message: Message, game: str = GAME) -> tuple[str, bytes]:
    """Key and payload of a message."""
    topic = TOPIC[type(message)]
    return topic.key(game, getattr(message, "id", None)), topic.encode(message)


def state(i: int, stamp_ns: int = START_NS, **changes: object) -> messages.State:
    """A vehicle that flies north at 10 m/s, 100 m east of its neighbour."""
    base = messages.State(
        id=i, role=role_of(i), stamp_ns=stamp_ns, position=(0.0, 100.0 * i, -50.0),
        velocity=(10.0, 0.0, 0.0), airspeed=10.0, wind=(0.0, 0.0, 0.0), roll=0.0, pitch=0.0, yaw=0.0,
        mode="GUIDED", armed=True, nonce=1000 + i,
    )  # fmt: skip
    return msgspec.structs.replace(base, **changes)


def health(i: int, stamp_ns: int = START_NS, **changes: object) -> messages.Health:
    """A vehicle in full health that acts."""
    base = messages.Health(
        id=i, role=role_of(i), stamp_ns=stamp_ns, stage=AgentStage.ACTING, lacks=(),
        autopilot=Kind.ARDUCOPTER, mode="GUIDED", armed=True, battery=0.9, link_quality=1.0,
        telemetry_rate_hz=20.0, setpoint_rate_hz=20.0, clock_offset_s=0.0, gps_fix=3, ekf_ok=True,
        supervisor=messages.SupervisorAction.OK, version="0.1.0", counters={}, nonce=1000 + i,
    )  # fmt: skip
    return msgspec.structs.replace(base, **changes)


def decision(i: int, stamp_ns: int = START_NS, **changes: object) -> messages.DecisionReport:
    """A pursuer that cuts the evader off."""
    base = messages.DecisionReport(
        id=i, stamp_ns=stamp_ns, t=1.0, level=messages.DecisionLevel.TACTICAL,
        module=messages.DecisionModule.GEOMETRIC, strategy="apollonius",
        rule="intercept", velocity=(10.0, 0.0, 0.0), aim=(200.0, 100.0, -50.0), time_to_aim=12.5, miss=1.5,
    )  # fmt: skip
    return msgspec.structs.replace(base, **changes)


def event(i: int, number: int, **changes: object) -> messages.Event:
    """Something that happened to a vehicle."""
    base = messages.Event(
        i, number, START_NS, messages.Severity.INFO, "note", f"event {number}", nonce=1000 + i
    )
    return msgspec.structs.replace(base, **changes)


def track(i: int, stamp_ns: int = START_NS, **changes: object) -> messages.Track:
    """A sensor's sight of a vehicle."""
    base = messages.Track(i, stamp_ns, (0.0, 100.0 * i, -50.0), (10.0, 0.0, 0.0), (1.0,) * 6, "radar")
    return msgspec.structs.replace(base, **changes)


def setup(count: int = 3, pursuer_speed: float = 10.0, **changes: object) -> messages.Setup:
    """A game of one evader and `count` − 1 pursuers; `changes` of the setup or of its rules."""
    roster = tuple(
        messages.Member(i, role_of(i), 10.0 if i == 1 else pursuer_speed, (0.0, 100.0 * i, -50.0))
        for i in range(1, count + 1)
    )
    base = messages.Setup(
        game=GAME, scenario="meeting", scenario_hash="abc", master="bridge",
        origin=messages.Origin(47.0, 8.0, 400.0), roster=roster, rules=messages.RulesMessage(2.0, 4.0),
    )  # fmt: skip
    rules = {name: changes.pop(name) for name in Rules._fields if name in changes}
    changed = msgspec.structs.replace(base.rules, **rules)
    return msgspec.structs.replace(base, rules=changed, **changes)


class Tower:
    """A ground station's picture and a hand on the clock."""

    def __init__(self, limits: Thresholds | None = None, version: str = "0.1.0") -> None:
        self.reducer = PictureReducer(GAME, limits, version)
        self.now_ns = START_NS
        self.stream: list[tuple[str, bytes, int]] = []  # all that was heard, as a recorder has it

    def hear(self, *messages: Message) -> None:
        """Messages arrive now."""
        for message in messages:
            self.hear_raw(*on_bus(message))

    def hear_raw(self, key: str, payload: bytes) -> None:
        """Bytes arrive now."""
        self.stream.append((key, payload, self.now_ns))
        self.reducer.apply(key, payload, self.now_ns)

    def note(self, topic: Topic[M], entry: M) -> None:
        """An entry of the station's own journal."""
        self.hear_raw(topic.key(GAME), topic.encode(entry))

    def token(self, i: int, alive: bool) -> None:
        """A liveliness token appears or goes."""
        entry = station_journal.Presence(topics.ALIVE.key(GAME, i), alive)
        self.note(station_journal.PRESENCE, entry)

    def wait(self, seconds: float) -> None:
        """Let time pass in silence."""
        self.now_ns += round(seconds * NS_PER_S)
        self.reducer.tick(self.now_ns)

    def fly(self, seconds: float, *ids: int, state_hz: int = 20, **changes: object) -> None:
        """These vehicles send state at 20 Hz and health at 2 Hz meanwhile; `changes` are to their health."""
        for step in range(round(seconds * state_hz)):
            for i in ids:
                self.hear(state(i, self.now_ns))
                if step % (state_hz // 2) == 0:
                    self.hear(health(i, self.now_ns, **changes))
            self.wait(1.0 / state_hz)

    @property
    def picture(self) -> Picture:
        """The picture now."""
        return self.reducer.picture(self.now_ns)

    def vehicle(self, i: int) -> VehicleView:
        """One vehicle of it."""
        found = self.picture.vehicle(i)
        assert found is not None
        return found

    def alerts(self) -> set[str]:
        """Names of the alerts in force."""
        return {alert.name for alert in self.picture.alerts}


def phase(which: Phase, t0_ns: int = 0, stamp_ns: int = START_NS) -> messages.PhaseChange:
    """The master's word on the game."""
    return messages.PhaseChange(which, t0_ns, stamp_ns)
