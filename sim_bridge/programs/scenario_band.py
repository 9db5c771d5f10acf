"""The band of a scenario's evader in words, and `sim-bridge scenario stage`: a ring that closes it."""

from __future__ import annotations

import re
from math import atan2, ceil, degrees, pi
from pathlib import Path
from typing import NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.geometry.lead import lead
from onboard.core.math.angles import wrap
from onboard.core.math.vectors import ZERO, Vec, distance, yaw_of
from onboard.core.strategy.team.closure import least_number, past, pitch_band, way_out
from onboard.core.strategy.team.parts import front_line, setting_out
from onboard.core.strategy.team.plan_types import NOBODY, Band, Member, Situation
from onboard.core.strategy.team.ring import TURNED, closing, laid
from onboard.game.scenario import Scenario, load
from sim_bridge.plane_game.setup import (
    conditions_of,
    heights_of,
    margin_of,
    nearest_of,
    turn_rate_of,
    vehicles_of,
)

WIDER = 12  # rings, each 15 % wider than the one before, that are tried
WITHOUT_BOUND = 3  # lines that are told where no bound is broken
AGES = 100_000.0  # [s] for staging without a limit of time


def situation_of(scenario: Scenario, seconds: float, nearest: float | None = None) -> Situation:
    """A scenario as its pursuers' planner sees it, `seconds` before the evader sets out, nobody lost.

    The evader stays about its place until then. The margin is the sensor's noise and delay and a control
    step; `nearest` [m] is how near the pursuers may come before t₀.
    """
    rules, target, _ = conditions_of(scenario)
    evader, *others = vehicles_of(scenario)
    team = tuple(
        Member(one, spec.limits()._replace(turn_rate=turn_rate_of(scenario, index)), True)
        for index, (one, spec) in enumerate(zip(others, scenario.pursuers, strict=True), 1)
    )
    least = nearest_of(scenario) if nearest is None else nearest
    limits = scenario.evader.limits()._replace(turn_rate=turn_rate_of(scenario, 0))
    return Situation(
        0.0,
        seconds,
        evader,
        limits,
        team,
        target,
        ZERO,
        rules,
        heights_of(scenario),
        margin_of(scenario),
        evader.position,
        least,
    )


def band_lines(scenario: Scenario) -> list[str]:
    """Whether the reachable band is closed at the start; else the widest way out, who closes it and when."""
    s = situation_of(scenario, 0.0)
    return [*_band(s, closing(s, way_out(s)), scenario.ids), *_too_few(s)]


def _reach(s: Situation) -> str:
    if s.rules.planar:
        return "band (all headings)"
    band = pitch_band(s.evader, s.evader_limits, s.heights, past(s))
    low, high = degrees(band.pitch_min), degrees(band.pitch_max)
    return f"band (all headings, pitch {low:.1f}° to {high:.1f}°)"


def _band(s: Situation, band: Band, ids: tuple[int, ...]) -> list[str]:
    where = f"at heading {degrees(band.bearing) % 360.0:.0f}°"
    if not s.rules.planar:
        where += f", pitch {degrees(band.pitch):.0f}°"
    if band.closed:
        overlap = "" if band.gap <= -pi else f", the smallest overlap is {degrees(-band.gap):.1f}° {where}"
        return [f"{_reach(s)}: closed, noise, delay and the turn of the noses allowed for{overlap}"]
    lines = [f"{_reach(s)}: open, the widest way out is {degrees(band.gap):.1f}° {where}"]
    if band.closer != NOBODY:
        lines.append(
            f"  while the evader stands the pursuers can close it in {band.closes - s.now:.0f} s; pursuer"
            f" {ids[band.closer + 1]} goes farthest"
        )
    return lines


def _too_few(s: Situation) -> list[str]:
    """The bound, where it is broken."""
    need = needed(s)
    if need == 0:
        return ["  no number of level pursuers closes the band: asin γ is below the steepest pitch"]
    if need > len(s.team):
        return [
            f"  bound: a ring of such pursuers takes {need}, here are {len(s.team)}: nothing forces a capture"
        ]
    return []


def needed(s: Situation) -> int:
    """How many pursuers like the slowest of the team a closed ring takes; 0: none suffice."""
    slowest = min(member.vehicle.speed for member in s.team)
    pitch = 0.0
    if not s.rules.planar:
        band = pitch_band(s.evader, s.evader_limits, s.heights, past(s))
        pitch = max(band.pitch_max, -band.pitch_min)
    return least_number(slowest / s.evader.speed, pitch)


class Staged(NamedTuple):
    """A scenario with its pursuers on a ring."""

    scenario: Scenario
    band: Band  # at t₀
    seconds: float  # that staging takes from the places of the file
    words: str


