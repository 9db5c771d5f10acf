"""A share of the long fuzz (`make fuzz`) in every test run."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from tests.fuzz import autopilots, campaign, framing, signing


def test_no_frame_raises_and_none_is_lost() -> None:
    totals = campaign.run(framing.play, 20_000, 7, None, lambda line: None)
    assert totals["good"] > 1000
    assert totals["values"] > 1000
    assert totals["bad"] > 5000


def test_no_forgery_passes_and_the_sender_is_always_heard() -> None:
    totals = campaign.run(signing.play, 5_000, 7, None, lambda line: None)
    assert {totals[kind] for kind in signing.KINDS_OF_FORGERY} == {5_000}
    assert totals["legitimate"] == 2_500
    for verdict in ("wrong", "replayed", "unsigned", "future"):
        assert totals[f"counted_signature_{verdict}"] > 500


def test_no_frame_stops_an_autopilot_or_makes_it_say_nonsense() -> None:
    totals = campaign.run(autopilots.play, 20_000, 7, None, lambda line: None)
    assert totals["addressed"] > 500
    assert totals["answers"] > 300


def test_a_campaign_continues_where_it_stopped(tmp_path: Path) -> None:
    resume = tmp_path / "state.json"
    said: list[str] = []
    campaign.run(framing.play, 1_000, 3, resume, said.append, block=1_000)
    half = campaign.run(framing.play, 3_000, 3, resume, said.append, block=1_000)
    whole: Counter[str] = campaign.run(framing.play, 3_000, 3, None, said.append, block=1_000)
    assert half == whole
