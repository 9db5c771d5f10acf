"""The flight recorder: everything comes back, killed or not, and a full disk is only an alert."""

from __future__ import annotations

import json
import resource
import signal
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader

from gcs.recording.reader import Recording
from gcs.recording.recorder import Recorder, RecorderStatus, remark_of
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Severity
from tests.support.chase_messages import EPOCH_NS, Item, chase
from tests.support.real_time import patience
from tests.support.recording_process import CHILD, kill_while_recording, read


def recorded(path: Path, items: list[Item], **options: object) -> Recorder:
    recorder = Recorder(path, "field", **options)  # type: ignore[arg-type]
    for item in items:
        recorder.record(*item)
    return recorder


class SmallDisk:
    """A disk with room for `room` bytes, kept in memory."""

    def __init__(self, room: int) -> None:
        self.room = room
        self.data = bytearray()

    def __call__(self, _path: Path) -> SmallDisk:
        return self

    def write_at(self, data: memoryview, offset: int) -> int:
        fits = min(len(data), self.room - offset)
        if fits <= 0:
            raise OSError(28, "No space left on device")
        if len(self.data) < offset + fits:
            self.data.extend(bytes(offset + fits - len(self.data)))
        self.data[offset : offset + fits] = data[:fits]
        return fits

    def truncate(self, size: int) -> None:
        del self.data[size:]

    def close(self) -> None:
        pass


def test_every_message_comes_back_as_it_came(tmp_path: Path) -> None:
    flown = list(chase(8.0))
    recorded(tmp_path / "flight.mcap", flown).close()

    recording = Recording(tmp_path / "flight.mcap")
    assert [tuple(entry) for entry in recording.entries()] == [tuple(item) for item in flown]
    assert recording.remarks == []
    assert recording.game == "field"
    assert recording.start_ns == flown[0].stamp_ns


