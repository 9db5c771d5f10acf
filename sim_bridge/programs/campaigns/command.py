"""From options to a campaign: which scenarios, strategies, values and seeds are meant."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from onboard.config.bounds import SEED_MAX
from onboard.config.names import file_name
from onboard.config.strict import ConfigError
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.plugins import demand_name, evader_strategy, plugin_names, pursuer_strategy
from onboard.game.scenario import load
from onboard.runtime.resources import SCENARIOS, shipped_file
from sim_bridge.programs.campaigns import sweep
from sim_bridge.programs.campaigns.fingerprint import fingerprint
from sim_bridge.programs.campaigns.plan import (
    AS_WRITTEN,
    FORMAT,
    Chosen,
    Pair,
    Plan,
    chosen,
    demand_playable,
)
from sim_bridge.programs.campaigns.run import Ways, part_of
from sim_bridge.programs.campaigns.until import parse

ALL = "all"
GAMES = 100  # of a cell, where nothing is said
MAX_GAMES = 1_000_000  # in all, under a rule


class Options(NamedTuple):
    """What `campaign run` can be told of the games."""

    scenarios: tuple[Path, ...]
    evaders: tuple[str, ...] = ()  # none: the scenario's
    pursuers: tuple[str, ...] = ()
    sweep: Path | None = None
    games: int | None = None  # of each cell
    max_games: int | None = None  # in all
    seed: int = 1  # the first
    shard_games: int = 1000
    flown: bool = False


class Played(NamedTuple):
    """What it can be told of who plays; None: nothing is said."""

    workers: int | None = None
    dask: str | None = None
    shard: str | None = None
    until: str | None = None


def plan_of(options: Options, until: bool) -> Plan:
    """The plan that the options mean; `until`: a rule ends it. Raises ConfigError."""
    if until and options.games is not None:
        raise ConfigError("--games: found with --until, expected --max-games: the rule says how many")
    scenarios = scenarios_of(options.scenarios)
    evaders = named(options.evaders, "evader")
    pursuers = named(options.pursuers, "pursuer")
    points = [{}] if options.sweep is None else sweep.load(options.sweep)
    pairs = [Pair(evader, pursuing) for evader in evaders for pursuing in pursuers]
    used = {*evaders, *pursuers, *(name for one in scenarios for name in strategies_in(one))}
    cells = len(scenarios) * len(points) * len(pairs)
    most = options.max_games or (MAX_GAMES if until else None)
    games = (options.games or GAMES) if most is None else max(1, most // cells)
    if most is not None and options.games is not None:
        games = min(games, options.games)
    last = SEED_MAX - games + 1 - max(one.data["seed"] for one in scenarios)
    if options.seed > last:
        raise ConfigError(f"--seed: found {options.seed}, expected at most {last} for {games} games")
    plan = Plan(
        format=FORMAT,
        scenarios=scenarios,
        points=points,
        pairs=pairs,
        first_seed=options.seed,
        games=games,
        shard_games=options.shard_games,
        flown=options.flown,
        fingerprint=fingerprint(tuple(sorted(used)), flown=options.flown),
    )
    demand_playable(plan)
    return plan


def scenarios_of(paths: tuple[Path, ...]) -> list[Chosen]:
    """Scenario files or names, each under its short name. Raises ConfigError."""
    files = [shipped_file(path, SCENARIOS.sought_first("spatial")) for path in paths]
    stems = [file.stem for file in files]
    labels = [
        file.stem if stems.count(file.stem) == 1 else f"{file.parent.name or '.'}/{file.stem}"
        for file in files
    ]
    for label in labels:
        if labels.count(label) > 1:
            raise ConfigError(f"SCENARIO: found {label} twice, expected each once")
    return [chosen(label, load(file, several=True)) for label, file in zip(labels, files, strict=True)]


def strategies_in(one: Chosen) -> list[str]:
    """The strategies that a scenario names."""
    everybody = one.data["evader"], *one.data["pursuers"], *one.data.get("evaders", ())
    return [spec["strategy"] for spec in everybody]


def named(names: tuple[str, ...], role: str) -> list[str]:
    """Strategies of a role ("evader" or "pursuer"): as named, all that are known, or the scenario's.

    Raises ConfigError for an unknown one.
    """
    if not names:
        return [AS_WRITTEN]
    find: Callable[[str], object] = evader_strategy if role == "evader" else pursuer_strategy
    where = "--evader" if role == "evader" else "--pursuers"
    found: list[str] = []
    for name in names:
        if name == ALL:
            found += all_of(role)
        else:
            demand_name(name, role, where)
            find(name)
            found.append(name)
    return list(dict.fromkeys(found))


def all_of(role: str) -> list[str]:
    """The strategies of a role, each once by its first name, those of other distributions included."""
    known: Mapping[str, Any] = EVADERS if role == "evader" else PURSUERS
    first = {strategy.decide: name for name, strategy in reversed(list(known.items()))}
    own = [name for name, strategy in known.items() if first[strategy.decide] == name]
    find: Callable[[str], object] = evader_strategy if role == "evader" else pursuer_strategy
    for name in plugin_names():
        try:
            find(name)
        except ConfigError:  # of the other role, or it does not load: who names it is told
            continue
        own.append(name)
    return own


def ways_of(played: Played) -> Ways:
    """By whom it is played. Raises ConfigError for options that exclude each other."""
    workers, dask, shard, until = played
    if dask is not None and workers is not None:
        raise ConfigError("--workers: found with --dask, whose cluster has workers of its own")
    if until is not None and shard is not None:
        raise ConfigError("--until: found with --shard, whose jobs do not see each other's games")
    return Ways(
        workers or len(os.sched_getaffinity(0)),
        dask or "",
        (1, 1) if shard is None else part_of(shard),
        None if until is None else parse(until),
    )


def folder_of(options: Options) -> Path:
    """Where a campaign's results go when no folder is named."""
    first = file_name(options.scenarios[0].stem)
    return Path("runs") / f"campaign-{first}{'-flown' if options.flown else ''}"
