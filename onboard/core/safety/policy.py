"""Thresholds, actions and causes of the supervisor."""

from __future__ import annotations

from enum import IntEnum
from math import inf, pi
from typing import NamedTuple

from onboard.core.geometry.zones import NO_ZONES, Zones
from onboard.core.math.states import Mate
from onboard.core.math.vectors import ZERO, Vec


class Action(IntEnum):
    """What the supervisor does with a decision, in order of gravity."""

    PASS = 0  # the decision goes out as it is
    CLIP = 1  # the nearest thing that is allowed goes out
    HOLD = 2  # stay here: hover or loiter
    RETURN = 3  # the autopilot's own way home
    LAND = 4  # the autopilot's own landing, where the vehicle is
    END = 5  # end the stream of setpoints; what that means is the adapter's business


class Command(IntEnum):
    """What the adapter is to do: the supervisor alone says when a vehicle leaves the guided mode, and how."""

    STREAM = 0  # send the setpoint
    HOVER = 1  # send zero velocity: a multicopter holds under the agent's control
    RELEASE_TO_HOLD = 2  # leave the vehicle in the autopilot's own mode to hold
    RELEASE_TO_RETURN = 3  # … to fly home
    RELEASE_TO_LAND = 4  # … to land
    END_STREAM = 5  # send nothing more
    HANDS_OFF = 6  # a pilot, or the autopilot's own failsafe, flies: ask for nothing


class Cause(IntEnum):
    """Why: one per rule. Their words are in `words`."""

    NONE = 0
    SPEED = 1
    CLIMB = 2
    TURN = 3
    ACCELERATION = 4
    FENCE_AHEAD = 5
    CEILING_AHEAD = 6
    FLOOR_AHEAD = 7
    OUTSIDE_FENCE = 8
    SEPARATION = 9
    LAYER = 10
    NOT_FINITE = 11
    TELEMETRY = 12
    HEARTBEAT = 13
    TRACKS = 14
    STRATEGY = 15
    GROUND_STATION = 16
    CLOCK = 17
    BATTERY = 18
    EKF = 19
    GPS = 20
    PILOT = 21
    ORDER = 22
    FAR_OUTSIDE_FENCE = 23
    OVER = 24
    FAILSAFE = 25
    ZONE_AHEAD = 26
    INSIDE_ZONE = 27


class Envelope(NamedTuple):
    """What one vehicle may be asked to do. The speeds are airspeeds; a multicopter's are over ground."""

    hovers: bool = True  # a multicopter can stop; a plane can only turn
    speed_min: float = 0.0  # [m/s]
    speed_max: float = 10.0  # [m/s]
    climb_max: float = 3.0  # [m/s; up]
    sink_max: float = 2.0  # [m/s; down]
    turn_rate: float = pi  # of the demanded course [rad/s]; 0 = off
    acceleration: float = 6.0  # of the demanded velocity [m/s²]; 0 = off
    deceleration: float = 2.0  # what braking may be counted on [m/s²]
    turn_radius: float = 0.0  # planes: of a turn that may be counted on, in still air [m]


class Fence(NamedTuple):
    """A polygon of (north, east) [m] and a band of height above the origin [m]."""

    polygon: tuple[tuple[float, float], ...]
    low: float  # [m; up]
    high: float  # [m; up]


class Policy(NamedTuple):
    """Every threshold of the supervisor."""

    envelope: Envelope = Envelope()
    fences: tuple[Fence, ...] = ()  # all of them hold
    zones: Zones = NO_ZONES  # that are kept out of
    fence_margin: float = 5.0  # kept to the polygon, and to zones [m]
    height_margin: float = 3.0  # kept to floor and ceiling [m]
    fence_far: float = 30.0  # so far outside the autopilot flies home [m]
    reaction: float = 0.5  # from a decision to the vehicle's answer [s]
    coast: float = 0.0  # a multicopter whose agent dies flies on with its last velocity for so long [s]
    separation: float = 0.0  # kept to team mates [m]; 0 = off
    mate_age: float = 1.0  # a team mate unheard for longer counts with twice the separation [s]
    mate_forget: float = 10.0  # and after this not at all [s]
    layered: bool = False  # field profile: keep to a height of one's own
    layer: float = 0.0  # that height above the origin [m]
    layer_band: float = 5.0  # a vehicle this near to it is in its layer [m]
    telemetry_age: float = 0.5  # [s]
    heartbeat_age: float = 2.0  # [s]
    heartbeat_alone: float = 6.0  # the same while telemetry still comes: a lossy link loses beats [s]
    strategy_age: float = 0.2  # [s]
    track_sigma: float = 100.0  # stated position error of the worst track that is needed [m]
    track_action: Action = Action.HOLD
    track_latched: bool = False  # field profile: who loses the tracks breaks off for good
    ground_age: float = 5.0  # [s]
    ground_action: Action = Action.PASS  # PASS = the rule is off
    ground_return: float = inf  # silence of the ground after which the vehicle flies home for good [s]
    clock_jump: float = 0.2  # [s]
    clock_hold: float = 2.0  # a jump makes everybody hold for so long [s]
    battery: float = 0.2  # share left; 0 = off
    gps_fix: int = 3  # least acceptable (MAVLink GPS_FIX_TYPE); 0 = off
    settle: float = 1.0  # a cause must be gone for so long before its action ends [s]


class SupervisorInput(NamedTuple):
    """Everything the supervisor looks at in one step. Ages in seconds, of the local monotonic clock."""

    now: float  # monotonic [s]
    id: int  # own
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]
    wind: Vec = ZERO  # [m/s; where the air moves to]; ZERO for multicopters
    mates: tuple[Mate, ...] = ()
    telemetry_age: float = 0.0
    heartbeat_age: float = 0.0
    strategy_age: float = 0.0  # since the strategy's last sign of life
    track_sigma: float = 0.0  # [m]; 0 = no track is needed
    ground_age: float = 0.0
    clock_jump_age: float = inf  # since the wall clock last jumped
    battery: float = -1.0  # share left; −1 = unknown
    ekf_ok: bool = True
    gps_fix: int = 3
    pilot: bool = False  # somebody else changed the autopilot's mode
    failsafe: bool = False  # … and that was the autopilot's own failsafe
    order: Action = Action.PASS  # what the ground ordered
    over: bool = False  # what the vehicle was to do is done: nothing is left to fly