def test_the_same_flight_gives_the_same_bytes(tmp_path: Path) -> None:
    flown = list(chase(3.0))
    for name in ("a", "b"):
        recorded(tmp_path / name, flown).close()
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_the_mcap_librarys_own_reader_reads_it_with_schemas(tmp_path: Path) -> None:
    flown = list(chase(4.0))
    recorded(tmp_path / "flight.mcap", flown).close()
    with (tmp_path / "flight.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        messages = list(reader.iter_messages())
        summary = reader.get_summary()
    assert summary is not None
    assert summary.statistics is not None
    assert summary.statistics.message_count == len(messages)
    on_bus = [m for _, channel, m in messages if not channel.topic.startswith("/")]
    assert sorted(m.data for m in on_bus) == sorted(item.payload for item in flown)
    schemas = {channel.topic: (schema, channel) for schema, channel, _ in messages}
    schema, channel = schemas["apollonius/field/vehicles/2/state"]
    assert schema is not None
    assert (schema.name, schema.encoding) == ("apollonius.State", "jsonschema")
    assert channel.message_encoding == "msgpack"
    fields = json.loads(schema.data)["prefixItems"][1]["prefixItems"]
    assert [field["title"] for field in fields][:4] == ["id", "role", "stamp_ns", "position"]


def test_viewers_find_scene_poses_places_and_log(tmp_path: Path) -> None:
    recorded(tmp_path / "flight.mcap", list(chase(8.0))).close()
    recording = Recording(tmp_path / "flight.mcap")

    def last(topic: str) -> dict[str, object]:
        found = [json.loads(entry.payload) for entry in recording.views(topic)]
        assert found, topic
        return found[-1]  # type: ignore[no-any-return]

    drawn = {e["id"] for entry in recording.views("/scene") for e in json.loads(entry.payload)["entities"]}
    assert drawn == {
        "target", "fence", "vehicle-1", "vehicle-2", "vehicle-3",
        "trail-vehicle-1", "trail-vehicle-2", "trail-vehicle-3",
    }  # fmt: skip
    pose = last("/position/1")["pose"]["position"]  # type: ignore[index]
    assert 40.0 < pose["z"] < 60.0, "up is positive for viewers"
    place = last("/location/1")
    assert place["latitude"] == pytest.approx(47.3977 + pose["y"] / 111_190, abs=1e-4)
    frames = {t["child_frame_id"] for t in last("/tf")["transforms"]}  # type: ignore[attr-defined]
    assert frames == {"vehicle-1", "vehicle-2", "vehicle-3"}
    lines = [json.loads(entry.payload)["message"] for entry in recording.views("/log")]
    assert "decision clipped: pitch" in lines
    assert "game running" in lines


def test_viewers_messages_fit_the_schemas_that_the_file_carries(tmp_path: Path) -> None:
    recorded(tmp_path / "flight.mcap", list(chase(6.0))).close()
    with (tmp_path / "flight.mcap").open("rb") as file:
        names = set()
        for schema, channel, message in make_reader(file).iter_messages():
            if channel.topic.startswith("/"):
                assert schema is not None
                names.add(schema.name)
                outline = json.loads(schema.data)
                assert set(json.loads(message.data)) == set(outline["properties"])
                assert "$ref" not in schema.data.decode()
    assert names == {
        "foxglove.SceneUpdate", "foxglove.FrameTransforms", "foxglove.PoseInFrame",
        "foxglove.LocationFix", "foxglove.Log",
    }  # fmt: skip


def test_what_is_foreign_is_recorded_too(tmp_path: Path) -> None:
    odd = [Item("apollonius/field/weather/3", b"\x00\xff", EPOCH_NS), Item("x", b"", EPOCH_NS + 1)]
    recorded(tmp_path / "odd.mcap", odd).close()
    assert list(Recording(tmp_path / "odd.mcap").entries()) == [tuple(item) for item in odd]


def test_a_flood_of_keys_stays_within_the_formats_numbers(tmp_path: Path) -> None:
    flood = [Item(f"apollonius/g{n}/game/phase", b"x", EPOCH_NS + n) for n in range(5000)]
    recorded(tmp_path / "flood.mcap", flood).close()
    assert len(list(Recording(tmp_path / "flood.mcap").entries())) == 5000


def test_without_close_the_file_is_whole_but_for_the_last_second(tmp_path: Path) -> None:
    flown = list(chase(5.0))
    recorded(tmp_path / "flight.mcap", flown)
    recording = Recording(tmp_path / "flight.mcap")
    entries = list(recording.entries())
    assert recording.remarks == []
    assert [tuple(e) for e in entries] == [tuple(item) for item in flown[: len(entries)]]
    assert flown[-1].stamp_ns - entries[-1].stamp_ns < NS_PER_S
    with (tmp_path / "flight.mcap").open("rb") as file:
        assert len(list(make_reader(file).iter_messages())) == recording.messages


def test_silence_on_the_bus_still_puts_what_came_on_the_disk(tmp_path: Path) -> None:
    recorder = recorded(tmp_path / "flight.mcap", [Item("x", b"1", EPOCH_NS)])
    recorder.tick(EPOCH_NS + NS_PER_S)
    assert len(list(Recording(tmp_path / "flight.mcap").entries())) == 1


def test_a_recording_is_never_overwritten(tmp_path: Path) -> None:
    recorded(tmp_path / "flight.mcap", list(chase(1.0))).close()
    before = (tmp_path / "flight.mcap").read_bytes()
    with pytest.raises(ConfigError, match=r"flight\.mcap: file exists"):
        Recorder(tmp_path / "flight.mcap", "field")
    assert (tmp_path / "flight.mcap").read_bytes() == before


def read_back(disk: SmallDisk, path: Path) -> list[tuple[str, bytes, int]]:
    path.write_bytes(disk.data)
    recording = Recording(path)
    assert recording.remarks == [], "a full disk leaves no torn end"
    return [tuple(entry) for entry in recording.entries()]


def test_a_full_disk_is_an_alert_and_recording_goes_on_when_there_is_room(tmp_path: Path) -> None:
    flown = list(chase(12.0))
    third = len(flown) // 3
    disk = SmallDisk(30_000)
    recorder = Recorder(tmp_path / "x", "field", opener=disk)
    well = recorder.status()
    for item in flown[: 2 * third]:
        recorder.record(*item)
    full = recorder.status()
    assert full.trouble == "no space left on device"
    assert full.lost == 0
    assert full.waiting > 0
    remark = remark_of(well, full)
    assert remark is not None
    assert remark.severity is Severity.ERROR
    assert "make room" in remark.advice
    kept = read_back(disk, tmp_path / "full.mcap")
    assert 0 < len(kept) < 2 * third

    disk.room = 10_000_000
    for item in flown[2 * third :]:
        recorder.record(*item)
    recorder.close()
    again = recorder.status()
    over = remark_of(full, again)
    assert over is not None
    assert over.over
    assert "nothing lost" in over.text
    assert read_back(disk, tmp_path / "all.mcap") == [tuple(item) for item in flown]


def test_a_disk_full_for_long_loses_messages_but_says_how_many(tmp_path: Path) -> None:
    flown = list(chase(12.0))
    disk = SmallDisk(20_000)
    recorder = Recorder(tmp_path / "x", "field", opener=disk, most_waiting=20_000)
    for item in flown:
        recorder.record(*item)
    status = recorder.status()
    assert status.lost > 0
    assert status.recorded + status.lost == len(flown)
    disk.room = 10_000_000
    recorder.close()
    kept = read_back(disk, tmp_path / "kept.mcap")
    assert len(kept) == status.recorded
    assert kept == [tuple(item) for item in flown[: len(kept)]]


@settings(max_examples=30, deadline=None)
@given(room=st.integers(0, 60_000), wait=st.integers(1, 1000))
def test_wherever_the_disk_fills_the_file_is_whole(
    tmp_path_factory: pytest.TempPathFactory, room: int, wait: int
) -> None:
    flown = list(chase(4.0))
    disk = SmallDisk(room)
    recorder = Recorder(Path("x"), "field", opener=disk)
    for item in flown[: 2 * wait]:
        recorder.record(*item)
    recorder.close()
    folder = tmp_path_factory.mktemp("full")
    (folder / "f").write_bytes(disk.data)
    kept, remarks, refusal = read(folder / "f")
    assert remarks == []
    assert bool(refusal) == (not kept)
    assert kept == [tuple(item) for item in flown[: len(kept)]]
    if not recorder.status().trouble:
        assert len(kept) == min(len(flown), 2 * wait)


def test_a_real_limit_of_the_operating_system_is_no_crash(tmp_path: Path) -> None:
    def limited() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (40_000, 40_000))

    command = [sys.executable, str(CHILD), str(tmp_path / "flight.mcap"), "20"]
    done = subprocess.run(command, preexec_fn=limited, capture_output=True, text=True, timeout=patience(20.0))
    assert done.returncode == 0, done.stderr
    assert "file too large" in done.stdout.splitlines()[-1]
    recording = Recording(tmp_path / "flight.mcap")
    assert recording.remarks == []
    assert recording.messages > 100


@pytest.mark.real
@pytest.mark.parametrize("moment", range(8))
def test_killed_at_any_moment_the_file_opens_with_at_most_a_second_missing(
    tmp_path: Path, moment: int
) -> None:
    killed = kill_while_recording(tmp_path / "flight.mcap", lines=3 + 137 * moment)
    assert killed.missing_s <= 1.0
    assert killed.messages == killed.library
    assert killed.remarks == []


def test_status_is_a_value(tmp_path: Path) -> None:
    recorder = recorded(tmp_path / "f", list(chase(2.0)))
    status = recorder.status()
    assert isinstance(status, RecorderStatus)
    assert msgspec.json.encode(status)
    assert status.recorded == len(list(chase(2.0)))
    assert status.trouble == ""
    assert status.size > 1000
