"""`gcs take-off` against simulated autopilots: each kind rises to its place; nobody is armed unasked."""

from __future__ import annotations

import pytest

from gcs.rise import Place, Rise, Step
from gcs.takeoff import links_of, places_of, take_off
from onboard.config.strict import ConfigError
from onboard.core.math.vectors import Vec, distance
from onboard.game.scenario import Flight, Kind, Scenario, VehicleSpec
from onboard.wire.mavlink.frames import Framer, Sender
from tests.support.flown_autopilot import ORIGIN, FlownAutopilot
from tests.support.real_time import patience
from tests.support.udp_fleet import fleet, free_port

KINDS = (Kind.ARDUCOPTER, Kind.PX4, Kind.ARDUPLANE, Kind.PX4_PLANE)


def rising(
    kind: Kind, place: Vec, *, may_arm: bool = True, airborne: bool = False, seconds: float = 240.0
) -> tuple[Rise, FlownAutopilot]:
    """A vehicle and who brings it up, on virtual time, until that is over."""
    flown = FlownAutopilot(kind, airborne=airborne, tick_s=0.05)
    rise = Rise(Place(1, place, ORIGIN), may_arm=may_arm)
    framer, sender = Framer(), Sender(254, 190)
    for tick in range(round(seconds / 0.1)):
        flown.forward(0.1)
        frames, flown.frames = flown.frames, []
        for packet in framer.feed(b"".join(frames)):
            rise.take(packet, tick * 0.1)
        for message in rise.due(tick * 0.1):
            flown.autopilot.receive(flown.now_ns, sender.pack(message), "peer")
        if rise.over:
            break
    return rise, flown


@pytest.mark.parametrize("kind", [Kind.ARDUCOPTER, Kind.PX4])
def test_a_multicopter_rises_goes_to_its_place_and_stays_there(kind: Kind) -> None:
    there = Vec(40.0, -20.0, -30.0)
    rise, flown = rising(kind, there)
    assert rise.step is Step.THERE, rise.why
    assert flown.mode == {Kind.ARDUCOPTER: "GUIDED", Kind.PX4: "HOLD"}[kind]
    flown.forward(20.0)  # nobody speaks to it any more
    flown.assert_near(there, 4.0)


@pytest.mark.parametrize("kind", [Kind.ARDUPLANE, Kind.PX4_PLANE])
def test_a_plane_takes_off_and_circles_its_place(kind: Kind) -> None:
    there = Vec(300.0, 200.0, -90.0)
    rise, flown = rising(kind, there)
    assert rise.step is Step.THERE, rise.why
    flown.forward(40.0)
    assert abs(flown.height - 90.0) < 20.0
    assert distance(flown.position, there) < 300.0


@pytest.mark.parametrize("kind", KINDS)
def test_nobody_is_armed_who_may_not_be_and_who_flies_is_left_alone(kind: Kind) -> None:
    rise, flown = rising(kind, Vec(10.0, 0.0, -40.0), may_arm=False, seconds=30.0)
    assert (rise.step, flown.autopilot.armed) == (Step.LEFT, False)
    assert "arming is not allowed" in rise.why
    before = FlownAutopilot(kind).mode
    rise, flown = rising(kind, Vec(10.0, 0.0, -40.0), airborne=True, seconds=30.0)
    assert (rise.step, flown.mode) == (Step.LEFT, before)
    assert rise.why.startswith("in the air already")


def test_no_heartbeat_is_ever_sent_and_nothing_to_a_silent_vehicle() -> None:
    rise = Rise(Place(1, Vec(0.0, 0.0, -30.0), ORIGIN), may_arm=True)
    assert rise.due(0.0) == []
    assert rise.why == "no heartbeat"


def test_links_are_told_by_id_and_places_by_the_scenario() -> None:
    assert links_of(("2=udpin://0.0.0.0:14551",)) == {2: "udpin://0.0.0.0:14551"}
    for pair in ("2", "2=", "x=udp:1", "251=udp:1", "0=udp:1"):
        with pytest.raises(ConfigError, match="expected ID=URL"):
            links_of((pair,))
    with pytest.raises(ConfigError, match="each id once"):
        links_of(("2=a", "2=b"))
    low = Scenario("low", VehicleSpec((0.0, 0.0, 1.0), 5.0), (VehicleSpec((9.0, 0.0, 30.0), 4.0),))
    with pytest.raises(ConfigError, match="vehicle 1: found a place 1 m above the origin"):
        places_of(low, (1,))
    with pytest.raises(ConfigError, match="found vehicle 7, expected one of 1, 2"):
        places_of(low, (7,))
    (place,) = places_of(low, (2,))
    assert place.ned == Vec(9.0, 0.0, -30.0)


@pytest.mark.real
async def test_a_copter_is_brought_to_its_place_over_udp(capsys: pytest.CaptureFixture[str]) -> None:
    port = free_port()
    async with fleet(Kind.ARDUCOPTER, [[port]], ground=True) as vehicles:
        scenario = Scenario(
            "up", VehicleSpec((4.0, 0.0, 6.0), 5.0), (VehicleSpec((90.0, 0.0, 30.0), 4.0),), flight=Flight()
        )
        links = {1: f"udpin://127.0.0.1:{port}"}
        assert await take_off(scenario, links, may_arm=False, within_s=patience(20.0)) == 1
        assert "disarmed, and arming is not allowed (--may-arm)" in capsys.readouterr().err
        assert not vehicles.autopilot(1).armed
        assert await take_off(scenario, links, may_arm=True, within_s=patience(60.0)) == 0
        assert distance(vehicles.position(1), Vec(4.0, 0.0, -6.0)) < 5.0
        assert vehicles.autopilot(1).mode_name == "GUIDED"
        assert await take_off(scenario, links, may_arm=True, within_s=patience(20.0)) == 1
        assert "left alone: in the air already, in GUIDED" in capsys.readouterr().err
