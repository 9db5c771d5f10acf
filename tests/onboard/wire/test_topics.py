"""The table of topics: every row is heard, recorded, replayed and documented from the row alone."""

from __future__ import annotations

import tracemalloc
from collections import Counter
from copy import deepcopy
from enum import Enum
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader

from gcs.picture.fleet import Fleet
from gcs.picture.station_journal import HEARD_HERE, JOURNAL
from gcs.recording.reader import Recording
from gcs.recording.recorder import Recorder
from gcs.recording.schemas import layout_of
from onboard.wire.bus.describe import described
from onboard.wire.bus.messages import Health, Message, Outcome, Severity, State
from onboard.wire.bus.topics import (
    COMMAND,
    HEALTH,
    ID,
    SETUP,
    STATE,
    TOPICS,
    TRACK,
    Delivery,
    Dispatcher,
    Party,
    RequestTopic,
    Table,
    Topic,
)
from tests.support.paths import ROOT

VEHICLE = 7
ROWS = [pytest.param(topic, id=topic.suffix) for topic in HEARD_HERE]
ON_BUS = [pytest.param(topic, id=topic.suffix) for topic in TOPICS]


class Weather(Message, frozen=True):
    """A message that the product does not have."""

    id: int
    severity: Severity
    gust: float  # [m/s]


WEATHER = Topic(
    "vehicles/{id}/weather", Weather, Delivery.LATEST, (Party.OWN_AGENT,), (Party.STATION,), "gusts", 1.0
)


def sample(kind: type[Any]) -> Any:
    """A message of a type, made from its fields' types alone; the fields called `id` name VEHICLE."""
    fields = {}
    for field in msgspec.inspect.type_info(kind).fields:  # type: ignore[attr-defined]
        fields[field.name] = VEHICLE if field.name == "id" else _value(field.type)
    return kind(**fields)


def _value(kind: Any) -> Any:
    match type(kind).__name__:
        case "StructType":
            return sample(kind.cls)
        case "EnumType":
            return next(iter(kind.cls))
        case "TupleType":
            return tuple(_value(item) for item in kind.item_types)
        case "VarTupleType":
            return (_value(kind.item_type),)
        case "UnionType":
            return _value(kind.types[0])
        case "DictType":
            return {_value(kind.key_type): _value(kind.value_type)}
    return {"IntType": 3, "FloatType": 1.5, "StrType": "word", "BoolType": True, "NoneType": None}[
        type(kind).__name__
    ]


def place(topic: Topic[Any], game: str = "g") -> str:
    """The key of a topic of VEHICLE."""
    return topic.key(game, VEHICLE if ID in topic.suffix else None)


@pytest.mark.parametrize("topic", ROWS)
def test_what_is_encoded_is_heard_again_with_its_topic_and_vehicle(topic: Topic[Any]) -> None:
    message, drops = sample(topic.message), Counter[str]()
    heard = HEARD_HERE.heard(place(topic), topic.encode(message), drops)
    assert heard == (topic, VEHICLE if ID in topic.suffix else None, message)
    assert not drops
    found = HEARD_HERE.find(place(topic, "another"))
    assert found is not None
    assert (found.topic, found.game) == (topic, "another")


@pytest.mark.parametrize("topic", ROWS)
def test_every_topic_is_recorded_with_its_schema_and_read_back(topic: Topic[Any], tmp_path: Path) -> None:
    payload = topic.encode(sample(topic.message))
    recorder = Recorder(tmp_path / "flight.mcap", "g", views=False)
    recorder.record(place(topic), payload, 10)
    recorder.close()
    recording = Recording(tmp_path / "flight.mcap")
    assert [(entry.key, entry.payload) for entry in recording.entries()] == [(place(topic), payload)]
    with (tmp_path / "flight.mcap").open("rb") as file:
        ((schema, channel, message),) = make_reader(file).iter_messages()
    assert (channel.topic, message.data) == (place(topic), payload)
    assert schema is not None
    assert schema.name == f"apollonius.{topic.message.__name__}"
    _, fields = msgspec.json.decode(schema.data)["prefixItems"]
    titles = [field["title"] for field in fields.get("prefixItems", ())]
    assert titles == list(topic.message.__struct_fields__)


