"""The campaign of the spatial game: many seeds, paired, with the strategy and flying straight at the target.

A seed draws where the pursuers start (about the scenario's places), where the mean wind comes from,
the gusts and the tracks' noise. Both ways of flying meet the same draw.
"""

from __future__ import annotations

from math import degrees, radians
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.game.referee import GameResult
from onboard.core.math.angles import wrap
from onboard.game.scenario import Scenario
from onboard.runtime.progress import Tell, over, part, silent
from onboard.runtime.run_folder import made
from onboard.runtime.whole_files import write_whole
from sim_bridge.campaign.spatial_draw import T0, Draw, compiled_kernel, draw, kernel_of, log_of, sky_of
from sim_bridge.campaign.spatial_game import Evasion, SpatialPlay

REVERSAL = radians(10.0)  # a turn one way, then the other
WITHIN = 2.0  # [s]

Array = NDArray[np.float64]


class Played(NamedTuple):
    """One game of the campaign."""

    verdict: GameResult
    time: float  # [s]
    smallest: float  # distance of any pursuer [m]
    reversals: int  # of the evader's flown course
    decided_reversals: int  # of the course it decided on
    play: SpatialPlay
    log: Array  # (steps, players, 6): position [m; NED], flown and decided course [rad], rule


def play_seed(
    scenario: Scenario, seed: int, evasion: Evasion, compiled: bool = True, t0: float = T0
) -> Played:
    """One game of a scenario, compiled or by the same kernels interpreted; see `draw`."""
    return play_drawn(draw(scenario, seed, t0, compiled), evasion, compiled)


def play_drawn(d: Draw, evasion: int, compiled: bool = True) -> Played:
    """Play a drawn game out. It uses up the draw's tracks; `evasion`: the evader's way among its sides."""
    log = log_of(d)
    sides = d.sides
    chosen = sides.chosen._replace(evader=int(evasion))
    found = kernel_of(sides.evaders, sides.pursuers, compiled)(d.start, chosen, sky_of(d, compiled), log)
    log = log[: found.steps]
    count = compiled_kernel(reversals) if compiled else reversals
    span = round(WITHIN / d.start.conditions.control.dt)
    return Played(
        GameResult(found.game.score.verdict),
        found.game.score.time,
        found.game.score.smallest,
        count(log[:, 0, 3], span),
        count(log[:, 0, 4], span),
        found,
        log,
    )


def reversals(course: Array, span: int) -> int:
    """How often a course [rad] turned by more than 10° and back by more than 10° within `span` samples.

    Counted once each: a window that holds one is left behind. Kernel style.
    """
    angle = np.zeros(course.shape[0])
    way = np.zeros(course.shape[0])  # the turns so far, either way
    for k in range(1, course.shape[0]):
        turn = wrap(course[k] - course[k - 1])
        angle[k] = angle[k - 1] + turn
        way[k] = way[k - 1] + abs(turn)
    count = 0
    k = 0
    while k < angle.shape[0] - span:
        if way[k + span] - way[k] <= 2.0 * REVERSAL:
            k += 1
            continue
        high = low = angle[k]
        for j in range(k + 1, k + span + 1):
            high = max(high, angle[j])
            low = min(low, angle[j])
        up_down = high - max(angle[k], angle[k + span])
        down_up = min(angle[k], angle[k + span]) - low
        if max(up_down, down_up) > REVERSAL:
            count += 1
            k += span
        else:
            k += 1
    return count


class Tally(NamedTuple):
    """One way of flying over all seeds."""

    way: str
    games: int
    captured: int
    arrived: int
    neither: int
    arrival_time: float  # mean of those that arrived [s]; nan where none did
    smallest: float  # median smallest distance [m]
    reversals: int
    decided_reversals: int
    flown_s: float
    pitch_deg: tuple[float, float]
    speed: tuple[float, float]  # share of the declared airspeed
    lowest: float  # [m]


