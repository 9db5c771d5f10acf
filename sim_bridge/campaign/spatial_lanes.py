"""The vehicles of a spatial game moved eight at a time: `Motion` over lanes, for the compiled game."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sim_bridge.campaign.aboard import Aboard
from sim_bridge.campaign.envelope import UNMOVED, Envelope
from sim_bridge.campaign.flight_lanes import (
    AT_AUTOPILOT,
    AT_COMMAND,
    AT_DECLARED,
    AT_ERRORS,
    AT_FILTER,
    AT_LIMITS,
    AT_REACH,
    AT_STAMP,
    AT_TOLD,
    AT_WIND,
    BLOCK,
    FILTER_WIDTH,
    FLOWN,
    MEASURED,
    WORD_BLOCK,
    Array,
    Instant,
    Limits,
    Sensing,
    Told,
    blow,
    fly_commanded,
    fly_ordered,
    hear,
    load_flown,
    load_reach,
    load_wind,
    measure,
    store_autopilot,
    store_command,
    store_errors,
    store_flown,
    store_limits,
    store_reach,
    store_told,
    store_wind,
    weather,
    widen,
)
from sim_bridge.campaign.lanes import LANES
from sim_bridge.campaign.plane_in_wind import Flown, gust_tick
from sim_bridge.campaign.spatial_game import ABOARD_ROW, Start, load_aboard, store_aboard
from sim_bridge.campaign.spatial_play import Motion
from sim_bridge.campaign.tracks import Tracks
from sim_bridge.vehicle.flight.plane import Command
from sim_bridge.vehicle.wind.estimate import Estimate

COURSE = FLOWN.leaves.index("v.plane.course") * LANES  # where it lies in a block


class InLanes(NamedTuple):
    """Vehicles that are moved eight at a time; player k is lane k mod 8 of block k div 8."""

    air: Array  # (blocks, BLOCK)
    gusts: NDArray[np.int64]  # (blocks, WORD_BLOCK)
    sensor: NDArray[np.int64]
    waiting: Array  # (slots, blocks, MEASURED * LANES)
    crew: Array  # rows of `ABOARD_ROW`
    seen: Tracks  # what the filters hold, by player: see `show`


def note_lanes(sky: InLanes, here: Array) -> None:
    """`Motion.note` over lanes, the estimates of the wind included."""
    for i in range(here.shape[0]):
        b = i // LANES
        lane = i % LANES
        for k in range(6):
            here[i, k] = sky.air[b, lane + k * LANES]
        here[i, 6] = sky.air[b, lane + AT_WIND]
        here[i, 7] = sky.air[b, lane + AT_WIND + LANES]


def watch_lanes(sky: InLanes, start: Start, sample: int, _here: Array) -> None:
    """`Motion.watch` over lanes."""
    eye = start.eye
    slots = sky.waiting.shape[0]
    sensing = Sensing(sky.air, sky.sensor, sky.waiting)
    if sample % eye.period == 0:
        number = sample // eye.period
        for b in range(sky.air.shape[0]):
            measure(sensing, number % slots, b, eye, number)
    heard = sample - eye.delay
    if heard >= 0 and heard % eye.period == 0:
        number = heard // eye.period
        for b in range(sky.air.shape[0]):
            hear(sensing, number % slots, b, eye, Instant(heard, start.fleet.evader.dt))
        show(sky)


def show(sky: InLanes) -> None:
    """Write what the filters hold where decisions read it."""
    for i in range(sky.seen.filters.shape[0]):
        b = i // LANES
        lane = i % LANES
        for k in range(FILTER_WIDTH):
            sky.seen.filters[i, k] = sky.air[b, lane + AT_FILTER + k * LANES]
        sky.seen.stamps[i] = sky.air[b, lane + AT_STAMP]


def order_lanes(sky: InLanes) -> None:
    """`Motion.order` over lanes."""
    for i in range(sky.seen.filters.shape[0]):
        aboard = load_aboard(sky.crew, i, 0)
        told = Told(aboard.altitude.value, aboard.airspeed.value, aboard.bank)
        store_told(sky.air, i // LANES, i % LANES + AT_TOLD, told)


def course_in_lane(sky: InLanes, index: int) -> float:
    """`Motion.course` over lanes."""
    return float(sky.air[index // LANES, index % LANES + COURSE])


def estimate_lanes(sky: InLanes, start: Start, here: Array) -> None:
    """`Motion.estimate` over lanes."""
    for b in range(sky.air.shape[0]):
        weather(sky.air, b, start.fleet.pursuer, start.climate)
    note_lanes(sky, here)


def blow_lanes(sky: InLanes, start: Start, sample: int) -> None:
    """The gusts' grid at a sample."""
    tick = gust_tick(sample)
    if tick >= 0:
        for b in range(sky.air.shape[0]):
            blow(sky.air, sky.gusts, b, tick, start.fleet.pursuer, start.climate)


def move_lanes(sky: InLanes, start: Start, sample: int, here: Array) -> None:
    """`Motion.move` over lanes.

    What the autopilot commands depends on no gust of the same sample, so that all gusts come first.
    """
    blow_lanes(sky, start, sample)
    for b in range(sky.air.shape[0]):
        fly_ordered(sky.air, b, start.fleet.pursuer, start.climate)
    note_lanes(sky, here)