@pytest.mark.parametrize("topic", ROWS)
def test_every_topic_that_carries_messages_is_taken_into_the_picture(topic: Topic[Any]) -> None:
    fleet = Fleet("g")
    payload = topic.encode(sample(topic.message))
    carries = topic.delivery not in (Delivery.REQUEST, Delivery.TOKEN)
    assert (fleet.apply(place(topic), payload, 10) is not None) is carries
    assert fleet.drops["foreign"] == (0 if carries and topic.message.__name__ != "Presence" else 1)


@pytest.mark.parametrize("topic", ON_BUS)
def test_states_that_people_read_travel_as_their_words(topic: Topic[Any]) -> None:
    message = sample(topic.message)
    _, fields = msgspec.msgpack.decode(topic.encode(message))
    for name, value in zip(topic.message.__struct_fields__, fields, strict=True):
        if isinstance(getattr(message, name), Enum):
            assert value == getattr(message, name).value
            assert isinstance(value, str)


@pytest.mark.parametrize("topic", ROWS)
def test_every_row_says_who_writes_and_who_reads(topic: Topic[Any]) -> None:
    assert topic.writers
    assert topic.readers
    assert Party.STATION in (*topic.readers, *topic.writers)  # the station hears all there is
    if not topic.suffix.startswith("vehicles/"):
        assert Party.OWN_AGENT not in (*topic.readers, *topic.writers)


def test_no_opponent_reads_a_state_and_nobody_but_the_evader_its_brief() -> None:
    assert {Party.ANY_AGENT, Party.EVADER}.isdisjoint(STATE.readers)
    brief = next(topic for topic in TOPICS if topic.suffix == "roles/evader/brief")
    assert {Party.ANY_AGENT, Party.OWN_AGENT, Party.SAME_SIDE}.isdisjoint(brief.readers)


def test_a_message_more_is_a_struct_and_a_row() -> None:
    """The same code hears it, gives it a schema and documents it."""
    table = Table((*HEARD_HERE, WEATHER))
    gust = Weather(VEHICLE, Severity.WARNING, 12.5)
    payload = WEATHER.encode(gust)
    heard = table.heard(WEATHER.key("g", VEHICLE), payload, Counter())
    assert heard == (WEATHER, VEHICLE, gust)
    seen: list[Weather] = []
    Dispatcher(Counter(), table).on(WEATHER, seen.append)((WEATHER.key("g", VEHICLE), payload))
    assert seen == [gust]
    layout = layout_of(WEATHER)
    assert layout.name == "apollonius.Weather"
    assert b'"title":"gust"' in layout.schema
    assert b'"enum":["error","info","warning"]' in layout.schema
    row = described(table).splitlines()[-1]
    assert row == "| `vehicles/{id}/weather` | `Weather` | gusts | latest | 1 Hz | own agent | station |"
    assert HEARD_HERE.find(WEATHER.key("g", VEHICLE)) is None  # other tables do not know it


def test_the_conventions_show_the_table_as_it_is() -> None:
    text = (ROOT / "docs" / "conventions.md").read_text()
    assert described(TOPICS) in text, "run python -m onboard.wire.bus.describe and put it into the page"


def test_the_journal_never_travels_on_the_bus() -> None:
    assert {topic.delivery for topic in JOURNAL} == {Delivery.LOCAL}
    assert Delivery.LOCAL not in {topic.delivery for topic in TOPICS}


def test_what_speaks_for_another_vehicle_is_dropped_and_counted() -> None:
    drops: Counter[str] = Counter()
    payload = HEALTH.encode(sample(Health))
    assert TOPICS.heard(HEALTH.key("g", VEHICLE + 1), payload, drops) is None
    assert drops == {"wrong_id": 1}


