"""Why an evader was not captured: the moment from which nobody could still have met it on the way it flew.

At an instant t a pursuer at p can be at any place within v_p (s − t) of p at a later s, and nowhere else,
however it flies. So it can still capture the evader on the way that it flew iff, for some later s of the
game, v_p (s − t) + R ≥ |e(s) − p(t)|. What it flies meanwhile cannot make that true again: the reach shrinks.
The last instant at which it holds for anybody is the moment that was missed. All of it in the moving air.
"""

from __future__ import annotations

from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.core.geometry.assessment import gaps, largest_free_cap
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.states import Vehicle
from onboard.core.math.vectors import ZERO, Vec

Array = NDArray[np.float64]
MOST = 400  # instants that are looked at


class Ways(NamedTuple):
    """How a game was flown, at n instants of its play, in the frame of the air."""

    t: Array  # (n,) [s], rising
    evader: Array  # (n, 3) [m; NED]
    pursuers: Array  # (k, n, 3)
    speeds: Array  # (k,) of the pursuers [m/s; air]
    speed: float  # of the evader [m/s; air]
    R: float  # capture radius [m]
    planar: bool  # heights do not count


class Missed(NamedTuple):
    """The moment from which nobody could have met the evader on the way it flew."""

    t: float  # [s]; the start of the game where nobody ever could
    who: int  # the pursuer that could last, −1 = nobody ever
    when: float  # [s] it could have met the evader then
    place: Array  # (3,) and there
    spare: Array  # (n, k) [m] by which each could still reach the way; negative: not any more
    instants: Array  # (n,) [s] of `spare`
    open_since: float  # [s] a ray safe from everybody existed from here to the end; NaN: not even at the end
    gap: float  # [rad] the widest way out then: in space the angle across the largest free cap


def thinned(ways: Ways) -> Ways:
    """At most MOST instants, the last one among them."""
    n = len(ways.t)
    if n <= MOST:
        return ways
    keep = np.unique(np.linspace(0, n - 1, MOST).round().astype(int))
    return ways._replace(t=ways.t[keep], evader=ways.evader[keep], pursuers=ways.pursuers[:, keep])


def spare(ways: Ways) -> tuple[Array, NDArray[np.int64]]:
    """(n, k): by how much [m] each pursuer could still reach the rest of the evader's way, and at which later
    instant by most."""
    e = ways.evader
    n, k = len(ways.t), len(ways.pursuers)
    found, best = np.empty((n, k)), np.empty((n, k), np.int64)
    for j in range(n):
        later = ways.t[j:] - ways.t[j]
        for i in range(k):
            room = ways.speeds[i] * later + ways.R - np.linalg.norm(e[j:] - ways.pursuers[i, j], axis=1)
            best[j, i] = j + int(room.argmax())
            found[j, i] = room.max()
    return found, best


def missed(ways: Ways) -> Missed:
    """When the game was lost on by the pursuers. There must be two instants and a pursuer."""
    ways = thinned(ways)
    if ways.planar:
        flat = np.array([1.0, 1.0, 0.0])
        ways = ways._replace(evader=ways.evader * flat, pursuers=ways.pursuers * flat)
    room, best = spare(ways)
    most = room.max(axis=1)
    could = np.flatnonzero(most >= 0.0)
    since, gap = open_since(ways)
    if not len(could):
        return Missed(float(ways.t[0]), -1, float("nan"), ways.evader[0], room, ways.t, since, gap)
    last = int(could[-1])
    who = int(room[last].argmax())
    t = float(ways.t[last])
    if last + 1 < len(ways.t):  # between the two instants the reach runs out
        share = most[last] / (most[last] - most[last + 1])
        t += float(share * (ways.t[last + 1] - ways.t[last]))
    then = int(best[last, who])
    return Missed(t, who, float(ways.t[then]), ways.evader[then], room, ways.t, since, gap)


def open_since(ways: Ways) -> tuple[float, float]:
    """Since when, to the end, a ray was safe from everybody whatever they do, and the way out then [rad]."""
    since, width = float("nan"), 0.0
    for j in range(len(ways.t) - 1, -1, -1):
        wide = way_out(ways, j)
        if wide <= 0.0:
            break
        since, width = float(ways.t[j]), wide
    return since, width


def way_out(ways: Ways, j: int) -> float:
    """The widest gap between the pursuers' cones at instant j [rad]; 0 where every ray is blocked."""
    evader = Vehicle(Vec(*ways.evader[j].tolist()), ZERO, ways.speed)
    team = tuple(
        Vehicle(Vec(*place[j].tolist()), ZERO, float(speed))
        for place, speed in zip(ways.pursuers, ways.speeds, strict=True)
    )
    cones = blocked_cones(evader, team, ways.R)
    if ways.planar:
        return max((gap.width for gap in gaps(cones)), default=0.0)
    return min(2.0 * pi, 2.0 * largest_free_cap(cones).radius)


def in_words(found: Missed, ids: tuple[int, ...], clock: str = "s") -> str:
    """The moment for people; `ids` are the pursuers' in their order."""
    if found.who < 0:
        said = "From the start nobody could have met the evader on the way it flew."
    else:
        said = (
            f"Until {found.t:.1f} {clock} pursuer {ids[found.who]} could still have met the evader on the way"
            f" it flew, at {found.when:.1f} {clock}; from then on nobody could, however they flew."
        )
    if np.isnan(found.open_since):
        return f"{said} At the end every ray of the evader was blocked."
    wide = np.degrees(found.gap)
    return (
        f"{said} From {found.open_since:.1f} {clock} to the end there was a ray, in a way out {wide:.0f}°"
        " wide at first, on which nothing could have forced a capture."
    )
