"""What changes the picture without coming over the bus as such: the station's own messages.

The picture is a reduction of one stream of (key, payload, now_ns). Liveliness, commands, their
replies, acknowledgements and the station's own remarks therefore travel as messages too, on keys
below `apollonius/<game>/gcs/`. A recorder writes them like any other, and a replay that reads them
gives the same picture. They are not published on the bus.
"""

from __future__ import annotations

from typing import Any

from onboard.wire.bus.codec import M
from onboard.wire.bus.messages import Command, CommandReply, Message, Severity
from onboard.wire.bus.topics import TOPICS, Delivery, Party, Table, Topic

FOLDER = "gcs"  # the journal's keys lie below it


class Presence(Message, frozen=True):
    """A liveliness token appeared or went."""

    key: str
    alive: bool


class Sent(Message, frozen=True):
    """The operator gave a command to these vehicles; the same command again names further ones."""

    command: Command
    ids: tuple[int, ...]
    everybody: bool = False  # and to whoever answers a call to all agents of the game


class Replied(Message, frozen=True):
    """An agent answered a command."""

    reply: CommandReply


class Acknowledged(Message, frozen=True):
    """The operator has seen an alert."""

    alert: str  # the alert's name, `Alert.name`; "" = all
    by: str


class Remark(Message, frozen=True):
    """Something the station itself has to say (port taken, disk full …)."""

    severity: Severity
    kind: str  # machine-readable
    text: str  # for a person
    advice: str = ""  # what to do; with one, a warning or an error becomes an alert
    over: bool = False  # True: the alert that an earlier remark of this kind raised is over


def _row(name: str, message: type[M], says: str) -> Topic[M]:
    station = (Party.STATION,)
    return Topic(f"{FOLDER}/{name}", message, Delivery.LOCAL, station, station, says)


PRESENCE = _row("presence", Presence, "a liveliness token appeared or went")
SENT = _row("sent", Sent, "the operator gave a command")
REPLIED = _row("replied", Replied, "an agent answered a command")
ACKNOWLEDGED = _row("acknowledged", Acknowledged, "the operator has seen an alert")
REMARK = _row("remark", Remark, "the station's own remark")

JOURNAL: tuple[Topic[Any], ...] = (PRESENCE, SENT, REPLIED, ACKNOWLEDGED, REMARK)
HEARD_HERE = Table((*TOPICS, *JOURNAL))  # all that the picture is made of, and all that is recorded
