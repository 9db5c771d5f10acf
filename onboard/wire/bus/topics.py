"""The table of topics of the bus, and the one way from a key and a payload to a message.

A topic is a row of the table: its key, its message, how it is delivered, how often, who writes it and who
reads it. Whoever publishes uses the row's `key` and `encode`, whoever hears uses `Table.heard` or a
`Dispatcher`. The recorder, the schemas of a recording, replay and docs/conventions.md take the table as it
is, so that a new message is a struct in `messages` and a row here.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Generic, NamedTuple, TypeVar

from onboard.core.math.each import new
from onboard.wire.bus.codec import Codec, M
from onboard.wire.bus.knowledge_messages import Knowledge
from onboard.wire.bus.messages import (
    Alive,
    Command,
    CommandReply,
    DecisionReport,
    EvaderBrief,
    Event,
    Health,
    Master,
    Message,
    Outcome,
    OwnBrief,
    PhaseChange,
    Setup,
    State,
    Track,
)
from onboard.wire.bus.team_messages import TeamPlan

ROOT = "apollonius"
DEFAULT_GAME = "game"  # the game that all programs join unless told another
ID = "{id}"  # stands in a key for a vehicle's id
IDS_MOST = 1000  # an agent's id is its MAVLink system id, 1 to 250; several networks on one bus have more
IDS = {str(id): id for id in range(1, IDS_MOST + 1)}  # as they stand in keys
PLACES_KEPT = 16 * IDS_MOST  # keys of which a table remembers the topic

R = TypeVar("R", bound=Message)


class Delivery(Enum):
    """How a topic is delivered."""

    LATEST = "latest"  # latest wins; dropped under congestion
    CACHED = "cached"  # a late joiner gets the last value
    EVENT = "event"  # cached, numbered, recovered
    REQUEST = "request"  # request and reply, blocking
    TOKEN = "token"  # a liveliness token: there or not, no payload
    LOCAL = "local"  # within one program, and in its recording


class Party(Enum):
    """Who takes part in the bus, as the access rules of a topic name them.

    Joined with a game's roster the parties become vehicles: a topic `vehicles/{id}/…` that OWN_AGENT
    writes and SAME_SIDE reads is written by agent n alone and read by the agents of n's role.
    """

    OWN_AGENT = "own agent"  # the agent of the vehicle that the key names
    SAME_SIDE = "same side"  # the agents of the vehicles that have the role of the vehicle in the key
    ANY_AGENT = "any agent"  # every agent of the roster
    EVADER = "evader"  # the evader's agent
    MASTER = "master"  # the game's master: the bridge in simulation, the ground station in the field
    STATION = "station"  # ground stations
    SENSOR = "sensor"  # what reports tracks: the bridge in simulation


@dataclass(frozen=True, eq=False)
class Topic(Generic[M]):
    """One row of the table. Two topics are the same where they are the same object."""

    suffix: str  # the key below `apollonius/<game>/`; `{id}` stands for a vehicle's id
    message: type[M]
    delivery: Delivery
    writers: tuple[Party, ...]
    readers: tuple[Party, ...]
    says: str  # in a few words, for the documents
    rate_hz: float = 0.0  # nominal [Hz]; 0 = on change
    codec: Codec[M] = field(init=False, repr=False)
    names_vehicle: bool = field(init=False, repr=False)  # the message repeats the id of its key

    def __post_init__(self) -> None:
        object.__setattr__(self, "codec", Codec(self.message))
        names = ID in self.suffix and "id" in self.message.__struct_fields__
        object.__setattr__(self, "names_vehicle", names)

    def __deepcopy__(self, memo: object) -> Topic[M]:
        """A topic is a constant: a copy of what refers to it refers to it too."""
        return self

    def key(self, game: str, id: int | None = None) -> str:
        """The key in a game. Where it holds a vehicle's id, `id` None gives the pattern over all (`*`).

        Raises ValueError for an id where the key holds none.
        """
        if id is not None and ID not in self.suffix:
            raise ValueError(f"{self.suffix} holds no vehicle's id: found {id}")
        return f"{ROOT}/{game}/{self.suffix.replace(ID, '*' if id is None else str(id))}"

    def encode(self, message: M) -> bytes:
        """The payload of a message."""
        return self.codec.encode(message)

    def decode(self, payload: bytes, drops: Counter[str]) -> M | None:
        """The message of a payload; None (and one more in `drops`, by cause) for a bad one."""
        return self.codec.decode(payload, drops)


@dataclass(frozen=True, eq=False)
class RequestTopic(Topic[M], Generic[M, R]):
    """A topic of requests, each answered by a reply: `message` is the request."""

    reply: type[R] = field(kw_only=True)
    reply_codec: Codec[R] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "reply_codec", Codec(self.reply))

    def encode_reply(self, message: R) -> bytes:
        """The payload of a reply."""
        return self.reply_codec.encode(message)

    def decode_reply(self, payload: bytes, drops: Counter[str]) -> R | None:
        """The reply of a payload; None (and one more in `drops`, by cause) for a bad one."""
        return self.reply_codec.decode(payload, drops)


class Place(NamedTuple):
    """What a key says."""

    topic: Topic[Any]
    game: str
    id: int | None  # of the vehicle; None where the topic's key holds none


class Heard(NamedTuple):
    """One message, and the topic and the vehicle that its key names."""

    topic: Topic[Any]
    id: int | None
    message: Message


def told(place: Place, payload: bytes, drops: Counter[str]) -> Any | None:
    """The message of a payload at a place; None where it is bad, and one more in `drops`: see `heard`."""
    topic, _, id = place
    message = topic.codec.decode(payload, drops)
    if message is not None and topic.names_vehicle and message.id != id:
        drops["wrong_id"] += 1
        return None
    return message


class Table:
    """Topics by their keys. Iterates over its rows in the order given."""

    def __init__(self, rows: Iterable[Topic[Any]]) -> None:
        self._rows = tuple(rows)
        self._by_suffix = {topic.suffix: topic for topic in self._rows}
        self._places: dict[str, Place | None] = {}
        if len(self._by_suffix) != len(self._rows):
            raise ValueError("two topics have one key")

    def __iter__(self) -> Iterator[Topic[Any]]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    def find(self, key: str) -> Place | None:
        """Topic, game and vehicle of a full key; None for a key that the table does not have."""
        try:
            return self._places[key]
        except KeyError:
            pass
        if len(self._places) >= PLACES_KEPT:  # keys come from the network
            self._places.clear()
        place = self._places[key] = self._parse(key)
        return place

    def heard(self, key: str, payload: bytes, drops: Counter[str]) -> Heard | None:
        """Decode what came on a key; None (and one more in `drops`, by cause) where it is bad.

        The causes: those of `Codec`, `foreign` (a key that the table does not have) and `wrong_id` (the
        message speaks for another vehicle than its key).
        """
        place = self.find(key)
        if place is None:
            drops["foreign"] += 1
            return None
        return self.told(place, payload, drops)

    def told(self, place: Place, payload: bytes, drops: Counter[str]) -> Heard | None:
        """As `heard`, of a key that was found already."""
        message = told(place, payload, drops)
        if message is None:
            return None
        heard = new(Heard, (place.topic, place.id, message))
        return heard

    def _parse(self, key: str) -> Place | None:
        root, _, below = key.partition("/")
        game, _, suffix = below.partition("/")
        if root != ROOT or not game:
            return None
        topic = self._by_suffix.get(suffix)
        if topic is not None and ID not in suffix:
            return Place(topic, game, None)
        parts = suffix.split("/")
        for index, part in enumerate(parts):
            if part in IDS:
                topic = self._by_suffix.get("/".join((*parts[:index], ID, *parts[index + 1 :])))
                if topic is not None:
                    return Place(topic, game, IDS[part])
        return None


_GAME = (Party.ANY_AGENT, Party.STATION)
_GROUND = (Party.MASTER, Party.STATION)

SETUP = Topic(
    "game/setup", Setup, Delivery.CACHED, (Party.MASTER,), _GAME,
    "the game; the evaders' targets where pursuers may know them",
)
PHASE = Topic("game/phase", PhaseChange, Delivery.CACHED, (Party.MASTER,), _GAME, "phase and t₀")
OUTCOME = Topic("game/outcome", Outcome, Delivery.CACHED, (Party.MASTER,), _GAME, "how the game ended")
MASTER = Topic(
    "game/master", Master, Delivery.LATEST, (Party.MASTER,), (*_GAME, Party.MASTER),
    "the master's lease and clock", 2.0,
)  # fmt: skip
EVADER_BRIEF = Topic(
    "roles/evader/brief", EvaderBrief, Delivery.CACHED, (Party.MASTER,), (Party.EVADER, Party.STATION),
    "the evader's target",
)  # fmt: skip
OWN_BRIEF = Topic(
    "vehicles/{id}/brief", OwnBrief, Delivery.CACHED, (Party.MASTER,), (Party.OWN_AGENT, Party.STATION),
    "the targets of one of several evaders",
)  # fmt: skip
STATE = Topic(
    "vehicles/{id}/state", State, Delivery.LATEST, (Party.OWN_AGENT,), (Party.SAME_SIDE, *_GROUND),
    "own state", 20.0,
)  # fmt: skip
DECISION = Topic(
    "vehicles/{id}/decision", DecisionReport, Delivery.LATEST, (Party.OWN_AGENT,), _GROUND,
    "what was decided and why", 10.0,
)  # fmt: skip
PLAN = Topic(
    "vehicles/{id}/plan", TeamPlan, Delivery.LATEST, (Party.OWN_AGENT,), (Party.SAME_SIDE, *_GROUND),
    "what the planner has its team do", 2.0,
)  # fmt: skip
KNOWLEDGE = Topic(
    "vehicles/{id}/knowledge", Knowledge, Delivery.LATEST, (Party.OWN_AGENT,), _GROUND,
    "what the planner knows, and what its team is after", 1.0,
)  # fmt: skip
HEALTH = Topic(
    "vehicles/{id}/health", Health, Delivery.LATEST, (Party.OWN_AGENT,), (Party.OWN_AGENT, *_GROUND),
    "the agent's heartbeat", 2.0,
)  # fmt: skip
EVENTS = Topic("vehicles/{id}/events", Event, Delivery.EVENT, (Party.OWN_AGENT,), _GROUND, "what happened")
COMMAND = RequestTopic(
    "vehicles/{id}/command", Command, Delivery.REQUEST, (Party.STATION,), (Party.OWN_AGENT,),
    "an order to the vehicle", reply=CommandReply,
)  # fmt: skip
ALIVE = Topic(
    "vehicles/{id}/alive", Alive, Delivery.TOKEN, (Party.OWN_AGENT,), (Party.STATION,),
    "there while the agent is",
)  # fmt: skip
TRACK = Topic(
    "tracks/{id}", Track, Delivery.LATEST, (Party.SENSOR,), _GAME, "an opponent as a sensor reports it", 20.0
)

# Every row above, in the order of the page: a row that is written is in the table.
TOPICS = Table(tuple(row for row in tuple(globals().values()) if isinstance(row, Topic)))


class Dispatcher:
    """Decodes what is heard on the bus and gives each message to the one who takes its topic.

    Subscribe it to the keys of its topics: it is called with (key, payload).
    """

    def __init__(self, drops: Counter[str], table: Table = TOPICS) -> None:
        self._drops = drops
        self._table = table
        self._takers: dict[Topic[Any], Callable[[Any], None]] = {}

    @property
    def topics(self) -> tuple[Topic[Any], ...]:
        """The topics that somebody takes."""
        return tuple(self._takers)

    def on(self, topic: Topic[M], take: Callable[[M], None]) -> Dispatcher:
        """Let `take` have the messages of a topic; the dispatcher itself."""
        self._takers[topic] = take
        return self

    def __call__(self, sample: tuple[str, bytes]) -> None:
        """Take in one (key, payload); what is bad is counted in `drops`, what nobody takes is left."""
        key, payload = sample
        place = self._table.find(key)
        if place is None:
            self._drops["foreign"] += 1
            return
        message = told(place, payload, self._drops)
        if message is not None:
            take = self._takers.get(place.topic)
            if take is not None:
                take(message)


def echo_key(game: str) -> str:
    """The key on which the listener of a field answers every member: the session works both ways.

    It is no topic: it says nothing, and nobody records it.
    """
    return f"{ROOT}/{game}/bus/echo"


def everything(game: str) -> str:
    """The pattern that matches every topic of a game."""
    return f"{ROOT}/{game}/**"
