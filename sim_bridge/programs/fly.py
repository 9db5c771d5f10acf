"""`sim-bridge fly`: the whole game, agents included, and the run folder that it leaves.

`--fast` plays it in this process on virtual time; otherwise agents are processes of their own,
over UDP and Zenoh on loopback, in real time.
"""

from __future__ import annotations

import asyncio
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import Scenario, load
from onboard.runtime.clock import RealClock
from onboard.runtime.loop import run_virtual, virtual_clock
from onboard.runtime.progress import Progress, silent
from onboard.runtime.run_folder import new_run
from onboard.runtime.whole_files import write_whole
from sim_bridge.programs import run_folder
from sim_bridge.world.summary import EvaderSummary, Summary

REPORT_S = 120.0


class Options(NamedTuple):
    """What `fly` can be told."""

    fast: bool = False
    seed: int | None = None
    runs: Path = Path("runs")
    bus: str = ""  # Zenoh endpoint, "" = tcp/127.0.0.1:7447
    report: bool = True
    quiet: bool = False


class Flown(NamedTuple):
    """A game that was flown."""

    folder: Path
    summary: Summary
    report: Path | None


def fly(path: Path, options: Options, say: Callable[[str], None] = print) -> Flown:
    """Fly a scenario file. Raises ConfigError for what the user can mend."""
    scenario = load(path, several=True)
    demand_strategies(scenario, str(path))
    clock = RealClock()
    folder = new_run(options.runs, scenario.name, clock.wall_ns())
    tell = (lambda line: None) if options.quiet else say
    used = run_folder.scenario_used(scenario, options.seed, path.parent)
    write_whole(folder / "scenario.toml", used)
    run_folder.write(folder / "versions.json", run_folder.versions())
    began = clock.monotonic_ns()
    try:
        if options.fast:
            summary, timing = _fast(scenario, options, folder, path.parent, tell)
        else:
            from sim_bridge.programs.fly_real import fly_real
            from sim_bridge.programs.serve import Options as ServeOptions

            server = ServeOptions(bus=options.bus, listen=True, once=True, seed=options.seed)
            summary, timing = asyncio.run(fly_real(scenario, server, folder, path.parent, tell))
    except (ConfigError, ModuleNotFoundError):
        run_folder.discard(folder)
        raise
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"no outcome; the unfinished game is in {folder}") from None
    wall_s = (clock.monotonic_ns() - began) / NS_PER_S
    run_folder.write(folder / "summary.json", summary)
    timing = {"wall_s": round(wall_s, 3), **timing}
    run_folder.write(folder / "timing.json", timing)
    if summary.verdict == "none":  # a signal ended it: agents and vehicles were brought to an end before
        raise KeyboardInterrupt(f"no outcome; the unfinished game is in {folder}")
    report = _report(folder, tell) if options.report else None
    return Flown(folder, summary, report)


def _fast(
    scenario: Scenario, options: Options, folder: Path, home: Path, say: Callable[[str], None]
) -> tuple[Summary, dict[str, object]]:
    from sim_bridge.rehearsal import Options as RehearsalOptions
    from sim_bridge.rehearsal import Rehearsal

    clock, tell = RealClock(), silent

    async def play() -> tuple[Summary, float]:
        virtual = virtual_clock()
        chosen = RehearsalOptions(
            seed=options.seed, folder=folder, scenario_folder=home, say=say,
            version=run_folder.versions().get("apollonius", ""),
        )  # fmt: skip
        async with Rehearsal(scenario, virtual, chosen) as game:
            run_folder.write(folder / "configuration.json", game.configuration())
            await game.until_ended(tell)
            await game.land_agents()
            return game.summary(), virtual.monotonic_ns() / NS_PER_S

    began = clock.monotonic_ns()
    with Progress("sim-bridge") as progress:
        say, tell = progress.aside(say), silent if options.quiet else progress.show
        summary, virtual_s = run_virtual(play())
    took = max((clock.monotonic_ns() - began) / NS_PER_S, 1e-9)
    return summary, {
        "virtual_s": round(virtual_s, 3),
        "times_real_time": round(virtual_s / took, 2),
    }


