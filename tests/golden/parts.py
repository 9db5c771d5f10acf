"""The guarded parts: how each is run, what is recorded of it, and how it is compared."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple, Protocol

from pymavlink.dialects.v20 import all as dialect

from tests.golden import adapter, capture, digests, translations
from tests.golden.differences import Comparison, told, write_decoded
from tests.golden.digests import Part
from tests.support.paths import RECORDINGS

HERE = Path(__file__).parent
RECORDED = HERE / "recorded"
COMMAND_S = 600.0


class Guarded(Protocol):
    """A part of the product's behaviour. `name` is its file's in `recorded/`, too."""

    @property
    def name(self) -> str:
        """What `--only` calls it."""
        ...

    def record(self, folder: Path) -> None:
        """Run it and write what is kept of it to `folder`."""
        ...

    def compare(self, folder: Path, found: Path) -> list[str]:
        """Run it and compare with what is in `folder`: a line for each difference, details in `found`."""
        ...

    def show(self, found: Path) -> None:
        """Run it and write all of it, decoded, to `found`."""
        ...


def command(*arguments: str, exit_code: int = 0) -> str:
    """Standard output of `sim-bridge` with `arguments`. Raises RuntimeError for another exit code."""
    done = subprocess.run(
        [*adapter.SIM_BRIDGE, *arguments], capture_output=True, text=True, timeout=COMMAND_S, check=False
    )
    if done.returncode != exit_code:
        said = (done.stderr or done.stdout).strip()[-2000:]
        line = f"sim-bridge {' '.join(arguments)}"
        raise RuntimeError(f"{line}: found exit code {done.returncode}, expected {exit_code}: {said}")
    return done.stdout


class Streamed:
    """A part that consists of streams."""

    def __init__(self, name: str, every: int) -> None:
        self.name = name
        self.every = every  # seconds between two items that are kept in full

    def run(self, translate: bool) -> Part:
        """Run it; with the declared translations where `translate`."""
        raise NotImplementedError

    def record(self, folder: Path) -> None:
        """Run it and write what is kept of it to `folder`."""
        digests.write(digests.kept(self.run(False), adapter.EPOCH_NS, self.every), folder, self.name)

    def compare(self, folder: Path, found: Path) -> list[str]:
        """Run it and compare with what is in `folder`: a line for each difference, details in `found`."""
        expected = digests.read(folder, self.name)
        return Comparison(self.name, expected, self.run(True), adapter.EPOCH_NS).lines(found)

    def show(self, found: Path) -> None:
        """Run it and write all of it, decoded, to `found`."""
        for stream, items in self.run(True).streams.items():
            write_decoded(items, found / self.name / stream, adapter.EPOCH_NS)


class FastGame(Streamed):
    """A game of `sim-bridge fly --fast`: telemetry logs, bus, viewers' topics and summary."""

    def __init__(self, name: str, scenario: str, every: int) -> None:
        super().__init__(name, every)
        self.scenario = scenario  # a shipped scenario's name, or a file

    def run(self, translate: bool) -> Part:
        """Fly it."""
        tables = ((*translations.TRANSLATIONS,) if translate else (), translations.EXCLUDED)
        with TemporaryDirectory(prefix="golden-") as runs:
            command("fly", "--fast", "--quiet", "--no-report", "--runs", runs, self.scenario)
            (run,) = Path(runs).iterdir()
            summary = json.loads((run / adapter.SUMMARY).read_text(encoding="utf-8"))
            for table in tables:
                _topic, summary = translations.translated("summary", summary, table)
            return Part(capture.game_streams(run, adapter.RECORDING, tables), summary)


class Beside(Streamed):
    """What the evader's agent sends to an autopilot that is the recording of a real one."""

    def __init__(self, name: str, recording: str, scenario: Path, *, with_gps: bool, every: int) -> None:
        super().__init__(name, every)
        self.recording = recording
        self.scenario = scenario
        self.with_gps = with_gps  # whether GPS_RAW_INT is added: the recorded autopilot sent none

    def run(self, translate: bool) -> Part:
        """Play the game; nothing in it is translated."""
        log = (RECORDINGS / f"{self.recording}.tlog").read_bytes()
        frames = list(autopilots(log))
        if self.with_gps:
            frames = list(with_gps(frames))
        sent = adapter.sent_beside(self.scenario, frames)
        return Part({"sent": capture.framed((s.at_ns, s.data) for s in sent)}, "")


