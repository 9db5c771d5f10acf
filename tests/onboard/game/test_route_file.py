"""Route files: the one that comes with the distribution, and what is refused with its reason."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec, distance
from onboard.game.route_file import load_route
from onboard.runtime.resources import configs

TWENTY = configs() / "routes" / "twenty_km.toml"
TEXT = TWENTY.read_text(encoding="utf-8")


def test_the_twenty_kilometres_have_six_waypoints_after_the_start() -> None:
    route = load_route(TWENTY)
    points = route.waypoints
    assert len(points) == 7
    length = sum(distance(a.position, b.position) for a, b in pairwise(points))
    assert length == pytest.approx(20_000.0, rel=0.01)
    assert points[0].position == Vec(0.0, 0.0, -300.0)


BAD = [
    ("time = 83.3", "time = 40.0", r"waypoints\[1\].time: found unreachable: 3500 m in 40 s", "63.6 s"),
    ("time = 83.3", "time = 150.0", r"waypoints\[1\].time: found unreachable", "at most 116.7 s"),
    ("time = 83.3", "time = -1.0", r"waypoints\[1\].time", "zero or more"),
    ("3500.0, 0.0, 300.0", "3500.0, 0.0, -5.0", r"waypoints\[1\].position: found height -5 m", "above"),
    ("ground = 0.0", "ground = 310.0", r"waypoints\[0\].position: found height 300 m", "310 m"),
    ("3500.0, 0.0, 300.0", "1500.0, 0.0, 3300.0", r"waypoints\[1\].position: found unreachable", "deg"),
    ("3500.0, 0.0, 300.0", "0.0, 0.0, 300.0", r"waypoints\[1\].position", "another place"),
    ("nominal = 42.0", "nominal = 80.0", "nominal", "30 to 55 m/s"),
    ("speed_min = 30.0", "speed_min = 60.0", "speed_min", "min ≤ max"),
    ("nominal = 42.0", "nominal = 42.0\nspeed = 3", "speed", "unknown key"),
    ("3500.0, 0.0, 300.0", "3500.0, nan, 300.0", r"waypoints\[1\].position\[1\]", "finite"),
    ("3500.0, 0.0, 300.0", "3500.0, 0.0", r"waypoints\[1\].position", "expected 3 values"),
]


@pytest.mark.parametrize(("found", "put", "key", "expected"), BAD)
def test_a_route_nobody_can_fly_is_refused_with_the_reason(
    tmp_path: Path, found: str, put: str, key: str, expected: str
) -> None:
    assert found in TEXT
    path = tmp_path / "route.toml"
    path.write_text(TEXT.replace(found, put, 1), encoding="utf-8")
    with pytest.raises(ConfigError, match=key) as error:
        load_route(path)
    assert str(error.value).startswith(f"{path}: ")
    assert expected in str(error.value)


def test_a_route_without_waypoints_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "route.toml"
    path.write_text(
        'name = "none"\nnominal = 40.0\nspeed_min = 30.0\nspeed_max = 50.0\nwaypoints = []\n',
        encoding="utf-8",
    )
    with pytest.raises(ConfigError, match="waypoints: found \\[\\], expected a start and at least one more"):
        load_route(path)
