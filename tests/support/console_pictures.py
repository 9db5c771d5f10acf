"""Pictures of the console for the documents: `python -m tests.support.console_pictures [FOLDER]`.

The demo's game is played on virtual time beside a station; what it saw is drawn by the real console.
"""

from __future__ import annotations

import asyncio
import re
import sys
from collections.abc import Iterable
from pathlib import Path

from gcs.console.app import Console
from gcs.console.source import LIVE_HINT, Key
from gcs.picture.values import Picture
from gcs.station import Station, StationSetup
from onboard.game.scenario import load
from onboard.runtime.loop import run_virtual
from onboard.runtime.resources import configs
from onboard.wire.bus.messages import CommandKind, Phase
from tests.support.whole_games import at_phase, game_of

DEMO = configs() / "scenarios" / "flight" / "demo.toml"


class Still:
    """A source that stands still."""

    title = "live"
    keys: tuple[Key, ...] = ()
    steers = True
    leaving = "leave the console? vehicles fly on"

    def __init__(self, picture: Picture) -> None:
        self._picture = picture

    def picture(self) -> Picture:
        return self._picture

    def hint(self) -> str:
        return LIVE_HINT

    def nobody(self) -> tuple[str, ...]:
        return ()

    def status(self) -> str:
        return "listening at tcp/127.0.0.1:7447, recording 0.4 MB"

    def act(self, action: str) -> str:
        return ""

    def command(self, kind: CommandKind, ids: Iterable[int], *, named: bool = False) -> str:
        return ""

    def acknowledge(self, alert: str) -> None:
        return


async def _play() -> tuple[Picture, Picture]:
    """The demo under way, and just after an abort that vehicle 4, whose agent was killed, cannot confirm."""
    async with game_of(load(DEMO)) as game:
        station = Station(game.broker.connect("gcs"), game.clock, StationSetup(game.game, "gcs/anna"))
        task = asyncio.create_task(station.run())
        await at_phase(game, Phase.RUNNING)
        await game.forward(14.0)
        running = station.picture()
        game.kill_agent(4)
        game.agents[4].bus.cut()
        await game.forward(4.0)
        station.command(CommandKind.ABORT, station.ids())
        await game.forward(3.0)
        aborted = station.picture()
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
    return running, aborted


async def _draw(picture: Picture, size: tuple[int, int], selected: int, keys: tuple[str, ...]) -> str:
    """The console as SVG."""
    app = Console(Still(picture))
    async with app.run_test(size=size) as pilot:
        app.select(selected)
        await pilot.press(*keys)
        await pilot.pause()
        svg = app.export_screenshot(title="gcs")
    svg = re.sub(r"@font-face \{.*?\}\s*", "", svg, flags=re.DOTALL)  # nothing is fetched from anywhere
    return svg.replace("Fira Code", "DejaVu Sans Mono")


def main(folder: Path) -> None:
    running, aborted = run_virtual(_play())
    for name, picture, size, selected, keys in (
        ("console", running, (140, 40), 5, ()),
        ("console-80x24", aborted, (80, 24), 4, ()),
        ("console-help", aborted, (80, 24), 4, ("question_mark",)),
    ):
        svg = asyncio.run(_draw(picture, size, selected, keys))
        (folder / f"{name}.svg").write_text(svg, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures"))
