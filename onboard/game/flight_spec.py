"""What stands around the vehicles of a scenario: place, sensor, links, wind, autopilots."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Annotated

import msgspec

from onboard.config.bounds import (
    Altitude,
    Distance,
    Duration,
    Latitude,
    Longitude,
    NotNegative,
    PartialShare,
    Rate,
    Share,
    Speed,
    YawDeg,
)
from onboard.config.strict import StrictConfig, demand


class Transmitter(Enum):
    """The pilot's transmitter of simulated vehicles, and where its throttle stick stands."""

    CENTRED = "centred"
    LOW = "low"  # as software in the loop without one: channels are healthy, throttle at 1000
    NONE = "none"  # no channel was ever heard


class Firmware(Enum):
    """Which generation of parameter names and commands a simulated autopilot has."""

    OLDER = "older"  # ArduPilot 4.4
    RECORDED = "recorded"  # ArduPilot 4.5.6, PX4 1.16
    NEWER = "newer"  # ArduPilot 4.7, PX4 1.18


class OriginSpec(StrictConfig, frozen=True):
    """Origin of the game frame (WGS-84; altitude above mean sea level)."""

    latitude_deg: Latitude = 47.397742  # of the origin [deg]
    longitude_deg: Longitude = 8.545594  # of the origin [deg]
    altitude_m: Altitude = 488.0  # of the origin, above mean sea level [m]


class SensorSpec(StrictConfig, frozen=True):
    """The simulated sensor that publishes tracks."""

    rate_hz: Rate = 10.0  # measurements a second of each vehicle [Hz]
    sigma: Distance = 0.0  # position noise, one sigma an axis [m]
    sigma_velocity: Speed = 0.0  # velocity noise [m/s]
    delay_s: Duration = 0.0  # from a measurement to its track on the bus [s]
    dropout: PartialShare = 0.0  # share of lost measurements


class ImpairmentSpec(StrictConfig, frozen=True):
    """What happens to datagrams (and, where `bus` says so, to the memory bus)."""

    loss: Share = 0.0  # share
    delay_s: Duration = 0.0  # of every datagram [s]
    jitter_s: Duration = 0.0  # at most so much more, drawn for each [s]
    duplication: Share = 0.0  # share
    reordering: Share = 0.0  # share
    burst_rate: NotNegative = 0.0  # bursts per second
    burst_s: Duration = 0.0  # mean length of a burst in which all is lost
    bit_error: Share = 0.0  # share of datagrams with a flipped bit
    bus: bool = False  # whether the memory bus suffers too

    def __post_init__(self) -> None:
        demand((self.burst_rate > 0) == (self.burst_s > 0), "burst_rate", f"{self.burst_rate:g} with burst_s"
               f" {self.burst_s:g}", "both or neither")  # fmt: skip


class WindSpec(StrictConfig, frozen=True):
    """Wind. `from_deg` is the direction it comes from, as pilots say it."""

    speed: Speed = 0.0  # mean, at 6 m (20 ft) above ground [m/s]
    from_deg: YawDeg = 0.0  # where it comes from, clockwise from north [deg]
    shear: bool = False  # MIL-F-8785C profile
    gust_sigma: Speed = 0.0  # σ of the Dryden gusts [m/s]
    correlation_m: Distance = 0.0  # 0 = each vehicle its own gusts
    recorded: str = ""  # CSV file in place of the model

    def __post_init__(self) -> None:
        modelled = self.speed or self.gust_sigma or self.correlation_m or self.shear
        demand(not (self.recorded and modelled), "recorded", f"{self.recorded!r} beside a modelled wind",
               "either of them")  # fmt: skip
        demand(self.gust_sigma > 0 or self.correlation_m == 0, "correlation_m", self.correlation_m,
               "0: there are no gusts (gust_sigma = 0)")  # fmt: skip
        demand(self.speed > 0 or not self.shear, "shear", "true", "false: there is no mean wind (speed = 0)")


class SimulatedSpec(StrictConfig, frozen=True):
    """What stands around every simulated autopilot, and how it is set up."""

    transmitter: Transmitter = Transmitter.CENTRED  # where every throttle stick stands
    answer_delay_s: Duration = 0.0  # least time from a command to its execution and answer
    answer_delay_max_s: Duration = 0.0  # most; each command draws its own, so that answers may cross
    batteries: Annotated[int, msgspec.Meta(ge=1, le=2, description="1 or 2 batteries")] = 1  # of each vehicle
    firmware: Firmware = Firmware.RECORDED  # generation of parameter names and commands
    gimbal: bool = False  # whether component 154 sends heartbeats with the vehicle's own system id
    other_station_hz: NotNegative = 0.0  # a second ground station asks for all streams at this rate; 0: none
    full_streams: bool = False  # whether PX4 streams by default what a real one does: 22 kB/s
    parameters: Mapping[str, float] = msgspec.field(default_factory=dict)  # of the autopilots that have them

    def __post_init__(self) -> None:
        most = self.answer_delay_max_s
        demand(most == 0.0 or most >= self.answer_delay_s, "answer_delay_max_s", most,
               f"0 or at least answer_delay_s = {self.answer_delay_s:g} s")  # fmt: skip
