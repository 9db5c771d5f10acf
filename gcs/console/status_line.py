"""Status line, alerts and log as styled lines. Pure."""

from __future__ import annotations

from datetime import UTC, datetime
from math import degrees

from gcs.picture.values import CommandView, LegState, Picture, Presence
from onboard.wire.bus.messages import Severity

Runs = list[tuple[str, str]]
SIGNS = {Severity.ERROR: "E", Severity.WARNING: "w", Severity.INFO: " "}
STYLES = {Severity.ERROR: "bold red", Severity.WARNING: "yellow", Severity.INFO: ""}


def status_line(picture: Picture, title: str, status: str, width: int) -> Runs:
    """Game, phase and clock to the left; the source's own words to the right, as far as there is room."""
    left = "  ".join(part for part in (f"Apollonius {title}", *_game(picture), _fleet(picture)) if part)
    right = _fitting(status, width - len(left) - 2)
    return [(f"{left}{right.rjust(max(0, width - len(left)))}"[:width], "bold")]


def _fitting(status: str, room: int) -> str:
    """As many whole parts of a status as there is room for, from the first."""
    while len(status) > room:
        status = status.rpartition(", ")[0]
        if not status:
            return ""
    return status


def _game(picture: Picture) -> list[str]:
    game = picture.game
    if game.setup is None and game.phase is None:
        return [f"game {game.name}: no master heard"]
    name = game.setup.scenario if game.setup else game.name
    phase = game.phase.value.upper() if game.phase else "setup"
    parts = [f"{name} {phase} {game.clock}"]
    if game.outcome is not None:
        by = f" by {game.outcome.captor}" if game.outcome.captor else ""
        parts.append(f"evader {game.outcome.verdict.value}{by}")
    elif picture.assessment is not None:
        found = picture.assessment
        gap = "encircled" if found.encircled else f"gap {degrees(found.largest_gap):.0f}°"
        parts.append(f"{gap}{', target denied' if found.target_denied else ''}")
    return parts


def _fleet(picture: Picture) -> str:
    lost = sum(v.presence is Presence.LOST for v in picture.vehicles)
    return f"{len(picture.vehicles)} vehicles" + (f", {lost} LOST" if lost else "")


def alert_lines(picture: Picture, width: int, height: int) -> list[Runs]:
    """Open commands first, then alerts, with what to do where there is room for it."""
    lines = [_command(command) for command in picture.commands if _shown(command, picture)]
    for alert in picture.alerts:
        style = "dim" if alert.acknowledged else STYLES[alert.severity]
        sign = "✓" if alert.acknowledged else SIGNS[alert.severity]
        lines.append([(f"{sign} {alert.text}", style), (f"  → {alert.advice}", "dim")])
    if not lines:
        lines.append([("no alerts", "dim")])
    if len(lines) > height > 0:
        hidden = len(lines) - height + 1
        lines = [*lines[: height - 1], [(f"… and {hidden} more", "bold yellow")]]
    return lines


def _shown(command: CommandView, picture: Picture) -> bool:
    """Open, or settled within the last five seconds."""
    return any(
        leg.open or picture.now_ns - command.issued_ns < (leg.took_s + 5.0) * 1e9 for leg in command.legs
    )


def _command(command: CommandView) -> Runs:
    done = sum(leg.state is LegState.CONFIRMED for leg in command.legs)
    text = f"{command.kind.value}: {done} of {len(command.legs)} confirmed"
    if command.confirmed:
        slowest = max(leg.took_s for leg in command.legs)
        return [(f"{text} in {slowest:.1f} s", "green")]
    groups: dict[str, list[str]] = {}
    for leg in command.legs:
        if leg.state is not LegState.CONFIRMED:
            said = f" ({leg.reason})" if leg.reason else ""
            groups.setdefault(leg.state.words, []).append(f"{leg.id}{said}")
    rest = "; ".join(f"{word}: {', '.join(ids)}" for word, ids in groups.items())
    return [(f"{text}; {rest}", "bold yellow")]


def log_lines(picture: Picture, width: int) -> list[Runs]:
    """The event log, oldest first: time of day (UTC), vehicle, text."""
    lines: list[Runs] = []
    for entry in picture.log:
        who = str(entry.id) if entry.id else "–"
        text = f"{clock(entry.at_ns)} {who:>3} {SIGNS[entry.severity]} {entry.text}"
        lines.append([(text[:width], STYLES[entry.severity])])
    return lines


def clock(at_ns: int) -> str:
    """Time of day, UTC."""
    return datetime.fromtimestamp(at_ns // 1_000_000_000, UTC).strftime("%H:%M:%S")
