"""The command line's language. Pure: text in, an intent or a plain reason out."""

from __future__ import annotations

from typing import NamedTuple

from gcs.picture.values import Picture
from onboard.wire.bus.messages import CommandKind, Role

SORTS = ("id", "role", "health", "battery", "link", "age", "height", "distance")
HELP_LINES = (
    ("abort [WHOM]", "knock it off: hold or return; never disarms; asks nothing"),
    ("hold [WHOM]", "stay here: hover or loiter"),
    ("resume [WHOM]", "go on with the game after a hold, a restart or a take-over"),
    ("start [WHOM]", "let the vehicle act"),
    ("return [WHOM]", "fly home; asks twice"),
    ("land [WHOM]", "land where it is; asks twice"),
    ("ack [all|NAME]", "mark the topmost alert, all, or one as seen"),
    ("select ID", "show a vehicle's detail"),
    ("sort COLUMN", f"sort the table: {', '.join(SORTS)}"),
    ("help, quit", ""),
)
WHOM = "WHOM: all, pursuers, evader, or ids: 2 3 5-7; without it the selected vehicle (abort: all)"


class Order(NamedTuple):
    """A command to vehicles."""

    kind: CommandKind
    ids: tuple[int, ...]
    named: bool = False  # one vehicle, by its id or selected: no word that means many


class Do(NamedTuple):
    """Something for the console itself."""

    what: str  # ack | select | sort | help | quit
    argument: str = ""


class Wrong(NamedTuple):
    """Not understood, and why."""

    reason: str


def parse(text: str, picture: Picture, selected: int | None) -> Order | Do | Wrong:
    """What a line means. Empty lines are Wrong with an empty reason."""
    words = text.lower().replace(",", " ").split()
    if not words:
        return Wrong("")
    verb, rest = words[0], words[1:]
    kinds = {kind.value: kind for kind in CommandKind}
    if verb in kinds:
        return _order(kinds[verb], rest, picture, selected)
    if verb in ("help", "?"):
        return Do("help")
    if verb in ("quit", "exit", "q"):
        return Do("quit")
    if verb == "ack" and len(rest) <= 1:
        return Do("ack", rest[0] if rest else "")
    if verb == "select" and len(rest) == 1:
        if rest[0].isdecimal() and picture.vehicle(int(rest[0])):
            return Do("select", rest[0])
        return Wrong(f"no vehicle {rest[0]}")
    if verb == "sort" and len(rest) == 1:
        return Do("sort", rest[0]) if rest[0] in SORTS else Wrong(f"sort by one of: {', '.join(SORTS)}")
    return Wrong(f"not understood: {text.strip()} (? shows the commands)")


def _order(
    kind: CommandKind, whom: list[str], picture: Picture, selected: int | None
) -> Order | Wrong:
    known = tuple(v.id for v in picture.vehicles)
    if not known:
        return Wrong("no vehicle is known yet")
    if not whom:
        if kind is CommandKind.ABORT:
            return Order(kind, known)
        if selected is None:
            return Wrong(f"{kind.value} whom? {WHOM}")
        return Order(kind, (selected,), named=True)
    ids: set[int] = set()
    for word in whom:
        if word == "all":
            ids.update(known)
        elif word in ("pursuer", "pursuers", "evader", "evaders", "tracker", "trackers"):
            role = Role(word.rstrip("s"))
            found = {v.id for v in picture.vehicles if v.role is role}
            if not found:
                return Wrong(f"no {word} is known")
            ids |= found
        else:
            first, _, last = word.partition("-")
            if not first.isdecimal() or not (last or first).isdecimal() or len(word) > 7:
                return Wrong(f"whom is {word}? {WHOM}")
            span = range(int(first), int(last or first) + 1)
            strangers = [i for i in span if i not in known]
            if not span or strangers:
                return Wrong(f"no vehicle {strangers[0] if strangers else word}")
            ids.update(span)
    return Order(kind, tuple(sorted(ids)), named=len(ids) == 1 and whom == [str(*ids)])


def names(ids: tuple[int, ...], picture: Picture) -> str:
    """Ids for a person: `all 6`, `2, 3`."""
    if len(ids) > 1 and set(ids) == {v.id for v in picture.vehicles}:
        return f"all {len(ids)}"
    return ", ".join(map(str, ids))
