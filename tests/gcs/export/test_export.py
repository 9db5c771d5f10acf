"""A run for other programs: what was flown comes back from every format, read by readers of their own."""

from __future__ import annotations

import csv
import io
import itertools
import json
import re
import shutil
import sys
from datetime import datetime
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pymap3d
import pytest
from lxml import etree
from mcap.reader import make_reader

import gcs
from gcs.cli import app
from gcs.export.formats import Format
from gcs.export.program import export
from gcs.export.run_data import COLUMNS, RunData
from gcs.report.program import write_report
from onboard.config.strict import ConfigError
from onboard.wire.bus import topics
from onboard.wire.bus.messages import State
from sim_bridge.studies.tracks import recording_of
from tests.support.chase_messages import EPOCH_NS
from tests.support.paths import ROOT
from tests.support.run_folders import flight, make_run, make_tlogs

KML = "{http://www.opengis.net/kml/2.2}"
GX = "{http://www.google.com/kml/ext/2.2}"
GPX = "{http://www.topografix.com/GPX/1/1}"
ORIGIN = (47.397742, 8.545594, 488.0)
UNIT = re.compile(r"_(ns|s|m|m_s|rad|deg|hz|share)$")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_run(tmp_path_factory.mktemp("runs") / "run")


@pytest.fixture(scope="module")
def data(run: Path) -> RunData:
    return gcs.load(run)


