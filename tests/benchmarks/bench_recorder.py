"""What picture and recorder cost by themselves, and what a kill leaves of a recording.

Promises: 200 vehicles with state alone at 20 Hz, and 50 with the whole table of topics, into picture and
recorder with no message lost and less than 70 % of one core (here as processor seconds a flown second,
without a bus); killed at 100 random moments, every file opens with at most one second missing. Ten vehicles
show how the cost grows. `python -m tests.benchmarks.bench_recorder`, or with pytest.
"""

from __future__ import annotations

import time
from pathlib import Path
from tempfile import TemporaryDirectory, mkdtemp
from typing import NamedTuple

import numpy as np
import pytest

from gcs.picture.reducer import PictureReducer
from gcs.recording.reader import Recording
from gcs.recording.recorder import Recorder
from tests.benchmarks import yardstick
from tests.support.chase_messages import Item, chase
from tests.support.recording_process import kill_while_recording

SECONDS = 20.0
KILLS = 100


class Load(NamedTuple):
    """Who speaks."""

    vehicles: int
    whole: bool  # every topic of the table at its rate; else state alone

    def name(self) -> str:
        return f"{self.vehicles} vehicles, {'all topics' if self.whole else 'state alone'}"


class Cost(NamedTuple):
    """What it took."""

    messages: int
    recorded: int
    picture: float  # share of one core
    recorder: float  # share of one core
    megabytes: float  # an hour
    reading: float  # messages a second, read back


def measure(load: Load, folder: Path) -> Cost:
    """One flight into picture and recorder, each timed by itself."""
    flown = list(chase(SECONDS, vehicles=load.vehicles, state_only=not load.whole, story=False))
    watch = PictureReducer("field")
    picture = _timed(lambda item: watch.apply(*item), flown)
    watch.picture(flown[-1].stamp_ns)
    assert watch.fleet.received == len(flown)
    assert not watch.fleet.drops
    recorder = Recorder(folder / "flight.mcap", "field")
    recording = _timed(lambda item: recorder.record(*item), flown)
    recorder.close()
    begun = time.process_time()
    entries = list(Recording(folder / "flight.mcap").entries())
    reading = len(entries) / (time.process_time() - begun)
    assert [tuple(entry) for entry in entries] == [tuple(item) for item in flown]
    size = (folder / "flight.mcap").stat().st_size
    return Cost(
        len(flown), len(entries), picture / SECONDS, recording / SECONDS, size / 1e6 * 3600 / SECONDS, reading
    )


def _timed(take: object, flown: list[Item]) -> float:
    assert callable(take)
    begun = time.process_time()
    for item in flown:
        take(item)
    return time.process_time() - begun


LOADS = (Load(10, True), Load(50, True), Load(10, False), Load(200, False))


@pytest.mark.parametrize("load", LOADS, ids=Load.name)
def test_picture_and_recorder_leave_most_of_a_core_free(load: Load, tmp_path: Path) -> None:
    runs = [measure(load, Path(mkdtemp(dir=tmp_path))) for _ in range(yardstick.MEASURED)]
    cost = runs[0]._replace(
        picture=min(run.picture for run in runs), recorder=min(run.recorder for run in runs)
    )
    print(
        f"{load.name()}: {cost.messages / SECONDS:.0f} messages/s, picture {cost.picture:.1%}, "
        f"recorder {cost.recorder:.1%} of a core, {cost.megabytes:.0f} MB/h, "
        f"read back at {cost.reading:,.0f} messages/s",
        flush=True,
    )
    yardstick.cost(f"a second in the picture, {load.name()}", cost.picture)
    yardstick.cost(f"a second in the recorder, {load.name()}", cost.recorder)
    assert cost.recorded == cost.messages
    assert cost.picture + cost.recorder < 0.70


def test_killed_at_100_random_moments_at_most_a_second_is_missing(tmp_path: Path) -> None:
    rng = np.random.default_rng(6)
    missing = []
    for number, lines in enumerate(rng.integers(1, 6000, KILLS)):
        killed = kill_while_recording(tmp_path / f"{number}.mcap", int(lines))
        assert killed.remarks == []
        assert killed.messages == killed.library
        missing.append(killed.missing_s)
    print(
        f"{KILLS} kills: missing {np.mean(missing):.2f} s on average, {max(missing):.2f} s at most",
        flush=True,
    )
    assert max(missing) <= 1.0


if __name__ == "__main__":
    for each in LOADS:
        with TemporaryDirectory() as place:
            test_picture_and_recorder_leave_most_of_a_core_free(each, Path(place))
    with TemporaryDirectory() as place:
        test_killed_at_100_random_moments_at_most_a_second_is_missing(Path(place))
