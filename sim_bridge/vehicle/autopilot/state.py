"""What a simulated autopilot knows of itself, and its queue of outgoing frames.

Telemetry, commands and microservices work on an `AutopilotState`; `Autopilot` moves it on in time.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Mapping
from typing import ClassVar

from onboard.core.math.vectors import Vec
from onboard.game.scenario import Firmware
from onboard.wire.geodesy import Frame, Geodetic
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, Said, dialect
from sim_bridge.vehicle.autopilot.health import Fault, Health, pack_voltage
from sim_bridge.vehicle.autopilot.parameters import Parameters
from sim_bridge.vehicle.autopilot.resting import AWAKE
from sim_bridge.vehicle.autopilot.setup import Setup
from sim_bridge.vehicle.autopilot.streams import Streams
from sim_bridge.vehicle.autopilot.transmitter import Transmitter
from sim_bridge.vehicle.autopilot.wind_filter import WindFilter
from sim_bridge.vehicle.motion import CALM

COMPONENT = 1  # MAV_COMP_ID_AUTOPILOT1
TEXT_LONGEST = 50  # bytes of one STATUSTEXT; longer texts are sent in chunks


class AutopilotState(ABC):
    """State of one autopilot: motion, home, mode, arming, health, parameters, streams."""

    autopilot_type: ClassVar[int]
    vehicle_type: ClassVar[int]
    modes: ClassVar[Mapping[str, int]]  # names ↔ custom_mode
    default_rates: ClassVar[Mapping[int, float]]  # message number → [Hz]
    full_rates: ClassVar[Mapping[int, float]] = {}  # of the real one by default, where they are simulated
    versions: ClassVar[Mapping[Firmware, tuple[int, int, int]]]  # major, minor, patch
    refused_arming: ClassVar[int]  # result of a refused arm or disarm
    unknown_message: ClassVar[int]  # result of REQUEST_MESSAGE for what it cannot send
    unknown_interval: ClassVar[int]  # … and of SET_MESSAGE_INTERVAL

    def __init__(self, setup: Setup, now_ns: int) -> None:
        """`now_ns` is the instant of boot, integer nanoseconds of any monotonic zero."""
        self.setup = setup
        self.system = setup.system
        self.motion = setup.start
        self.air = CALM
        self.wind_filter = WindFilter(setup.kind, setup.options.wind_errors)
        self.home = setup.home
        self.local = Frame(*setup.origin)
        self.health = Health(setup.options.battery_s, setup.options.batteries)
        self.transmitter = Transmitter(setup.options.throttle)
        self.parameters = self._new_parameters()
        self.counters: Counter[str] = Counter()
        self.armed = setup.options.airborne
        self.landed = not setup.options.airborne
        self._cold = not setup.options.airborne  # booted on the ground: the estimator needs time
        self.home_known = not self._cold
        self._names = {number: name for name, number in self.modes.items()}
        self.mode = self.first_mode
        self._last_step_ns = now_ns
        self._out: list[bytes] = []
        self._place: tuple[Vec, Geodetic] | None = None
        self._rest_ns = AWAKE  # until when nothing is due, if nobody tells it anything
        self._quiet_ns = AWAKE  # until when nothing is found by watching, likewise
        self._boot(now_ns)

    def _boot(self, now_ns: int) -> None:
        """Begin a life of the wire: sequence, time since boot and streams start anew."""
        self._boot_ns = now_ns
        self._text_number = 0  # of the latest text in chunks
        self._sender = DialectSender(self.system, COMPONENT, signing=self.setup.options.signing)
        full = self.setup.options.full_streams and self.full_rates
        self.streams = Streams(self.full_rates if full else self.default_rates, now_ns)

    @property
    def version(self) -> int:
        """AUTOPILOT_VERSION.flight_sw_version: of a release (type 255)."""
        major, minor, patch = self.versions[self.setup.options.firmware]
        return major << 24 | minor << 16 | patch << 8 | 255

    @property
    def version_name(self) -> str:
        """The firmware's version as people write it."""
        return ".".join(str(part) for part in self.versions[self.setup.options.firmware])

    @property
    @abstractmethod
    def banner(self) -> tuple[str, ...]:
        """What it says at boot and before a listing of parameters."""

    @property
    @abstractmethod
    def critical(self) -> bool:
        """Whether a failsafe is active: HEARTBEAT.system_status then says CRITICAL."""

    @property
    @abstractmethod
    def first_mode(self) -> int:
        """custom_mode in which the autopilot boots."""

    @abstractmethod
    def _new_parameters(self) -> Parameters:
        """The parameter table of this autopilot as delivered."""

    # ------------------------------------------------------------------ what it sends

    def emit(self, message: MavMessage | Said | None) -> None:
        """Queue one message; None: there is nothing to say."""
        if message is None:
            return
        self._out.append(self._sender.pack(message, self._last_step_ns + self.setup.options.epoch_ns))

    def say(self, severity: int, text: str) -> None:
        """Queue a STATUSTEXT of a MAV_SEVERITY; a text above 50 bytes goes out in numbered chunks.

        A last chunk of exactly 50 bytes is followed by an empty one: a chunk without a zero byte goes on.
        """
        told = text.encode()
        if len(told) <= TEXT_LONGEST:
            self.emit(dialect.MAVLink_statustext_message(severity, told))
            return
        self._text_number = self._text_number % 65535 + 1
        chunks = [told[at : at + TEXT_LONGEST] for at in range(0, len(told), TEXT_LONGEST)]
        if len(chunks[-1]) == TEXT_LONGEST:
            chunks.append(b"")
        for number, chunk in enumerate(chunks):
            self.emit(dialect.MAVLink_statustext_message(severity, chunk, self._text_number, number))

    @property
    def parked(self) -> bool:
        """Whether the vehicle stands on the ground: the world then leaves the airframe where it is."""
        return self.landed

    @property
    def speaks(self) -> bool:
        """Whether there are frames to be sent."""
        return bool(self._out)

    def outgoing(self) -> list[bytes]:
        """The frames to be sent now, each to every peer; they are handed over once."""
        out = self._out
        self._out = []
        return out

    # ------------------------------------------------------------------ what is done to the vehicle

    def wake(self) -> None:
        """Look at everything in the next step: something was done to the vehicle."""
        self._rest_ns = self._quiet_ns = AWAKE

    def fail(self, fault: Fault, failed: bool = True) -> None:
        """Make something fail, or recover."""
        self.wake()
        if failed:
            self.health.faults.add(fault)
        else:
            self.health.faults.discard(fault)

    def set_battery(self, share: float) -> None:
        """Set the flight battery's charge, 0…1."""
        self.wake()
        self.health.battery = min(1.0, max(0.0, share))

    def set_voltage(self, voltage: float) -> None:
        """Let the flight battery's voltage drop to `voltage` [V] at its present charge."""
        self.wake()
        self.health.sag = max(0.0, pack_voltage(self.health.battery) - voltage)

    def set_throttle(self, now_ns: int, throttle: float | None) -> None:
        """Move the pilot's throttle stick, 0…1; None: the transmitter is no longer heard."""
        self.wake()
        self.transmitter.put(throttle, now_ns)

    def touch_down(self) -> None:
        """The vehicle has reached the ground."""
        self.landed = True

    def lift_off(self) -> None:
        """The vehicle leaves the ground."""
        self.landed = False
        self._cold = False

    # ------------------------------------------------------------------ what it knows

    def boot_ms(self, now_ns: int) -> int:
        """Time since boot [ms], as time_boot_ms has it."""
        return (now_ns - self._boot_ns) // 1_000_000

    def boot_elapsed_ns(self, now_ns: int) -> int:
        """Time since boot [ns]."""
        return now_ns - self._boot_ns

    def up_s(self, now_ns: int) -> float:
        """Time since boot [s]."""
        return (now_ns - self._boot_ns) * 1e-9

    @property
    def place(self) -> Geodetic:
        """Geodetic position of the vehicle."""
        position = self.motion.position
        if self._place is None or self._place[0] is not position:
            self._place = (position, self.setup.frame.geodetic_from_ned(position))
        return self._place[1]

    @property
    def height(self) -> float:
        """Height of the vehicle above home [m]."""
        return self.setup.frame.origin.altitude_m - self.motion.position.z - self.home.altitude_m

    @property
    def above_ground(self) -> float:
        """Height above the ground of the start [m]: home may have been moved since."""
        return self.setup.frame.origin.altitude_m - self.motion.position.z - self.setup.home.altitude_m

    def game_position(self, latitude_deg: float, longitude_deg: float, altitude_m: float) -> Vec:
        """A geodetic place in the frame in which motion is given [m; NED]."""
        return self.setup.frame.ned_from_geodetic(latitude_deg, longitude_deg, altitude_m)

    def game_from_local(self, position: Vec) -> Vec:
        """A position in the autopilot's own local frame [m; NED], in the frame of its motion [m; NED]."""
        return self.game_position(*self.local.geodetic_from_ned(position))

    def positioned(self, now_ns: int) -> bool:
        """Whether the estimator has a position."""
        cold = self._cold and self.up_s(now_ns) < self.setup.options.ready_s
        return self.health.positioned and not cold

    def gps_fixed(self, now_ns: int) -> bool:
        """Whether the receiver has a fix; it has one before the estimator uses it."""
        cold = self._cold and self.up_s(now_ns) < 0.5 * self.setup.options.ready_s
        return self.health.gps and not cold

    def healthy(self, now_ns: int) -> bool:
        """Whether SYS_STATUS says ready to arm: real autopilots say it before they accept arming."""
        cold = self._cold and self.up_s(now_ns) < self.setup.options.healthy_s
        return self.health.positioned and not cold

    @property
    def mode_name(self) -> str:
        """The mode's name in the autopilot's own words."""
        return self._names.get(self.mode, f"mode {self.mode}")

    def is_mode(self, *names: str) -> bool:
        """Whether the autopilot is in one of these modes."""
        return self._names.get(self.mode) in names
