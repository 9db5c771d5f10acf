"""What is learned: a scenario, who learns in it, against whom, by which observations, actions and rewards."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum
from math import isfinite
from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.game.advance import EvaderStrategy, PursuerStrategy
from onboard.core.math.vectors import distance
from onboard.core.strategy.features import Axes, Form, Steering
from onboard.game.plugins import evader_strategy, pursuer_strategy
from onboard.game.scenario import AirframeKind, Scenario, load
from onboard.runtime.resources import SCENARIOS, shipped_file
from sim_bridge.gym.exchange import Rewards

EVADER = "evader"
HEIGHT_SHARE = 0.2  # of the spread of places, by which starts differ in height


class Motion(Enum):
    """How vehicles move."""

    AIRCRAFT = "aircraft"  # as flown: transfer functions, gusts, sensor, filters, supervisor, autopilot
    SIMPLE = "simple"  # (7)–(8): at once as decided, in the mean wind


class Task(NamedTuple):
    """A learning task. `make_task` checks one."""

    scenario: Scenario
    learners: tuple[str, ...]  # names of `agents_of` whose actions come from outside, evader first
    evader: EvaderStrategy | None  # None: it learns
    pursuers: PursuerStrategy | None  # None: all of them learn
    motion: Motion
    form: Form
    rewards: Rewards
    spread: float  # [m] by which a game moves each pursuer's start, one sigma, level; a fifth of it in height


class Wish(msgspec.Struct, frozen=True, kw_only=True):
    """What an environment can be told; every key is one of `gymnasium.make`."""

    scenario: Scenario | Path | str = "plane"  # a scenario, its file, or the name of a shipped one
    learn: str | Sequence[str] = "pursuers"  # "pursuers", "evader", "all", or names as "pursuer_1"
    evader: str = ""  # its strategy where it does not learn; "" = the scenario's
    pursuers: str = ""  # strategy of those who do not learn; "" = the scenario's
    motion: str = "simple"  # vehicles fly at once as decided, in the mean wind; "aircraft": as flown
    actions: str = "heading"  # or "velocity", "acceleration": see above
    axes: str = "ned"  # north, east, down; "sight": along the line of sight, right of it, down
    rewards: Rewards = Rewards()  # see above
    spread: float | None = None  # of the starts, σ [m]; None: a fifth of the nearest distance


def agents_of(scenario: Scenario) -> tuple[str, ...]:
    """Names of everybody who plays, the evader first: evader_1, pursuer_1, pursuer_2, …"""
    return (f"{EVADER}_1", *(f"pursuer_{k + 1}" for k in range(len(scenario.pursuers))))


def make_task(wish: Wish) -> Task:
    """The task of a wish. Raises ConfigError that names the key, what was found and what was expected."""
    scenario = _scenario(wish.scenario)
    motion = Motion(_one("motion", wish.motion, [kind.value for kind in Motion]))
    _demand_playable(scenario, motion)
    agents = agents_of(scenario)
    learners = _learners(wish.learn, agents)
    evader = pursuers = None
    if agents[0] not in learners:
        evader = evader_strategy(wish.evader or scenario.evader.strategy)
    elif wish.evader:
        raise ConfigError(f"evader: found {wish.evader!r}, expected none: {agents[0]} learns")
    if not set(agents[1:]) <= set(learners):
        pursuers = pursuer_strategy(wish.pursuers or _team_strategy(scenario))
    elif wish.pursuers:
        raise ConfigError(f"pursuers: found {wish.pursuers!r}, expected none: all of them learn")
    steering = Steering[_one("actions", wish.actions, [kind.name.lower() for kind in Steering]).upper()]
    axes = Axes[_one("axes", wish.axes, [kind.name.lower() for kind in Axes]).upper()]
    dt = scenario.parameters.dt if motion is Motion.SIMPLE else 1.0 / scenario.flight.control_rate_hz
    form = Form(axes, steering, scenario.planar, scenario.evader.acceleration, dt)
    spread = _spread(scenario) if wish.spread is None else wish.spread
    if not isinstance(spread, int | float) or not 0.0 <= spread < 1e6:
        raise ConfigError(f"spread: found {wish.spread!r}, expected 0 to 1e6 m")
    if not isinstance(wish.rewards, Rewards) or not all(map(_finite, wish.rewards)):
        raise ConfigError(f"rewards: found {wish.rewards!r}, expected Rewards of finite numbers")
    return Task(scenario, learners, evader, pursuers, motion, form, wish.rewards, float(spread))


def _finite(value: object) -> bool:
    return isinstance(value, int | float) and isfinite(value)


def _one(key: str, value: str, words: list[str]) -> str:
    if value not in words:
        raise ConfigError(f"{key}: found {value!r}, expected one of: {', '.join(words)}")
    return value


def _scenario(wish: Scenario | Path | str) -> Scenario:
    if isinstance(wish, Scenario):
        return wish
    if not isinstance(wish, str | Path) or not str(wish).strip():
        raise ConfigError(f"scenario: found {wish!r}, expected a scenario, its file, or a shipped one's name")
    return load(shipped_file(Path(wish), SCENARIOS))


def _demand_playable(scenario: Scenario, motion: Motion) -> None:
    wind, name = scenario.flight.wind, scenario.name
    accelerations = {v.acceleration for v in scenario.vehicles}
    faults: list[tuple[bool, str, object, str]] = [
        (len(accelerations) > 1, "acceleration", sorted(accelerations), "the same of all vehicles")
    ]
    faults.append((bool(scenario.zones), "zones", f"{len(scenario.zones)} zones", "none"))
    if motion is Motion.SIMPLE:
        for key in ("shear", "gust_sigma", "correlation_m", "recorded"):
            value = getattr(wind, key)
            faults.append((bool(value), f"flight.wind.{key}", value, "none with motion 'simple'"))
        faults.append((scenario.flight.fence is not None, "flight.fence", "one", "none with motion 'simple'"))
        wanted = scenario.flight.airframe
        faults.append((wanted is not AirframeKind.KINEMATIC, "flight.airframe", wanted.value,
                       "kinematic with motion 'simple'; motion 'aircraft' flies the others"))  # fmt: skip
    for wrong, key, found, expected in faults:
        if wrong:
            raise ConfigError(f"{name}: {key}: found {found}, expected {expected}")


def _learners(learn: str | Sequence[str], agents: tuple[str, ...]) -> tuple[str, ...]:
    groups = {"evader": agents[:1], "pursuers": agents[1:], "all": agents}
    wanted = groups.get(learn, (learn,)) if isinstance(learn, str) else tuple(learn)
    for name in wanted:
        if name not in agents:
            words = ", ".join([*groups, *agents])
            raise ConfigError(f"learn: found {name!r}, expected one of: {words}")
    if not wanted or len(set(wanted)) < len(wanted):
        raise ConfigError(f"learn: found {list(wanted)}, expected one name or more, each once")
    return tuple(name for name in agents if name in wanted)


def _team_strategy(scenario: Scenario) -> str:
    found = {one.strategy for one in scenario.pursuers}
    if len(found) > 1:
        words = ", ".join(sorted(found))
        raise ConfigError(f"{scenario.name}: pursuers.strategy: found {words}, expected one for all")
    name: str = found.pop()
    return name


def _spread(scenario: Scenario) -> float:
    e = scenario.evader.start()
    return 0.2 * min(distance(one.start(), e) for one in scenario.pursuers)
