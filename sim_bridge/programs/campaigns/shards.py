"""A campaign's folder: `manifest.json`, and one Parquet file a shard, whole or not there.

A shard is written under a temporary name, brought to the disk and renamed. Its bytes follow from its key
alone: no time, no host, fixed settings of the writer. So resuming is playing what is missing, and merging is
copying files. Files of other campaigns are left alone and told of.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from onboard.config.strict import ConfigError
from onboard.core.strategy.registry import evader_named, pursuer_named
from onboard.runtime.run_folder import made
from onboard.runtime.whole_files import sweep, write_first, write_whole
from sim_bridge.programs.campaigns.plan import Cell, Plan, Shard, checked
from sim_bridge.programs.campaigns.rows import EvaderRow, Row

MANIFEST = "manifest.json"
KEY = b"apollonius.shard"


def file_name(plan: Plan, shard: Shard) -> str:
    """The name of a shard's file."""
    return f"shard-{shard.number:06d}-{plan.key(shard)[:16]}.parquet"


def encoded(plan: Plan, shard: Shard, rows: Iterable[Row]) -> bytes:
    """A shard's games as a Parquet file: the columns of `Row`, what was played, and every swept value."""
    import pyarrow as pa

    games = list(rows)
    cells = {number: plan.cell(number) for number in shard.cells}
    told = [cells[row.cell] for row in games]
    columns: dict[str, Any] = {
        "cell": pa.array([row.cell for row in games], pa.int32()),
        "seed": pa.array([row.seed for row in games], pa.int64()),
        "scenario": _words(cell.label for cell in told),
        "evader": _words(evaders_in(cell) for cell in told),
        "pursuers": _words(
            "+".join(sorted({pursuer_named(spec.strategy) for spec in cell.scenario.pursuers}))
            for cell in told
        ),
    }
    for name in plan.parameters():
        values = [cell.point[name] for cell in told]
        numbers = all(isinstance(point[name], (int, float)) for point in plan.points)
        columns[name] = pa.array([*map(float, values)], pa.float64()) if numbers else _words(map(str, values))
    columns |= {
        "verdict": _words(row.verdict for row in games),
        "time": pa.array([row.time for row in games], pa.float64()),
        "smallest": pa.array([row.smallest for row in games], pa.float64()),
        "captor": pa.array([row.captor for row in games], pa.int16()),
        "unsafe": pa.array([row.unsafe for row in games], pa.float64()),
        "reversals": pa.array([row.reversals for row in games], pa.int32()),
    }
    if plan.several:
        kinds = (pa.string(), pa.float64(), pa.float64(), pa.int16(), pa.float64())
        one = pa.struct(list(zip(EvaderRow._fields, kinds, strict=True)))
        listed = pa.list_(pa.field("element", one))  # so it is called when it is read again
        columns["evaders"] = pa.array(
            [[evader._asdict() for evader in row.evaders] for row in games], listed
        )
    return written(pa.table(columns).replace_schema_metadata({KEY: plan.key(shard).encode()}))


def evaders_in(cell: Cell) -> str:
    """The evaders' strategies of a cell, each once."""
    return "+".join(sorted({evader_named(spec.strategy) for spec in cell.scenario.evading}))


def written(table: Any) -> bytes:
    """A table as the bytes of a Parquet file: the same for the same table and release of pyarrow."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    sink = pa.BufferOutputStream()
    pq.write_table(
        table, sink, version="2.6", compression="zstd", compression_level=3, row_group_size=1 << 20,
        write_page_checksum=True, data_page_version="1.0",
    )  # fmt: skip
    data: bytes = sink.getvalue().to_pybytes()
    return data


def _words(words: Iterable[str]) -> Any:
    import pyarrow as pa

    return pa.array(list(words), pa.string()).dictionary_encode()


class Found(NamedTuple):
    """What lies in a folder, beside its manifest."""

    whole: dict[int, Path]  # shards of the campaign by number
    broken: list[Path]  # files that have a shard's name and not its contents
    strange: list[Path]  # other files


def find(folder: Path, plan: Plan) -> Found:
    """Which shards of the campaign are there and whole; every page's checksum is looked at."""
    wanted = {file_name(plan, shard): shard for shard in plan.shards()}
    whole, broken, strange = {}, [], []
    for path in sorted(folder.iterdir()):
        if path.name == MANIFEST or path.name.startswith(".") or path.is_dir():
            continue
        shard = wanted.get(path.name)
        if shard is None:
            strange.append(path)
        elif sound(path, plan, shard):
            whole[shard.number] = path
        else:
            broken.append(path)
    return Found(whole, broken, strange)


