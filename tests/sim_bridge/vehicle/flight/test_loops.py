"""The closed loops as flown: margins, steps, saturation; every figure from the kernel's own step."""

from __future__ import annotations

from collections import deque
from math import degrees, pi, radians
from pathlib import Path

import numpy as np
import pytest

from onboard.core.math.vectors import ZERO, Vec
from sim_bridge.studies.design import design, fly_step
from sim_bridge.vehicle.flight import control_toolbox as linear
from sim_bridge.vehicle.flight import loop_analysis as cut
from sim_bridge.vehicle.flight.aircraft import Aircraft, named
from sim_bridge.vehicle.flight.axis import (
    AxisLaw,
    AxisModel,
    AxisState,
    attainable,
    integrate,
    move,
    rate_asked,
    step_axis,
    surface_asked,
)
from sim_bridge.vehicle.flight.plane import Command, Steer, start_state, step_plane, trimmed
from sim_bridge.vehicle.flight.transfer import sampled

DT = 0.01


@pytest.fixture(scope="module")
def aircraft() -> Aircraft:
    return named("nose")


def axis_of(aircraft: Aircraft, axis: str) -> tuple[AxisModel, AxisLaw]:
    m = aircraft.model
    return (m.pitch, m.pitch_law) if axis == "pitch" else (m.yaw, m.yaw_law)


def ringing(model: AxisModel, law: AxisLaw, factor: float, delay: int, seconds: float = 30.0) -> float:
    """Largest angle in the last fifth of a flight after a 0.1° offset [deg]: the servo's command is
    multiplied by `factor` and comes `delay` samples late."""
    state = AxisState(0.0, 0.0, radians(0.1), 0.0, 0.0, 0.0)
    waiting = deque([0.0] * delay)
    count = int(seconds / DT)
    late = []
    for k in range(count):
        rate = rate_asked(law, -state.angle)
        asked = surface_asked(state, law, rate)
        waiting.append(factor * asked)
        given = attainable(state.surface, law, waiting.popleft())
        state = move(state, model, law, given, integrate(state, law, rate, asked, asked), 0.0, 0.0)
        if k > 0.8 * count:
            late.append(abs(degrees(state.angle)))
    return max(late)


@pytest.mark.parametrize("axis", ["pitch", "yaw"])
def test_margins_of_the_loop_as_flown(aircraft: Aircraft, axis: str) -> None:
    model, law = axis_of(aircraft, axis)
    margins = linear.margins(cut.open_loop(model, law, DT), DT)
    assert margins.gain_db >= 6.0
    assert margins.phase_deg >= 45.0


@pytest.mark.parametrize("axis", ["pitch", "yaw"])
def test_the_flown_loop_bears_its_margins_and_no_more(aircraft: Aircraft, axis: str) -> None:
    """Twice the gain, or the delay that eats 45° at the crossover: it settles. Beyond its margins not."""
    model, law = axis_of(aircraft, axis)
    margins = linear.margins(cut.open_loop(model, law, DT), DT)
    assert ringing(model, law, 2.0, 0) < 0.01
    delay = int(radians(45.0) / margins.gain_crossover / DT)
    assert delay >= 8
    assert ringing(model, law, 1.0, delay) < 0.05
    beyond = round(1.15 * margins.delay_s / DT) + 1
    assert ringing(model, law, 1.0, beyond) > 0.5
    assert ringing(model, law, 10.0 ** ((margins.gain_db + 1.0) / 20.0), 0) > 0.5


def test_a_pitch_step_of_ten_degrees(aircraft: Aircraft) -> None:
    step = fly_step(aircraft, "pitch", 10.0, 20.0)
    assert step.settling_s <= 4.0
    assert step.overshoot <= 0.15
    assert abs(step.final_error) < 1e-3


