"""What the simulated autopilots cost: six of them beside the time they live in, and beside bare encoding."""

from __future__ import annotations

from time import process_time

from onboard.core.math.vectors import Vec
from onboard.game.scenario import Kind
from onboard.wire.mavlink.dialect import DialectSender, dialect
from tests.benchmarks import yardstick
from tests.support.flown_autopilot import FlownAutopilot

SECONDS = 10
TICKS_A_SECOND = 100
RATES = ((33, 20), (32, 20), (30, 10), (74, 5), (1, 2))  # message number, Hz: what an agent asks for


def flight(kind: Kind) -> tuple[float, int]:
    """CPU seconds of one autopilot's and airframe's flight, and how many frames they sent."""
    flown = FlownAutopilot(kind, tick_s=1.0 / TICKS_A_SECOND)
    for number, hz in RATES:
        assert flown.command(511, number, 1e6 / hz) == 0
    autopilot, airframe, air = flown.autopilot, flown.airframe, flown.air
    autopilot.outgoing()
    target = flown.roll_target(10.0) if kind == Kind.ARDUPLANE else flown.velocity_target(Vec(1.0, 2.0, 0.0))
    setpoints = [flown.client.pack(target) for _ in range(20)]
    frames, now_ns = 0, flown.now_ns
    began = process_time()
    for tick in range(SECONDS * TICKS_A_SECOND):
        now_ns += flown.tick_ns
        if tick % 5 == 0:
            autopilot.receive(now_ns, setpoints[tick // 5 % 20], "agent")
        airframe.step(autopilot.step(now_ns, airframe.motion, air), air, flown.tick_ns * 1e-9)
        frames += len(autopilot.outgoing())
    return process_time() - began, frames


def test_six_autopilots_and_airframes_beside_bare_encoding_of_what_they_send() -> None:
    """Their share must leave most of a core to the agents at ten times real time."""
    for kind in Kind:
        taken, frames = min(flight(kind) for _ in range(yardstick.MEASURED))
        yardstick.cost(f"a simulated autopilot's second, {kind.value}", taken / SECONDS)
        sender = DialectSender(1, 1)
        began = process_time()
        for number in range(frames):
            sender.pack(dialect.MAVLink_local_position_ned_message(number, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0))
        bare = process_time() - began
        print(
            f"{kind.value}: six run {SECONDS / taken / 6:.0f} times faster than real time; "
            f"{frames / SECONDS:.0f} messages/s each; "
            f"{taken / bare:.1f} times the bare encoding of as many messages"
        )
        assert frames > 50 * SECONDS
        assert taken < 25.0 * bare
