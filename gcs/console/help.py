"""The help screen."""

from __future__ import annotations

from collections.abc import Iterable
from typing import ClassVar

from rich.text import Text
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import VerticalScroll
from textual.screen import ModalScreen
from textual.widgets import Static

from gcs.console import command_parser, plan
from gcs.console.source import Key

KEY_NAMES = {
    "colon": ":", "slash": "/", "question_mark": "?", "plus": "+", "equals_sign": "=", "minus": "-",
    "full_stop": ".", "comma": ",", "escape": "Esc", "pageup": "PgUp", "pagedown": "PgDn", "up": "↑",
    "down": "↓", "left": "←", "right": "→", "enter": "Enter", "space": "Space", "home": "Home", "end": "End",
    "ctrl": "Ctrl", "f1": "F1",
}  # fmt: skip


class HelpScreen(ModalScreen[None]):
    """Keys, commands and signs, over the console."""

    CSS = """
    HelpScreen { align: center middle; }
    #help { width: 78; max-width: 100%; height: 90%; border: round; padding: 0 1; background: $surface; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("escape,question_mark,f1,q,enter", "app.pop_screen", "back", show=False),
        Binding("x", "app.abort_all", "abort all", show=False),
    ]

    def __init__(self, keys: Iterable[tuple[str, str, str]], own: Iterable[Key], steers: bool = True) -> None:
        super().__init__()
        self.text = help_text(keys, own, steers)

    def compose(self) -> ComposeResult:
        """The text in a frame that scrolls."""
        with VerticalScroll(id="help"):
            yield Static(self.text)


def help_text(keys: Iterable[tuple[str, str, str]], own: Iterable[Key], steers: bool = True) -> Text:
    """Everything one needs to know, on two screens of 80×24; without commands where nobody hears them."""
    text = Text()
    text.append("Keys", "bold")
    text.append("  (↑ ↓ scroll, Esc leaves)\n")
    for key in own:
        _entry(text, _named(key.key), key.text)
    for names, _, said in keys:
        _entry(text, _named(names), said)
    text.append("\nCommand line", "bold")
    text.append("  (: or Enter opens it)\n")
    for form, said in command_parser.HELP_LINES:
        if steers or "WHOM" not in form:
            _entry(text, form, said)
    if steers:
        text.append(f"  {command_parser.WHOM}\n")
    text.append("\nPlan\n", "bold")
    for sign, said in plan.LEGEND:
        _entry(text, sign, said)
    return text


def _entry(text: Text, left: str, right: str) -> None:
    text.append(f"  {left:<15}", "bold")
    text.append(f"{right}\n")


def _named(keys: str) -> str:
    """Keys as they are printed on keyboards: `Ctrl →`, `Space`."""
    return " ".join(" ".join(KEY_NAMES.get(part, part) for part in key.split("+")) for key in keys.split(","))
