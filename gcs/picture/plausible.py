"""Whether a decoded message can be true: what cannot would only break sums further on. Pure."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from onboard.wire.bus.messages import EvaderBrief, Message, OwnBrief, Setup, State, Track, Triple

FARTHEST = 1e6  # [m] and [m/s]: no game is larger, nothing flies so fast


def plausible(message: Message) -> bool:
    """Whether the places [m], speeds [m/s] and lengths [m] of a message can be those of a game."""
    check = _CHECKS.get(type(message))
    return check is None or check(message)


def _state(state: State) -> bool:
    values = (*state.position, *state.velocity, *state.wind)
    return min(values) > -FARTHEST and max(values) < FARTHEST


def _track(track: Track) -> bool:
    return _sane(*track.position, *track.velocity)


def _setup(setup: Setup) -> bool:
    lengths = (setup.rules.R, setup.rules.rho, setup.rules.separation)
    sizes = (*lengths, *(member.speed for member in setup.roster))
    goals = all(_places(*one.targets) for one in setup.targets)
    goals = goals and (setup.target is None or _sane(*setup.target))
    return goals and _sane(*sizes) and min(sizes) >= 0.0


def _brief(brief: EvaderBrief) -> bool:
    return (brief.target is None or _sane(*brief.target)) and _places(*brief.targets)


def _own_brief(brief: OwnBrief) -> bool:
    return _places(*brief.targets)


def _places(*places: Triple) -> bool:
    return all(_sane(*place) for place in places)


def _sane(*values: float) -> bool:
    return min(values) > -FARTHEST and max(values) < FARTHEST


_CHECKS: dict[type[Message], Callable[[Any], bool]] = {
    State: _state,
    Track: _track,
    Setup: _setup,
    EvaderBrief: _brief,
    OwnBrief: _own_brief,
}
