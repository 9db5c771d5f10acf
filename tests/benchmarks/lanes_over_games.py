"""Whether decisions pay in lanes over games: `python -m tests.benchmarks.lanes_over_games`.

A step of simple motion is cones, meeting points and the referee, besides the search for a free ray. Each of
the three is compiled twice over the same situations: game by game with the core's own functions, as campaigns
play, and many games beside each other without a branch, of which a compiler makes vector instructions. Both
must find the same. The page is benchmarks/results/lanes-over-games.md.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt
from time import process_time
from typing import Any, NamedTuple

import numpy as np
import typer

from onboard.core.game.advance import Conditions
from onboard.core.game.referee import closest
from onboard.core.game.rules import Control, Rules, Target
from onboard.core.geometry.apollonius import closest_approach, intercept
from onboard.core.geometry.cones import Seen, blocked_cone
from onboard.core.math.states import FREE, Vehicle
from onboard.core.math.vectors import NORTH, TINY, ZERO, Vec, sub, unit
from onboard.core.strategy.registry import EVADERS, PURSUERS
from sim_bridge.campaign.compiled import Starts, _blank, campaign, register, register_strategies
from sim_bridge.campaign.kernel_cache import kernel
from tests.benchmarks.lanes_play import ACROSS, block_of, lane_player
from tests.support import benchmark_record

COMMAND = "python -m tests.benchmarks.lanes_over_games"
LANES = 32  # of which a compiler takes as many at once as the processor can
BLOCKS = 16  # of games
TEAM = 5
EVADER, PURSUER, RHO = 5.0, 4.0, 4.0  # [m/s], [m]
STEP = 0.05  # [s]
TURNS, ROUNDS = 200, 7
# Shares of a step's time with five pursuers in the plane, by perf: cones, decisions, referee; free rays and
# views are the rest.
SHARES = (0.34, 0.30, 0.18)

GAMES = 4000
WORDS = """
What it says:

- What has no branch pays: cones, meeting points and the referee are three to four and a half times faster.
- A campaign does not get that as long as strategies are functions of a view, plug-ins among them: a game's
  numbers, which a game alone keeps in registers, are fetched from the lanes and put back at every step, and
  that costs more than cones and referee cost less. It would pay with decisions in lanes too: strategies
  written without a branch, and free rays searched by all lanes at once. So campaigns play game by game.
