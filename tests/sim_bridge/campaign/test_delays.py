"""The delays of the compiled game are those of a flight: measured between the frames of real agents.

In the kernel (`spatial_game.play`) everybody decides at samples that leave `DECIDES` when divided by the
control period, on the position of the sample before, and what is decided moves the aircraft from that sample
on; a track is heard `Eye.delay` samples after its instant.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from typing import Any

import pytest

from onboard.core.math.vectors import Vec, distance
from onboard.wire.bus.messages import Phase
from onboard.wire.bus.topics import TRACK
from sim_bridge.campaign.spatial_draw import DECIDES, drawn_scenario, spatial
from sim_bridge.campaign.spatial_fixed import eye_of
from sim_bridge.vehicle.motion import Air, Motion
from tests.support.virtual_time import virtual
from tests.support.whole_games import WholeGame, autopilot, game_of

pytestmark = pytest.mark.game
ATTITUDE_TARGET, POSITION = 82, 33  # SET_ATTITUDE_TARGET, GLOBAL_POSITION_INT
CONTROL = 5  # samples of 10 ms between two decisions
SECONDS = 3.0


def number(frame: bytes) -> int:
    """Of a MAVLink 2 message."""
    return int.from_bytes(frame[7:10], "little")


class Watch:
    """When frames of one vehicle pass, by physics steps of the world, and where it was at each."""

    def __init__(self, game: WholeGame, id: int) -> None:
        self.told: list[tuple[int, Vec]] = []  # step, position in the message [m; NED]
        self.ordered: list[int] = []  # steps at whose end a bank was taken in
        self.truth: dict[int, Vec] = {}
        self.game, self.id, world = game, id, game.bridge.world
        pilot, link, frame = autopilot(game, id), world.vehicles[id].links[0], autopilot(game, id).setup.frame
        vehicle = world.vehicles[id]
        receive, send, move = pilot.receive, link.send, vehicle.move

        def received(now_ns: int, data: bytes, peer: Hashable) -> None:
            if number(data) == ATTITUDE_TARGET:
                self.ordered.append(self.step)
            receive(now_ns, data, peer)

        def sent(data: bytes) -> None:
            if number(data) == POSITION:
                payload = data[10:].ljust(28, b"\0")
                lat, lon, alt = (
                    int.from_bytes(payload[k : k + 4], "little", signed=True) for k in (4, 8, 12)
                )
                self.told.append((self.step, frame.ned_from_geodetic(lat / 1e7, lon / 1e7, alt / 1e3)))
            send(data)

        def moved(now_ns: int, motion: Motion, air: Air) -> None:
            self.truth[self.step - 1] = vehicle.airframe.motion.position  # before this step
            move(now_ns, motion, air)

        pilot.receive, link.send, vehicle.move = received, sent, moved  # type: ignore[method-assign,assignment]

    @property
    def step(self) -> int:
        world = self.game.bridge.world
        return world.elapsed_ns // world.step_ns


@virtual
async def test_a_flight_decides_and_orders_when_the_compiled_game_does() -> None:
    scenario = drawn_scenario(spatial("two"), 2)
    async with game_of(scenario) as game:
        await game.forward(4.0, until=lambda: game.phase is Phase.READY)
        await game.forward(1.0)  # everybody is led to its place
        tracks: list[float] = []
        game.bus.subscribe(TRACK.key(game.game, 1), lambda sample: tracks.append(age(game, sample)))
        watches = [Watch(game, id) for id in scenario.ids]
        await game.forward(SECONDS)
    for watch in watches:
        assert len(watch.told) >= SECONDS * 20 - 2
        assert {step % CONTROL for step, _ in watch.told} == {DECIDES}
        assert {step % CONTROL for step in watch.ordered} == {DECIDES}, "in the step of the position"
        assert {step for step, _ in watch.told} == set(watch.ordered)
        for step, place in watch.told[1:]:
            before, later = (distance(place, watch.truth[n]) for n in (step - 1, step - 2))
            assert before < 0.05, "the position is that of the sample before"
            assert later > 0.15
    delay = eye_of(scenario, 0.01).delay * 0.01
    assert tracks
    assert tracks == pytest.approx([delay] * len(tracks), abs=1e-6)


def age(game: WholeGame, sample: Any) -> float:
    """Of a track when it is heard [s]."""
    track = TRACK.decode(sample.payload, Counter())
    assert track is not None
    return (game.clock.wall_ns() - track.stamp_ns) / 1e9
