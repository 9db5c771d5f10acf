"""The console: a Textual application over a `Source`.

It refreshes at 3 Hz, because text on a slow line costs more than it tells; keys answer at once. All
thinking is in the pure modules beside this one.
"""

from __future__ import annotations

from typing import ClassVar

from textual.app import App, ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container
from textual.css.query import NoMatches
from textual.timer import Timer
from textual.widgets import Input, Static

from gcs.console import command_parser, plan
from gcs.console.events_screen import EventsScreen
from gcs.console.help import HelpScreen
from gcs.console.questions import Questions
from gcs.console.source import Source
from gcs.console.vehicle_table import Row, rows
from gcs.console.widgets import AlertBoard, Detail, LogPanel, Plan, Prompt, StatusBar, VehicleTable
from gcs.picture.current import current
from gcs.picture.values import Picture
from onboard.wire.bus.messages import CommandKind

REFRESH_HZ = 3.0
WIDE = 150  # columns from which on the plan stands beside the table
TALL = 30  # lines from which on the table and the log take their share
SMALLEST = (60, 15)  # columns and lines; in fewer it says so
SAID_S = 8.0  # and how long an answer of the console stands

KEYS: tuple[tuple[str, str, str], ...] = (  # key, action, text for the help
    ("x", "abort_all", "ABORT ALL: everybody holds or returns (ctrl+x while typing)"),
    ("up,k", "move(-1)", "select the vehicle above"),
    ("down,j", "move(1)", "select the vehicle below"),
    ("h", "order('hold')", "hold the selected vehicle"),
    ("r", "order('resume')", "resume the selected vehicle"),
    ("b", "order('return')", "bring the selected vehicle back (asks)"),
    ("l", "order('land')", "land the selected vehicle (asks)"),
    ("colon,slash,enter", "command_line", "type a command"),
    ("escape", "cancel", "leave the command line, answer no"),
    ("n", "cancel", "answer no"),
    ("y", "yes", "answer yes"),
    ("a", "acknowledge('')", "acknowledge the topmost alert"),
    ("A", "acknowledge('all')", "acknowledge all alerts"),
    ("s", "sort(1)", "sort by the next column"),
    ("S", "reverse", "turn the order round"),
    ("plus,equals_sign", "zoom(True)", "plan: closer"),
    ("minus", "zoom(False)", "plan: farther"),
    ("f", "fit", "plan: fit everything, and keep it fitted"),
    ("c", "follow", "plan: follow the selected vehicle"),
    ("t", "draw('trails')", "plan: trails on and off"),
    ("o", "draw('circles')", "plan: circles on and off"),
    ("pageup", "scroll_log(-1)", "log: back"),
    ("pagedown", "scroll_log(1)", "log: forward"),
    ("e", "events", "alerts, vehicle and events whole, nothing cut"),
    ("question_mark,f1", "help", "this help"),
    ("q", "leave", "leave the console; asks first where something flies"),
)
STEERING = ("abort_all", "order(")  # actions that a source without anybody to command does not have


