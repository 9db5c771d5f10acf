"""Report, exports and comparison of a game of three evaders with zones, read by readers of their own."""

from __future__ import annotations

import json
import re
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pymap3d
import pytest
from mcap.reader import make_reader

import gcs
from gcs.export.compare import compare
from gcs.export.formats import Format
from gcs.export.program import export
from gcs.page.replay import curves
from gcs.report.data import Run
from gcs.report.drawing import style
from gcs.report.figures import plan
from gcs.report.hindsight import missed_captures
from gcs.report.page import page
from gcs.report.program import read_run
from onboard.game import hindsight
from onboard.wire.bus.messages import OutcomeResult
from tests.support.run_folders import make_run
from tests.support.three_on_ten import AFTER, EVADERS, TARGETS, ZONES, R, flight

KML = "{http://www.opengis.net/kml/2.2}"
ORIGIN = (47.397742, 8.545594, 488.0)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_run(tmp_path_factory.mktemp("runs") / "run", list(flight()))


@pytest.fixture(scope="module")
def values(run: Path) -> Run:
    return read_run(run)


def test_the_report_tells_each_evaders_end(values: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hindsight, "MOST", 50)  # instants: each costs the number of pursuers to the fourth
    assert {fate.id: fate.verdict for fate in values.fates} == {
        1: OutcomeResult.CAPTURED, 12: OutcomeResult.ARRIVED, 13: OutcomeResult.ESCAPED,
    }  # fmt: skip
    with style():
        missed = missed_captures(values)
        above = plan(values)
    assert above is not None
    assert [drawing.title for drawing in missed] == [
        "Why evader 12 was not captured", "Why evader 13 was not captured",
    ]  # fmt: skip
    text = page(values, [above])
    rings = [patch for patch in above.figure.axes[0].patches if getattr(patch, "radius", None) == R]
    assert len(rings) == 3, "the capture radius around each evader"
    assert "<h1>3 evaders: 1 captured, 1 arrived, 1 escaped after 34.0 s</h1>" in text
    table = text.partition("id='evaders'")[2].partition("</section>")[0]
    rows = re.findall(r"<tr>(.*?)</tr>", table)[1:]
    assert len(rows) == 3
    assert "captured" in rows[0]
    assert "pursuer 2" in rows[0]
    assert "260, 330, 50; 330, 140, 50" in rows[1]
    data = json.loads(re.search(r"id='flight'>(.*?)</script>", text)[1].replace("<\\/", "</"))
    assert [goal["name"] for goal in data["scene"]["field"]["targets"]] == [
        "target of 1", "target 1 of 12", "target 2 of 12", "target of 13",
    ]  # fmt: skip
    assert [zone["name"] for zone in data["scene"]["field"]["zones"]] == ["mast", "village"]


def test_distances_are_those_to_the_nearest_evader_that_plays(values: Run) -> None:
    ends = {fate.id: fate.time_s for fate in values.fates}
    for gap in values.gaps():
        own = values.flown[gap.id]
        for t, said in list(zip(gap.t, gap.distance, strict=True))[::17]:
            here = [np.interp(t, own.t, own.position[:, axis]) for axis in range(3)]
            playing = [id for id in EVADERS if t <= ends[id]] or list(EVADERS)
            there = [
                [np.interp(t, way.t, way.position[:, axis]) for axis in range(3)]
                for way in map(values.flown.__getitem__, playing)
            ]
            nearest = min(np.linalg.norm(np.subtract(here, place)) for place in there)
            assert said == pytest.approx(nearest, abs=0.05)
    assert values.nearest()[2] < 8.0, "it captured"


def test_the_curves_of_a_replay_have_a_band_for_each_evader(values: Run) -> None:
    told = curves(values, {1: [(values.t0_ns, 1.0)], 12: [(values.t0_ns, 2.0)]})
    band = next(curve for curve in told if curve["name"] == "widest free gap of each evader")
    assert {line["id"]: line["y"] for line in band["lines"]} == {1: [57.3], 12: [114.59]}
    assert "distance to the nearest evader" in {curve["name"] for curve in told}


def test_a_change_of_quarry_ends_a_band_of_rules(values: Run) -> None:
    said = [band.why.rpartition(" ")[2] for band in values.rules[2]]
    assert said[0] == "1"
    assert len(said) > 1, "evader 1 was captured: it went after another one"


