"""How a report looks: one colour and one name for each vehicle, rule and line, in pages and pictures."""

from __future__ import annotations

from gcs.report.data import Run
from onboard.wire.bus.messages import Role

EVADER = "#e69f00"
# told apart also by most who do not see all colours (Okabe and Ito, then Tol's muted scheme)
PURSUERS = ("#0072b2", "#009e73", "#cc79a7", "#56b4e9", "#882255", "#44aa99", "#6a51a3", "#8c6d31")
OTHERS = "#7f7f7f"
TARGET = "#117733"
CAPTURE = "#d62728"
SAFETY = "#8a8a8a"
FENCE = "#b0559b"
INK, FAINT, PAPER, GRID = "#1c2330", "#5c6675", "#ffffff", "#e3e7ee"
RULES = (
    "#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377",
    "#bbbbbb", "#997700", "#004488", "#994455", "#6699cc", "#ee99aa",
)  # fmt: skip
CLIP, GUARDS = "#5c6675", ("#111111", "#8c1d18", "#4a148c", "#004d40")


def colors(run: Run) -> dict[int, str]:
    """One colour for each vehicle, by id."""
    found = {}
    pursuers = 0
    for vehicle_id, flown in sorted(run.flown.items()):
        if flown.role is Role.EVADER:
            found[vehicle_id] = EVADER
        elif flown.role is Role.PURSUER:
            found[vehicle_id] = PURSUERS[pursuers % len(PURSUERS)]
            pursuers += 1
        else:
            found[vehicle_id] = OTHERS
    return found


def rule_colors(run: Run) -> dict[str, str]:
    """One colour for each rule, in order of first appearance."""
    found: dict[str, str] = {}
    bands = sorted((band for bands in run.rules.values() for band in bands), key=lambda b: (b.start, b.rule))
    for band in bands:
        if band.rule not in found:
            found[band.rule] = RULES[len(found) % len(RULES)]
    return found


def guard_colors(run: Run) -> dict[str, str]:
    """One dark colour for each of the supervisor's actions; clipping, the mildest, is grey."""
    actions = sorted({band.rule for bands in run.guards.values() for band in bands} - {"clip"})
    named = {action: GUARDS[n % len(GUARDS)] for n, action in enumerate(actions)}
    clips = any(band.rule == "clip" for bands in run.guards.values() for band in bands)
    return ({"clip": CLIP} if clips else {}) | named


def words(name: str) -> str:
    """A rule's or key's name for a person."""
    return name.replace("_", " ")


def verdict(run: Run) -> str:
    """The outcome in one sentence."""
    outcome = run.outcome
    if outcome is None:
        told = run.summary.get("verdict") or run.summary.get("outcome")
        return f"Outcome: {told}" if isinstance(told, str) else "No outcome was recorded"
    who = f" by pursuer {outcome.captor}" if outcome.captor else ""
    return f"Evader {outcome.verdict.value}{who} after {outcome.time:.1f} s"
