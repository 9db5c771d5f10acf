"""Impaired links: the shares come true, the seed decides all, and the cable can be cut and joined."""

from __future__ import annotations

import asyncio
from collections.abc import Hashable
from itertools import pairwise
from math import sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onboard.runtime.impairment import CLEAR, CUT, HELD_BACK_S, Channel, Impaired, Impairment
from onboard.runtime.links import memory_pair
from onboard.runtime.loop import virtual_clock
from tests.support.virtual_time import virtual

MS = 1_000_000
shares = st.floats(0.0, 1.0)
impairments = st.builds(
    Impairment,
    loss=shares, delay_s=st.floats(0, 0.5), jitter_s=st.floats(0, 0.2), duplication=shares, reordering=shares,
    burst_rate=st.floats(0, 5), burst_s=st.floats(0, 1), bit_error=shares,
)  # fmt: skip


Fates = list[list[tuple[int, bytes]]]


def fates(impairment: Impairment, count: int, seed: int = 1, every_ns: int = 20 * MS) -> Fates:
    channel = Channel(impairment, np.random.default_rng(seed))
    return [channel.fate(index.to_bytes(4, "big"), index * every_ns) for index in range(count)]


@given(impairments, st.integers(0, 2**32))
@settings(max_examples=40, deadline=None)
def test_the_seed_decides_everything(impairment: Impairment, seed: int) -> None:
    assert fates(impairment, 60, seed) == fates(impairment, 60, seed)


@given(impairments)
@settings(max_examples=60, deadline=None)
def test_nothing_arrives_before_its_delay_and_nothing_is_invented(impairment: Impairment) -> None:
    for index, copies in enumerate(fates(impairment, 80)):
        assert len(copies) <= 2
        for arrival, data in copies:
            assert arrival >= index * 20 * MS + round(impairment.delay_s * 1e9)
            flipped = int.from_bytes(data, "big") ^ index
            assert flipped.bit_count() <= (1 if impairment.bit_error > 0 else 0)


@given(later=impairments, quiet=st.integers(0, 9000), seed=st.integers(0, 2**32))
@settings(max_examples=30, deadline=None)
def test_what_a_clean_channel_did_not_draw_it_draws_before_it_does_more(
    later: Impairment, quiet: int, seed: int
) -> None:
    """Beside a channel that drew all the while, for a loss too small to happen."""
    clean = Channel(Impairment(delay_s=0.01), np.random.default_rng(seed))
    drawing = Channel(Impairment(delay_s=0.01, loss=1e-300), np.random.default_rng(seed))
    for index in range(quiet):
        assert clean.fate(b"a", index * MS) == drawing.fate(b"a", index * MS)
    clean.impairment = drawing.impairment = later
    for index in range(quiet, quiet + 20):
        assert clean.fate(b"abc", index * MS) == drawing.fate(b"abc", index * MS)
    assert clean.counts == drawing.counts


@pytest.mark.parametrize("loss", [0.05, 0.3, 0.9])
def test_the_share_of_loss_comes_true(loss: float) -> None:
    count = 20_000
    lost = sum(not copies for copies in fates(Impairment(loss=loss), count))
    assert abs(lost - count * loss) < 5 * sqrt(count * loss * (1 - loss))


def test_bursts_take_the_share_of_time_their_rate_and_length_say() -> None:
    impairment = Impairment(burst_rate=0.5, burst_s=0.4)  # 2 s good, 0.4 s bad
    lost = [not copies for copies in fates(impairment, 200_000)]
    share = sum(lost) / len(lost)
    assert share == pytest.approx(0.4 / 2.4, rel=0.1)
    starts = sum(b and not a for a, b in pairwise(lost))
    assert sum(lost) / starts > 10  # losses come in a row: 0.4 s at 50 Hz is 20 of them


def test_one_bit_is_flipped_and_every_bit_has_its_turn() -> None:
    differences = [
        int.from_bytes(copies[0][1], "big") ^ index
        for index, copies in enumerate(fates(Impairment(bit_error=1.0), 3000))
    ]
    assert {difference.bit_count() for difference in differences} == {1}
    assert len(set(differences)) == 32


