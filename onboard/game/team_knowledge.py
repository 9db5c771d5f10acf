"""The knowledge model that a team flies by, from the name of its strategy.

`team` knows the core's own model, `team:plain` none; `team:FILE.py` and `team:NAME` know more: the file, or
what another distribution's entry point `NAME` of the group `apollonius.knowledge` names, has `RELATIONS` and
`GOALS`, tuples of the core's `Relation` and `GoalRule` (either may be missing). They are asked before the
core's own. Written in kernel style they also compile.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from importlib.util import module_from_spec, spec_from_file_location
from inspect import getsourcefile, unwrap
from pathlib import Path
from typing import Any, TypeVar

from onboard.config.in_words import nearest
from onboard.config.printable import words_of
from onboard.config.strict import ConfigError
from onboard.core.game.advance import PursuerStrategy
from onboard.core.strategy.semantic.goals import GoalRule
from onboard.core.strategy.semantic.graph import Relation
from onboard.core.strategy.semantic.model import MODEL, Model, extended
from onboard.core.strategy.team.flying import pursuer_team
from onboard.core.strategy.team.planner import Planner
from onboard.core.strategy.team.planners import planner_for, pursuer_team_plain, team_of

GROUP = "apollonius.knowledge"
TEAM = "team"
PREFIX = f"{TEAM}:"
PLAIN = f"{PREFIX}plain"
MODULE = "apollonius_knowledge_file"

R = TypeVar("R", Relation, GoalRule)


def is_team(name: str) -> bool:
    """Whether pursuers of a strategy of this name fly by their team's plan."""
    return name == TEAM or name.startswith(PREFIX)


def names_file(name: str) -> bool:
    """Whether a strategy's name is that of a file, which would be run."""
    return name.startswith(PREFIX) and name.endswith(".py")


@cache
def strategy(name: str) -> PursuerStrategy:
    """The strategy of a team by its name. Raises ConfigError."""
    if name == TEAM:
        return pursuer_team
    if name == PLAIN:
        return pursuer_team_plain
    return team_of(model(name))


def planner(name: str) -> Planner:
    """What makes the plan of a team of this name. Raises ConfigError."""
    found = planner_for(strategy(name))
    assert found is not None
    return found


def files_of(name: str) -> tuple[Path, ...]:
    """The files in which relations and rules stand that are not the core's own. Raises ConfigError."""
    known = model(name)
    own: list[Callable[..., Any]] = [row.apply for row in known.relations if row not in MODEL.relations]
    own += [row.apply for row in known.goals if row not in MODEL.goals]
    files = (getsourcefile(unwrap(one)) for one in own)
    return tuple(sorted({Path(file) for file in files if file is not None}))


def trouble(name: str) -> str:
    """Why a strategy of this name cannot have its team's knowledge; "" where it can, or is no team's."""
    try:
        if is_team(name):
            strategy(name)
    except ConfigError as error:
        return str(error)
    return ""


@cache
def model(name: str) -> Model:
    """What a team of this name knows; the core's own for `team` and `team:plain`. Raises ConfigError."""
    if name in (TEAM, PLAIN):
        return MODEL
    source = name.removeprefix(PREFIX)
    found = _file(Path(source)) if names_file(name) else _entry(source)
    where = f"knowledge: {source}"
    relations = _rows(found, "RELATIONS", Relation, where)
    goals = _rows(found, "GOALS", GoalRule, where)
    if not relations and not goals:
        raise ConfigError(f"{where}: found neither RELATIONS nor GOALS, expected a tuple of at least one")
    try:
        return extended(relations, goals)
    except ValueError as error:
        raise ConfigError(f"{where}: {error}") from None


def _rows(found: Any, name: str, kind: type[R], where: str) -> tuple[R, ...]:
    rows = getattr(found, name, ())
    if not isinstance(rows, Iterable):
        raise ConfigError(f"{where}: {name}: found {type(rows).__name__}, expected a tuple")
    rows = tuple(rows)
    for row in rows:
        if not isinstance(row, kind):
            raise ConfigError(f"{where}: {name}: found {type(row).__name__}, expected {kind.__name__}")
        if not callable(row.apply):
            raise ConfigError(f"{where}: {name}: {row.name}: apply: expected a function")
        if isinstance(row, Relation):
            _demand_words(row, where)
    return rows


def _demand_words(row: Relation, where: str) -> None:
    try:
        row.words.format(a="one", b="other", value=0.0)
    except (LookupError, ValueError, AttributeError) as error:
        raise ConfigError(
            f"{where}: RELATIONS: {row.name}: words: found {row.words!r}, expected {{a}}, {{b}} and {{value}}"
            f" alone: {words_of(error)}"
        ) from None


def _file(path: Path) -> Any:
    """A file as a module. Raises ConfigError."""
    if not path.is_file():
        raise ConfigError(f"knowledge: {path}: no such file")
    spec = spec_from_file_location(f"{MODULE}_{path.stem}", path)
    assert spec is not None
    loader = spec.loader
    assert loader is not None
    module = module_from_spec(spec)
    _loaded(lambda: loader.exec_module(module), str(path))
    return module


def _entry(name: str) -> Any:
    from importlib.metadata import EntryPoint, entry_points  # it brings the parser of e-mails

    points: dict[str, EntryPoint] = {point.name: point for point in entry_points(group=GROUP)}
    if name not in points:
        names = ["plain", *sorted(points)]
        words = f"{', '.join(names)} or a file FILE.py{nearest(name, names)}"
        raise ConfigError(f"knowledge: found '{name}', expected one of: {words}")
    return _loaded(points[name].load, name)


def _loaded(load: Any, name: str) -> Any:
    try:
        return load()
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a foreign module may fail in any way, `sys.exit` among them
        raise ConfigError(f"knowledge: {name} does not load: {words_of(error)}") from None
