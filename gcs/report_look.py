"""How a report looks: one colour and one name for each vehicle, rule and line, in pages and pictures."""

from __future__ import annotations

from gcs.report_data import Run
from onboard.wire.swarm import Role

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
SUPERVISOR = "#111111"


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
    """One colour for each rule, in order of first appearance; the supervisor's actions are dark."""
    found: dict[str, str] = {}
    bands = sorted((band for bands in run.rules.values() for band in bands), key=lambda b: (b.start, b.rule))
    for band in bands:
        if band.rule.startswith("supervisor"):
            found[band.rule] = SUPERVISOR
        elif band.rule not in found:
            found[band.rule] = RULES[len(found) % len(RULES)]
    return found


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
    return f"Evader {outcome.verdict}{who} after {outcome.time:.1f} s"
