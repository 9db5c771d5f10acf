"""Unknown is no default: in whatever order setup, heartbeat, parameters, phase and position arrive."""

from __future__ import annotations

from itertools import permutations
from math import radians

import pytest

from onboard.agent.config import AgentConfig, EnvelopeConfig
from onboard.agent.core.events import (
    BusMessage,
    Instant,
    LinkBytes,
    LinkFacts,
    Load,
    Loaded,
    Send,
    Started,
    Tick,
)
from onboard.agent.core.machine import AgentCore, Facts
from onboard.autopilot.flight_limits import NAMES, FlightLimits, read_limits, unread
from onboard.wire.bus.messages import Master, Member, Origin, Phase, PhaseChange, Role, RulesMessage, Setup
from onboard.wire.bus.topics import MASTER, PHASE, SETUP
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, dialect
from onboard.wire.mavlink.frames import Framer
from onboard.wire.mavlink.modes import Kind

GAME = "demo"
T0 = 1_700_000_000_000_000_000
PLANE_PARAMETERS = {"AIRSPEED_MIN": 10.0, "AIRSPEED_MAX": 30.0, "ROLL_LIMIT_DEG": 50.0, "TECS_CLMB_MAX": 4.0}
COPTER_PARAMETERS = {"WPNAV_SPEED": 800.0, "WPNAV_SPEED_UP": 250.0, "WPNAV_SPEED_DN": 150.0}


def setup_of(speed: float) -> Setup:
    members = tuple(
        Member(id=id, role=role, speed=speed, start=(0.0, 100.0 * id, -100.0))
        for id, role in ((1, Role.EVADER), (2, Role.PURSUER))
    )
    return Setup(
        game=GAME, master="m", scenario="two", scenario_hash="0", origin=Origin(47.3977, 8.5456, 488.0),
        roster=members, rules=RulesMessage(R=20.0, rho=40.0), nonce=5,
    )  # fmt: skip


class OneAgent:
    """One agent without input and output, told one thing after the other."""

    def __init__(self, plane: bool, speed: float, config: AgentConfig | None = None) -> None:
        self.plane, self.speed = plane, speed
        self.core = AgentCore(
            config or AgentConfig(id=2, game=GAME, take_control=True), Facts(1, (LinkFacts("link", False),))
        )
        self.sender = DialectSender(2, 1)
        self.sent: list[str] = []
        self.now = 0.0
        self._do(Started())

    def _do(self, event: object) -> None:
        now = Instant(self.now, T0 + int(self.now * 1e9))
        effects = [*self.core.handle(event, now), *self.core.idle(now)]  # type: ignore[arg-type]
        for effect in effects:
            if isinstance(effect, Send):
                self.sent += [packet.name for packet in Framer().feed(effect.frame)]
            if isinstance(effect, Load):
                self._do(Loaded(effect.strategy, ""))

    def mavlink(self, message: MavMessage) -> None:
        self._do(LinkBytes(0, 0, self.sender.pack(message)))

    def master(self) -> None:
        """The lease of the master from whom setup and phase are."""
        word = Master("m", T0 + int(self.now * 1e9), lease_s=60.0, nonce=5, number=1)
        self._do(BusMessage(MASTER.key(GAME), MASTER.encode(word)))

    def setup(self) -> None:
        self.master()
        self._do(BusMessage(SETUP.key(GAME), SETUP.encode(setup_of(self.speed))))

    def phase(self) -> None:
        self.master()
        change = PhaseChange(Phase.STAGING, 0, T0 + int(self.now * 1e9), master="m", nonce=5, number=1)
        self._do(BusMessage(PHASE.key(GAME), PHASE.encode(change)))

    def heartbeat(self) -> None:
        guided = 15 if self.plane else 4
        self.mavlink(dialect.MAVLink_heartbeat_message(1 if self.plane else 2, 3, 0x81, guided, 4, 3))

    def parameters(self) -> None:
        values = PLANE_PARAMETERS if self.plane else COPTER_PARAMETERS
        for name, value in values.items():
            self.mavlink(dialect.MAVLink_param_value_message(name.encode(), value, 9, 1400, 7))

    def position(self) -> None:
        boot_ms = int(1000 * self.now) + 60_000
        self.mavlink(
            dialect.MAVLink_global_position_int_message(
                boot_ms, 473_977_000, 85_456_000, 588_000, 100_000, 0, 0, 0, 0
            )
        )

    def wait(self, seconds: float) -> None:
        until = self.now + seconds
        while self.now < until:
            self.now += 0.05
            self._do(Tick())