def staged(scenario: Scenario, seconds: float | None = None, nearest: float | None = None) -> Staged:
    """The scenario with its pursuers on the ring that closes the band at t₀, noses on parallel pursuit.

    `seconds` is the time that they have for it from where they stand in the file, None as long as it takes;
    `nearest` [m] is how near they may come. The ring is the smallest that is closed with the margin. Raises
    ConfigError, with the bound, where no such ring exists.
    """
    time = AGES if seconds is None else seconds
    s = situation_of(scenario, time, nearest)
    least = s.nearest
    for k in range(WIDER):
        found = _on_ring(scenario, situation_of(scenario, time, least * 1.15**k))
        if found.band.closed:
            return found
    first = _on_ring(scenario, s)
    lines = [
        f"{scenario.name}: no ring of {len(s.team)} pursuers closes the band"
        + ("" if seconds is None else f" in {seconds:.0f} s"),
        *_band(situation_of(first.scenario, 0.0, nearest), first.band, scenario.ids),
        *_too_few(s),
    ]
    if seconds is not None and len(lines) == WITHOUT_BOUND:
        try:
            lines.append(f"  with {ceil(staged(scenario, None, nearest).seconds):d} s they can")
        except ConfigError:
            lines.append("  nor can they with more time")
    raise ConfigError("; ".join(line.strip() for line in lines))


def _on_ring(scenario: Scenario, s: Situation) -> Staged:
    """The scenario with its pursuers on their slots, closed or not."""
    slots = laid(s)
    moved = _moved(scenario, s, slots.aims)
    takes = max(
        distance(member.vehicle.position, aim) / member.vehicle.speed + TURNED / member.limits.turn_rate
        for member, aim in zip(s.team, slots.aims, strict=True)
    )
    then = situation_of(moved, 0.0, s.nearest)
    band = closing(then, way_out(then))
    return Staged(moved, band, takes, "\n".join([*_band(then, band, scenario.ids), _ring(then, takes)]))


def _ring(s: Situation, takes: float) -> str:
    """A ring in words."""
    line = front_line(s)
    places = [member.vehicle.position for member in s.team]
    far = [distance(place, s.expected) for place in places]
    off = min(abs(wrap(atan2(p.y - s.expected.y, p.x - s.expected.x) - line)) for p in places)
    ahead = "the line to the target" if s.target.exists else "the evader's heading"
    return (
        f"{len(places)} pursuers {min(far):.0f} to {max(far):.0f} m away, one {degrees(off):.1f}° from"
        f" {ahead}, noses on parallel pursuit;\n  it takes {takes:.0f} s from the places of the file while"
        " the evader stays there"
    )


def _moved(scenario: Scenario, s: Situation, aims: list[Vec]) -> Scenario:
    """The scenario with its pursuers at their slots."""
    replace = msgspec.structs.replace
    pursuers = []
    for spec, member, aim in zip(scenario.pursuers, s.team, aims, strict=True):
        ahead = lead(aim, member.vehicle.speed, s.expected, setting_out(s))
        level = (round(aim.x, 1) + 0.0, round(aim.y, 1) + 0.0)  # no −0
        place = level if s.rules.planar else (*level, round(-aim.z, 1))
        pursuers.append(replace(spec, position=place, heading_deg=round(degrees(yaw_of(ahead)), 2) + 0.0))
    return replace(scenario, pursuers=tuple(pursuers))


def stage_file(source: Path, file: Path, seconds: float | None, nearest: float | None) -> str:
    """Write `source` to a new file with its pursuers on the ring that closes the band. Returns what was done.

    Everything else of the file stays as it is, comments too. Raises ConfigError where there is no such ring,
    where the file exists, and where a pursuer has no table with a line `position = […]` of its own.
    """
    found = staged(load(source), seconds, nearest)
    text = rewritten(source.read_text(encoding="utf-8"), found.scenario, str(source))
    try:
        with file.open("x", encoding="utf-8") as out:
            out.write(text)
    except FileExistsError:
        raise ConfigError(f"{file}: there is a file of this name already") from None
    except OSError as error:
        raise ConfigError(f"{file}: {(error.strerror or str(error)).lower()}") from None
    try:
        again = load(file)
    except ConfigError:
        file.unlink()
        raise
    if again.pursuers != found.scenario.pursuers:
        file.unlink()
        raise ConfigError(f"{source}: found pursuers written another way, expected {TABLE}")
    return f"{found.words}\nwritten to {file}; try: sim-bridge scenario check {file}"


TABLE = "a table [[pursuers]] for each, with a line position = [...] of its own"


def rewritten(text: str, scenario: Scenario, name: str) -> str:
    """A scenario file's text with the pursuers' positions and headings of `scenario`."""
    parts = re.split(r"(?m)^(?=[ \t]*\[)(?![ \t]*\[[ \t\d.+-])", text)
    number = 0
    for k, part in enumerate(parts):
        if not re.match(r"[ \t]*\[\[[ \t]*pursuers[ \t]*\]\]", part):
            continue
        lines = re.findall(r"(?m)^[ \t]*position[ \t]*=[ \t]*\[[^\]\n]*\].*$", part)
        if len(lines) != 1 or number >= len(scenario.pursuers):
            raise ConfigError(
                f"{name}: pursuers[{number}]: found no single line of its position, expected {TABLE}"
            )
        spec = scenario.pursuers[number]
        number += 1
        place = ", ".join(f"{value:.1f}" for value in spec.position)
        part = re.sub(r"(?m)^[ \t]*heading_deg[ \t]*=.*\n?", "", part)
        parts[k] = part.replace(lines[0], f"position = [{place}]\nheading_deg = {spec.heading_deg}", 1)
    if number != len(scenario.pursuers):
        raise ConfigError(f"{name}: pursuers: found {number} tables, expected {TABLE}")
    return "".join(parts)
