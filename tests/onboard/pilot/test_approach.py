"""Planes on their way to where a game begins: there at t₀, in strong wind and gusts, and within their limits.

The aircraft, its autopilot, gusts and the estimate of the wind are the simulation's; wind, place and heading
are drawn. What gusts do in the last few seconds nobody makes up for: their drift of up to some 3 m/s, met
three seconds late.
"""

from __future__ import annotations

from math import ceil, cos, degrees, hypot, pi, radians, sin
from typing import NamedTuple

import msgspec
import numpy as np
import pytest

from onboard.agent.core.to_place import by_itself, circling
from onboard.core.math.angles import wrap
from onboard.core.math.states import VehicleLimits
from onboard.core.math.vectors import ZERO, Vec, norm, sub
from onboard.core.safety.policy import Cause, Envelope, Policy
from onboard.core.safety.supervisor import Before, Flying, allow
from onboard.game.scenario import WindSpec
from onboard.pilot.approach import Approach, Place, through
from onboard.pilot.setup import Own
from sim_bridge.campaign.aboard import Aboard, Instant, autopilot_of, boarded, commanded, ordered
from sim_bridge.campaign.plane_in_wind import (
    Climate,
    Flown,
    blown,
    climate_of,
    fly,
    gust_at,
    gust_tick,
    launched,
    wind_at,
)
from sim_bridge.draws import Purpose, key_of
from sim_bridge.vehicle.flight.aircraft import named, within
from sim_bridge.vehicle.flight.plane import nose_yaw, start_state, trimmed, true_airspeed
from sim_bridge.vehicle.wind.dryden import gust_noise
from sim_bridge.vehicle.wind.estimate import ARDUPILOT, Sensed, begun, drawn_errors, estimated, wind_of

HEIGHT = 1500.0
TURN_RATE = radians(4.5)
LATE_S = 0.2  # that nobody waits for
LONGEST = 45_000  # samples of 10 ms


class Passed(NamedTuple):
    """How a place was passed."""

    away: float  # [m], as seen from above
    height: float  # [m]
    heading: float  # [rad]
    airspeed: float  # [m/s]
    clips: int  # commands that the supervisor changed


def envelope_of(speed: float, slow: float) -> Envelope:
    """The paper's aircraft."""
    climb = speed * sin(radians(20.0))
    return Envelope(
        hovers=False, speed_min=slow, speed_max=speed, climb_max=climb, sink_max=climb, turn_rate=TURN_RATE,
        turn_radius=speed / TURN_RATE,
    )  # fmt: skip


class Way:
    """One aircraft `nose` led to a place, from somewhere near it."""

    def __init__(self, seed: int, speed: float, wind: WindSpec) -> None:
        draw = np.random.default_rng(seed)
        limits = VehicleLimits(
            pitch_min=-radians(20.0), pitch_max=radians(20.0), speed_min=0.8 * speed, speed_max=speed
        )
        self.speed, self.heading = speed, float(draw.uniform(-pi, pi))
        self.model = within(named("nose").model, limits)
        self.policy = Policy(envelope=envelope_of(speed, 0.8 * speed))
        self.autopilot = autopilot_of(limits, speed, TURN_RATE)
        self.climate: Climate = climate_of(wind)
        self.gusts = key_of(seed, 1, Purpose.GUST)
        r, b, course = draw.uniform(500.0, 1300.0), draw.uniform(-pi, pi), draw.uniform(-pi, pi)
        here = Vec(r * cos(b), r * sin(b), -HEIGHT)
        air = wind_at(self.climate, here)
        self.flown: Flown = launched(
            trimmed(start_state(here, course, speed, air), self.model), gust_noise(self.gusts, 0)
        )
        self.errors = drawn_errors(key_of(seed, 1, Purpose.WIND))
        self.estimate = begun(air, self.errors)
        level = sub(self.flown.plane.velocity, air)
        self.aboard: Aboard = boarded(level, -0.05, HEIGHT, speed, self.estimate)
        place = Place(Vec(0.0, 0.0, -HEIGHT), self.heading, speed, 1.05 * 0.8 * speed, self.policy.envelope)
        self.approach, self.clips, self.led = Approach(place), 0, False

    def own(self, flown: Flown) -> Own:
        return Own(flown.plane.position, flown.plane.velocity, wind_of(self.estimate))

    def passed(self) -> Passed:
        """Fly until t₀, which is put off as a master does."""
        before, k = self.flown, 0
        end = ceil(100.0 * self.approach.needs(self.own(self.flown)))
        said = 0
        while k < min(end, LONGEST):
            if gust_tick(k) >= 0:
                noise = gust_noise(self.gusts, gust_tick(k))
                self.flown = blown(self.flown, self.model, self.climate, noise)
            if k % 10 == 0:
                self.estimate = estimated(self.estimate, ARDUPILOT, self.errors, self.sensed())
            if k % 5 == 2:
                own, left = self.own(before), 0.01 * (end - k + 1)
                self.command(k, own, left)
                late = self.approach.misses(own, left)
                if k - said > 150 and late > LATE_S:
                    end, said = end + round(100.0 * late), k
            before = self.flown
            told = commanded(self.aboard, self.flown.plane, self.model, self.autopilot, 0.0)
            self.flown = fly(self.flown, self.model, told, self.climate)
            k += 1
        plane = self.flown.plane
        x, y, z = plane.position
        turned = abs(wrap(nose_yaw(plane, self.model) - self.heading))
        return Passed(hypot(x, y), abs(z + HEIGHT), turned, abs(plane.speed - self.speed), self.clips)

    def sensed(self) -> Sensed:
        plane = self.flown.plane
        wind = wind_at(self.climate, plane.position)
        airspeed = true_airspeed(plane, wind, gust_at(self.climate, self.flown, self.model))
        return Sensed(plane.velocity, airspeed, nose_yaw(plane, self.model))

    def command(self, k: int, own: Own, left: float) -> None:
        wanted = self.approach.steer(own, left)
        at = Instant(0.01 * k, own.position, own.velocity, own.wind, 1)
        if self.led:
            last = Before(self.aboard.demand, self.aboard.stamp)
            flying = Flying(at.now, at.id, at.position, at.velocity)
            cause = allow(wanted, at.wind, flying, (), self.policy, last).cause
            self.clips += cause != Cause.NONE
        else:
            self.led = True
            self.aboard = self.aboard._replace(demand=wanted)
        self.aboard = ordered(self.aboard, wanted, at, self.policy, ())


