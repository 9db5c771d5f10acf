"""No number of a swarm message is NaN or infinite, however deep it lies."""

from __future__ import annotations

from collections import Counter
from math import inf, nan

import msgspec
import pytest

from onboard.wire.bus import messages, topics
from onboard.wire.bus.messages import Fence, LimitsMessage, Member, Origin, Role, RulesMessage, Setup


def setup(
    latitude: float = 47.0, start: float = 1.0, corner: float = 2.0, horizon: float = 60.0, pitch: float = 1.0
) -> Setup:
    return Setup(
        game="g",
        scenario="s",
        scenario_hash="0",
        master="m",
        origin=Origin(latitude, 8.0, 400.0),
        roster=(
            Member(1, Role.EVADER, 4.0, (0.0, 0.0, 0.0), LimitsMessage(pitch_max=pitch)),
            Member(2, Role.PURSUER, 5.0, (0.0, start, 0)),
        ),
        rules=RulesMessage(2.0, 4.0, horizon=horizon),
        fence=Fence(((0.0, 0.0), (corner, 0.0), (0.0, 9.0)), 0.0, 100.0),
    )


def test_a_good_message_passes() -> None:
    drops: Counter[str] = Counter()
    assert topics.SETUP.decode(topics.SETUP.encode(setup()), drops) == setup()
    assert not drops


@pytest.mark.parametrize("bad", [nan, inf, -inf])
@pytest.mark.parametrize("place", ["latitude", "start", "corner", "horizon", "pitch"])
def test_a_number_that_is_none_is_dropped_and_counted(place: str, bad: float) -> None:
    drops: Counter[str] = Counter()
    payload = msgspec.msgpack.encode((messages.SCHEMA, setup(**{place: bad})))
    assert topics.SETUP.decode(payload, drops) is None
    assert drops == {"not_finite": 1}
