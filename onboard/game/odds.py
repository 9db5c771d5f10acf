"""Go or no-go before an engagement: can this team win from here, how likely, and what would change it.

What geometry says comes first: the bound on the number, and whether the band is closed. Then a table says how
such games went: a logistic fit of many compiled games over what describes a start, made by
`python -m sim_bridge.campaign.odds` and kept in odds.json with the hash of what it was made from.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from math import atan2, cos, degrees, exp, log, pi, sin, sqrt
from typing import NamedTuple

import msgspec

from onboard.core.game.rules import Rules, Target
from onboard.core.game.views import level
from onboard.core.geometry.chauffeur import sure_radius
from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.vectors import ZERO, Vec, along, distance, sub, unit, yaw_of
from onboard.core.strategy.team.closure import least_number, past, pitch_band, sight_cone, way_out
from onboard.core.strategy.team.parts import front_line, setting_out
from onboard.core.strategy.team.plan_types import Heights, Margin, Member, Situation, nearest_staged
from onboard.core.strategy.team.ring import laid

NAMES = (
    "one", "gap", "gap squared", "closed", "cover", "front", "facing", "spare", "spare squared", "near",
    "far", "spread", "noses", "noses squared",
)  # fmt: skip
"""What describes a start, in the order of the fit."""

STAGING_S = 40.0  # that is tried as a change [s]
GO = 0.5  # the chance of capture from which on an engagement is worth it
Z = 1.96  # of a 95 % interval
DELAY = 0.15  # [s] of a track and a control step in space
OTHER = 0.25  # share by which an evader may turn and climb otherwise than the table's
BEYOND = 0.1  # share of a range of the table by which a start may lie outside it


class Outcome(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The fit of one outcome: the weights of the standardised features, and how sure they are."""

    weights: tuple[float, ...]
    covariance: tuple[tuple[float, ...], ...]