def autopilots(log: bytes) -> Iterator[tuple[int, bytes]]:
    """The frames of a log that the autopilot (component 1) sent, with the time since the first frame [ns]."""
    start = -1
    for at_ns, frame in capture.frames(log):
        start = at_ns if start < 0 else start
        if capture.kind_of(frame).endswith("/1"):
            yield at_ns - start, frame


def with_gps(frames: list[tuple[int, bytes]], every_ns: int = 500_000_000) -> Iterator[tuple[int, bytes]]:
    """The same with a good GPS_RAW_INT twice a second, under the number of the frame before it."""
    due = 0
    sender = dialect.MAVLink(None, srcSystem=adapter.FED, srcComponent=1)
    for at_ns, frame in frames:
        yield at_ns, frame
        if at_ns >= due:
            due = at_ns + every_ns
            sender.seq = frame[4]
            gps = dialect.MAVLink_gps_raw_int_message(
                at_ns // 1000, 3, 473977420, 85455940, 508000, 80, 120, 0, 0, 12
            )
            yield at_ns, bytes(gps.pack(sender))


class Rows:
    """A part that is a table: a line of JSON a row."""

    def __init__(self, name: str) -> None:
        self.name = name

    def rows(self) -> dict[str, Any]:
        """Run it: rows by their name."""
        raise NotImplementedError

    def text(self) -> str:
        """The table as it is recorded."""
        return "".join(json.dumps({"row": name, **row}) + "\n" for name, row in self.rows().items())

    def record(self, folder: Path) -> None:
        """Run it and write the table to `folder`."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{self.name}.jsonl").write_text(self.text(), encoding="utf-8")

    def compare(self, folder: Path, found: Path) -> list[str]:
        """Run it and compare with the table in `folder`; the found one goes to `found`."""
        recorded = (folder / f"{self.name}.jsonl").read_text(encoding="utf-8")
        text = self.text()
        expected, now = _by_name(recorded), _by_name(text)
        lines = [
            f"{self.name}: {name}: {line}"
            for name in [*expected, *(name for name in now if name not in expected)]
            for line in told(expected.get(name, "no such row"), now.get(name, "no such row"))
        ]
        if lines:
            found.mkdir(parents=True, exist_ok=True)
            (found / f"{self.name}.jsonl").write_text(text, encoding="utf-8")
        return lines

    def show(self, found: Path) -> None:
        """Run it and write the table to `found`."""
        self.record(found)


def _by_name(text: str) -> dict[str, Any]:
    return {row.pop("row"): row for row in map(json.loads, text.splitlines())}


class Planar(Rows):
    """Table 1: `sim-bridge planar`, which exits with 0 only where all 30 verdicts are the paper's."""

    def rows(self) -> dict[str, Any]:
        """Twenty games: ten rows under two strategies."""
        games = [json.loads(line) for line in command("planar", "--json").splitlines()]
        return {f"{game['scenario']}, {game['strategy']}": game for game in games}


class Spatial(Rows):
    """The spatial campaign, compiled."""

    def __init__(self, name: str, scenario: str, seeds: range) -> None:
        super().__init__(name)
        self.scenario = scenario
        self.seeds = seeds

    def rows(self) -> dict[str, Any]:
        """Every seed, flown with the strategy and straight."""
        rows = adapter.spatial_rows(self.scenario, self.seeds)
        return {f"{self.scenario}, seed {seed}, {way}": row._asdict() for (seed, way), row in rows.items()}


class Guard(NamedTuple):
    """A part, and whether it is in the suite's share."""

    part: Guarded
    short: bool


SCENARIOS = HERE / "scenarios"
GUARDS = (
    Guard(Spatial("spatial", "five", range(100)), False),
    Guard(FastGame("game-planes", "five", every=4), False),
    Guard(FastGame("game-loss", "heavy-loss", every=1), False),
    Guard(FastGame("game-demo", "demo", every=1), False),
    Guard(FastGame("game-short", str(SCENARIOS / "short.toml"), every=1), True),
    Guard(
        Beside(
            "frames-arducopter", "arducopter-4.5.6-guided", SCENARIOS / "beside-arducopter.toml",
            with_gps=True, every=1,
        ),
        True,
    ),
    Guard(
        Beside(
            "frames-arduplane", "arduplane-4.5.6-guided", SCENARIOS / "beside-arduplane.toml",
            with_gps=False, every=1,
        ),
        False,
    ),
    Guard(Planar("planar"), True),
)  # fmt: skip
PARTS = {guard.part.name: guard.part for guard in GUARDS}
SHORT = tuple(guard.part.name for guard in GUARDS if guard.short)
