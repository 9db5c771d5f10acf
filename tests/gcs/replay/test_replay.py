"""Replay: the same picture as live, at any speed, after any jump."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.picture.reducer import PictureReducer
from gcs.picture.values import Picture
from gcs.recording.recorder import Recorder
from gcs.replay.player import Player
from gcs.replay.source import ReplaySource, open_run
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import CommandKind
from tests.support.chase_messages import EPOCH_NS, Item, chase


def flight_with_trouble() -> list[Item]:
    """40 s in which vehicle 2 falls silent for 5 s: lost, then back."""
    silent = range(EPOCH_NS + 8 * NS_PER_S, EPOCH_NS + 13 * NS_PER_S)
    flown = chase(40.0)
    return [i for i in flown if not ("/vehicles/2/" in i.key and i.stamp_ns in silent)]


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    recorder = Recorder(folder / "recording.mcap", "field")
    for item in flight_with_trouble():
        recorder.record(*item)
    recorder.close()
    return folder


def live(at_ns: int) -> Picture:
    """What the station showed at an instant."""
    watch = PictureReducer("field")
    for item in flight_with_trouble():
        if item.stamp_ns <= at_ns:
            watch.apply(*item)
    return watch.picture(at_ns)


def test_a_replay_gives_the_live_picture_alert_for_alert(run: Path) -> None:
    player = Player(open_run(run))
    watch = PictureReducer("field")
    flown = iter(flight_with_trouble())
    item = next(flown)
    shown = set()
    for at_ns in range(player.start_ns, player.end_ns, 250_000_000):
        while item.stamp_ns <= at_ns:
            watch.apply(*item)
            item = next(flown)
        player.seek(at_ns)
        picture = player.picture()
        assert picture == watch.picture(at_ns)
        shown |= {alert.name for alert in picture.alerts}
    assert "lost:2" in shown, "the flight had an alert to compare"
    assert player.picture().past_alerts


def test_time_passes_at_the_chosen_speed_and_stops_at_the_end(run: Path) -> None:
    player = Player(open_run(run))
    player.advance(NS_PER_S)
    assert player.at_ns - player.start_ns == NS_PER_S
    assert player.faster() == 2.0
    player.advance(NS_PER_S)
    assert player.at_ns - player.start_ns == 3 * NS_PER_S
    assert player.faster(-3) == 0.25
    player.advance(4 * NS_PER_S)
    assert player.at_ns - player.start_ns == 4 * NS_PER_S
    player.pause()
    player.advance(NS_PER_S)
    assert player.at_ns - player.start_ns == 4 * NS_PER_S
    player.pause(False)
    player.advance(1000 * NS_PER_S)
    assert player.ended
    assert player.paused
    player.pause(False)
    assert player.at_ns == player.start_ns, "playing on at the end begins anew"


@settings(max_examples=25, deadline=None)
@given(jumps=st.lists(st.integers(-2, 45_000), min_size=1, max_size=4))
def test_wherever_one_jumps_the_picture_is_that_of_the_instant(run: Path, jumps: list[int]) -> None:
    player = Player(open_run(run))
    for jump in jumps:
        player.seek(player.start_ns + jump * 1_000_000)
    assert player.picture() == live(player.at_ns)


def test_steps_walk_the_grid_both_ways(run: Path) -> None:
    player = Player(open_run(run))
    player.seek(player.start_ns + 20 * NS_PER_S + 12345)
    player.step()
    forward = player.at_ns
    player.step()
    assert player.at_ns - forward == NS_PER_S // 10
    player.step(-1)
    assert player.at_ns == forward
    assert player.paused
    assert player.picture() == live(forward)


def test_a_long_way_back_uses_checkpoints(run: Path) -> None:
    player = Player(open_run(run))
    player.seek(player.end_ns)
    gaps = np.diff([player.start_ns, *(at for at, _ in player.checkpoints), player.end_ns]) / NS_PER_S
    assert gaps.max() < 2.5  # so much at most is played again
    player.seek(player.start_ns + 35 * NS_PER_S)
    assert player.picture() == live(player.at_ns)


def test_an_index_shows_the_end_and_stays_where_it_was(run: Path) -> None:
    player, told = Player(open_run(run)), []
    player.seek(player.start_ns + 7 * NS_PER_S)
    last = player.index(lambda share, picture: told.append(share))
    assert last == live(player.end_ns)
    assert player.picture() == live(player.start_ns + 7 * NS_PER_S)
    assert told == sorted(told)
    assert told[-1] == 1.0
    begun = []
    player._place = lambda at_ns, reducer: begun.append(at_ns)  # type: ignore[method-assign]
    player.seek(player.end_ns - NS_PER_S)  # forward, too, from the checkpoint before it
    assert player.end_ns - begun[0] < 6 * NS_PER_S


def test_the_consoles_keys_steer_it(run: Path) -> None:
    now = 0
    source = ReplaySource(Player(open_run(run)), "chase", lambda: now)
    assert source.title == "replay of chase"
    assert {key.action for key in source.keys} >= {"pause", "on", "step", "faster", "start"}
    now = 2 * NS_PER_S
    assert source.picture().now_ns == source.player.start_ns + 2 * NS_PER_S
    assert source.status() == "0:02.0 of 0:40.0 ×1 playing"
    source.act("on")
    assert source.status().startswith("0:12.0 of 0:40.0")
    assert source.act("pause") == "paused"
    assert source.status().endswith("paused")
    assert source.act("faster") == "speed ×2"
    for key in source.keys:
        source.act(key.action)
    source.acknowledge("")
    assert source.command(CommandKind.ABORT, (1, 2)) == "this is a recording: abort goes to nobody"


def test_a_cut_recording_plays_what_is_there(run: Path, tmp_path: Path) -> None:
    data = (run / "recording.mcap").read_bytes()
    (tmp_path / "recording.mcap").write_bytes(data[: len(data) // 3])
    recording = open_run(tmp_path)
    assert len(recording.remarks) == 1
    player = Player(recording)
    player.seek(player.end_ns)
    assert player.picture() == live(player.end_ns)


def test_a_run_without_a_recording_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"recording\.mcap: no such file"):
        open_run(tmp_path)
