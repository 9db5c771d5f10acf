"""Fences as the field's tools write them become the game's; what encloses nothing is refused."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from pymavlink import mavutil, mavwp

from gcs.fence import show
from onboard.config.strict import ConfigError, parse
from onboard.core.math.vectors import Vec
from onboard.game.fence_file import GeoFence, polygon_in, read_fence
from onboard.game.scenario import Scenario, load
from onboard.wire.geodesy import Frame
from onboard.wire.mavlink.dialect import dialect
from sim_bridge.programs.scenario_tools import check
from tests.support.real_time import patience

ORIGIN = (47.397742, 8.545594, 488.0)
LAT, LON = 200.0 / 111_175.0, 200.0 / 75_400.0  # 200 m there, to a metre
CORNERS = (
    (ORIGIN[0] - LAT, ORIGIN[1] - LON),
    (ORIGIN[0] - LAT, ORIGIN[1] + LON),
    (ORIGIN[0] + LAT, ORIGIN[1] + LON),
    (ORIGIN[0] + LAT, ORIGIN[1] - LON),
)
SQUARE = ((-200.0, -200.0), (-200.0, 200.0), (200.0, 200.0), (200.0, -200.0))
GAME = """name = "f"
[evader]
position = [0.0, 0.0]
speed = 5.0
target = [100.0, 0.0]
[[pursuers]]
position = [60.0, 20.0]
speed = 6.0
[flight.fence]
height_min = 20.0
height_max = 80.0
"""


def plan(**fence: Any) -> str:
    """A QGroundControl plan with a fence, and a mission that nobody asks for."""
    whole = {
        "fileType": "Plan", "groundStation": "QGroundControl", "version": 1,
        "geoFence": {"circles": [], "polygons": [], "version": 2, **fence},
        "mission": {"items": [], "version": 2}, "rallyPoints": {"points": [], "version": 2},
    }  # fmt: skip
    return json.dumps(whole, indent=4)


def area(corners: Any = CORNERS, *, inclusion: bool = True) -> dict[str, Any]:
    return {"inclusion": inclusion, "polygon": [list(corner) for corner in corners], "version": 1}


def around(radius: float, *, inclusion: bool = True) -> dict[str, Any]:
    return {"circle": {"center": list(ORIGIN[:2]), "radius": radius}, "inclusion": inclusion, "version": 1}


def kml(ring: Any = CORNERS, more: str = "", tag: str = "Polygon") -> str:
    """A polygon as Google Earth draws it: longitude first, the first corner again at the end."""
    closed = " ".join(f"{lon:.9f},{lat:.9f},0" for lat, lon in [*ring, ring[0]])
    inner = (
        f"<outerBoundaryIs><LinearRing><coordinates>\n{closed}\n</coordinates></LinearRing></outerBoundaryIs>"
    )
    body = inner if tag == "Polygon" else f"<coordinates>{closed}</coordinates>"
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<kml xmlns="http://www.opengis.net/kml/2.2"><Document>'
        f"<Placemark><name>field</name><{tag}>{body}{more}</{tag}></Placemark></Document></kml>"
    )


def points(path: Path, corners: Any = CORNERS) -> None:
    """Saved by pymavlink's own loader of fences, as MAVProxy's `fence save` does."""
    loader = mavwp.MAVFenceLoader()
    for lat, lon in [ORIGIN[:2], *corners, corners[0]]:
        loader.add_latlon(lat, lon)
    loader.save(str(path))


def items(
    path: Path, command: int = dialect.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, count: int = 4
) -> None:
    """Saved by pymavlink's own loader of waypoints, as today's MAVProxy saves a fence."""
    loader = mavwp.MAVWPLoader()
    for index, (lat, lon) in enumerate(CORNERS):
        loader.add(
            mavutil.mavlink.MAVLink_mission_item_message(
                1, 1, index, 3, command, 0, 1, count, 0, 0, 0, lat, lon, 0
            )
        )
    loader.save(str(path))


def polygon(path: Path) -> tuple[tuple[float, float], ...]:
    return polygon_in(read_fence(path), Frame(*ORIGIN), "f")


def test_each_tools_fence_becomes_the_same_square(tmp_path: Path) -> None:
    (tmp_path / "a.plan").write_text(plan(polygons=[area()]))
    (tmp_path / "old.plan").write_text(plan(polygon=[list(corner) for corner in CORNERS]))
    (tmp_path / "bom.plan").write_text(plan(polygons=[area()]), encoding="utf-8-sig")
    (tmp_path / "a.kml").write_text(kml())
    (tmp_path / "blanks.kml").write_text(kml().replace(",", ", "))
    (tmp_path / "line.kml").write_text(kml(tag="LineString"))
    points(tmp_path / "fence.txt")
    items(tmp_path / "items.txt")
    for file in sorted(tmp_path.iterdir()):
        found = polygon(file)
        assert len(found) == 4, file
        for corner, expected in zip(found, SQUARE, strict=True):
            assert corner == pytest.approx(expected, abs=1.0), file


def test_a_circle_is_a_polygon_within_it(tmp_path: Path) -> None:
    (tmp_path / "a.plan").write_text(plan(circles=[around(150.0)]))
    found = polygon(tmp_path / "a.plan")
    radii = [(north * north + east * east) ** 0.5 for north, east in found]
    assert len(found) == 36
    assert (min(radii), max(radii)) == pytest.approx((150.0, 150.0), abs=0.1)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (plan(), "no fence, expected one fence to stay in"),
        (plan(polygons=[area(), area()]), "2 fences to stay in"),
        (plan(polygons=[area()], circles=[around(50.0)]), "2 fences to stay in"),
        (plan(polygons=[area(inclusion=False)]), "no fence, expected one fence to stay in"),
        (plan(polygons=[area(CORNERS[:2])]), "2 corners, expected three"),
        (
            plan(polygons=[area([(lon + 90, lat) for lat, lon in CORNERS])]),
            r"degrees on Earth \(exchanged\?\)",
        ),
        ('{"geoFence": 5}', "no plan"),
        ("{" * 20_000, "no plan"),
        (kml(more="<innerBoundaryIs/>"), "1 holes"),
        (kml().replace(" 8.5", " x8.5", 1).replace("\n8.5", "\nx8.5", 1), "expected 3 numbers"),
        ("<kml>", "no XML"),
        ('<!DOCTYPE k [<!ENTITY a "b">]><kml/>', "entities"),
        ("PK\x03\x04", "unzip"),
        ("47.1 8.1\n47.2 8.2\n", "2 points"),
        ("47.1 8.1\n47.2 8.2\n47.3 8.2\n47.3 8.4\n47.3 8.5\n", "not closed"),
        ("hello\n", "expected 2 numbers a line, or a QGroundControl"),
        ("", "expected a QGroundControl"),
    ],
)
def test_what_is_no_fence_for_a_game_is_refused_with_the_reason(
    tmp_path: Path, text: str, reason: str
) -> None:
    file = tmp_path / "fence"
    file.write_text(text)
    with pytest.raises(ConfigError, match=reason) as caught:
        read_fence(file)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(f"{file}: ")


@pytest.mark.parametrize(
    ("command", "count", "reason"),
    [
        (dialect.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION, 4, "no fence, expected one"),
        (dialect.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION, 5, "fewer corners"),
        (dialect.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, 5, "fewer corners"),
        (dialect.MAV_CMD_NAV_WAYPOINT, 4, "command 16"),
    ],
)
def test_items_that_are_no_whole_fence_are_refused(
    tmp_path: Path, command: int, count: int, reason: str
) -> None:
    items(tmp_path / "items.txt", command, count)
    with pytest.raises(ConfigError, match=reason):
        read_fence(tmp_path / "items.txt")


def scenario(tmp_path: Path, line: str) -> Scenario:
    """A game in a file of its own, with one more line in its fence."""
    file = tmp_path / "game.toml"
    file.write_text(GAME + line + "\n")
    return load(file)


def moved(north: float, size: float) -> list[tuple[float, float]]:
    """The square of the field, smaller and farther north [m]."""
    frame = Frame(*ORIGIN)
    corners = [(north + size, -size), (north + size, size), (north - size, size), (north - size, -size)]
    places = [frame.geodetic_from_ned(Vec(x, y, 0.0)) for x, y in corners]
    return [(place.latitude_deg, place.longitude_deg) for place in places]


def test_what_another_tool_keeps_out_of_becomes_zones(tmp_path: Path) -> None:
    polygons = [area(), area(moved(80.0, 10.0), inclusion=False)]
    middle = {"center": list(moved(-90.0, 0.0)[0]), "radius": 12.0}
    out = {"circle": middle, "inclusion": False, "version": 1}
    (tmp_path / "area.plan").write_text(plan(polygons=polygons, circles=[out]))
    found = scenario(tmp_path, 'file = "area.plan"')
    block, disc = found.zones
    assert block.polygon is not None
    assert disc.centre is not None
    for corner, expected in zip(block.polygon, [(90, -10), (90, 10), (70, 10), (70, -10)], strict=True):
        assert corner == pytest.approx(expected, abs=0.1)
    assert (*disc.centre, disc.radius) == pytest.approx((-90.0, 0.0, 12.0), abs=0.1)
    assert len(found.rules.zones.areas) == 2
    bent = [*moved(80.0, 10.0)[:2], moved(80.0, 0.0)[0], *moved(80.0, 10.0)[2:]]
    (tmp_path / "area.plan").write_text(plan(polygons=[area(), area(bent, inclusion=False)]))
    with pytest.raises(ConfigError, match=r"keep out 1: polygon: found corner .* bends inwards"):
        scenario(tmp_path, 'file = "area.plan"')


def test_a_scenario_names_the_file_beside_it(tmp_path: Path) -> None:
    (tmp_path / "area.plan").write_text(plan(polygons=[area()]))
    found = scenario(tmp_path, 'file = "area.plan"').flight.fence
    typed = scenario(tmp_path, f"polygon = {json.dumps([list(corner) for corner in SQUARE])}").flight.fence
    assert found is not None
    assert typed is not None
    assert (found.file, found.height_min, found.height_max) == ("", 20.0, 80.0)
    for corner, expected in zip(found.polygon, typed.polygon, strict=True):
        assert corner == pytest.approx(expected, abs=1.0)


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("polygon = [[-200,-200],[200,200],[200,-200],[-200,200]]", "edges from corners 1 and 3 that cross"),
        ("polygon = [[0,0],[100,0],[200,0]]", "on one line"),
        ("polygon = [[0,0],[100,0],[200,0.001]]", "on one line"),
        ("polygon = [[0,0],[3,0],[3,0.3]]", "area of"),
        ("polygon = [[-9,-9],[-9,200],[200,200],[200,-9],[0,0],[200,100]]", "cross"),
        ("polygon = [[47.3977,8.5456],[47.3987,8.5456],[47.3987,8.5476],[47.3977,8.5476]]", "degrees"),
        (
            "polygon = [[500,500],[500,900],[900,900],[900,500]]",
            r"evader\.position: .*outside flight\.fence",
        ),
        (
            "polygon = [[-50,-50],[-50,50],[50,50],[50,-50]]",
            r"pursuers\[0\]\.position: .*\[60, 20\] at 50 m",
        ),
        ("", "neither of polygon and file"),
        ('file = "no.plan"', "no such file"),
    ],
)
def test_a_fence_that_encloses_nothing_or_nobody_is_refused(tmp_path: Path, line: str, reason: str) -> None:
    with pytest.raises(ConfigError, match=reason):
        scenario(tmp_path, line)


def test_a_target_outside_is_warned_of(tmp_path: Path) -> None:
    near = scenario(tmp_path, "polygon = [[-90,-90],[-90,90],[90,90],[90,-90]]")
    assert "the target lies outside flight.fence" in check(near)
    assert "outside" not in check(scenario(tmp_path, f"polygon = {json.dumps(SQUARE)}"))


def test_a_ring_that_is_closed_is_a_fence(tmp_path: Path) -> None:
    closed = [list(corner) for corner in (*SQUARE, SQUARE[0])]
    assert scenario(tmp_path, f"polygon = {json.dumps(closed)}").flight.fence is not None


def test_heights_and_ground_starts_are_judged() -> None:
    low = GAME.replace("height_min = 20.0", "height_min = 60.0") + f"polygon = {json.dumps(SQUARE)}\n"
    with pytest.raises(ConfigError, match="at 50 m, outside"):
        parse(low, Scenario, "g")
    assert parse("flight.ground_start = true\n" + low, Scenario, "g").flight.ground_start


def test_a_fence_of_another_place_is_refused(tmp_path: Path) -> None:
    far = GeoFence(tuple((lat + 2.0, lon) for lat, lon in CORNERS), "plan")
    with pytest.raises(ConfigError, match=r"22\d km from flight\.origin"):
        polygon_in(far, Frame(*ORIGIN), "area.plan")


@pytest.mark.real
def test_gcs_fence_prints_what_a_scenario_takes(tmp_path: Path) -> None:
    (tmp_path / "area.kml").write_text(kml())
    (tmp_path / "bow.kml").write_text(kml(tuple(CORNERS[i] for i in (0, 2, 1, 3))))
    game = tmp_path / "game.toml"
    game.write_text(GAME + f"polygon = {json.dumps(SQUARE)}\n")

    def gcs(*words: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "gcs.cli", "fence", *words]
        return subprocess.run(command, capture_output=True, text=True, timeout=patience(10.0), check=False)

    assert "KML, 4 corners, 400 m north to south" in show(tmp_path / "area.kml", None)[0]
    run = gcs(str(tmp_path / "area.kml"), "--scenario", str(game))
    assert run.returncode == 0, run.stderr
    assert "all 2 vehicles of f start within it" in run.stdout
    table = run.stdout[run.stdout.index("[flight.fence]") :].split("\n\n")[0]
    assert parse(GAME.split("[flight.fence]")[0] + table, Scenario, "g").flight.fence is not None
    crossed = gcs(str(tmp_path / "bow.kml"))
    assert (crossed.returncode, "edges from corners 1 and 3 that cross" in crossed.stderr) == (2, True), (
        crossed
    )
