"""What a person reads: the window's whole width, whole texts, own times, nothing twice, and small windows."""

from __future__ import annotations

import asyncio
import os
import pty
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from gcs.console.app import SAID_S, SMALLEST, Console
from gcs.console.events_screen import EventsScreen
from gcs.console.help import KEY_NAMES, help_text
from gcs.console.source import LIVE_HINT, Key
from gcs.console.status_line import log_lines, spans
from gcs.console.widgets import AlertBoard, Detail, LogPanel, Plan, Prompt, StatusBar, VehicleTable
from gcs.recording.recorder import Recorder
from gcs.replay.player import Player
from gcs.replay.source import ReplaySource, open_run
from onboard.core.math.constants import NS_PER_S
from onboard.game import palette
from onboard.wire.bus import messages
from onboard.wire.bus.messages import Severity
from tests.gcs.console.test_console import Desk, desk, screen
from tests.support.paths import ROOT
from tests.support.real_time import patience
from tests.support.sample_messages import START_NS, Tower, decision, event, health

SIZES = [(80, 24), (120, 40), (150, 40), (200, 50)]
PAPER_RULES = [rule.replace("_", " ") for rule in palette.RULES]


def logged(tower: Tower) -> list[str]:
    """The lines of the log."""
    return ["".join(text for text, _ in line) for line in log_lines(tower.picture)]


def told_by(tower: Tower, *texts: str) -> None:
    """Events of vehicle 2 with these texts."""
    for number, text in enumerate(texts, start=1):
        tower.hear(event(2, number, text=text, stamp_ns=tower.now_ns))


@pytest.mark.parametrize("size", SIZES)
async def test_alerts_and_log_have_the_width_of_the_window(size: tuple[int, int]) -> None:
    source = desk()
    source.tower.fly(3.0, *range(1, 6), state_hz=4)  # 6 is silent
    told_by(source.tower, "a" * 250)
    app = Console(source)
    async with app.run_test(size=size) as pilot:
        await pilot.pause()
        for panel in (AlertBoard, LogPanel, StatusBar):
            assert app.query_one(panel).size.width == size[0]
        line = next(line for line in screen(app).splitlines() if "aaa" in line)
        assert line.rstrip().endswith("a…")  # what is cut says so
        assert len(line.rstrip()) == size[0]


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("rule", sorted(palette.RULES, key=len)[-3:])
async def test_no_rule_of_the_paper_is_cut_in_any_size(size: tuple[int, int], rule: str) -> None:
    source = desk()
    source.tower.hear(decision(2, source.tower.now_ns, rule=rule))
    app = Console(source)
    async with app.run_test(size=size) as pilot:
        await pilot.pause()
        app.show()
        await pilot.pause()
        assert f" {rule.replace('_', ' ')} " in app.query_one(VehicleTable).text


async def test_the_whole_of_what_is_cut_can_be_opened() -> None:
    source = desk()
    source.tower.fly(3.0, *range(1, 6), state_hz=4)
    long = " ".join(f"word{n}" for n in range(40))
    told_by(source.tower, long)
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("e")
        assert isinstance(app.screen, EventsScreen)
        whole = app.screen.text.plain
        assert long in whole
        assert "vehicle 6 is lost: silent from all sources  → look for it, keep others away" in whole
        assert "word0 word1" in screen(app)
        assert "word25" in screen(app)  # it wraps: eighty columns hold twelve of them
        await pilot.press("x")
        assert source.given == [("abort", (1, 2, 3, 4, 5, 6))]
        told_by(source.tower, "one more")
        app.refresh_picture()
        await pilot.press("escape")
        assert not isinstance(app.screen, EventsScreen)


async def test_the_detail_wraps() -> None:
    source = desk()
    why = "the decision leads beyond the geofence and the next one would be too late"
    source.tower.hear(
        decision(1, source.tower.now_ns, supervisor=messages.SupervisorAction.HOLD, reason=why)
    )
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        assert why in " ".join(app.query_one(Detail).text.split())