def carry_lanes(sky: InLanes, start: Start, sample: int, here: Array) -> None:
    """`Motion.carry` over lanes."""
    blow_lanes(sky, start, sample)
    for b in range(sky.air.shape[0]):
        fly_commanded(sky.air, b, start.fleet.pursuer, start.climate)
    note_lanes(sky, here)


def put_lanes(sky: InLanes, here: Array, places: Array) -> None:
    """`Motion.put` over lanes."""
    for i in range(here.shape[0]):
        b = i // LANES
        lane = i % LANES
        for axis in range(3):
            off = places[i, axis] - here[i, axis]
            sky.air[b, lane + axis * LANES] = places[i, axis]
            sky.air[b, lane + AT_FILTER + 5 * axis * LANES] += off
            for slot in range(sky.waiting.shape[0]):
                sky.waiting[slot, b, lane + axis * LANES] += off
    show(sky)


def widen_lanes(sky: InLanes, start: Start) -> None:
    """`Motion.widen` over lanes."""
    for b in range(sky.air.shape[0]):
        widen(sky.air, b, start.fleet.pursuer)


def reach_lanes(sky: InLanes) -> Envelope:
    """`Motion.reach` over lanes: that of all players."""
    found = UNMOVED
    for i in range(sky.seen.filters.shape[0]):
        r = load_reach(sky.air, i // LANES, i % LANES + AT_REACH)
        found = Envelope(
            min(found.pitch_low, r.pitch_low),
            max(found.pitch_high, r.pitch_high),
            min(found.speed_low, r.speed_low),
            max(found.speed_high, r.speed_high),
            min(found.lowest, r.lowest),
            max(found.surface, r.surface),
        )
    return found


def moved_in_lanes() -> Motion:
    """The motion over `InLanes`."""
    return Motion(
        note_lanes, watch_lanes, order_lanes, course_in_lane, estimate_lanes, move_lanes, carry_lanes,
        put_lanes, widen_lanes, reach_lanes,
    )  # fmt: skip


def in_lanes_of(
    start: Start, players: list[Flown], level: list[Command], crew: list[Aboard], seen: Tracks
) -> InLanes:
    """The sky of `moved_in_lanes`; `level` for an approach, `crew` for a game, else empty.

    Lanes without a player repeat the last one.
    """
    count = len(players)
    blocks = -(-count // LANES)
    air = np.zeros((blocks, BLOCK))
    words = np.zeros((2, blocks, WORD_BLOCK), dtype=np.int64)
    waiting = np.zeros((seen.waiting.shape[0], blocks, MEASURED, LANES))
    for place in range(blocks * LANES):
        b, lane, i = place // LANES, place % LANES, min(place, count - 1)
        block, model = air[b], start.fleet.pursuer if i else start.fleet.evader
        store_flown(air, b, lane, players[i])
        limits = Limits(model.pitch_min, model.pitch_max, model.speed_min, model.speed_max)
        store_limits(air, b, lane + AT_LIMITS, limits)
        store_autopilot(air, b, lane + AT_AUTOPILOT, start.autopilots[i])
        store_errors(air, b, lane + AT_ERRORS, start.errors[i])
        store_reach(air, b, lane + AT_REACH, UNMOVED)
        block[lane + AT_DECLARED] = start.policies[i].envelope.speed_max
        block[lane + AT_FILTER : AT_FILTER + FILTER_WIDTH * LANES : LANES] = seen.filters[i]
        block[lane + AT_STAMP] = seen.stamps[i]
        waiting[:, b, :, lane] = seen.waiting[:, i]
        for keys, drawn in zip((start.gusts, start.eye.keys), words, strict=True):
            drawn[b, lane], drawn[b, lane + LANES] = keys[i]
        if level:
            store_command(air, b, lane + AT_COMMAND, level[i])
        if crew:
            told = Told(crew[i].altitude.value, crew[i].airspeed.value, crew[i].bank)
            store_told(air, b, lane + AT_TOLD, told)
            store_wind(air, b, lane + AT_WIND, crew[i].wind)
    rows = np.zeros((count, ABOARD_ROW))
    for i, aboard in enumerate(crew):
        store_aboard(rows, i, 0, aboard)
    flat = waiting.reshape(waiting.shape[0], blocks, MEASURED * LANES)
    return InLanes(air, words[0], words[1], flat, rows, seen)


def players_of(sky: InLanes) -> list[Flown]:
    """The aircraft of all players."""
    count = sky.seen.filters.shape[0]
    return [load_flown(sky.air, i // LANES, i % LANES) for i in range(count)]


def winds_of(sky: InLanes) -> list[Estimate]:
    """What the autopilots of all players know of the wind."""
    count = sky.seen.filters.shape[0]
    return [load_wind(sky.air, i // LANES, i % LANES + AT_WIND) for i in range(count)]


def tracks_of(sky: InLanes) -> Tracks:
    """What is under way and what the filters hold, by player."""
    count = sky.seen.filters.shape[0]
    slots, blocks, _width = sky.waiting.shape
    waiting = sky.waiting.reshape(slots, blocks, MEASURED, LANES).transpose(0, 1, 3, 2)
    rows = waiting.reshape(slots, blocks * LANES, MEASURED)[:, :count].copy()
    return Tracks(rows, sky.seen.filters.copy(), sky.seen.stamps.copy())