- With 32 games beside each other their numbers no longer fit the first cache: slower still.
""".strip().splitlines()

Array = Any


class Part(NamedTuple):
    """A part of a step, both ways: `run(places, found, turns)`.

    One has places [m] (games, team, 3) and finds (games, team, 4). The other has both in one array, a row a
    block and pursuer, of 3 + 4 numbers of each game: of two arrays a compiler fears that they overlap.
    """

    name: str
    single: Callable[[Array, Array, int], None]
    lanes: Callable[[Array, Array, int], None]


def cones(places: Array, found: Array, turns: int) -> None:
    """The cones of all pursuers, by the core."""
    for _ in range(turns):
        for g in range(places.shape[0]):
            for p in range(places.shape[1]):
                place = Vec(places[g, p, 0], places[g, p, 1], places[g, p, 2])
                cone = blocked_cone(Vehicle(place, ZERO, PURSUER), p, Seen(ZERO, EVADER, RHO))
                found[g, p, 0] = cone.axis.x
                found[g, p, 1] = cone.axis.y
                found[g, p, 2] = cone.axis.z
                found[g, p, 3] = cone.cos + cone.sin


def cones_in_lanes(air: Array, _found: Array, turns: int) -> None:
    """The same without a branch."""
    sa = PURSUER / EVADER
    ca = sqrt(1.0 - sa * sa)
    for _ in range(turns):
        for r in range(air.shape[0]):
            for i in range(LANES):
                x = air[r, i]
                y = air[r, i + LANES]
                z = air[r, i + 2 * LANES]
                square = x * x + y * y + z * z
                d = sqrt(square)
                k = 1.0 / d
                sb = RHO * k if d > RHO else 1.0
                cb = sqrt(max(0.0, square - RHO * RHO)) * k
                air[r, i + 3 * LANES] = x * k
                air[r, i + 4 * LANES] = y * k
                air[r, i + 5 * LANES] = z * k
                air[r, i + 6 * LANES] = (ca * cb - sa * sb) + (sa * cb + ca * sb)


def meetings(places: Array, found: Array, turns: int) -> None:
    """Where each pursuer heads: to the point of convergence, to the closest approach or parallel."""
    for _ in range(turns):
        for g in range(places.shape[0]):
            for p in range(places.shape[1]):
                place = Vec(places[g, p, 0], places[g, p, 1], places[g, p, 2])
                meeting = intercept(ZERO, NORTH, EVADER, place, PURSUER)
                if not meeting.exists:
                    meeting = closest_approach(ZERO, NORTH, EVADER, place, PURSUER)
                ahead = NORTH
                if meeting.exists:
                    ahead = unit(sub(meeting.point, place), NORTH)
                found[g, p, 0] = ahead.x
                found[g, p, 1] = ahead.y
                found[g, p, 2] = ahead.z
                found[g, p, 3] = meeting.time


def meetings_in_lanes(air: Array, _found: Array, turns: int) -> None:
    """The same without a branch: all three are reckoned, and one is taken."""
    gamma = PURSUER / EVADER
    root = sqrt(1.0 - gamma * gamma)
    a = EVADER * EVADER - PURSUER * PURSUER
    for _ in range(turns):
        for r in range(air.shape[0]):
            for i in range(LANES):
                x = air[r, i]
                y = air[r, i + LANES]
                z = air[r, i + 2 * LANES]
                dd = x * x + y * y + z * z
                half = EVADER * x
                inside = half * half - a * dd
                bottom = half + sqrt(max(0.0, inside))
                meets = inside >= 0.0 and half >= 0.0
                h = sqrt(y * y + z * z)
                nears = x > 0.0
                time = dd / bottom if meets else (x + h * gamma / root) / EVADER
                ax = EVADER * time - x
                n = sqrt(ax * ax + y * y + z * z)
                k = 1.0 / n
                off = not (meets or nears) or n <= TINY
                air[r, i + 3 * LANES] = 1.0 if off else ax * k
                air[r, i + 4 * LANES] = 0.0 if off else -y * k
                air[r, i + 5 * LANES] = 0.0 if off else -z * k
                air[r, i + 6 * LANES] = time if meets or nears else 0.0


def referee(places: Array, found: Array, turns: int) -> None:
    """The nearest that each pursuer comes in a step straight at the evader, which goes north."""
    north = Vec(EVADER * STEP, 0.0, 0.0)
    for _ in range(turns):
        for g in range(places.shape[0]):
            for p in range(places.shape[1]):
                place = Vec(places[g, p, 0], places[g, p, 1], places[g, p, 2])
                k = 1.0 - PURSUER * STEP / 20.0
                seen = closest(place, Vec(place.x * k, place.y * k, place.z * k), ZERO, north)
                found[g, p, 0] = seen.square
                found[g, p, 1] = seen.when


def referee_in_lanes(air: Array, _found: Array, turns: int) -> None:
    """The same without a branch."""
    k = 1.0 - PURSUER * STEP / 20.0
    for _ in range(turns):
        for r in range(air.shape[0]):
            for i in range(LANES):
                rx = air[r, i]
                ry = air[r, i + LANES]
                rz = air[r, i + 2 * LANES]
                x = rx * k - EVADER * STEP - rx
                y = ry * k - ry
                z = rz * k - rz
                cc = rx * rx + ry * ry + rz * rz
                aa = x * x + y * y + z * z
                bb = rx * x + ry * y + rz * z
                when = min(1.0, max(0.0, -bb / aa))
                when = when if aa > TINY * TINY else 0.0
                air[r, i + 3 * LANES] = max(0.0, cc + when * (2.0 * bb + when * aa))
                air[r, i + 4 * LANES] = when


PARTS = (
    Part("cones", cones, cones_in_lanes),
    Part("meeting points", meetings, meetings_in_lanes),
    Part("referee", referee, referee_in_lanes),
)


def situations() -> Array:
    """(games, team, 3) [m]: pursuers 15 to 120 m away all around."""
    rng = np.random.default_rng(1)
    ways = rng.standard_normal((BLOCKS * LANES, TEAM, 3))
    far = rng.uniform(15.0, 120.0, (BLOCKS * LANES, TEAM, 1))
    return np.ascontiguousarray(far * ways / np.linalg.norm(ways, axis=2, keepdims=True))


class Measured(NamedTuple):
    """What a part costs both ways [ns a pursuer], and how far they are apart."""

    single: float
    lanes: float
    off: float


def measured(part: Part, rows: Array) -> Measured:
    """Both ways in turn, the least of all rounds."""
    air = np.zeros((BLOCKS, TEAM, 7, LANES))
    air[:, :, :3] = rows.reshape(BLOCKS, LANES, TEAM, 3).transpose(0, 2, 3, 1)
    blocks = air.reshape(BLOCKS * TEAM, 7 * LANES)
    ways = [kernel(one, error_model="numpy") for one in (part.single, part.lanes)]
    found = np.zeros((*rows.shape[:2], 4))
    best = [np.inf, np.inf]
    for number in range(ROUNDS + 1):
        for k, places in enumerate((rows, blocks)):
            begin = process_time()
            ways[k](places, found, TURNS)
            if number:  # the first compiles
                best[k] = min(best[k], process_time() - begin)
    other = air[:, :, 3:].transpose(0, 3, 1, 2).reshape(found.shape)
    off = float(np.max(np.abs(found - other) / np.maximum(1.0, np.abs(found))))
    if not off < 1e-9:
        raise SystemExit(f"{part.name}: both ways should find the same; they are {off:.1e} apart")
    each = 1e9 / (TURNS * BLOCKS * LANES * TEAM)
    return Measured(best[0] * each, best[1] * each, off)


def whole_games() -> list[str]:
    """The lines of whole games of the paper's strategies, as campaigns play and sixteen beside each other."""
    rng = np.random.default_rng(7)
    ways = rng.standard_normal((GAMES, TEAM, 3))
    ways[:, :, 2] = 0.0
    ways *= rng.uniform(15.0, 120.0, (GAMES, TEAM, 1)) / np.linalg.norm(ways, axis=2, keepdims=True)
    places = np.concatenate([np.zeros((GAMES, 1, 3)), ways], axis=1)
    speeds = np.tile([EVADER] + [PURSUER] * TEAM, (GAMES, 1))
    velocities = np.zeros_like(places)
    velocities[:, :, 0] = speeds
    limits = np.tile(np.array(FREE, dtype=float), (GAMES, TEAM + 1, 1))
    starts = Starts(places, velocities, speeds, limits, np.tile([300.0, 0.0, 0.0], (GAMES, 1)))
    conditions = Conditions(Rules(R=2.0, rho=RHO, horizon=40.0, planar=True), Target(True, ZERO), Control())
    pair = (EVADERS["paper"].decide, PURSUERS["paper"].decide)
    today = campaign(*pair, TEAM)
    trial = lane_player(*pair, tuple(range(1, TEAM + 1)))
    best = [np.inf, np.inf]
    for number in range(ROUNDS + 1):
        begin = process_time()
        ends = today(starts, conditions)
        middle = process_time()
        found = _blank(starts, 0)
        trial(starts, conditions, found, block_of(TEAM + 1))
        if number:
            best = [min(best[0], middle - begin), min(best[1], process_time() - middle)]
    if any(a.tobytes() != b.tobytes() for a, b in zip(ends[:6], found[:6], strict=True)):
        raise SystemExit("whole games: both ways should end the same, to the bit")
    one, other = (ends.steps.sum() / 1e6 / seconds for seconds in best)
    return [
        f"Whole games ({GAMES} in the plane, ends equal to the bit): one after the other {one:.2f} M steps a",
        f"CPU-second; {ACROSS} beside each other, cones and referee in lanes, strategies asked game by game",
        f"(tests/benchmarks/lanes_play.py), {other:.2f} M: {other / one:.2f} times as fast.",
    ]


