"""The pilot thinks: tracks in, decisions with their reasons out."""

from __future__ import annotations

from math import inf, isfinite, nan, sqrt

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from onboard.core.game.rules import Rules, Target
from onboard.core.game.views import evader_view, heading_at
from onboard.core.math.states import FREE, MateState, Vehicle, VehicleLimits, carried
from onboard.core.math.vectors import NORTH, ZERO, Vec, add, along, distance, dot, norm, scale, sub, unit
from onboard.core.strategy.evasion import evader
from onboard.pilot.memory import Memory
from onboard.pilot.pilot import Pilot, PilotDecision, drawing
from onboard.pilot.setup import GameSetup, Own, Player, Side, TrackSample

EXACT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
SETUP = GameSetup(
    roster=(
        Player(1, Side.EVADER, 5.0, FREE),
        Player(2, Side.PURSUER, 4.0, FREE),
        Player(3, Side.PURSUER, 4.0, FREE),
    ),
    rules=Rules(R=2.0, rho=4.0),
    target=Target(True, Vec(200.0, 0.0, -50.0)),
)


def seen(id: int, t: float, position: Vec, velocity: Vec) -> TrackSample:
    return TrackSample(id, t, position, velocity, EXACT)


def remembered(*samples: TrackSample) -> Memory:
    memory = Memory()
    memory.take(samples)
    return memory


def test_a_pursuer_heads_for_the_point_where_it_meets_the_evader() -> None:
    pilot = Pilot(2, Side.PURSUER, "paper")
    track = seen(1, 10.0, Vec(0.0, 0.0, -50.0), Vec(5.0, 0.0, 0.0))
    thought = pilot.step(10.0, Own(Vec(50.0, 20.0, -50.0), ZERO), (), SETUP, remembered(track))
    assert (thought.rule, thought.level, thought.module) == ("intercept", "tactical", "geometric")
    assert distance(along(Vec(50.0, 20.0, -50.0), thought.velocity, thought.time), thought.aim) < 1e-6
    assert distance(along(Vec(0.0, 0.0, -50.0), Vec(5.0, 0.0, 0.0), thought.time), thought.aim) < 1e-6


def test_an_evaders_pilot_decides_as_its_strategy_does() -> None:
    pilot = Pilot(1, Side.EVADER)
    ahead, aside = Vec(60.0, 0.0, -50.0), Vec(0.0, 70.0, -50.0)
    tracks = (seen(2, 0.0, ahead, ZERO), seen(3, 0.0, aside, ZERO))
    thought = pilot.step(0.0, Own(Vec(0.0, 0.0, -50.0), ZERO), (), SETUP, remembered(*tracks))
    own = Vehicle(Vec(0.0, 0.0, -50.0), ZERO, 5.0)
    pursuers = (Vehicle(ahead, ZERO, 4.0), Vehicle(aside, ZERO, 4.0))
    expected = evader(evader_view(own, FREE, pursuers, SETUP.target, ZERO, SETUP.rules))
    assert thought.velocity == scale(expected.direction, expected.speed)
    cones, circles = drawing(thought, Side.EVADER)
    assert len(cones) == len(circles) == 2


def test_a_late_track_is_carried_forward_to_now() -> None:
    pilot = Pilot(2, Side.PURSUER, "pure-pursuit")
    samples = tuple(seen(1, 0.1 * n, Vec(0.0, 0.5 * n, -50.0), Vec(0.0, 5.0, 0.0)) for n in range(20))
    thought = pilot.step(2.4, Own(Vec(-100.0, 12.0, -50.0), ZERO), (), SETUP, remembered(*samples))
    assert thought.aim.y == pytest.approx(12.0, abs=0.3)
    assert 0.0 < thought.sigma < 5.0
    assert thought.predictor == "constant_velocity"


def test_with_no_track_it_decides_nothing_and_names_what_it_lacks() -> None:
    thought = Pilot(2, Side.PURSUER).step(0.0, Own(ZERO, ZERO), (), SETUP, Memory())
    assert (thought.decides, thought.lacks, thought.sigma) == (False, ("track of evader 1",), inf)


