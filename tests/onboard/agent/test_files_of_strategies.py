"""No word over the bus has an agent run a file: that is said to the agent itself."""

from __future__ import annotations

from pathlib import Path

from onboard.wire.bus.messages import Member, Phase, Role
from tests.support.lone_agent import EVADER, VEHICLE, LoneAgent

RULES = """from pathlib import Path

from onboard.core.strategy.semantic.goals import GOALS as OWN

Path(__file__).with_suffix(".ran").touch()
GOALS = (OWN[-1]._replace(id=100, name="mine"),)
"""


def told(file: Path, **config: str) -> LoneAgent:
    """An agent in a game whose setup names a file as its strategy."""
    agent = LoneAgent(**config)
    agent.run(1.0)
    agent.master.setup(roster=(
        Member(EVADER, Role.EVADER, 10.0, (200.0, 0.0, -50.0)),
        Member(VEHICLE, Role.PURSUER, 15.0, (0.0, 0.0, -50.0), strategy=f"team:{file}"),
    ))  # fmt: skip
    agent.master.phase(Phase.STAGING)
    agent.run(2.0)
    return agent


def test_a_file_that_a_setup_names_is_not_run(tmp_path: Path) -> None:
    file = tmp_path / "rules.py"
    file.write_text(RULES, encoding="utf-8")
    agent = told(file)
    assert not file.with_suffix(".ran").exists()
    assert agent.health is not None
    assert any(f"the setup's strategy: found the file 'team:{file}'" in why for why in agent.health.lacks)


def test_a_file_that_the_agent_is_started_with_is_run(tmp_path: Path) -> None:
    file = tmp_path / "rules.py"
    file.write_text(RULES, encoding="utf-8")
    agent = told(file, strategy=f"team:{file}")
    assert file.with_suffix(".ran").exists()
    assert agent.health is not None
    assert not any("strategy" in why for why in agent.health.lacks)
