"""Who may put, hear, ask and announce what: access rules for Zenoh, from the table of topics and a roster.

The station that listens enforces them on every connection, by the common name of its certificate; what no
rule allows is denied. So a row that is added to the table has its rules at once.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from typing import Any, NamedTuple

from onboard.game.field_roster import FieldRoster, Member
from onboard.wire.bus.topics import COMMAND, ID, STATE, TOPICS, Delivery, Table, Topic, echo_key, everything

BY_DATAGRAM: tuple[Topic[Any], ...] = (STATE, COMMAND)  # these travel as datagrams too
KEPT = (Delivery.CACHED, Delivery.EVENT)
LATEST_FACTOR = 5.0  # a topic's nominal rate times this passes the listener, and no more
ORDERS_HZ = 50.0  # orders of one station to one vehicle that pass the listener
PAYLOAD_MAX = 65_536  # [bytes] no message of the table comes near it


class Use(Enum):
    """What a member does with a key."""

    WRITE = "write"  # puts; of a request: asks; of a token: announces
    READ = "read"  # hears; of a request: answers; of a token: sees


class Grant(NamedTuple):
    """A member's right to use one topic's keys."""

    topic: Topic[Any]
    use: Use
    ids: tuple[int | None, ...]  # of the vehicles in the key; (None,) where it holds none


def grants(member: Member, roster: FieldRoster, table: Table = TOPICS) -> list[Grant]:
    """What the table allows to a member."""
    found = []
    for topic in table:
        if topic.delivery is Delivery.LOCAL:
            continue
        for use, parties in ((Use.WRITE, topic.writers), (Use.READ, topic.readers)):
            ids = sorted({id for party in parties for id in member.vehicles_of(party, roster)})
            if ids:
                found.append(Grant(topic, use, tuple(ids) if ID in topic.suffix else (None,)))
    return found


def access_control(roster: FieldRoster, table: Table = TOPICS) -> dict[str, Any]:
    """Zenoh's `access_control` for the station that listens. Connections are its subjects: the other
    members', and those of other programs on its own computer."""
    rules: list[dict[str, Any]] = []
    subjects, policies = [], []
    for member in roster.members:
        own = _rules(member, roster, table)
        rules += own
        subjects.append({"id": member.name, "cert_common_names": [member.certificate]})
        policies.append({"rules": [rule["id"] for rule in own], "subjects": [member.name]})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": subjects,
        "policies": policies,
    }


def low_pass() -> list[dict[str, Any]]:
    """Zenoh's `low_pass_filter`: messages of more than `PAYLOAD_MAX` bytes end where they arrive."""
    kinds = ["put", "delete", "query", "reply"]
    return [
        {"id": "payload", "flows": ["ingress"], "messages": kinds, "key_exprs": ["**"],
         "size_limit": PAYLOAD_MAX}
    ]  # fmt: skip


def downsampling(roster: FieldRoster, table: Table = TOPICS) -> list[dict[str, Any]]:
    """Zenoh's `downsampling` for the station that listens: a bound on the rate of each LATEST key
    and of orders.

    Each connection has its own count, so nobody uses up another's share.
    """
    ids = [vehicle.id for vehicle in roster.vehicles]
    rules = [
        {"key_expr": topic.key(roster.game, id), "freq": topic.rate_hz * LATEST_FACTOR}
        for topic in table
        if topic.delivery is Delivery.LATEST and topic.rate_hz > 0.0
        for id in (ids if ID in topic.suffix else [None])
    ]
    orders = [{"key_expr": COMMAND.key(roster.game, id), "freq": ORDERS_HZ} for id in ids]
    return [
        {"id": "rates", "flows": ["ingress"], "messages": ["put"], "rules": rules},
        {"id": "orders", "flows": ["ingress"], "messages": ["query"], "rules": orders},
    ]


def _rules(member: Member, roster: FieldRoster, table: Table) -> list[dict[str, Any]]:
    """The rules of one member, as the listener sees its connection: ingress is what it sends."""
    wanted: dict[tuple[str, str], list[str]] = {}  # (flow, message) → key expressions

    def allow(flow: str, messages: Iterable[str], keys: Iterable[str]) -> None:
        for message in messages:
            place = wanted.setdefault((flow, message), [])
            place += [key for key in keys if key not in place]

    allow("ingress", ["query"], [echo_key(roster.game)])
    allow("egress", ["reply", "declare_queryable"], [echo_key(roster.game)])
    whole = 0
    for topic, use, ids in grants(member, roster, table):
        keys = [topic.key(roster.game, id) for id in ids]
        if topic.delivery is Delivery.REQUEST:
            asks, answers = ("ingress", "egress") if use is Use.WRITE else ("egress", "ingress")
            allow(asks, ["query"], keys)
            allow(answers, ["reply", "declare_queryable"], keys)
            continue
        there, back = ("ingress", "egress") if use is Use.WRITE else ("egress", "ingress")
        if topic.delivery is Delivery.TOKEN:
            allow(there, ["liveliness_token"], keys)
            seen = [*keys, topic.key(roster.game)]
            allow(back, ["liveliness_query", "declare_liveliness_subscriber"], seen)
            continue
        patterns = [topic.key(roster.game)] if use is Use.READ and len(ids) == len(roster.vehicles) else []
        allow(there, ["put"], keys)
        allow(back, ["declare_subscriber"], [*keys, *patterns])
        if topic.delivery in KEPT:  # Zenoh's advanced publishers and subscribers talk below `@adv`
            extra = [f"{key}/@adv/**" for key in keys]
            asked = [*extra, *(f"{pattern}/@adv/**" for pattern in patterns)]
            allow(there, ["put", "declare_queryable", "liveliness_token"], extra)
            allow(there, ["reply"], [*keys, *extra])
            listening = ["declare_subscriber", "query", "liveliness_query", "declare_liveliness_subscriber"]
            allow(back, listening, asked)
        whole += use is Use.READ and member.vehicle is None
    # Who writes must learn who listens, by whatever pattern, now or later: else its messages stay with it.
    # What it may put, and what is sent to it, the lines above name.
    below = everything(roster.game)
    allow("egress", ["declare_subscriber"], [below, f"{below}/@adv/**"])
    allow("egress", ["query", "liveliness_query", "declare_liveliness_subscriber"], [f"{below}/@adv/**"])
    if whole:  # a station listens to the whole game, and is sent what the lines above name
        every = f"{everything(roster.game)}/@adv/**"
        allow("ingress", ["declare_subscriber"], [everything(roster.game), every])
        allow("ingress", ["query", "liveliness_query", "declare_liveliness_subscriber"], [every])
    return [
        {
            "id": f"{member.name} {flow} {message}",
            "permission": "allow",
            "flows": [flow],
            "messages": [message],
            "key_exprs": keys,
        }
        for (flow, message), keys in wanted.items()
    ]