def test_out_of_the_roster_it_decides_nothing() -> None:
    thought = Pilot(9, Side.PURSUER).step(0.0, Own(ZERO, ZERO), (), SETUP, Memory())
    assert thought.lacks == ("a place in the roster",)


def test_an_undeclared_speed_is_the_upper_envelope_of_what_was_seen() -> None:
    memory = Memory()
    assert memory.top_speed(1, 0.0, Vec(12.0, 0.0, 0.0)) == 12.0
    assert 11.5 < memory.top_speed(1, 2.0, Vec(3.0, 0.0, 0.0)) < 12.0
    assert memory.top_speed(1, 3.0, Vec(20.0, 0.0, 0.0), Vec(-5.0, 0.0, 0.0)) == 25.0


def test_in_a_plane_game_heights_do_not_count_and_its_own_is_kept() -> None:
    roster = (Player(1, Side.EVADER, 5.0), Player(2, Side.PURSUER, 4.0, height=50.0))
    setup = SETUP._replace(roster=roster, rules=SETUP.rules._replace(planar=True))
    track = seen(1, 0.0, Vec(30.0, 0.0, -90.0), Vec(-5.0, 0.0, 3.0))
    low = Own(Vec(0.0, 0.0, -40.0), ZERO)
    thought = Pilot(2, Side.PURSUER).step(0.0, low, (), setup, remembered(track))
    assert norm(Vec(thought.velocity.x, thought.velocity.y, 0.0)) == pytest.approx(4.0)
    assert thought.velocity.z < 0.0
    assert thought.aim.z == -40.0


def test_a_pursuer_keeps_off_a_team_mate() -> None:
    setup = SETUP._replace(rules=SETUP.rules._replace(separation=10.0))
    mate = MateState(3, 0.0, Vec(5.0, 0.0, -50.0), ZERO)
    track = seen(1, 0.0, Vec(100.0, 0.0, -50.0), Vec(5.0, 0.0, 0.0))
    own = Own(Vec(0.0, 0.0, -50.0), ZERO)
    thought = Pilot(2, Side.PURSUER).step(0.0, own, (carried(mate, 0.0),), setup, remembered(track))
    assert thought.rule == "keep_off_mate"


@settings(max_examples=60, deadline=None)
@given(
    wind=st.tuples(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0)),
    place=st.tuples(st.floats(20.0, 200.0), st.floats(-200.0, 200.0)),
    course=st.tuples(st.floats(-40.0, 40.0), st.floats(-40.0, 40.0)),
)
def test_a_pursuer_in_steady_wind_decides_as_in_still_air(
    wind: tuple[float, float], place: tuple[float, float], course: tuple[float, float]
) -> None:
    air = Vec(*wind, 0.0)
    evader_at, evader_v = Vec(*place, -50.0), Vec(*course, 0.0)
    # Adding the wind and taking it off again rounds the velocity. That turns a crawling evader's heading, and
    # where a rule begins another one may speak: at cos φ = 0, and where the ray touches the sphere.
    assume(norm(evader_v) == 0.0 or norm(evader_v) > 0.1)
    here = Vec(0.0, 0.0, -50.0)
    sight = unit(sub(here, evader_at), NORTH)
    cosine = dot(heading_at(Vehicle(evader_at, evader_v, 5.0)), sight)
    assume(all(abs(cosine - edge) > 1e-9 for edge in (0.0, sqrt(1.0 - (4.0 / 5.0) ** 2))))

    def think(w: Vec) -> PilotDecision:
        track = seen(1, 5.0, evader_at, add(evader_v, w))
        own = Own(here, add(Vec(3.0, 1.0, 0.0), w), w)
        return Pilot(2, Side.PURSUER).step(5.0, own, (), SETUP, remembered(track))

    still, windy = think(ZERO), think(air)
    assert distance(still.velocity, windy.velocity) < 1e-6
    assert distance(along(still.aim, air, still.time), windy.aim) < 1e-6 * max(1.0, norm(windy.aim))