def test_what_several_say_alike_is_one_line_and_what_one_says_twice_too() -> None:
    tower = Tower()
    for i in (1, 2, 3, 5):
        tower.hear(event(i, 1, text="staging", stamp_ns=tower.now_ns))
        tower.wait(0.1)
    tower.hear(event(5, 2, text="staging", kind="other", stamp_ns=tower.now_ns))
    tower.wait(5.0)
    tower.hear(event(1, 2, text="staging", stamp_ns=tower.now_ns))
    said = [line for line in logged(tower) if "staging" in line]
    assert [line.split()[1:] for line in said] == [["1-3,5", "staging"], ["1", "staging"]]


IDS = [([0], "–"), ([4], "4"), ([2, 1, 3], "1-3"), ([9, 2, 4, 3], "2-4,9")]


@pytest.mark.parametrize(("ids", "said"), IDS)
def test_ids_are_told_as_spans(ids: list[int], said: str) -> None:
    assert spans(ids) == said


def test_an_event_has_its_own_time_and_says_when_it_came_late() -> None:
    tower = Tower()
    tower.hear(event(2, 1, text="at once", stamp_ns=tower.now_ns))
    own = tower.now_ns
    tower.wait(30.0)
    tower.hear(event(2, 2, text="recovered", stamp_ns=own + NS_PER_S))
    first, second = (line for line in logged(tower) if "lost" not in line)
    assert int(second[6:8]) == int(first[6:8]) + 1
    assert "heard" not in first
    assert second.endswith(")")
    assert "recovered (heard " in second


async def test_an_alert_is_shown_once() -> None:
    source = desk()
    source.tower.fly(3.0, *range(1, 6), state_hz=4)
    app = Console(source)
    async with app.run_test(size=(120, 40)) as pilot:
        app.select(6)
        await pilot.press("x")
        source.tower.wait(3.0)  # nobody confirms
        app.refresh_picture()
        await pilot.pause()
        board = app.query_one(AlertBoard).text
        assert board.count("abort") == 1
        assert "no answer: 1, 2, 3, 4, 5, 6  → still being repeated" in board
        assert "alert:" not in app.query_one(Detail).text


async def test_an_alert_that_the_board_has_no_room_for_stands_in_its_vehicles_detail() -> None:
    source = desk()
    source.tower.fly(3.0, 1, state_hz=4)  # 2 to 6 are silent, the board has three lines
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        for selected in range(2, 7):
            app.select(selected)
            await pilot.pause()
            shown = f"vehicle {selected} is lost" in app.query_one(AlertBoard).text
            assert ("alert: " in app.query_one(Detail).text) is not shown


@pytest.mark.parametrize("size", [(59, 30), (100, 14), (20, 6), (12, 2), (30, 8)])
async def test_too_small_a_window_says_so_and_keeps_the_abort_key(size: tuple[int, int]) -> None:
    source = desk()
    app = Console(source)
    async with app.run_test(size=size) as pilot:
        await pilot.pause()
        lines = screen(app).splitlines()
        assert lines[-1].startswith("x ABORT ALL"[: size[0]])
        assert f"{size[0]}×{size[1]} is too" in " ".join("".join(lines).split()) or size[1] < 3
        assert not app.query_one(Plan).display
        await pilot.press("x")
        assert source.given == [("abort", (1, 2, 3, 4, 5, 6))]
        await pilot.resize_terminal(*SMALLEST)
        await pilot.pause()
        app.show()
        await pilot.pause()
        assert "evad" in screen(app)


async def test_n_says_no() -> None:
    source = desk()
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("l", "n", "y")
        assert source.given == []
        await pilot.press("q", "n")
        assert app.is_running
        await pilot.press("colon", "l", "a", "n", "d", "enter")  # n is a letter where one types
        assert app.query_one(Prompt).said.startswith("land 1?")


