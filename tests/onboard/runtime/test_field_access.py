"""The attack matrix: every member and every stranger tries everything on every topic of the table.

What is expected is read off the table's parties here, apart from the rules under test: nothing forged may
arrive, and nothing that the table allows may be missing.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import pytest
import zenoh

from onboard.runtime.bus_zenoh import ZenohBus, open_zenoh
from onboard.wire.bus.topics import (
    EVADER_BRIEF,
    EVENTS,
    ID,
    SETUP,
    STATE,
    TOPICS,
    Delivery,
    Party,
    Topic,
    everything,
)
from tests.support.field_keys import Field, expired
from tests.support.real_time import patience, until

IDS = (1, 2, 3)
SIDES = {1: (1,), 2: (2, 3), 3: (2, 3)}
AGENTS = {f"vehicle-{id}": id for id in IDS}
STATIONS = {
    "ground": {Party.MASTER, Party.STATION},
    "second": {Party.STATION},
    "radar": {Party.SENSOR},
    "revoked": set(),  # a certificate of this authority that the roster no longer names
}
EVERYBODY = (*AGENTS, *STATIONS)
GAME = "range"


def allowed(who: str, parties: tuple[Party, ...], id: int | None) -> bool:
    """Whether a member is one of the parties for the vehicle that a key names."""
    if who in STATIONS:
        return bool(STATIONS[who] & set(parties))
    own = AGENTS[who]
    means = {
        Party.OWN_AGENT: id == own,
        Party.SAME_SIDE: id in SIDES[own] and id != own,
        Party.ANY_AGENT: True,
        Party.EVADER: own == 1,
    }
    return any(means.get(party, False) for party in parties)


def places() -> Iterator[tuple[Topic[Any], int | None, str]]:
    """Every topic, vehicle and key of the bus."""
    for topic in TOPICS:
        for id in IDS if ID in topic.suffix else (None,):
            yield topic, id, topic.key(GAME, id)


def expected(deliveries: tuple[Delivery, ...]) -> set[tuple[str, str, str]]:
    """(who writes, who reads, key) as the table allows; what the listener's own computer does is its own."""
    return {
        (writer, reader, key)
        for topic, id, key in places()
        if topic.delivery in deliveries
        for writer in EVERYBODY
        for reader in EVERYBODY
        if writer != reader
        and (writer == "ground" or allowed(writer, topic.writers, id))
        and (reader == "ground" or allowed(reader, topic.readers, id))
    }


class Range(NamedTuple):
    field: Field
    ground: ZenohBus
    sessions: dict[str, Any]


@pytest.fixture
async def range_(tmp_path: Path) -> AsyncIterator[Range]:
    """The listener, and a bare session for every other member, none of ours between it and the bus."""
    field = Field(tmp_path / "keys").make()
    revoked = tmp_path / "revoked.json5"
    revoked.write_bytes(field.config("vehicle-3").read_bytes())
    field.change("id = 3\n", "id = 3\nkey = 2\n")
    field.make()
    ground = await open_zenoh(listen=True, config_file=field.config("ground"))
    assert ground.how == "listening", ground.status()
    sessions = {"ground": ground._session}
    for who in EVERYBODY[:-1]:
        if who != "ground":
            sessions[who] = await asyncio.to_thread(open_bare, field.config(who))
    sessions["revoked"] = await asyncio.to_thread(open_bare, revoked)
    yield Range(field, ground, sessions)
    for who, session in sessions.items():
        if who != "ground":
            await asyncio.to_thread(session.close)
    await ground.close()


def open_bare(file: Path) -> Any:
    config = zenoh.Config.from_file(str(file))
    config.insert_json5("connect/timeout_ms", "3000")
    config.insert_json5("connect/exit_on_failure", "true")
    return zenoh.open(config)


