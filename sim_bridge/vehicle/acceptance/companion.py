"""The companion computer of an acceptance flight: what it hears of an autopilot, and what it sends.

Sans I/O: `receive` takes datagrams, `tick` keeps the time [s since the flight's beginning], `outgoing` hands
over frames. It beats as an agent does, so that the autopilot's failsafes see it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from math import hypot
from struct import pack, unpack
from typing import Any, NamedTuple

from onboard.core.math.vectors import ZERO, Vec
from onboard.wire.autopilot_kind import Kind
from onboard.wire.mavlink.dialect import DialectSender, MavMessage, dialect, dialect_packet
from onboard.wire.mavlink.frames import PeerFramers
from onboard.wire.mavlink.modes import custom_mode, kind_of, mode_name
from onboard.wire.mavlink.signing import Signing

COMPONENT = 191  # MAV_COMP_ID_ONBOARD_COMPUTER
BEAT_S = 1.0
STREAM_S = 0.05  # between two targets: 20 Hz
FRESH_S = 2.0  # for which RC_CHANNELS says where the stick stands
INTERVALS_US = {
    32: 50_000,
    33: 100_000,
    30: 100_000,
    74: 100_000,
    65: 500_000,
}  # message → interval asked for
HEARD_MOST = 100_000  # acknowledgements, changes and texts kept


class Change(NamedTuple):
    """A heartbeat that told another mode or status than the one before."""

    t: float
    mode: str
    status: int  # MAV_STATE


class Companion:
    """One companion and what it knows of the one autopilot on its link."""

    def __init__(self, signing: Signing | None = None) -> None:
        self.now = 0.0
        self.kind = Kind.UNKNOWN
        self.system = 0  # of the autopilot; 0: none was heard
        self.armed = False
        self.beats = True  # whether it sends heartbeats
        self.target: Callable[[], MavMessage] | None = None  # streamed at 20 Hz
        self.acks: list[tuple[float, int, int]] = []  # time, command, result
        self.changes: list[Change] = []
        self.texts: list[str] = []
        self.parameters: dict[str, float] = {}
        self.local, self.velocity = ZERO, ZERO  # LOCAL_POSITION_NED
        self.height: float | None = None  # above home [m]
        self.latest: dict[str, Any] = {}  # the latest message of each kind
        self._signing = signing
        self._sender: DialectSender | None = None
        self._framers = PeerFramers(signing=signing)
        self._stick: tuple[float, int] | None = None  # when RC_CHANNELS came, channel 3
        self._beat_due = self._target_due = 0.0
        self._out: list[bytes] = []

    # ------------------------------------------------------------------ the link's side

    def receive(self, data: bytes, peer: Hashable = None) -> list[bytes]:
        """Take what came from `peer`; gives the whole frames in it, for the log."""
        frames = []
        for packet in self._framers.feed(peer, data):
            frames.append(packet.raw)
            try:
                message = dialect_packet(packet.raw).message
            except KeyError:
                continue
            self._take(packet.system, packet.component, message)
        return frames

    def tick(self, now: float) -> None:
        """Let time pass: send the heartbeat and the target that are due."""
        self.now = now
        if self.system == 0:
            return
        if self.beats and now >= self._beat_due:
            self._beat_due = now + BEAT_S
            self.send(
                dialect.MAVLink_heartbeat_message(
                    dialect.MAV_TYPE_ONBOARD_CONTROLLER, dialect.MAV_AUTOPILOT_INVALID, 0, 0,
                    dialect.MAV_STATE_ACTIVE, 3,
                )
            )  # fmt: skip
        if self.target is not None and now >= self._target_due:
            self._target_due = now + STREAM_S
            self.send(self.target())

    def outgoing(self) -> list[bytes]:
        """The frames to be sent now."""
        out, self._out = self._out, []
        return out

    # ------------------------------------------------------------------ the story's side

    @property
    def mode(self) -> str:
        """The mode of the latest heartbeat."""
        return self.changes[-1].mode if self.changes else ""

    @property
    def stick_centred(self) -> bool:
        """Whether a transmitter is heard and its throttle stick stands in the middle (±10 %)."""
        return (
            self._stick is not None
            and self.now - self._stick[0] < FRESH_S
            and abs(self._stick[1] - 1500) <= 50
        )

    @property
    def throttle(self) -> float | None:
        """The throttle stick, 0…1; None where no channel is heard."""
        if self._stick is None or self._stick[1] < 900:
            return None
        return min(1.0, max(0.0, (self._stick[1] - 1000) / 1000.0))

    @property
    def level_speed(self) -> float:
        """Speed over ground [m/s]."""
        return hypot(self.velocity.x, self.velocity.y)

    def send(self, message: MavMessage) -> None:
        """Queue one message."""
        if self._sender is None:
            self._sender = DialectSender(self.system or 1, COMPONENT, signing=self._signing)
        self._out.append(self._sender.pack(message))

    def command(self, number: int, *values: float) -> None:
        """Send a COMMAND_LONG with its params from the first on."""
        values = (*values, *[0.0] * (7 - len(values)))
        self.send(dialect.MAVLink_command_long_message(self.system, 1, number, 0, *values))

    def command_int(
        self, number: int, values: tuple[float, float, float, float], z: float, frame: int
    ) -> None:
        """Send a COMMAND_INT without a place but for its height."""
        self.send(dialect.MAVLink_command_int_message(self.system, 1, frame, number, 0, 0, *values, 0, 0, z))

    def order_mode(self, name: str) -> None:
        """Send a DO_SET_MODE."""
        number = custom_mode(self.kind, name)
        if number is None:
            raise ValueError(f"{self.kind.value} has no mode {name}")
        px4 = self.kind in (Kind.PX4_MULTICOPTER, Kind.PX4_PLANE)
        parts = (number >> 16 & 255, number >> 24) if px4 else (number, 0)
        self.command(dialect.MAV_CMD_DO_SET_MODE, 1, *parts)

    def results(self, number: int, since: float) -> list[int]:
        """Results of a command's acknowledgements since a time."""
        return [result for t, command, result in self.acks if command == number and t >= since]

    def ask_streams(self) -> None:
        """Ask for the messages that the stories read."""
        for number, interval_us in INTERVALS_US.items():
            self.command(dialect.MAV_CMD_SET_MESSAGE_INTERVAL, number, interval_us)

    def ask_parameter(self, name: str) -> None:
        """Ask for one parameter; its value lands in `parameters`."""
        self.send(dialect.MAVLink_param_request_read_message(self.system, 1, name.encode(), -1))

    def velocity_target(self, velocity: Vec) -> MavMessage:
        """SET_POSITION_TARGET_LOCAL_NED with a velocity alone."""
        mask = 0x0DC7 if self.kind is Kind.ARDUCOPTER else 0x9C7
        message: MavMessage = dialect.MAVLink_set_position_target_local_ned_message(
            0, self.system, 1, 1, mask, 0, 0, 0, *velocity, 0, 0, 0, 0, 0
        )
        return message

    def position_target(self, place: Vec) -> MavMessage:
        """SET_POSITION_TARGET_LOCAL_NED with a place of the autopilot's own frame [m; NED] alone."""
        message: MavMessage = dialect.MAVLink_set_position_target_local_ned_message(
            0, self.system, 1, 1, 0xDF8, *place, 0, 0, 0, 0, 0, 0, 0, 0
        )
        return message

    # ------------------------------------------------------------------ inside

    def _take(self, system: int, component: int, m: Any) -> None:
        name = m.get_type()
        if component != 1 or (self.system and system != self.system):
            return
        if name == "HEARTBEAT":
            self._take_heartbeat(system, m)
            return
        self.latest[name] = m
        if name == "COMMAND_ACK":
            self.acks = [*self.acks[-HEARD_MOST:], (self.now, m.command, m.result)]
        elif name == "STATUSTEXT":
            self.texts = [*self.texts[-HEARD_MOST:], m.text]
        elif name == "LOCAL_POSITION_NED":
            self.local, self.velocity = Vec(m.x, m.y, m.z), Vec(m.vx, m.vy, m.vz)
        elif name == "GLOBAL_POSITION_INT":
            self.height = m.relative_alt * 1e-3
        elif name == "RC_CHANNELS":
            self._stick = (self.now, m.chan3_raw if m.chancount else 0)
        elif name == "PARAM_VALUE":
            value = m.param_value
            bytewise = self.kind in (Kind.PX4_MULTICOPTER, Kind.PX4_PLANE) and m.param_type != 9
            self.parameters[m.param_id] = float(unpack("<i", pack("<f", value))[0]) if bytewise else value

    def _take_heartbeat(self, system: int, m: Any) -> None:
        kind = kind_of(m.autopilot, m.type)
        if kind is Kind.UNKNOWN:
            return
        self.system, self.kind = system, kind
        self.armed = bool(m.base_mode & dialect.MAV_MODE_FLAG_SAFETY_ARMED)
        change = Change(self.now, mode_name(kind, m.custom_mode), m.system_status)
        if not self.changes or self.changes[-1][1:] != change[1:]:
            self.changes = [*self.changes[-HEARD_MOST:], change]
