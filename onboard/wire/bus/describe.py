"""The table of topics as docs/conventions.md has it: `python -m onboard.wire.bus.describe` prints it."""

from __future__ import annotations

from typing import Any

from onboard.wire.bus.topics import TOPICS, Party, RequestTopic, Table, Topic

HEAD = ("key below `apollonius/<game>/`", "message", "what it says", "delivery", "rate", "writers", "readers")


def described(table: Table) -> str:
    """A table of topics in Markdown, one row for each, with a line's end after each."""
    rows = [HEAD, ("---",) * len(HEAD), *(_row(topic) for topic in table)]
    return "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _row(topic: Topic[Any]) -> tuple[str, ...]:
    message = f"`{topic.message.__name__}`"
    if isinstance(topic, RequestTopic):
        message += f" → `{topic.reply.__name__}`"
    return (
        f"`{topic.suffix}`",
        message,
        topic.says,
        topic.delivery.value,
        f"{topic.rate_hz:g} Hz" if topic.rate_hz else "on change",
        _parties(topic.writers),
        _parties(topic.readers),
    )


def _parties(parties: tuple[Party, ...]) -> str:
    return ", ".join(party.value for party in parties)


if __name__ == "__main__":
    print(described(TOPICS), end="")
