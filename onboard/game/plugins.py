"""Strategies by name: the core's own, those of other distributions, and trained ones (`policy:FILE`).

A distribution adds a strategy through the entry-point group `apollonius.strategies`; the entry
point names an object with `role` ("pursuer" or "evader") and `decide`, a pure function from a
`PursuerView` or an `EvaderView` to a `Decision`. It runs interpreted; written in kernel style it
also compiles.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, cast

from onboard.config.in_words import nearest
from onboard.config.printable import words_of
from onboard.config.strict import ConfigError
from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.strategy.registry import EVADERS, PURSUERS, evader_named, pursuer_named
from onboard.game.policy_file import is_policy
from onboard.game.policy_file import strategy as policy
from onboard.game.team_knowledge import is_team
from onboard.game.team_knowledge import strategy as team

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

GROUP = "apollonius.strategies"


def pursuer_strategy(name: str) -> PursuerStrategy:
    """A pursuers' strategy by name ("" = the default). Raises ConfigError for an unknown one."""
    if (own := pursuer_named(name)) in PURSUERS:
        return PURSUERS[own].decide
    if is_team(name):
        return team(name)
    if is_policy(name):
        return cast(PursuerStrategy, policy(name, "pursuer"))
    found: PursuerStrategy = _plugin(name, "pursuer", list(PURSUERS))
    return found


def evader_strategy(name: str) -> EvaderStrategy:
    """The evader's strategy by name ("" = the default). Raises ConfigError for an unknown one."""
    if (own := evader_named(name)) in EVADERS:
        return EVADERS[own].decide
    if is_policy(name):
        return cast(EvaderStrategy, policy(name, "evader"))
    found: EvaderStrategy = _plugin(name, "evader", list(EVADERS))
    return found


def demand_name(name: str, role: str, where: str) -> None:
    """Demand that a strategy of this name is known for a role ("evader" or "pursuer"), without loading a
    plug-in: what that is for is seen where it is loaded. Raises ConfigError that begins with `where`."""
    known = list(EVADERS if role == "evader" else PURSUERS)
    if is_policy(name):
        try:
            policy(name, role)
        except ConfigError as error:
            raise ConfigError(f"{where}: {error}") from None
        return
    if role == "pursuer" and is_team(name):
        try:
            team(name)
        except ConfigError as error:
            raise ConfigError(f"{where}: {error}") from None
        return
    named = evader_named(name) if role == "evader" else pursuer_named(name)
    if named not in known and name not in plugin_names():
        names = [*known, *plugin_names()]
        words = f"{', '.join(names)}{nearest(name, names)}"
        role_words = "an evader" if role == "evader" else f"a {role}"
        raise ConfigError(f"{where}: strategy: found '{name}', expected one of {role_words}'s: {words}")


def plugin_names() -> tuple[str, ...]:
    """Names that other distributions add."""
    return tuple(sorted({point.name for point in _points()}))


def plugins() -> list[tuple[str, str]]:
    """Names that other distributions add, with the distribution and its release."""
    found = {(point.name, f"{d.name} {d.version}" if (d := point.dist) else point.value)
             for point in _points()}  # fmt: skip
    return sorted(found)


def _points() -> Iterable[EntryPoint]:
    from importlib.metadata import entry_points  # it brings the parser of e-mails: for who needs it

    return entry_points(group=GROUP)


def _plugin(name: str, role: str, known: list[str]) -> Any:
    points = [point for point in _points() if point.name == name]
    if not points:
        names = [*known, *plugin_names()]
        words = f"{', '.join(names)}{nearest(name, names)}"
        raise ConfigError(f"strategy: found '{name}', expected one of: {words}")
    plugin = _load(points[0])
    found = getattr(plugin, "role", None)
    if found != role:
        raise ConfigError(f"strategy: '{name}' is for the role {found!r}, expected '{role}'")
    decide = getattr(plugin, "decide", None)
    if not callable(decide):
        raise ConfigError(f"strategy: '{name}' has no function 'decide'")
    return decide


def _load(point: EntryPoint) -> Any:
    try:
        return point.load()
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a foreign module may fail in any way, `sys.exit` among them
        why = f"strategy: '{point.name}' ({point.value}) does not load: {words_of(error)}"
        raise ConfigError(why) from None
