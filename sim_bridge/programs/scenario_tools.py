"""`sim-bridge scenario new|check`: a commented template, and what a scenario promises."""

from __future__ import annotations

from math import degrees, pi
from pathlib import Path

from onboard.config.strict import ConfigError
from onboard.core.game.rules import goal_disc
from onboard.core.geometry.assessment import Assessment, Goal, assess
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.vectors import ZERO, distance
from onboard.core.safety.fence import inside
from onboard.game.go_or_no_go import engagement_of
from onboard.game.go_or_no_go import lines as odds_lines
from onboard.game.scenario import Scenario
from onboard.game.zone_words import zone_lines
from sim_bridge.plane_game.setup import conditions_of, turn_rate_of, vehicles_of
from sim_bridge.plane_game.several import alone
from sim_bridge.programs.scenario_band import band_lines
from sim_bridge.programs.scenario_knowledge import denies, knowledge_lines

TEMPLATE = """\
# A scenario of Apollonius. Metres, metres a second, degrees where a key ends in _deg.
# Positions: [north, east], or [north, east, height above the origin] in all places.
name = "my game"
seed = 1                       # of noise, wind and lost datagrams

[evader]
position = [0, 0]
speed = 5                      # what the game reckons with
target = [-60, -140]           # leave it out: the evader only flees
# targets = [[-60, -140], [90, 20]]   # in place of target: to reach any of them counts
# strategy = "paper"           # hysteresis, two-leg, dodge, evasive, straight; see sim-bridge list
# pitch_min_deg = -20          # limits (2)-(3); they enter the decision itself
# pitch_max_deg = 20

[[pursuers]]                   # as many as you like
position = [40, 30]
speed = 4

[[pursuers]]
position = [-30, -60]
speed = 4
# strategy = "parallel-pursuit"   # goalkeeper, team, paper, … (docs/rules.md)

# [[evaders]]                  # further evaders, told as [evader] is (docs/several-evaders.md)
# position = [10, 70]
# speed = 4.5
# target = [-90, 60]

[parameters]
R = 2.0                        # capture radius (6)
# rho = 4.0                    # safety distance (4); 2R where it is not given
lambda = 100.0                 # of (21)-(22)
beta = 1.0                     # of (22)
epsilon_min = 2.0              # the target counts as reached within this (5)
dt = 0.05                      # time step of plane and compiled games
horizon = 100.0                # not captured until then: escaped, or denied its target
separation = 0.0               # pursuers keep this apart (Figure 8b); 0 = off

[flight]                       # only for serve and fly
autopilot = "arducopter"       # px4, px4-plane, arducopter or arduplane
airframe = "kinematic"         # nose, slip or coordinated need arduplane
height = 50.0                  # at which a plane game is flown
ready_s = 5.0                  # from ready to the start
# ground_start = true
# prediction = "network"       # what carries tracks forward: network, ridge or constant-velocity

[flight.origin]
latitude_deg = 47.397742
longitude_deg = 8.545594
altitude_m = 488.0             # above mean sea level

[flight.sensor]                # how the players see each other
rate_hz = 10.0
sigma = 0.1                    # position noise [m]
sigma_velocity = 0.05          # [m/s]
delay_s = 0.1
dropout = 0.05                 # share of measurements lost

# [[zones]]                    # nobody flies into them: convex, 3 to 12 corners, up to 8 zones
# name = "wood"
# polygon = [[-30, -90], [-10, -110], [0, -80]]                     # north, east [m]
# centre = [60, 60]            # in its place a disc, with its radius
# radius = 15
# low = 0                      # of games in space: its heights above the origin
# high = 80

# [flight.fence]               # everybody starts within it
# polygon = [[-300, -300], [-300, 300], [300, 300], [300, -300]]    # north, east [m]
# file = "area.plan"           # in its place: QGroundControl's plan, MAVProxy's fence, KML; see gcs fence
# height_min = 20              # above the origin
# height_max = 120

[flight.impairment]            # what happens to datagrams
loss = 0.0

[flight.wind]
speed = 0.0                    # mean wind at 6 m height
from_deg = 270.0               # where it comes from
gust_sigma = 0.0               # of Dryden gusts
"""


def new(path: Path) -> str:
    """Write the template to a new file. Raises ConfigError where it exists or cannot be."""
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(TEMPLATE)
    except FileExistsError:
        raise ConfigError(f"{path}: there is a file of this name already") from None
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    return f"template written to {path}; try: sim-bridge scenario check {path}"


def check(scenario: Scenario) -> str:
    """What a scenario promises, in lines for people; of several evaders for each and its pursuers."""
    if not scenario.several:
        lines = [*_table(scenario), "", *_prospects(scenario), *knowledge_lines(scenario)]
        return "\n".join([*lines, *zone_lines(scenario), *_duration(scenario)])
    lines = [f"{scenario.name}: {len(scenario.evading)} evaders, {len(scenario.pursuers)} pursuers"]
    for one, _stem in singly(scenario, ""):
        lines += ["", *_table(one), "", *_prospects(one), *_duration(one)]
    return "\n".join([*lines, "", *zone_lines(scenario), *knowledge_lines(scenario)])


def singly(scenario: Scenario, stem: str) -> list[tuple[Scenario, str]]:
    """A scenario's games of one evader, with a name for the files of each: itself, or one an evader."""
    if not scenario.several:
        return [(scenario, stem)]
    ids = scenario.evader_ids
    return [(alone(scenario, number), f"{stem}-{id}") for number, id in enumerate(ids)]


