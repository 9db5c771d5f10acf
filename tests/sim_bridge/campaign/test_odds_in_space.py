"""The odds in space against games of aircraft that no fit has seen, and the starts that the fit draws."""

from __future__ import annotations

import numpy as np
import pytest

from onboard.core.game.referee import GameResult
from onboard.core.math.vectors import distance
from onboard.game.go_or_no_go import engagement_of
from onboard.game.odds import chances, outside, sheet_of
from sim_bridge.campaign.odds import EVADING, space_part, space_scenario

NEW = 100_000  # seeds from here on are in no fit


def test_what_is_drawn_has_rings_staged_and_open_starts_within_the_domain() -> None:
    starts = [space_scenario(NEW + seed, 5) for seed in range(60)]
    speeds = {p.speed for start in starts for p in start.pursuers}
    assert min(speeds) < 37.0
    assert max(speeds) > 43.0
    even = 0
    for start in starts:
        e = start.evader.start()
        far = [distance(p.start(), e) for p in start.pursuers]
        even += max(far) - min(far) < 1.0
        assert min(far) > 600.0
        assert start.seed not in {s.seed for s in starts if s is not start}
    assert 2 <= even <= 15
    s = [engagement_of(start) for start in starts]
    sheet_ = sheet_of(s[0])
    assert sheet_ is not None
    assert sum(not outside(one, sheet_) for one in s) >= 55


@pytest.mark.long
@pytest.mark.timeout(900)
def test_new_games_of_aircraft_end_as_often_as_the_table_says() -> None:
    part = space_part(60, 5, NEW)
    said, happened = [], []
    for k in range(60):
        found = chances(engagement_of(space_scenario(NEW + 1 + k, 5)), EVADING[0])
        if found is not None:
            said.append(found.captured.p)
            happened.append(part.ends[k, 0] == GameResult.CAPTURED)
    p, y = np.array(said), np.array(happened, float)
    assert len(p) >= 50
    assert abs(float((p - y).sum())) < 3.5 * float(np.sqrt((p * (1 - p)).sum() + 1.0))
    assert float(np.mean((p - y) ** 2)) < 0.6 * float(y.mean() * (1 - y.mean()))
