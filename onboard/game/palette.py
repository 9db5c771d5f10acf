"""Colours of players, places and rules: the same in reports, in the console and in every picture."""

from __future__ import annotations

from typing import NamedTuple
from zlib import crc32


class Colour(NamedTuple):
    """One colour as sRGB hexadecimal, for white paper and for a dark screen."""

    light: str  # `#rrggbb` on white
    dark: str  # `#rrggbb` on black


INK = Colour("#1c2330", "#e6e9ef")  # text
FAINT = Colour("#5c6675", "#9aa5b4")  # axes, notes
PAPER = Colour("#ffffff", "#161b22")  # behind figures and tables
GRID = Colour("#e3e7ee", "#303846")

EVADER = Colour("#d1480c", "#ff8b4d")
# Of several evaders the second, the third …: warm shades, as pursuers have none.
EVADERS = (EVADER, Colour("#b00b3c", "#ff5c80"), Colour("#c4009b", "#ff7be3"), Colour("#8a2b0e", "#e59a78"))
# Told apart by most people who do not see all colours; pursuer 2 has the first, pursuer 3 the second …
PURSUERS = (
    Colour("#0068b3", "#5ab4ff"),
    Colour("#00805c", "#3fd6a5"),
    Colour("#b04a8f", "#f08fd0"),
    Colour("#7a4b1e", "#d9a066"),
    Colour("#5b3fa8", "#a98bff"),
    Colour("#1f8a96", "#4fd0dd"),
    Colour("#882255", "#e0709f"),
    Colour("#6b7a12", "#c3d44f"),
)
TARGET = Colour("#b8860b", "#ffd54a")
CAPTURE = Colour("#2f3641", "#d5dae3")  # the capture radius R
SAFETY = Colour("#8a8a8a", "#8f8f8f")  # the safety distance ρ
FENCE = Colour("#7b8794", "#8b98a8")  # the geofence
ZONE = Colour("#9c3d36", "#d9827a")  # no-fly zones and obstacles
APOLLONIUS = Colour("#0899a8", "#3fd5e6")  # Apollonius circles
FORCE = Colour("#9467bd", "#b99be0")  # the resultant force F_res
CONE = Colour("#c47f2e", "#e8b06c")  # headings that a pursuer blocks

# Fills wide enough to need no second shade on a dark screen. Rules of routes fly apart from those of games.
RULES = {
    "free_ray_to_target": "#4477aa",
    "free_ray_from_pursuers": "#66ccee",
    "resultant_force_to_target": "#cc5544",
    "resultant_force": "#aa3377",
    "straight_to_target": "#7b9fc8",
    "straight_on": "#a0a8b4",
    "steady_ray_to_target": "#3a8fb7",
    "steady_ray_from_pursuers": "#7cc4d8",
    "two_legs": "#5566bb",
    "dodge": "#c2477f",
    "played": "#7a4fa3",
    "keep_off_mate": "#994455",
    "intercept": "#ee6677",
    "closest_approach": "#228833",
    "parallel": "#ccbb44",
    "predicted_place": "#8c6bb1",
    "straight_at_evader": "#dd8833",
    "pure_pursuit": "#e08a5a",
    "parallel_pursuit": "#5aae9a",
    "keep_goal": "#8c6d1f",
    "hold_line": "#c49a3c",
    "proportional_navigation": "#997700",
    "point_by_point": "#7a5c9e",
    "ring_slot": "#2f8f83",
    "guard_target": "#b8862b",
    "block_corridor": "#c0603a",
    "abreast": "#3f7f5f",
    "round_zone": "#d0508a",
    "leave_zone": "#a02060",
    "waypoint_near": "#4478ab",
    "astray": "#ee6678",
    "still_astray": "#994456",
    "gusty_air": "#66cbee",
    "calm_air": "#228834",
    "keep": "#a0a8b5",
    "fixed": "#7b9fc9",
}
OTHER_RULES = ("#b07aa1", "#5f9e6e", "#c7a76c", "#857aab", "#6f8f9f", "#b55d60")  # rules of plug-ins
ACTIONS = {  # of the supervisor
    "clip": Colour("#6b7480", "#9ca6b3"),
    "hold": Colour("#8c1d18", "#ff7b72"),
    "return": Colour("#4a148c", "#c08cff"),
    "land": Colour("#004d40", "#4fc7b0"),
    "end": Colour("#111111", "#fafafa"),
}


def vehicle(vehicle_id: int, evader: bool, rank: int = 0) -> Colour:
    """The colour of a vehicle: a pursuer's follows from its id on the bus, an evader's from its `rank` among
    the evaders (0: the one with the lowest id)."""
    return EVADERS[rank % len(EVADERS)] if evader else PURSUERS[(vehicle_id - 2) % len(PURSUERS)]


def rule(name: str) -> Colour:
    """The colour of a rule. A plug-in's own rule gets one that follows from its name."""
    found = RULES.get(name) or OTHER_RULES[crc32(name.encode()) % len(OTHER_RULES)]
    return Colour(found, found)


def action(name: str) -> Colour:
    """The colour of a supervisor's action."""
    return ACTIONS.get(name, ACTIONS["end"])


def every_colour() -> tuple[Colour, ...]:
    """All colours there are, each once; no two have the same light shade."""
    single = (INK, FAINT, PAPER, GRID, EVADER, TARGET, CAPTURE, SAFETY, FENCE, ZONE, APOLLONIUS, FORCE, CONE)
    rules = tuple(Colour(value, value) for value in (*RULES.values(), *OTHER_RULES))
    return (*single, *EVADERS[1:], *PURSUERS, *rules, *ACTIONS.values())