@pytest.mark.parametrize(
    "key",
    [
        "", "/", "apollonius", "apollonius/g", "apollonius//game/setup", "apollonius/g/game/setup/x",
        "x/g/game/setup",
        "apollonius/g/vehicles/0/state", "apollonius/g/vehicles/1001/state", "apollonius/g/vehicles/07/state",
        "apollonius/g/vehicles/-1/state", "apollonius/g/vehicles/٣/state", "apollonius/g/vehicles/state",
        "apollonius/g/vehicles/{id}/state", "apollonius/g/vehicles/*/state", "apollonius/g/tracks/1/state",
        f"apollonius/g/vehicles/{'9' * 5000}/state",
    ],
)  # fmt: skip
def test_a_foreign_key_is_counted(key: str) -> None:
    drops: Counter[str] = Counter()
    assert TOPICS.heard(key, STATE.encode(sample(State)), drops) is None
    assert drops == {"foreign": 1}


@settings(max_examples=200, deadline=None)
@given(st.sampled_from([place(topic) for topic in HEARD_HERE]), st.binary(max_size=80))
def test_no_bytes_raise_and_none_pass_uncounted(key: str, payload: bytes) -> None:
    drops: Counter[str] = Counter()
    heard = HEARD_HERE.heard(key, payload, drops)
    assert (heard is None) == (drops.total() == 1)


def test_keys_from_the_network_do_not_fill_the_memory() -> None:
    table = Table(TOPICS)
    tracemalloc.start()
    try:
        for number in range(40_000):
            table.find(f"apollonius/game-{number}/game/setup")
            table.find(f"foreign-{number}")
        held, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert held < 4 << 20  # unbounded it would be about 20 MiB


def test_a_word_that_the_enum_does_not_have_is_dropped() -> None:
    drops: Counter[str] = Counter()
    outcome = next(topic for topic in TOPICS if topic.message is Outcome)
    schema, fields = msgspec.msgpack.decode(outcome.encode(sample(Outcome)))
    payload = msgspec.msgpack.encode([schema, ["won", *fields[1:]]])
    assert outcome.decode(payload, drops) is None
    assert drops == {"undecodable": 1}


def test_a_dispatcher_gives_each_message_to_its_taker_and_leaves_the_others() -> None:
    states: list[State] = []
    drops: Counter[str] = Counter()
    hear = Dispatcher(drops).on(STATE, states.append)
    assert hear.topics == (STATE,)
    hear((STATE.key("g", VEHICLE), STATE.encode(sample(State))))
    hear((TRACK.key("g", VEHICLE), TRACK.encode(sample(TRACK.message))))
    hear((STATE.key("g", VEHICLE), b"\x00"))
    assert states == [sample(State)]
    assert drops == {"undecodable": 1}


def test_a_request_and_its_reply_each_have_their_codec() -> None:
    assert isinstance(COMMAND, RequestTopic)
    drops: Counter[str] = Counter()
    reply = sample(COMMAND.reply)
    assert COMMAND.decode_reply(COMMAND.encode_reply(reply), drops) == reply
    assert COMMAND.decode(COMMAND.encode_reply(reply), drops) is None
    assert drops == {"undecodable": 1}


def test_keys_of_one_vehicle_of_all_and_of_none() -> None:
    assert STATE.key("g", 3) == "apollonius/g/vehicles/3/state"
    assert STATE.key("g") == "apollonius/g/vehicles/*/state"
    assert SETUP.key("g") == "apollonius/g/game/setup"
    with pytest.raises(ValueError, match="holds no vehicle's id: found 3"):
        SETUP.key("g", 3)
    with pytest.raises(ValueError, match="two topics have one key"):
        Table((STATE, STATE))
    assert deepcopy({STATE: 1})[STATE] == 1
