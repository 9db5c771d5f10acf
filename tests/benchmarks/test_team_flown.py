"""Two seeds of the team benchmark flown whole: as they are computed from their states at t₀."""

from __future__ import annotations

import pytest

from tests.benchmarks.team import Job, flight_of
from tests.benchmarks.team_cases import demand, game_of

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]


@pytest.mark.parametrize(("case", "seed"), [("front-4", 1), ("shipped-6", 2)])
def test_a_flown_game_of_a_team_is_the_computed_one(case: str, seed: int) -> None:
    job = Job(demand(case), seed, 1, True)
    row = flight_of(game_of(job.case, seed), job)
    assert row["verdict"] == row["computed"]
    assert row["computed_time"] == pytest.approx(row["time"], rel=0.05)