def demand_strategies(scenario: Scenario, name: str) -> None:
    """Raise ConfigError for a strategy that nobody here has: its vehicle would never be ready."""
    for at, spec in scenario.keyed().items():
        try:
            (pursuer_strategy if at.startswith("pursuers") else evader_strategy)(spec.strategy)
        except ConfigError as error:
            raise ConfigError(f"{name}: {at}.{error}") from None


def _report(folder: Path, say: Callable[[str], None]) -> Path | None:
    """The report, made by the ground station in a process of its own; a failure is told, not fatal."""
    command = [sys.executable, "-m", "gcs.cli", "report", str(folder)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=REPORT_S, check=False)
    except subprocess.TimeoutExpired:
        say("the report took too long and was given up")
        return None
    page = folder / "report.html"
    if done.returncode != 0 or not page.exists():
        lines = done.stderr.strip().splitlines()
        say(f"no report: {lines[-1] if lines else f'exit code {done.returncode}'}")
        return None
    return page


def verdict_lines(summary: Summary) -> list[str]:
    """How it ended, a sentence; of several evaders one for each, after one for all."""
    return [verdict_line(summary), *(_evader_line(one) for one in summary.evaders)]


def _evader_line(end: EvaderSummary) -> str:
    text = {
        "captured": f"captured by pursuer {end.captor} after {end.time:.1f} s",
        "arrived": f"reached its target after {end.time:.1f} s",
        "escaped": f"escaped: not captured within {end.time:.0f} s",
        "denied": f"its target was denied: neither arrived nor captured within {end.time:.0f} s",
    }.get(end.verdict, f"no verdict: its game ended after {end.time:.1f} s")
    nearest = "" if end.smallest_distance is None else f"; smallest distance {end.smallest_distance:.2f} m"
    return f"  evader {end.id}: {text}{nearest}"


def _whole_line(summary: Summary) -> str:
    """How the whole game of several evaders ended."""
    count = len(summary.evaders)
    found = {verdict: sum(end.verdict == verdict for end in summary.evaders) for verdict in SAID}
    told = ", ".join(f"{number} {verdict}" for verdict, number in found.items() if number)
    return f"{summary.verdict} after {summary.time:.1f} s: of {count} evaders {told}"


SAID = ("captured", "denied", "escaped", "arrived", "aborted")  # verdicts, the best for the pursuers first


def verdict_line(summary: Summary) -> str:
    """How it ended, in a sentence."""
    if summary.evaders and summary.verdict != "aborted":
        return _whole_line(summary)
    smallest = summary.smallest_distance
    nearest = "" if smallest is None else f"; smallest distance {smallest:.2f} m"
    text = {
        "captured": f"captured by pursuer {summary.captor} after {summary.time:.1f} s",
        "arrived": f"the evader reached its target after {summary.time:.1f} s",
        "escaped": f"the evader escaped: not captured within {summary.time:.0f} s",
        "denied": f"the target was denied: neither arrived nor captured within {summary.time:.0f} s",
        "aborted": f"aborted: {summary.reason}",
    }.get(summary.verdict, "no outcome")
    expected = f"; the paper's verdict: {summary.expected}" if summary.expected else ""
    return f"{text}{nearest}{expected}"


def story(flown: Flown) -> str:
    """What to tell when it is over."""
    lines = [*verdict_lines(flown.summary), f"run folder: {flown.folder}"]
    pictures = sorted((flown.folder / "figures").glob("*.png"))
    if pictures:
        lines.append(f"figures:    {pictures[0].parent}: {', '.join(p.stem for p in pictures)}")
    if flown.report is not None:
        lines.append(f"report:     {flown.report}  (open it in a browser)")
    return "\n".join(lines)
