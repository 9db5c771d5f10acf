"""The picture of docs/knowledge-model.md: `python -m tests.support.knowledge_picture [FILE]`."""

from __future__ import annotations

import sys
from math import cos, sin
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
from matplotlib.patches import Circle, Wedge

from onboard.core.game.rules import Rules, Target
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec, scale
from onboard.core.strategy.semantic.model import MODEL
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Situation
from onboard.game.knowledge_words import goal_in_words, known_of, message
from onboard.wire.bus.knowledge_messages import Knowledge, NodeKind

SHOWN = {"threatens": "#c0392b", "covers": "#1e8449", "blocks": "#2471a3", "flanks": "#7d6608"}
RULES = Rules(2.0, 4.0, horizon=300.0, planar=True, target_known=True)


def known() -> Knowledge:
    """Four pursuers at γ = 0.8 and an evader with two targets."""
    places = ((70.0, 45.0), (30.0, -60.0), (-45.0, 30.0), (95.0, -55.0))
    team = tuple(Member(Vehicle(Vec(x, y, 0.0), scale(NORTH, 4.0), 4.0), FREE, True) for x, y in places)
    targets = (Target(True, Vec(110.0, 60.0, 0.0)), Target(True, Vec(115.0, -70.0, 0.0)))
    s = Situation(
        1.0, 0.0, Vehicle(ZERO, scale(NORTH, 5.0), 5.0), FREE, team, targets[0], ZERO, RULES, Heights(),
        Margin(), ZERO, 40.0, targets,
    )  # fmt: skip
    return message(known_of(s, None, MODEL, 1, (2, 3, 4, 5)), 2, 0, 0)


def draw(told: Knowledge, axes: Any) -> None:
    """Nodes where they are, relations as arrows as wide as they are strong."""
    for node in told.nodes:
        north, east, _ = node.place
        if node.kind is NodeKind.APOLLONIUS:
            axes.add_patch(Circle((east, north), node.size, fill=False, ls=":", color="#2471a3", lw=0.8))
        elif node.kind is NodeKind.BAND:
            middle, half = 90.0 - node.bearing * 57.29578, 0.5 * node.size * 57.29578
            axes.add_patch(Wedge((east, north), 38.0, middle - half, middle + half, color="#f9e79f"))
        elif node.kind in (NodeKind.EVADER, NodeKind.PURSUER, NodeKind.TARGET):
            colour = {"evader": "#c0392b", "pursuer": "#2471a3", "target": "#1e8449"}[node.kind.value]
            axes.plot(east, north, "o" if node.kind is not NodeKind.TARGET else "s", color=colour, ms=8)
            axes.annotate(node.name, (east, north), (5, 6), textcoords="offset points", color=colour)
    for edge in told.edges:
        if edge.relation in SHOWN:
            a, b = told.nodes[edge.source], told.nodes[edge.sink]
            end = b.place
            if b.kind is NodeKind.BAND:
                end = (28.0 * cos(b.bearing), 28.0 * sin(b.bearing), 0.0)
            axes.annotate(
                "", (end[1], end[0]), (a.place[1], a.place[0]),
                arrowprops={"arrowstyle": "-|>", "color": SHOWN[edge.relation], "alpha": 0.7,
                            "shrinkA": 8, "shrinkB": 8, "lw": 0.5 + 3.0 * edge.strength},
            )  # fmt: skip
    for name, colour in SHOWN.items():
        axes.plot([], [], color=colour, label=name, lw=2)
    axes.legend(loc="lower left", title="holds, as wide as it is strong")
    axes.set_title(f"goal: {goal_in_words(told.goal)}", fontsize=10)
    axes.set(xlabel="east [m]", ylabel="north [m]", aspect="equal", xlim=(-130, 130), ylim=(-90, 150))


def main(file: Path) -> None:
    """Draw and write."""
    mpl.rcParams["svg.hashsalt"] = "apollonius"
    figure, axes = plt.subplots(figsize=(7.5, 7.0))
    draw(known(), axes)
    figure.savefig(file, metadata={"Date": None} if file.suffix == ".svg" else None, bbox_inches="tight")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/knowledge.svg"))
