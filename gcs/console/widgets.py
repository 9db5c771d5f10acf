"""The console's panels. Each is shown values and draws lines; none holds state of the fleet.

They draw only the lines in view, so that two hundred vehicles cost no more than six.
"""

from __future__ import annotations

from textwrap import wrap

from rich.segment import Segment
from rich.style import Style
from rich.text import Text
from textual import events
from textual.app import ComposeResult
from textual.containers import Horizontal
from textual.geometry import Region
from textual.message import Message
from textual.strip import Strip
from textual.widget import Widget
from textual.widgets import Input, Static

from gcs.console import plan
from gcs.console.detail import detail
from gcs.console.status_line import alert_lines, hidden_alerts, log_lines, status_line
from gcs.console.vehicle_table import STYLES, Row, column_at, heading, line
from gcs.picture.terminal_text import printable
from gcs.picture.values import Picture

Runs = list[tuple[str, str]]


class Lines(Widget):
    """A panel of styled lines."""

    def __init__(self, *, id: str) -> None:
        super().__init__(id=id)
        self.lines: list[Runs] = []

    def put(self, lines: list[Runs]) -> None:
        """Show these lines; only those that have changed are drawn again."""
        old, self.lines = self.lines, lines
        width = self.size.width
        changed = [
            Region(0, y, width, 1)
            for y in range(max(len(lines), len(old)))
            if y >= len(lines) or y >= len(old) or lines[y] != old[y]
        ]
        if changed:
            self.refresh(*changed)

    def render_line(self, y: int) -> Strip:
        """One line of the panel as Textual draws it."""
        width = self.size.width
        runs = self.lines[y] if y < len(self.lines) else []
        base = self.rich_style
        strip = Strip([Segment(printable(text), base + Style.parse(style)) for text, style in runs])
        if strip.cell_length > width > 0:
            more = Segment("…", base + Style.parse(runs[-1][1]))
            strip = Strip([*strip.crop(0, width - 1), more])
        return strip.adjust_cell_length(width, base).crop(0, width)

    @property
    def text(self) -> str:
        """What it shows, without style."""
        return "\n".join("".join(text for text, _ in runs) for runs in self.lines)


class StatusBar(Lines):
    """Game, phase, clock, what the situation promises, the bus."""

    def show(self, picture: Picture, title: str, status: str) -> None:
        """Show the one line."""
        self.put([status_line(picture, title, status, self.size.width)])


class VehicleTable(Lines):
    """The vehicles, one a line, below a heading one can click."""

    class Picked(Message):
        """A vehicle was clicked."""

        def __init__(self, vehicle_id: int) -> None:
            super().__init__()
            self.vehicle_id = vehicle_id

    class Sorted(Message):
        """A heading was clicked."""

        def __init__(self, column: str) -> None:
            super().__init__()
            self.column = column

    def __init__(self, *, id: str) -> None:
        super().__init__(id=id)
        self.first = 0
        self.shown: list[Row] = []

    def show(
        self, table: list[Row], selected: int | None, sort: str, descending: bool, nobody: tuple[str, ...]
    ) -> None:
        """Show the part of the table that holds the selected vehicle; without any, `nobody`."""
        width, room = self.size.width, max(1, self.size.height - 1)
        ids = [row.id for row in table]
        at = ids.index(selected) if selected in ids else 0
        self.first = max(0, min(self.first, at, len(ids) - room), at - room + 1)
        self.shown = table[self.first : self.first + room]
        more = len(table) - self.first - len(self.shown)
        top = " " + heading(sort, descending, width - 1)
        if self.first or more:
            note = f" {self.first}↑ {more}↓"
            top = top[: max(0, width - len(note))] + note
        lines: list[Runs] = [[(top, "bold underline")]]
        for row in self.shown:
            style = STYLES[row.grade] + (" reverse" if row.id == selected else "")
            lines.append([("▸" if row.id == selected else " ", style), (line(row.cells, width - 1), style)])
        if not table:
            lines += [[("no vehicle heard yet", "bold")], *([(text, "dim")] for text in nobody)]
        self.put(lines)

    def on_click(self, event: events.Click) -> None:
        """Select a vehicle, or sort by a column."""
        if event.y == 0:
            column = column_at(event.x - 1, self.size.width - 1)
            if column is not None and column.sort:
                self.post_message(self.Sorted(column.sort))
        elif 0 <= event.y - 1 < len(self.shown):
            self.post_message(self.Picked(self.shown[event.y - 1].id))


