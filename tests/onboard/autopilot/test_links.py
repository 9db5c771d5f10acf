"""Radio reality: rates that fit a link, two links to one autopilot, and its clock beside ours."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.autopilot.link_redundancy import LOSS, Redundant
from onboard.autopilot.stream_rates import NEEDS, SHARE, StreamRates, capacity_of, plan
from onboard.autopilot.telemetry_state import Observer
from onboard.autopilot.timesync import TimesyncEstimator
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Target
from onboard.wire.mavlink.dialect import DialectSender, dialect
from onboard.wire.mavlink.frames import Framer, Packet
from onboard.wire.mavlink.ids import frame_size
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import Timesync

PLANE = NEEDS[Kind.ARDUPLANE]


def load(rates: dict[str, float]) -> float:
    return sum(rate * frame_size(name) for name, rate in rates.items())


def test_57600_baud_carries_all_that_is_wanted_and_9600_the_most_important() -> None:
    full = plan(PLANE, capacity_of(57600) * SHARE)
    assert full == {need.message: need.rate for need in PLANE}
    slow = plan(PLANE, capacity_of(9600) * SHARE)
    assert load(slow) <= 960 * SHARE
    assert slow["HEARTBEAT"] == 1.0
    assert slow["GLOBAL_POSITION_INT"] >= 5.0
    assert slow["EXTENDED_SYS_STATE"] <= 0.2


@settings(max_examples=200, deadline=None)
@given(st.floats(0.0, 20_000.0), st.sampled_from(sorted(NEEDS, key=str)))
def test_a_plan_never_exceeds_its_budget_nor_what_is_wanted(budget: float, kind: Kind) -> None:
    rates = plan(NEEDS[kind], budget)
    assert load(rates) <= budget + 1e-6
    for need in NEEDS[kind]:
        assert rates[need.message] == 0.0 or need.least <= rates[need.message] <= need.rate + 1e-9


class Radio:
    """A link of fixed capacity: what is asked beyond it arrives in proportion."""

    def __init__(self, capacity: float) -> None:
        self.capacity = capacity
        self.asked: dict[str, float] = {}

    def hear(self, messages: list[commands.CommandLong]) -> None:
        names = {number: kind.msgname for number, kind in dialect.mavlink_map.items()}
        for message in messages:
            if message.command != dialect.MAV_CMD_SET_MESSAGE_INTERVAL:
                continue
            interval = message.params[1]
            self.asked[names[int(message.params[0])]] = 1e6 / interval if interval > 0 else 0.0

    def arrived(self) -> dict[str, float]:
        share = min(1.0, self.capacity / max(load(self.asked), 1.0))
        return {name: rate * share for name, rate in self.asked.items()}


def test_the_rates_fall_to_what_the_link_carries_and_rise_again_with_it() -> None:
    radio, asking = Radio(1200.0), StreamRates(Kind.ARDUPLANE, Target(1))
    now = 0.0
    for _ in range(120):
        now += 1.0
        radio.hear(asking.step(now, radio.arrived()))
    assert load(radio.asked) <= 1200.0 * 1.15
    assert min(radio.asked["GLOBAL_POSITION_INT"], radio.asked["ATTITUDE"]) >= 5.0
    radio.capacity = 6000.0
    for _ in range(300):
        now += 1.0
        radio.hear(asking.step(now, radio.arrived()))
    assert radio.asked == pytest.approx({need.message: need.rate for need in PLANE}, rel=0.2)
    radio.hear(asking.step(now + 10, radio.arrived(), buffer_free=0.1))  # the radio's buffer fills
    assert asking.budget < load({need.message: need.rate for need in PLANE})


def test_a_lost_request_is_asked_again_without_slowing_the_rest() -> None:
    asking = StreamRates(Kind.ARDUPLANE, Target(1), capacity_of(57600))
    first = asking.step(0.0, {})
    assert len(first) == len(PLANE)
    arrived = {need.message: need.rate for need in PLANE if need.message != "WIND"}
    again = asking.step(4.0, arrived)
    assert [message.params[0] for message in again] == [dialect.MAVLINK_MSG_ID_WIND]
    assert asking.rates["ATTITUDE"] == 20.0
    asking.forget()
    assert len(asking.step(5.0, arrived)) == len(PLANE)


@pytest.mark.parametrize("quality", [0.9, 0.7, 0.5])
def test_what_is_lost_on_the_way_by_chance_is_no_reason_to_ask_for_less(quality: float) -> None:
    rng, asking = np.random.default_rng(5), StreamRates(Kind.ARDUCOPTER, Target(1))
    asking.step(0.0, {})
    falls = 0
    for second in range(1, 600):
        rates = asking.rates.items()
        came = {name: rng.binomial(round(rate), quality) / quality for name, rate in rates}
        before = asking.budget
        asking.step(float(second), came, quality=quality)
        falls += asking.budget < before
    assert falls <= 3
    assert min(asking.rates.values()) >= 0.5


def attitude(sender: DialectSender, boot_ms: int) -> Packet:
    raw = sender.pack(dialect.MAVLink_attitude_message(boot_ms, 0, 0, boot_ms * 1e-4, 0, 0, 0))
    return Framer().feed(raw)[0]


def test_another_link_takes_over_before_telemetry_counts_as_lost_and_gives_back() -> None:
    """Two ports of one autopilot at 20 Hz; the first is cut from 5 s to 9 s."""
    ports, redundant, observer = (DialectSender(1, 1), DialectSender(1, 1)), Redundant(2), Observer(1)
    for _ in range(77):
        attitude(ports[1], 0)
    used: list[tuple[float, int]] = []
    take_overs: list[int] = []  # the links that took over
    worst = 0.0
    for k in range(1, 400):
        now = k * 0.05
        for link in (0, 1):
            if link == 0 and 5.0 <= now < 9.0:
                continue
            packet = attitude(ports[link], k * 50)
            heard = redundant.take(now, link, packet)
            take_overs += [redundant.active] if heard.took_over else []
            if heard.use:
                assert observer.take(now, packet, link) is not None
                used.append((now, link))
        worst = max(worst, now - observer.snapshot().attitude_at)
    assert worst <= LOSS + 0.06
    assert {link for now, link in used if now < 5.0} == {0}
    assert {link for now, link in used if 5.4 < now < 9.0} == {1}
    assert {link for now, link in used if now > 14.5} == {0}
    assert len({now for now, _ in used}) == len(used)  # nothing twice
    assert take_overs == [1, 0]
    assert observer.snapshot().reboots == 0


def test_the_same_frame_by_two_ways_counts_once_and_an_answer_from_either() -> None:
    redundant, sender = Redundant(2), DialectSender(1, 1)
    frame = attitude(sender, 1000)
    assert redundant.take(1.0, 0, frame).use
    assert not redundant.take(1.01, 1, frame).use
    assert not redundant.take(1.02, 0, frame).use
    answer = dialect.MAVLink_command_ack_message(176, 0)
    assert redundant.take(1.1, 1, Framer().feed(sender.pack(answer))[0]).use
    assert not redundant.take(1.1, 0, Framer().feed(sender.pack(answer))[0]).use


class Peer:
    """An autopilot's clock: an offset and a drift from ours, behind two one-way delays."""

    def __init__(self, offset_ns: int) -> None:
        self.offset_ns = offset_ns

    def answer(self, question: Timesync, arrives_ns: int) -> Timesync:
        return Timesync(arrives_ns + self.offset_ns, question.asked_ns)


