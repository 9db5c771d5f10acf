"""`sim-bridge list`: the names that commands and scenario files take, with one line each."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum

Row = tuple[str, str]  # a name, and what it is


class Listed(Enum):
    """What can be listed."""

    SCENARIOS = "scenarios"
    STRATEGIES = "strategies"
    AIRCRAFT = "aircraft"
    AUTOPILOTS = "autopilots"


AUTOPILOTS = {
    "px4": "PX4 multicopter, OFFBOARD",
    "px4-plane": "PX4 plane, OFFBOARD",
    "arducopter": "ArduCopter, GUIDED",
    "arduplane": "ArduPlane, GUIDED",
}
PATHS = {
    "nose": "the velocity lies along the nose (7)-(8)",
    "slip": "the path lags behind the nose (34)-(35)",
    "coordinated": "bank to turn",
}


def lines(what: Listed | None) -> list[str]:
    """The names of one kind, or of every kind below its heading."""
    if what is not None:
        return _table(ROWS[what]())
    found = []
    for kind, rows in ROWS.items():
        found += [f"{kind.value}:", *(f"  {line}" for line in _table(rows())), ""]
    return found[:-1]


def scenarios() -> list[Row]:
    """The shipped scenarios."""
    from onboard.game.scenario import load
    from onboard.runtime.resources import SCENARIOS, named_files

    rows = []
    for name, path in named_files(SCENARIOS).items():
        game = load(path, several=True)
        kinds = sorted({(one.autopilot or game.flight.autopilot).value for one in game.vehicles})
        flown = "" if path.parent.name == "table1" else f", {' and '.join(kinds)}"
        space = "plane" if game.planar else "in space"
        told = f"{game.name}: {len(game.pursuers)} on {len(game.evading)}, {space}{flown}"
        rows.append((name, told))
    return rows


def strategies() -> list[Row]:
    """The core's strategies, and those that other distributions add."""
    from onboard.core.strategy.registry import EVADERS, PURSUERS
    from onboard.game.plugins import plugins

    rows = [(name, f"pursuer; {one.words}") for name, one in PURSUERS.items()]
    rows += [(name, f"evader; {one.words}") for name, one in EVADERS.items()]
    return rows + [(name, f"plug-in of {distribution}") for name, distribution in plugins()]


def aircraft() -> list[Row]:
    """The shipped aircraft files."""
    from onboard.runtime.resources import AIRCRAFT, named_files
    from sim_bridge.vehicle.flight.aircraft import load

    return [(name, PATHS[load(path).spec.path.value]) for name, path in named_files(AIRCRAFT).items()]


def autopilots() -> list[Row]:
    """The autopilots that are simulated."""
    from onboard.game.scenario import Kind

    return [(kind.value, AUTOPILOTS[kind.value]) for kind in Kind]


def _table(rows: Iterable[Row]) -> list[str]:
    rows = list(rows)
    width = max((len(name) for name, _ in rows), default=0)
    return [f"{name.ljust(width)}  {words}" for name, words in rows]


ROWS: dict[Listed, Callable[[], list[Row]]] = {
    Listed.SCENARIOS: scenarios,
    Listed.STRATEGIES: strategies,
    Listed.AIRCRAFT: aircraft,
    Listed.AUTOPILOTS: autopilots,
}
