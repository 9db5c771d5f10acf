"""A recording in the console: the console's keys steer the player, commands are refused in words."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

from gcs.console.source import Key
from gcs.picture.values import Picture
from gcs.recording.reader import Recording
from gcs.recording.shell import RECORDING
from gcs.replay.player import Player
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import CommandKind

JUMPS = {"back": -10, "on": 10, "far_back": -60, "far_on": 60}  # [s]


def open_run(run: Path) -> Recording:
    """The recording of a run folder, or a recording itself. Raises ConfigError with one line."""
    return Recording(run / RECORDING if run.is_dir() else run)


class ReplaySource:
    """Implements `gcs.console.source.Source`. `now_ns` is any steady clock."""

    steers = False
    leaving = ""  # nothing flies here

    def __init__(self, player: Player, name: str, now_ns: Callable[[], int]) -> None:
        self.player = player
        self._name = name
        self._now_ns = now_ns
        self._then_ns = now_ns()

    @property
    def title(self) -> str:
        """The run's name."""
        return f"replay of {self._name}"

    @property
    def keys(self) -> tuple[Key, ...]:
        """Keys of its own."""
        return (
            Key("space", "pause", "pause / play"),
            Key("right", "on", "10 s on"),
            Key("left", "back", "10 s back"),
            Key("ctrl+right", "far_on", "60 s on"),
            Key("ctrl+left", "far_back", "60 s back"),
            Key("full_stop", "step", "0.1 s on"),
            Key("comma", "step_back", "0.1 s back"),
            Key("plus", "faster", "faster"),
            Key("minus", "slower", "slower"),
            Key("home", "start", "to the start"),
            Key("end", "end", "to the end"),
        )

    def picture(self) -> Picture:
        """The picture at the place in the recording."""
        now_ns = self._now_ns()
        self.player.advance(now_ns - self._then_ns)
        self._then_ns = now_ns
        return self.player.picture()

    def status(self) -> str:
        """Place, length, speed, and whether it plays."""
        player = self.player
        state = "ended" if player.ended else "paused" if player.paused else "playing"
        return (
            f"{_minutes(player.at_ns - player.start_ns)} of {_minutes(player.end_ns - player.start_ns)}"
            f" ×{player.speed:g} {state}"
        )

    def hint(self) -> str:
        """Where it stands, and the keys that move it: no key commands anybody."""
        return f"{self.status()}  Space pause  ← → 10 s  , . 0.1 s  + - speed  e events  ? help  q leave"

    def nobody(self) -> tuple[str, ...]:
        """Nobody was recorded up to here."""
        return ("no vehicle recorded up to here", "→ goes 10 s on, End to the end")

    def act(self, action: str) -> str:
        """A key was pressed; what to tell the user."""
        player = self.player
        if action == "pause":
            player.pause(not player.paused)
            return "paused" if player.paused else "playing"
        if action in JUMPS:
            player.seek(player.at_ns + JUMPS[action] * NS_PER_S)
        elif action in ("step", "step_back"):
            player.step(1 if action == "step" else -1)
        elif action in ("faster", "slower"):
            return f"speed ×{player.faster(1 if action == 'faster' else -1):g}"
        elif action in ("start", "end"):
            player.seek(player.start_ns if action == "start" else player.end_ns)
        return ""

    def command(self, kind: CommandKind, ids: Iterable[int], *, named: bool = False) -> str:
        """Refused: nobody hears it."""
        return f"this is a recording: {kind.value} goes to nobody"

    def acknowledge(self, alert: str) -> None:
        """Nothing: what was acknowledged is in the recording."""


def _minutes(span_ns: int) -> str:
    seconds = span_ns / NS_PER_S
    return f"{int(seconds // 60)}:{seconds % 60:04.1f}"
