"""Recordings that are cut, damaged, foreign, empty or newer: a clear line each, nothing whole is lost."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.writer import Writer

from gcs.recording.reader import Recording
from gcs.recording.recorder import FORMAT, METADATA, Recorder
from onboard.config.strict import ConfigError
from onboard.wire.bus.messages import SCHEMA
from tests.support.chase_messages import chase
from tests.support.recording_process import read

FLOWN = list(chase(3.0))


class Bytes(bytes):
    """A file's contents that do not flood a failing test's report."""

    def __repr__(self) -> str:
        return f"<{len(self)} bytes>"


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("whole") / "flight.mcap"
    recorder = Recorder(path, "field")
    for item in FLOWN:
        recorder.record(*item)
    recorder.close()
    return Bytes(path.read_bytes())


def refused(path: Path, data: bytes) -> str:
    path.write_bytes(data)
    with pytest.raises(ConfigError) as caught:
        Recording(path)
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    assert "\n" not in text
    return text


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_cut_at_any_byte_all_that_is_whole_is_read(
    tmp_path_factory: pytest.TempPathFactory, whole: bytes, data: st.DataObject
) -> None:
    cut = data.draw(st.integers(1, len(whole) - 1))
    path = tmp_path_factory.mktemp("cut") / "flight.mcap"
    path.write_bytes(whole[:cut])
    kept, remarks, refusal = read(path)
    assert kept == [tuple(item) for item in FLOWN[: len(kept)]]
    if refusal:
        assert cut < len(whole) / 2
        assert "without a message" in refusal or "no MCAP" in refusal
    elif remarks:
        assert len(remarks) == 1
        assert "cut in the record at byte" in remarks[0]
    else:
        assert len(kept) == len(FLOWN), "only the index was lost"


@settings(max_examples=80, deadline=None)
@given(data=st.data())
def test_a_flipped_byte_costs_its_own_chunk_alone_and_never_raises(
    tmp_path_factory: pytest.TempPathFactory, whole: bytes, data: st.DataObject
) -> None:
    at = data.draw(st.integers(0, len(whole) - 1))
    bad = bytearray(whole)
    bad[at] ^= 1 << data.draw(st.integers(0, 7))
    path = tmp_path_factory.mktemp("bad") / "flight.mcap"
    path.write_bytes(bad)
    kept, _, refusal = read(path)
    flown = {tuple(item) for item in FLOWN}
    assert set(kept) <= flown, "a damaged message never passes as a good one"
    if refusal:
        assert refusal.startswith(f"{path}: ")
    else:
        assert len(kept) > len(FLOWN) / 2, "one flipped bit costs one chunk at most"


def test_a_chunk_whose_length_has_grown_does_not_swallow_its_successors(tmp_path: Path, whole: bytes) -> None:
    """Its own contents still check: only the length tells."""
    at = 8
    while whole[at] != 6:  # the first chunk
        at += 9 + int.from_bytes(whole[at + 1 : at + 9], "little")
    bad = bytearray(whole)
    bad[at + 2] ^= 1 << 6  # 16 kB more
    path = tmp_path / "flight.mcap"
    path.write_bytes(bad)
    kept, _, refusal = read(path)
    assert not refusal
    assert len(kept) > 0.8 * len(FLOWN)


def test_a_damaged_chunk_leaves_the_others(tmp_path: Path, whole: bytes) -> None:
    path = tmp_path / "flight.mcap"
    path.write_bytes(whole)
    spans = Recording(path).spans
    assert len(spans) >= 5
    bad = bytearray(whole)
    bad[spans[2].offset + spans[2].length // 2] ^= 0xFF
    path.write_bytes(bad)
    recording = Recording(path)
    assert len(recording.remarks) == 1
    assert "damaged at byte" in recording.remarks[0]
    assert [s.start_ns for s in recording.spans] == [s.start_ns for i, s in enumerate(spans) if i != 2]


def test_an_empty_file_is_named(tmp_path: Path) -> None:
    assert "empty, expected a recording" in refused(tmp_path / "empty.mcap", b"")


def test_a_missing_file_and_a_folder_are_named(tmp_path: Path) -> None:
    for path, why in ((tmp_path / "none.mcap", "no such file"), (tmp_path, "is a directory")):
        with pytest.raises(ConfigError, match=why):
            Recording(path)


def test_a_file_of_another_kind_is_named(tmp_path: Path) -> None:
    assert "found no MCAP file" in refused(tmp_path / "x.mcap", b"PK\x03\x04 something else entirely")


def test_anothers_mcap_is_named(tmp_path: Path) -> None:
    path = tmp_path / "ros.mcap"
    writer = Writer(str(path))
    writer.start(profile="ros2", library="libmcap 1.2")
    channel = writer.register_channel("/odom", "cdr", 0)
    writer.add_message(channel, 1, b"x", 1)
    writer.finish()  # type: ignore[no-untyped-call]
    assert "written by 'libmcap 1.2', expected a recording of gcs" in refused(path, path.read_bytes())


@pytest.mark.parametrize(
    ("key", "found", "advice"),
    [
        ("format", FORMAT + 6, "read it with a newer gcs"),
        ("schema", SCHEMA + 6, "read it with a newer gcs"),
        ("schema", SCHEMA - 1, "read it with the gcs that recorded it"),
    ],
)
def test_a_recording_of_another_version_says_which_it_found(
    tmp_path: Path, key: str, found: int, advice: str
) -> None:
    path = tmp_path / "other.mcap"
    writer = Writer(str(path))
    writer.start(library="apollonius")
    known = {"format": str(FORMAT), "schema": str(SCHEMA), "game": "g"}
    writer.add_metadata(METADATA, {**known, key: str(found)})
    channel = writer.register_channel("x", "msgpack", 0)
    writer.add_message(channel, 1, b"x", 1)
    writer.finish()  # type: ignore[no-untyped-call]
    expected = {"format": FORMAT, "schema": SCHEMA}[key]
    said = refused(path, path.read_bytes())
    assert f"{key}: found version {found}, expected {expected}: {advice}" in said


def test_a_recording_of_nothing_says_so(tmp_path: Path) -> None:
    path = tmp_path / "flight.mcap"
    Recorder(path, "field").close()
    assert "a recording without a message" in refused(path, path.read_bytes())
