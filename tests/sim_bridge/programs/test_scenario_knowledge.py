"""What `scenario check` says a team knows: targets, goals, rules of one's own, a disc and its middle."""

from __future__ import annotations

import msgspec

from onboard.game.scenario import Parameters, Scenario, VehicleSpec
from sim_bridge.programs.scenario_knowledge import denies, knowledge_lines
from tests.support.paths import ROOT

RULE = ROOT / "examples" / "knowledge-rule" / "apollonius_engage.py"


def scenario(strategy: str = "team", known: bool = True, **parameters: float) -> Scenario:
    """Two targets, each with a pursuer before it; a third beside the evader."""
    places = ((110.0, 50.0), (110.0, -50.0), (25.0, 0.0))
    return Scenario(
        name="two targets",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0, targets=((120.0, 60.0), (120.0, -60.0))),
        pursuers=tuple(VehicleSpec(position=at, speed=4.0, strategy=strategy) for at in places),
        parameters=Parameters(R=2.0, target_known=known, horizon=100.0, **parameters),
    )


def test_each_target_is_told_and_the_goal_last() -> None:
    lines = knowledge_lines(scenario())
    for target, pursuer in ((1, 2), (2, 3)):
        assert any(line.endswith(f"evader 1 threatens target {target}: there in 27 s") for line in lines)
        covers = f"  pursuer {pursuer} covers target {target}: there 23.3 s before the evader"
        assert covers in lines
    assert lines[-1] == "  goal: deny every target, as more than one target is known"
    assert not any("near" in line for line in lines)


def test_what_pursuers_do_not_know_is_not_among_it() -> None:
    lines = knowledge_lines(scenario(known=False))
    assert lines[0].endswith("not where it goes (parameters.target_known)")
    assert not any("target 1" in line for line in lines)
    assert lines[-1].startswith("  goal: chase")


def test_a_relation_of_ones_own_is_told_too() -> None:
    lines = knowledge_lines(scenario(f"team:{RULE}"))
    assert "  pursuer 4 is 25 m from evader 1" in lines  # near: within ten ρ, which are 40 m


def test_a_border_is_not_denied_by_who_is_first_at_its_middle() -> None:
    """The border is 60 m north, the edge of a disc of 20 km: who is behind the evader is no defender."""
    border = scenario(epsilon_min=20_000.0)
    far = msgspec.structs.replace(border.evader, targets=(), target=(20_060.0, 0.0))
    pursuers = [VehicleSpec(position=at, speed=v) for at, v in
                (((55.0, 0.0), 5.5), ((-30.0, 0.0), 5.5), ((59.0, 0.0), 4.0))]  # fmt: skip
    game = msgspec.structs.replace(border, evader=far, pursuers=tuple(pursuers))
    assert denies(game) == (True, False, False)