class Sheet(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The games of one kind (plane, or aircraft in space)."""

    command: str  # that made it
    sources: str  # hash of what the games were played by
    games: int  # of each evader
    sizes: tuple[int, int]  # pursuers, least and most
    turn: float  # radius of the evader's tightest turn, in safety distances; 0: it turns at once
    pitch: float  # [rad] its steepest
    low: tuple[float, ...]  # least of each feature
    high: tuple[float, ...]
    mean: tuple[float, ...]
    deviation: tuple[float, ...]
    fits: dict[str, dict[str, Outcome]]  # by evader's strategy and outcome; "arrived" of games not captured


class Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """odds.json."""

    pursuers: str  # their strategy
    sheets: dict[str, Sheet]  # plane, space


class Estimate(NamedTuple):
    """A probability and its 95 % interval, of the fit alone."""

    p: float
    low: float
    high: float


class Chances(NamedTuple):
    """How such games end."""

    captured: Estimate
    arrived: Estimate


class Change(NamedTuple):
    """Something that could be done, and what it would make of the chances."""

    words: str
    captured: Estimate


class Odds(NamedTuple):
    """The answer."""

    needed: int  # pursuers of a closed ring at least; 0 = no number suffices
    closed: bool  # the band, with the margin of noise, delay and turns
    gap: float  # [rad] of the widest way out; negative: the smallest overlap
    chances: dict[str, Chances]  # by the evader's strategy; empty where the table does not reach
    beyond: str  # why it does not reach; "" = it does
    changes: tuple[Change, ...]  # against the evader of the paper


def engagement(
    evader: Member, team: tuple[Member, ...], target: Target, rules: Rules, heights: Heights, sigma: float
) -> Situation:
    """The situation now, as the table's games are described: in the plane without noise, delay and turns, as
    its simple motion has them; in space with DELAY and the tracks' `sigma` [m]."""
    if rules.planar and all(member.vehicle.speed < evader.vehicle.speed for member in team):
        evader, team = _free(evader), tuple(_free(member) for member in team)
        target = target._replace(position=level(target.position, True))
    margin = Margin() if rules.planar else Margin(DELAY, sigma)
    own = evader.vehicle
    return Situation(
        0.0, 0.0, own, evader.limits, team, target, ZERO, rules, heights, margin, own.position, 0.0
    )


def _free(member: Member) -> Member:
    """As the plane's simple motion has it: level, turning at once."""
    own = member.vehicle
    flat = own._replace(position=level(own.position, True), velocity=level(own.velocity, True))
    return member._replace(vehicle=flat, limits=member.limits._replace(turn_rate=0.0))


@cache
def table() -> Table:
    """The shipped table."""
    return msgspec.json.decode((files("onboard.game") / "odds.json").read_bytes(), type=Table)


def features(s: Situation) -> tuple[float, ...]:
    """What describes a start with a target, in the order of `NAMES`. Lengths count as ratios alone."""
    e, target = s.evader, s.target.position
    way = way_out(s)
    gap = min(way.gap, 2.0 * pi)
    team = [member.vehicle for member in s.team if member.fit]
    far = [max(distance(one.position, e.position), 1e-3) for one in team]
    goal = max(distance(target, e.position), 1e-3)
    line = atan2(target.y - e.position.y, target.x - e.position.x)
    steepest = 0.0
    if not s.rules.planar:
        band = pitch_band(e, s.evader_limits, s.heights, past(s))
        steepest = max(band.pitch_max, -band.pitch_min)
    cover = sum(sight_cone(one.speed / e.speed, steepest) for one in team) / pi - 1.0
    front = min(
        abs(wrap(atan2(p.position.y - e.position.y, p.position.x - e.position.x) - line)) for p in team
    )
    facing = 0.0 if way.closed else max(0.0, gap) * cos(wrap(way.bearing - line))
    spare = max(goal / e.speed - distance(one.position, target) / one.speed for one in team) * e.speed / goal
    spare = max(-3.0, min(1.0, spare))
    mean = exp(sum(log(d) for d in far) / len(far))
    noses = sum(_off_course(member, s) for member in s.team if member.fit) / len(team)
    return (
        1.0, gap, gap * gap, 1.0 if way.closed else 0.0, cover, front, facing, spare, spare * spare,
        log(min(far) / s.rules.rho), log(goal / mean), log(max(far) / min(far)), noses, noses * noses,
    )  # fmt: skip


def _off_course(member: Member, s: Situation) -> float:
    """How far a member's nose is from the heading of parallel pursuit [rad]; 0 for who turns at once."""
    if member.limits.turn_rate <= 0.0:
        return 0.0
    own = member.vehicle
    return abs(wrap(yaw_of(own.velocity) - _nose(own.position, own.speed, s)))


def _nose(place: Vec, speed: float, s: Situation) -> float:
    """The heading of parallel pursuit from a place [rad]."""
    return yaw_of(lead(place, speed, s.evader.position, setting_out(s)))


def sheet_of(s: Situation) -> Sheet | None:
    """The games that are like this one, if there are any in the table."""
    return table().sheets.get("plane" if s.rules.planar else "space")


def manners(s: Situation) -> tuple[float, float]:
    """The evader's `turn` and `pitch`, as a sheet has them."""
    limits, speed = s.evader_limits, s.evader.speed
    turn = speed / (limits.turn_rate * s.rules.rho) if limits.turn_rate > 0.0 else 0.0
    steepest = 0.0 if s.rules.planar else min(0.5 * pi, max(limits.pitch_max, -limits.pitch_min))
    return turn, steepest


def outside(s: Situation, sheet: Sheet) -> str:
    """Why the table says nothing of a start; "" where it does."""
    count, (fewest, most) = sum(member.fit for member in s.team), sheet.sizes
    if not fewest <= count <= most:
        return f"pursuers: found {count}, the table's games have {fewest} to {most}"
    for name, found, meant in zip(("turn", "pitch"), manners(s), (sheet.turn, sheet.pitch), strict=True):
        if abs(found - meant) > OTHER * meant:
            return f"the evader's {name}: found {found:.2f}, the table's games have {meant:.2f}"
    for name, x, low, high in zip(NAMES, features(s), sheet.low, sheet.high, strict=True):
        room = BEYOND * (high - low) + 1e-9
        if not low - room <= x <= high + room:
            return f"{name}: found {x:.2f}, the table's games have {low:.2f} to {high:.2f}"
    return ""


def estimate(sheet: Sheet, fit: Outcome, x: tuple[float, ...]) -> Estimate:
    """The probability of an outcome."""
    z = [x[0], *((v - m) / d for v, m, d in zip(x[1:], sheet.mean[1:], sheet.deviation[1:], strict=True))]
    level = sum(w * v for w, v in zip(fit.weights, z, strict=True))
    spread = sum(a * c * b for a, row in zip(z, fit.covariance, strict=True)
                 for c, b in zip(row, z, strict=True))  # fmt: skip
    wide = Z * sqrt(max(0.0, spread))
    return Estimate(_share(level), _share(level - wide), _share(level + wide))


def _share(level: float) -> float:
    return 1.0 / (1.0 + exp(-level)) if level > -500.0 else 0.0


def chances(s: Situation, evader: str) -> Chances | None:
    """How games from such starts ended against an evader's strategy; None where the table does not reach."""
    sheet = sheet_of(s)
    if sheet is None or not s.target.exists or outside(s, sheet):
        return None
    return said_of(sheet, evader, features(s))


def said_of(sheet: Sheet, evader: str, x: tuple[float, ...]) -> Chances:
    """What a sheet says of a start with the features `x` against an evader's strategy."""
    fits = sheet.fits[evader]
    captured, arrived = estimate(sheet, fits["captured"], x), estimate(sheet, fits["arrived"], x)
    return Chances(captured, of_the_rest(captured, arrived))


def of_the_rest(captured: Estimate, arrived: Estimate) -> Estimate:
    """The chance of arrival, of that among games without a capture: both together are 1 at most."""
    return Estimate(
        (1.0 - captured.p) * arrived.p,
        (1.0 - captured.high) * arrived.low,
        (1.0 - captured.low) * arrived.high,
    )


def one_each(evaders: int, targets: int) -> str:
    """Why the table says nothing of so many evaders, of which one has so many targets; "": it may."""
    if evaders > 1:
        return f"evaders: found {evaders}, the table's games have 1"
    return f"targets: found {targets}, the table's games have 1" if targets > 1 else ""


def odds(s: Situation, *, changes: bool = True, beyond: str = "") -> Odds:
    """Bound, band, table, and with `changes` what would change it; the table says nothing where it is known
    to be `beyond` it. There must be a pursuer that is fit."""
    way = way_out(s)
    slowest = min(member.vehicle.speed for member in s.team if member.fit)
    pitch = 0.0
    if not s.rules.planar:
        band = pitch_band(s.evader, s.evader_limits, s.heights, past(s))
        pitch = max(band.pitch_max, -band.pitch_min)
    need = least_number(slowest / s.evader.speed, pitch)
    sheet = sheet_of(s)
    beyond = beyond or _beyond(s, sheet, slowest)
    found: dict[str, Chances] = {}
    tried: list[Change] = []
    if not beyond and sheet is not None:
        for name in sheet.fits:
            one = chances(s, name)
            if one is not None:
                found[name] = one
        for words, other in changed(s) if changes else ():
            then = chances(other, next(iter(sheet.fits)))
            if then is not None:
                tried.append(Change(words, then.captured))
    return Odds(need, way.closed, way.gap, found, beyond, tuple(tried))


def _beyond(s: Situation, sheet: Sheet | None, slowest: float) -> str:
    """Why the table does not reach a situation; "" where it does."""
    if slowest >= s.evader.speed:
        return "a pursuer is as fast as the evader: the table's are slower"
    if not s.target.exists:
        return "no target: the table's games have one"
    return "no games of this kind" if sheet is None else outside(s, sheet)


def judgement(found: Odds, count: int) -> str:
    """Go, no-go or open, against the evader of the paper: by the interval of the chance of capture of `count`
    pursuers; where the table says nothing by the bound, and by the band. Where the bound forbids a forced
    capture no chance is a go."""
    if not found.chances:
        too_few = found.needed == 0 or found.needed > count
        return "go" if found.closed else "no-go" if too_few else "unknown"
    p = next(iter(found.chances.values())).captured
    forced = found.closed or 0 < found.needed <= count
    return "go" if p.low >= GO and forced else "no-go" if p.high < GO else "open"


def headline(s: Situation, found: Odds) -> tuple[str, str]:
    """The word (go, no-go, open, unknown), and why: the bound, and the band."""
    count = sum(member.fit for member in s.team)
    fast = [member for member in s.team if member.fit and member.vehicle.speed > s.evader.speed]
    if fast:
        sure = min(sure_radius(s.evader.speed, one.vehicle.speed, one.limits.turn_rate) for one in fast)
        safe = "above" if sure < s.rules.R else "not above"
        bound = (
            f"bound: R = {s.rules.R:g} m is {safe} the {sure:.1f} m with which one pursuer captures an evader"
            " that turns at once (the homicidal chauffeur)"
        )
        return "go" if sure < s.rules.R else "open", bound
    if found.needed > count:
        bound = f"bound: {found.needed} such pursuers at least force a capture, here are {count}"
    elif found.needed == 0:
        bound = "bound: no number of level pursuers closes the band"
    else:
        bound = f"bound: {count} pursuers suffice, {found.needed} are needed at least"
    band = "closed" if found.closed else f"open, the widest way out is {degrees(max(0.0, found.gap)):.0f}°"
    return judgement(found, count), f"{bound}; the band is {band}"


def changed(s: Situation) -> list[tuple[str, Situation]]:
    """Situations that could be had instead, in words."""
    fit = [member for member in s.team if member.fit]
    way = way_out(s)
    e = s.evader.position
    mean = sum(distance(member.vehicle.position, e) for member in fit) / len(fit)
    place = Vec(e.x + mean * cos(way.bearing), e.y + mean * sin(way.bearing), e.z)
    more = _moved(fit[0], s, place)
    radius = nearest_staged(s.rules)
    where = f"{degrees(way.bearing) % 360.0:.0f}°"
    return [
        (f"one more pursuer at heading {where}, {mean:.0f} m away", s._replace(team=(*s.team, more))),
        (f"{STAGING_S:.0f} s of staging before the evader moves", staged(s, STAGING_S)),
        (f"a ring of {radius:.0f} m, one on the line to the target", ringed(s, radius)),
    ]


def staged(s: Situation, seconds: float) -> Situation:
    """The situation with its pursuers as far towards the slots of the best ring as `seconds` bring them,
    while the evader stays about its place."""
    later = s._replace(t0=s.now + seconds, expected=s.evader.position, nearest=nearest_staged(s.rules))
    places = [_towards(member, aim, seconds) for member, aim in zip(s.team, laid(later).aims, strict=True)]
    return s._replace(team=tuple(_moved(one, s, place) for one, place in zip(s.team, places, strict=True)))


def ringed(s: Situation, radius: float, phase: float = 0.0) -> Situation:
    """The situation with those who are fit on an even ring of `radius` [m], its first member `phase` [rad]
    from the line to the target."""
    fit = [member for member in s.team if member.fit]
    e, first = s.evader.position, front_line(s) + phase
    bearings = [first + 2.0 * pi * k / len(fit) for k in range(len(fit))]
    places = [Vec(e.x + radius * cos(a), e.y + radius * sin(a), e.z) for a in bearings]
    return s._replace(team=tuple(_moved(one, s, place) for one, place in zip(fit, places, strict=True)))


def _towards(member: Member, aim: Vec, time: float) -> Vec:
    own = member.vehicle
    reach = own.speed * time
    if distance(own.position, aim) <= reach:
        return aim
    return along(own.position, unit(sub(aim, own.position), Vec(1.0, 0.0, 0.0)), reach)


def _moved(member: Member, s: Situation, place: Vec) -> Member:
    """A member at another place, its nose on parallel pursuit."""
    own = member.vehicle
    yaw = _nose(place, own.speed, s)
    velocity = Vec(own.speed * cos(yaw), own.speed * sin(yaw), 0.0)
    return member._replace(vehicle=own._replace(position=place, velocity=velocity), fit=True)
