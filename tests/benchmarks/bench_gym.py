"""Steps of learning environments a CPU-second, beside VMAS and PettingZoo's simple_tag: `make bench-gym`.

Not run by pytest: it needs the environment of locks/bench-gym.in. The same work everywhere: one flees, five
pursue, actions of those who learn come from outside, observations and rewards go out, all in one thread.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from time import process_time
from typing import Any, NamedTuple

import numba
import numpy as np
from msgspec.structs import replace

from sim_bridge.gym.games import games_of
from sim_bridge.gym.task import Wish, make_task
from tests.support.benchmark_record import write

GAMES = 1024
TRACKED = 256  # known by tracks: as many as stay in the processor's cache
FLOWN = 128  # with the aircraft as flown
THEIRS = 8192  # environments of VMAS, where it is fastest
PURSUERS = 5


class Contender(NamedTuple):
    """One way to step environments."""

    name: str
    step: Callable[[], object]
    environments: int  # stepped by a call
    calls: int  # in a round


def ours(name: str, calls: int = 60, clear: bool = False, many: int = GAMES, **words: Any) -> Contender:
    """Games of this project, under actions drawn once: what they cost does not depend on them."""
    scenario = make_task(Wish(**words)).scenario
    if clear:
        sensor = replace(scenario.flight.sensor, sigma=0.0, sigma_velocity=0.0, delay_s=0.0)
        scenario = replace(scenario, flight=replace(scenario.flight, sensor=sensor))
    games = games_of(make_task(Wish(**{**words, "scenario": scenario})), many)
    games.reset(1)
    rng = np.random.default_rng(1)
    for array in (games.arrays.evader_acts, games.arrays.pursuers_act):
        array[:] = rng.uniform(-1.0, 1.0, array.shape)
    return Contender(name, games.step, many, calls)


def vmas() -> Contender:
    """VMAS's simple_tag."""
    import torch
    from vmas import make_env

    torch.set_num_threads(1)
    env = make_env("simple_tag", num_envs=THEIRS, device="cpu", continuous_actions=True, seed=1,
                   num_good_agents=1, num_adversaries=PURSUERS, num_landmarks=0)  # fmt: skip
    env.reset()
    actions = [env.get_random_action(agent) for agent in env.agents]
    return Contender("VMAS simple_tag, 8192 environments", lambda: env.step(actions), THEIRS, 2)


def simple_tag() -> Contender:
    """PettingZoo's simple_tag (mpe2)."""
    from mpe2 import simple_tag_v3

    env = simple_tag_v3.parallel_env(num_good=1, num_adversaries=PURSUERS, num_obstacles=0, max_cycles=10**9,
                                     continuous_actions=True)  # fmt: skip
    env.reset(seed=1)
    actions = {name: env.action_space(name).sample() for name in env.agents}
    return Contender("PettingZoo simple_tag (mpe2)", lambda: env.step(actions), 1, 200)


def pettingzoo() -> Contender:
    """The project's own parallel environment, a game at a time."""
    from sim_bridge.gym.parallel import parallel_env

    env = parallel_env(scenario="plane", compiled=True)
    env.reset(seed=1)
    actions = {name: env.action_space(name).sample() for name in env.possible_agents}

    def step() -> None:
        if not env.agents:
            env.reset()
        env.step(actions)

    return Contender("apollonius, PettingZoo's interface, plane", step, 1, 1000)


def yardsticks() -> list[Contender]:
    """Loops of a fixed length, by which another day's figures compare: a million turns each."""

    @numba.njit
    def compiled(n: int) -> float:
        x = 0.0
        for k in range(n):
            x = x * 0.999 + k % 7
        return x

    def plain() -> float:
        x = 0.0
        for k in range(100_000):
            x = x * 0.999 + k % 7
        return x

    compiled(1)
    return [Contender("yardstick: a loop in numba, turns", lambda: compiled(1_000_000), 1_000_000, 3),
            Contender("yardstick: the same in Python, turns", plain, 100_000, 1)]  # fmt: skip


