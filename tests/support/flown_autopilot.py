"""A simulated autopilot in its airframe, flown on virtual time by a scripted companion."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, radians, sin
from typing import Any

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO, Vec, distance
from onboard.game.scenario import WINGED, Kind, VehicleSpec
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.dialect import DialectSender, dialect, dialect_packet
from onboard.wire.mavlink.frames import Framer
from sim_bridge.vehicle.autopilot.autopilot import Autopilot
from sim_bridge.vehicle.autopilot.make import autopilot_for
from sim_bridge.vehicle.autopilot.setup import Options
from sim_bridge.vehicle.flight.kinematic import kinematic, start_motion
from sim_bridge.vehicle.motion import Air, Demand

EPOCH_NS = 1_700_000_000 * NS_PER_S
ORIGIN = Frame(47.397742, 8.545594, 488.0)
MULTICOPTER = VehicleSpec(position=(0.0, 0.0, 50.0), speed=5.0, speed_max=8.0)
PLANE = VehicleSpec(
    position=(0.0, 0.0, 100.0),
    speed=22.0,
    speed_min=10.0,
    speed_max=30.0,
    turn_rate_deg=40.0,
    pitch_min_deg=-20.0,
    pitch_max_deg=25.0,
)
COMPANION = 191
FLOWN = (Kind.PX4, Kind.ARDUCOPTER, Kind.ARDUPLANE)  # by agents, in the stories of every kind
ENDED = (*FLOWN, Kind.PX4_PLANE)  # in those of endings
PX4 = (Kind.PX4, Kind.PX4_PLANE)
LAST = 20  # texts and answers in the text of a failure


class FlownAutopilot:
    """One vehicle and the companion beside it."""

    def __init__(
        self,
        kind: Kind,
        *,
        system: int = 1,
        spec: VehicleSpec | None = None,
        airborne: bool = True,
        wind: Vec = ZERO,
        tick_s: float = 0.02,
        client: tuple[int, int] | None = None,
        **more: Any,
    ) -> None:
        self.kind = kind
        self.system = system
        self.air = Air(wind, ZERO)
        self.tick_ns = round(tick_s * NS_PER_S)
        self.now_ns = 0
        spec = spec or (PLANE if kind in WINGED else MULTICOPTER)
        position = spec.start() if airborne else spec.start()._replace(z=0.0)
        start = start_motion(position, radians(spec.heading_deg or 0.0), kind, spec.speed, self.air, airborne)
        self.airframe = kinematic(spec, kind, start, self.air)
        self.autopilot: Autopilot = autopilot_for(
            spec, kind, system, ORIGIN, start, Options(airborne=airborne, epoch_ns=EPOCH_NS, **more)
        )
        self.client = DialectSender(*(client or (system, COMPANION)))
        self.framer = Framer()
        self.heard: list[tuple[int, Any]] = []  # (now_ns, message) of everything it sent
        self.frames: list[bytes] = []
        self.demand: Demand | None = None
        self.forward(0.0)

    @property
    def position(self) -> Vec:
        return self.airframe.motion.position

    @property
    def velocity(self) -> Vec:
        return self.airframe.motion.velocity

    @property
    def height(self) -> float:
        return -self.position.z

    @property
    def mode(self) -> str:
        return self.autopilot.mode_name

    def forward(
        self,
        seconds: float,
        *,
        until: Callable[[], object] | None = None,
        every_s: float = 0.0,
        send: Callable[[], Any] | None = None,
    ) -> FlownAutopilot:
        """Let `seconds` pass, or time until a condition holds, for `seconds` at most.

        `send()` gives a message to be sent every `every_s` [s]. Raises AssertionError where the condition
        does not come to hold, with the last that was heard of the autopilot.
        """
        end = self.now_ns + round(seconds * NS_PER_S)
        next_ns = self.now_ns
        self._collect()
        while self.now_ns < end and not (until is not None and until()):
            if send is not None and self.now_ns >= next_ns:
                self.send(send())
                next_ns += round(every_s * NS_PER_S)
            self.now_ns += self.tick_ns
            self.demand = self.autopilot.step(self.now_ns, self.airframe.motion, self.air)
            self.airframe.step(self.demand, self.air, self.tick_ns / NS_PER_S)
            self._collect()
        if until is not None and not until():
            raise AssertionError(f"what was waited for did not happen within {seconds:g} s\n{self.story()}")
        return self

    def assert_near(self, there: Vec, within: float) -> None:
        """The vehicle is, in truth, at most `within` [m] from a place [m; NED]."""
        gap = distance(self.position, there)
        told = f"at {self.position}, {gap:.2f} m from {there}, expected {within:g}"
        assert gap <= within, f"{told}\n{self.story()}"

    def story(self) -> str:
        """The state of the autopilot, its texts and its last answers, for people."""
        acks = [f"command {m.command}: result {m.result}" for m in self.got("COMMAND_ACK")]
        now = f"{self.now_ns / NS_PER_S:.2f} s: {self.mode} at {self.position}, velocity {self.velocity}"
        return "\n".join([now, *self.texts()[-LAST:], *acks[-LAST:]])

    def send(self, message: Any, sender: DialectSender | None = None) -> None:
        """One message from the companion (or another)."""
        self.autopilot.receive(self.now_ns, (sender or self.client).pack(message), "peer")
        self._collect()

    def _collect(self) -> None:
        for frame in self.autopilot.outgoing():
            self.frames.append(frame)
            packets = self.framer.feed(frame)
            self.heard += [(self.now_ns, dialect_packet(packet.raw).message) for packet in packets]

    def got(self, name: str, since_ns: int = 0) -> list[Any]:
        """Messages of a kind that it has sent."""
        return [m for t, m in self.heard if t >= since_ns and m.get_type() == name]

    def last(self, name: str) -> Any:
        """The latest message of a kind."""
        return self.got(name)[-1]

    def texts(self) -> list[str]:
        return [m.text for m in self.got("STATUSTEXT")]

    def command(self, number: int, *p: float, confirmation: int = 0) -> int:
        """COMMAND_LONG; the result of its acknowledgement."""
        params = [*p, *([0.0] * (7 - len(p)))]
        return self._acknowledged(
            dialect.MAVLink_command_long_message(self.system, 1, number, confirmation, *params), number
        )

    def command_int(
        self,
        number: int,
        p1: float = 0.0,
        p2: float = 0.0,
        p3: float = 0.0,
        p4: float = 0.0,
        x: int = 0,
        y: int = 0,
        z: float = 0.0,
        frame: int = 0,
    ) -> int:
        """COMMAND_INT; the result of its acknowledgement."""
        return self._acknowledged(
            dialect.MAVLink_command_int_message(self.system, 1, frame, number, 0, 0, p1, p2, p3, p4, x, y, z),
            number,
        )

    def _acknowledged(self, message: Any, number: int) -> int:
        before = len(self.heard)
        self.send(message)
        acks = [m for _, m in self.heard[before:] if m.get_type() == "COMMAND_ACK"]
        twice = 2 if self.kind in PX4 and number == 176 else 1  # PX4: accepted first, then the result
        assert [m.command for m in acks] == [number] * twice
        return int(acks[-1].result)

    def mode_to(self, name: str) -> int:
        """DO_SET_MODE; the result."""
        number = self.autopilot.modes[name]
        if self.kind in PX4:
            return self.command(176, 1, number >> 16 & 255, number >> 24)
        return self.command(176, 1, number)

    def velocity_target(
        self, v: Vec, *, frame: int = 1, mask: int | None = None, system: int | None = None
    ) -> Any:
        """SET_POSITION_TARGET_LOCAL_NED."""
        if mask is None:
            mask = 0x9C7 if self.kind in PX4 else 0x0DC7
        target = self.system if system is None else system
        return dialect.MAVLink_set_position_target_local_ned_message(
            0, target, 1, frame, mask, 0, 0, 0, v.x, v.y, v.z, 0, 0, 0, 0, 0
        )

    def roll_target(self, roll_deg: float, mask: int = 198, thrust: float = 0.0) -> Any:
        """SET_ATTITUDE_TARGET with a roll alone."""
        half = 0.5 * radians(roll_deg)
        return dialect.MAVLink_set_attitude_target_message(
            0, self.system, 1, mask, [cos(half), sin(half), 0.0, 0.0], 0, 0, 0, thrust
        )
