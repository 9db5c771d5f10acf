"""Status line, alerts and log as styled lines. Pure."""

from __future__ import annotations

from collections import Counter
from datetime import UTC, datetime
from math import degrees

from gcs.picture.knowledge import goal_lines, told
from gcs.picture.several import verdict_in_words
from gcs.picture.team import MOST_TOLD, band_in_words
from gcs.picture.terminal_text import cut
from gcs.picture.values import AssessmentView, CommandView, LegState, LogLine, Picture, Presence
from onboard.core.math.constants import NS_PER_S
from onboard.game.knowledge_words import goal_in_words
from onboard.wire.bus.messages import Severity

Runs = list[tuple[str, str]]
ALIKE_NS = 2 * NS_PER_S
SIGNS = {Severity.ERROR: "E", Severity.WARNING: "w", Severity.INFO: " "}
STYLES = {Severity.ERROR: "bold red", Severity.WARNING: "yellow", Severity.INFO: ""}


def status_line(picture: Picture, title: str, status: str, width: int) -> Runs:
    """Game, phase and clock to the left; the source's own words to the right, as far as there is room."""
    game, *more = _game(picture)
    left = "  ".join(part for part in (title, game, _fleet(picture), *more) if part)
    right = _fitting(status, width - len(left) - 2)
    return [(cut(f"{left}{right.rjust(max(0, width - len(left)))}", width), "bold")]


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
        parts.append(verdict_in_words(game.outcome))
    elif picture.assessments:
        parts.append(situation_in_words(picture))
    if game.plan is not None:
        parts.append(band_in_words(game.plan))
    return parts


def situation_in_words(picture: Picture, *, whole: bool = False) -> str:
    """The ways out of all evaders, for people: the only one's with its odds; of several each by its id, and
    how it ended for those that are out of the game."""
    judged = picture.assessments
    if len(judged) == 1 and judged[0].alone:
        return prospects_in_words(judged[0], whole=whole)
    told = {found.evader: prospects_in_words(found, whole=whole) for found in judged}
    told |= {fate.id: fate.verdict.value for fate in picture.game.fates if fate.out}
    if len(told) > MOST_TOLD:
        return _counted(picture)
    called = "evader " if whole else "E"
    return "; ".join(f"{called}{id} {words}" for id, words in sorted(told.items()))


def _counted(picture: Picture) -> str:
    """The same of more evaders than can be told one by one: how many are how, and the widest way out."""
    ends = Counter(fate.verdict.value for fate in picture.game.fates if fate.out)
    said = [f"{count} {word}" for word, count in ends.items()]
    closed = sum(found.encircled for found in picture.assessments)
    widest = max(picture.assessments, key=lambda found: found.largest_gap, default=None)
    said += [f"{closed} encircled"] if closed else []
    if widest is not None and len(picture.assessments) > closed:
        wide = f"the widest {degrees(widest.largest_gap):.0f}° of {widest.evader}"
        said.append(f"{len(picture.assessments) - closed} with a way out, {wide}")
    return f"evaders: {', '.join(said)}"


def prospects_in_words(found: AssessmentView, *, whole: bool = False) -> str:
    """The widest way out, and the odds, for people; in `whole` words where there is room."""
    way_out, chance = ("widest way out", "chance of capture") if whole else ("gap", "capture")
    gap = "encircled" if found.encircled else f"{way_out} {degrees(found.largest_gap):.0f}°"
    if found.captured is not None:
        p, low, high = (100.0 * share for share in found.captured)
        gap += f", {chance} {p:.0f} % ({low:.0f}–{high:.0f})"
    return f"{gap}{', target denied' if found.target_denied else ''}"


def _fleet(picture: Picture) -> str:
    lost = sum(v.presence is Presence.LOST for v in picture.vehicles)
    return f"{len(picture.vehicles)} vehicles" + (f", {lost} LOST" if lost else "")


