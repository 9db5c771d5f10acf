"""The leaderboard's default set, as `sim-bridge bench` plays it: `python -m tests.benchmarks.leaderboard`.

Resumable: a shard that is in the folder is not played again. Not run by pytest.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from time import process_time

from sim_bridge.programs.campaigns.plan import Plan
from sim_bridge.programs.campaigns.show import results
from sim_bridge.programs.leaderboard.command import Options, bench
from sim_bridge.programs.leaderboard.ratings import Board, Score
from tests.support.benchmark_record import write


def scores(side: str, found: list[Score]) -> list[str]:
    """A side's ratings, best first."""
    rows = [f"| {s.name} | {s.rating:+.0f} ({s.low:+.0f} … {s.high:+.0f}) | {s.share:.1%} |" for s in found]
    return [f"| {side} | rating (95 %) | points |", "|---|---|---|", *rows, ""]


def matrix(title: str, board: Board, chosen: list[int]) -> list[str]:
    """Shares captured over some scenarios, both sides best first."""
    evaders = [score.name for score in board.evader_scores]
    shares = board.captured[chosen].mean(axis=0)
    lines = [
        f"## {title}",
        "",
        f"| pursuers \\ evader | {' | '.join(evaders)} |",
        "|---" * (len(evaders) + 1) + "|",
    ]
    for score in board.pursuer_scores:
        p = board.pursuers.index(score.name)
        cells = (f"{shares[board.evaders.index(name), p]:.0%}" for name in evaders)
        lines.append(f"| {score.name} | {' | '.join(cells)} |")
    return [*lines, ""]


def page(plan: Plan, board: Board) -> list[str]:
    """The committed page."""
    versions = ", ".join(f"{name} {value}" for name, value in sorted(plan.fingerprint.versions.items()))
    aircraft = [k for k, name in enumerate(board.scenarios) if name == "five"]
    plane = [k for k in range(len(board.scenarios)) if k not in aircraft]
    counts = " × ".join(
        map(str, (len(board.pursuers), len(board.evaders), len(board.scenarios), board.games))
    )
    return [
        f"{counts} games (pursuers' strategies, evaders, scenarios, public seeds from {plan.first_seed}):"
        f" {board.points.size * board.games}. Scenarios: {', '.join(board.scenarios)}. {versions}; sources"
        f" `{plan.fingerprint.sources[:16]}`.",
        "",
        "Ratings on Elo's scale by the model of Bradley and Terry with a term for each scenario; arrivals are"
        " the evader's, captures and denied targets the pursuers', escapes are a draw.",
        "",
        *scores("pursuers", board.pursuer_scores),
        *scores("evader", board.evader_scores),
        *(matrix("Captured, aircraft in wind", board, aircraft) if aircraft else []),
        *(matrix("Captured, simple motion", board, plane) if plane else []),
    ]  # fmt: skip


def main() -> None:
    """Play what is missing of the default set and write benchmarks/results/leaderboard.md."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, default=Path("runs/bench"))
    parser.add_argument("--games", type=int, default=20)
    parser.add_argument("--workers", type=int, default=1)
    for name in ("scenario", "evader", "pursuers"):
        parser.add_argument(f"--{name}", action="append", default=[], help="as of `sim-bridge bench`")
    told = parser.parse_args()
    begun, fresh = process_time(), not told.folder.exists()
    chosen = tuple(map(Path, told.scenario)), tuple(told.evader), tuple(told.pursuers)
    made = bench(Options(*chosen, told.games, None, told.workers, told.folder), print)
    took = f"{process_time() - begun:.0f} CPU-seconds of one process"
    found = results(told.folder / "games")
    lines = page(found.plan, made.board)
    if fresh and told.workers == 1:
        lines += [f"All of it, what had to be compiled included, took {took}."]
    elif told.workers == 1:
        lines += [f"With the shards that were there, it took {took}."]
    print("\n".join(lines))
    parts = [
        f" --{name} {value}" for name in ("scenario", "evader", "pursuers") for value in getattr(told, name)
    ]
    command = f"sim-bridge bench --games {told.games}{''.join(parts)}"
    write("leaderboard.md", "The leaderboard", command, lines)


if __name__ == "__main__":
    main()
