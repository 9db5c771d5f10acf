"""Hours of flight with random faults: six vehicles on virtual time, seeded, in games of ten minutes.

    python -m tests.soak.run --hours 4 --seed 1 --resume .soak.json

Nothing may be stuck: once a fault has passed, a vehicle flies again by itself, or as soon as somebody on
the ground says resume. Every stop has an event that explains it. Memory stays flat. Game k of seed S is
the same on any day, so what fails can be played again: `--hours` and `--resume` aside, `--game K` plays it.
"""

from __future__ import annotations

import argparse
import gc
import json
import os
import sys
from collections import Counter
from collections.abc import Callable, Collection
from pathlib import Path

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import numpy as np  # noqa: E402  (threads are set before NumPy is imported)
import psutil  # noqa: E402

from onboard.game.scenario import Flight, ImpairmentSpec, Kind, Parameters, Scenario, VehicleSpec  # noqa: E402
from onboard.pilot.predictor_choice import Predicting  # noqa: E402
from onboard.runtime.loop import run_virtual  # noqa: E402
from onboard.wire.bus.messages import Command, CommandKind, Phase  # noqa: E402
from onboard.wire.bus.topics import COMMAND  # noqa: E402
from tests.soak.faults import NAMES, OF_ALL, OF_ONE, Rng, Undo  # noqa: E402
from tests.support.flown_autopilot import FLOWN  # noqa: E402
from tests.support.whole_games import TO_START_S, WholeGame, flies, game_of, quoting  # noqa: E402

GAME_S = 600.0
LOOK_S = 0.1
CALM_S = (1.0, 6.0)  # between two faults
LASTS_S = (0.5, 8.0)
EXPLAINED_S = 3.5  # after a stop: the autopilot's heartbeat counts as missing after 2 s
PATIENCE_S = 6.0  # of the operator, before he says resume
STUCK_S = 45.0  # after all that was wrong with a vehicle has passed
WARM = 3  # games after which memory must be flat
GROWTH_MB = 12.0
EXPLAINS = (
    "supervisor_hold", "supervisor_return", "supervisor_end", "take_over", "reboot", "released", "regain",
    "failsafe", "command", "started", "clock_jump", "phase", "late", "strategy", "control",
)  # fmt: skip


def scenario(kind: Kind, seed: int) -> Scenario:
    """A chase that has no end: the pursuers are slow, and far behind."""
    fast, slow, far = (45.0, 30.0, 9000.0) if kind is Kind.ARDUPLANE else (5.0, 2.0, 1500.0)
    return Scenario(
        name=f"soak with {kind.value}",
        evader=VehicleSpec(position=(0.0, 0.0), speed=fast),
        pursuers=tuple(VehicleSpec(position=(-far, 60.0 * (n - 2)), speed=slow) for n in range(5)),
        parameters=Parameters(R=1.0, horizon=86400.0),
        seed=seed,
        flight=Flight(
            autopilot=kind,
            height=300.0,
            ready_s=2.0,
            impairment=ImpairmentSpec(bus=True),
            prediction=Predicting.CONSTANT_VELOCITY,
        ),
    )


class Vehicle:
    """What is watched of one vehicle."""

    def __init__(self) -> None:
        self.active = 0  # faults in force
        self.calm_at = 0.0  # when the last of them passed
        self.flew = False
        self.stopped_at = -1.0  # of a stop that is not explained yet
        self.explained = 0  # explaining events up to when it last flew
        self.resumes = 0


