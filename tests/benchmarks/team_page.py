"""The page of the team benchmark: its tables, and what they do not say by themselves."""

from __future__ import annotations

from collections import Counter
from math import degrees
from statistics import median
from typing import Any

from sim_bridge.campaign.spatial_campaign import mcnemar, share
from tests.benchmarks.team_cases import CASES, HEADING_OFF, PLACE_OFF

Row = dict[str, Any]
CAPTURED, ARRIVED = "CAPTURED", "ARRIVED"


def pairs(rows: list[Row], case: str) -> tuple[list[Row], list[Row]]:
    """The games of a case that were played both ways, by the paper's rules and by the team."""
    mine: dict[str, dict[int, Row]] = {"paper": {}, "team": {}}
    for row in rows:
        if row["case"] == case:
            mine[row["way"]][row["seed"]] = row
    seeds = sorted(set(mine["paper"]) & set(mine["team"]))
    old, new = ([mine[way][seed] for seed in seeds] for way in ("paper", "team"))
    return old, new


def games_table(rows: list[Row]) -> list[str]:
    """A line for each case."""
    lines = [
        "| case | games | paper: captured (95 %) | arrived (95 %) | team: captured (95 %) | arrived (95 %) |"
        " only team, only paper captured; p | only paper, only team let it arrive; p | closed at t0 |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for case in CASES:
        old, new = pairs(rows, case.name)
        n = len(old)
        if not n:
            lines.append(f"| {case.words} | 0 | | | | | | | |")
            continue
        cells = []
        for verdict in (CAPTURED, ARRIVED):
            ours, theirs = ([r["verdict"] == verdict for r in side] for side in (new, old))
            cells.append((ours, theirs))
        (caught, before), (came, had_come) = cells
        won = sum(b and not a for a, b in zip(before, caught, strict=True))
        lost = sum(a and not b for a, b in zip(before, caught, strict=True))
        saved = sum(a and not b for a, b in zip(had_come, came, strict=True))
        let = sum(b and not a for a, b in zip(had_come, came, strict=True))
        lines.append(
            f"| {case.words} | {n} | {share(sum(before), n)} | {share(sum(had_come), n)} |"
            f" {share(sum(caught), n)} | {share(sum(came), n)} | {won}, {lost}; {mcnemar(won, lost):.1e} |"
            f" {saved}, {let}; {mcnemar(saved, let):.1e} | {sum(r['closed'] for r in new)} |"
        )
    return lines


def honesty(rows: list[Row]) -> list[str]:
    """What must never be."""
    lines = [""]
    near = Counter(r["case"] for r in rows if r["near"] and not r["case"].startswith("shipped"))
    by = ", ".join(f"{case} {count}" for case, count in sorted(near.items()))
    said = f" ({by})" if by else ""
    lines.append(f"Rings and staged starts with a pursuer nearer than 1.5 km at t0: {near.total()}{said}.")
    for way in ("team", "paper"):
        ours = [r for r in rows if r["way"] == way]
        if ours:
            lines.append(separation(f"By `{way}`", ours))
    caught = [r for r in rows if r["verdict"] == CAPTURED and r["way"] == "team"]
    unclosed = sum(not r["closed"] for r in caught)
    lines.append(f"Of the team's {len(caught)} captures {unclosed} began with an open band.")
    return lines


def separation(who: str, rows: list[Row]) -> str:
    """How near two pursuers came, and in how many games nearer than they keep apart."""
    least = min(rows, key=lambda r: float(r["apart"]))
    broken = sum(r["apart"] < r["separation"] for r in rows)
    close = sum(r["apart"] < 25.0 for r in rows)
    return (
        f"{who} two pursuers came nearer than the {least['separation']:.0f} m they keep apart in {broken} of"
        f" {len(rows)} games, nearer than 25 m in {close}; least {least['apart']:.1f} m ({least['case']},"
        f" seed {least['seed']})."
    )


def words(games: list[Row], flights: list[Row], seeds: int) -> list[str]:
    """What was played and how."""
    short = [c.name for c in CASES if len(pairs(games, c.name)[0]) < seeds]
    lines = [""]
    if short:
        fewest = min(len(pairs(games, name)[0]) for name in short)
        lines.append(
            f"{seeds} seeds of each case were asked for; {len(short)} cases have fewer ({fewest} at least),"
            " in order from 1."
        )
    if games:
        lines.append(f"A game took {median(row['cpu'] for row in games):.2f} s of CPU in the median.")
    if flights:
        lines.append(f"A flight took {median(row['cpu'] for row in flights):.0f} s.")
    lines += [
        "The evader is the paper's, the pursuers know the target; a seed draws wind, gusts, noise, phases and"
        " places. `closed at t0` counts games whose band is closed with the margin.",
        "Staged pursuers fly from the drawn shipped places along paths of two turns and straight lines that"
        f" take just the time; they begin {PLACE_OFF:g} m and {degrees(HEADING_OFF):.0f}° (one sigma) off,"
        " as flown planes meet their places, and the evader stays about its place until t0. `paper` has the"
        " paper's rules 4 to 6 from the same places, so that its rings and slots are the team's; the shipped"
        " starts compare the rules alone.",
    ]
    return lines


def flown_table(rows: list[Row]) -> list[str]:
    """The flights beside what is computed from their states at t₀."""
    if not rows:
        return []
    lines = [
        "",
        "## Flown whole, by the team",
        "",
        "| case | flights | captured | arrived | computed from its states at t0: same verdict |",
        "|---|---|---|---|---|",
    ]
    for case in CASES:
        ours = [r for r in rows if r["case"] == case.name]
        if ours:
            ends = [r["verdict"] for r in ours]
            same = sum(r["verdict"] == r["computed"] for r in ours)
            lines.append(
                f"| {case.words} | {len(ours)} | {ends.count(CAPTURED)} | {ends.count(ARRIVED)} | {same} |"
            )
    same = sum(r["verdict"] == r["computed"] for r in rows)
    lines += ["", f"Verdicts flown and computed are the same in {share(same, len(rows))} (wanted: 95 %)."]
    for r in rows:
        if r["verdict"] != r["computed"]:
            lines.append(
                f"- {r['case']}, seed {r['seed']}: flown {r['verdict'].lower()} at {r['time']:.1f} s (least"
                f" {r['smallest']:.1f} m), computed {r['computed'].lower()} at {r['computed_time']:.1f} s"
                f" ({r['computed_smallest']:.1f} m)"
            )
    lines.append(separation("In flight", rows))
    return lines