@pytest.mark.real
async def test_what_anybody_puts_arrives_where_the_table_says_and_nowhere_else(range_: Range) -> None:
    heard: set[tuple[str, str, str]] = set()

    def listen(reader: str, key: str) -> Any:
        def arrived(sample: Any) -> None:
            if str(sample.key_expr) == key:
                heard.add((sample.payload.to_bytes().decode(), reader, key))

        return range_.sessions[reader].declare_subscriber(key, arrived)

    put = (Delivery.LATEST, Delivery.CACHED, Delivery.EVENT)
    every = [(topic, id, key) for topic, id, key in places()]
    subscribers = [listen(reader, key) for reader in EVERYBODY for _, _, key in every]
    await asyncio.sleep(0.5)
    wanted = {entry for entry in expected(put)}
    for _ in range(round(patience(6.0))):
        for writer in EVERYBODY:
            for _, _, key in every:
                range_.sessions[writer].put(key, writer.encode())
            await asyncio.sleep(0.15)  # another writer's turn: the listener bounds the rate of a key
        await asyncio.sleep(0.3)
        if {h for h in heard if h[0] != h[1]} >= wanted:
            break
    tokens = (Delivery.TOKEN, Delivery.REQUEST)
    bare = {(w, r, key) for w, r, key in heard if w != r and key not in _keys(tokens)}
    assert bare == wanted
    # a put on a topic of requests or tokens reaches nobody but whom the listener's own computer tells
    assert {h for h in heard if h[2] in _keys(tokens) and "ground" not in h[:1] and h[0] != h[1]} == set()
    del subscribers


@pytest.mark.real
async def test_orders_are_asked_by_stations_and_answered_by_the_vehicle_alone(range_: Range) -> None:
    def serve(server: str, key: str) -> Any:
        def asked(query: Any) -> None:
            with query:
                query.reply(key, server.encode())

        return range_.sessions[server].declare_queryable(key, asked)

    every = list(places())
    serving = [serve(who, key) for who in EVERYBODY for _, _, key in every]
    await asyncio.sleep(0.7)

    def ask(who: str, key: str) -> set[tuple[str, str, str]]:
        replies = range_.sessions[who].get(
            key, timeout=1.0, target=zenoh.QueryTarget.ALL, consolidation=zenoh.ConsolidationMode.NONE
        )
        answers = [reply.ok.payload.to_bytes().decode() for reply in replies if reply.ok is not None]
        return {(who, server, key) for server in answers if server != who}

    found: set[tuple[str, str, str]] = set()
    for who in EVERYBODY:
        found |= set().union(
            *await asyncio.gather(*(asyncio.to_thread(ask, who, key) for _, _, key in every))
        )
    # what ground serves or asks is its own program's doing, which no rule between computers concerns
    forged = {f for f in found if "ground" not in f[:2]} - expected((Delivery.REQUEST,))
    assert forged == set()
    assert {e for e in expected((Delivery.REQUEST,)) if e[1] != "ground"} <= found
    del serving


@pytest.mark.real
async def test_a_token_shows_where_the_table_says(range_: Range) -> None:
    seen: set[tuple[str, str]] = set()
    watching = [
        range_.sessions[reader].liveliness().declare_subscriber(
            key, lambda sample, reader=reader, key=key: seen.add((reader, key))
        )
        for reader in EVERYBODY
        for topic, _, key in places()
    ]  # fmt: skip
    await asyncio.sleep(0.5)
    found = set()
    for writer in EVERYBODY:
        seen.clear()
        tokens = [range_.sessions[writer].liveliness().declare_token(key) for _, _, key in places()]
        await asyncio.sleep(0.4)
        found |= {(writer, reader, key) for reader, key in seen if reader != writer}
        for token in tokens:
            token.undeclare()
        await asyncio.sleep(0.3)
    alive = _keys((Delivery.TOKEN,))
    assert {f for f in found if f[2] in alive} == expected((Delivery.TOKEN,))
    assert {f for f in found if f[2] not in alive and "ground" not in f[:2]} == set()
    del watching


