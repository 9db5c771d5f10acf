"""Key patterns agree with Zenoh's own."""

from __future__ import annotations

import zenoh
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.runtime.patterns import intersects, matches

chunks = st.sampled_from(["a", "b", "*", "**"])
patterns = st.lists(chunks, min_size=1, max_size=5).map("/".join)


@given(patterns, patterns)
@settings(max_examples=400, deadline=None)
def test_patterns_meet_where_zenoh_says_they_do(one: str, other: str) -> None:
    expected = zenoh.KeyExpr.autocanonize(one).intersects(zenoh.KeyExpr.autocanonize(other))
    assert intersects(one, other) == expected


def test_an_agent_that_watches_one_mate_hears_no_other() -> None:
    assert matches("apollonius/g/vehicles/2/state", "apollonius/g/vehicles/2/state")
    assert not matches("apollonius/g/vehicles/2/state", "apollonius/g/vehicles/1/state")
    assert matches("apollonius/g/**", "apollonius/g/roles/evader/brief")
    assert not matches("apollonius/g/*/state", "apollonius/g/vehicles/2/state")
