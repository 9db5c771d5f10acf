"""What adapters read, are given and answer: telemetry, setpoints, messages and notes.

An adapter flies one autopilot and does no I/O. The agent calls

    adapter.step(now, telemetry, setpoint)      # each control step, and at least every 80 ms

and sends the messages it gets back, in order, at once; notes it publishes as events. All instants are
local monotonic seconds. An adapter never arms unless it was made with `may_arm`, enters the autopilot's
guided mode only after `enter`, leaves it whenever told, and lets go at once and for good (until `enter`, or
until the pilot's switch selects the guided mode again) when the mode changes by another hand.
"""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple, Protocol

from onboard.core.math.constants import NEVER
from onboard.core.math.vectors import ZERO, Vec
from onboard.wire.mavlink.commands import Outgoing
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import UNKNOWN, CommandAck


class Telemetry(NamedTuple):
    """What is known of the own vehicle at one instant; `*_at` are arrival times [s, monotonic].

    `Observer.snapshot` makes it. A field is meaningful only when its `*_at` is not `NEVER`.
    """

    kind: Kind = Kind.UNKNOWN
    mode: str = ""  # the autopilot's own word
    armed: bool = False
    heartbeat_at: float = NEVER
    status: int = 0  # MAV_STATE: 3 standby, 4 active, 5 critical (a failsafe), 6 emergency; 0 unknown
    time_boot_s: float = 0.0  # the autopilot's clock at its newest stamped message
    latitude_deg: float = 0.0
    longitude_deg: float = 0.0
    altitude_m: float = 0.0  # above mean sea level
    above_home_m: float = 0.0
    position: Vec = ZERO  # [m; NED, game frame], once the frame is known
    placed: bool = False  # the game frame is known, so `position` counts
    velocity: Vec = ZERO  # [m/s; ground, NED]
    position_at: float = NEVER  # of place and velocity together
    roll: float = 0.0  # [rad]
    pitch: float = 0.0  # [rad, up]
    yaw: float = 0.0  # [rad, north to east]
    attitude_at: float = NEVER
    airspeed: float = 0.0  # [m/s]
    airspeed_at: float = NEVER
    wind: Vec = ZERO  # [m/s; NED] of the air over ground
    wind_at: float = NEVER
    battery: float = UNKNOWN  # 0…1
    voltage: float = UNKNOWN  # [V]
    battery_at: float = NEVER
    pre_arm_ok: bool = False
    unhealthy: int = 0  # MAV_SYS_STATUS_SENSOR bits
    status_at: float = NEVER
    gps_fix: int = 0
    satellites: int = -1
    accuracy_m: float = UNKNOWN  # horizontal
    gps_at: float = NEVER
    ekf_ok: bool = False
    ekf_at: float = NEVER
    channels: tuple[int, ...] = ()  # [µs] of the pilot's transmitter, channel 1 first; 0: not heard
    channels_at: float = NEVER
    landed_state: int = 0  # 0 unknown, 1 on ground, 2 in air, 3 taking off, 4 landing
    landed_at: float = NEVER
    reboots: int = 0  # how often the autopilot's clock started again
    link_quality: float = 1.0  # share of the autopilot's frames that arrived, lately


class Setpoint(NamedTuple):
    """A velocity that the supervisor let pass: within the vehicle's limits already, and sent as it is."""

    velocity: Vec  # [m/s; relative to the air, NED]
    wind: Vec = ZERO  # [m/s; NED] added for motion over ground; 0 for those who hold groundspeed
    yaw: float | None = None  # [rad] where a multicopter's nose is to point; None: as its encoder likes


class Stage(Enum):
    """Who flies, as far as the adapter knows."""

    IDLE = "idle"  # not asked to control
    ENTERING = "entering"  # asks for the guided mode
    ACTIVE = "active"  # the autopilot reports the guided mode: setpoints count
    LEAVING = "leaving"  # asks for a mode the autopilot can hold alone
    LEFT = "left"  # it reports that mode
    TAKEN = "taken"  # somebody else changed the mode: hands off


class Pilot(Enum):
    """Who holds the transmitter of a vehicle in a mode that its sticks move."""

    NONE = "none"  # no transmitter, or a mode that no stick moves
    PRESENT = "present"  # a transmitter that somebody holds, its sticks at rest
    FLYING = "flying"  # its sticks have moved lately


class ReleaseMode(Enum):
    """What the autopilot shall do alone when this agent leaves."""

    HOLD = "hold"
    RETURN = "return"
    LAND = "land"
    DEPART = "depart"  # hold or come home, with nobody on board who could think again


class Note(NamedTuple):
    """Something that a person should know of an adapter: the agent publishes it as an event."""

    severity: str  # info | warning | error
    kind: str  # the same word for the same thing, for programs
    text: str


class Step(NamedTuple):
    """What one step wants done: messages to send, in order, and notes."""

    messages: tuple[Outgoing, ...] = ()
    notes: tuple[Note, ...] = ()


class Refusal(NamedTuple):
    """Why no adapter flies this autopilot."""

    reason: str


class Adapter(Protocol):
    """One kind of autopilot: setpoints and intentions in, messages out."""

    @property
    def name(self) -> str:
        """Its name in configuration: a key of `choose.SCHEMES`."""
        ...

    @property
    def kind(self) -> Kind:
        """The autopilot it was made for."""
        ...

    @property
    def stage(self) -> Stage:
        """Who flies."""
        ...

    @property
    def failsafe(self) -> bool:
        """Whether, in TAKEN, the autopilot's own failsafe took it, and no person."""
        ...

    @property
    def handed(self) -> bool:
        """Whether the pilot's switch chose the guided mode that the vehicle is in."""
        ...

    def pilot(self, now: float) -> Pilot:
        """Return whether a pilot flies by his sticks."""
        ...

    @property
    def holds_airspeed(self) -> bool:
        """True where a constant speed means airspeed (planes); else groundspeed, and the wind is 0 to it."""
        ...

    @property
    def guided_mode(self) -> str:
        """The mode in which setpoints count, in the autopilot's words."""
        ...

    def enter(self, now: float) -> None:
        """Ask for the guided mode until the heartbeat reports it, also after TAKEN."""
        ...

    def leave(self, now: float, mode: ReleaseMode) -> None:
        """End the setpoints and ask for a mode that the autopilot flies alone, until it reports it."""
        ...

    def forget(self, now: float) -> None:
        """Ask for the guided mode, and for arming, no more: nobody wants them now. It changes no mode."""
        ...

    def end(self, now: float) -> None:
        """End the stream of setpoints for want of a decision. It changes no mode."""
        ...

    def arm(self, now: float) -> bool:
        """Ask for arming until the heartbeat reports it; return False, and send nothing, unless `may_arm`."""
        ...

    def answers_in(self, took: float) -> None:
        """Hear how long the autopilot took to answer another command [s]."""
        ...

    def acknowledge(self, now: float, ack: CommandAck) -> None:
        """Hear the autopilot's answer to a command."""
        ...

    def close(self) -> None:
        """Release what it holds (a child process); idempotent. Does not change the mode: `leave` does."""
        ...

    def step(self, now: float, telemetry: Telemetry, setpoint: Setpoint | None) -> Step:
        """Return the messages due now. `setpoint` None: none is allowed now, and none is sent."""
        ...
