"""What the subcommands do, once the settings are known. Each returns an exit code."""

from __future__ import annotations

import asyncio
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import AbstractAsyncContextManager, nullcontext, suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from gcs.console.plain_lines import PlainLines
from gcs.console.plain_lines import status as status_lines
from gcs.picture.assessment import beyond_one, engagements_in
from gcs.picture.json_document import to_json
from gcs.picture.several import verdict_in_words
from gcs.picture.terminal_text import printable
from gcs.picture.thresholds import Thresholds
from gcs.picture.values import Picture
from gcs.session import Session, on_air
from gcs.settings import Settings
from onboard.config.strict import ConfigError
from onboard.config.version import version
from onboard.core.math.constants import NS_PER_S
from onboard.game import go_or_no_go
from onboard.game.scenario import Scenario, load
from onboard.game.trials import in_words
from onboard.runtime.bus_security import Lock
from onboard.runtime.clock import RealClock
from onboard.runtime.progress import Progress
from onboard.runtime.spoken_lines import SpokenLines
from onboard.wire.bus.messages import Role

if TYPE_CHECKING:
    from gcs.export.formats import Format
    from gcs.replay.player import Player

LOOK_S = 0.25


async def watch(settings: Settings, *, record: bool, plain: bool) -> int:
    """The console, or lines, until one leaves."""
    _demand_terminal(plain)
    async with on_air(settings, listen=settings.bus.listen, record=record) as session:
        try:
            async with _page(session, settings):
                if plain:
                    return await print_lines(session)
                return await show_console(session)
        finally:
            _say_farewell(session)


def _page(session: Session, settings: Settings) -> AbstractAsyncContextManager[None]:
    """The page beside a console, where it is asked for."""
    if not settings.page.enabled:
        return nullcontext()
    from gcs.page.program import beside

    return beside(session, settings.page)


def _say_farewell(session: Session) -> None:
    if session.farewell():
        print(printable(session.farewell()), flush=True)


def _demand_terminal(plain: bool) -> None:
    """Refuse where one of the three streams is no terminal: the console is drawn on standard error."""
    streams = {"input": sys.stdin, "output": sys.stdout, "error": sys.stderr}
    elsewhere = [name for name, stream in streams.items() if stream is None or not stream.isatty()]
    if not plain and elsewhere:
        raise ConfigError(
            f"the console needs a terminal: found standard {', '.join(elsewhere)} redirected; "
            "without one: gcs --plain or gcs status --json"
        )


async def show_console(session: Session) -> int:
    """The console on this terminal."""
    from gcs.console.app import Console

    return await Console(session).run_async() or 0


async def print_lines(session: Session, over: Callable[[], bool] = lambda: False) -> int:
    """Lines on standard output until ctrl-C, SIGTERM or `over()`."""
    stop = asyncio.Event()
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, stop.set)
    lines, out = PlainLines(), SpokenLines()
    try:
        out.say(session.status())
        while not stop.is_set():
            for line in lines.lines(session.picture()):
                out.say(line)
            if over():
                break
            with suppress(TimeoutError):
                async with asyncio.timeout(LOOK_S):
                    await stop.wait()
    finally:
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.remove_signal_handler(number)
        out.close()
    return 0


async def status(settings: Settings, *, json: bool, wait_s: float) -> int:
    """Print the picture once, after listening for `wait_s`; exit code 1 when nobody is heard."""
    async with on_air(settings, listen=False, record=False) as session:
        await asyncio.sleep(wait_s)
        picture = session.picture()
        print(to_json(picture) if json else "\n".join(map(printable, status_lines(picture))), flush=True)
        if not picture.vehicles and picture.game.setup is None:
            print(f"gcs: nobody heard in game {settings.game}: {session.bus.status()}", file=sys.stderr)
            return 1
    return 0


def assess_file(path: Path) -> int:
    """Print the odds of a scenario, of several evaders each one's; exit code 1 where they say no-go."""
    scenario = load(path, several=True)
    beyond = partial(go_or_no_go.beyond_one, scenario)
    found = go_or_no_go.engagements(scenario)
    return _told({id: go_or_no_go.lines(one, beyond(id)) for id, one in found.items()})


async def assess_bus(settings: Settings, *, wait_s: float) -> int:
    """Print the odds of the game on the bus, after listening for `wait_s`; exit code 1 for a no-go."""
    async with on_air(settings, listen=False, record=False) as session:
        await asyncio.sleep(wait_s)
        picture = session.picture()
        found = engagements_in(picture.game, picture.vehicles, picture.tracks)
        if not found:
            print(f"gcs: no evader with pursuers heard in game {settings.game}: {session.bus.status()}",
                  file=sys.stderr)  # fmt: skip
            return 1
    return _told({id: go_or_no_go.lines(one, beyond_one(picture.game, id)) for id, one in found.items()})