@pytest.mark.parametrize("side", [-5.0, 5.0])
def test_a_heading_step_of_thirty_degrees_under_a_constant_side_wind_through_w_z(
    aircraft: Aircraft, side: float
) -> None:
    """With the constant that (37) prints, though (35) has none: a disturbance that never goes away."""
    m = aircraft.model
    bent = sampled(aircraft.yaw._replace(wind1=(aircraft.yaw.wind1[0], -0.175)), DT)
    state = AxisState(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for _ in range(int(120.0 / DT)):
        state = step_axis(
            state, bent, m.yaw_law, rate_asked(m.yaw_law, radians(30.0) - state.angle), side, 0.0
        )
    assert degrees(state.angle) == pytest.approx(30.0, abs=1e-4)
    assert degrees(state.surface) == pytest.approx(-side * 0.175 / 0.75, abs=1e-3)  # the rudder bears it


def test_the_nose_turns_no_faster_than_the_rudder_can_hold(aircraft: Aircraft) -> None:
    step = fly_step(aircraft, "yaw", 170.0, 40.0)
    rate = np.diff(step.angle) / DT
    assert np.max(rate) <= 4.5 * 1.02
    assert rate[3500] == pytest.approx(25.0 * 0.75 / 4.2, abs=0.05)  # what 25° hold
    assert np.max(np.abs(step.surface)) <= 25.0 + 1e-9


def test_a_long_saturated_turn_does_not_wind_up(aircraft: Aircraft) -> None:
    """A third of a circle at the stop of a rudder that reaches only 12°: the turn ends almost as cleanly."""
    weak = aircraft.model.yaw_law._replace(surface_limit=radians(12.0))
    flown = fly_step(aircraft._replace(model=aircraft.model._replace(yaw_law=weak)), "yaw", 120.0, 90.0)
    assert np.mean(np.abs(flown.surface) > 11.9) > 0.3  # it was saturated
    assert 120.0 * flown.overshoot < 1.5  # [deg]
    careless = weak._replace(release=0.0)
    other = fly_step(aircraft._replace(model=aircraft.model._replace(yaw_law=careless)), "yaw", 120.0, 90.0)
    assert other.overshoot > 3.0 * flown.overshoot


def test_the_servo_obeys_its_rate_limit(aircraft: Aircraft) -> None:
    m = aircraft.model
    state = trimmed(start_state(ZERO, 0.0, 45.0, ZERO), m)
    last = 0.0
    fastest = 0.0
    for k in range(500):
        wanted = radians(25.0 if (k // 50) % 2 == 0 else -25.0)
        state = step_plane(state, m, Command(Steer.HEADING, 0.0, wanted, 45.0), ZERO, ZERO)
        fastest = max(fastest, abs(state.pitch.surface - last) / DT)
        last = state.pitch.surface
    assert degrees(fastest) <= 80.0 + 1e-6
    assert degrees(fastest) > 79.0


def test_airspeed_steps_settle_and_stay_within_the_engine(aircraft: Aircraft) -> None:
    m = aircraft.model
    state = trimmed(start_state(ZERO, 0.0, 40.0, ZERO), m)
    thrusts = []
    for _ in range(int(40.0 / DT)):
        state = step_plane(state, m, Command(Steer.HEADING, 0.0, radians(10.0), 50.0), ZERO, ZERO)
        thrusts.append(state.thrust)
        assert state.speed < 50.5
    assert state.speed == pytest.approx(50.0, abs=0.02)
    assert -4.0 <= min(thrusts) <= max(thrusts) <= 5.0


def test_the_design_report_says_what_was_measured(tmp_path: Path) -> None:
    from onboard.runtime.resources import configs

    text = design(configs() / "aircraft" / "nose.toml", tmp_path)
    assert all(word in text for word in ("phase margin", "2.682", "settled"))
    assert {path.name for path in tmp_path.iterdir()} == {"nose-bode.png", "nose-steps.png"}


def test_a_gust_pushes_the_path_only_through_its_lags(aircraft: Aircraft) -> None:
    """(35): the carried drift follows a side gust with k_β, not at once."""
    m = aircraft.model
    state = trimmed(start_state(ZERO, 0.0, 45.0, ZERO), m)
    for _ in range(600):
        state = step_plane(state, m, Command(Steer.HEADING, 0.0, 0.0, 45.0), ZERO, Vec(0.0, 3.0, 0.0))
    assert state.drift.y == pytest.approx(3.0 * (1.0 - np.exp(-1.0)), rel=0.02)
    assert abs(state.yaw.angle) < radians(0.2) < pi
