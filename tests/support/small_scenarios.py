"""Scenarios of two to six vehicles: a chase that goes on, and a duel that is over within seconds."""

from __future__ import annotations

from typing import Any

from onboard.game.scenario import (
    WINGED,
    FenceSpec,
    Flight,
    ImpairmentSpec,
    Kind,
    Parameters,
    Scenario,
    VehicleSpec,
)
from onboard.pilot.predictor_choice import Predicting

EVADER, PURSUER, MATE = 1, 2, 3
HOLD = {Kind.PX4: "HOLD", Kind.ARDUCOPTER: "LOITER", Kind.ARDUPLANE: "LOITER"}
GUIDED = {Kind.PX4: "OFFBOARD", Kind.ARDUCOPTER: "GUIDED", Kind.ARDUPLANE: "GUIDED"}


def chase(
    kind: Kind = Kind.ARDUCOPTER, *, pursuers: int = 1, separation: float = 0.0, **flight: Any
) -> Scenario:
    """A chase that goes on for a minute or more: the pursuers start behind a faster evader.

    `separation` [m] is what pursuers keep from each other; 0 = nothing.
    """
    scale = 10.0 if kind in WINGED else 1.0
    places = ((-60.0, 40.0), (-60.0, -40.0), (-90.0, 0.0))
    return Scenario(
        name="chase",
        evader=VehicleSpec(position=(0.0, 0.0), speed=5.0 * scale, target=(400.0 * scale, 0.0)),
        pursuers=tuple(
            VehicleSpec(position=(x * scale, y * scale), speed=4.0 * scale) for x, y in places[:pursuers]
        ),
        parameters=Parameters(horizon=100.0, separation=separation),
        flight=Flight(autopilot=kind, height=120.0, ready_s=2.0, **flight),
    )


def lossy(loss: float) -> ImpairmentSpec:
    """Loss in both directions of every link."""
    return ImpairmentSpec(loss=loss, delay_s=0.02, jitter_s=0.02)


def fenced() -> FenceSpec:
    """A fence that the evader's way leaves."""
    square = ((-200.0, -200.0), (150.0, -200.0), (150.0, 200.0), (-200.0, 200.0))
    return FenceSpec(polygon=square, height_min=50.0, height_max=200.0)


def duel(
    kind: Kind = Kind.ARDUCOPTER, *, mates: int = 0, horizon: float = 40.0, gap: float = 45.0, **flight: Any
) -> Scenario:
    """A faster pursuer ahead of an evader that flies straight on: a capture within `gap` / 8 seconds or so.

    `mates` more pursuers come from behind, too far away to matter. Planes are ten times as fast, and loiter
    until it begins: they start farther apart, and are judged by 40 m."""
    scale, R = (10.0, 40.0) if kind in WINGED else (1.0, 2.0)
    gap = 3.0 * gap if kind in WINGED else gap
    behind = [(-80.0, 50.0), (-80.0, -50.0), (-120.0, 0.0), (-120.0, 80.0)]
    return Scenario(
        name="duel",
        evader=VehicleSpec(
            position=(0.0, 0.0), speed=4.0 * scale, target=(300.0 * scale, 0.0), strategy="straight"
        ),
        pursuers=tuple(
            VehicleSpec(position=(x * scale, y * scale), speed=5.0 * scale)
            for x, y in [(gap, 1.0), *behind[:mates]]
        ),
        parameters=Parameters(R=R, horizon=horizon),
        flight=Flight(
            autopilot=kind,
            height=150.0,
            ready_s=2.0,
            prediction=Predicting.CONSTANT_VELOCITY,
            **flight,
        ),
    )


