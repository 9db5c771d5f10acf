"""`gcs --plain`: lines for logs and screen readers. Pure; the caller prints."""

from __future__ import annotations

from gcs.console.status_line import clock
from gcs.console.vehicle_table import GRADE_WORDS, age, grades
from gcs.picture.current import current
from gcs.picture.knowledge import goal_lines
from gcs.picture.team import band_in_words, part_of
from gcs.picture.terminal_text import printable
from gcs.picture.values import LogLine, Picture
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Severity

STATUS_EVERY_S = 5.0
WORDS = {Severity.ERROR: "ERROR ", Severity.WARNING: "WARNING ", Severity.INFO: ""}


class PlainLines:
    """Turns pictures into lines: each new entry of the log once, and now and then how all are."""

    def __init__(self) -> None:
        self._last: LogLine | None = None
        self._status_ns: int | None = None

    def lines(self, picture: Picture) -> list[str]:
        """What is to be printed now."""
        found = [_entry(entry) for entry in self._fresh(picture)]
        due = self._status_ns is None or picture.now_ns - self._status_ns >= STATUS_EVERY_S * NS_PER_S
        if due:
            self._status_ns = picture.now_ns
            found += status(picture)
        return [printable(line) for line in found]

    def _fresh(self, picture: Picture) -> list[LogLine]:
        log = picture.log
        start = 0
        if self._last is not None:
            for index in range(len(log) - 1, -1, -1):
                if log[index] is self._last:
                    start = index + 1
                    break
        if log:
            self._last = log[-1]
        return list(log[start:])


def _entry(entry: LogLine) -> str:
    named = f"vehicle {entry.id}"
    who = f"{named}: " if entry.id and not entry.text.startswith((named, f"over: {named}")) else ""
    return f"{clock(entry.at_ns)} {WORDS[entry.severity]}{who}{entry.text}"


def status(picture: Picture) -> list[str]:
    """How the game and each vehicle are, a line each."""
    picture = current(picture)
    game = picture.game
    at = clock(picture.now_ns)
    phase = game.phase.value if game.phase else "no game"
    name = game.setup.scenario if game.setup else game.name
    alerts = len(picture.alerts)
    said = f"{at} STATUS {name} {phase} {game.clock}, {len(picture.vehicles)} vehicles, {alerts} alerts"
    if game.plan is not None:
        said += f", {band_in_words(game.plan)}"
    lines = [said, *(f"{at} STATUS {text}" for text in goal_lines(game))]
    graded = grades(picture)
    for vehicle in picture.vehicles:
        health = vehicle.health
        parts = [
            f"{at} STATUS vehicle {vehicle.id}",
            vehicle.role.value if vehicle.role else "role unknown",
            GRADE_WORDS[graded[vehicle.id]],
            vehicle.mode or "no mode",
            health.stage.value if health else "no health",
            f"link {health.link_quality:.0%}" if health and health.autopilot else "link unknown",
            f"battery {health.battery:.0%}" if health and health.battery >= 0 else "battery unknown",
            f"heard {age(vehicle.age_s)} s ago",
        ]
        if vehicle.rule:
            parts.append(f"rule {vehicle.rule}")
        part = part_of(game.plan, vehicle.id)
        if part is not None:
            parts.append(f"role {part.role.value}")
        lines.append(" ".join(parts))
    return lines
