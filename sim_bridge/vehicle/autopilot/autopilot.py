"""What all simulated autopilots do alike: addressing, heartbeat, streams, commands, arming, faults.

Sans I/O. Time is an argument: `now_ns`, integer nanoseconds, any monotonic zero. The world calls
`receive` for each datagram, `step` each tick, and sends what `outgoing` gives to every peer.
"""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from collections.abc import Callable, Hashable
from functools import partial

from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import ZERO
from onboard.wire.mavlink.dialect import DialectPacket, DialectSender, dialect, dialect_packet
from onboard.wire.mavlink.frames import PeerFramers
from onboard.wire.mavlink.signing import MemoryStore, Signing
from sim_bridge.vehicle.autopilot import telemetry
from sim_bridge.vehicle.autopilot.command import ACCEPTED, FAILED, UNSUPPORTED, Command, from_int, from_long
from sim_bridge.vehicle.autopilot.commands import COMMANDS
from sim_bridge.vehicle.autopilot.company import Company
from sim_bridge.vehicle.autopilot.generations import REMOVED
from sim_bridge.vehicle.autopilot.microservices import SERVICES
from sim_bridge.vehicle.autopilot.resting import AWAKE, DELAYED, SETPOINTS
from sim_bridge.vehicle.autopilot.setup import Setup
from sim_bridge.vehicle.autopilot.state import COMPONENT, AutopilotState
from sim_bridge.vehicle.motion import Air, Demand, Motion

HEARTBEAT_NS = NS_PER_S
PEERS_MAX = 16  # framing states kept, least recently heard forgotten first
PARAMETERS_A_STEP = 5
LATE_MOST = 256  # commands that wait for their delay; beyond them they are lost, and counted
FORCE = 21196  # param2 of 400: arm or disarm whatever the checks say