class Plan(Lines):
    """The field from above."""

    def show(self, picture: Picture, view: plan.View, selected: int | None, options: plan.Options) -> None:
        """Show the part of the field that the view holds."""
        if self.size.width and self.size.height:
            self.put(plan.plan(picture, view, self.size.width, self.size.height, selected, options))


class Detail(Lines):
    """The selected vehicle in words."""

    def show(self, picture: Picture, selected: int | None, hidden: frozenset[str]) -> None:
        """Show as many lines as there is room for; `hidden` names alerts that the board has no room for."""
        width = max(8, self.size.width)
        told = detail(picture, selected, hidden)
        self.put([[(part, style)] for text, style in told for part in wrap(text, width) or [""]])


class AlertBoard(Lines):
    """Alerts in force, and commands that not everybody has confirmed."""

    def show(self, picture: Picture) -> None:
        """Show open commands and alerts, the worst first."""
        self.put(alert_lines(picture, self.size.width, self.size.height))

    def hidden(self, picture: Picture) -> frozenset[str]:
        """The alerts that it has no room for."""
        return hidden_alerts(picture, self.size.height)


class LogPanel(Lines):
    """The event log; the newest at the bottom."""

    def __init__(self, *, id: str) -> None:
        super().__init__(id=id)
        self.back = 0  # lines scrolled back from the newest
        self._picture: Picture | None = None

    def show(self, picture: Picture) -> None:
        """Show the page one is on."""
        self._picture = picture
        lines = log_lines(picture)
        self.back = max(0, min(self.back, len(lines) - self.size.height))
        end = len(lines) - self.back
        self.put(lines[max(0, end - self.size.height) : end])

    def scroll_pages(self, pages: int) -> None:
        """Back (−1) or forward (1)."""
        self.back -= pages * max(1, self.size.height - 1)
        if self._picture is not None:
            self.show(self._picture)


class Prompt(Horizontal):
    """The last line: a hint, what was said last, or the command line."""

    DEFAULT_CSS = """
    Prompt { height: 1; }
    Prompt Input { height: 1; border: none; padding: 0; width: 1fr; display: none; }
    Prompt Input:focus { border: none; }
    Prompt Static { width: 1fr; height: 1; }
    Prompt.typing Input { display: block; }
    Prompt.typing Static { display: none; }
    """

    def __init__(self, *, id: str) -> None:
        super().__init__(id=id)
        self.said = ""
        self._style = ""
        self._hint = ""

    def compose(self) -> ComposeResult:
        """The hint and the command line, of which one is shown."""
        yield Static("", id="hint", markup=False)
        example = "abort, hold 2 3, return pursuers, land all, ack, help …"
        yield Input(placeholder=example, id="line", disabled=True)

    def say(self, text: str, style: str = "") -> None:
        """Show a text in place of the hint; "" brings the hint back."""
        self.said, self._style = text, style
        self._draw()

    def hint(self, text: str) -> None:
        """What to show while nothing is said."""
        if text != self._hint:
            self._hint = text
            self._draw()

    def _draw(self) -> None:
        self.query_one("#hint", Static).update(Text(self.said or self._hint, self._style or "none"))

    def open(self) -> None:
        """Show an empty command line, ready to be typed in."""
        self.add_class("typing")
        line = self.query_one(Input)
        line.value = ""
        line.disabled = False
        line.focus()

    def close(self) -> None:
        """Put the command line away and show the hint again."""
        self.remove_class("typing")
        self.query_one(Input).disabled = True
        self.screen.set_focus(None)
