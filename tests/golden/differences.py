"""Where a run differs from the recorded one, in words: stream, second, kind, and which values."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.golden.capture import Item
from tests.golden.digests import WHOLE, Kept, Part, Seconds, kept, second_of

MOST_KINDS = 3  # of one stream that are told in full
MOST_VALUES = 6  # of one item
ABSENT = "nothing"


def values(expected: object, found: object, at: str = "") -> Iterator[str]:
    """Each value that differs between two decoded items, as `place: expected …, found …`."""
    if isinstance(expected, dict) and isinstance(found, dict):
        for key in sorted({*expected, *found}):
            yield from values(expected.get(key, ABSENT), found.get(key, ABSENT), f"{at}.{key}")
    elif isinstance(expected, list) and isinstance(found, list) and len(expected) == len(found):
        for index, (a, b) in enumerate(zip(expected, found, strict=True)):
            yield from values(a, b, f"{at}[{index}]")
    elif repr(expected) != repr(found):
        yield f"{at.lstrip('.') or 'value'}: expected {expected!r}, found {found!r}"


def told(expected: object, found: object) -> list[str]:
    """The first of the differing values, and how many there are beside."""
    lines = list(values(expected, found))
    more = [f"… and {len(lines) - MOST_VALUES} more values"] if len(lines) > MOST_VALUES else []
    return lines[:MOST_VALUES] + more


def first_second(expected: Seconds, found: Seconds) -> dict[str, int]:
    """For each kind that differs, the first second in which it does."""
    first: dict[str, int] = {}
    for kind in {*expected, *found}:
        was, now = expected.get(kind, {}), found.get(kind, {})
        differing = [int(s) for s in {*was, *now} if was.get(s) != now.get(s)]
        if differing:
            first[kind] = min(differing)
    return first


class Comparison:
    """One part against what was recorded of it. `lines()` is empty where nothing differs."""

    def __init__(self, name: str, expected: Kept, part: Part, epoch_ns: int) -> None:
        self.name = name
        self._expected = expected
        self._part = part
        self._epoch_ns = epoch_ns
        self._found = kept(part, epoch_ns, every=1)

    def lines(self, folder: Path) -> list[str]:
        """The differences, the earliest first; what differs is written, decoded, to `folder`."""
        lines = [
            f"{self.name}: summary.json: {text}"
            for text in told(self._expected.overview.get("summary"), self._found.overview.get("summary"))
        ]
        streams: list[tuple[int, str, dict[str, int]]] = []
        for stream in sorted({*self._expected.seconds, *self._found.seconds}):
            first = first_second(self._expected.seconds.get(stream, {}), self._found.seconds.get(stream, {}))
            if first:
                streams.append((min(first.values()), stream, first))
            elif self._digest(self._expected, stream) != self._digest(self._found, stream):
                lines.append(f"{self.name}: {stream}: the bytes differ, though no second does")
        for second, stream, first in sorted(streams, key=lambda entry: entry[:2]):
            lines += self._stream(second, stream, first)
            write_decoded(self._part.streams.get(stream, []), folder / self.name / stream, self._epoch_ns)
        return lines

    def _digest(self, of: Kept, stream: str) -> object:
        return of.overview["streams"].get(stream, {}).get("sha256")

    def _stream(self, second: int, stream: str, first: dict[str, int]) -> list[str]:
        head = f"{self.name}: {stream}: first difference in second {second}"
        differing = sorted(kind for kind, at in first.items() if at == second and kind != WHOLE)
        if not differing:
            return [f"{head}: the same items in another order"]
        later = len(first) - len(differing) - (WHOLE in first)
        lines = [f"{head}: {', '.join(differing)}" + (f"; {later} more kinds later" if later else "")]
        for kind in differing[:MOST_KINDS]:
            lines += [f"    {text}" for text in self._kind(stream, kind, second)]
        return lines

    def _kind(self, stream: str, kind: str, second: int) -> list[str]:
        was = self._expected.seconds.get(stream, {}).get(kind, {}).get(str(second), f"0:{ABSENT}")
        now = self._found.seconds.get(stream, {}).get(kind, {}).get(str(second), f"0:{ABSENT}")
        expected_count, found_count = was.split(":")[0], now.split(":")[0]
        alike = f"{found_count} in second {second}, as many as expected"
        differ = f"expected {expected_count} in second {second}, found {found_count}"
        lines = [f"{kind}: {alike if expected_count == found_count else differ}"]
        samples = self._expected.samples.get(stream, {}).get(kind, {})
        firsts = self._found.samples.get(stream, {}).get(kind, {})
        for at in sorted(map(int, samples)):
            if at < second or str(at) not in firsts:
                continue
            expected = json.loads(json.dumps(samples[str(at)], default=list))
            found = json.loads(json.dumps(firsts[str(at)], default=list))
            texts = told(expected, found)
            if texts:
                return [*lines, f"the first one in second {at}:", *(f"    {text}" for text in texts)]
        return lines


def write_decoded(items: list[Item], folder: Path, epoch_ns: int) -> None:
    """Write a stream for people: a file a kind, a line an item, with its instant [s]."""
    folder.mkdir(parents=True, exist_ok=True)
    texts: dict[str, list[str]] = {}
    for item in items:
        decoded: Any = json.dumps(item.decode(item.data), ensure_ascii=False, default=list)
        at = f"{second_of(item, epoch_ns)}.{(item.at_ns - epoch_ns) % 1_000_000_000:09d}"
        texts.setdefault(item.kind, []).append(f"{at} {decoded}\n")
    for kind, lines in texts.items():
        file = folder / (kind.strip("/").replace("/", "_").replace(" ", "_") + ".txt")
        file.write_text("".join(lines), encoding="utf-8")