def sound(path: Path, plan: Plan, shard: Shard) -> bool:
    """Whether a file is the shard: its key, its number of games, every page and every byte as written."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        data = path.read_bytes()
        table = pq.ParquetFile(pa.BufferReader(data), page_checksum_verification=True).read()
        if pa.__version__ == plan.fingerprint.versions.get("pyarrow") and written(table) != data:
            return False  # what stands between the pages has no checksum
    except (pa.ArrowException, OSError, ValueError):
        return False
    key = (table.schema.metadata or {}).get(KEY, b"").decode()
    return bool(key == plan.key(shard) and table.num_rows == shard.games)


def read_plan(folder: Path) -> Plan:
    """The plan of a campaign's folder. Raises ConfigError where there is none."""
    path = folder / MANIFEST
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}; expected a campaign's folder"
                          ) from None  # fmt: skip
    return checked(data, str(path))


def settle(folder: Path, plan: Plan) -> Plan:
    """Make the folder the plan's, or find that it is; a plan with more games of the same goes on with it.

    Returns the plan that the folder has now. Raises ConfigError for a folder of another campaign.
    """
    made(folder)
    sweep(folder)
    if (folder / MANIFEST).exists():
        old = read_plan(folder)
        for name in Plan.__struct_fields__:
            if name != "games" and getattr(old, name) != getattr(plan, name):
                raise ConfigError(
                    f"{folder}: found a campaign with {_differs(name, old, plan)}, expected this one; name"
                    " another folder (--out)"
                )
        if old.games >= plan.games:
            return old
        kept = {file_name(plan, shard) for shard in plan.shards()}
        for shard in old.shards():  # the last seeds of before lie in a longer shard now
            if (name := file_name(old, shard)) not in kept:
                (folder / name).unlink(missing_ok=True)
    elif any(path.suffix == ".parquet" for path in folder.iterdir()):
        raise ConfigError(f"{folder}: found shards without {MANIFEST}, expected a new folder or a campaign's")
    elif write_first(folder / MANIFEST, manifest(plan)):
        return plan
    else:  # somebody else began here at the same moment
        return settle(folder, plan)
    write_whole(folder / MANIFEST, manifest(plan), durable=True)
    return plan


def manifest(plan: Plan) -> bytes:
    """The plan as JSON."""
    return msgspec.json.format(msgspec.json.encode(plan, order="deterministic"), indent=1) + b"\n"


def _differs(name: str, old: Plan, new: Plan) -> str:
    if name == "fingerprint":
        for part in ("sources", "versions", "plugins", "machine"):
            before, now = getattr(old.fingerprint, part), getattr(new.fingerprint, part)
            if before != now:
                return f"other {part}" if part == "sources" else f"other {part} ({_told(before, now)})"
    if name in ("first_seed", "shard_games", "flown", "format"):
        return f"{name} {getattr(old, name)}"
    return f"other {name}"


def _told(before: Any, now: Any) -> str:
    """What is other, and no more: of tables the entries that differ."""
    if not isinstance(before, dict) or not isinstance(now, dict):
        return f"{before}, here {now}"
    names = sorted(name for name in before | now if before.get(name) != now.get(name))
    return ", ".join(f"{name} {before.get(name, 'none')}, here {now.get(name, 'none')}" for name in names)


def counts(path: Path) -> Counter[tuple[int, str]]:
    """How often each cell of a shard had each verdict."""
    import pyarrow.parquet as pq

    table = pq.read_table(path, columns=["cell", "verdict"])
    return Counter(zip(table["cell"].to_pylist(), table["verdict"].to_pylist(), strict=True))


def table_of(paths: Iterable[Path]) -> Any:
    """All games of these shards as one pyarrow table."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    return pa.concat_tables([pq.ParquetFile(path).read() for path in paths]).unify_dictionaries()


def row_of(path: Path, cell: int, seed: int) -> Row | None:
    """One game of a shard, None where it is not in it."""
    import pyarrow.parquet as pq

    found = pq.read_table(path, filters=[("cell", "=", cell), ("seed", "=", seed)]).to_pylist()
    if not found:
        return None
    kept = {name: found[0][name] for name in Row._fields if name in found[0]}
    return Row(**kept | {"evaders": evader_rows(found[0].get("evaders", ()))})


def evader_rows(listed: Iterable[dict[str, Any]]) -> tuple[EvaderRow, ...]:
    """The evaders of a game as a shard lists them."""
    return tuple(EvaderRow(**one) for one in listed)
