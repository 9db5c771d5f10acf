"""The state machine of modes as a property: whatever happens, hands off means hands off."""

from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.autopilot.arduplane import ArduPlaneEncoder
from onboard.autopilot.base import Adapter, ReleaseMode, Setpoint, Stage, Telemetry
from onboard.autopilot.guided import GuidedAdapter
from onboard.autopilot.velocity import VelocityEncoder
from onboard.core.math.vectors import Vec
from onboard.wire.mavlink.commands import CommandLong, Target, VelocityTarget
from onboard.wire.mavlink.modes import MODES, Kind
from onboard.wire.mavlink.values import CommandAck

KINDS = (Kind.PX4_MULTICOPTER, Kind.ARDUCOPTER, Kind.ARDUPLANE)


def adapter_of(kind: Kind) -> Adapter:
    if kind is Kind.ARDUPLANE:
        return GuidedAdapter(Target(1), ArduPlaneEncoder(Target(1), 0.785))
    return GuidedAdapter(Target(1), VelocityEncoder(kind, Target(1)))


happening = st.one_of(
    st.tuples(st.just("mode"), st.integers(0, 30)),
    st.tuples(st.just("beat"), st.just(0)),
    st.tuples(st.just("enter"), st.just(0)),
    st.tuples(st.just("leave"), st.integers(0, 2)),
    st.tuples(st.just("end"), st.just(0)),
    st.tuples(st.just("arm"), st.just(0)),
    st.tuples(st.just("ack"), st.integers(0, 6)),
    st.tuples(st.just("reboot"), st.just(0)),
    st.tuples(st.just("steps"), st.integers(1, 30)),
)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.value)
@settings(max_examples=150, deadline=None)
@given(story=st.lists(happening, max_size=40))
def test_setpoints_leave_only_where_they_count_and_nothing_is_armed(
    kind: Kind, story: list[tuple[str, int]]
) -> None:
    adapter = adapter_of(kind)
    modes = sorted(MODES[kind])
    telemetry = Telemetry(kind=kind, mode=modes[0], heartbeat_at=0.0, altitude_m=500.0)
    now = 0.0
    asked: list[float] = []
    for what, number in story:
        if what == "mode":
            telemetry = telemetry._replace(mode=modes[number % len(modes)], heartbeat_at=now)
        elif what == "beat":
            telemetry = telemetry._replace(heartbeat_at=now)
        elif what == "enter":
            adapter.enter(now)
        elif what == "leave":
            adapter.leave(now, list(ReleaseMode)[number])
        elif what == "end":
            adapter.end(now)
        elif what == "arm":
            assert not adapter.arm(now)
        elif what == "ack":
            adapter.acknowledge(now, CommandAck(176, number, 1, 191))
        elif what == "reboot":
            telemetry = telemetry._replace(reboots=telemetry.reboots + 1, heartbeat_at=now)
        for _ in range(number if what == "steps" else 1):
            now = round(now + 0.02, 3)
            before = adapter.stage
            for message in adapter.step(now, telemetry, Setpoint(Vec(15.0, 1.0, 0.0))).messages:
                if isinstance(message, CommandLong):
                    assert adapter.stage in (Stage.ENTERING, Stage.LEAVING)
                    if message.command == 176:
                        asked.append(now)
                    else:  # the heartbeat that proves it
                        assert (message.command, message.params[0]) == (512, 0)
                else:
                    early = kind is Kind.PX4_MULTICOPTER and adapter.stage in (Stage.IDLE, Stage.ENTERING)
                    assert adapter.stage is Stage.ACTIVE or early
                    assert early or telemetry.mode == adapter.guided_mode
                    assert isinstance(message, VelocityTarget) == (kind is not Kind.ARDUPLANE)
            if before in (Stage.TAKEN, Stage.LEFT) and adapter.stage is Stage.ACTIVE:
                assert telemetry.mode == adapter.guided_mode


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.value)
def test_a_command_is_repeated_no_faster_than_every_80_ms(kind: Kind) -> None:
    adapter = adapter_of(kind)
    telemetry = Telemetry(kind=kind, mode="RTL", heartbeat_at=0.0)
    adapter.leave(0.0, ReleaseMode.HOLD)
    sent = [
        k
        for k in range(200)
        for message in adapter.step(k * 0.01, telemetry, None).messages
        if message.command == 176
    ]
    assert min(b - a for a, b in pairwise(sent)) >= 8
