"""The report's page: one HTML file that asks the network for nothing, and says so to the browser."""

from __future__ import annotations

import json
from base64 import b64encode
from datetime import UTC, datetime
from hashlib import sha256
from html import escape
from importlib.resources import files
from typing import Any

import numpy as np

from gcs.picture.values import LegState
from gcs.report import drawing, theme
from gcs.report.data import Run
from gcs.report.drawing import Drawing
from gcs.report.playback import scene_of
from onboard.core.math.constants import NS_PER_S
from onboard.core.strategy.registry import evader_named, pursuer_named
from onboard.game import palette
from onboard.wire.bus.messages import Role, Severity

MOST_ROWS = 400  # places of a vehicle that the page's script knows
ENLARGE = "Drag over a part to enlarge it, double click for the whole."
SPACE = "space"  # the drawing whose place the scene takes
CONFIRMED = "Confirmed means that the autopilot reports it."
GLOSSARY = "What each rule and action of the figure of rules says, and where it comes from."
TAGS = {LegState.CONFIRMED: "good", LegState.REFUSED: "error"}  # of others: warning


def page(run: Run, drawings: list[Drawing]) -> str:
    """The whole file: the figures as SVG, the tables, the style sheet and the script."""
    tables = [
        ("evaders", "Evaders", "", evaders(run)),
        ("glossary", "Glossary", GLOSSARY, glossary(run)),
        ("vehicles", "Vehicles", "", vehicles(run)),
        ("commands", "Commands", CONFIRMED, commands(run)),
        ("alerts", "Alerts", "", alerts(run)),
        ("log", "Log", "", log(run)),
        ("parameters", "Game", "", parameters(run)),
        ("summary", "Summary", "From summary.json.", facts_table(run.summary)),
        ("timing", "Timing", "From timing.json.", facts_table(run.timing)),
    ]
    tables = [table for table in tables if table[3]]
    anchors = [(d.name, d.title) for d in drawings] + [(name, title) for name, title, _, _ in tables]
    title = escape(run.name)
    script = (files("gcs.report") / "page.js").read_text(encoding="utf-8")
    played = scene_of(run)
    scene = (files("gcs.page") / "static" / "report.js").read_text(encoding="utf-8") if played else ""
    parts = [
        "<!doctype html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n",
        f'<meta http-equiv="Content-Security-Policy" content="{_policy(scene, script)}">\n',
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n",
        f"<title>{title}: flight report</title>\n<link rel='icon' href='data:,'>\n",
        f"<style>{_style()}</style>\n",
        "</head>\n<body>\n<main>\n",
        f"<header><h1>{escape(theme.verdict(run))}</h1>\n",
        f"<p class='sub'>{title} · {_when(run)} · folder {escape(run.folder.name)}</p></header>\n",
        notes(run),
        facts(run),
        "<nav>" + "".join(f"<a href='#{name}'>{escape(text)}</a>" for name, text in anchors) + "</nav>\n",
    ]
    figures = []
    for one in drawings:
        if one.name == SPACE and played:
            parts.append(_stage(one))
            continue
        parts.append(
            f"<section id='{one.name}'><h2>{escape(one.title)}</h2>\n"
            f"<p class='sub'>{escape(one.note)} {ENLARGE}</p>\n"
            f"<div class='figure' id='figure-{one.name}'>{drawing.svg(one)}</div></section>\n"
        )
        figures.append(drawing.questions(one))
    for name, heading, note, body in tables:
        sub = f"<p class='sub'>{escape(note)}</p>\n" if note else ""
        parts.append(f"<section id='{name}'><h2>{escape(heading)}</h2>\n{sub}{body}</section>\n")
    parts.append("<footer>Positions in the game frame: metres north, east and up of its origin.</footer>\n")
    told = _json({"ways": _ways(run), "figures": figures, "scene": played})
    parts.append("</main>\n<div id='tip'></div>\n")
    parts.append(f"<script type='application/json' id='flight'>{told}</script>\n")
    if scene:
        parts.append(f"<script>{scene}</script>\n")
    parts.append(f"<script>{script}</script>\n</body>\n</html>\n")
    return "".join(parts)


def _stage(one: Drawing) -> str:
    """The scene that plays; on paper, and where a browser draws no scene, the drawing in its place."""
    return (
        f"<section id='{one.name}'><h2>{escape(one.title)}</h2>\n"
        "<p class='sub screen'>Drag to turn, scroll to come closer. The buttons play the flight; the figures"
        " over time mark the same instant.</p>\n"
        "<div class='screen'><div id='stage'></div><div id='time'></div></div>\n"
        f"<p class='sub paper'>{escape(one.note)}</p>\n"
        f"<div class='figure paper' id='figure-{one.name}'>{drawing.svg(one)}</div></section>\n"
    )


