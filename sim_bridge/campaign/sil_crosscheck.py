"""The campaign's games again, flown whole: agents, MAVLink, sensor and bus, by `sim-bridge fly --fast`.

A seed's draw (places and wind direction) is written out as a scenario file; gusts, tracks and links then come
from the bridge's own generators with the same seed.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from onboard.game.scenario import load
from sim_bridge.campaign.spatial_draw import drawn_scenario
from sim_bridge.campaign.spatial_game import Evasion

PATIENCE = 1800.0  # [s] of wall time for one game


class FlownGame(NamedTuple):
    """One game as its run folder tells it."""

    seed: int
    way: str
    verdict: str
    time: float  # [s]
    smallest: float  # [m]


def inline(value: Any) -> str:
    """Plain data as a TOML value."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {inline(part)}" for key, part in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(inline, value)) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return json.dumps(value) if isinstance(value, str) else repr(value)


def drawn(path: Path, seed: int, evasion: Evasion) -> str:
    """The scenario file of a seed's draw, and of how the evader flies."""
    data = tomllib.loads(path.read_text(encoding="utf-8"))
    found = drawn_scenario(load(path), seed)
    for spec, vehicle in zip([data["evader"], *data["pursuers"]], found.vehicles, strict=True):
        spec["position"] = list(vehicle.position)
    data["flight"]["wind"]["from_deg"] = found.flight.wind.from_deg
    data["seed"] = found.seed
    if evasion is Evasion.STRAIGHT:
        data["evader"]["strategy"] = "straight"
    return "\n".join(f"{key} = {inline(value)}" for key, value in data.items()) + "\n"


def fly_game(path: Path, seed: int, evasion: Evasion, folder: Path) -> FlownGame:
    """Fly one game in a process of its own; the run folder stays under `folder`."""
    way = evasion.name.lower()
    home = folder / f"{path.stem}-{seed}-{way}"
    home.mkdir(parents=True, exist_ok=True)
    scenario = home / "scenario.toml"
    scenario.write_text(drawn(path, seed, evasion), encoding="utf-8")
    command = [sys.executable, "-c", "from sim_bridge.cli import main; main()", "fly", "--fast"]
    subprocess.run(
        [*command, str(scenario), "--runs", str(home), "--quiet", "--no-report"],
        check=False,
        timeout=PATIENCE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    found = sorted(home.glob("*/summary.json"))
    if not found:
        return FlownGame(seed, way, "failed", float("nan"), float("nan"))
    summary = json.loads(found[-1].read_text(encoding="utf-8"))
    return FlownGame(
        seed,
        way,
        str(summary["verdict"]),
        float(summary.get("time") or "nan"),
        float(summary.get("smallest_distance") or "nan"),
    )
