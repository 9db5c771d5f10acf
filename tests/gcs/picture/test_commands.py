"""Commands: repeated until confirmed, harmless when repeated, and the console knows who has not."""

from __future__ import annotations

import asyncio
from collections import Counter
from contextlib import asynccontextmanager

import numpy as np
import pytest

from gcs.picture.command_book import CALL_NS, EXPIRY_NS, RETRY_NS, CommandBook
from gcs.picture.values import CommandView, LegState
from gcs.station import Station, StationSetup
from onboard.core.math.constants import NS_PER_S
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.impairment import Impairment
from onboard.runtime.loop import virtual_clock
from onboard.wire.bus.messages import Command, CommandKind, CommandReply, CommandState
from onboard.wire.bus.topics import COMMAND
from tests.support.answering_agents import AnsweringAgent
from tests.support.sample_messages import GAME, START_NS
from tests.support.virtual_time import virtual


def order(kind: CommandKind = CommandKind.ABORT, name: str = "c1", sender: str = "tower") -> Command:
    return Command(name, kind, sender, START_NS)


def reply(state: CommandState, i: int = 2, name: str = "c1", reason: str = "") -> CommandReply:
    return CommandReply(name, i, state, reason, "tower", START_NS)


def legs(book: CommandBook, name: str = "c1", now_ns: int = START_NS) -> dict[int, LegState]:
    view = book.view(name, now_ns)
    assert view is not None
    return {leg.id: leg.state for leg in view.legs}


def test_a_command_is_repeated_every_80_ms_until_each_has_confirmed():
    book = CommandBook()
    book.issue(order(), (2, 3), START_NS)
    assert [due.id for due in book.due(START_NS)] == [2, 3]
    assert book.due(START_NS + RETRY_NS - 1) == []
    assert [due.id for due in book.due(START_NS + RETRY_NS)] == [2, 3]
    book.reply(reply(CommandState.PENDING), START_NS + RETRY_NS)
    book.reply(reply(CommandState.CONFIRMED, 3), START_NS + RETRY_NS)
    assert legs(book) == {2: LegState.PENDING, 3: LegState.CONFIRMED}
    assert [due.id for due in book.due(START_NS + 2 * RETRY_NS)] == [2]
    book.reply(reply(CommandState.CONFIRMED), START_NS + 3 * RETRY_NS)
    assert book.due(START_NS + 10 * NS_PER_S) == []
    assert not book.busy(START_NS + 10 * NS_PER_S)
    view = book.view("c1", START_NS + 10 * NS_PER_S)
    assert view is not None
    assert view.confirmed
    assert [leg.took_s for leg in view.legs] == [pytest.approx(0.24), pytest.approx(0.08)]


