"""The report's page: one HTML file that asks the network for nothing, and says so to the browser."""

from __future__ import annotations

import json
from datetime import UTC, datetime
from html import escape
from typing import Any

import numpy as np

from gcs.report import theme as look
from gcs.report.data import Run
from gcs.report.plotly_parts import Figure
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Role, Severity

# The browser itself refuses every request; plotly.js compiles functions of its own (`unsafe-eval`).
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; worker-src blob:"
)
CONFIG = {"responsive": True, "displaylogo": False, "scrollZoom": True, "showSendToCloud": False}
STYLE = f"""
:root {{ color-scheme: light; }}
* {{ box-sizing: border-box; }}
body {{ margin: 0; background: #f3f5f8; color: {look.INK};
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }}
main {{ max-width: 1160px; margin: 0 auto; padding: 24px 20px 60px; }}
h1 {{ font-size: 27px; line-height: 1.25; margin: 0 0 4px; }}
h2 {{ font-size: 18px; margin: 0 0 2px; }}
.sub {{ color: {look.FAINT}; margin: 0; }}
section, .facts div {{ background: {look.PAPER}; border: 1px solid {look.GRID}; border-radius: 10px; }}
section {{ padding: 18px 20px; margin-top: 18px; overflow-x: auto; }}
section > .sub {{ font-size: 14px; margin-bottom: 8px; }}
.facts {{ display: grid; margin-top: 18px; gap: 12px;
  grid-template-columns: repeat(auto-fit, minmax(140px, 1fr)); }}
.facts div {{ padding: 12px 16px; }}
.facts b {{ display: block; font-size: 20px; font-variant-numeric: tabular-nums; }}
.facts span {{ color: {look.FAINT}; font-size: 13px; }}
nav {{ margin-top: 14px; display: flex; flex-wrap: wrap; gap: 4px 16px; font-size: 14px; }}
a {{ color: #0b5cad; text-decoration: none; }} a:hover {{ text-decoration: underline; }}
table {{ border-collapse: collapse; width: 100%; font-size: 14px; font-variant-numeric: tabular-nums; }}
th {{ text-align: left; color: {look.FAINT}; font-weight: 600; }}
th, td {{ padding: 5px 14px 5px 0; border-bottom: 1px solid {look.GRID}; vertical-align: top; }}
.n {{ text-align: right; }} td.n, td:first-child {{ white-space: nowrap; }}
.tag {{ display: inline-block; border-radius: 5px; padding: 0 7px; font-size: 13px; white-space: nowrap; }}
.error {{ background: #fde2e0; color: #8c1d18; }} .warning {{ background: #fff0cf; color: #6b4a00; }}
.info {{ background: #e6eefb; color: #17407a; }} .good {{ background: #dff3e4; color: #14532d; }}
.notes {{ border-left: 4px solid #d9a400; }}
.dot {{ display: inline-block; width: 11px; height: 11px; border-radius: 50%; margin-right: 7px; }}
.figure {{ width: 100%; }} .long {{ max-height: 560px; overflow-y: auto; }}
footer {{ margin-top: 26px; color: {look.FAINT}; font-size: 13px; }}
@media print {{ body {{ background: white; }} section {{ break-inside: avoid; }} nav {{ display: none; }}
  .long {{ max-height: none; }} }}
"""