async def test_the_hint_comes_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gcs.console.app.SAID_S", 0.05)
    assert SAID_S > 2.0
    app = Console(desk())
    async with app.run_test(size=(80, 24)) as pilot:
        assert len(LIVE_HINT) <= 80
        await pilot.press("h")
        for _ in range(100):
            await asyncio.sleep(0.02)
            if not app.query_one(Prompt).said:
                break
        assert screen(app).splitlines()[-1].rstrip() == LIVE_HINT


async def test_an_empty_console_says_where_it_listens_and_what_to_start() -> None:
    app = Console(Desk(Tower()))
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        for word in ("no vehicle heard yet", "listening at tcp/127.0.0.1:7447", "sim-bridge serve demo"):
            assert word in app.query_one(VehicleTable).text


@pytest.fixture
def replayed(tmp_path: Path) -> Iterator[ReplaySource]:
    source = desk()
    source.tower.fly(20.0, *range(1, 7), state_hz=4)
    recorder = Recorder(tmp_path / "recording.mcap", "game")
    for item in source.tower.stream:
        recorder.record(*item)
    recorder.close()
    recording = open_run(tmp_path)
    now = [0]
    found = ReplaySource(Player(recording), "a run of a long name", lambda: now[0])
    yield found
    recording.close()


@pytest.mark.parametrize("size", SIZES)
async def test_a_replay_shows_place_total_speed_and_pause_and_no_abort(
    replayed: ReplaySource, size: tuple[int, int]
) -> None:
    app = Console(replayed)
    async with app.run_test(size=size) as pilot:
        await pilot.press("right", "plus")
        app.say("")
        await pilot.pause()
        last = screen(app).splitlines()[-1]
        assert last.startswith("0:10.0 of 0:2")
        assert "×2 playing" in last
        await pilot.press("space")
        app.say("")
        await pilot.pause()
        assert "×2 paused" in screen(app)
        await pilot.press("x", "ctrl+x", "h", "l")
        assert "ABORT" not in screen(app)
        assert app.query_one(Prompt).said == ""
        await pilot.press("question_mark")
        assert "ABORT" not in app.screen.text.plain
        assert "vehicles fly on" not in app.screen.text.plain
        await pilot.press("escape", "q")  # nothing flies: nothing is asked
    assert app.return_code == 0


def test_keys_are_named_as_they_are_printed() -> None:
    keys = (Key("ctrl+right", "on", "60 s on"), Key("full_stop", "s", "step"), Key("space", "p", "pause"))
    text = help_text((("pageup", "", "back"), ("question_mark,f1", "", "help")), keys).plain
    for name in ("Ctrl →", ".", "Space", "PgUp", "? F1"):
        assert f"\n  {name:<15}" in text
    assert not any(name in text for name in KEY_NAMES if len(name) > 5)


@pytest.mark.real
@pytest.mark.parametrize("redirected", ["stdin", "stdout", "stderr"])
def test_it_draws_on_no_file(redirected: str, tmp_path: Path) -> None:
    """Two of three streams on a real terminal: the third, a file, is refused before anything is drawn."""
    leader, follower = pty.openpty()
    with (tmp_path / "file").open("w+b") as file:
        streams = {name: follower for name in ("stdin", "stdout", "stderr")} | {redirected: file.fileno()}
        done = subprocess.run(
            [sys.executable, "-m", "gcs.cli", "--runs", str(tmp_path / "runs")], timeout=patience(20.0),
            env={**os.environ, "PYTHONPATH": str(ROOT)}, check=False, **streams,
        )  # fmt: skip
        os.close(follower)
        said = (tmp_path / "file").read_bytes()
    assert done.returncode == 2
    assert b"\x1b" not in said
    assert not (tmp_path / "runs").exists()
    os.close(leader)


def test_health_and_severity_reach_the_whole_text() -> None:
    tower = Tower()
    tower.hear(health(2), event(2, 1, severity=Severity.ERROR, text="x" * 300, stamp_ns=START_NS))
    shown = EventsScreen(tower.picture, 2).text.plain
    assert "x" * 300 in shown
    assert "2 pursuer" in shown
