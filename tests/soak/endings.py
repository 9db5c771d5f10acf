"""Games that end in every way a flight can: seeded, on virtual time, with every kind of autopilot in turn.

    python -m tests.soak.endings --games 200 --seed 1

In each game one thing ends the pursuer's flight at a random instant: an order, SIGTERM, `kill -9`, a restart,
the pilot, a failsafe of the autopilot, a dead bus; with and without a transmitter, with answers in time or up
to 3 s late. Whatever it was: nobody sinks but in a mode in which the autopilot itself comes down, nobody is
taken out of a pilot's hands, every vehicle ends held, coming home or landed, and each end has its words.
Game k of seed S is the same on any day: `--game K` plays it again.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections import Counter
from collections.abc import Callable
from time import perf_counter
from typing import NamedTuple

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import numpy as np  # noqa: E402  (threads are set before NumPy is imported)

from onboard.game.scenario import (  # noqa: E402
    WINGED,
    Flight,
    Kind,
    Parameters,
    Scenario,
    SimulatedSpec,
    Transmitter,
    VehicleSpec,
)
from onboard.pilot.predictor_choice import Predicting  # noqa: E402
from onboard.runtime.loop import run_virtual  # noqa: E402
from onboard.wire.bus.messages import CommandKind, Phase  # noqa: E402
from tests.soak.faults import PILOTS, Rng, battery, ekf, gps  # noqa: E402
from tests.support import benchmark_record  # noqa: E402
from tests.support.flown_autopilot import ENDED  # noqa: E402
from tests.support.small_scenarios import PURSUER  # noqa: E402
from tests.support.whole_games import (  # noqa: E402
    WholeGame,
    autopilot,
    choose_mode,
    command,
    flies,
    game_of,
    mode,
    order,
    place,
)

WATCH_S = 25.0  # after the end
LOOK_S = 0.1
GUIDED = frozenset({"GUIDED", "OFFBOARD"})
COMES_DOWN = frozenset({"LAND", "RTL", "SMART_RTL", "QLAND", "DESCEND", "AUTO_LAND", "TERMINATE"})
SINKS_M = {True: 25.0, False: 6.0}  # a plane turns, a multicopter brakes; more than that is sinking
LATEST_S = 15.0  # by then whoever was left is held, coming home or landed


class Ended(NamedTuple):
    """How one game went."""

    number: int
    kind: Kind
    how: str
    words: str  # that explain the end
    mode: str  # of the vehicle at the end
    problem: str  # "" = none


class Ending:
    """One thing that ends a flight, and what is demanded of the vehicle then."""

    def __init__(self, game: WholeGame, rng: Rng) -> None:
        self.game, self.rng = game, rng
        self.taken = ""  # the mode in which a pilot has the vehicle

    async def ordered(self, kind: CommandKind) -> None:
        await order(self.game, PURSUER, command(kind), 1.0)

    async def terminated(self) -> None:
        self.game.agents[PURSUER].stop()

    async def killed(self) -> None:
        self.game.kill_agent(PURSUER)

    async def restarted(self) -> None:
        self.game.kill_agent(PURSUER)
        await self.game.forward(float(self.rng.uniform(0.5, 9.0)))
        self.game.start_agent(PURSUER)

    async def piloted(self) -> None:
        self.taken = PILOTS[self.game.scenario.flight.autopilot]
        autopilot(self.game, PURSUER).set_throttle(self.game.bridge.world.elapsed_ns, 0.5)
        choose_mode(self.game, PURSUER, self.taken)

    async def pilot_and_restart(self) -> None:
        await self.piloted()
        await self.restarted()

    async def blinded(self) -> None:
        gps(self.game, PURSUER, self.rng)

    async def lost(self) -> None:
        ekf(self.game, PURSUER, self.rng)

    async def emptied(self) -> None:
        battery(self.game, PURSUER, self.rng)

    async def cut_off(self) -> None:
        self.game.broker.kill()

    async def game_over(self) -> None:
        self.game.master.abort(self.game.clock.wall_ns(), self.game.clock.monotonic_ns(), "the soak's end")


WAYS: dict[str, Callable[[Ending], object]] = {
    "abort": lambda e: e.ordered(CommandKind.ABORT),
    "hold": lambda e: e.ordered(CommandKind.HOLD),
    "return": lambda e: e.ordered(CommandKind.RETURN),
    "land": lambda e: e.ordered(CommandKind.LAND),
    "SIGTERM": Ending.terminated,
    "kill": Ending.killed,
    "restart": Ending.restarted,
    "pilot": Ending.piloted,
    "pilot, restart": Ending.pilot_and_restart,
    "no GPS": Ending.blinded,
    "no EKF": Ending.lost,
    "battery": Ending.emptied,
    "no bus": Ending.cut_off,
    "game over": Ending.game_over,
}
EXPLAINS = frozenset({
    "supervisor_hold", "supervisor_return", "supervisor_end", "take_over", "released", "command", "phase",
    "started", "held", "status",
})  # fmt: skip
SAFE = {
    Kind.ARDUCOPTER: {"FS_GCS_ENABLE": 1.0, "SYSID_MYGCS": 2.0},
    Kind.ARDUPLANE: {"FS_GCS_ENABL": 1.0, "FS_LONG_ACTN": 1.0, "SYSID_MYGCS": 2.0},
}
"""The parameters that docs/first-flight.md asks for: the pursuer's own agent is watched."""
NO_POSITION = frozenset({"no GPS", "no EKF"})  # there a multicopter may drift down while its failsafe begins


