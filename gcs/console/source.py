"""What a console shows and steers: a live station, or a recording."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple, Protocol

from gcs.picture.values import Picture
from onboard.wire.bus.messages import CommandKind

LIVE_HINT = "x ABORT ALL  : type  h hold  r resume  b return  l land  a ack  e events  ? help"


class Key(NamedTuple):
    """A key that a source understands beside the console's own (a replay: pause, speed, seek, step)."""

    key: str  # as Textual names it: "space", "right", "ctrl+right", "p"
    action: str  # handed to `Source.act`
    text: str  # for footer and help


class Source(Protocol):
    """Where a console's picture comes from."""

    @property
    def title(self) -> str:
        """For the title bar: `live` or the run's name."""
        ...

    @property
    def keys(self) -> tuple[Key, ...]:
        """Keys of its own; they go before the console's."""
        ...

    @property
    def steers(self) -> bool:
        """Whether commands reach anybody; where they do not, the console offers none."""
        ...

    @property
    def leaving(self) -> str:
        """What is asked before one leaves, "" = nothing."""
        ...

    def hint(self) -> str:
        """The last line while nothing else is to be said: the keys that matter most."""
        ...

    def nobody(self) -> tuple[str, ...]:
        """What to read where no vehicle is known: where it listens, and what to start."""
        ...

    def picture(self) -> Picture:
        """The picture to show now; called at the console's refresh rate."""
        ...

    def status(self) -> str:
        """One line about itself: the bus and the recording; or pause, speed and place of a replay."""
        ...

    def act(self, action: str) -> str:
        """A key of its own was pressed; what to tell the user, "" = nothing."""
        ...

    def command(self, kind: CommandKind, ids: Iterable[int], *, named: bool = False) -> str:
        """Give a command; what to tell the user. A recording refuses in words.

        `named`: a person has named the one vehicle, and confirms the mode that is shown of it."""
        ...

    def acknowledge(self, alert: str) -> None:
        """The user has seen an alert; "" = all."""
        ...