def tally(way: str, games: list[Played]) -> Tally:
    """Counts of one way of flying."""
    verdicts = [g.verdict for g in games]
    arrivals = [g.time for g in games if g.verdict == GameResult.ARRIVED]
    reach = [g.play.envelope for g in games]
    return Tally(
        way,
        len(games),
        verdicts.count(GameResult.CAPTURED),
        verdicts.count(GameResult.ARRIVED),
        verdicts.count(GameResult.ESCAPED) + verdicts.count(GameResult.DENIED),
        float(np.mean(arrivals)) if arrivals else float("nan"),
        float(np.median([g.smallest for g in games])),
        sum(g.reversals for g in games),
        sum(g.decided_reversals for g in games),
        sum(g.time for g in games),
        (degrees(min(e.pitch_low for e in reach)), degrees(max(e.pitch_high for e in reach))),
        (min(e.speed_low for e in reach), max(e.speed_high for e in reach)),
        min(e.lowest for e in reach),
    )


class Contest(NamedTuple):
    """Both ways over the same seeds."""

    scenario: str
    strategy: Tally
    straight: Tally
    saved: int  # captured straight, not with the strategy
    lost: int  # captured with the strategy, not straight
    p_value: float  # exact McNemar test on those pairs, two-sided


def contest(scenario: Scenario, seeds: range, compiled: bool = True, tell: Tell = silent) -> Contest:
    """Play all seeds both ways."""
    first, second = over(seeds, part(tell, 0, 2), scenario.name), over(seeds, part(tell, 1, 2), scenario.name)
    with_it = [play_seed(scenario, seed, Evasion.STRATEGY, compiled) for seed in first]
    straight = [play_seed(scenario, seed, Evasion.STRAIGHT, compiled) for seed in second]
    pairs = [
        (a.verdict == GameResult.CAPTURED, b.verdict == GameResult.CAPTURED)
        for a, b in zip(with_it, straight, strict=True)
    ]
    saved = sum(b and not a for a, b in pairs)
    lost = sum(a and not b for a, b in pairs)
    return Contest(
        scenario.name,
        tally("strategy of 3.4.1", with_it),
        tally("straight at the target", straight),
        saved,
        lost,
        mcnemar(saved, lost),
    )


def mcnemar(saved: int, lost: int) -> float:
    """Exact two-sided test that both discordant outcomes are as likely."""
    from scipy.stats import binomtest

    return float(binomtest(saved, saved + lost, 0.5).pvalue) if saved + lost else 1.0


def table(contests: list[Contest]) -> str:
    """Contests as a Markdown table."""
    lines = [
        "| scenario | evader | captured (95 %) | arrived (95 %) | neither | arrival time [s] |"
        " median smallest distance [m] | reversals flown (decided) per minute |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for c in contests:
        for t in (c.strategy, c.straight):
            minutes = t.flown_s / 60.0
            lines.append(
                f"| {c.scenario} | {t.way} | {share(t.captured, t.games)} | {share(t.arrived, t.games)} |"
                f" {t.neither} | {t.arrival_time:.0f} | {t.smallest:.0f} |"
                f" {t.reversals / minutes:.3f} ({t.decided_reversals / minutes:.3f}) |"
            )
    lines.append("")
    for c in contests:
        lines.append(
            f"{c.scenario}: of the same {c.strategy.games} games, {c.saved} were captured only straight and"
            f" {c.lost} only with the strategy (McNemar, exact: p = {c.p_value:.1e}). Pitch"
            f" {c.strategy.pitch_deg[0]:.1f} to {c.strategy.pitch_deg[1]:.1f} deg, airspeed"
            f" {100 * c.strategy.speed[0]:.1f} to {100 * c.strategy.speed[1]:.1f} % of the declared, lowest"
            f" height {c.strategy.lowest:.0f} m."
        )
    return "\n".join(lines)


def share(count: int, games: int) -> str:
    """A count with its share and Wilson's 95 % confidence interval."""
    from scipy.stats import binomtest

    low, high = binomtest(count, games).proportion_ci(method="wilson")
    return f"{count} = {100 * count / games:.0f} % ({100 * low:.0f}–{100 * high:.0f})"


def output(folder: Path, name: str, text: str) -> Path:
    """Write a result. Raises ConfigError where that cannot be."""
    path = made(folder) / name
    write_whole(path, f"{text}\n".encode())
    return path
