"""`sim-bridge bench`: the campaign behind the leaderboard, and its page."""

from __future__ import annotations

from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

from onboard.config.strict import ConfigError
from onboard.runtime.whole_files import sweep, write_whole
from sim_bridge.programs.campaigns import command
from sim_bridge.programs.campaigns.run import Ways, run
from sim_bridge.programs.campaigns.show import results
from sim_bridge.programs.leaderboard import page
from sim_bridge.programs.leaderboard.ratings import Board, board

SCENARIOS = (*(f"table1/row{number:02d}" for number in range(1, 11)), "demo", "five")
GAMES = 20  # of each cell
KEY_MIN = 16  # characters


class Options(NamedTuple):
    """What `bench` can be told."""

    scenarios: tuple[Path, ...] = ()  # none: the fixed set
    evaders: tuple[str, ...] = ()  # none: all
    pursuers: tuple[str, ...] = ()
    games: int = GAMES
    key: Path | None = None  # file of the key that hides the seeds
    workers: int | None = None
    out: Path = Path("runs/bench")


class Made(NamedTuple):
    """What a run of the leaderboard leaves."""

    board: Board
    page: Path
    data: Path


def classic_scenarios() -> list[Path]:
    """The classical problems that it can play: simple motion in the plane, a fixed target at most."""
    from sim_bridge.classic.problems import played_by_bench

    return [Path(name) for name in played_by_bench()]


def bench(options: Options, say: Callable[[str], None]) -> Made:
    """Play what the leaderboard lacks and write its page. Raises ConfigError."""
    first, commitment = seeds_of(options.key)
    told = command.Options(
        options.scenarios or tuple(map(Path, SCENARIOS)),
        options.evaders or (command.ALL,),
        options.pursuers or (command.ALL,),
        games=options.games,
        seed=first,
    )
    ways = command.ways_of(command.Played(options.workers))
    plan = run(options.out / "games", command.plan_of(told, until=False), Ways(ways.workers), say)
    compared = board(results(options.out / "games"))
    sweep(options.out)
    paths = options.out / "bench.html", options.out / "bench.json"
    write_whole(paths[0], page.page(plan, compared, commitment).encode())
    write_whole(paths[1], page.as_json(plan, compared, commitment))
    return Made(compared, *paths)


def seeds_of(key: Path | None) -> tuple[int, str]:
    """The first seed that a key's file hides, and the hash by which its owner can later prove it.

    Without a key the seeds are public, from 1. Raises ConfigError.
    """
    if key is None:
        return 1, ""
    try:
        secret = key.read_bytes().strip()
    except OSError as error:
        raise ConfigError(f"--key: {key}: {(error.strerror or str(error)).lower()}") from None
    if len(secret) < KEY_MIN:
        raise ConfigError(f"--key: {key}: found {len(secret)} characters, expected {KEY_MIN} or more")
    first = int.from_bytes(sha256(b"apollonius leaderboard\0" + secret).digest()[:8]) >> 2
    return first, sha256(secret).hexdigest()
