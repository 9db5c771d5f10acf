"""A team's knowledge by its strategy's name: a file, another distribution's, and what is wrong with one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from onboard.config.strict import ConfigError
from onboard.core.game.advance import Conditions, Game, begin
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, ZERO, Vec, scale
from onboard.core.strategy.registry import EVADERS
from onboard.game.plugins import demand_name, pursuer_strategy
from onboard.game.team_knowledge import files_of, model, planner, trouble
from sim_bridge.campaign.compiled import Ends, campaign, starts_of
from sim_bridge.programs.campaigns.fingerprint import fingerprint
from tests.support.paths import ROOT

EXAMPLE = f"team:{ROOT}/examples/knowledge-rule/apollonius_engage.py"
UNSAID = """
from onboard.core.strategy.semantic.graph import NONE, Node, Relation
RELATIONS = [Relation(101, "mine", "{who} runs", Node.EVADER, Node.BAND, lambda s, i, j: NONE)]
"""
GOAL = Vec(60.0, 0.0, 0.0)


def game() -> Game:
    """Three who are in time for the target, two of them near the evader."""
    team = tuple(Vehicle(Vec(x, y, 0.0), scale(NORTH, v), v) for x, y, v in
                 ((30.0, 4.0, 4.5), (31.0, -6.0, 4.5), (60.0, 25.0, 4.0)))  # fmt: skip
    return begin(Vehicle(ZERO, scale(NORTH, 5.0), 5.0), team, FREE, (FREE,) * 3)


def ends(name: str, compiled: bool) -> Ends:
    conditions = Conditions(
        Rules(2.0, 4.0, horizon=40.0, planar=True, target_known=True), Target(True, GOAL), Control(0.1)
    )
    play = campaign(EVADERS["paper"].decide, pursuer_strategy(name), 3, compiled)
    return play(starts_of([game()], [GOAL]), conditions, 1, 400)


def test_a_file_changes_what_the_team_does() -> None:
    own, mine = ends("team", compiled=False), ends(EXAMPLE, compiled=False)
    assert not np.array_equal(own.trace, mine.trace, equal_nan=True)
    assert model(EXAMPLE).relations[-1].name == "near"
    assert model(EXAMPLE).goals[0].name == "engage"


def test_campaigns_tell_apart_what_a_team_knows(tmp_path: Path) -> None:
    """A campaign that goes on by another file, or by one that has changed, would mix two teams."""
    text = Path(EXAMPLE.removeprefix("team:")).read_text(encoding="utf-8")
    found = []
    for number, changed in enumerate((text, text, text.replace("REACH = 10.0", "REACH = 11.0"))):
        file = tmp_path / f"rules{number}.py"
        file.write_text(changed, encoding="utf-8")
        assert files_of(f"team:{file}") == (file,)
        found.append(fingerprint((f"team:{file}",), flown=False).plugins[f"team:{file}"])
    assert found[0] == found[1] != found[2]
    plain = fingerprint(("team:plain",), flown=False).plugins
    assert plain["team:plain"].strip() == ""


@pytest.mark.long
@pytest.mark.parametrize("name", ["team", EXAMPLE])
def test_a_knowledge_model_plays_compiled_as_it_does_interpreted(name: str) -> None:
    one, other = ends(name, compiled=True), ends(name, compiled=False)
    assert (one.verdicts, one.steps) == (other.verdicts, other.steps)
    np.testing.assert_allclose(one.trace, other.trace, atol=1e-9)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x = 1\n", "found neither RELATIONS nor GOALS"),
        ("GOALS = (1,)\n", "GOALS: found int, expected GoalRule"),
        ("RELATIONS = 5\n", "RELATIONS: found int, expected a tuple"),
        ("import no_such_module\n", "does not load: No module named 'no_such_module'"),
        ("from onboard.core.strategy.semantic.goals import GOALS\n", "rule enclosed: found number"),
        (UNSAID, "mine: words: found '{who} runs', expected {a}, {b} and {value} alone"),
        ("1 +\n", "does not load: invalid syntax"),
    ],
)
def test_a_wrong_file_costs_one_line(text: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError, match=r"^pursuers\[0\]: knowledge: .*mine\.py") as found:
        demand_name(f"team:{file}", "pursuer", "pursuers[0]")
    assert said in str(found.value)
    assert "\n" not in str(found.value)
    assert trouble(f"team:{file}") != ""


def test_no_file_and_no_such_name_say_what_there_is(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no such file"):
        planner(f"team:{tmp_path}/nowhere.py")
    with pytest.raises(ConfigError, match=r"found 'plane', expected one of: plain.*did you mean 'plain'"):
        planner("team:plane")
    assert trouble("team") == trouble("team:plain") == trouble("paper") == ""


def test_another_distribution_names_its_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    info = tmp_path / "apollonius_engage-0.1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: apollonius-engage\nVersion: 0.1.0\n")
    (info / "entry_points.txt").write_text("[apollonius.knowledge]\nengage = apollonius_engage\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.syspath_prepend(str(ROOT / "examples" / "knowledge-rule"))
    assert model("team:engage").goals[0].when == "two are near the evader"