@pytest.mark.real
async def test_who_comes_late_gets_what_is_kept_through_the_rules(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    ground = await open_zenoh(listen=True, config_file=field.config("ground"))
    vehicle = await open_zenoh(config_file=field.config("vehicle-2"))
    buses = [ground, vehicle]
    try:
        await until(vehicle.connected)
        ground.publish(SETUP.key(GAME), b"setup", Delivery.CACHED)
        ground.publish(EVADER_BRIEF.key(GAME), b"brief", Delivery.CACHED)
        for number in range(3):
            vehicle.publish(EVENTS.key(GAME, 2), str(number).encode(), Delivery.EVENT)
        heard: dict[str, list[Any]] = {}
        for who in ("vehicle-1", "vehicle-3", "second"):
            bus = await open_zenoh(config_file=field.config(who))
            buses.append(bus)
            heard[who] = []
            keys = [everything(GAME)] if who == "second" else [SETUP.key(GAME), EVADER_BRIEF.key(GAME)]
            for key in keys:
                bus.subscribe(key, lambda sample, who=who: heard[who].append(sample.payload))
        await until(lambda: heard["vehicle-1"] and heard["vehicle-3"] and len(heard["second"]) >= 5)
        await asyncio.sleep(0.5)
        assert sorted(heard["second"]) == [b"0", b"1", b"2", b"brief", b"setup"]
        assert sorted(heard["vehicle-1"]) == [b"brief", b"setup"]
        assert heard["vehicle-3"] == [b"setup"]
    finally:
        for bus in buses[::-1]:
            await bus.close()


@pytest.mark.real
async def test_a_member_whose_certificate_was_revoked_is_told_so(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys").make()
    old = tmp_path / "old" / "vehicle-3"
    old.mkdir(parents=True)
    for file in field.config("vehicle-3").parent.iterdir():
        (old / file.name).write_bytes(file.read_bytes())
        (old / file.name).chmod(0o600)
    field.change("id = 3\n", "id = 3\nkey = 2\n")
    field.make()
    ground = await open_zenoh(listen=True, config_file=field.config("ground"))
    bus = await open_zenoh(config_file=old / "zenoh.json5")
    try:
        heard: list[Any] = []
        ground.subscribe(everything(GAME), heard.append)

        def told() -> bool:
            bus.publish(STATE.key(GAME, 3), b"forged", Delivery.LATEST)
            return "is vehicle-3.1 in its roster?" in bus.status()

        await until(told)
        assert heard == []
        assert ground.counters()["datagrams_foreign"] > 0
    finally:
        await bus.close()
        await ground.close()


def _keys(deliveries: tuple[Delivery, ...]) -> set[str]:
    return {key for topic, _, key in places() if topic.delivery in deliveries}


@pytest.mark.real
@pytest.mark.parametrize(
    ("stranger", "why"),
    [
        ("foreign", "another authority"),
        ("expired", "has expired"),
        ("none", "demands a certificate"),
    ],
)
async def test_a_stranger_does_not_get_in_and_is_told_why(tmp_path: Path, stranger: str, why: str) -> None:
    field = Field(tmp_path / "keys").make()
    own = tmp_path / "own" / "vehicle-2"
    own.mkdir(parents=True)
    for file in field.config("vehicle-2").parent.iterdir():
        (own / file.name).write_bytes(file.read_bytes())
        (own / file.name).chmod(0o600)
    file = own / "zenoh.json5"
    config = json.loads(file.read_text())
    tls = config["transport"]["link"]["tls"]
    if stranger == "none":
        del tls["connect_certificate_base64"], tls["connect_private_key_base64"]
    else:
        other = Field(tmp_path / "other", field.port)
        if stranger == "expired":  # of the same authority, as it was then
            other.folder.mkdir()
            for name in ("authority.key", "authority.pem"):
                (other.folder / name).write_bytes((field.folder / name).read_bytes())
                (other.folder / name).chmod(0o600)
        other.make(expired() if stranger == "expired" else None)
        theirs = json.loads(other.config("vehicle-2").read_text())["transport"]["link"]["tls"]
        tls |= {name: theirs[name] for name in ("connect_certificate_base64", "connect_private_key_base64")}
    file.write_text(json.dumps(config))
    ground = await open_zenoh(listen=True, config_file=field.config("ground"))
    bus = await open_zenoh(config_file=file)
    try:
        await until(lambda: why in bus.status())
        assert not bus.connected()
        assert not ground.connected()
    finally:
        await bus.close()
        await ground.close()
