"""A share of the long soak (`make soak`) in every test run: a minute of flight, and its resumption."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from tests.soak import run
from tests.soak.faults import NAMES


@pytest.mark.game
@pytest.mark.timeout(300)
def test_a_minute_of_faults_leaves_nobody_stuck_and_no_stop_unexplained() -> None:
    totals = Counter[str]()
    run.play(2, 1, totals, 60.0)
    assert totals["simulated_s"] >= 60
    assert totals["stops"] >= 3
    assert len([name for name in NAMES if totals[name]]) >= 6
    assert totals["games_ended"] == 0


@pytest.mark.timeout(300)
def test_a_soak_continues_where_it_stopped_and_repeats_to_the_last_fault(tmp_path: Path) -> None:
    resume, said = tmp_path / "state.json", list[str]()
    first = run.run(0.001, 5, resume, said.append, seconds=3.0)
    hours = first["simulated_s"] / 3600.0 + 1e-6  # one more game
    half = run.run(hours, 5, resume, said.append, seconds=3.0)
    whole = run.run(hours, 5, None, lambda line: None, seconds=3.0)
    assert half == whole
    assert half["simulated_s"] > first["simulated_s"]
    assert len(said) == 2


def test_a_stop_without_a_word_or_a_vehicle_that_stays_down_ends_the_soak() -> None:
    with pytest.raises(AssertionError, match="stopped without a word at"):
        run.play(2, 1, Counter(), 60.0, explains=())
