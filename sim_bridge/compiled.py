"""The core compiled: the same source, registered with numba, played at millions of steps a second.

The core itself knows nothing of numba. `register()` marks every kernel of the given modules as
compilable (`register_jitable`), functions found in closures included, and gives `each` its
compiled form: a tuple written out in full for the length at hand.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable
from functools import cache
from types import FunctionType, ModuleType
from typing import Any, NamedTuple

import numba
from numba.core import types
from numba.extending import overload, register_jitable

from onboard.core import each as each_module
from onboard.core.game import (
    EvaderStrategy,
    Game,
    Params,
    PursuerStrategy,
    advance,
)
from onboard.core.referee import Verdict

KERNELS = (
    "onboard.core.vectors",
    "onboard.core.apollonius",
    "onboard.core.cones",
    "onboard.core.evasion",
    "onboard.core.pursuit",
    "onboard.core.referee",
    "onboard.core.game",
)

# Everything is inlined, or else the many small functions would pass whole games by value; but
# this one is called from every rule and would swell the code.
OUT_OF_LINE = frozenset({"free_ray_limited"})

_registered: set[int] = set()


def register(modules: Iterable[str] = KERNELS) -> None:
    """Register every function of the modules with numba; idempotent."""
    _overload_each()
    for name in modules:
        for function in _functions(importlib.import_module(name)):
            _register(function)


def _functions(module: ModuleType) -> list[FunctionType]:
    return [value for value in vars(module).values() if isinstance(value, FunctionType)]


def _register(function: FunctionType) -> None:
    if id(function) in _registered or function.__module__ == each_module.__name__:
        return
    if not function.__module__.startswith(("onboard.core", "sim_bridge")):
        return
    _registered.add(id(function))
    for cell in function.__closure__ or ():
        if isinstance(cell.cell_contents, FunctionType):
            _register(cell.cell_contents)
    register_jitable(forceinline=function.__name__ not in OUT_OF_LINE)(function)


@cache
def _overload_each() -> None:
    def compiled_each(function, items, shared):  # type: ignore[no-untyped-def]
        calls = "".join(f"function(items[{k}], {k}, shared), " for k in range(_count(items)))
        return _written_out("function, items, shared", calls)

    def compiled_pair(function, items, others, shared):  # type: ignore[no-untyped-def]
        calls = "".join(f"function(items[{k}], others[{k}], shared), " for k in range(_count(items)))
        return _written_out("function, items, others, shared", calls)

    options = {"forceinline": True}
    overload(each_module.each, jit_options=options)(compiled_each)
    overload(each_module.each_pair, jit_options=options)(compiled_pair)


def _count(items: Any) -> int:
    return len(items) if isinstance(items, types.BaseTuple) else 0


def _written_out(arguments: str, calls: str) -> Any:
    names: dict[str, Any] = {}
    exec(f"def written_out({arguments}):\n    return ({calls})", names)
    return names["written_out"]


class Play(NamedTuple):
    """How a compiled game ended."""

    game: Game
    steps: int


def player(
    decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy
) -> Callable[[Game, Params, int], Play]:
    """The compiled play of one game under two strategies in kernel style.

    The result is called with a game (from `onboard.core.game.begin`), its parameters and the most
    steps to play. It compiles once for each number of pursuers (a few seconds).
    """
    register()
    _register(decide_evader)  # type: ignore[arg-type]
    _register(decide_pursuer)  # type: ignore[arg-type]

    @numba.njit(nogil=True)  # type: ignore[untyped-decorator,unused-ignore]
    def play(game: Game, params: Params, most: int) -> Play:
        steps = 0
        while steps < most and game.score.verdict == Verdict.RUNNING:
            game = advance(game, params, decide_evader, decide_pursuer)
            steps += 1
        return Play(game, steps)

    compiled: Callable[[Game, Params, int], Play] = play
    return compiled


def play_interpreted(
    game: Game, params: Params, most: int, decide_evader: EvaderStrategy, decide_pursuer: PursuerStrategy
) -> Play:
    """The same play, interpreted."""
    steps = 0
    while steps < most and game.score.verdict == Verdict.RUNNING:
        game = advance(game, params, decide_evader, decide_pursuer)
        steps += 1
    return Play(game, steps)
