"""A field of our own: keys made as `gcs keys init` makes them, for tests that try them on a real bus."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

from gcs.keys import folder as keys
from onboard.config.strict import parse
from onboard.game.field_roster import FieldRoster
from tests.support.bus_stages import free_port

ROSTER = """
game = "range"
host = "127.0.0.1"
port = {port}
days = 30

[[stations]]
name = "ground"
parts = ["master"]

[[stations]]
name = "second"

[[stations]]
name = "radar"
parts = ["sensor"]
commands = false

[[vehicles]]
id = 1
role = "evader"

[[vehicles]]
id = 2
role = "pursuer"

[[vehicles]]
id = 3
role = "pursuer"
"""


class Field:
    """Keys in a folder, and what they were made from."""

    def __init__(self, folder: Path, port: int | None = None) -> None:
        self.folder = folder
        self.port = free_port() if port is None else port
        self.text = ROSTER.format(port=self.port)
        self.roster = parse(self.text, FieldRoster, "roster")
        self.issued: list[keys.Issued] = []

    def make(self, now: datetime | None = None) -> Field:
        """Make the keys, or bring them up to date, at an instant (now unless told)."""
        when = datetime.now(UTC) if now is None else now
        self.issued = keys.init(self.roster, self.text.encode(), self.folder, when)
        return self

    def change(self, old: str, new: str) -> None:
        """Write the roster anew, one part of it replaced."""
        assert old in self.text
        self.text = self.text.replace(old, new, 1)
        self.roster = parse(self.text, FieldRoster, "roster")

    def config(self, member: str) -> Path:
        """A member's Zenoh configuration."""
        return self.folder / member / keys.ZENOH_FILE


def expired() -> datetime:
    """An instant at which certificates were made that have ended by now."""
    return datetime.now(UTC) - timedelta(days=60)