class Console(App[int]):
    """The ground station's console."""

    TITLE = "Apollonius"
    ENABLE_COMMAND_PALETTE = False
    AUTO_FOCUS = None  # keys are for the console until one opens the command line
    HORIZONTAL_BREAKPOINTS = [  # noqa: RUF012 - as the base class has it
        (0, "-tiny"), (SMALLEST[0], "-narrow"), (WIDE, "-wide"),
    ]  # fmt: skip
    VERTICAL_BREAKPOINTS = [(0, "-flat"), (SMALLEST[1], "-low"), (TALL, "-tall")]  # noqa: RUF012
    BINDINGS: ClassVar[list[BindingType]] = [
        *(Binding(key, action, text, show=False) for key, action, text in KEYS),
        Binding("ctrl+x", "abort_all", "abort all", show=False, priority=True),
        Binding("ctrl+q,ctrl+c", "leave_now", "leave", show=False, priority=True),
    ]
    CSS = """
    #main { layout: grid; grid-size: 2; grid-gutter: 0 1; grid-columns: 1fr 1fr; grid-rows: 1 7 1fr 3 3 1; }
    #status, #vehicles, #alerts, #log, #prompt { column-span: 2; }
    #status, #alerts { background: $boost; }
    Screen.-tall #main { grid-rows: 1 3fr 4fr 2fr 3fr 1; }
    Screen.-wide #main { grid-columns: 96 1fr; }
    Screen.-wide #vehicles { column-span: 1; }
    Screen.-wide #plan { row-span: 2; }
    #small { display: none; column-span: 2; text-style: bold; }
    Screen.-tiny #main, Screen.-flat #main { grid-rows: 1fr 1; }
    Screen.-tiny .panel, Screen.-flat .panel { display: none; }
    Screen.-tiny #small, Screen.-flat #small { display: block; }
    """

    def __init__(self, source: Source) -> None:
        super().__init__()
        self.source = source
        self.selected: int | None = None
        self.sort = "id"
        self.descending = False
        self.view = plan.START
        self.keeps_fitted = True
        self.follows = False
        self.options = plan.Options()
        self.table: list[Row] = []
        self.questions = Questions()
        self._forget: Timer | None = None
        self.picture: Picture = source.picture()

    # ---- what is on the screen

    def compose(self) -> ComposeResult:
        """The panels, from top to bottom."""
        with Container(id="main"):
            for panel in (
                StatusBar(id="status"), VehicleTable(id="vehicles"), Plan(id="plan"), Detail(id="detail"),
                AlertBoard(id="alerts"), LogPanel(id="log"),
            ):  # fmt: skip
                panel.add_class("panel")
                yield panel
            yield Static("", id="small", markup=False)
            yield Prompt(id="prompt")

    def on_mount(self) -> None:
        """Take the source's own keys in, and begin to refresh."""
        for key in self.source.keys:
            self._bindings.key_to_bindings.pop(key.key, None)
            self._bindings.bind(key.key, f"source({key.action!r})", key.text, show=False)
        if not self.source.steers:
            for keys, action, _ in (*KEYS, ("ctrl+x", "abort_all", "")):
                for name in keys.split(",") if action.startswith(STEERING) else ():
                    self._bindings.key_to_bindings.pop(name, None)
        self.set_interval(1.0 / REFRESH_HZ, self.refresh_picture)
        self.refresh_picture()

    def on_resize(self) -> None:
        """Panels have other sizes now."""
        self.call_after_refresh(self.show)

    def refresh_picture(self) -> None:
        """Take the picture and show it."""
        if not self.is_running:  # closing: a timer may still call, and the screens are gone
            return
        self.picture = self.source.picture()
        if self.questions.lapsed(self.picture.now_ns):
            self.say("not done")
        self.show()

    def show(self) -> None:
        """Show the picture as it is, by the present settings."""
        if not self.is_running:
            return
        picture = self.picture
        if self.selected is None and picture.vehicles:
            self.selected = picture.vehicles[0].id
        self.table = rows(current(picture), self.sort, self.descending)
        try:
            self._show_all(picture)
        except NoMatches:  # not composed yet, or on its way out
            return

    def _show_all(self, picture: Picture) -> None:
        main = self.screen_stack[0]
        main.query_one(StatusBar).show(picture, self.source.title, self.source.status())
        nobody = self.source.nobody() if not self.table else ()
        main.query_one(VehicleTable).show(self.table, self.selected, self.sort, self.descending, nobody)
        area = main.query_one(Plan)
        self.view = self._view_of(picture, area.size.width, area.size.height)
        area.show(picture, self.view, self.selected, self.options)
        board = main.query_one(AlertBoard)
        main.query_one(Detail).show(picture, self.selected, board.hidden(picture))
        board.show(picture)
        main.query_one(LogPanel).show(picture)
        main.query_one(Prompt).hint(self.source.hint())
        width, height = self.size
        small = f"{width}×{height} is too small for the console: {SMALLEST[0]}×{SMALLEST[1]} at least"
        main.query_one("#small", Static).update(small)
        if isinstance(self.screen, EventsScreen):
            self.screen.show(picture, self.selected)

    def _view_of(self, picture: Picture, width: int, height: int) -> plan.View:
        view = self.view
        if self.keeps_fitted:
            view = plan.fitted(view, picture, width, height)
        chosen = picture.vehicle(self.selected) if self.selected is not None else None
        if self.follows and chosen is not None and chosen.position is not None:
            view = view._replace(north=chosen.position[0], east=chosen.position[1])
        return view

    def say(self, text: str, style: str = "") -> None:
        """Tell the user something in the prompt line; after a while its hint comes back."""
        if not self.is_running:
            return
        prompt = self.screen_stack[0].query_one(Prompt)
        prompt.say(text, style)
        if self._forget is not None:
            self._forget.stop()
        self._forget = self.set_timer(SAID_S, self._hint_again) if text else None

    def _hint_again(self) -> None:
        if self.questions.asked is None:
            self.say("")

    # ---- keys

    def action_source(self, action: str) -> None:
        """A key of the source's own."""
        self.say(self.source.act(action))
        self.refresh_picture()

    def action_abort_all(self) -> None:
        """Knock it off, everybody: one key, no dialogue."""
        self.questions.no()
        ids = tuple(vehicle.id for vehicle in self.source.picture().vehicles)
        if not ids:
            self.say("no vehicle is known yet", "bold yellow")
            return
        self._give(command_parser.Order(CommandKind.ABORT, ids))

    def action_order(self, kind: str) -> None:
        """A command to the selected vehicle; the same key again answers yes."""
        if self.selected is None:
            self.say("no vehicle is known yet", "bold yellow")
            return
        self._order(command_parser.Order(CommandKind(kind), (self.selected,), named=True))

    def action_move(self, step: int) -> None:
        """Select the next vehicle of the table."""
        ids = [row.id for row in self.table]
        if not ids:
            return
        at = ids.index(self.selected) if self.selected in ids else 0
        self.select(ids[max(0, min(len(ids) - 1, at + step))])

    def select(self, vehicle_id: int) -> None:
        """Show this vehicle's detail."""
        self.selected = vehicle_id
        self.show()

    def action_command_line(self) -> None:
        """Open the command line."""
        self._answer_no()
        self.query_one(Prompt).open()

    def action_cancel(self) -> None:
        """Leave the command line; answer no."""
        self._answer_no()
        self.query_one(Prompt).close()
        self.say("")

    def action_yes(self) -> None:
        """Yes to what was asked."""
        asked = self.questions.yes()
        if isinstance(asked, command_parser.Order):
            self._give(asked)
        elif isinstance(asked, command_parser.Do):
            self.exit(0)

    def action_acknowledge(self, what: str) -> None:
        """Mark the topmost alert, or all, as seen."""
        fresh = [alert.name for alert in self.picture.alerts if not alert.acknowledged]
        if not fresh:
            self.say("nothing to acknowledge")
            return
        self.source.acknowledge("" if what == "all" else what or fresh[0])
        self.refresh_picture()

    def action_sort(self, step: int) -> None:
        """Sort by the next column."""
        at = command_parser.SORTS.index(self.sort)
        self.sort_by(command_parser.SORTS[(at + step) % len(command_parser.SORTS)])

    def sort_by(self, column: str) -> None:
        """Sort by a column; by the same one again: the other way round."""
        self.descending = not self.descending if column == self.sort else False
        self.sort = column
        self.show()

    def action_reverse(self) -> None:
        """Turn the order round."""
        self.descending = not self.descending
        self.show()

    def action_zoom(self, closer: bool) -> None:
        """A round step closer or farther."""
        self.keeps_fitted = False
        self.view = plan.zoomed(self.view, closer)
        self.show()

    def action_fit(self) -> None:
        """Fit the plan to all vehicles again, and keep it fitted."""
        self.keeps_fitted, self.follows = True, False
        area = self.query_one(Plan).size
        self.view = plan.fitted(plan.View(1e9, 1e9, 1.0), self.picture, area.width, area.height)
        self.show()

    def action_follow(self) -> None:
        """Keep the selected vehicle in the middle."""
        self.follows = not self.follows
        self.keeps_fitted = not self.follows
        self.show()

    def action_draw(self, what: str) -> None:
        """Trails or circles on and off."""
        self.options = self.options._replace(**{what: not getattr(self.options, what)})
        self.show()

    def action_scroll_log(self, pages: int) -> None:
        """Back and forward in the log."""
        self.query_one(LogPanel).scroll_pages(pages)

    def action_help(self) -> None:
        """Show the help, or leave it."""
        if isinstance(self.screen, HelpScreen):
            self.pop_screen()
        else:
            own = {name for key in self.source.keys for name in key.key.split(",")}
            steers = self.source.steers
            keys = [
                (",".join(name for name in names.split(",") if name not in own), action, text)
                for names, action, text in KEYS if steers or not action.startswith(STEERING)
            ]  # fmt: skip
            keys = [key for key in keys if key[0]]
            self.push_screen(HelpScreen(keys, self.source.keys, steers))

    def action_events(self) -> None:
        """Show alerts, vehicle and events whole."""
        self.push_screen(EventsScreen(self.picture, self.selected))

    def action_leave(self) -> None:
        """Leave, after the source's question."""
        if isinstance(self.questions.asked, command_parser.Do) or not self.source.leaving:
            self.exit(0)
        else:
            self.questions.ask(command_parser.Do("quit"), self.picture.now_ns)
            self._ask(self.source.leaving)

    def action_leave_now(self) -> None:
        """Leave the console at once, without a question."""
        self.exit(0)

    def on_vehicle_table_picked(self, event: VehicleTable.Picked) -> None:
        """A vehicle was clicked."""
        self.select(event.vehicle_id)

    def on_vehicle_table_sorted(self, event: VehicleTable.Sorted) -> None:
        """A heading was clicked."""
        self.sort_by(event.column)

    # ---- the command line

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """A line was typed."""
        self.query_one(Prompt).close()
        meaning = command_parser.parse(event.value, self.picture, self.selected)
        if isinstance(meaning, command_parser.Wrong):
            self.say(meaning.reason, "bold yellow")
        elif isinstance(meaning, command_parser.Order):
            self._order(meaning)
        else:
            self._do(meaning)

    def _do(self, meaning: command_parser.Do) -> None:
        if meaning.what == "ack":
            self.action_acknowledge(meaning.argument)
        elif meaning.what == "select":
            self.select(int(meaning.argument))
        elif meaning.what == "sort":
            self.sort_by(meaning.argument)
        elif meaning.what == "help":
            self.action_help()
        else:
            self.exit(0)

    def _order(self, order: command_parser.Order) -> None:
        question = self.questions.put(order, self.picture)
        if question:
            self._ask(question)
        else:
            self._give(order)

    def _ask(self, question: str) -> None:
        self.say(f"{question}  y: yes, n: no", "bold reverse")

    def _answer_no(self) -> None:
        if self.questions.no():
            self.say("not done")

    def _give(self, order: command_parser.Order) -> None:
        said = self.source.command(order.kind, order.ids, named=order.named)
        self.say(said or f"{order.kind.value} to {command_parser.names(order.ids, self.picture)}", "bold")
        self.refresh_picture()
