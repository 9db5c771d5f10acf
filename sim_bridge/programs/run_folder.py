"""The run folder that `fly` leaves: what was played, with what, and how it ended."""

from __future__ import annotations

import platform
import re
import shutil
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from typing import Any

import msgspec

from onboard.core.strategy.registry import evader_named, pursuer_named
from onboard.game.scenario import Scenario
from onboard.runtime.whole_files import write_whole
from onboard.wire.bus.messages import Role

PACKAGES = ("apollonius", "numpy", "pymavlink", "eclipse-zenoh", "msgspec", "numba", "scipy", "control")
BARE = re.compile("[A-Za-z0-9_-]+")  # a key that TOML takes without quotes


def discard(folder: Path) -> None:
    """Remove a run folder in which nothing was flown; where there is a log it stays, for it may tell why."""
    if any(path.suffix in (".log", ".tlog") and path.stat().st_size for path in folder.iterdir()):
        return
    shutil.rmtree(folder, ignore_errors=True)


def write(path: Path, value: object) -> None:
    """Write JSON, whole or not at all; what is not known is null, never "". Raises ConfigError."""
    answers = _answers(msgspec.to_builtins(value))
    data = msgspec.json.format(msgspec.json.encode(answers), indent=1) + b"\n"
    write_whole(path, data)


def _answers(value: Any) -> Any:
    """Plain data in which an empty string, which answers nothing, has become None."""
    if isinstance(value, Mapping):
        return {key: _answers(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_answers(inner) for inner in value]
    return None if value == "" else value


def versions() -> dict[str, str]:
    """Of Python and of what matters."""
    found = {"python": platform.python_version()}
    for name in PACKAGES:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


def toml_of(settings: Mapping[str, Any], table: str = "") -> str:
    """Settings as TOML, tables and lists of tables included; what is None is left out.

    `table` is the dotted name of the table that they stand in.
    """
    values, tables = [], []
    for key, value in settings.items():
        name = key if BARE.fullmatch(key) else msgspec.json.encode(key).decode()
        at = f"{table}.{name}" if table else name
        if isinstance(value, Mapping) and value:
            tables.append(f"\n[{at}]\n{toml_of(value, at)}")
        elif isinstance(value, (list, tuple)) and value and isinstance(value[0], Mapping):
            tables += [f"\n[[{at}]]\n{toml_of(entry, at)}" for entry in value]
        elif value is not None and not isinstance(value, Mapping):
            values.append(f"{name} = {msgspec.json.encode(value).decode()}\n")
    return "".join(values + tables)


def scenario_used(scenario: Scenario, seed: int | None, home: Path) -> bytes:
    """A scenario file with every value that a run used, those that were left to their defaults included.

    `seed` where it was given in place of the scenario's; a recording of wind, which lies in `home`, by its
    full path. `fly` plays the file again from any folder.
    """
    replace = msgspec.structs.replace
    wind = scenario.flight.wind
    if wind.recorded:
        wind = replace(wind, recorded=str((home / wind.recorded).resolve()))
    named = {Role.EVADER: evader_named, Role.PURSUER: pursuer_named}
    vehicles = tuple(
        replace(
            spec,
            id=id,
            strategy=named[scenario.role_of(id)](spec.strategy),
            speed_max=spec.limits().speed_max,
        )
        for id, spec in zip(scenario.ids, scenario.vehicles, strict=True)
    )
    team = 1 + len(scenario.pursuers)
    used = replace(
        scenario,
        evader=vehicles[0],
        pursuers=vehicles[1:team],
        evaders=vehicles[team:],
        seed=scenario.seed if seed is None else seed,
        parameters=replace(scenario.parameters, rho=scenario.rules.rho),
        flight=replace(scenario.flight, wind=wind),
    )
    return f"# Every value that this run used.\n{toml_of(_answers(used.contents()))}".encode()
