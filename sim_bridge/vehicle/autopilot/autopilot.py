"""The part all personalities share: addressing, heartbeat, streams, commands, arming, faults.

Sans I/O. Time is an argument: `now_ns`, integer nanoseconds, any monotonic zero. The world calls
`receive` for each datagram, `step` each tick, and sends what `outgoing` gives to every peer.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter, OrderedDict
from collections.abc import Callable, Hashable, Mapping
from functools import partial
from typing import ClassVar

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO, Vec
from onboard.wire.geodesy import Frame, Geodetic
from onboard.wire.mavlink.dialect import DialectPacket, DialectSender, MavMessage, dialect, dialect_packet
from onboard.wire.mavlink.frames import Framer
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.command import ACCEPTED, UNSUPPORTED, Command, from_int, from_long
from sim_bridge.vehicle.autopilot.commands import INQUIRIES
from sim_bridge.vehicle.autopilot.health import Fault, Health
from sim_bridge.vehicle.autopilot.microservices import SERVICES
from sim_bridge.vehicle.autopilot.parameters import Parameters
from sim_bridge.vehicle.autopilot.setup import Setup
from sim_bridge.vehicle.autopilot.streams import Streams
from sim_bridge.vehicle.motion import CALM, Air, Demand, Motion

COMPONENT = 1  # MAV_COMP_ID_AUTOPILOT1
HEARTBEAT_NS = NS_PER_S
PEERS_MAX = 16  # framing states kept, least recently heard forgotten first
PARAMETERS_A_STEP = 5
FORCE = 21196  # param2 of 400: arm or disarm whatever the checks say


class Autopilot(ABC):
    """A simulated autopilot. Subclasses are the personalities."""

    autopilot_type: ClassVar[int]
    vehicle_type: ClassVar[int]
    modes: ClassVar[Mapping[str, int]]  # names ↔ custom_mode
    default_rates: ClassVar[Mapping[int, float]]  # message number → [Hz]
    banner: ClassVar[tuple[str, ...]]
    version: ClassVar[int]  # AUTOPILOT_VERSION.flight_sw_version
    refused_arming: ClassVar[int]  # result of a refused arm or disarm
    unknown_message: ClassVar[int]  # result of REQUEST_MESSAGE for what it cannot send
    unknown_interval: ClassVar[int]  # … and of SET_MESSAGE_INTERVAL

    def __init__(self, setup: Setup, now_ns: int) -> None:
        self.setup = setup
        self.system = setup.system
        self.motion = setup.start
        self.air = CALM
        self.home = setup.home
        self.local = Frame(*setup.origin)
        self.health = Health(setup.battery_s)
        self.parameters = self._new_parameters()
        self.counters: Counter[str] = Counter()
        self.armed = setup.airborne
        self.landed = not setup.airborne
        self._cold = not setup.airborne  # booted on the ground: the estimator needs time
        self._names = {number: name for name, number in self.modes.items()}
        self.mode = self.first_mode
        self._boot_ns = now_ns
        self._last_step_ns = now_ns
        self._handlers: dict[int, Callable[[int, DialectPacket], None]] = self._message_handlers()
        self._commands: dict[int, Callable[[int, Command], int]] = self._command_handlers()
        self._framers: OrderedDict[Hashable, Framer] = OrderedDict()
        self._out: list[bytes] = []
        self._place: tuple[Vec, Geodetic] | None = None
        self.home_known = not self._cold
        self._ground_station_ns = -1  # last heartbeat of the watched one; −1 = never
        self._start_wire(now_ns)
        self.enter(now_ns, self.mode)

    # ------------------------------------------------------------------ the world's side

    def receive(self, now_ns: int, data: bytes, peer: Hashable) -> None:
        """Take one datagram. Never raises: what is bad or meant for others is counted and dropped."""
        framer = self._framers.get(peer)
        if framer is None:
            while len(self._framers) >= PEERS_MAX:
                self._framers.popitem(last=False)
            framer = self._framers[peer] = Framer(signing=self.setup.signing, causes=self.counters)
        self._framers.move_to_end(peer)
        for packet in framer.feed(data, self.setup.epoch_ns + now_ns):
            self._take(now_ns, dialect_packet(packet.raw))

    def step(self, now_ns: int, motion: Motion, air: Air) -> Demand:
        """Sense, keep time, send what is due, and say what the airframe shall do until the next step."""
        dt = (now_ns - self._last_step_ns) * 1e-9
        self._last_step_ns = now_ns
        self.motion = Motion(motion.position, ZERO, 0.0, 0.0, 0.0, motion.yaw) if self.landed else motion
        self.air = air
        self._place = None
        self.health.drain(dt, self.armed and not self.landed)
        if not self.home_known and self.positioned(now_ns):
            self.home_known = True
            self.emit(telemetry.home_position(self, now_ns))
            self.emit(telemetry.global_origin(self, now_ns))
        self.watch(now_ns)
        demand = self.guide(now_ns, dt)
        self._send_due(now_ns)
        return demand

    def outgoing(self) -> list[bytes]:
        """The frames to be sent now, each to every peer; they are handed over once."""
        out = self._out
        self._out = []
        return out

    @property
    def parked(self) -> bool:
        """Whether it stands on the ground: the world then leaves the airframe where it is."""
        return self.landed

    # ------------------------------------------------------------------ faults

    def reboot(self, now_ns: int) -> None:
        """Restart: sequence, boot time, streams and guidance begin anew; parameters, home and battery stay.

        In flight a real one would come up flying (a watchdog reset keeps the vehicle armed)."""
        self._boot_ns = now_ns
        self._framers.clear()
        self._out.clear()
        self._cold = self.landed
        self.armed = self.armed and not self.landed
        self._ground_station_ns = -1
        self._start_wire(now_ns)
        self.mode = self.first_mode
        self.enter(now_ns, self.mode)
        for line in self.banner:
            self.say(dialect.MAV_SEVERITY_INFO, line)

    def pilot_mode(self, now_ns: int, name: str) -> None:
        """The safety pilot's switch: the mode is entered whatever the ground station wants.

        Raises KeyError where this kind has no mode of that name."""
        self._change(now_ns, self.modes[name])

    def fail(self, fault: Fault, failed: bool = True) -> None:
        """Make something fail, or recover."""
        if failed:
            self.health.faults.add(fault)
        else:
            self.health.faults.discard(fault)

    def set_battery(self, share: float) -> None:
        """Set the battery's charge, 0…1."""
        self.health.battery = min(1.0, max(0.0, share))

    # ------------------------------------------------------------------ the personality's side

    @property
    @abstractmethod
    def first_mode(self) -> int:
        """The mode after boot."""

    @abstractmethod
    def guide(self, now_ns: int, dt: float) -> Demand:
        """What the mode asks of the airframe now."""

    @abstractmethod
    def enter(self, now_ns: int, mode: int) -> None:
        """Prepare the guidance of a mode that has just been entered."""

    @abstractmethod
    def allows(self, now_ns: int, mode: int) -> str:
        """Why a mode cannot be entered now; "" where it can."""

    @abstractmethod
    def watch(self, now_ns: int) -> None:
        """Failsafes."""

    @abstractmethod
    def why_not_armable(self, now_ns: int) -> str:
        """Why arming is refused now; "" where it is not."""

    @abstractmethod
    def set_mode_result(self, now_ns: int, command: Command) -> int:
        """DO_SET_MODE."""

    @abstractmethod
    def watched_ground_station(self, packet: DialectPacket) -> bool:
        """Whether a heartbeat is that of the ground station whose silence counts."""

    @abstractmethod
    def _new_parameters(self) -> Parameters:
        """Its table."""

    @abstractmethod
    def on_armed(self, now_ns: int) -> None:
        """What else happens at arming."""

    def _message_handlers(self) -> dict[int, Callable[[int, DialectPacket], None]]:
        handlers: dict[int, Callable[[int, DialectPacket], None]] = {
            number: partial(service, self) for number, service in SERVICES.items()
        }
        handlers[dialect.MAVLINK_MSG_ID_HEARTBEAT] = self._on_heartbeat
        handlers[dialect.MAVLINK_MSG_ID_COMMAND_LONG] = self._on_command_long
        handlers[dialect.MAVLINK_MSG_ID_COMMAND_INT] = self._on_command_int
        handlers[dialect.MAVLINK_MSG_ID_SET_MODE] = self._on_set_mode
        return handlers

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        handlers: dict[int, Callable[[int, Command], int]] = {
            number: partial(inquiry, self) for number, inquiry in INQUIRIES.items()
        }
        handlers[dialect.MAV_CMD_COMPONENT_ARM_DISARM] = self._do_arm
        handlers[dialect.MAV_CMD_DO_SET_MODE] = self.set_mode_result
        return handlers

    # ------------------------------------------------------------------ what personalities use

    def emit(self, message: MavMessage | None) -> None:
        """Queue one message; None: there is nothing to say."""
        if message is None:
            return
        self._out.append(self._sender.pack(message, self._last_step_ns + self.setup.epoch_ns))

    def say(self, severity: int, text: str) -> None:
        """Queue a STATUSTEXT."""
        self.emit(dialect.MAVLink_statustext_message(severity, text.encode()[:50]))

    def boot_ms(self, now_ns: int) -> int:
        """time_boot_ms."""
        return (now_ns - self._boot_ns) // 1_000_000

    def boot_elapsed_ns(self, now_ns: int) -> int:
        """Since boot [ns]."""
        return now_ns - self._boot_ns

    def up_s(self, now_ns: int) -> float:
        """Time since boot [s]."""
        return (now_ns - self._boot_ns) * 1e-9

    @property
    def place(self) -> Geodetic:
        """Where it is."""
        position = self.motion.position
        if self._place is None or self._place[0] is not position:
            self._place = (position, self.setup.frame.geodetic_from_ned(position))
        return self._place[1]

    @property
    def height(self) -> float:
        """Above home [m]."""
        return self.setup.frame.origin.altitude_m - self.motion.position.z - self.home.altitude_m

    @property
    def above_ground(self) -> float:
        """Above the ground of its start [m]: home may have been moved since."""
        return self.setup.frame.origin.altitude_m - self.motion.position.z - self.setup.home.altitude_m

    def game_position(self, latitude_deg: float, longitude_deg: float, altitude_m: float) -> Vec:
        """In the frame in which motion is given [m; NED]."""
        return self.setup.frame.ned_from_geodetic(latitude_deg, longitude_deg, altitude_m)

    def game_from_local(self, position: Vec) -> Vec:
        """From the autopilot's own local frame into that of its motion [m; NED]."""
        return self.game_position(*self.local.geodetic_from_ned(position))

    def positioned(self, now_ns: int) -> bool:
        """Whether its estimator has a position."""
        cold = self._cold and self.up_s(now_ns) < self.setup.ready_s
        return self.health.positioned and not cold

    def gps_fixed(self, now_ns: int) -> bool:
        """Whether its receiver has a fix: it comes before the estimator uses it."""
        cold = self._cold and self.up_s(now_ns) < 0.5 * self.setup.ready_s
        return self.health.gps and not cold

    def healthy(self, now_ns: int) -> bool:
        """The pre-arm bit of SYS_STATUS: real ones set it before arming is accepted."""
        cold = self._cold and self.up_s(now_ns) < self.setup.healthy_s
        return self.health.positioned and not cold

    @property
    def mode_name(self) -> str:
        """The mode in the autopilot's own words."""
        return self._names.get(self.mode, f"mode {self.mode}")

    def request_mode(self, now_ns: int, mode: int) -> str:
        """Change the mode if it may be entered; why not otherwise."""
        if mode == self.mode:
            return ""
        reason = self.allows(now_ns, mode)
        if not reason:
            self._change(now_ns, mode)
        return reason

    def is_mode(self, *names: str) -> bool:
        """Whether it is in one of these modes."""
        return self._names.get(self.mode) in names

    def ground_station_silence_s(self, now_ns: int) -> float:
        """Since the watched ground station's last heartbeat [s]; 0 where it was never heard."""
        return 0.0 if self._ground_station_ns < 0 else (now_ns - self._ground_station_ns) * 1e-9

    def disarm(self, now_ns: int) -> None:
        """Stop the motors."""
        self.armed = False
        self._heartbeat(now_ns)

    def touch_down(self) -> None:
        """It has reached the ground."""
        self.landed = True

    def lift_off(self) -> None:
        """It leaves the ground."""
        self.landed = False
        self._cold = False

    # ------------------------------------------------------------------ inside

    def _start_wire(self, now_ns: int) -> None:
        self._sender = DialectSender(self.system, COMPONENT, signing=self.setup.signing)
        self.streams = Streams(self.default_rates, now_ns)
        self._heartbeat_ns = now_ns

    def _change(self, now_ns: int, mode: int) -> None:
        self.mode = mode
        self.enter(now_ns, mode)
        self._heartbeat(now_ns)

    def _heartbeat(self, now_ns: int) -> None:
        self._heartbeat_ns = now_ns + HEARTBEAT_NS
        self.emit(telemetry.heartbeat(self, now_ns))

    def _send_due(self, now_ns: int) -> None:
        if now_ns >= self._heartbeat_ns:
            following = self._heartbeat_ns + HEARTBEAT_NS
            self._heartbeat(now_ns)
            self._heartbeat_ns = following if following > now_ns else now_ns + HEARTBEAT_NS
        for number in self.streams.due(now_ns):
            self.emit(telemetry.build(self, number, now_ns))
        for message in self.parameters.due(PARAMETERS_A_STEP):
            self.emit(message)

    def _take(self, now_ns: int, packet: DialectPacket) -> None:
        message = packet.message
        if packet.system == self.system and packet.component == COMPONENT:
            self.counters["own_echo"] += 1
            return
        if getattr(message, "target_system", 0) not in (0, self.system) or getattr(
            message, "target_component", 0
        ) not in (0, COMPONENT):
            self.counters["for_others"] += 1
            return
        handler = self._handlers.get(message.get_msgId())
        if handler is None:
            self.counters["not_handled"] += 1
            return
        handler(now_ns, packet)

    def _on_heartbeat(self, now_ns: int, packet: DialectPacket) -> None:
        if self.watched_ground_station(packet):
            self._ground_station_ns = now_ns

    def _on_command_long(self, now_ns: int, packet: DialectPacket) -> None:
        self._obey(now_ns, from_long(packet))

    def _on_command_int(self, now_ns: int, packet: DialectPacket) -> None:
        self._obey(now_ns, from_int(packet))

    def _obey(self, now_ns: int, command: Command) -> None:
        handler = self._commands.get(command.number)
        result = UNSUPPORTED if handler is None else handler(now_ns, command)
        self.emit(
            dialect.MAVLink_command_ack_message(
                command.number, result, 0, 0, command.system, command.component
            )
        )

    def _on_set_mode(self, now_ns: int, packet: DialectPacket) -> None:
        m = packet.message
        main, sub = m.custom_mode >> 16 & 0xFF, m.custom_mode >> 24
        px4 = self.autopilot_type == dialect.MAV_AUTOPILOT_PX4
        p2, p3 = (main, sub) if px4 else (m.custom_mode, 0)
        result = self.set_mode_result(
            now_ns,
            Command(
                dialect.MAV_CMD_DO_SET_MODE,
                m.base_mode,
                p2,
                p3,
                0.0,
                0.0,
                0.0,
                0.0,
                -1,
                packet.system,
                packet.component,
            ),
        )
        self.emit(
            dialect.MAVLink_command_ack_message(
                dialect.MAVLINK_MSG_ID_SET_MODE, result, 0, 0, packet.system, packet.component
            )
        )

    def _do_arm(self, now_ns: int, command: Command) -> int:
        forced = command.p2 == FORCE
        if command.p1 == 1.0:
            if self.armed:
                return ACCEPTED
            reason = "" if forced else self.why_not_armable(now_ns)
            if reason:
                self.say(dialect.MAV_SEVERITY_CRITICAL, reason)
                return self.refused_arming
            self.armed = True
            self.on_armed(now_ns)
            self._heartbeat(now_ns)
            return ACCEPTED
        if command.p1 == 0.0:
            if self.armed and not self.landed and not forced:
                return self.refused_arming
            if self.armed:
                self.disarm(now_ns)
            return ACCEPTED
        return UNSUPPORTED