@pytest.fixture(scope="module")
def written(run: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("out")
    export(run, [each for each in Format if each is not Format.PARQUET], folder, ())
    return folder


def flown(id: int) -> list[State]:
    """The states of a vehicle as they went over the bus."""
    places = ((item, topics.TOPICS.find(item.key)) for item in flight())
    mine = [item for item, place in places if place and place.topic is topics.STATE and place.id == id]
    return [state for item in mine if (state := topics.STATE.decode(item.payload, {})) is not None]  # type: ignore[arg-type]


def ns(text: str) -> int:
    """An instant of a file [ns]."""
    return round(datetime.fromisoformat(text).timestamp() * 1000) * 1_000_000


def test_the_tables_hold_what_went_over_the_bus(data: RunData) -> None:
    for id in (1, 2, 3):
        sent, got = flown(id), data.states.of(id)
        assert got.rows == len(sent) > 100
        assert np.array_equal(got["stamp_ns"], [s.stamp_ns for s in sent])
        assert np.array_equal(
            np.column_stack([got["north_m"], got["east_m"], got["down_m"]]), [s.position for s in sent]
        )
        assert np.array_equal(got["v_east_m_s"], [s.velocity[1] for s in sent])
        assert set(got["role"]) == {sent[0].role.value}
    assert data.t0_ns >= EPOCH_NS
    assert np.allclose(data.states["t_s"], (data.states["stamp_ns"] - data.t0_ns) / 1e9)
    assert data.setpoints.rows == data.decisions.rows > 100
    assert data.events.rows > 0
    assert data.health.rows > 0
    assert data.outcome is not None
    assert [goal.place for goal in data.targets] == [(400.0, 100.0, -60.0)]


def test_places_on_earth_agree_with_another_library(data: RunData) -> None:
    for name in ("states", "tracks"):
        table = getattr(data, name).of(1)
        lat, lon, height = pymap3d.ned2geodetic(table["north_m"], table["east_m"], table["down_m"], *ORIGIN)
        assert np.abs(table["latitude_deg"] - lat).max() < 1e-7  # 1 cm
        assert np.abs(table["longitude_deg"] - lon).max() < 1e-7
        assert np.abs(table["altitude_m"] - height).max() < 0.05


def test_every_number_has_its_unit_in_its_name(data: RunData) -> None:
    for table in data.tables:
        assert tuple(table)[:1] == ("t_s",)
        assert set(COLUMNS[table.name]) <= set(table)
        for name, column in table.items():
            assert len(column) == table.rows
            number = column.dtype.kind in "if" and name not in ("id", "number", "quarry_id")
            assert bool(UNIT.search(name)) == number, (table.name, name, column.dtype)


def test_csv_reads_back_to_the_same_numbers(data: RunData, written: Path) -> None:
    for table in data.tables:
        with (written / f"{table.name}.csv").open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        assert len(rows) == table.rows
        for name, column in table.items():
            cells = [row[name] for row in rows]
            if column.dtype.kind == "f":
                assert np.array_equal([float(cell or "nan") for cell in cells], column, equal_nan=True), name
            elif column.dtype.kind == "b":
                assert cells == ["true" if value else "false" for value in column]
            else:
                assert cells == [str(value) for value in column]


def test_parquet_is_read_by_pyarrow(data: RunData, run: Path, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    export(run, [Format.PARQUET], tmp_path, ())
    for table in data.tables:
        found = parquet.read_table(tmp_path / f"{table.name}.parquet")
        assert found.column_names == list(table)
        for name, column in table.items():
            assert found[name].to_pylist() == column.tolist() or column.dtype.kind == "f", name
            if column.dtype.kind == "f":
                assert np.array_equal(found[name].to_numpy(), column, equal_nan=True), name


def test_parquet_without_its_library_says_what_to_install(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ConfigError, match="found no pyarrow, expected it: pip install pyarrow"):
        export(run, [Format.PARQUET], tmp_path, ())


def test_pandas_takes_a_table(data: RunData) -> None:
    pandas = pytest.importorskip("pandas")
    frame = data.states.frame()
    assert list(frame.columns) == list(data.states)
    assert frame[frame.id == 2].north_m.max() == data.states.of(2)["north_m"].max()
    assert isinstance(frame, pandas.DataFrame)


def test_kml_is_what_a_globe_expects(data: RunData, written: Path) -> None:
    root = etree.parse(str(written / "run.kml")).getroot()
    assert root.tag == f"{KML}kml"
    marks = {mark.findtext(f"{KML}name"): mark for mark in root.iter(f"{KML}Placemark")}
    styles = {style.get("id") for style in root.iter(f"{KML}Style")}
    for id, name in ((1, "evader 1"), (2, "pursuer 2")):
        mark = marks[name]
        assert mark.findtext(f"{KML}styleUrl").lstrip("#") in styles
        track = mark.find(f"{GX}Track")
        assert next(child.tag for child in track) == f"{KML}altitudeMode"
        whens = [ns(at.text) for at in track.iter(f"{KML}when")]
        coords = np.array([[float(n) for n in at.text.split()] for at in track.iter(f"{GX}coord")])
        assert len(whens) == len(coords) > 50
        assert whens == sorted(whens)
        assert min(np.diff(whens)[:-1]) >= 199_000_000
        north, east, down = pymap3d.geodetic2ned(coords[:, 1], coords[:, 0], coords[:, 2], *ORIGIN)
        own = data.states.of(id)
        for axis, found in (("north_m", north), ("east_m", east), ("down_m", down)):
            assert np.abs(np.interp(whens, own["stamp_ns"], own[axis]) - found).max() < 0.1, axis
    bands = [mark for mark in root.iter(f"{KML}Placemark") if mark.find(f"{KML}TimeSpan") is not None]
    assert {mark.findtext(f"{KML}name").split(": ")[1] for mark in bands} == set(data.decisions["rule"])
    assert "target" in marks
    assert any((name or "").startswith("fence") for name in marks)


def test_gpx_has_the_order_that_its_schema_demands(data: RunData, written: Path) -> None:
    root = ET.parse(written / "run.gpx").getroot()
    assert (root.tag, root.get("version")) == (f"{GPX}gpx", "1.1")
    order = [child.tag.removeprefix(GPX) for child in root]
    assert order == sorted(order, key=["metadata", "wpt", "rte", "trk"].index)
    waypoint = root.find(f"{GPX}wpt")
    assert waypoint is not None
    assert [child.tag.removeprefix(GPX) for child in waypoint] == ["ele", "time", "name", "desc"]
    names = [track.findtext(f"{GPX}name") for track in root.iter(f"{GPX}trk")]
    assert names[:3] == ["evader 1", "pursuer 2", "pursuer 3"]
    for point in root.iter(f"{GPX}trkpt"):
        assert abs(float(point.get("lat", "nan")) - ORIGIN[0]) < 0.02
        assert [child.tag.removeprefix(GPX) for child in point] == ["ele", "time"]


def test_czml_moves_through_its_time(data: RunData, written: Path) -> None:
    packets = json.loads((written / "run.czml").read_text(encoding="utf-8"))
    assert packets[0]["id"] == "document"
    assert packets[0]["version"] == "1.0"
    assert len({packet["id"] for packet in packets}) == len(packets)
    evader = next(packet for packet in packets if packet["name"] == "evader 1")
    numbers = np.array(evader["position"]["cartographicDegrees"]).reshape(-1, 4)
    begin, end = (ns(text) for text in evader["availability"].split("/"))
    assert numbers[0, 0] == 0.0
    assert abs(numbers[-1, 0] - (end - begin) / 1e9) < 2e-3
    north, _, _ = pymap3d.geodetic2ned(numbers[:, 2], numbers[:, 1], numbers[:, 3], *ORIGIN)
    own = data.states.of(1)
    assert np.abs(np.interp(begin + numbers[:, 0] * 1e9, own["stamp_ns"], own["north_m"]) - north).max() < 0.1
    assert {text["string"].removeprefix("evader 1 ") for text in evader["label"]["text"]} == set(
        data.decisions.of(1)["rule"]
    )
    sent = np.array(evader["properties"]["setpoint_v_north_m_s"]["number"]).reshape(-1, 2)
    assert np.allclose(sent[:, 1], data.setpoints.of(1)["v_north_m_s"], atol=1e-3)


def test_geojson_has_lines_with_instants_and_a_fence_that_runs_against_the_clock(
    data: RunData, run: Path, tmp_path: Path
) -> None:
    (path,) = export(run, [Format.GEOJSON], tmp_path, ())[0]
    told = json.loads(path.read_text(encoding="utf-8"))
    assert told["type"] == "FeatureCollection"
    by_name = {feature["properties"]["name"]: feature for feature in told["features"]}
    for id, name in ((1, "evader 1"), (2, "pursuer 2")):
        feature = by_name[name]
        assert feature["geometry"]["type"] == "LineString"
        places = np.array(feature["geometry"]["coordinates"])
        times = [ns(text) for text in feature["properties"]["times"]]
        assert len(times) == len(places) > 50
        north, east, _ = pymap3d.geodetic2ned(places[:, 1], places[:, 0], places[:, 2], *ORIGIN)
        own = data.states.of(id)
        assert np.abs(np.interp(times, own["stamp_ns"], own["north_m"]) - north).max() < 0.1
        assert np.abs(np.interp(times, own["stamp_ns"], own["east_m"]) - east).max() < 0.1
    (ring,) = by_name["fence"]["geometry"]["coordinates"]
    assert ring[0] == ring[-1]
    area = sum(x0 * y1 - x1 * y0 for (x0, y0, _), (x1, y1, _) in itertools.pairwise(np.array(ring) - ring[0]))
    assert area > 0.0  # the right-hand rule of RFC 7946, 3.1.6
    assert "target" in by_name


def test_every_topic_of_the_viewers_layout_is_in_the_recording(run: Path, tmp_path: Path) -> None:
    (path,) = export(run, [Format.FOXGLOVE], tmp_path, ())[0]
    told = json.loads(path.read_text(encoding="utf-8"))
    with (run / "recording.mcap").open("rb") as file:
        there = {channel.topic for channel in make_reader(file).get_summary().channels.values()}
    named = {word.split(".")[0] for word in re.findall(r'"(/[^"]*)"', path.read_text(encoding="utf-8"))}
    assert {"/scene", "/log", "/position/1", "/location/2"} <= named
    assert named <= there

    def panels(node: object) -> set[str]:
        return {node} if isinstance(node, str) else panels(node["first"]) | panels(node["second"])

    assert panels(told["layout"]) == set(told["configById"])


@pytest.mark.parametrize("name", ["states", "tracks"])
def test_what_is_exported_predict_reads(run: Path, data: RunData, tmp_path: Path, name: str) -> None:
    (path,) = (p for p in export(run, [Format.CSV], tmp_path, (1,))[0] if p.stem == name)
    track, table = recording_of(path), getattr(data, name).of(1)
    assert [s.t for s in track.samples] == table["t_s"].tolist()
    assert [s.position.y for s in track.samples] == table["east_m"].tolist()
    assert [s.velocity and s.velocity.x for s in track.samples] == table["v_north_m_s"].tolist()
    if "sigma_m" in table:
        assert [s.variance[0] for s in track.samples] == pytest.approx((table["sigma_m"] ** 2).tolist())


def test_predict_refuses_several_vehicles_in_one_file(run: Path, tmp_path: Path) -> None:
    export(run, [Format.CSV], tmp_path, ())
    with pytest.raises(ConfigError, match=r"states.csv: id: found 1, 2, 3, expected one vehicle: gcs export"):
        recording_of(tmp_path / "states.csv")


def test_of_a_run_without_recording_the_logs_are_exported(data: RunData, tmp_path: Path) -> None:
    folder = make_tlogs(make_run(tmp_path / "run", recording=False))
    logged = gcs.load(folder)
    assert logged.states.ids == (1, 2, 3)
    assert any("made from telemetry logs" in note for note in logged.notes)
    mine, theirs = logged.states.of(1), data.states.of(1)
    place = np.interp(mine["stamp_ns"], theirs["stamp_ns"], theirs["north_m"])
    assert np.abs(mine["north_m"] - place).max() < 1.0
    assert len(export(folder, list(Format)[2:], None, ())[0]) == 5


def test_what_cannot_be_exported_is_said_in_one_line(run: Path, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="nothing: no such run"):
        export(tmp_path / "nothing", [Format.CSV], None, ())
    with pytest.raises(ConfigError, match="--id: found vehicle 9, expected one of 1, 2, 3"):
        export(run, [Format.CSV], None, (9,))
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match="file"):
        export(run, [Format.CSV], tmp_path / "file", ())
    shutil.copytree(run, tmp_path / "cut")
    (tmp_path / "cut" / "truth.csv").write_text("stamp_ns,id\n1,2\n")
    with pytest.raises(ConfigError, match=r"truth.csv: found no column airspeed_m_s, expected stamp_ns, id"):
        gcs.load(tmp_path / "cut")


def test_a_column_that_is_not_there_is_told_with_those_that_are(run: Path) -> None:
    with pytest.raises(KeyError, match="states: found no column 'nort_m', expected one of t_s, stamp_ns"):
        gcs.load(run).states["nort_m"]


def test_a_truth_cut_while_it_was_written_is_read_up_to_the_cut(run: Path, tmp_path: Path) -> None:
    shutil.copytree(run, tmp_path / "cut")
    line = ",".join(["1760000000000000000", "1", *["1.5"] * 10])
    text = ",".join(COLUMNS["truth"]) + f"\n{line}\n{line[:30]}"
    (tmp_path / "cut" / "truth.csv").write_text(text)
    assert gcs.load(tmp_path / "cut").truth["north_m"].tolist() == [1.5]


def test_two_recordings_in_one_folder_keep_their_reports_and_exports(run: Path, tmp_path: Path) -> None:
    for name in ("morning", "noon"):
        shutil.copy(run / "recording.mcap", tmp_path / f"{name}.mcap")
    pages = [write_report(tmp_path / f"{name}.mcap").page for name in ("morning", "noon")]
    assert [page.name for page in pages] == ["morning-report.html", "noon-report.html"]
    assert all(page.exists() for page in pages)
    assert (tmp_path / "noon-figures" / "plan.png").exists()
    assert export(tmp_path / "noon.mcap", [Format.GPX], None, ())[0] == [tmp_path / "noon-export" / "run.gpx"]


def test_the_example_of_the_docs_draws_its_figure(
    run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (ROOT / "docs" / "run-folder.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert 'gcs.load("runs/RUN")' in example
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    exec(compile(example.replace("runs/RUN", str(run)), "docs/run-folder.md", "exec"), {})
    drawn = (tmp_path / "distance.png").read_bytes()
    assert drawn.startswith(b"\x89PNG")
    assert len(drawn) > 5_000


def test_the_command_says_what_it_wrote(run: Path, tmp_path: Path) -> None:
    from typer.testing import CliRunner

    asked = ["export", str(run), "--format", "gpx", "--format", "csv", "--to", str(tmp_path)]
    done = CliRunner().invoke(app, asked)
    assert done.exception is None or isinstance(done.exception, SystemExit)
    said = done.stdout.split()
    assert str(tmp_path / "run.gpx") in said
    assert str(tmp_path / "truth.csv") in said
    assert all(Path(line).exists() for line in said)
    assert csv.reader(io.StringIO((tmp_path / "truth.csv").read_text())).__next__()[0] == "t_s"
