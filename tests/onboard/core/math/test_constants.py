"""NEVER behaves like an instant in the arithmetic that rules do, interpreted and compiled."""

from math import inf

import numba

from onboard.core.math.constants import NEVER


def _too_old(now: float, at: float, most: float) -> bool:
    return now - at > most


def _running(now: float, at: float) -> bool:
    return 0.0 <= now - at <= 1.0


def test_what_never_happened_is_older_than_any_limit() -> None:
    for rule in (_too_old, numba.njit(_too_old)):
        assert rule(0.0, NEVER, 1e300)
        assert rule(-1e9, NEVER, 1e300)  # a clock before its zero
    for rule in (_running, numba.njit(_running)):
        assert not rule(5.0, NEVER)
    assert max(NEVER, 3.0) == 3.0
    assert inf == 3.0 - NEVER