def test_jitter_alone_keeps_the_order_and_reordering_breaks_it() -> None:
    def order(impairment: Impairment) -> list[int]:
        arrivals = [
            (copies[0][0], index) for index, copies in enumerate(fates(impairment, 500, every_ns=5 * MS))
        ]
        return [index for _, index in sorted(arrivals)]

    assert order(Impairment(delay_s=0.1, jitter_s=0.1)) == list(range(500))
    mixed = order(Impairment(delay_s=0.1, reordering=0.2))
    assert mixed != list(range(500))
    assert max(abs(place - index) for place, index in enumerate(mixed)) <= HELD_BACK_S[1] / 0.005 + 1


def test_changing_one_share_leaves_the_other_fates_alone() -> None:
    def lost(impairment: Impairment) -> list[bool]:
        return [not copies for copies in fates(impairment, 1000)]

    assert lost(Impairment(loss=0.3)) == lost(Impairment(loss=0.3, duplication=0.5, jitter_s=0.1))


@virtual
async def test_a_link_cut_for_three_seconds_comes_back() -> None:
    a, b = memory_pair("vehicle 2")
    link = Impaired(a, CLEAR, np.random.default_rng(3))
    clock = virtual_clock()
    heard: list[float] = []
    answered: list[float] = []

    def answer(data: bytes, peer: Hashable) -> None:
        heard.append(clock.monotonic_ns() / 1e9)
        b.send(data)

    b.receive(answer)
    link.receive(lambda data, peer: answered.append(clock.monotonic_ns() / 1e9))
    for tick in range(100):
        if tick == 20:
            link.change(CUT)
        if tick == 80:
            link.change(CLEAR)
        link.send(b"position")
        await asyncio.sleep(0.05)
    assert heard == answered
    assert [t for t in heard if 1.0 <= t < 4.0] == []
    assert len(heard) == 40
    assert link.counters()["out_cut"] == 60


@virtual
async def test_each_direction_has_an_impairment_of_its_own() -> None:
    a, b = memory_pair("one-way")
    link = Impaired(a, Impairment(delay_s=0.1), np.random.default_rng(3))
    link.incoming.impairment = CUT
    clock = virtual_clock()
    heard: list[int] = []
    b.receive(lambda data, peer: heard.append(clock.monotonic_ns()))
    link.receive(lambda data, peer: pytest.fail("the way back is cut"))
    link.send(b"there")
    b.send(b"back")
    await asyncio.sleep(1.0)
    assert heard == [100 * MS]
    assert link.counters()["in_cut"] == 1


@virtual
async def test_what_is_under_way_when_the_link_closes_is_lost() -> None:
    a, b = memory_pair("closing")
    link = Impaired(a, Impairment(delay_s=0.1), np.random.default_rng(3))
    b.receive(lambda data, peer: pytest.fail("the link was closed"))
    link.send(b"too late")
    link.close()
    await asyncio.sleep(1.0)
    assert b.counters() == {}


@virtual
async def test_two_seeds_differ_and_two_runs_of_one_do_not() -> None:
    async def run(seed: int) -> list[tuple[int, bytes]]:
        a, b = memory_pair("run")
        impairment = Impairment(loss=0.3, delay_s=0.05, jitter_s=0.02, duplication=0.1, bit_error=0.1)
        link = Impaired(a, impairment, np.random.default_rng(seed))
        clock, start = virtual_clock(), virtual_clock().monotonic_ns()
        got: list[tuple[int, bytes]] = []
        b.receive(lambda data, peer: got.append((clock.monotonic_ns() - start, data)))
        for tick in range(200):
            link.send(tick.to_bytes(2, "big"))
            await asyncio.sleep(0.02)
        await asyncio.sleep(1.0)
        return got

    first, again, other = await run(1), await run(1), await run(2)
    assert first == again
    assert first != other
    assert len(first) > 100