def _told(judged: dict[int, list[str]]) -> int:
    """Print what was said of each evader's engagement; 1 where one is a no-go."""
    for id, lines in judged.items():
        if len(judged) > 1:
            print(f"evader {id}")
        print("\n".join(map(printable, lines)), flush=True)
    return 1 if any(lines[0].startswith("no-go") for lines in judged.values()) else 0


async def check_crowd(settings: Settings, scenario: Scenario, wait_s: float) -> int:
    """Compare the roster's vehicles after listening for `wait_s`; exit code 1 where two might meet."""
    from gcs.crowd import compare

    async with on_air(settings, listen=False, record=False) as session:
        await asyncio.sleep(wait_s)
        heard = {vehicle.id: vehicle.health for vehicle in session.picture().vehicles}
        lines = compare(scenario, heard)
    for line in lines:
        print(f"{'PASS' if line.well else 'FAIL'}  vehicle {line.id}: {printable(line.text)}", flush=True)
    return 0 if all(line.well for line in lines) else 1


async def play(
    settings: Settings, scenario: Scenario, *, plain: bool, auto_start: bool, takes_over: str = ""
) -> int:
    """Play a game with the ground station as its master; exit code 0 when it ended with a verdict."""
    from gcs.master import FieldMaster

    _demand_terminal(plain)
    listen, record = settings.bus.listen, settings.recording.enabled
    async with on_air(settings, listen=listen, record=record) as session:
        if scenario.flight.field_profile and session.lock.lock is Lock.OPEN and not settings.bus.open:
            raise ConfigError(
                f"bus: found {session.lock.words}, expected keys, or open = true, for a game in the field"
            )
        master = FieldMaster(session.station, scenario, auto_start=auto_start, takes_over=takes_over)
        session.extra = master.status
        session.leaving = "leave the console? the game then ends for want of its master"
        async with _page(session, settings), asyncio.TaskGroup() as tasks:
            task = tasks.create_task(master.run(), name="master")
            try:
                if plain:
                    await print_lines(session, over=lambda: master.over)
                else:
                    await show_console(session)
            finally:
                task.cancel()
                _say_farewell(session)
        picture: Picture = session.picture()
        if picture.game.outcome is not None:
            outcome = picture.game.outcome
            print(f"{verdict_in_words(outcome)} after {outcome.time:.1f} s")
            for end in outcome.evaders:
                print(f"  {in_words(end)}")
        return master.exit_code


def replay(run: Path, limits: Thresholds, *, plain: bool) -> int:
    """A recording in the console, or its log in lines."""
    from gcs.replay.player import Player
    from gcs.replay.source import ReplaySource, open_run

    _demand_terminal(plain)
    recording = open_run(run)
    try:
        for remark in recording.remarks:
            print(f"gcs: {remark}", file=sys.stderr)
        player = Player(recording, limits, version())
        if plain:
            _print_through(player)
            return 0
        from gcs.console.app import Console

        source = ReplaySource(player, run.resolve().name, RealClock().monotonic_ns)
        return asyncio.run(Console(source).run_async()) or 0
    finally:
        recording.close()


def _print_through(player: Player) -> None:
    """Every line of the log, and how all were every five seconds, without waiting."""
    lines = PlainLines()
    at_ns = player.start_ns
    while True:
        player.seek(at_ns)
        for line in lines.lines(player.picture()):
            print(line)
        if player.ended:
            return
        at_ns += NS_PER_S


def decide_again(run: Path, strategies: dict[Role, str]) -> int:
    """The agents of a run fed again: where they do or decide otherwise. 1 where an agent does."""
    from gcs.replay.decide import decide

    with Progress("gcs") as progress:
        comparison = decide(run, strategies, progress.show)
    print("\n".join(comparison.lines()))
    return 1 if any(fed.otherwise for fed in comparison.fed) else 0


def report(run: Path, limits: Thresholds, *, gif: bool = False) -> int:
    """The report of a run; with `gif` its scene as a GIF, too."""
    from gcs.report.program import write_report

    with Progress("gcs") as progress:
        written = write_report(run, limits, version(), progress.show)
        if gif:
            from gcs.report.moving import write_gif

            moving = write_gif(written.page, written.page.with_suffix(".gif"), progress.show)
            written = written._replace(pictures=(*written.pictures, moving))
    for note in written.notes:
        print(f"gcs: {note}", file=sys.stderr)
    print(written.page)
    for picture in written.pictures:
        print(picture)
    return 0


def export(run: Path, formats: Sequence[Format], to: Path | None, ids: tuple[int, ...]) -> int:
    """A run in formats that other programs read."""
    from gcs.export.program import export as write

    written, notes = write(run, formats, to, ids)
    for note in notes:
        print(f"gcs: {note}", file=sys.stderr)
    for path in written:
        print(path)
    return 0


def compare(first: Path, second: Path) -> int:
    """Two runs beside each other."""
    from gcs.export.compare import compare as beside

    print("\n".join(map(printable, beside(first, second).lines())))
    return 0