def scenario(kind: Kind, rng: Rng) -> Scenario:
    """A pursuer on its way to an evader that is far off, and known by its track alone."""
    sticks = list(Transmitter)[int(rng.integers(len(Transmitter)))]
    late = (0.0, 0.0) if rng.random() < 0.7 else (0.1, float(rng.uniform(0.2, 3.0)))
    spec = SimulatedSpec(
        transmitter=sticks, answer_delay_s=late[0], answer_delay_max_s=late[1], parameters=SAFE.get(kind, {})
    )
    scale = 10.0 if kind in WINGED else 1.0
    return Scenario(
        name="endings",
        evader=VehicleSpec(position=(600.0 * scale, 0.0), speed=5.0 * scale, tracked=True),
        pursuers=(VehicleSpec(position=(0.0, 0.0), speed=4.0 * scale),),
        parameters=Parameters(horizon=300.0),
        flight=Flight(autopilot=kind, height=120.0, ready_s=1.0, prediction=Predicting.CONSTANT_VELOCITY,
                      simulated=spec),
    )  # fmt: skip


async def end_one(number: int, seed: int, how: str, kind: Kind, watch_s: float) -> Ended:
    """Play one game to its end, and watch what becomes of the pursuer."""
    rng = np.random.default_rng((seed, number))
    async with game_of(scenario(kind, rng), seed=seed + number, any_error=True) as game:
        game.expects_abort()
        after = float(rng.uniform(1.0, 8.0))
        await game.forward(240.0, until=lambda: game.phase is Phase.RUNNING and game.now >= after)
        await game.forward(30.0, until=lambda: flies(game.agents[PURSUER]))
        ending, struck_ns = Ending(game, rng), game.clock.wall_ns()
        said, logged = len(game.events), len(game.told)
        await WAYS[how](ending)  # type: ignore[misc]
        problem = await watch(game, ending, how, watch_s)
        words = explanation(game, (said, logged), struck_ns, how)
        if not problem and not words:
            problem = "ended without a word"
        if problem:
            problem = f"game {number}, {kind.value}, {how}: {problem}\n{game.story(8)}"
        return Ended(number, kind, how, words, mode(game, PURSUER), problem)


def at_work(game: WholeGame, how: str) -> bool:
    """Whether an agent that is alive flies the pursuer."""
    return how != "kill" and flies(game.agents[PURSUER])


