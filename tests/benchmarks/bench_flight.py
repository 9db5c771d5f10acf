"""What an aircraft costs: interpreted beside an evader's decision, compiled beside a plain kernel."""

from __future__ import annotations

from math import radians
from time import process_time
from typing import Any

import numpy as np
import pytest

from onboard.core.game.rules import Rules, Target
from onboard.core.game.views import EvaderView
from onboard.core.geometry.cones import blocked_cones
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.evasion import evader
from sim_bridge.campaign.spatial_draw import draw, kernel_of, sky_of, spatial
from sim_bridge.vehicle.flight.aircraft import named
from sim_bridge.vehicle.flight.plane import Command, Steer, start_state, step_plane, trimmed
from tests.benchmarks import plain_aircraft, yardstick
from tests.benchmarks.yardstick import Yard


def cost(work: Any, count: int, rounds: int = 7) -> float:
    """Least CPU time of one call [s]."""
    best = 1e9
    for _ in range(rounds):
        start = process_time()
        for _ in range(count):
            work()
        best = min(best, (process_time() - start) / count)
    return best


def decision() -> Any:
    """An evader's decision in space against five pursuers, its direct way blocked."""
    own = Vehicle(ZERO, Vec(50.0, 0.0, 0.0), 50.0)
    places = [(2000, 100, 50), (2500, 900, -100), (1800, -900, 30), (2200, 300, 400), (2600, -300, -300)]
    others = tuple(Vehicle(Vec(*map(float, p)), Vec(-40.0, 0.0, 0.0), 40.0) for p in places)
    limits = VehicleLimits(40.0, 50.0, radians(-20), radians(20))
    target, rules = Vec(6000.0, 0.0, 0.0), Rules(25.0, 88.0)

    def work() -> object:
        view = EvaderView(
            own, limits, others, blocked_cones(own, others, rules.rho), Target(True, target), rules,
            (0.0,) * len(others),
        )
        return evader(view)

    return work


@pytest.mark.parametrize("name", ["nose", "slip", "coordinated"])
def test_a_step_of_an_aircraft_beside_an_evader_s_decision(name: str) -> None:
    model = named(name).model
    state = trimmed(start_state(Vec(0.0, 0.0, -500.0), 0.1, 45.0, ZERO), model)
    command = Command(Steer.COURSE, 1.0, 0.1, 45.0)
    wind, gust = Vec(3.0, -4.0, 0.0), Vec(1.0, 2.0, -1.0)
    step = cost(lambda: step_plane(state, model, command, wind, gust), 2000)
    decide = cost(decision(), 500)
    print(f"\n{name}: a step {1e6 * step:.1f} us, an evader's decision {1e6 * decide:.1f} us")
    yardstick.cost(f"aircraft's step, {name}", step)
    assert step < decide


def flat(value: Any) -> list[float]:
    return [x for part in value for x in flat(part)] if isinstance(value, tuple) else [float(value)]


def test_the_compiled_game_of_six_aircraft_beside_a_plain_kernel() -> None:
    scenario = spatial("five")
    sides = draw(scenario, 1).sides
    compiled = kernel_of(sides.evaders, sides.pursuers, True)
    count = 2000  # control steps of both

    def ours() -> float:
        d = draw(scenario, 1)
        conditions = d.start.conditions
        rules = conditions.rules._replace(R=0.0, epsilon_min=0.0, horizon=count * conditions.control.dt)
        endless = d.start._replace(conditions=conditions._replace(rules=rules))
        log = np.zeros((d.steps, 6, 6))
        sky = sky_of(d, True)
        start = process_time()
        found = compiled(endless, d.sides.chosen, sky, log)
        spent = process_time() - start
        assert found.steps == count
        return spent

    def theirs() -> float:
        d = draw(scenario, 1)
        game, rng = d.start, np.random.default_rng(1)
        gusts, tracks = rng.standard_normal((5 * count, 6, 5)), rng.standard_normal((count + 8, 6, 6))
        m, goal = game.fleet.evader, game.conditions.target.position
        state = np.zeros((6, 29))
        for index, flown in enumerate(d.players):
            p = flown.plane
            state[index] = [
                *p.position, *p.velocity, p.speed, p.thrust, p.thrust_integral, *p.pitch, *p.yaw, *p.drift,
                *flown.gusts,
            ]  # fmt: skip
        s = m.speed
        speeds = (
            s.gain, s.integral_gain, s.acceleration_min, s.acceleration_max, s.lag, s.lead, s.drag, s.gravity,
            s.trim,
        )  # fmt: skip
        c, f = game.climate, m.follow
        wind = np.array([*c.reference, c.axis_x, c.axis_y, f.carry_along, f.carry_across, f.carry_up])
        declared = np.array([50.0] + [40.0] * 5)
        arrays = [np.array(flat(x)) for x in (m.pitch, m.yaw, m.pitch_law, m.yaw_law)]
        start = process_time()
        plain_aircraft.play(
            state, *arrays, speeds, declared, wind, c.sigma, gusts, tracks,
            np.array([3.5, 1.0]), np.array(goal), game.conditions.rules.rho, count, radians(20.0),
        )  # fmt: skip
        spent = process_time() - start
        assert np.all(np.isfinite(state))
        assert np.ptp(state[:, 0]) > 100.0
        return spent

    ours()
    theirs()
    fast, plain = (min(work() for _ in range(9)) for work in (ours, theirs))
    steps = 5 * count
    print(
        f"\nsix aircraft in wind at 100 Hz: compiled {steps / fast / 1e3:.0f} k game steps a CPU-second,"
        f" plain kernel {steps / plain / 1e3:.0f} k, ratio {plain / fast:.2f}"
    )
    yardstick.cost("compiled game step of six aircraft", fast / steps, Yard.COMPILED)
    assert plain / fast >= 0.1  # ours also filters the tracks, supervises, and draws its own numbers
