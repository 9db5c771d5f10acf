"""What is kept of a run: for each stream and kind a digest a second, and here and there an item in full.

A digest says that something differs and in which second; a kept item says how. `*` among the kinds is the
stream as a whole, in its order.
"""

from __future__ import annotations

import json
import lzma
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from tests.golden.capture import Item, Streams, canonical, kinds

WHOLE = "*"
NS = 1_000_000_000
PIECE = 10  # hexadecimal digits of a second's digest

Seconds = dict[str, dict[str, str]]  # kind → second → "number of items:digest"
Samples = dict[str, dict[str, Any]]  # kind → second → its first item, decoded


class Kept(msgspec.Struct, frozen=True):
    """One recorded part, as it lies in the repository in two files: for people, and for locating."""

    overview: dict[str, Any]  # what a person reads: the summary; of each stream its digest and its kinds
    seconds: dict[str, Seconds]  # by stream
    samples: dict[str, Samples]  # by stream


class Part(NamedTuple):
    """A run as it was found."""

    streams: Streams
    summary: Any  # "" where there is none


def second_of(item: Item, epoch_ns: int) -> int:
    """In which second of virtual time."""
    return (item.at_ns - epoch_ns) // NS


def digests(items: list[Item], epoch_ns: int) -> Seconds:
    """A digest for each kind and second, and one for each second of the whole stream."""
    running: dict[tuple[str, int], tuple[int, Any]] = {}
    for item in items:
        second = second_of(item, epoch_ns)
        for kind in (item.kind, WHOLE):
            count, digest = running.get((kind, second)) or (0, sha256())
            digest.update(f"{item.at_ns} {item.kind} {len(item.data)} ".encode() + item.data)
            running[kind, second] = (count + 1, digest)
    found: Seconds = {}
    for (kind, second), (count, digest) in running.items():
        found.setdefault(kind, {})[str(second)] = f"{count}:{digest.hexdigest()[:PIECE]}"
    return found


def first_items(items: list[Item], epoch_ns: int, every: int) -> Samples:
    """The first item of each kind in every `every`-th second, decoded."""
    found: Samples = {}
    for item in items:
        second = second_of(item, epoch_ns)
        if second % every == 0 and str(second) not in found.setdefault(item.kind, {}):
            found[item.kind][str(second)] = item.decode(item.data)
    return {kind: seconds for kind, seconds in found.items() if seconds}


def whole(items: list[Item]) -> str:
    """SHA-256 of a stream. Of frames: of the bytes of the .tlog."""
    digest = sha256()
    for item in items:
        digest.update((item.at_ns // 1000).to_bytes(8, "big") + item.data)
    return digest.hexdigest()


def kept(part: Part, epoch_ns: int, every: int) -> Kept:
    """What is kept of a run; items in full in every `every`-th second, but none of what viewers see."""
    overview: dict[str, Any] = {"summary": part.summary} if part.summary else {}
    overview["streams"] = {
        name: {"sha256": whole(items), "kinds": kinds(items)} for name, items in part.streams.items()
    }
    return Kept(
        overview,
        {name: digests(items, epoch_ns) for name, items in part.streams.items()},
        {
            name: first_items(items, epoch_ns, every)
            for name, items in part.streams.items()
            if name != "viewers"
        },
    )


def write(found: Kept, folder: Path, name: str) -> None:
    """Write `NAME.json` and `NAME.seconds.xz`: the same bytes for the same run."""
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps(found.overview, indent=1, ensure_ascii=False)
    (folder / f"{name}.json").write_text(text + "\n", encoding="utf-8")
    data = canonical({"seconds": found.seconds, "samples": found.samples})
    (folder / f"{name}.seconds.xz").write_bytes(lzma.compress(data, preset=9 | lzma.PRESET_EXTREME))


def read(folder: Path, name: str) -> Kept:
    """What `write` wrote. Raises FileNotFoundError where nothing was recorded under this name."""
    overview = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
    data = json.loads(lzma.decompress((folder / f"{name}.seconds.xz").read_bytes()))
    return Kept(overview, data["seconds"], data["samples"])