async def watch(game: WholeGame, ending: Ending, how: str, watch_s: float) -> str:
    """What is wrong with the pursuer's end; "" = nothing."""
    highest = -place(game, PURSUER).z
    winged = game.scenario.flight.autopilot in WINGED
    left_s = 0.0  # how long it has been in guided mode with nobody flying it
    for _ in range(round(watch_s / LOOK_S)):
        await game.forward(LOOK_S)
        now, height = mode(game, PURSUER), -place(game, PURSUER).z
        if ending.taken and now in GUIDED:
            return f"taken out of the pilot's {ending.taken} into {now}"
        if now in COMES_DOWN or at_work(game, how) or how in NO_POSITION:
            highest = height
        elif height < highest - SINKS_M[winged]:
            return f"sinks in {now}: {highest:.1f} → {height:.1f} m"
        elif height < 1.0 and how not in NO_POSITION:
            return f"on the ground in {now}"
        nobody = now in GUIDED and not at_work(game, how)
        left_s = left_s + LOOK_S if nobody else 0.0
        if left_s > LATEST_S:
            return f"left in {now}, and nobody flies it"
    return ""


def explanation(game: WholeGame, before: tuple[int, int], struck_ns: int, how: str) -> str:
    """The words of the agent that say why the flight ended, or what the autopilot did by itself.

    `before`: how many events, and lines of the log, there were up to the end. Where the bus is dead nobody
    hears the agent: what it wrote into its own log counts.
    """
    told = [
        event for event in game.events[before[0] :] if event.id == PURSUER and event.stamp_ns >= struck_ns
    ]
    words = [f"{event.kind}: {event.text}" for event in told if event.kind in EXPLAINS]
    if how == "no bus":
        words = [line for line in game.told[before[1] :] if f"vehicle {PURSUER} " in line]
    now = mode(game, PURSUER)
    if at_work(game, how):
        words.append("flies on: what it knows suffices")
    elif now not in GUIDED:
        words.append(f"the autopilot's own failsafe: {now}")
    return words[0] if words else ""


def play(number: int, seed: int, how: str = "", watch_s: float = WATCH_S) -> Ended:
    """Game `number` of a seed; `how` in place of the way that is drawn."""
    kind = ENDED[number % len(ENDED)]
    names = list(WAYS)
    drawn = names[int(np.random.default_rng((seed, number, 7)).integers(len(names)))]
    return run_virtual(end_one(number, seed, how or drawn, kind, watch_s))


def run(
    count: int, seed: int, first: int, say: Callable[[str], None], only: Kind | None = None
) -> list[Ended]:
    """`count` games from number `first` on; of these those of one kind alone, where one is given."""
    found = []
    for number in range(first, first + count):
        if only not in (None, ENDED[number % len(ENDED)]):
            continue
        began = perf_counter()
        ended = play(number, seed)
        found.append(ended)
        took = f"({perf_counter() - began:.1f} s)"
        say(f"{number}: {ended.kind.value}, {ended.how}: {ended.mode}; {ended.words[:80]} {took}")
        if ended.problem:
            say(f"PROBLEM {ended.problem}")
    return found


def table(found: list[Ended]) -> list[str]:
    """The result as a page."""
    kinds = sorted({ended.kind.value for ended in found})
    lines = [
        f"| end | {' | '.join(kinds)} | modes in which they ended | problems |",
        "|" + "---|" * (len(kinds) + 3),
    ]
    for how in WAYS:
        of = [ended for ended in found if ended.how == how]
        counts = Counter(ended.kind.value for ended in of)
        modes = Counter(ended.mode for ended in of)
        cells = [str(counts[kind]) for kind in kinds]
        told = ", ".join(f"{name} {n}" for name, n in modes.most_common())
        lines.append(f"| {how} | {' | '.join(cells)} | {told} | {sum(bool(e.problem) for e in of)} |")
    return lines


def main() -> int:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--games", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first game")
    parser.add_argument("--game", type=int, default=None, help="play this one game again, and no other")
    parser.add_argument("--kind", type=Kind, default=None, help="of the games those of one kind: px4-plane")
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/endings.md")
    options = parser.parse_args()

    def say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)

    count, first = (options.games, options.first) if options.game is None else (1, options.game)
    found = run(count, options.seed, first, say, options.kind)
    lines = table(found)
    say("\n".join(lines))
    if options.write:
        only = "" if options.kind is None else f" --kind {options.kind.value}"
        argv = f"python -m tests.soak.endings --games {count} --seed {options.seed}{only} --write"
        benchmark_record.write("endings.md", "Games that end in every way", argv, lines)
    return 1 if any(ended.problem for ended in found) else 0


if __name__ == "__main__":
    sys.exit(main())