def alert_lines(picture: Picture, width: int, height: int) -> list[Runs]:
    """Open commands first, then alerts, with what to do where there is room for it; below, where there is
    room, what the team is after."""
    commands = [command for command in picture.commands if _shown(command, picture)]
    lines = [_command(command) for command in commands]
    of_kind = {f"unconfirmed_{command.kind.value}": at for at, command in enumerate(commands)}
    for alert in picture.alerts:
        if alert.kind in of_kind:  # the command's own line names who has not confirmed
            lines[of_kind[alert.kind]].append((f"  → {alert.advice}", "dim"))
            continue
        style = "dim" if alert.acknowledged else STYLES[alert.severity]
        sign = "✓" if alert.acknowledged else SIGNS[alert.severity]
        lines.append([(f"{sign} {alert.text}", style), (f"  → {alert.advice}", "dim")])
    if not lines:
        lines.append([("no alerts", "dim")])
    goals = [[(text, "dim")] for text in goal_lines(picture.game)]
    lines += goals[: max(0, height - len(lines))] if height > 0 else goals
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


def hidden_alerts(picture: Picture, height: int) -> frozenset[str]:
    """The names of the alerts that a board of this height has no room for."""
    shown = sum(_shown(command, picture) for command in picture.commands)
    commands = {f"unconfirmed_{c.kind.value}" for c in picture.commands if _shown(c, picture)}
    names = [alert.name for alert in picture.alerts if alert.kind not in commands]
    return frozenset() if shown + len(names) <= height else frozenset(names[max(0, height - 1 - shown) :])


def log_lines(picture: Picture) -> list[Runs]:
    """The event log, oldest first: time of day (UTC), vehicles, text.

    The time is the event's own; what arrived later says when. What several vehicles say alike within two
    seconds is one line.
    """
    merged: list[tuple[LogLine, list[int]]] = []
    latest: dict[str, int] = {}
    for entry in picture.log:
        at = latest.get(entry.text)
        if entry.id and at is not None and abs(entry.own_ns - merged[at][0].own_ns) < ALIKE_NS:
            merged[at][1].append(entry.id)
            continue
        latest[entry.text] = len(merged)
        merged.append((entry, [entry.id]))
    return [[(_told(entry, ids), STYLES[entry.severity])] for entry, ids in merged]


def _told(entry: LogLine, ids: list[int]) -> str:
    late = f" (heard {clock(entry.at_ns)})" if abs(entry.at_ns - entry.own_ns) > ALIKE_NS else ""
    return f"{clock(entry.own_ns)} {spans(ids):>5} {SIGNS[entry.severity]} {entry.text}{late}"


def spans(ids: list[int]) -> str:
    """Ids for a person: `1-6`, `2,5`; the station's own 0 is `–`."""
    found: list[list[int]] = []
    for id in sorted(set(ids)):
        if found and id == found[-1][1] + 1:
            found[-1][1] = id
        else:
            found.append([id, id])
    return ",".join(str(a) if a == b else f"{a}-{b}" for a, b in found) if found != [[0, 0]] else "–"


def known_lines(picture: Picture) -> list[str]:
    """What the team's planner knows: of each evader the goal, then what holds with its strength."""
    lines = []
    for word in picture.game.knowledge:
        lines.append(f"evader {word.quarry}: {goal_in_words(word.goal) or 'no goal'}")
        lines += [f"  {edge.words} ({edge.strength:.2f})" for edge in told(word, dict(picture.game.quarries))]
    return lines


def whole_text(picture: Picture, selected: int | None, detail: list[tuple[str, str]]) -> Runs:
    """Alerts with what to do, the selected vehicle, what the team knows and the log, the newest first; lines
    may be long."""
    runs: Runs = [(f"Alerts at {clock(picture.now_ns)}\n", "bold")]
    for line in alert_lines(picture, 0, 0):
        runs += [*line, ("\n", "")]
    if detail and selected is not None:
        runs.append(("\nVehicle\n", "bold"))
        runs += [(f"{text}\n", style) for text, style in detail]
    if known := known_lines(picture):
        runs.append(("\nWhat the team knows\n", "bold"))
        runs += [(f"{text}\n", "") for text in known]
    runs.append(("\nEvents, the newest first (UTC)\n", "bold"))
    for line in reversed(log_lines(picture)):
        runs += [*line, ("\n", "")]
    return runs


def clock(at_ns: int) -> str:
    """Time of day, UTC."""
    return datetime.fromtimestamp(at_ns // 1_000_000_000, UTC).strftime("%H:%M:%S")