def page(run: Run, figures: list[Figure], plotly_js: str) -> str:
    """The whole file."""
    tables = [
        ("vehicles", "Vehicles", "", vehicles(run)),
        ("commands", "Commands", "Confirmed means that the autopilot reports it.", commands(run)),
        ("alerts", "Alerts", "", alerts(run)),
        ("log", "Log", "", log(run)),
        ("parameters", "Game", "", parameters(run)),
        ("summary", "Summary", "From summary.json.", facts_table(run.summary)),
        ("timing", "Timing", "From timing.json.", facts_table(run.timing)),
    ]
    tables = [table for table in tables if table[3]]
    anchors = [(f.name, f.title) for f in figures] + [(name, title) for name, title, _, _ in tables]
    title = escape(run.name)
    began = datetime.fromtimestamp(run.t0_ns // NS_PER_S, UTC).strftime("%Y-%m-%d %H:%M:%S UTC")
    parts = [
        "<!doctype html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n",
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n',
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n",
        f"<title>{title}: flight report</title>\n<link rel='icon' href='data:,'>\n<style>{STYLE}</style>\n",
        "</head>\n<body>\n<main>\n",
        f"<header><h1>{escape(look.verdict(run))}</h1>\n",
        f"<p class='sub'>{title} · began {began} · folder {escape(run.folder.name)}</p></header>\n",
        notes(run),
        facts(run),
        "<nav>" + "".join(f"<a href='#{name}'>{escape(text)}</a>" for name, text in anchors) + "</nav>\n",
        "<noscript><section class='notes'>The figures need JavaScript. The same are in the folder "
        "<i>figures</i> as pictures.</section></noscript>\n",
    ]
    for figure in figures:
        size = f"style='height:{figure.height}px'"
        parts.append(
            f"<section id='{figure.name}'><h2>{escape(figure.title)}</h2>\n"
            f"<p class='sub'>{escape(figure.note)}</p>\n"
            f"<div class='figure' id='figure-{figure.name}' {size}></div></section>\n"
        )
    for name, heading, note, body in tables:
        sub = f"<p class='sub'>{escape(note)}</p>\n" if note else ""
        parts.append(f"<section id='{name}'><h2>{escape(heading)}</h2>\n{sub}{body}</section>\n")
    parts.append("<footer>Positions in the game frame: metres north, east and up of its origin.</footer>\n")
    parts.append("</main>\n<script>" + plotly_js.replace("</script", "<\\/script") + "</script>\n<script>\n")
    parts.append(f"const config = {_json(CONFIG)};\n")
    for figure in figures:
        given = f"{_json(figure.data)}, {_json(figure.layout)}, config"
        parts.append(f"Plotly.newPlot('figure-{figure.name}', {given});\n")
    parts.append("</script>\n</body>\n</html>\n")
    return "".join(parts)


def notes(run: Run) -> str:
    """What is missing or damaged."""
    if not run.notes:
        return ""
    lines = "".join(f"<div>{escape(note)}</div>" for note in run.notes)
    return f"<section class='notes'><h2>Please note</h2>{lines}</section>\n"


def facts(run: Run) -> str:
    """The numbers one asks for first."""
    start, end = run.span
    found = [(f"{end - start:.1f} s", "flown and recorded")]
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
    pursuers = sum(f.role is Role.PURSUER for f in run.flown.values())
    found.append((str(pursuers), "pursuer" if pursuers == 1 else "pursuers"))
    worst = sum(alert.severity is Severity.ERROR for alert in run.alerts)
    found.append(
        (str(len(run.alerts)), f"{_count('alert', run.alerts)}{f', {worst} severe' if worst else ''}")
    )
    boxes = "".join(f"<div><b>{escape(value)}</b><span>{escape(what)}</span></div>" for value, what in found)
    return f"<div class='facts'>{boxes}</div>\n"


def vehicles(run: Run) -> str:
    """One row for each vehicle."""
    colors = look.colors(run)
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
                f"<span class='dot' style='background:{colors[vehicle_id]}'></span>"
                + escape(run.role_of(vehicle_id)),
                escape(member.strategy or "paper") if member is not None else "",
                f"{member.speed:g}" if member is not None else "",
                mean,
                f"{nearest[vehicle_id]:.2f}" if vehicle_id in nearest else "",
                f"{median:.0f} / {most:.0f}" if len(late) else "",
                "" if charge != charge else f"{100 * charge:.0f}",
                {"state": "its own state", "track": "tracks alone", "tlog": "telemetry log"}[flown.source],
            ]
        )
    heads = ["vehicle", "strategy", "declared m/s", "mean over ground m/s", "nearest to evader m"]
    heads += ["age ms, median / 99 %", "battery %", "known from"]
    return _table(heads, rows, numbers=(2, 3, 4, 5, 6))


def commands(run: Run) -> str:
    """Each command with who confirmed it, and after what time."""
    rows = []
    for command in run.commands:
        at = f"{(command.issued_ns - run.t0_ns) / NS_PER_S:.1f}"
        legs = []
        for leg in command.legs:
            kind = "good" if leg.state == "confirmed" else "error" if leg.state == "refused" else "warning"
            took = f" in {leg.took_s:.2f} s" if leg.state == "confirmed" else ""
            why = f" ({escape(leg.reason)})" if leg.reason else ""
            legs.append(f"<span class='tag {kind}'>{leg.id} {escape(leg.state)}{took}</span>{why}")
        rows.append([at, escape(command.kind), escape(command.sender), " ".join(legs)])
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
    """What happened."""
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
            tables.append(f"<p class='sub'>{escape(look.words(key))}</p>{_records(value)}")
        else:
            rows.append([escape(look.words(key)), escape(value)])
    return (_table(["", ""], rows) if rows else "") + "".join(tables)


def _flat(value: Any, key: str) -> list[tuple[str, str | list[dict[str, Any]]]]:
    if isinstance(value, dict):
        return [pair for k, v in value.items() for pair in _flat(v, f"{key}.{k}" if key else str(k))]
    if isinstance(value, list) and value and all(isinstance(item, dict) for item in value):
        return [(key, value)]
    return [(key, _text(value))]


def _records(records: list[dict[str, Any]]) -> str:
    heads = list(dict.fromkeys(str(key) for record in records for key in record))
    rows = [[escape(_text(record[key])) if key in record else "" for key in heads] for record in records]
    return _table([escape(look.words(head)) for head in heads], rows)


def _count(what: str, things: tuple[Any, ...]) -> str:
    return what if len(things) == 1 else f"{what}s"


def _text(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "–"}[value]
    if isinstance(value, dict):
        return ", ".join(f"{look.words(str(k))} {_text(v)}" for k, v in value.items())
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
