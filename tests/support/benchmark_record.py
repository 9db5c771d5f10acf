"""What a benchmark's page says of itself: machine, yardsticks, command; and where a profile's time went."""

from __future__ import annotations

import os
import platform
import pstats
from collections import defaultdict
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from tests.benchmarks import yardstick
from tests.support.paths import RESULTS, ROOT

LIBRARIES = ("numpy", "pymavlink", "msgspec", "mcap", "zenoh", "asyncio")


def machine() -> str:
    """Processor, cores, load, versions, and how fast it is just now: every page's head says this."""
    model = platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        rows = info.read_text(encoding="utf-8").splitlines()
        names = [row.split(":", 1)[1].strip() for row in rows if row.startswith("model name")]
        model = f"{model}, {names[0]}" if names else model
    load = os.getloadavg()[0]
    seen = f"{model}, {os.cpu_count()} cores with a load of {load:.1f}, Python {platform.python_version()}"
    return f"{seen}, {yardstick.words()}"


def write(name: str, title: str, command: str, lines: list[str]) -> None:
    """A page of `benchmarks/results/`."""
    RESULTS.mkdir(parents=True, exist_ok=True)
    day = datetime.now(UTC).date().isoformat()
    head = [f"# {title}", "", f"`{command}` on {machine()}; {day}.", ""]
    (RESULTS / name).write_text("\n".join([*head, *lines]) + "\n", encoding="utf-8")


def rooms(stats: pstats.Stats) -> dict[str, float]:
    """Seconds of a profile by room, the most first. What a built-in function took counts where it was called
    from."""
    found: dict[str, float] = defaultdict(float)
    entries: Mapping[tuple[str, int, str], Any] = stats.stats  # type: ignore[attr-defined]
    for (file, _, _), (_, _, own, _, callers) in entries.items():
        if file != "~" or not callers:
            found[room(file)] += own
        else:
            for (caller, _, _), (_, _, part, _) in callers.items():
                found[room(caller)] += part
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def room(file: str) -> str:
    """The room of a source file, or the library."""
    path = Path(file)
    if path.is_relative_to(ROOT) and "site-packages" not in path.parts:
        parts = path.relative_to(ROOT).with_suffix("").parts
        depth = 3 if parts[:3] == ("onboard", "pilot", "predictor") else 2
        return "/".join(parts[:depth])
    for library in LIBRARIES:
        if library in path.parts:
            return library
    return "Python" if file != "<string>" else "named tuples"