class Soak:
    """One game and its faults."""

    def __init__(
        self, game: WholeGame, rng: Rng, totals: Counter[str], explains: Collection[str] = EXPLAINS
    ) -> None:
        self.game = game
        self.rng = rng
        self.totals = totals
        self.explains = explains
        self.vehicles = {id: Vehicle() for id in game.scenario.ids}
        self._due: list[tuple[float, int, Undo, tuple[int, ...]]] = []
        self._in_force: set[str] = set()
        self._orders = 0

    @property
    def now(self) -> float:
        return self.game.clock.monotonic_ns() / 1e9

    async def play(self, seconds: float) -> None:
        """Strike and watch for so long, then let all faults pass and demand that everybody flies."""
        game = self.game
        await game.forward(TO_START_S, until=self.all_fly)
        end, next_at = self.now + seconds, self.now + 2.0
        while self.now < end or any(v.active for v in self.vehicles.values()) or not self.all_fly():
            if game.phase is not Phase.RUNNING:
                self.totals["games_ended"] += 1
                return
            if next_at <= self.now < end:
                self.strike()
                next_at = self.now + float(self.rng.uniform(*CALM_S))
            self.heal()
            await game.forward(LOOK_S)
            self.watch()
            await self.operate()

    def all_fly(self) -> bool:
        return all(flies(self.game.agents[id]) for id in self.vehicles)

    def strike(self) -> None:
        """One fault, of one vehicle or all."""
        name = NAMES[int(self.rng.integers(len(NAMES)))]
        id = int(self.rng.choice(list(self.vehicles)))
        lasts = float(self.rng.uniform(*LASTS_S))
        token = name if name in OF_ALL else f"{name} {id}"
        gone = f"killed {id}" in self._in_force
        if token in self._in_force or (gone and name in OF_ONE):
            return
        strike = OF_ALL[name] if name in OF_ALL else OF_ONE[name]
        struck = tuple(self.vehicles) if name in OF_ALL else (id,)
        undo = strike(self.game, id, self.rng)
        self.totals[name] += 1
        self._in_force.add(token)
        for one in struck:
            self.vehicles[one].active += 1

        def pass_by() -> None:
            undo()
            self._in_force.discard(token)

        self._due.append((self.now + lasts, len(self._due), pass_by, struck))

    def heal(self) -> None:
        """End the faults whose time is over."""
        for entry in [entry for entry in self._due if entry[0] <= self.now]:
            self._due.remove(entry)
            entry[2]()
            for id in entry[3]:
                self.vehicles[id].active -= 1
                self.vehicles[id].calm_at = self.now

    def watch(self) -> None:
        """Every stop is explained, and nobody is stuck."""
        for id, vehicle in self.vehicles.items():
            agent = self.game.agents[id]
            alive = f"killed {id}" not in self._in_force
            flying = alive and flies(agent)
            kinds = agent.core.journal.kinds
            explained = sum(kinds.get(kind, 0) for kind in self.explains) + agent.core.journal.suppressed
            if flying or not alive:
                vehicle.stopped_at, vehicle.explained = -1.0, explained
            elif vehicle.flew:
                vehicle.stopped_at = self.now
                self.totals["stops"] += 1
            if vehicle.stopped_at >= 0.0:
                if explained > vehicle.explained:
                    vehicle.stopped_at = -1.0
                else:
                    silent = self.now - vehicle.stopped_at
                    assert silent < EXPLAINED_S, self.story(id, "stopped without a word")
            vehicle.flew = flying
            if flying or vehicle.active:
                vehicle.resumes = 0
                vehicle.calm_at = self.now
            assert self.now - vehicle.calm_at < STUCK_S, self.story(id, "stuck")

    async def operate(self) -> None:
        """Who on the ground sees a vehicle that does not come back by itself says resume."""
        for id, vehicle in self.vehicles.items():
            waited = self.now - vehicle.calm_at
            if waited > PATIENCE_S * (1 + vehicle.resumes):
                vehicle.resumes += 1
                self._orders += 1
                self.totals["resumes"] += 1
                shown = self.game.bridge.world.vehicles[id].autopilot.mode_name
                order = Command(f"soak-{self._orders}", CommandKind.RESUME, "operator", 0, shown)
                order = quoting(self.game, id, order)
                where = COMMAND.key(self.game.game, id)
                await self.game.bus.request(where, COMMAND.encode(order), 0.5)

    def story(self, id: int, what: str) -> str:
        """What a person needs to know of a failure."""
        agent, autopilot = self.game.agents[id], self.game.bridge.world.vehicles[id].autopilot
        verdict = agent.core.flight.output
        last = [line for line in self.game.told if f"vehicle {id} " in line][-12:]
        return (
            f"vehicle {id} {what} at {self.now:.1f} s: mode {autopilot.mode_name}, "
            f"{'armed' if autopilot.armed else 'disarmed'}, "
            f"agent {agent.core.stage}, lacks {agent.core.lacks}, "
            f"{agent.core.vehicle.stage}, {verdict and verdict.cause!r}, in force {sorted(self._in_force)}\n"
            + "\n".join(last)
        )


def play(
    number: int,
    seed: int,
    totals: Counter[str],
    seconds: float = GAME_S,
    explains: Collection[str] = EXPLAINS,
) -> None:
    """Game `number` of a seed. Raises AssertionError with the story of what went wrong.

    `explains`: the kinds of events that explain why a vehicle has stopped.
    """

    async def game_on() -> None:
        rng = np.random.default_rng((seed, number))
        kind = FLOWN[number % len(FLOWN)]
        chase = scenario(kind, seed)
        async with game_of(chase, seed=seed + number, battery_s=1e9, any_error=True) as game:
            soak = Soak(game, rng, totals, explains)
            await soak.play(seconds)
            totals["simulated_s"] += round(soak.now)

    run_virtual(game_on())


def resident_mb() -> float:
    """Resident memory of this process now."""
    gc.collect()
    return float(psutil.Process().memory_info().rss) / 2**20


def run(
    hours: float,
    seed: int,
    resume: Path | None,
    say: Callable[[str], None],
    seconds: float = GAME_S,
) -> Counter[str]:
    """So many hours of simulated flight, continued where the file `resume` says; totals by fault."""
    done, totals = 0, Counter[str]()
    if resume is not None and resume.exists():
        state = json.loads(resume.read_text())
        if state["seed"] == seed:
            done, totals = state["done"], Counter(state["totals"])
    settled, played = 0.0, 0
    while totals["simulated_s"] < hours * 3600.0:
        play(done, seed, totals, seconds)
        done, played = done + 1, played + 1
        now_mb = resident_mb()
        if played == WARM:
            settled = now_mb
        if settled:
            assert now_mb - settled < GROWTH_MB, f"memory grows: {settled:.0f} → {now_mb:.0f} MB"
        if resume is not None:
            resume.write_text(json.dumps({"seed": seed, "done": done, "totals": totals}))
        flown = totals["simulated_s"] / 3600.0
        say(f"{flown:.2f} h of {hours:g} h, {now_mb:.0f} MB {dict(sorted(totals.items()))}")
    return totals


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--hours", type=float, default=4.0, help="of simulated flight")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--resume", type=Path, default=None, help="file that remembers how far it came")
    parser.add_argument("--game", type=int, default=None, help="play this one game again, and no other")
    options = parser.parse_args()

    def say(line: str) -> None:
        print(line, file=sys.stderr, flush=True)

    if options.game is not None:
        totals = Counter[str]()
        play(options.game, options.seed, totals)
        say(str(dict(totals)))
    else:
        run(options.hours, options.seed, options.resume, say)


if __name__ == "__main__":
    main()
