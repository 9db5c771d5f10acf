"""Types of configuration values with their ranges, and the words in which a range is told.

Upper bounds lie far beyond any aircraft of this project's; they keep sums and squares of values finite.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

Share = Annotated[float, Meta(ge=0, le=1, description="a share in [0, 1]")]
PartialShare = Annotated[float, Meta(ge=0, lt=1, description="a share in [0, 1)")]

Coordinate = Annotated[float, Meta(ge=-1e6, le=1e6, description="−1 000 000 to 1 000 000 m")]
Distance = Annotated[float, Meta(ge=0, le=1e6, description="zero or more [m], at most 1 000 000")]
PositiveDistance = Annotated[
    float, Meta(gt=0, le=1e6, description="a positive distance [m], at most 1 000 000")
]
Speed = Annotated[float, Meta(ge=0, le=1000, description="zero or more [m/s], at most 1000")]
PositiveSpeed = Annotated[float, Meta(gt=0, le=1000, description="a positive speed [m/s], at most 1000")]
Acceleration = Annotated[float, Meta(ge=0, le=1000, description="zero or more [m/s²], at most 1000")]
PositiveAcceleration = Annotated[
    float, Meta(gt=0, le=1000, description="a positive acceleration [m/s²], at most 1000")
]

Duration = Annotated[float, Meta(ge=0, le=86400, description="zero or more [s], at most 86400")]
PositiveDuration = Annotated[float, Meta(gt=0, le=86400, description="a duration in (0, 86400] s")]
Rate = Annotated[float, Meta(gt=0, le=1000, description="a positive rate [Hz], at most 1000")]
ControlRate = Annotated[float, Meta(gt=0, le=50, description="a rate in (0, 50] Hz")]

# A pole has no north, and so no game frame.
Latitude = Annotated[float, Meta(gt=-90, lt=90, description="a latitude between −90 and 90 deg, no pole")]
Longitude = Annotated[float, Meta(ge=-180, le=180, description="a longitude in [−180, 180] deg")]
Altitude = Annotated[float, Meta(ge=-500, le=50_000, description="−500 to 50 000 m above mean sea level")]
PitchDeg = Annotated[float, Meta(ge=-90, le=90, description="an angle in [−90, 90] deg")]
YawDeg = Annotated[float, Meta(ge=-360, le=360, description="an angle in [−360, 360] deg")]
TurnRateDeg = Annotated[float, Meta(gt=0, le=3600, description="a positive rate [deg/s], at most 3600")]

TimeStep = Annotated[float, Meta(gt=0, le=1, description="a time step in (0, 1] s")]
Epochs = Annotated[int, Meta(ge=1, le=1_000_000, description="a whole number from 1 to 1 000 000")]
Count = Annotated[int, Meta(ge=1, le=1_000_000, description="a whole number from 1 to 1 000 000")]
Flights = Annotated[int, Meta(ge=2, le=1_000_000, description="a whole number from 2 to 1 000 000")]
Pressure = Annotated[float, Meta(ge=870, le=1085, description="870 to 1085 hPa")]
Undulation = Annotated[float, Meta(ge=-110, le=90, description="−110 to 90 m")]
ListenTime = Annotated[float, Meta(ge=0, le=600, description="0 to 600 s")]
HttpPort = Annotated[int, Meta(ge=0, le=65535, description="a port, 0 to 65535")]
WaitTime = Annotated[float, Meta(ge=0.1, le=3600, description="0.1 to 3600 s")]

SystemId = Annotated[int, Meta(ge=1, le=250, description="a MAVLink system id from 1 to 250")]
SEED_MAX = 2**63 - 1
Seed = Annotated[int, Meta(ge=0, le=SEED_MAX, description="a whole number from 0 to 2^63 − 1")]
GpsFix = Annotated[int, Meta(ge=0, le=6, description="a MAVLink GPS_FIX_TYPE from 0 to 6")]

NotNegative = Annotated[float, Meta(ge=0, le=1e9, description="zero or more, at most 1e9")]
Positive = Annotated[float, Meta(gt=0, le=1e9, description="a positive number, at most 1e9")]
