"""Differences that are meant: how a message of today's shape is turned into the shape that was recorded.

When messages are reshaped on purpose (fields regrouped, words that become numbers) the recorded values keep
their worth: add a row to TRANSLATIONS, whose `back` gives the recorded shape again. What is found is
translated before it is compared; what was recorded never is. A row lives until the next recording, which
demands an empty table: it would otherwise hide what it was not meant for.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple


class Translation(NamedTuple):
    """One meant difference. Messages are what MessagePack and JSON decode to: lists, dicts, numbers, text."""

    topic: str  # regular expression for the whole topic as it is now, as in r"vehicles/[0-9]+/health"
    back: Callable[[Any], Any]  # today's message → the recorded shape
    why: str  # for whoever reads the table
    was: str = r"\g<0>"  # the topic's recorded name, as in re.sub


# Topics as in `bus` (without the game's name), in `viewers`, and "summary" for a game's summary.json.
TRANSLATIONS: tuple[Translation, ...] = ()


def without_version(message: Any) -> Any:
    """A health message without the package's version, which every release changes."""
    match message:
        case [schema, [*body]] if len(body) > VERSION_AT:
            return [schema, [*body[:VERSION_AT], "", *body[VERSION_AT + 1 :]]]
    return message


VERSION_AT = 16  # place of the version in a health message as recorded

# Not compared at all. Applied when recording and when comparing, after the translations.
EXCLUDED: tuple[Translation, ...] = (
    Translation(r"vehicles/[0-9]+/health", without_version, "the version is the package's, not the game's"),
)


def translated(topic: str, message: Any, table: Sequence[Translation]) -> tuple[str, Any]:
    """Topic and message after every row of the table that fits the topic, in the table's order."""
    for row in table:
        if re.fullmatch(row.topic, topic):
            topic, message = re.sub(row.topic, row.was, topic), row.back(message)
    return topic, message
