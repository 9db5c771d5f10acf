"""One agent's machine beside an autopilot and a master that say what a test wants, on time that it moves."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, sin
from typing import Any

import msgspec

from onboard.agent.config import AgentConfig
from onboard.agent.core.events import (
    AnyEffect,
    AnyEvent,
    BusMessage,
    Count,
    Counted,
    Instant,
    LinkBytes,
    LinkFacts,
    Load,
    Publish,
    Reply,
    Request,
    Send,
    Started,
    Think,
    Tick,
)
from onboard.agent.core.machine import AgentCore, Facts
from onboard.agent.thinker import Thinker
from onboard.core.math.vectors import Vec, add
from onboard.runtime.clock import RealClock
from onboard.wire.bus import topics
from onboard.wire.bus.messages import (
    Command,
    CommandReply,
    EvaderBrief,
    Fence,
    Health,
    Master,
    Member,
    Origin,
    Phase,
    PhaseChange,
    Role,
    RulesMessage,
    Setup,
    Track,
)
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.dialect import dialect
from onboard.wire.mavlink.modes import MODES, Kind

GAME, VEHICLE, EVADER = "g", 2, 1
EPOCH_NS = 1_700_000_000 * 10**9
STEP_S = 0.05
RADIUS = 80.0  # of a plane's circles [m]
LIMIT = 20.0  # what every parameter says; half of it where it is a least value
SQUARE = ((-300.0, -300.0), (300.0, -300.0), (300.0, 300.0), (-300.0, 300.0))
ORIGIN = Origin(47.0, 8.0, 400.0)
KINDS = {
    Kind.ARDUCOPTER: (2, 3), Kind.ARDUPLANE: (1, 3), Kind.PX4_MULTICOPTER: (2, 12), Kind.PX4_PLANE: (1, 12),
}  # fmt: skip
PLANES = (Kind.ARDUPLANE, Kind.PX4_PLANE)
PX4 = (Kind.PX4_MULTICOPTER, Kind.PX4_PLANE)
SETPOINTS = ("SET_POSITION_TARGET_LOCAL_NED", "SET_ATTITUDE_TARGET")


class FakeAutopilot:
    """An autopilot that obeys every mode it is asked for, and otherwise reports what it is told to."""

    def __init__(self, kind: Kind) -> None:
        self.kind = kind
        self.names = {number: name for name, number in MODES[kind].items()}
        self.mode = MODES[kind]["HOLD" if kind in PX4 else "LOITER"]
        self.battery, self.fix, self.ekf = 95, 3, 0x33F
        self.armed, self.status, self.landed = True, 4, dialect.MAV_LANDED_STATE_IN_AIR
        self.parameters: dict[str, float] = {}  # that say something else than `LIMIT`
        self.wind: Vec | None = None  # [m/s; NED] where the air moves to, as a plane reports it
        self.booted = 0.0  # when it was last started [s]
        self.place, self.speed = Vec(0.0, 0.0, -50.0), 15.0 if kind in PLANES else 0.0
        self.drift = 0.0  # [m/s; north] reported over that
        self._asked: list[str] = []  # parameters
        self.talks = True
        self.setpoints: list[float] = []  # when each arrived
        self.obeys = True
        self.asked_modes: list[str] = []  # that it was asked for, obeyed or not
        self.orders: list[tuple[float, int, float]] = []  # when, MAV_CMD and seventh parameter of each
        self._mav: Any = dialect.MAVLink(None, srcSystem=VEHICLE, srcComponent=1)
        self._ears: Any = dialect.MAVLink(None)
        self._frame = Frame(ORIGIN.latitude_deg, ORIGIN.longitude_deg, ORIGIN.altitude_m)

    def set_parameter(self, name: str, value: float) -> None:
        """Somebody changes a parameter: it is said by itself."""
        self.parameters[name] = value
        self._asked.append(name)

    @property
    def mode_name(self) -> str:
        """In its own words."""
        return self.names[self.mode]

    def hear(self, now: float, frame: bytes) -> str:
        """Take a frame; its name."""
        for m in self._ears.parse_buffer(frame) or ():
            name = str(m.get_type())
            if name in SETPOINTS:
                self.setpoints.append(now)
            elif name == "PARAM_REQUEST_READ":
                self._asked.append(m.param_id)
            if name == "COMMAND_LONG":
                self.orders.append((now, m.command, m.param7))
            if name == "COMMAND_LONG" and m.command == dialect.MAV_CMD_DO_SET_MODE:
                px4 = int(m.param2) << 16 | int(m.param3) << 24
                asked = px4 if self.kind in PX4 else int(m.param2)
                self.asked_modes.append(self.names[asked])
                self.mode = asked if self.obeys else self.mode
            return name
        return ""

    def says(self, now: float) -> list[bytes]:
        """What it sends in one step."""
        if not self.talks:
            return []
        d, boot = dialect, round((now - self.booted) * 1e3)
        kind, autopilot = KINDS[self.kind]
        turn = now * self.speed / RADIUS  # a plane circles about its place
        v = Vec(self.speed * cos(turn) + self.drift, self.speed * sin(turn), 0.0)
        off = Vec(RADIUS * sin(turn), -RADIUS * cos(turn), 0.0) if self.speed else Vec(0.0, 0.0, 0.0)
        latitude, longitude, altitude = self._frame.geodetic_from_ned(add(self.place, off))
        said = [
            d.MAVLink_heartbeat_message(kind, autopilot, 128 * self.armed | 1, self.mode, self.status, 3),
            d.MAVLink_gps_raw_int_message(
                boot * 1000, self.fix, round(latitude * 1e7), round(longitude * 1e7), round(altitude * 1e3),
                80, 80, 0, 0, 12,
            ),
            d.MAVLink_sys_status_message(0, 0, 0, 100, 12000, 100, self.battery, 0, 0, 0, 0, 0, 0),
            d.MAVLink_attitude_message(boot, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
            d.MAVLink_extended_sys_state_message(0, self.landed),
        ]  # fmt: skip
        if self.kind in PX4:
            said.append(
                d.MAVLink_estimator_status_message(boot * 1000, self.ekf, *([0.1] * 6), 0.5, 0.5)
            )
        else:
            said.append(d.MAVLink_ekf_status_report_message(self.ekf, *([0.1] * 5)))
        said.append(
            d.MAVLink_global_position_int_message(
                boot, round(latitude * 1e7), round(longitude * 1e7), round(altitude * 1e3),
                round(-self.place.z * 1e3), round(v.x * 100), round(v.y * 100), round(v.z * 100), 0,
            )
        )  # fmt: skip
        if self.wind is not None:
            from_deg = degrees(atan2(-self.wind.y, -self.wind.x))
            said.append(d.MAVLink_wind_message(from_deg, hypot(self.wind.x, self.wind.y), self.wind.z))
        for name in self._asked:
            value = self.parameters.get(name, LIMIT / 2 if "MIN" in name else LIMIT)
            said.append(d.MAVLink_param_value_message(name.encode(), value, d.MAV_PARAM_TYPE_REAL32, 1, 0))
        self._asked.clear()
        return [bytes(m.pack(self._mav)) for m in said]


class LoneAgent:
    """The machine of pursuer 2, stepped at 20 Hz."""

    def __init__(
        self, kind: Kind = Kind.ARDUCOPTER, nonce: int = 77, member: str = "", **config: Any
    ) -> None:
        self.s, self.wall_ns = 100.0, EPOCH_NS
        self.autopilot = FakeAutopilot(kind)
        self.master = FakeMaster()
        self.core = AgentCore(
            AgentConfig(id=VEHICLE, game=GAME, **{"take_control": True, **config}),
            Facts(nonce, (LinkFacts("wire", False),), master=member),
        )
        self.thinker = Thinker(RealClock())
        self.health: Health | None = None
        self.replies: dict[int, CommandReply] = {}
        self._tokens = 0
        self.do(Started())

    @property
    def now(self) -> Instant:
        """This moment on both clocks."""
        return Instant(self.s, self.wall_ns)

    def do(self, event: AnyEvent) -> list[AnyEffect]:
        """One event, its effects, and what is said afterwards; all effects."""
        effects = self.core.handle(event, self.now)
        done = list(effects)
        for effect in effects:
            if isinstance(effect, Send):
                self.autopilot.hear(self.s, effect.frame)
            elif isinstance(effect, Reply):
                reply = topics.COMMAND.decode_reply(effect.payload, self.core.bus.drops)
                assert reply is not None
                self.replies[effect.token] = reply
            elif isinstance(effect, Count):
                done += self.do(Counted({}, {}, {}))
            elif isinstance(effect, Load):
                done += self.do(self.thinker.load(effect))
            elif isinstance(effect, Think):
                done += self.do(self._answer(effect))
        for effect in self.core.idle(self.now) if self.core.pending else ():
            if isinstance(effect, Publish) and effect.key == topics.HEALTH.key(GAME, VEHICLE):
                self.health = topics.HEALTH.decode(effect.payload, self.core.bus.drops)
            done.append(effect)
        return done

    def _answer(self, question: Think) -> AnyEvent:
        return msgspec.structs.replace(self.thinker.answer(question), took_s=0.001)

    def hear(self, message: Any, topic: topics.Topic[Any]) -> list[AnyEffect]:
        """A message of the bus arrives."""
        key = topic.key(GAME, message.id) if topic is topics.TRACK else topic.key(GAME)
        return self.do(BusMessage(key, topic.encode(message)))

    def order(self, command: Command) -> CommandReply:
        """A command arrives; the answer."""
        self._tokens += 1
        self.do(Request(self._tokens, topics.COMMAND.encode(command)))
        return self.replies[self._tokens]

    def step(self) -> list[AnyEffect]:
        """50 ms pass: master, tracks, autopilot, and what is due."""
        self.s += STEP_S
        self.wall_ns += round(STEP_S * 1e9)
        done: list[AnyEffect] = []
        for topic, message in self.master.says(self.s, self.wall_ns):
            done += self.hear(message, topic)
        for frame in self.autopilot.says(self.s):
            done += self.do(LinkBytes(0, 1, frame))
        for _ in range(8):
            if self.core.next_deadline() > self.s:
                break
            done += self.do(Tick())
        return done

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds / STEP_S)):
            self.step()

    def rate(self, seconds: float) -> float:
        """Setpoints that the autopilot heard lately [Hz]."""
        return sum(1 for at in self.autopilot.setpoints if at > self.s - seconds) / seconds


class FakeMaster:
    """A master that says what it is told to: lease twice a second, tracks at 10 Hz."""

    def __init__(self, name: str = "laptop-A", nonce: int = 5, offset_s: float = 0.0) -> None:
        self.name, self.nonce, self.offset_ns = name, nonce, round(offset_s * 1e9)
        self.on = True
        self.number = self.phases = 0
        self.tracks = True
        self._due: list[tuple[topics.Topic[Any], Any]] = []
        self._at = self._track_at = 0.0
        self._phase: tuple[Phase, float, tuple[int, ...]] | None = None
        self.takes_over = ""

    def setup(self, name: str = "square", **changes: Any) -> None:
        """Publish a setup."""
        roster = (
            Member(EVADER, Role.EVADER, 10.0, (200.0, 0.0, -50.0)),
            Member(VEHICLE, Role.PURSUER, 15.0, (0.0, 0.0, -50.0)),
        )
        base = Setup(
            game=GAME, scenario=name, scenario_hash=name, master=self.name, origin=ORIGIN, roster=roster,
            rules=RulesMessage(2.0, 4.0), fence=Fence(SQUARE, 10.0, 120.0), nonce=self.nonce,
        )  # fmt: skip
        self._due.append((topics.SETUP, msgspec.structs.replace(base, **changes)))
        self._due.append((topics.EVADER_BRIEF, EvaderBrief(None, EPOCH_NS)))

    def phase(self, phase: Phase, in_s: float = 0.0, resume: tuple[int, ...] = ()) -> None:
        """Enter a phase whose t₀ is `in_s` from now."""
        self._phase = (phase, in_s, resume)

    def says(self, now: float, wall_ns: int) -> list[tuple[topics.Topic[Any], Any]]:
        """What it publishes in one step."""
        if not self.on:
            return []
        wall_ns += self.offset_ns
        said: list[tuple[topics.Topic[Any], Any]] = []
        if now >= self._at:
            self._at = now + 0.5
            said.append((topics.MASTER, self.lease(wall_ns)))
        said += self._due
        self._due = []
        if self._phase is not None:
            (which, in_s, resume), self._phase = self._phase, None
            t0 = 0 if which is Phase.STAGING else wall_ns + round(in_s * 1e9)
            said.append((topics.PHASE, self.change(which, t0, wall_ns, resume)))
        if self.tracks and now >= self._track_at:
            self._track_at = now + 0.1
            said.append(
                (topics.TRACK, Track(EVADER, wall_ns, (200.0, 0.0, -50.0), (0.0, 5.0, 0.0), (1.0,) * 6))
            )
        return said

    def lease(self, wall_ns: int) -> Master:
        """Its next word."""
        self.number += 1
        return Master(self.name, wall_ns, 2.0, self.nonce, self.number, self.takes_over)

    def change(self, which: Phase, t0: int, wall_ns: int, resume: tuple[int, ...] = ()) -> PhaseChange:
        """Its next phase."""
        self.phases += 1
        return PhaseChange(which, t0, wall_ns, resume, "", self.name, self.nonce, self.phases)


def playing(kind: Kind = Kind.ARDUCOPTER, **config: Any) -> LoneAgent:
    """An agent that flies a game which has run for a second."""
    agent = LoneAgent(kind, **config)
    agent.run(1.0)
    agent.master.setup()
    agent.master.phase(Phase.STAGING)
    agent.run(2.0)
    agent.master.phase(Phase.READY, 2.0)
    agent.run(2.0)
    agent.master.phase(Phase.RUNNING)
    agent.run(2.0)
    assert agent.health is not None
    assert agent.rate(0.5) > 15.0, (agent.health, agent.core.lacks)
    return agent