def test_the_pace_falls_when_nobody_answers_but_an_abort_never_gives_up():
    book = CommandBook()
    book.issue(order(), (2,), START_NS)
    sent = sum(len(book.due(START_NS + n * NS_PER_S // 100)) for n in range(60 * 100))
    assert 3 / 0.08 < sent < 3 / 0.08 + 62
    assert len(book.due(START_NS + 3600 * NS_PER_S)) == 1


@pytest.mark.parametrize("kind", [CommandKind.START, CommandKind.RESUME])
def test_what_sets_a_vehicle_off_expires(kind):
    book = CommandBook()
    book.issue(order(kind), (2,), START_NS)
    assert len(book.due(START_NS + EXPIRY_NS - 1)) == 1
    assert book.due(START_NS + EXPIRY_NS) == []
    assert legs(book, now_ns=START_NS + EXPIRY_NS) == {2: LegState.EXPIRED}
    view = book.view("c1", START_NS + 60 * NS_PER_S)
    assert view is not None
    assert view.legs[0].took_s == 5.0  # when it expired, not how long ago it was given
    assert not book.busy(START_NS + EXPIRY_NS)


def test_a_newer_command_supersedes_what_is_open_to_the_same_vehicles_alone():
    book = CommandBook()
    book.issue(order(CommandKind.HOLD), (2, 3), START_NS)
    book.issue(order(CommandKind.RETURN, "c2"), (3,), START_NS + NS_PER_S)
    assert legs(book) == {2: LegState.SENT, 3: LegState.SUPERSEDED}
    assert {(d.id, d.command.command_id) for d in book.due(START_NS + NS_PER_S)} == {(2, "c1"), (3, "c2")}


def test_nothing_sets_a_vehicle_off_while_an_abort_is_not_confirmed():
    book = CommandBook()
    book.issue(order(), (2, 3), START_NS)
    book.reply(reply(CommandState.CONFIRMED, 3), START_NS)
    book.issue(order(CommandKind.RESUME, "c2"), (2, 3), START_NS + NS_PER_S)
    assert legs(book) == {2: LegState.SENT, 3: LegState.CONFIRMED}
    assert legs(book, "c2") == {2: LegState.REFUSED, 3: LegState.SENT}


def test_answers_to_nothing_late_and_unknown_ones_change_nothing():
    book = CommandBook()
    book.issue(order(), (2,), START_NS)
    book.reply(reply(CommandState.CONFIRMED, name="other"), START_NS)
    book.reply(reply(CommandState.CONFIRMED, 7), START_NS)
    assert legs(book) == {2: LegState.SENT}
    book.reply(reply(CommandState.REFUSED, reason="no autopilot"), START_NS)
    book.reply(reply(CommandState.PENDING), START_NS)
    assert legs(book) == {2: LegState.REFUSED}
    book.issue(order(), (2, 3), START_NS)  # the same id again is the same command, given to one more
    assert legs(book) == {2: LegState.REFUSED, 3: LegState.SENT}


def test_everybody_is_called_and_who_answers_is_one_of_those_told():
    book = CommandBook()
    book.issue(order(CommandKind.RESUME, "c0"), (7,), START_NS)
    book.issue(order(), (2,), START_NS, everybody=True)
    assert {due.id for due in book.due(START_NS)} == {None, 2, 7}
    book.reply(reply(CommandState.PENDING, 7), START_NS)
    assert legs(book) == {2: LegState.SENT}  # a vehicle is told it first
    found = book.call_found("c1", 7)
    assert found == order()
    book.issue(found, (7,), START_NS)
    assert legs(book) == {2: LegState.SENT, 7: LegState.SENT}
    assert book.call_found("c1", 7) is None
    assert book.call_found("c0", 9) is None  # nobody is called to that one
    assert legs(book, "c0") == {7: LegState.SUPERSEDED}
    late_ns = START_NS + CALL_NS
    assert {due.id for due in book.due(late_ns)} == {2, 7}  # each by its own key until it has confirmed
    for vehicle in (2, 7):
        book.reply(reply(CommandState.CONFIRMED, vehicle), late_ns)
    assert not book.busy(late_ns)


def test_a_call_that_nobody_answers_goes_on_and_strangers_who_answer_have_a_bound():
    book = CommandBook()
    book.issue(order(), (), START_NS, everybody=True)
    late_ns = START_NS + 20 * CALL_NS
    assert [due.id for due in book.due(late_ns)] == [None]
    for vehicle in range(1000):
        found = book.call_found("c1", vehicle)
        book.issue(found or order(CommandKind.HOLD, "none"), (vehicle,), late_ns)
    assert len(legs(book)) == 256


def test_everybody_is_called_for_a_second_and_a_half_and_until_somebody_is_told():
    book = CommandBook()
    book.issue(order(), (2,), START_NS, everybody=True)
    last = START_NS + 3 * NS_PER_S // 2

    def called(now_ns: int) -> bool:
        return any(due.id is None for due in book.due(now_ns))

    assert called(START_NS)
    assert not called(START_NS + 79_999_999)
    assert called(START_NS + 80_000_000)
    assert called(last - 1)
    assert not called(last + NS_PER_S)
    alone = CommandBook()
    alone.issue(order(), (), START_NS, everybody=True)
    assert [due.id for due in alone.due(START_NS + 60 * NS_PER_S)] == [None]
    named = CommandBook()
    named.issue(order(), (2,), START_NS)
    assert [due.id for due in named.due(START_NS)] == [2]


def test_an_answer_that_the_book_has_already_is_known_and_no_other():
    book = CommandBook()
    book.issue(order(), (2,), START_NS)
    said = reply(CommandState.PENDING, reason="slow")
    assert not book.knows(said)
    book.reply(said, START_NS)
    assert book.knows(said)
    assert not book.knows(reply(CommandState.CONFIRMED, reason="slow"))
    assert not book.knows(reply(CommandState.PENDING, 3, reason="slow"))
    assert not book.knows(reply(CommandState.PENDING, name="c9", reason="slow"))


def test_the_book_is_bounded():
    book = CommandBook()
    for n in range(200):
        book.issue(order(CommandKind.HOLD, f"c{n}"), (2,), START_NS + n)
    assert len(book.views(START_NS)) == 50


@asynccontextmanager
async def field(count: int, impairment: Impairment | None = None, seed: int = 1, **crew: object):
    """A station and `count` vehicles on one bus."""
    clock = virtual_clock()
    broker = MemoryBroker(impairment, np.random.default_rng(seed))
    crews = [AnsweringAgent(broker.connect(), clock, i, **crew) for i in range(1, count + 1)]
    station = Station(broker.connect("gcs"), clock, StationSetup(GAME, "anna"))
    task = asyncio.create_task(station.run())
    await asyncio.sleep(0.01)
    try:
        yield station, crews
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


async def confirmed(station: Station, command_id: str, within_s: float) -> CommandView:
    """The command's state after it is confirmed, or at the end of the time."""
    view = None
    for _ in range(round(within_s / 0.01)):
        view = station.reducer.book.view(command_id, station.now_ns())
        if view is not None and view.confirmed:
            break
        await asyncio.sleep(0.01)
    assert view is not None
    return view


@virtual
async def test_an_abort_of_six_is_confirmed_by_their_autopilots():
    async with field(6) as (station, crews):
        command_id = station.command(CommandKind.ABORT, range(1, 7))
        view = await confirmed(station, command_id, 2.0)
        assert view.confirmed
        assert {leg.mode for leg in view.legs} == {"LOITER"}
        assert all(0.3 <= leg.took_s < 0.5 for leg in view.legs)
        assert all(len(crew.obeyed) == 1 for crew in crews)  # however often it was sent
        assert all(crew.obeyed[0].sender == "anna" for crew in crews)
        await asyncio.sleep(1.0)
        assert all(crew.heard[command_id] <= 1 + 0.4 / 0.08 for crew in crews)


@virtual
async def test_an_abort_to_everybody_reaches_those_whom_nobody_has_heard():
    async with field(6, Impairment(loss=0.3, delay_s=0.02)) as (station, crews):
        assert station.ids() == ()
        command_id = station.abort_everybody()
        await asyncio.sleep(2.0)
        view = await confirmed(station, command_id, 2.0)
        assert view.confirmed
        assert sorted(leg.id for leg in view.legs) == [1, 2, 3, 4, 5, 6]
        assert all([c.command_id for c in crew.obeyed] == [command_id] for crew in crews)


@virtual
async def test_who_does_not_confirm_is_named_and_confirms_when_it_comes_back():
    async with field(3) as (station, _):
        command_id = station.command(CommandKind.ABORT, (1, 2, 3, 4))
        assert (await confirmed(station, command_id, 2.0)).unconfirmed == (4,)
        await asyncio.sleep(0.5)
        assert "abort not confirmed by 4" in [a.text for a in station.picture().alerts]
        bus = station.bus
        AnsweringAgent(bus, virtual_clock(), 4)
        assert (await confirmed(station, command_id, 3.0)).confirmed
        await asyncio.sleep(3.0)
        assert station.picture().alerts == ()


@virtual
async def test_a_refusal_is_shown_with_its_reason():
    async with field(1, refuses="the pilot flies") as (station, _):
        command_id = station.command(CommandKind.HOLD, (1,))
        await asyncio.sleep(0.5)
        view = station.reducer.book.view(command_id, station.now_ns())
        assert view is not None
        assert [(leg.state, leg.reason) for leg in view.legs] == [(LegState.REFUSED, "the pilot flies")]
        assert [a.text for a in station.picture().alerts] == ["hold refused by 1: the pilot flies"]


@virtual
async def test_two_stations_command_and_each_sees_whom_the_vehicle_obeys():
    async with field(1, takes_s=5.0) as (station, crews):
        other = Station(crews[0].bus, virtual_clock(), StationSetup(GAME, "ben"))
        task = asyncio.create_task(other.run())
        await asyncio.sleep(0.01)
        first = station.command(CommandKind.HOLD, (1,))
        await asyncio.sleep(0.5)
        other.command(CommandKind.RETURN, (1,))
        await asyncio.sleep(0.5)
        view = station.reducer.book.view(first, station.now_ns())
        assert view is not None
        assert [(leg.state, leg.obeyed) for leg in view.legs] == [(LegState.SUPERSEDED, "ben")]
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


@pytest.mark.parametrize("seed", range(5))
def test_an_abort_gets_through_a_bus_that_loses_every_third_message(seed):
    @virtual
    async def fly() -> None:
        loss = Impairment(loss=0.3, delay_s=0.02, jitter_s=0.02)
        async with field(6, loss, seed, takes_s=0.1) as (station, crews):
            view = await confirmed(station, station.command(CommandKind.ABORT, range(1, 7)), 5.0)
            assert view.confirmed
            assert all(len(crew.obeyed) == 1 for crew in crews)

    fly()


@pytest.mark.parametrize("abort", [lambda s: s.command(CommandKind.ABORT, (2, 3)), Station.abort_everybody])
@virtual
async def test_a_reply_in_the_name_of_another_vehicle_counts_for_nobody(abort) -> None:
    broker = MemoryBroker()
    station = Station(broker.connect(), virtual_clock(), StationSetup(GAME))
    liar = broker.connect()
    liar.serve(COMMAND.key(GAME, 3), lambda _: b"")

    def lies(payload: bytes) -> bytes:
        command = COMMAND.decode(payload, Counter())
        assert command is not None
        return COMMAND.encode_reply(reply(CommandState.CONFIRMED, 3, command.command_id))

    liar.serve(COMMAND.key(GAME, 2), lies)
    running = asyncio.create_task(station.run())
    await asyncio.sleep(0.1)
    abort(station)
    await asyncio.sleep(1.0)
    (shown,) = station.picture().commands
    assert {leg.state for leg in shown.legs} == {LegState.SENT}
    assert 3 in {leg.id for leg in shown.legs}
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)
