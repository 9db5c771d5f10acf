"""The table of topics: keys, rates and kinds of delivery on the swarm bus (DESIGN.md)."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

ROOT = "apollonius"
DEFAULT_GAME = "game"  # the game that all programs join unless told another


class Delivery(Enum):
    """How a topic is delivered."""

    LATEST = "latest"  # latest wins; dropped under congestion
    CACHED = "cached"  # a late joiner gets the last value
    EVENT = "event"  # cached, numbered, recovered
    REQUEST = "request"  # request and reply, blocking


class Topic(NamedTuple):
    """One row of the table."""

    suffix: str  # below apollonius/<game>/, `{id}` stands for a vehicle id
    rate_hz: float  # nominal; 0 = on change
    delivery: Delivery


SETUP = Topic("game/setup", 0.0, Delivery.CACHED)
PHASE = Topic("game/phase", 0.0, Delivery.CACHED)
OUTCOME = Topic("game/outcome", 0.0, Delivery.CACHED)
MASTER = Topic("game/master", 2.0, Delivery.LATEST)  # the master's lease and clock
EVADER_BRIEF = Topic("roles/evader/brief", 0.0, Delivery.CACHED)
STATE = Topic("vehicles/{id}/state", 20.0, Delivery.LATEST)
DECISION = Topic("vehicles/{id}/decision", 10.0, Delivery.LATEST)
HEALTH = Topic("vehicles/{id}/health", 2.0, Delivery.LATEST)
EVENTS = Topic("vehicles/{id}/events", 0.0, Delivery.EVENT)
COMMAND = Topic("vehicles/{id}/command", 0.0, Delivery.REQUEST)
ALIVE = Topic("vehicles/{id}/alive", 0.0, Delivery.LATEST)  # liveliness token, no payload
TRACK = Topic("tracks/{id}", 20.0, Delivery.LATEST)

TOPICS = (SETUP, PHASE, OUTCOME, MASTER, EVADER_BRIEF, STATE, DECISION, HEALTH, EVENTS, COMMAND, ALIVE, TRACK)


def key(game: str, topic: Topic, vehicle_id: int | None = None) -> str:
    """The full key of a topic; `vehicle_id` None gives the wildcard over all vehicles (`*`)."""
    suffix = topic.suffix.format(id="*" if vehicle_id is None else vehicle_id)
    return f"{ROOT}/{game}/{suffix}"


def everything(game: str) -> str:
    """The pattern that matches every topic of a game."""
    return f"{ROOT}/{game}/**"


def vehicle_of(full_key: str) -> int | None:
    """The vehicle id in a key, or None where it has none or a bad one."""
    parts = full_key.split("/")
    if len(parts) >= 4 and parts[2] in ("vehicles", "tracks"):
        return int(parts[3]) if parts[3].isascii() and parts[3].isdigit() else None
    return None


def topic_of(full_key: str) -> Topic | None:
    """The row of the table that a key belongs to, or None for a foreign key."""
    parts = full_key.split("/")
    if len(parts) < 4 or parts[0] != ROOT:
        return None
    if parts[2] in ("vehicles", "tracks"):
        parts[3] = "{id}"
    return _BY_SUFFIX.get("/".join(parts[2:]))


_BY_SUFFIX = {topic.suffix: topic for topic in TOPICS}
