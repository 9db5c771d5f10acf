"""A play of many games of strategies by name: compiled, or interpreted where one of them does not compile."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from onboard.core.strategy.registry import EVADERS, PURSUERS, evader_named, pursuer_named

Play = Callable[..., Any]


def compiled_or_not(evaders: Iterable[str], pursuers: str, make: Callable[[bool], Play]) -> Play:
    """What `make(compiled)` makes: compiled where all strategies are our own.

    A foreign one need not be in kernel style: then what numba refuses is played interpreted.
    """
    compiled = make(True)
    if {evader_named(name) for name in evaders} <= set(EVADERS) and pursuer_named(pursuers) in PURSUERS:
        return compiled
    from numba.core.errors import NumbaError

    interpreted = make(False)

    def play(*arguments: Any) -> Any:
        try:
            return compiled(*arguments)
        except NumbaError:
            return interpreted(*arguments)

    return play
