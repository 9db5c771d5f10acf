"""The console under the hands of a person: keys, commands, questions, help, sizes. Textual's own pilot."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from textual.strip import Strip

from gcs.console.app import REFRESH_HZ, Console
from gcs.console.help import HelpScreen
from gcs.console.plain_lines import PlainLines
from gcs.console.questions import CONFIRM_S
from gcs.console.source import LIVE_HINT, Key
from gcs.console.widgets import AlertBoard, Detail, Lines, LogPanel, Plan, Prompt, StatusBar, VehicleTable
from gcs.picture import station_journal
from gcs.picture.values import Picture
from onboard.wire.bus import messages
from onboard.wire.bus.messages import Command, CommandKind, CommandReply, CommandState, Phase
from tests.support.sample_messages import START_NS, Tower, decision, health, phase, setup, state


class Desk:
    """A source over a tower: what the operator does is remembered and shown."""

    title = "live"
    steers = True
    leaving = "leave the console? vehicles fly on"

    def __init__(self, tower: Tower, keys: tuple[Key, ...] = ()) -> None:
        self.tower = tower
        self.keys = keys
        self.given: list[tuple[str, tuple[int, ...]]] = []
        self.acted: list[str] = []

    def picture(self) -> Picture:
        return self.tower.picture

    def hint(self) -> str:
        return LIVE_HINT

    def nobody(self) -> tuple[str, ...]:
        return ("listening at tcp/127.0.0.1:7447", "sim-bridge serve demo")

    def status(self) -> str:
        return "listening at tcp/127.0.0.1:7447"

    def act(self, action: str) -> str:
        self.acted.append(action)
        return f"did {action}"

    def command(self, kind: CommandKind, ids: Iterable[int], *, named: bool = False) -> str:
        self.given.append((kind.value, tuple(ids)))
        order = Command(f"c{len(self.given)}", kind, "anna", self.tower.now_ns)
        self.tower.note(station_journal.SENT, station_journal.Sent(order, tuple(ids)))
        return ""

    def acknowledge(self, alert: str) -> None:
        self.tower.note(station_journal.ACKNOWLEDGED, station_journal.Acknowledged(alert, "anna"))


def desk(count: int = 6, **changes: object) -> Desk:
    """A game of `count` vehicles that runs."""
    tower = Tower()
    tower.hear(setup(count, pursuer_speed=6.0, **changes), messages.Master("bridge", START_NS, lease_s=1e3))
    tower.hear(phase(Phase.STAGING))
    tower.fly(1.0, *range(1, count + 1), state_hz=4)
    for i in range(1, count + 1):
        tower.hear(decision(i, tower.now_ns, circles=((50.0, 150.0, -50.0, 60.0),)))
    return Desk(tower)


def screen(app: Console) -> str:
    """What is on the terminal, as text."""
    return "\n".join("".join(segment.text for segment in strip) for strip in strips(app))


def strips(app: Console) -> list[Strip]:
    """The lines of the terminal; Textual gives them away in no public place."""
    return app.screen._compositor.render_strips()


async def test_the_whole_picture_is_on_80_by_24():
    app = Console(desk())
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        shown = screen(app)
        lines = shown.splitlines()
        assert len(lines) == 24
        assert all(len(line) == 80 for line in lines)
        for word in ("meeting STAGING", "6 vehicles", "evad ok", "purs ok", "intercept", "no alerts"):
            assert word in shown
        assert "1 evader: ok" in app.query_one(Detail).text
        assert "x ABORT ALL" in lines[-1]


@pytest.mark.parametrize("size", [(80, 24), (100, 30), (119, 50), (120, 24), (200, 60), (60, 15)])
async def test_every_size_shows_every_panel_that_fits(size):
    app = Console(desk())
    async with app.run_test(size=size) as pilot:
        await pilot.pause()
        assert len(screen(app).splitlines()) == size[1]
        wide = size[0] >= 150
        plan, table = app.query_one(Plan).region, app.query_one(VehicleTable).region
        assert (plan.x > table.x) is wide
        if size[0] >= 80 and size[1] >= 24:
            assert all(panel.size.area > 0 for panel in app.query(Lines))


async def test_the_terminal_is_resized_under_way():
    app = Console(desk())
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("down", "down")
        for size in ((140, 40), (30, 8), (80, 24)):
            await pilot.resize_terminal(*size)
            await pilot.pause()
        assert app.selected == 3
        assert "↑[3]" in app.query_one(Plan).text


async def test_arrows_select_and_the_detail_and_the_plan_follow():
    app = Console(desk())
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("down", "j", "down", "up")
        assert app.selected == 3
        detail = app.query_one(Detail).text
        assert "3 pursuer: ok" in detail
        for word in ("rule intercept", "aim N 200 E 100 up 50 m", "predicted miss 1.5 m", "evader 200.0 m"):
            assert word in detail
        assert "[3]" in app.query_one(Plan).text
        await pilot.press(*["down"] * 10)
        assert app.selected == 6


async def test_one_key_aborts_everybody_without_a_question():
    source = desk()
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("x")
        assert source.given == [("abort", (1, 2, 3, 4, 5, 6))]
        await pilot.pause()
        assert "abort: 0 of 6 confirmed; no answer: 1, 2, 3, 4, 5, 6" in app.query_one(AlertBoard).text
        for i in (1, 2, 4, 5, 6):
            answer = CommandReply("c1", i, CommandState.CONFIRMED, "", "anna", START_NS, "LOITER")
            source.tower.note(station_journal.REPLIED, station_journal.Replied(answer))
        app.refresh_picture()
        assert "abort: 5 of 6 confirmed; no answer: 3" in app.query_one(AlertBoard).text


@pytest.mark.parametrize("where", [("colon", "h", "o"), ("question_mark",), ("l",)])
async def test_abort_works_while_typing_in_the_help_and_at_a_question(where):
    source = desk()
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press(*where, "ctrl+x")
        assert source.given == [("abort", (1, 2, 3, 4, 5, 6))]


@pytest.mark.parametrize(("key", "kind"), [("b", "return"), ("l", "land")])
async def test_what_ends_a_flight_asks_first(key, kind):
    source = desk()
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("down", key)
        assert source.given == []
        assert app.query_one(Prompt).said == f"{kind} 2?  y: yes, n: no"
        await pilot.press("escape", "y")
        assert source.given == []
        await pilot.press(key, "y")
        assert source.given == [(kind, (2,))]
        await pilot.press(key, key)
        assert source.given == [(kind, (2,))] * 2


async def test_another_key_does_not_answer_the_question_and_it_expires():
    source = desk()
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("l", "down", "l")  # asks about 1, then about 2
        assert source.given == []
        assert app.query_one(Prompt).said.startswith("land 2?")
        source.tower.wait(CONFIRM_S + 1.0)
        app.refresh_picture()
        await pilot.press("y")
        assert source.given == []
        assert app.query_one(Prompt).said == "not done"


async def test_hold_and_resume_are_one_key():
    source = desk()
    async with Console(source).run_test(size=(80, 24)) as pilot:
        await pilot.press("down", "h", "r")
        assert source.given == [("hold", (2,)), ("resume", (2,))]


async def typed(app: Console, pilot, text: str) -> str:
    """Type a line; what the console says."""
    await pilot.press("colon")
    await pilot.press(*("space" if sign == " " else sign for sign in text), "enter")
    return app.query_one(Prompt).said


async def test_the_command_line_commands_roles_ranges_and_all():
    source = desk()
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        assert await typed(app, pilot, "hold pursuers") == "hold to 2, 3, 4, 5, 6"
        assert await typed(app, pilot, "resume 2 4-5") == "resume to 2, 4, 5"
        assert await typed(app, pilot, "start all") == "start to all 6"
        assert await typed(app, pilot, "abort") == "abort to all 6"
        said = await typed(app, pilot, "land all")
        assert said == "land all 6?  y: yes, n: no"
        await pilot.press("y")
        kinds = [kind for kind, _ in source.given]
        assert kinds == ["hold", "resume", "start", "abort", "land"]
        assert source.given[1][1] == (2, 4, 5)


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("jump", "not understood: jump"),
        ("hold 9", "no vehicle 9"),
        ("hold tracker", "no tracker is known"),
        ("hold me", "whom is me?"),
        ("sort colour", "sort by one of"),
        ("select 77", "no vehicle 77"),
    ],
)
async def test_what_is_not_understood_is_said_and_nothing_happens(text, answer):
    source = desk()
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        assert (await typed(app, pilot, text)).startswith(answer)
        assert source.given == []


async def test_the_command_line_can_be_left():
    source = desk()
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("colon", "l", "a", "n", "d", "escape", "down")
        assert source.given == []
        assert app.selected == 2


async def test_the_table_is_sorted_by_key_command_and_mouse():
    source = desk()
    for i, battery in ((2, 0.5), (3, 0.9), (4, 0.4)):
        source.tower.hear(health(i, source.tower.now_ns, battery=battery))
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await typed(app, pilot, "sort battery")
        assert [row.id for row in app.table][:2] == [4, 2]
        await pilot.press("S")
        assert [row.id for row in app.table][-2:] == [2, 4]
        assert "bat▾" in app.query_one(VehicleTable).text
        await pilot.press("s")
        assert app.sort == "link"
        await pilot.click(VehicleTable, offset=(2, 0))
        assert app.sort == "id"
        await pilot.click(VehicleTable, offset=(10, 4))
        assert app.selected == 4


async def test_alerts_are_shown_with_what_to_do_and_acknowledged():
    source = desk()
    source.tower.fly(3.0, *range(1, 6), state_hz=4)  # 6 is silent
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        assert coloured(app)
        board = app.query_one(AlertBoard)
        assert "E vehicle 6 is lost: silent from all sources  → look for it" in board.text
        assert "1 LOST" in app.query_one(StatusBar).text
        assert "LOST" in app.query_one(VehicleTable).text
        assert "✕6" in app.query_one(Plan).text
        await pilot.press("a")
        assert "✓ vehicle 6 is lost" in board.text
        await pilot.press("a")
        assert app.query_one(Prompt).said == "nothing to acknowledge"


async def test_the_log_scrolls():
    source = desk()
    for n in range(1, 60):
        source.tower.hear(messages.Event(2, n, START_NS, messages.Severity.INFO, "note", f"event {n}"))
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        log = app.query_one(LogPanel)
        assert "event 59" in log.text
        await pilot.press(*["pageup"] * 5)
        assert "event 59" not in log.text
        await pilot.press(*["pagedown"] * 9)
        assert "event 59" in log.text


async def test_the_help_names_every_key_and_command_and_is_left_again():
    app = Console(desk())
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("question_mark")
        assert isinstance(app.screen, HelpScreen)
        assert "ABORT ALL" in screen(app)
        text = app.screen.text.plain
        for kind in CommandKind:
            assert f"\n  {kind.value} [WHOM]" in text
        for binding in app.BINDINGS:
            assert binding.description in text or binding.key.startswith("ctrl")
        await pilot.press("escape")
        assert not isinstance(app.screen, HelpScreen)


async def test_zoom_follow_and_layers():
    app = Console(desk())
    async with app.run_test(size=(140, 40)) as pilot:
        await pilot.pause()
        fitted = app.view
        await pilot.press("minus", "minus")
        assert app.view.scale > 2 * fitted.scale
        await pilot.press("plus", "plus")
        assert app.view.scale == fitted.scale
        await pilot.press("down", "c")
        assert (app.view.north, app.view.east) == (0.0, 200.0)
        with_circles = app.query_one(Plan).text
        await pilot.press("o", "t")
        assert app.query_one(Plan).text != with_circles
        await pilot.press("f")
        assert not app.follows


async def test_leaving_asks_once():
    app = Console(desk())
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press("q")
        assert app.query_one(Prompt).said.startswith("leave the console? vehicles fly on")
        await pilot.press("escape")
        assert app.is_running
        await pilot.press("q", "q")
    assert app.return_code == 0


class BusyTimers(Console):
    """A console whose timers run at each step of its closing, as they may."""

    ran = 0

    async def _prune(self, *nodes, **options):
        self._timers_run()
        await super()._prune(*nodes, **options)
        self._timers_run()

    async def _close_all(self):
        await super()._close_all()
        self._timers_run()

    def _timers_run(self):
        self.refresh_picture()
        self.show()
        self._hint_again()
        self.ran += 1


@pytest.mark.parametrize("keys", [(), ("q", "q"), ("b",), ("question_mark",), ("colon", "h")])
async def test_timers_that_still_run_while_it_closes_do_no_harm(keys):
    source = desk()
    app = BusyTimers(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.press(*keys)
        source.tower.wait(CONFIRM_S + 1.0)  # a question has lapsed by then
    assert app.ran >= 3  # before and after a screen goes, and when all are gone


async def test_a_source_brings_keys_of_its_own():
    source = desk()
    source.keys = (Key("space", "pause", "pause and go on"), Key("plus", "faster", "play faster"))
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        scale = app.view.scale
        await pilot.press("space", "plus")
        assert source.acted == ["pause", "faster"]
        assert app.query_one(Prompt).said == "did faster"
        assert app.view.scale == scale  # the source's keys go before the console's
        await pilot.press("question_mark")
        assert "pause and go on" in app.screen.text.plain


async def test_two_hundred_vehicles_are_scrolled_through():
    app = Console(desk(200))
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        assert "0↑ 194↓" in app.query_one(VehicleTable).text
        await pilot.press(*["down"] * 20)
        assert app.selected == 21
        assert " 21 purs" in app.query_one(VehicleTable).text


def coloured(app: Console) -> bool:
    """Whether anything on the terminal has a hue."""
    for strip in strips(app):
        for segment in strip:
            colour = segment.style.color if segment.style else None
            if colour is not None and len(set(colour.get_truecolor())) > 1:
                return True
    return False


async def test_without_colour_everything_is_still_said(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    source = desk()
    source.tower.fly(3.0, *range(1, 6), state_hz=4)
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        assert app.no_color
        assert not coloured(app)
        for word in ("LOST", "ok", "▸", "E vehicle 6 is lost", "✕6", "↑[E1]"):
            assert word in screen(app)


async def test_before_anybody_is_heard_it_says_so_and_takes_no_command():
    source = Desk(Tower())
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        assert "no vehicle heard yet" in screen(app)
        assert "no master heard" in screen(app)
        await pilot.press("x", "h", "l", "y")
        assert await typed(app, pilot, "hold all") == "no vehicle is known yet"
        assert source.given == []


def test_the_refresh_rate_spares_a_slow_line():
    assert 2.0 <= REFRESH_HZ <= 4.0


async def test_only_lines_that_have_changed_are_drawn_again(monkeypatch):
    source = desk()
    app = Console(source)
    drawn: list[int] = []
    draw = VehicleTable.render_line

    def counting(table: VehicleTable, y: int):
        drawn.append(y)
        return draw(table, y)

    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        monkeypatch.setattr(VehicleTable, "render_line", counting)
        app.refresh_picture()
        await pilot.pause()
        assert drawn == []
        source.tower.hear(state(4, source.tower.now_ns, mode="LOITER"))
        app.refresh_picture()
        await pilot.pause()
        assert set(drawn) == {4}
        assert "LOITER" in screen(app).splitlines()[5]


async def test_words_from_the_network_cannot_steer_the_terminal():
    source = desk()
    evil = "\x1b[2J\x07calm\nE all is lost"
    source.tower.hear(messages.Event(2, 1, START_NS, messages.Severity.INFO, "note", evil))
    source.tower.hear(state(2, source.tower.now_ns, mode="\x1b[31m"))
    app = Console(source)
    async with app.run_test(size=(80, 24)) as pilot:
        await pilot.pause()
        assert all(segment.text.isprintable() for strip in strips(app) for segment in strip)
        assert "·[2J·calm·E all is lost" in screen(app)
    assert all(line.isprintable() for line in PlainLines().lines(source.tower.picture))