STEPS = ("setup", "heartbeat", "parameters", "phase", "position")


@pytest.mark.parametrize("plane", [True, False], ids=["plane", "copter"])
@pytest.mark.parametrize("order", list(permutations(STEPS)), ids="-".join)
def test_in_every_order_of_arrival_the_vehicle_is_supervised_as_what_it_is(
    order: tuple[str, ...], plane: bool
) -> None:
    agent = OneAgent(plane, 22.0 if plane else 5.0)
    heard: set[str] = set()
    for step in order:
        getattr(agent, step)()
        heard.add(step)
        agent.wait(0.2)
        known = {"heartbeat", "parameters"} <= heard
        # A parameter that came before the heartbeat was not asked for: the agent asks again.
        if not known:
            assert not any("TARGET" in name for name in agent.sent), agent.sent
            assert agent.core.game is not None
            assert agent.core.game.flying is None
    agent.heartbeat()
    agent.parameters()
    agent.position()
    agent.wait(0.2)
    assert agent.core.game is not None
    assert agent.core.game.flying is not None
    e = agent.core.part.policy.envelope
    if plane:
        assert (e.hovers, e.speed_min, e.climb_max) == (False, pytest.approx(10.0), pytest.approx(4.0))
    else:
        assert (e.hovers, e.speed_max, e.sink_max) == (True, pytest.approx(5.0), pytest.approx(1.5))


@pytest.mark.parametrize("speed", [7.0, 35.0])
def test_a_plane_is_not_flown_at_a_speed_that_its_autopilot_denies(speed: float) -> None:
    agent = OneAgent(True, speed)
    agent.setup()
    agent.heartbeat()
    agent.parameters()
    agent.position()
    agent.wait(0.5)
    assert agent.core.game is not None
    assert agent.core.game.flying is None
    assert f"wants {speed:g} m/s, the autopilot flies at" in agent.core.game.why_not
    assert not any("TARGET" in name for name in agent.sent)


def test_a_parameter_that_changes_in_flight_tightens_the_limits_at_once() -> None:
    agent = OneAgent(False, 5.0)
    for step in STEPS:
        getattr(agent, step)()
        agent.wait(0.1)
    agent.parameters()
    agent.position()
    agent.wait(0.2)
    assert agent.core.part.policy.envelope.speed_max == pytest.approx(5.0)
    agent.mavlink(dialect.MAVLink_param_value_message(b"WPNAV_SPEED", 300.0, 9, 1400, 7))
    agent.position()
    agent.wait(0.2)
    assert agent.core.part.policy.envelope.speed_max == pytest.approx(3.0)


def test_without_parameters_control_is_refused_with_the_reason_and_limits_can_be_configured() -> None:
    agent = OneAgent(True, 22.0)
    for step in ("setup", "heartbeat", "phase", "position"):
        getattr(agent, step)()
        agent.wait(0.5)
    assert agent.core.vehicle.unread == ("AIRSPEED_MIN", "AIRSPEED_MAX")
    assert any("AIRSPEED_MIN" in lack for lack in agent.core.part.lacks(Instant(agent.now, T0)))
    told = EnvelopeConfig(speed_min=12.0, speed_max=28.0)
    agent = OneAgent(True, 22.0, AgentConfig(id=2, game=GAME, take_control=True, envelope=told))
    for step in ("setup", "heartbeat", "position"):
        getattr(agent, step)()
        agent.wait(0.2)
    assert agent.core.vehicle.unread == ()
    assert agent.core.part.policy.envelope.speed_min == 12.0
    agent.parameters()  # the tighter of both
    agent.mavlink(dialect.MAVLink_param_value_message(b"AIRSPEED_MIN", 14.0, 9, 1400, 7))
    agent.position()
    agent.wait(0.2)
    assert agent.core.part.policy.envelope.speed_min == 14.0