STRONG = [WindSpec(speed=5.0, from_deg=angle, shear=True, gust_sigma=3.0) for angle in (250.0, 20.0, 110.0)]
"""13.5 m/s at the height of the game."""


def test_in_strong_wind_and_gusts_a_slow_turner_passes_its_place_at_the_start() -> None:
    """The second is carried on by 6 m/s of gust until half a minute before: more than it can fly slower."""
    found = [Way(n + 2, 50.0 - 10.0 * (n % 2), wind).passed() for n, wind in enumerate(STRONG)]
    assert sorted(p.away for p in found)[1] < 6.0, found
    assert np.mean([degrees(p.heading) for p in found]) < 6.0
    for p in found:
        assert p.away < 40.0, found
        assert p.height < 6.0
        assert degrees(p.heading) < 12.0
        assert p.airspeed < 6.0
        assert p.clips == 0, "what is asked for is within the limits"


def test_who_is_carried_on_by_a_gust_for_long_looks_for_a_longer_path_in_time() -> None:
    """A gust of 5 to 6 m/s from behind for half a minute: more than the plane can fly slower."""
    wind = WindSpec(speed=5.0, from_deg=float(np.random.default_rng(1003).uniform(0.0, 360.0)), shear=True)
    wind = msgspec.structs.replace(wind, gust_sigma=3.0)
    assert Way(3, 50.0, wind).passed().away < 20.0


def test_without_gusts_and_with_a_known_wind_it_is_there_to_a_metre() -> None:
    way = Way(4, 50.0, WindSpec(speed=5.0, from_deg=330.0, shear=True))
    way.errors = way.errors._replace(airspeed=0.0, heading=0.0)
    way.estimate = begun(
        wind_at(way.climate, Vec(0.0, 0.0, -HEIGHT)), way.errors._replace(north=0.0, east=0.0)
    )
    passed = way.passed()
    assert passed.away < 2.0
    assert passed.height < 1.0
    assert degrees(passed.heading) < 1.0
    assert passed.airspeed < 0.3


def test_the_time_that_is_asked_for_reckons_with_the_wind() -> None:
    """Straight ahead, with the wind and against it: a way takes as long as the speed over ground says."""
    e = envelope_of(50.0, 40.0)
    for wind in (13.0, -13.0):
        approach = Approach(Place(Vec(1900.0, 0.0, -HEIGHT), 0.0, 50.0, 42.0, e))
        needed = approach.needs(Own(Vec(0.0, 0.0, -HEIGHT), Vec(50.0 + wind, 0.0, 0.0), Vec(wind, 0.0, 0.0)))
        pace = 50.0 - 0.5 * 8.0
        ideal = 1900.0 / (pace + wind)
        assert ideal < needed < ideal + 15.0, "and some time to spare"


@pytest.mark.parametrize("now", [Vec(5.0, -3.0, 0.0), ZERO, Vec(-12.0, 9.0, 0.0)])
def test_what_is_flown_over_ground_does_not_depend_on_the_wind_of_the_moment(now: Vec) -> None:
    air, mean = Vec(40.0, 20.0, 1.0), Vec(3.0, 4.0, 0.0)
    found = through(air, mean, now)
    ground, other = (air.x + mean.x, air.y + mean.y), (found.x + now.x, found.y + now.y)
    assert norm(found) == pytest.approx(norm(air))
    assert ground[0] * other[1] - ground[1] * other[0] == pytest.approx(0.0, abs=1e-6)
    assert ground[0] * other[0] + ground[1] * other[1] > 0.0


def test_what_a_plane_does_by_itself_is_within_its_limits() -> None:
    """A gust makes it faster than it may be asked to fly: that is no decision that could be clipped."""
    e = envelope_of(50.0, 40.0)
    own = Own(ZERO, Vec(60.0, 0.0, 0.0), Vec(5.0, 0.0, 0.0))
    assert norm(by_itself(own, e)) == pytest.approx(50.0)
    assert norm(circling(own, e)) == pytest.approx(50.0)