@pytest.mark.parametrize("seed", range(5))
def test_the_offset_is_found_behind_jittery_delays(seed: int) -> None:
    rng = np.random.default_rng(seed)
    peer, estimator = Peer(-987_654_321_000), TimesyncEstimator()
    for second in range(30):
        now = second * 10**9
        there, back = (int(x) for x in 2e6 + rng.exponential(20e6, 2))
        question = estimator.ask(now)
        if rng.random() < 0.3:
            continue  # lost
        estimator.take(now + there + back, peer.answer(question, now + there))
    offset = estimator.offset()
    assert offset.known
    error = abs(offset.offset_ns - peer.offset_ns)
    assert error <= offset.uncertainty_ns
    assert error < 20e6


def test_an_autopilot_that_starts_again_has_a_new_clock_soon() -> None:
    peer, estimator = Peer(5 * 10**9), TimesyncEstimator()
    for second in range(20):
        now = second * 10**9
        peer.offset_ns = 5 * 10**9 if second < 10 else -3 * 10**9
        estimator.take(now + 4_000_000, peer.answer(estimator.ask(now), now + 2_000_000))
    assert estimator.offset().offset_ns == -3 * 10**9


def test_questions_of_others_are_answered_and_their_answers_ignored() -> None:
    estimator = TimesyncEstimator()
    reply = estimator.take(500, Timesync(0, 123))
    assert reply is not None
    assert reply == Timesync(answered_ns=500, asked_ns=123)
    estimator.take(600, Timesync(999, 42))  # an answer to a question that was not ours
    assert not estimator.offset().known