def _policy(*scripts: str) -> str:
    """What the browser may do with the page: nothing but run these scripts."""
    digests = [b64encode(sha256(script.encode()).digest()).decode() for script in scripts if script]
    own = " ".join(f"'sha256-{digest}'" for digest in digests)
    return f"default-src 'none'; script-src {own}; style-src 'unsafe-inline'; img-src data: blob:"


def _style() -> str:
    """The style sheet, with every colour of the figures as a variable that follows the browser's wish."""
    colours = palette.every_colour()
    names = {"ink": palette.INK, "faint": palette.FAINT, "paper": palette.PAPER, "grid": palette.GRID}

    def variables(dark: bool) -> str:
        named = {f"--c{c.light[1:]}": c for c in colours} | {f"--{name}": c for name, c in names.items()}
        return "".join(f"{name}: {c.dark if dark else c.light}; " for name, c in named.items())

    timeline = (files("gcs.page") / "static" / "timeline.css").read_text(encoding="utf-8")
    sheet = timeline + (files("gcs.report") / "page.css").read_text(encoding="utf-8")
    screen = f"@media screen and (prefers-color-scheme: dark) {{ :root {{ {variables(True)}}} }}"
    return f":root {{ {variables(False)}}}\n{screen}\n{sheet}"


def _when(run: Run) -> str:
    """When the game began, or that it was played on no clock of this world."""
    if run.virtual:
        return "played on virtual time"
    return datetime.fromtimestamp(run.t0_ns // NS_PER_S, UTC).strftime("began %Y-%m-%d %H:%M:%S UTC")


def _ways(run: Run) -> list[dict[str, Any]]:
    """Where each vehicle was when: time [s], east, north, height [m]."""
    ways: list[dict[str, Any]] = []
    for vehicle, flown in sorted(run.flown.items()):
        rows = np.column_stack([flown.t, flown.position[:, [1, 0, 2]] * (1.0, 1.0, -1.0)])
        told = {"name": run.role_of(vehicle), "colour": run.colour(vehicle)}
        ways.append(told | {"rows": drawing.thin(rows, MOST_ROWS)})
    return ways


def glossary(run: Run) -> str:
    """Each rule and action that was in force, in a sentence."""
    rows = []
    for rule in run.rule_names():
        name = _dot(palette.rule(rule).light) + escape(theme.words(rule))
        rows.append([name, *map(escape, theme.explained(rule))])
    for action in run.action_names():
        name = _dot(palette.action(action).light) + escape(theme.words(action))
        rows.append([name, theme.ACTIONS.get(action, "An action of the supervisor."), "supervisor"])
    return _table(["rule", "what it says", "source"], rows) if rows else ""


def _dot(colour: str) -> str:
    """A sign in a colour of the palette."""
    return f"<span class='dot' style='background:var(--c{colour[1:]})'></span>"


def notes(run: Run) -> str:
    """What is missing or damaged."""
    if not run.notes:
        return ""
    lines = "".join(f"<div>{escape(note)}</div>" for note in run.notes)
    return f"<section class='notes'><h2>Please note</h2>{lines}</section>\n"


def facts(run: Run) -> str:
    """The numbers one asks for first."""
    start, end = run.span
    found = [(f"{end - start:.1f} s", "flown and recorded" + (", on virtual time" if run.virtual else ""))]
    nearest = run.nearest()
    if run.outcome is not None:
        found.insert(0, (f"{run.outcome.time:.2f} s", "from start to end of the game"))
        if run.outcome.smallest_distance >= 0:
            found.append((f"{run.outcome.smallest_distance:.2f} m", "smallest distance, by the referee"))
    elif nearest:
        who = min(nearest, key=nearest.__getitem__)
        found.append((f"{nearest[who]:.2f} m", f"smallest distance, of pursuer {who}"))
    if run.capture_radius is not None:
        found.append((f"{run.capture_radius:g} m", "capture radius R"))
    if run.safety_distance is not None:
        found.append((f"{run.safety_distance:g} m", "safety distance ρ"))
    if len(run.evaders) > 1:
        found.append((str(len(run.evaders)), "evaders"))
    pursuers = sum(f.role is Role.PURSUER for f in run.flown.values())
    found.append((str(pursuers), "pursuer" if pursuers == 1 else "pursuers"))
    worst = sum(alert.severity is Severity.ERROR for alert in run.alerts)
    found.append(
        (str(len(run.alerts)), f"{_count('alert', run.alerts)}{f', {worst} severe' if worst else ''}")
    )
    boxes = "".join(f"<div><b>{escape(value)}</b><span>{escape(what)}</span></div>" for value, what in found)
    return f"<div class='facts'>{boxes}</div>\n"


def evaders(run: Run) -> str:
    """How the game ended for each evader, where there are several."""
    if len(run.evaders) < 2:
        return ""
    smallest = {one.id: one.smallest_distance for one in (run.outcome.evaders if run.outcome else ())}
    rows = []
    for flown in run.evaders:
        fate, near = run.fate_of(flown.id), smallest.get(flown.id, -1.0)
        goals = [goal.place for goal in run.targets if goal.evader == flown.id]
        rows.append(
            [
                _dot(run.colour(flown.id)) + escape(run.role_of(flown.id)),
                escape("; ".join(f"{n:.0f}, {e:.0f}, {-d:.0f}" for n, e, d in goals)) or "none",
                fate.verdict.value if fate is not None else "not told",
                f"pursuer {fate.captor}" if fate is not None and fate.captor else "",
                f"{fate.time_s:.1f}" if fate is not None else "",
                f"{near:.2f}" if near >= 0.0 else "",
            ]
        )
    heads = ["evader", "targets: north, east, up m", "how it ended", "by", "at s", "nearest pursuer m"]
    return _table(heads, rows, numbers=(4, 5))


def vehicles(run: Run) -> str:
    """One row for each vehicle."""
    nearest = run.nearest()
    rows = []
    for vehicle_id, flown in sorted(run.flown.items()):
        member = run.member(vehicle_id)
        link = run.links.get(vehicle_id)
        playing = run.playing(flown.t)
        mean = f"{flown.groundspeed[playing].mean():.1f}" if playing.any() else ""
        late = flown.latency[np.isfinite(flown.latency)] * 1000.0
        median, most = np.percentile(late, [50, 99]) if len(late) else (0.0, 0.0)
        charge = link.battery[-1] if link is not None and len(link.t) else float("nan")
        rows.append(
            [
                _dot(run.colour(vehicle_id)) + escape(run.role_of(vehicle_id)),
                escape(_strategy(member.role, member.strategy)) if member is not None else "",
                f"{member.speed:g}" if member is not None else "",
                mean,
                f"{nearest[vehicle_id]:.2f}" if vehicle_id in nearest else "",
                f"{median:.0f} / {most:.0f}" if len(late) else "",
                "" if charge != charge else f"{100 * charge:.0f}",
                {"state": "its own state", "track": "tracks alone", "tlog": "telemetry log"}[flown.source],
            ]
        )
    heads = ["vehicle", "strategy", "declared m/s", "mean over ground m/s", "nearest to an evader m"]
    heads += ["age ms, median / 99 %", "battery %", "known from"]
    return _table(heads, rows, numbers=(2, 3, 4, 5, 6))


def commands(run: Run) -> str:
    """Each command with who confirmed it, and after what time."""
    rows = []
    for command in run.commands:
        at = f"{(command.issued_ns - run.t0_ns) / NS_PER_S:.1f}"
        legs = []
        for leg in command.legs:
            kind = TAGS.get(leg.state, "warning")
            took = f" in {leg.took_s:.2f} s" if leg.state is LegState.CONFIRMED else ""
            why = f" ({escape(leg.reason)})" if leg.reason else ""
            legs.append(f"<span class='tag {kind}'>{leg.id} {escape(leg.state.value)}{took}</span>{why}")
        rows.append([at, escape(command.kind.value), escape(command.sender), " ".join(legs)])
    return _table(["at s", "command", "from", "vehicles"], rows, numbers=(0,)) if rows else ""


def alerts(run: Run) -> str:
    """Each alert from when to when."""
    rows = []
    for alert in run.alerts:
        end = f"{(alert.cleared_ns - run.t0_ns) / NS_PER_S:.1f}" if alert.cleared_ns else "in force"
        rows.append(
            [
                f"{(alert.raised_ns - run.t0_ns) / NS_PER_S:.1f}",
                end,
                f"<span class='tag {alert.severity.value}'>{alert.severity.value}</span>",
                escape(f"vehicle {alert.id}" if alert.id else ""),
                escape(alert.text),
                escape(alert.advice),
            ]
        )
    heads = ["raised s", "over s", "", "", "what", "what to do"]
    return _table(heads, rows, numbers=(0, 1)) if rows else ""


def log(run: Run) -> str:
    """Every entry of the event log, oldest first."""
    rows = [
        [
            f"{(line.at_ns - run.t0_ns) / NS_PER_S:.2f}",
            f"<span class='tag {line.severity.value}'>{escape(line.kind)}</span>",
            escape(f"vehicle {line.id}" if line.id else ""),
            escape(line.text),
        ]
        for line in run.log
    ]
    table = _table(["at s", "", "", "what"], rows, numbers=(0,))
    return f"<div class='long'>{table}</div>" if rows else ""


def parameters(run: Run) -> str:
    """The game as it was set up."""
    setup = run.setup
    if setup is None:
        return ""
    origin, rules = setup.origin, setup.rules
    pairs = {
        "scenario": f"{setup.scenario} ({setup.scenario_hash})",
        "game, master": f"{setup.game}, {setup.master}",
        "origin": f"{origin.latitude_deg:.6f}°, {origin.longitude_deg:.6f}°, {origin.altitude_m:g} m",
        "R, ρ, ε": f"{rules.R:g} m, {rules.rho:g} m, {rules.epsilon_min:g} m",
        "λ, β": f"{rules.lambda_:g}, {rules.beta:g}",
        "separation": f"{rules.separation:g} m" if rules.separation else "off",
        "horizon": f"{rules.horizon:g} s",
        "game": "plane" if rules.planar else "in space",
        "error of tracks": f"{setup.track_sigma:g} m",
        "seed": str(setup.seed),
    }
    return facts_table(pairs)


def facts_table(values: dict[str, Any]) -> str:
    """Any nested values: plain ones as rows, each list of records as a table of its own."""
    rows, tables = [], []
    for key, value in _flat(values, ""):
        if isinstance(value, list):
            tables.append(f"<p class='sub'>{escape(theme.words(key))}</p>{_records(value)}")
        else:
            rows.append([escape(theme.words(key)), escape(value)])
    return (_table(["", ""], rows) if rows else "") + "".join(tables)


def _flat(value: Any, key: str) -> list[tuple[str, str | list[dict[str, Any]]]]:
    if isinstance(value, dict):
        return [pair for k, v in value.items() for pair in _flat(v, f"{key}.{k}" if key else str(k))]
    if isinstance(value, list) and value and all(isinstance(item, dict) for item in value):
        return [(key, value)]
    return [(key, _text(value))]


def _records(records: list[dict[str, Any]]) -> str:
    """A table of records; records within them have a table of their own below, with the same first column."""
    keys = list(dict.fromkeys(str(key) for record in records for key in record))
    within = [key for key in keys[1:] if all(isinstance(record.get(key), dict) for record in records)]
    heads = [key for key in keys if key not in within]
    rows = [[escape(_text(record[key])) if key in record else "" for key in heads] for record in records]
    tables = [_table([escape(theme.words(head)) for head in heads], rows)]
    for key in within:
        inner = [{keys[0]: record[keys[0]], **record[key]} for record in records]
        if any(len(record) > 1 for record in inner):
            tables.append(f"<p class='sub'>{escape(theme.words(key))}</p>{_records(inner)}")
    return "".join(tables)


def _count(what: str, things: tuple[Any, ...]) -> str:
    return what if len(things) == 1 else f"{what}s"


def _text(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "–"}[value]
    if isinstance(value, dict):
        return ", ".join(f"{theme.words(str(k))} {_text(v)}" for k, v in value.items())
    if isinstance(value, list):
        return ", ".join(_text(item) for item in value)
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _table(heads: list[str], rows: list[list[str]], numbers: tuple[int, ...] = ()) -> str:
    def cells(tag: str, row: list[str]) -> str:
        return "".join(
            f"<{tag}{' class=n' if column in numbers else ''}>{cell}</{tag}>"
            for column, cell in enumerate(row)
        )

    head = f"<thead><tr>{cells('th', heads)}</tr></thead>" if any(heads) else ""
    body = "".join(f"<tr>{cells('td', row)}</tr>\n" for row in rows)
    return f"<table>{head}<tbody>\n{body}</tbody></table>\n"


def _json(value: Any) -> str:
    """JSON that cannot end a script element."""
    return (
        json.dumps(value, separators=(",", ":"), allow_nan=False)
        .replace("</", "<\\/")
        .replace("<!--", "<\\!--")
    )


def _strategy(role: Role, name: str) -> str:
    return evader_named(name) if role is Role.EVADER else pursuer_named(name)