@pytest.fixture(scope="module")
def written(run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("out")
    export(run, [Format.KML, Format.GEOJSON, Format.CZML, Format.CSV], folder, ())
    return folder


def on_earth(north: float, east: float, up: float) -> tuple[float, float, float]:
    """Latitude, longitude, height, by another library."""
    return pymap3d.ned2geodetic(north, east, -up, *ORIGIN)


def test_every_target_and_zone_is_on_the_globe(written: Path) -> None:
    found = json.loads((written / "run.geojson").read_text())["features"]
    targets = [f for f in found if f["properties"]["kind"] == "target"]
    assert [f["properties"]["evader"] for f in targets] == [1, 12, 12, 13]
    goals = [goal for id in EVADERS for goal in TARGETS[id]]
    for feature, (north, east, down) in zip(targets, goals, strict=True):
        lat, lon, height = on_earth(north, east, -down)
        east_deg, north_deg, up = feature["geometry"]["coordinates"]
        assert (east_deg, north_deg) == pytest.approx((lon, lat), abs=1e-7)
        assert up == pytest.approx(height, abs=0.1), "the frame is level, the Earth is round"
    zones = [f for f in found if f["properties"]["kind"] == "zone"]
    assert [f["properties"]["name"] for f in zones] == ["mast", "village"]
    assert "ceiling_m" in zones[0]["properties"]
    assert "ceiling_m" not in zones[1]["properties"], "it has no end"
    for feature, zone in zip(zones, ZONES, strict=True):
        (ring,) = feature["geometry"]["coordinates"]
        assert ring[0] == ring[-1]
        area = sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(ring))
        assert area > 0.0, "against the clock, as the RFC asks"
        corners = {on_earth(n, e, 0.0)[:2] for n, e in zone.polygon}
        for lat, lon in corners:
            assert min(abs(lat - place[1]) + abs(lon - place[0]) for place in ring) < 1e-6


def test_globes_show_zones_as_bodies(written: Path) -> None:
    root = ET.fromstring((written / "run.kml").read_bytes())
    names = [mark.findtext(f"{KML}name") for mark in root.iter(f"{KML}Placemark")]
    assert "target 2 of 12" in names
    bodies = [mark for mark in root.iter(f"{KML}Placemark") if mark.find(f"{KML}Polygon") is not None]
    assert [body.findtext(f"{KML}name").partition(",")[0] for body in bodies] == ["zone mast", "zone village"]
    modes = [body.findtext(f"{KML}Polygon/{KML}altitudeMode") for body in bodies]
    assert modes == ["absolute", "clampToGround"]
    packets = {packet["id"]: packet for packet in json.loads((written / "run.czml").read_text())}
    mast = packets["zone-0"]["polygon"]
    assert (mast["height"], mast["extrudedHeight"]) == (488.0, 488.0 + 90.0)
    corners = np.reshape(mast["positions"]["cartographicDegrees"], (-1, 3))
    for corner, (north, east) in zip(corners, ZONES[0].polygon, strict=True):
        lat, lon, _ = on_earth(north, east, 0.0)
        assert corner[:2] == pytest.approx((lon, lat), abs=1e-6)
    assert packets["target-2"]["name"] == "target 2 of 12"


def test_decisions_name_the_quarry(run: Path) -> None:
    decisions = gcs.load(run).decisions.of(6)
    assert set(decisions["quarry_id"]) <= {0, 1, 12, 13}
    assert decisions["quarry_id"][0] == AFTER[6]


def test_viewers_draw_targets_and_zones(run: Path) -> None:
    entities: dict[str, dict] = {}
    with (run / "recording.mcap").open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages(topics=["/scene"]):
            assert channel.topic == "/scene"
            for entity in json.loads(message.data)["entities"]:
                entities[entity["id"]] = entity
    texts = {id: entity["texts"][0]["text"] for id, entity in entities.items() if id.startswith("target")}
    assert sorted(texts.values()) == ["target 1 of 12", "target 2 of 12", "target of 1", "target of 13"]
    assert len(entities["zone-0"]["lines"]) == 2 + len(ZONES[0].polygon)


def test_two_runs_are_compared_evader_by_evader(run: Path) -> None:
    text = "\n".join(compare(run, run).lines())
    for id, words in ((1, "captured by 2"), (12, "arrived"), (13, "escaped")):
        assert re.search(rf"evader {id}\s+{words} at ", text), text[:800]
    assert re.search(r"pursuer 2 nearest \[m\]\s+[0-7]\.\d", text)
