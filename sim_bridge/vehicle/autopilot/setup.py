"""What an autopilot is made from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from numpy.random import Generator

from onboard.game.scenario import Firmware, Kind
from onboard.wire.geodesy import Frame, Geodetic
from onboard.wire.mavlink.signing import Signing
from sim_bridge.vehicle.motion import Motion
from sim_bridge.vehicle.wind.estimate import Errors


class Options(NamedTuple):
    """What may be chosen about an autopilot whatever vehicle it flies."""

    airborne: bool = True  # whether it starts flying and armed, in LOITER or HOLD
    epoch_ns: int = 0  # wall instant at now_ns = 0
    ready_s: float = 12.0  # a ground start's time from boot until arming is accepted [s]
    battery_s: float = 1200.0  # from full to empty in flight [s]
    parameters: Mapping[str, float] = {}  # in place of the defaults
    signing: Signing | None = None  # of all frames sent; None: frames are not signed
    throttle: float | None = 0.5  # of the pilot's stick, 0…1 (0.5 centred); None: no transmitter is heard
    answer_delay_s: tuple[float, float] = (0.0, 0.0)  # least and most time from a command to its answer [s]
    generator: Generator | None = None  # draws the delays; None: each takes the least
    batteries: int = 1
    firmware: Firmware = Firmware.RECORDED
    gimbal: bool = False  # whether component 154 of the vehicle's own system sends heartbeats
    other_station_hz: float = 0.0  # rate of all streams that a second ground station asks for [Hz]; 0: none
    full_streams: bool = False  # whether PX4 streams all that a real one does by default: 22 kB/s
    wind_errors: Errors | None = None  # of its estimate of the wind; None: it knows the mean wind
    healthy_share: float = 0.6  # of `ready_s`, after which the pre-arm bit is set: before arming is accepted

    @property
    def healthy_s(self) -> float:
        """A ground start's time from boot until the pre-arm bit says healthy [s]."""
        return self.healthy_share * self.ready_s


class Setup(NamedTuple):
    """One vehicle, as its autopilot is delivered.

    `origin` is that of the autopilot's own local frame: it differs from the game's, as it does
    between real vehicles, which set it where their own receiver found its first fix.
    """

    kind: Kind
    system: int  # MAVLink system id; the component is always 1
    frame: Frame  # the game's, in which motion is given
    start: Motion
    home: Geodetic  # where RTL leads
    origin: Geodetic  # of LOCAL_POSITION_NED
    speed_min: float  # [m/s; air] of planes: AIRSPEED_MIN
    speed_max: float  # [m/s; air]
    speed_cruise: float  # [m/s; air] flown when nothing else is asked
    bank_max_deg: float  # of planes: ROLL_LIMIT_DEG
    pitch_min_deg: float  # of planes: PTCH_LIM_MIN_DEG
    pitch_max_deg: float
    options: Options