Maker = Callable[[], Contender]


def own() -> dict[str, Maker]:
    """This project's, by name."""

    def games(name: str, calls: int = 60, **words: Any) -> tuple[str, Maker]:
        return name, lambda: ours(name, calls, **words)

    plane: Any = {"scenario": "plane", "actions": "velocity"}
    space: Any = {"scenario": "space", "actions": "velocity"}
    tracked: Any = {**space, "many": TRACKED}
    flown: Any = {"scenario": "spatial/five", "motion": "aircraft", "actions": "velocity", "many": FLOWN}
    return dict((
        games("plane, all six act by velocity", **plane, learn="all"),
        games("plane, all six act by heading", scenario="plane", actions="heading", learn="all"),
        games("plane, five act against the paper's evader", **plane),
        games("plane, the evader acts against five in parallel pursuit", scenario="plane", learn="evader"),
        games("space in wind, all six act by velocity", 30, clear=True, **space, learn="all"),
        games("space in wind, known by tracks, all six act by velocity", 80, **tracked, learn="all"),
        games("space, known by tracks, five act against the paper's evader", 80, **tracked),
        games("aircraft as flown, gusts, known by tracks, all six act by velocity", 10, **flown, learn="all"),
    ))  # fmt: skip


def contenders(only: str, without: str = "") -> list[Contender]:
    """Everybody who is measured; `only`: of this project's those whose name has the word, and no others;
    `without`: none whose name has this one."""
    chosen = [make() for name, make in own().items() if only in name and not (without and without in name)]
    return chosen if only else [*chosen, pettingzoo(), vmas(), simple_tag(), *yardsticks()]


def measured(everybody: list[Contender], rounds: int) -> dict[str, float]:
    """Environment steps a CPU-second, the best of interleaved rounds."""
    best = dict.fromkeys((one.name for one in everybody), 0.0)
    for _ in range(rounds):
        for one in everybody:
            start = process_time()
            for _ in range(one.calls):
                one.step()
            took = process_time() - start
            best[one.name] = max(best[one.name], one.environments * one.calls / took)
    return best


def page(found: dict[str, float], rounds: int) -> list[str]:
    """The table."""
    theirs = [name for name in found if "simple_tag" in name]
    lines = [
        "One that flees, five that pursue. A step is one control step of a whole game: the actions of those"
        " who learn in, all decisions, motion, referee, observations and rewards out, ended games begun anew."
        f" CPU time of one thread, the best of {rounds} interleaved rounds; "
        f"batches of {GAMES} games ({TRACKED} known by tracks, {FLOWN} as flown), VMAS"
        f" {THEIRS}. simple_tag of VMAS and of PettingZoo moves points under forces and collisions and has"
        " neither a referee that judges between steps, nor strategies, wind or tracks.",
        "",
        "| environment | steps a CPU-second | × VMAS | × PettingZoo |",
        "|---|---|---|---|",
    ]
    for name, rate in found.items():
        if "yardstick" in name:
            lines.append(f"| {name} | {rate:,.0f} | | |")
        else:
            ratios = " | ".join(f"{rate / found[other]:,.2f}" for other in theirs)
            lines.append(f"| {name} | {rate:,.0f} | {ratios} |")
    return lines


def main() -> None:
    """Measure, print, and write benchmarks/results/gym.md."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=15)
    parser.add_argument("--only", default="", help="print this project's whose name has the word; write none")
    parser.add_argument("--without", default="", help="leave those out whose name has the word")
    told = parser.parse_args()
    found = measured(contenders(told.only, told.without), told.rounds)
    if told.only:
        print("\n".join(f"{name}: {rate:,.0f} steps a CPU-second" for name, rate in found.items()))
        return
    lines = page(found, told.rounds)
    print("\n".join(lines))
    without = f"python -m tests.benchmarks.bench_gym --without {told.without}"
    write("gym.md", "Steps of learning environments", without if told.without else "make bench-gym", lines)


if __name__ == "__main__":
    main()