@pytest.mark.parametrize(
    ("kind", "parameters", "limits"),
    [
        (Kind.ARDUCOPTER, {"WPNAV_SPEED": 1000.0, "WPNAV_SPEED_UP": 250.0, "WPNAV_SPEED_DN": 150.0},
         FlightLimits(None, 10.0, 2.5, 1.5)),
        (Kind.ARDUCOPTER, {"WP_SPD": 10.0, "WP_SPD_UP": 2.5, "WP_SPD_DN": 1.5},
         FlightLimits(None, 10.0, 2.5, 1.5)),
        (Kind.ARDUPLANE, {"ARSPD_FBW_MIN": 9.0, "ARSPD_FBW_MAX": 22.0, "LIM_ROLL_CD": 4500.0},
         FlightLimits(9.0, 22.0, None, None, radians(45.0))),
        (Kind.ARDUPLANE, {"AIRSPEED_MIN": 9.0, "AIRSPEED_MAX": 22.0, "ROLL_LIMIT_DEG": 45.0},
         FlightLimits(9.0, 22.0, None, None, radians(45.0))),
        (Kind.PX4_MULTICOPTER,
         {"MPC_XY_VEL_MAX": 12.0, "MPC_Z_VEL_MAX_UP": 3.0, "MPC_Z_VEL_MAX_DN": 1.5},
         FlightLimits(None, 12.0, 3.0, 1.5)),
        (Kind.ARDUCOPTER, {"ANGLE_MAX": 3000.0, "RTL_ALT": 1500.0, "GUID_TIMEOUT": 3.0},
         FlightLimits(bank_max=radians(30.0), coast=3.0, return_height=15.0)),
        (Kind.ARDUCOPTER, {"ATC_ANGLE_MAX": 30.0, "RTL_ALT_M": 15.0},
         FlightLimits(bank_max=radians(30.0), return_height=15.0)),
        (Kind.ARDUPLANE, {"ALT_HOLD_RTL": 10000.0, "WP_LOITER_RAD": -80.0},
         FlightLimits(return_height=100.0, loiter_radius=80.0)),
        (Kind.ARDUPLANE, {"RTL_ALTITUDE": 100.0}, FlightLimits(return_height=100.0)),
        (Kind.PX4_MULTICOPTER, {"MPC_TILTMAX_AIR": 45.0, "COM_OF_LOSS_T": 1.0, "RTL_RETURN_ALT": 30.0},
         FlightLimits(bank_max=radians(45.0), coast=1.0, return_height=30.0)),
        (Kind.PX4_PLANE, {"FW_AIRSPD_TRIM": 15.0, "FW_R_LIM": 50.0, "NAV_LOITER_RAD": 80.0},
         FlightLimits(bank_max=radians(50.0), cruise=15.0, loiter_radius=80.0)),
        (Kind.ARDUCOPTER, {"WPNAV_SPEED": 0.0}, FlightLimits()),
        (Kind.ARDUCOPTER, {"WPNAV_SPEED": float("nan")}, FlightLimits()),
    ],
)  # fmt: skip
def test_both_generations_of_names_give_one_limit_in_one_unit(
    kind: Kind, parameters: dict[str, float], limits: FlightLimits
) -> None:
    found = read_limits(kind, parameters)
    for value, expected in zip(found, limits, strict=True):
        assert value == (None if expected is None else pytest.approx(expected))


def test_what_is_not_read_is_named_by_its_newest_name() -> None:
    assert unread(Kind.ARDUCOPTER, FlightLimits(), {}) == ("WP_SPD", "WP_SPD_UP", "WP_SPD_DN")
    assert unread(Kind.ARDUPLANE, FlightLimits(speed_min=9.0), {"speed_max": 20.0}) == ()
    assert set(NAMES) == {Kind.PX4_MULTICOPTER, Kind.PX4_PLANE, Kind.ARDUCOPTER, Kind.ARDUPLANE}