class Autopilot(AutopilotState):
    """A simulated autopilot. Subclasses are the personalities."""

    def __init__(self, setup: Setup, now_ns: int) -> None:
        super().__init__(setup, now_ns)
        self.handlers: dict[int, Callable[[int, DialectPacket], None]] = self._message_handlers()
        self.commands: dict[int, Callable[[int, Command], int]] = self._command_handlers()
        for number in REMOVED.get((setup.kind, setup.options.firmware), ()):
            self.commands.pop(number, None)
        self._framers = self._hearing(setup.options.signing)
        self._late: deque[tuple[int, DialectPacket]] = deque()  # commands and when each is executed
        self._company = Company(setup.options, setup.system, now_ns)
        self._senders: dict[tuple[int, int], DialectSender] = {}  # of the company
        self._ground_station_ns = -1  # last heartbeat of the watched one; −1 = never
        self._any_station_ns = -1  # last heartbeat of any ground station; −1 = never
        self._heartbeat_ns = now_ns  # when the next one is due
        self._rest_values = 0  # `changes` of the parameters then
        self._steady_ns = AWAKE  # until when `guide` says what `_steady` is
        self._steady: Demand | None = None  # what it demands until then, where motion does not change it
        self.enter(now_ns, self.mode)

    # ------------------------------------------------------------------ the world's side

    def receive(self, now_ns: int, data: bytes, peer: Hashable) -> None:
        """Take one datagram. Never raises: what is bad or meant for others is counted and dropped."""
        for packet in self._framers.feed(peer, data, self.setup.options.epoch_ns + now_ns):
            self._take(now_ns, dialect_packet(packet.raw))

    def step(self, now_ns: int, motion: Motion, air: Air) -> Demand:
        """Sense, keep time, send what is due, and say what the airframe shall do until the next step."""
        dt = (now_ns - self._last_step_ns) * 1e-9
        self._last_step_ns = now_ns
        self.motion = Motion(motion.position, ZERO, 0.0, 0.0, 0.0, motion.yaw) if self.landed else motion
        self.air = air
        self.wind_filter.step(now_ns, self.motion, air, self.landed)
        self.health.drain(dt, self.armed and not self.landed)
        if now_ns < self._quiet_ns and self.parameters.changes == self._rest_values:
            if now_ns < self._rest_ns:
                return self._steady or self._steered(now_ns, dt)
            steady = self._steady if now_ns < self._steady_ns else None
            if steady is not None:  # streams alone are due
                self._send_due(now_ns)
                self._rest(now_ns, steady)
                return steady
        self._rest_ns, self._quiet_ns, self._place = AWAKE, AWAKE, None
        if not self.home_known and self.positioned(now_ns):
            self.home_known = True
            self.emit(telemetry.home_position(self, now_ns))
            self.emit(telemetry.global_origin(self, now_ns))
        self._hear_company(now_ns)
        self._execute_late(now_ns)
        self.watch(now_ns)
        demand = self.guide(now_ns, dt)
        self._send_due(now_ns)
        alone = not self._late and self._company.alone and self.parameters.listed and self.home_known
        if alone and self.armed and not self.landed:  # until when this need not be done again
            self._quiet_ns = self.watched_until(now_ns)
            self._rest_values = self.parameters.changes
            self._steady_ns = self.steady_until(now_ns)
            self._rest(now_ns, demand)
        return demand

    def _rest(self, now_ns: int, demand: Demand) -> None:
        """Rest until something is due or may be found, with `demand` where that holds so long."""
        due_ns = min(self._heartbeat_ns, self.streams.first)
        self._rest_ns = min(due_ns, self._quiet_ns) if due_ns > now_ns else AWAKE
        self._steady = demand if self._steady_ns >= self._rest_ns else None

    def rests_until(self) -> int:
        """The instant [ns] before which `step` would demand the same again and do nothing else, as long as
        it is told nothing and nobody looks at it; 0: it is to be stepped. `rested` makes up for the steps."""
        steady = self._steady is not None and self.armed and not self.landed
        return self._rest_ns if steady and self.wind_filter.still else AWAKE

    def rested(self, steps: int, now_ns: int, motion: Motion, air: Air) -> None:
        """Make up for as many equal steps that it rested through, the last of them at `now_ns` [ns]."""
        dt = (now_ns - self._last_step_ns) // steps * 1e-9
        self._last_step_ns = now_ns
        self.motion, self.air = motion, air
        self.wind_filter.step(now_ns, motion, air, self.landed)
        self.health.drain(dt, True, steps)

    def _steered(self, now_ns: int, dt: float) -> Demand:
        """What `guide` says now, kept where it will say the same until the end of the rest."""
        before = self.mode, self.armed, self.landed
        demand = self.guide(now_ns, dt)
        if before != (self.mode, self.armed, self.landed):  # `watch` may find something in it
            self._quiet_ns = self._rest_ns
        self._steady_ns = self.steady_until(now_ns)
        self._steady = demand if self._steady_ns >= self._rest_ns else None
        return demand

    # ------------------------------------------------------------------ faults

    def reboot(self, now_ns: int) -> None:
        """Restart: sequence, boot time, streams and guidance begin anew; parameters, home and battery stay.

        In flight a real one would come up flying (a watchdog reset keeps the vehicle armed)."""
        self.wake()
        self._boot(now_ns)
        self._heartbeat_ns = now_ns
        self._framers.clear()
        self._late.clear()
        self._out.clear()
        self._cold = self.landed
        self.armed = self.armed and not self.landed
        self._ground_station_ns = -1
        self.mode = self.first_mode
        self.enter(now_ns, self.mode)
        for line in self.banner:
            self.say(dialect.MAV_SEVERITY_INFO, line)

    def pilot_mode(self, now_ns: int, name: str) -> None:
        """The safety pilot's switch: the mode is entered whatever the ground station wants.

        Raises KeyError where this kind has no mode of that name."""
        self.wake()
        self.transmitter.choose(name)
        self._change(now_ns, self.modes[name])

    # ------------------------------------------------------------------ the personality's side

    @abstractmethod
    def guide(self, now_ns: int, dt: float) -> Demand:
        """The demand of the present mode on the airframe, `dt` seconds after the last one."""

    @abstractmethod
    def enter(self, now_ns: int, mode: int) -> None:
        """Prepare the guidance of a mode that has just been entered."""

    @abstractmethod
    def allows(self, now_ns: int, mode: int) -> str:
        """Why a mode cannot be entered now; "" where it can."""

    @abstractmethod
    def watch(self, now_ns: int) -> None:
        """Look for what triggers a failsafe, and act on it."""

    @abstractmethod
    def watched_until(self, now_ns: int) -> int:
        """Until when [ns] `watch` surely finds nothing, armed in the air and told nothing; 0: look again."""

    def steady_until(self, now_ns: int) -> int:
        """Until when [ns] `guide` surely says the same, however the vehicle moves; 0: ask again."""
        return AWAKE

    @abstractmethod
    def why_not_armable(self, now_ns: int) -> str:
        """Why arming is refused now; "" where it is not."""

    @abstractmethod
    def set_mode_result(self, now_ns: int, command: Command) -> int:
        """MAV_RESULT of a MAV_CMD_DO_SET_MODE, which it obeys where it can."""

    @abstractmethod
    def watched_ground_station(self, packet: DialectPacket) -> bool:
        """Whether a heartbeat is that of the ground station whose silence counts."""

    @abstractmethod
    def on_armed(self, now_ns: int) -> None:
        """Do what else this autopilot does at arming: set home, say so."""

    def _message_handlers(self) -> dict[int, Callable[[int, DialectPacket], None]]:
        handlers: dict[int, Callable[[int, DialectPacket], None]] = {
            number: partial(service, self) for number, service in SERVICES.items()
        }
        handlers[dialect.MAVLINK_MSG_ID_HEARTBEAT] = self._on_heartbeat
        handlers[dialect.MAVLINK_MSG_ID_COMMAND_LONG] = self._on_command_long
        handlers[dialect.MAVLINK_MSG_ID_COMMAND_INT] = self._on_command_int
        handlers[dialect.MAVLINK_MSG_ID_SET_MODE] = self._on_set_mode
        handlers[dialect.MAVLINK_MSG_ID_SETUP_SIGNING] = self._on_setup_signing
        return handlers

    def _command_handlers(self) -> dict[int, Callable[[int, Command], int]]:
        handlers: dict[int, Callable[[int, Command], int]] = {
            number: partial(command, self) for number, command in COMMANDS.items()
        }
        handlers[dialect.MAV_CMD_COMPONENT_ARM_DISARM] = self._do_arm
        handlers[dialect.MAV_CMD_DO_SET_MODE] = self.set_mode_result
        handlers[dialect.MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN] = self._do_reboot
        return handlers

    def request_mode(self, now_ns: int, mode: int) -> str:
        """Change the mode where it may be entered; gives the reason where it may not, else ""."""
        if mode == self.mode:
            return ""
        reason = self.allows(now_ns, mode)
        if not reason:
            self._change(now_ns, mode)
        return reason

    def ground_station_silence_s(self, now_ns: int) -> float:
        """Time since the watched ground station's last heartbeat [s]; 0 where none was ever heard."""
        return 0.0 if self._ground_station_ns < 0 else (now_ns - self._ground_station_ns) * 1e-9

    def disarm(self, now_ns: int) -> None:
        """Stop the motors, and tell it with a heartbeat."""
        self.armed = False
        self._heartbeat(now_ns)

    # ------------------------------------------------------------------ inside

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
            if number == dialect.MAVLINK_MSG_ID_BATTERY_STATUS:
                self.emit(telemetry.payload_battery(self, now_ns))
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
        handler = self.handlers.get(message.get_msgId())
        if handler is None:
            self.counters["not_handled"] += 1
            return
        self._steady = None
        if message.get_msgId() not in SETPOINTS:  # which change what it demands, and nothing that is watched
            self.wake()
        most = self.setup.options.answer_delay_s[1]
        if most > 0.0 and message.get_msgId() in DELAYED:
            self._wait(now_ns, packet)
            return
        handler(now_ns, packet)

    def _wait(self, now_ns: int, packet: DialectPacket) -> None:
        """Put a command aside for its delay; each draws its own, so that they may be executed crosswise."""
        if len(self._late) >= LATE_MOST:
            self.counters["late_lost"] += 1
            return
        least, most = self.setup.options.answer_delay_s
        generator = self.setup.options.generator
        delay = least if generator is None else float(generator.uniform(least, most))
        self._late.append((now_ns + round(delay * NS_PER_S), packet))

    def _execute_late(self, now_ns: int) -> None:
        if not self._late:
            return
        due = [entry for entry in self._late if entry[0] <= now_ns]
        if due:
            self._late = deque(entry for entry in self._late if entry[0] > now_ns)
            for _, packet in sorted(due, key=lambda entry: entry[0]):
                self.handlers[packet.message.get_msgId()](now_ns, packet)

    def _hear_company(self, now_ns: int) -> None:
        """Let the neighbours on the link speak: to this autopilot, and to everybody through its links."""
        for voice in self._company.step(now_ns):
            packet = DialectPacket(voice.system, voice.component, voice.message)
            sender = self._senders.get((voice.system, voice.component))
            if sender is None:
                signing = self.setup.options.signing
                sender = DialectSender(voice.system, voice.component, signing=signing)
                self._senders[voice.system, voice.component] = sender
            self._out.append(sender.pack(voice.message, now_ns + self.setup.options.epoch_ns))
            self._take(now_ns, packet)

    def _on_heartbeat(self, now_ns: int, packet: DialectPacket) -> None:
        if packet.message.type == dialect.MAV_TYPE_GCS:
            self._any_station_ns = now_ns
        if self.watched_ground_station(packet):
            self._ground_station_ns = now_ns

    def _hearing(self, signing: Signing | None) -> PeerFramers:
        return PeerFramers(PEERS_MAX, signing=signing, causes=self.counters, takes_keys=True)

    def _on_setup_signing(self, now_ns: int, packet: DialectPacket) -> None:
        """Take a key, on the ground alone: from now on frames are signed, and unsigned ones are dropped."""
        if self.armed:
            return
        key = bytes(packet.message.secret_key)
        signing = Signing(key, MemoryStore()) if any(key) else None
        options = self.setup.options._replace(signing=signing)
        self.setup = self.setup._replace(options=options)
        self._framers = self._hearing(signing)
        self._sender = DialectSender(self.system, COMPONENT, signing=signing)
        self._senders.clear()

    def _on_command_long(self, now_ns: int, packet: DialectPacket) -> None:
        self._obey(now_ns, from_long(packet))

    def _on_command_int(self, now_ns: int, packet: DialectPacket) -> None:
        self._obey(now_ns, from_int(packet))

    def _obey(self, now_ns: int, command: Command) -> None:
        handler = self.commands.get(command.number)
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
        command = Command(
            dialect.MAV_CMD_DO_SET_MODE, m.base_mode, p2, p3, 0.0, 0.0, 0.0, 0.0, -1, packet.system,
            packet.component,
        )  # fmt: skip
        result = self.set_mode_result(now_ns, command)
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

    def _do_reboot(self, now_ns: int, command: Command) -> int:
        if command.p1 != 1.0:
            return UNSUPPORTED
        if self.armed:
            return FAILED
        self.reboot(now_ns)
        return ACCEPTED
