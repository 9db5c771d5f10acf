"""`gcs assess`: of a file, and of what a picture knows of the game on the bus."""

from __future__ import annotations

import pytest

from gcs.picture.assessment import engagements_in
from gcs.picture.reducer import PictureReducer
from gcs.programs import assess_file
from onboard.game.odds import features
from onboard.runtime.resources import configs
from tests.support.chase_messages import chase


def test_a_file_is_judged(capsys: pytest.CaptureFixture[str]) -> None:
    code = assess_file(configs() / "scenarios" / "table1" / "row03.toml")
    told = capsys.readouterr().out
    assert (code, told.partition(":")[0]) in ((0, "go"), (1, "no-go"), (0, "open"))
    assert "bound:" in told


def test_the_game_on_the_bus_is_the_same_engagement() -> None:
    reducer = PictureReducer("field")
    now = 0
    for item in chase(3.0):
        reducer.apply(item.key, item.payload, item.stamp_ns)
        now = item.stamp_ns
    picture = reducer.picture(now)
    (found,) = engagements_in(picture.game, picture.vehicles, picture.tracks).values()
    assert len(found.team) >= 1
    assert found.evader.speed > 0.0
    if found.target.exists:
        assert all(value == value for value in features(found))