def main() -> None:
    """Measure and write benchmarks/results/lanes-over-games.md."""
    register()
    register_strategies([one for part in PARTS for one in part[1:]])
    rows = situations()
    lines = [
        f"{BLOCKS * LANES} situations of {TEAM} pursuers, CPU ns a pursuer, the least of {ROUNDS} turns.",
        "Game by game is the core's own code; in lanes it is written out without a branch, many games",
        "beside each other. The last column is the share of a step of five pursuers in the plane (perf).",
        "",
        "| part | game by game | in lanes | times faster | apart by at most | share of a step |",
        "|---|---|---|---|---|---|",
    ]
    left = 1.0
    for part, share in zip(PARTS, SHARES, strict=True):
        m = measured(part, rows)
        left -= share * (1.0 - m.lanes / m.single)
        lines.append(
            f"| {part.name} | {m.single:.1f} | {m.lanes:.1f} | {m.single / m.lanes:.2f} | {m.off:.0e} |"
            f" {100 * share:.0f} % |"
        )
        print(lines[-1], flush=True)
    lines += [
        "",
        f"With these shares a step of all three in lanes costs {left:.2f} of today's: {1 / left:.2f}",
    ]
    lines += ["times faster, if every lane plays to the end and nothing else costs more."]
    lines += ["", *whole_games(), "", *WORDS]
    benchmark_record.write("lanes-over-games.md", "Decisions in lanes over games", COMMAND, lines)


if __name__ == "__main__":
    typer.run(main)
