"""(10) against (19)–(20): the mean square distance and the final distance are least on different headings."""

from __future__ import annotations

from math import atan2, degrees, pi

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from onboard.core.game.advance import decide
from onboard.core.geometry.apollonius import closest_approach
from onboard.core.math.vectors import scale
from onboard.core.strategy.knowledge import RuleId
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.scenario import load
from sim_bridge.plane_game.program import table1
from sim_bridge.plane_game.setup import conditions_of, game_of


def least(cost: object) -> float:
    """The heading of least cost [rad], from the best of a grid on."""
    grid = np.linspace(-pi, pi, 721)
    best = grid[int(np.argmin([cost(x) for x in grid]))]  # type: ignore[operator]
    return float(minimize_scalar(cost, bounds=(best - 0.02, best + 0.02), method="bounded").x)


def test_the_rule_minimises_the_final_distance_and_not_the_integral() -> None:
    """Row 1's fourth pursuer: −83.8° by (19)–(20), −102.6° by (10) over the same time."""
    scenario = load(table1()[0])
    game = game_of(scenario)
    p = game.pursuers[3]
    decided = decide(game, conditions_of(scenario), EVADERS["paper"].decide, PURSUERS["paper"].decide)
    heading = decided.evader.direction
    e = game.evader._replace(velocity=scale(heading, game.evader.speed))
    meeting = closest_approach(e.position, heading, e.speed, p.position, p.speed)
    assert meeting.exists
    start = np.array(p.position[:2]) - np.array(e.position[:2])

    def apart(angle: float, t: float) -> float:
        moved = p.speed * np.array([np.cos(angle), np.sin(angle)]) - np.array(e.velocity[:2])
        return float(np.sum((start + t * moved) ** 2))

    final = least(lambda angle: apart(angle, meeting.time))
    mean = least(lambda angle: quad(lambda t: apart(angle, t), 0.0, meeting.time)[0])
    ours = atan2(meeting.point.y - p.position.y, meeting.point.x - p.position.x)
    assert degrees(ours) == pytest.approx(degrees(final), abs=1e-3)
    assert decided.pursuers[3].rule == RuleId.CLOSEST_APPROACH
    assert degrees(ours) == pytest.approx(-83.78, abs=0.01)
    assert degrees(mean) == pytest.approx(-102.60, abs=0.01)
    early = np.array(e.position[:2]) + np.array(e.velocity[:2]) * meeting.time * 2.0 / 3.0
    toward = early - np.array(p.position[:2])
    assert degrees(mean) == pytest.approx(degrees(atan2(toward[1], toward[0])), abs=0.01)  # at e(2T/3)
