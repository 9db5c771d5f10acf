"""A place that stands still while velocity covers a way: running sums find what the sums of windows find."""

from __future__ import annotations

from math import cos, hypot, radians, sin

import numpy as np
import pytest

from onboard.autopilot.plausibility import GAP, LEAST, METRES, MOVED, STILL, WINDOW, Track
from onboard.core.math.vectors import Vec
from onboard.wire.mavlink.values import GlobalPosition

LATITUDE, LONGITUDE = 47.4, 8.5


def flight(rng: np.random.Generator, samples: int) -> list[GlobalPosition]:
    """Turns at some speed; now and then the place stands still, or creeps, while velocity runs on."""
    found, north, east, at = [], 0.0, 0.0, 10.0
    speed, course, share = float(rng.uniform(0.5, 25.0)), 0.0, 1.0
    for _ in range(samples):
        dt = float(rng.choice([0.05, 0.1, 0.2]))
        at += dt
        course += float(rng.normal(0.0, 0.1))
        if rng.random() < 0.05:
            share = float(rng.choice([1.0, 1.0, 0.0, 0.05, 0.15, 0.5]))
        velocity = Vec(speed * cos(course), speed * sin(course), 0.0)
        north += share * velocity.x * dt + float(rng.normal(0.0, 0.01))
        east += share * velocity.y * dt + float(rng.normal(0.0, 0.01))
        place = (LATITUDE + north / METRES, LONGITUDE + east / (METRES * cos(radians(LATITUDE))))
        found.append(GlobalPosition(at, *place, 100.0, 50.0, velocity))
    return found


def frozen(said: list[GlobalPosition]) -> bool | None:
    """By the definition, over every window that ends with the last of these; None: a hair's breadth."""
    last, north, east, verdict = said[-1], 0.0, 0.0, False
    for before, after in zip(said[-2::-1], said[:0:-1], strict=True):
        dt = after.time_boot_s - before.time_boot_s
        north += 0.5 * (before.velocity.x + after.velocity.x) * dt
        east += 0.5 * (before.velocity.y + after.velocity.y) * dt
        if last.time_boot_s - before.time_boot_s < LEAST:
            continue
        moved = hypot(
            (last.latitude_deg - before.latitude_deg) * METRES,
            (last.longitude_deg - before.longitude_deg) * METRES * cos(radians(LATITUDE)),
        )
        covered = hypot(north, east)
        if abs(moved - STILL * covered) < 1e-4 or abs(covered - MOVED) < 1e-6:
            return None
        verdict = verdict or (covered >= MOVED and moved < STILL * covered)
    return verdict


@pytest.mark.parametrize("seed", range(12))
def test_running_sums_find_what_the_sums_of_all_windows_find(seed: int) -> None:
    said, track, kept = flight(np.random.default_rng(seed), 400), Track(), list[GlobalPosition]()
    seen = {True: 0, False: 0}
    for place in said:
        fault = track.fault(place.time_boot_s, place)
        if fault == "position_jump":
            continue
        if kept and place.time_boot_s - kept[-1].time_boot_s > GAP:
            kept = []
        kept.append(place)
        while len(kept) > 2 and place.time_boot_s - kept[1].time_boot_s >= WINDOW:
            del kept[0]
        expected = frozen(kept) if len(kept) > 1 else False
        if expected is not None:
            assert (fault == "position_frozen") is expected
            seen[expected] += 1
    assert seen[False] > 50
    assert seed or seen[True] > 5
