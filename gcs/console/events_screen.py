"""Alerts, the selected vehicle and the log whole: lines wrap, nothing is cut."""

from __future__ import annotations

from typing import ClassVar

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

from gcs.console.detail import detail
from gcs.console.status_line import whole_text
from gcs.picture.terminal_text import printable
from gcs.picture.values import Picture


class EventsScreen(ModalScreen[None]):
    """Everything that the panels have no room for, over the console; it goes on with the picture."""

    CSS = """
    EventsScreen { align: center middle; }
    #events { width: 100%; height: 100%; padding: 0 1; background: $surface; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,e,q,enter", "app.pop_screen", "back", show=False),
        Binding("x", "app.abort_all", "abort all", show=False),
        Binding("a", "app.acknowledge('')", "acknowledge", show=False),
    ]

    def __init__(self, picture: Picture, selected: int | None) -> None:
        super().__init__()
        self.text = Text()
        self.read(picture, selected)

    def compose(self) -> ComposeResult:
        """The text, which scrolls."""
        with VerticalScroll(id="events"):
            yield Static(self.text, id="whole")

    def show(self, picture: Picture, selected: int | None) -> None:
        """Show the picture as it is now."""
        self.read(picture, selected)
        for static in self.query("#whole").results(Static):
            static.update(self.text)

    def read(self, picture: Picture, selected: int | None) -> None:
        """Put the picture into words."""
        self.text = Text("↑ ↓ PgUp PgDn scroll, Esc leaves\n\n", "dim")
        for said, style in whole_text(picture, selected, detail(picture, selected)):
            self.text.append(said if said == "\n" else _lines(said), style or None)


def _lines(said: str) -> str:
    """Text made fit for a terminal; the ends of its lines stay."""
    return "\n".join(printable(line) for line in said.split("\n"))
