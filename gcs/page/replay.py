"""A recording on the page: its timeline, the marks on it, and curves tied to its clock."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from gcs.page.documents import Document
from gcs.picture.thresholds import Thresholds
from gcs.picture.values import Picture
from gcs.recording.reader import Recording
from gcs.replay.player import SPEEDS, Player
from gcs.replay.source import ReplaySource
from gcs.report.data import Run
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import Severity
from onboard.wire.bus.topics import PHASE

NS_PER_MS = 1_000_000
CURVE_POINTS = 600  # of one curve
MARKS_MOST = 300  # on a timeline; the gravest stay
GRAVEST = (Severity.ERROR, Severity.WARNING, Severity.INFO)


class PageReplay(ReplaySource):
    """A replay that a page moves: by the console's keys, by jumps, in a loop."""

    def __init__(self, player: Player, name: str, now_ns: Callable[[], int], told: Document) -> None:
        super().__init__(player, name, now_ns)
        self.told = told  # marks and curves, made once
        self.loops = False

    def picture(self) -> Picture:
        """The picture at the place in the recording; at the end of a loop its beginning."""
        found = super().picture()
        if self.loops and self.player.ended and self.player.paused:
            self.player.pause(False)
        return found

    def act(self, action: str) -> str:
        """A key, or `loop`, or `speed N`."""
        verb, _, value = action.partition(" ")
        if verb == "loop":
            self.loops = not self.loops
            return "again and again" if self.loops else "once"
        if verb == "speed":
            if value not in (words := [f"{speed:g}" for speed in SPEEDS]):
                return f"speed: found {value[:20]!r}, expected one of {', '.join(words)}"
            self.player.speed = float(value)
            return ""
        return super().act(action)

    def seek_ms(self, at_ms: int) -> None:
        """Go to this instant [ms since the recording's begin]; it plays on if it was playing."""
        self.player.seek(self.player.start_ns + at_ms * NS_PER_MS)

    def timeline(self) -> Document:
        """The place and how it moves."""
        player = self.player
        return {
            "at_ms": (player.at_ns - player.start_ns) // NS_PER_MS, "speed": player.speed,
            "length_ms": (player.end_ns - player.start_ns) // NS_PER_MS,
            "playing": not player.paused, "loops": self.loops,
        }  # fmt: skip

    def marks(self) -> Document:
        """Marks and curves: they do not change."""
        return self.told


class Opened(NamedTuple):
    """A recording that was played through once."""

    player: Player
    last: Picture  # at the end
    free: dict[int, list[tuple[int, float]]]  # by evader, each second: instant [ns], its widest gap [rad]


def opened(
    recording: Recording, limits: Thresholds, version: str, tell: Callable[[float], None] = lambda share: None
) -> Opened:
    """Play through a recording for its index. It takes a while: not on an event loop."""
    player = Player(recording, limits, version)
    free: dict[int, list[tuple[int, float]]] = {}

    def look(share: float, picture: Picture) -> None:
        tell(share)
        for found in picture.assessments:
            widest = 0.0 if found.encircled else found.largest_gap
            free.setdefault(found.evader, []).append((picture.now_ns, widest))

    return Opened(player, player.index(look), free)


def marks_of(recording: Recording, opened: Opened, run: Run) -> Document:
    """Phases, events and alerts on the recording's time, and the curves of the run, for `PageReplay`."""
    start_ns, last = recording.start_ns, opened.last
    drops: Counter[str] = Counter()
    phase_key = PHASE.key(recording.game)
    found: list[tuple[Severity, Document]] = []
    for entry in recording.entries():
        if entry.key == phase_key and (change := PHASE.decode(entry.payload, drops)) is not None:
            at_ms = (entry.stamp_ns - start_ns) // NS_PER_MS
            found.append((Severity.ERROR, {"at_ms": at_ms, "kind": "phase", "text": change.phase.value}))
    for alert in (*last.past_alerts, *last.alerts):
        at_ms = (alert.raised_ns - start_ns) // NS_PER_MS
        told = {"at_ms": at_ms, "kind": "alert", "text": alert.text, "severity": alert.severity.value}
        found.append((alert.severity, told))
    for line in last.log:
        if line.id:
            at_ms = (line.at_ns - start_ns) // NS_PER_MS
            told = {"at_ms": at_ms, "kind": "event", "text": f"{line.id}: {line.text}"}
            found.append((line.severity, told | {"severity": line.severity.value}))
    found.sort(key=lambda pair: (GRAVEST.index(pair[0]), pair[1]["at_ms"]))
    marks = sorted((mark for _, mark in found[:MARKS_MOST]), key=lambda mark: mark["at_ms"])
    zero_ms = (run.t0_ns - start_ns) / NS_PER_MS if run.t0_ns else 0.0
    return {"what": "marks", "marks": marks, "zero_ms": round(zero_ms), "curves": curves(run, opened.free)}


def curves(run: Run, free: dict[int, list[tuple[int, float]]]) -> list[Document]:
    """Distances, speeds, the free band and rules over the time since t₀ [s], thinned for a screen."""
    found: list[Document] = []
    if gaps := run.gaps():
        lines = [_line(gap.id, run, gap.t, gap.distance) for gap in gaps]
        levels = [
            {"name": name, "value": value}
            for name, value in (("R", run.capture_radius), ("ρ", run.safety_distance))
            if value
        ]
        nearest = "nearest evader" if len(run.evaders) > 1 else "evader"
        found.append({"name": f"distance to the {nearest}", "unit": "m", "lines": lines, "levels": levels})
    speeds = [_line(f.id, run, f.t, f.groundspeed) for f in run.flown.values() if len(f.t) > 1]
    if speeds:
        found.append({"name": "speed over ground", "unit": "m/s", "lines": speeds, "levels": []})
    if free:
        alone = len(free) == 1
        lines = []
        for id, each in sorted(free.items()):
            times = np.array([(at_ns - run.t0_ns) / NS_PER_S for at_ns, _ in each])
            lines.append(_line(0 if alone else id, run, times, np.degrees([gap for _, gap in each])))
        name = "widest free gap of " + ("the evader" if alone else "each evader")
        found.append({"name": name, "unit": "°", "lines": lines, "levels": []})
    if run.rules:
        rows = [
            {"id": i, "bands": [[round(b.start, 2), round(b.end, 2), b.rule] for b in bands[:CURVE_POINTS]]}
            for i, bands in sorted(run.rules.items())
        ]
        found.append({"name": "rule in force", "rows": rows})
    return found


def _line(id: int, run: Run, t: Any, values: Any) -> Document:
    keep = np.unique(np.linspace(0, len(t) - 1, min(len(t), CURVE_POINTS)).round().astype(int))
    member = run.flown.get(id)
    return {
        "id": id, "role": member.role.value if member else "",
        "t": [round(float(x), 2) for x in t[keep]], "y": [round(float(x), 2) for x in values[keep]],
    }  # fmt: skip
