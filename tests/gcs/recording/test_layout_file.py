"""The viewer's layout beside a recording: there from the first second, whole, and never in anybody's way."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

from mcap.reader import make_reader

from gcs.export.formats import Format
from gcs.export.program import export
from gcs.recording.foxglove_layout import LAYOUT, LayoutFile
from gcs.recording.recorder import Recorder
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.file_writer import FileWriter
from onboard.wire.bus.messages import Role
from tests.support.chase_messages import EPOCH_NS, chase

BOTH = {1: Role.EVADER, 2: Role.PURSUER}


def topics(layout: Path) -> set[str]:
    return {word.split(".")[0] for word in re.findall(r'"(/[^"]*)"', layout.read_text(encoding="utf-8"))}


def test_a_recording_has_its_layout_beside_it_from_the_first_seconds(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    recorder = Recorder(folder / "recording.mcap", "field")
    for item in chase(10.0):
        recorder.record(*item)
        if item.stamp_ns > EPOCH_NS + 3 * NS_PER_S:
            break
    early = topics(folder / LAYOUT)  # nobody has closed it
    assert {"/scene", "/log", "/position/1", "/location/2"} <= early
    recorder.close()
    with (folder / "recording.mcap").open("rb") as file:
        there = {channel.topic for channel in make_reader(file).get_summary().channels.values()}
    assert early <= there
    (exported,) = export(folder, [Format.FOXGLOVE], tmp_path / "other", ())[0]
    assert (folder / LAYOUT).read_bytes() == exported.read_bytes()
    assert sorted(p.name for p in folder.iterdir()) == [LAYOUT, "recording.mcap"]


def test_it_grows_with_the_vehicles_and_is_written_only_then(tmp_path: Path) -> None:
    layout = LayoutFile(tmp_path)
    layout.hold({1: Role.EVADER})
    first = (tmp_path / LAYOUT).stat().st_ino
    layout.hold({1: Role.EVADER})
    assert (tmp_path / LAYOUT).stat().st_ino == first
    layout.hold(BOTH)
    assert "/position/2" in topics(tmp_path / LAYOUT)
    heights = json.loads((tmp_path / LAYOUT).read_bytes())["configById"]["Plot!heights"]
    labels = [path["label"] for path in heights["paths"]]
    assert labels == ["evader 1", "pursuer 2"]


def test_a_layout_of_ones_own_stays(tmp_path: Path) -> None:
    (tmp_path / LAYOUT).write_text("mine", encoding="utf-8")
    layout = LayoutFile(tmp_path)
    layout.hold(BOTH)
    layout.hold({1: Role.EVADER})
    assert (tmp_path / LAYOUT).read_text(encoding="utf-8") == "mine"


def test_a_disk_that_refuses_is_asked_again_and_leaves_no_part(tmp_path: Path) -> None:
    folder = tmp_path / "not yet"
    layout = LayoutFile(folder)
    layout.hold(BOTH)
    folder.mkdir()
    layout.hold(BOTH)
    assert [p.name for p in folder.iterdir()] == [LAYOUT]


def test_nobody_waits_for_the_disk_and_jobs_do_not_pile_up(tmp_path: Path) -> None:
    waiting: list[Callable[[], None]] = []

    def later(job: Callable[[], None]) -> bool:
        waiting.append(job)
        return True

    layout = LayoutFile(tmp_path, later)
    for count in range(1, 6):
        layout.hold({i: Role.PURSUER for i in range(1, count + 1)})
    assert len(waiting) == 1  # the disk hangs: one job waits, and nothing was written here
    assert list(tmp_path.iterdir()) == []
    waiting.pop()()
    layout.hold({i: Role.PURSUER for i in range(1, 6)})
    waiting.pop()()
    assert "/position/5" in topics(tmp_path / LAYOUT)


def test_a_full_queue_is_no_end(tmp_path: Path) -> None:
    layout = LayoutFile(tmp_path, lambda job: False)
    layout.hold(BOTH)
    layout._run = lambda job: job() or True  # type: ignore[func-returns-value]
    layout.hold(BOTH)
    assert (tmp_path / LAYOUT).exists()


def test_the_writers_thread_writes_it(tmp_path: Path) -> None:
    writer = FileWriter()
    recorder = Recorder(tmp_path / "recording.mcap", "field", writer=writer)
    for item in chase(3.0):
        recorder.record(*item)
    recorder.close()
    assert writer.close(10.0)
    assert "/position/1" in topics(tmp_path / LAYOUT)
