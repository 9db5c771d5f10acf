"""Aircraft files: what comes with the distribution, and what is refused with its reason."""

from __future__ import annotations

from math import radians
from pathlib import Path

import pytest

from onboard.config.strict import ConfigError
from onboard.core.math.states import VehicleLimits
from onboard.runtime.resources import configs
from sim_bridge.vehicle.flight.aircraft import load, named, within
from sim_bridge.vehicle.flight.plane import PathModel

NOSE = (configs() / "aircraft" / "nose.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize("path", sorted((configs() / "aircraft").glob("*.toml")), ids=lambda p: p.stem)
def test_every_aircraft_of_the_distribution_loads(path: Path) -> None:
    aircraft = load(path)
    assert PathModel(aircraft.model.path).name.lower() == path.stem == aircraft.spec.name


BAD = [
    ("[0.139, 0.537, 1.0]", "[0.139, -0.537, 1.0]", "pitch.denominator", "unstable"),
    ("[1.0, 1.1, 4.2]", "[1.0, 1.1, -4.2]", "yaw.denominator", "unstable"),
    ("[1.0, 1.1, 4.2]", "[1.1, 4.2]", "yaw.denominator", "degree 2"),
    ("[-0.753, -1.213]", "[1.0, 0.0, -0.753, -1.213]", "pitch.elevator", "improper"),
    ("[-4.1253, 0.0]", "[1.0, 0.0, -4.1253, 0.0]", "yaw.wind_z", "improper"),
    ("[-4.1253, 0.0]", "[4.1253, 0.0]", "yaw.wind_z", "the nose turns into the relative wind"),
    ("[-4.1253, 0.0]", "[-0.072, 0.0]", "yaw.wind_z", "angles are in degrees"),
    ("[-4.1253, 0.0]", "[0.072, 0.175]", "yaw.wind_z", "expected about -5.15 by the denominator"),
    ("[-4.1253, 0.0]", "[0.175]", "yaw.wind_z", "found 0 deg/s² per m/s"),
    ("[-0.355, 0.0]", "[0.355, 0.0]", "pitch.wind_y", "the nose turns into the relative wind"),
    ("[-4.5, -0.75]", "[-4.5, 0.0]", "yaw.rudder", "no steady effect"),
    ("rate_gain = -1.2", "rate_gain = 1.2", "yaw_loop.rate_gain", "sign"),
    ("rate_gain = -1.2", "rate_gain = -60.0", "yaw_loop", "unstable"),
    ("rate_hz = 100.0", "rate_hz = 50.0", "rate_hz", "[100, 2000] Hz"),
    ('path = "nose"', 'path = "tail"', "path", "one of: nose, slip, coordinated"),
    ("limit_deg = 25.0", "limit_deg = -25.0", "elevator.limit_deg", "positive"),
    ("acceleration_min = -4.0", "acceleration_min = 4.0", "speed.acceleration_min", "negative"),
    ("pitch_max_deg = 25.0", "pitch_max_deg = -30.0", "limits.pitch_min_deg", "min < max"),
    ("speed_max = 60.0", "speed_max = 10.0", "limits.speed_min", "min < max"),
    ("trim = 45.0", "trim = 70.0", "speed.trim", "within the limits"),
    ("trim = 45.0", "trim = nan", "speed.trim", "finite"),
    ("drag = 0.05", "drag = 0.05\nwings = 2", "speed.wings", "unknown key"),
    ("trim = 45.0", "", "trim", "missing"),
]


@pytest.mark.parametrize(("found", "put", "key", "reason"), BAD)
def test_what_cannot_fly_is_refused_with_its_reason(
    tmp_path: Path, found: str, put: str, key: str, reason: str
) -> None:
    assert found in NOSE
    path = tmp_path / "bad.toml"
    path.write_text(NOSE.replace(found, put, 1), encoding="utf-8")
    with pytest.raises(ConfigError) as error:
        load(path)
    text = str(error.value)
    assert text.startswith(f"{path}: ")
    assert key in text
    assert reason in text
    assert "\n" not in text


def test_a_vehicle_s_own_limits_narrow_those_of_the_aircraft() -> None:
    model = named("nose").model
    narrow = within(model, VehicleLimits(30.0, 50.0, radians(-10.0), radians(60.0)))
    assert (narrow.speed_min, narrow.speed_max) == (30.0, 50.0)
    assert narrow.pitch_min == radians(-10.0)
    assert narrow.pitch_max == model.pitch_max