def test_an_evader_in_wind_steers_into_it_so_that_its_track_leads_to_the_target() -> None:
    setup = SETUP._replace(target=Target(True, Vec(1000.0, 0.0, -50.0)))
    wind, at, memory = Vec(0.0, 3.0, 0.0), Vec(0.0, 0.0, -50.0), Memory()
    far = Vec(-5000.0, 0.0, -50.0)
    for n in range(10000):
        t = n * 0.05
        if n % 10 == 0:
            memory.take((seen(2, t, far, ZERO), seen(3, t, far, ZERO)))
        thought = Pilot(1, Side.EVADER).step(t, Own(at, ZERO, wind), (), setup, memory)
        assert thought.velocity.y < -2.5
        assert abs(at.y) < 1.0
        at = along(at, add(thought.velocity, wind), 0.05)
        if distance(at, setup.target.position) < 1.0:
            break
    assert t == pytest.approx(1000.0 / 4.0, rel=0.01)


anything = st.floats(allow_nan=True, allow_infinity=True)
vecs = st.builds(Vec, anything, anything, anything)


@settings(max_examples=150, deadline=None)
@given(
    samples=st.lists(
        st.builds(
            TrackSample,
            st.integers(1, 4),
            anything,
            vecs,
            vecs,
            st.tuples(anything, anything, anything, anything, anything, anything),
        ),
        max_size=6,
    ).map(tuple),
    side=st.sampled_from(Side),
)
def test_whatever_a_sensor_says_nothing_raises(samples: tuple[TrackSample, ...], side: Side) -> None:
    good = seen(1, 1.0, Vec(50.0, 0.0, -50.0), Vec(5.0, 0.0, 0.0))
    pilot = Pilot(1 if side is Side.EVADER else 2, side)
    memory = remembered(*samples, good)
    thought = pilot.step(1.0, Own(ZERO, ZERO), (), SETUP, memory)
    assert all(map(isfinite, thought.velocity))
    memory.take(samples)
    thought = pilot.step(1.05, Own(ZERO, Vec(nan, 0.0, 0.0)), (), SETUP, memory)
    assert thought.level == "tactical"


def test_five_pilots_catch_an_encircled_evader_with_late_tracks() -> None:
    ring = [
        Vec(40.0, 0.0, 0.0),
        Vec(12.0, 38.0, 0.0),
        Vec(-32.0, 23.0, 0.0),
        Vec(-32.0, -23.0, 0.0),
        Vec(12.0, -38.0, 0.0),
    ]
    roster = (
        Player(1, Side.EVADER, 3.0, VehicleLimits()),
        *(Player(2 + n, Side.PURSUER, 4.0) for n in range(5)),
    )
    setup = GameSetup(roster, Rules(R=2.0, rho=4.0, planar=True))
    pilots = [Pilot(1, Side.EVADER), *(Pilot(2 + n, Side.PURSUER) for n in range(5))]
    memories = [Memory() for _ in pilots]
    places, speeds = [ZERO, *ring], [ZERO] * 6
    history: list[tuple[TrackSample, ...]] = []
    nearest = inf
    for n in range(1200):
        t = n * 0.05
        history.append(tuple(seen(i + 1, t, places[i], speeds[i]) for i in range(6)))
        late = history[n - 4] if n >= 4 else ()
        for i, pilot in enumerate(pilots):
            memories[i].take(late)
            thought = pilot.step(t, Own(places[i], speeds[i]), (), setup, memories[i])
            speeds[i] = thought.velocity
        places = [along(p, v, 0.05) for p, v in zip(places, speeds, strict=True)]
        nearest = min(distance(places[0], p) for p in places[1:])
        if nearest <= setup.rules.R:
            break
    assert nearest <= setup.rules.R
    assert norm(sub(places[0], ZERO)) < 60.0