def _table(scenario: Scenario) -> list[str]:
    """The vehicles of a game of one evader."""
    rules, target, _ = conditions_of(scenario)
    evader, *pursuers = vehicles_of(scenario)
    seen = _assessed(scenario)
    denied = denies(scenario)
    lines = [
        f"{scenario.name}: {len(pursuers)} pursuers, {'plane' if rules.planar else 'in space'}, "
        f"R = {rules.R:g} m, ρ = {rules.rho:g} m, horizon {rules.horizon:g} s",
        *([scenario.description] if scenario.description else []),
        "",
        "vehicle   role      speed    turn radius  distance  γ      half-angle  intercepts  denies target",
    ]
    for index, (id, spec) in enumerate(zip(scenario.ids, scenario.vehicles, strict=True)):
        radius = spec.speed / turn_rate_of(scenario, index)
        row = f"{id:7d}   {'pursuer' if index else 'evader':8s}  {spec.speed:4.1f} m/s  {radius:8.1f} m"
        if index:
            prospect = seen.prospects[index - 1]
            meets = f"in {prospect.time:.1f} s" if prospect.intercepts else "no"
            held = ("yes" if denied[index - 1] else "no") if target.exists else "–"
            row += (
                f"   {distance(pursuers[index - 1].position, evader.position):7.1f} m"
                f"  {spec.speed / evader.speed:5.2f}  {degrees(prospect.half_angle):8.1f}°"
                f"   {meets:>10s}  {held}"
            )
        lines.append(row)
    return lines


def _assessed(scenario: Scenario) -> Assessment:
    """What geometry says of the start of a game of one evader."""
    rules, target, _ = conditions_of(scenario)
    evader, *pursuers = vehicles_of(scenario)
    goal = Goal(target.exists, target.position, goal_disc(rules))
    return assess(evader, tuple(pursuers), rules.rho, goal, rules.planar)


def _prospects(scenario: Scenario) -> list[str]:
    """What to expect of a game of one evader."""
    return [*odds_lines(engagement_of(scenario)), *_freedom(scenario), *band_lines(scenario)]


def _freedom(scenario: Scenario) -> list[str]:
    rules = scenario.rules
    evader, *pursuers = vehicles_of(scenario)
    seen = _assessed(scenario)
    if seen.encircled:
        return [
            "free rays at the start: none, the evader is encircled. By outcome 1 of 3.4.2 it is captured;",
            "  from places drawn at random more than a quarter of such evaders are not: "
            "sim-bridge campaign study encircled",
        ]
    if rules.planar:
        gaps = ", ".join(
            f"{degrees(g.start) % 360:.0f}° to {degrees(g.start + g.width) % 360:.0f}°" for g in seen.gaps
        )
        return [f"free headings at the start: {gaps} (largest gap {degrees(seen.largest_gap):.0f}°)"]
    cones = blocked_cones(evader, tuple(pursuers), rules.rho)
    return [
        f"free rays at the start: the largest free cap has a radius of {degrees(seen.cap.radius):.1f}° "
        f"({len(cones)} cones)"
    ]


def _duration(scenario: Scenario) -> list[str]:
    """How long it will last, as far as one can say without playing it."""
    rules, target, _ = conditions_of(scenario)
    evader, *pursuers = vehicles_of(scenario)
    lines = []
    if target.exists:
        straight = distance(evader.position, target.position) / evader.speed
        lines.append(f"straight to the target: {straight:.1f} s; the game lasts at most {rules.horizon:g} s")
        if straight > rules.horizon:
            lines.append("warning: the evader cannot reach its target within the horizon, even straight")
    else:
        lines.append(f"no target: the game lasts until a capture, at most {rules.horizon:g} s")
    half_turn = pi / turn_rate_of(scenario, 0)
    lines.append(f"a half turn of the evader takes {half_turn:.1f} s")
    for index, (id, spec) in enumerate(zip(scenario.ids, scenario.vehicles, strict=True)):
        held = degrees(turn_rate_of(scenario, index))
        if held < spec.turn_rate_deg - 1e-9:
            lines.append(
                f"warning: vehicle {id} declares a turn of {spec.turn_rate_deg:g}°/s, its airframe holds"
                f" {held:g}: strategies reckon with what is declared"
            )
    faster = [p for p in pursuers if p.speed > evader.speed]
    if faster:
        least = min(distance(p.position, evader.position) / (p.speed - evader.speed) for p in faster)
        lines.append(f"{len(faster)} faster than the evader: a chase from behind ends within {least:.0f} s")
    fence = scenario.flight.fence
    if target.exists and fence is not None and not inside(*target.position[:2], fence.polygon):
        lines.append("warning: the target lies outside flight.fence, where nobody is let")
    if target.exists and distance(evader.position, target.position) <= rules.epsilon_min:
        lines.append("warning: the evader starts at its target")
    if any(distance(p.position, evader.position) <= rules.R for p in pursuers):
        lines.append("warning: a pursuer starts within the capture radius")
    if scenario.flight.airframe.value != "kinematic" and evader.position == ZERO and rules.R < 10.0:
        lines.append("warning: R below 10 m is less than what transfer-function aircraft can aim at")
    return lines
