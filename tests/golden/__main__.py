"""`python -m tests.golden`: does the product still do what was recorded? Exit code 1 where it does not.

`--record --reason "…"` records again, and writes the reason to REASONS.md. `--write FOLDER` compares nothing
and writes everything decoded, so that two versions can be laid side by side with `diff -r`.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from datetime import UTC, datetime
from functools import partial
from multiprocessing import get_context
from pathlib import Path

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

from tests.golden import translations  # noqa: E402  (threads are set before anything imports NumPy)
from tests.golden.arithmetic import probe  # noqa: E402
from tests.golden.guard import ARITHMETIC, chosen, compare, record, same_arithmetic, show  # noqa: E402
from tests.golden.parts import HERE, PARTS, RECORDED  # noqa: E402

FOUND = Path(".golden")
LOOK = """\
What was found lies decoded in {found}. To lay what was expected beside it: check out the commit of the last
line of tests/golden/REASONS.md elsewhere, run `python -m tests.golden --only {names} --write FOLDER` there
and here, and compare with `diff -r`. A difference that is meant: declare it in tests/golden/translations.py
(messages reshaped, values alike), or record again with --record --reason "…"."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Compare, record or write the chosen parts; gives the exit code: 1 = differs, 2 = not comparable."""
    options = parsed(arguments)
    names = chosen(options.only)
    if options.record:
        work = partial(record, folder=RECORDED)
        if any(name.startswith("game-") for name in names) and translations.TRANSLATIONS:
            print("translations.py: found declared translations, expected none when games are recorded")
            return 2
    elif options.write is not None:
        work = partial(show, folder=options.write)
    else:
        work = partial(compare, found=FOUND)
        shutil.rmtree(FOUND, ignore_errors=True)
        differs = same_arithmetic()
        if differs:
            print(f"not comparable bit by bit on this machine: {'; '.join(differs)}")
            print("record on it from the unchanged product first: --record --reason …")
            return 2
    red = []
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        for name, lines in zip(names, pool.map(work, names), strict=True):
            print("\n".join(lines) if lines else f"{name}: {_done(options)}", flush=True)
            red += [name] if lines else []
    if red:
        print(LOOK.format(found=FOUND.resolve(), names=",".join(red)))
    if options.record:
        ARITHMETIC.write_text(json.dumps(probe()) + "\n", encoding="utf-8")
        with (HERE / "REASONS.md").open("a", encoding="utf-8") as file:
            file.write(f"- {datetime.now(UTC):%Y-%m-%d}, {', '.join(names)}: {options.reason.strip()}\n")
    return 1 if red else 0


def _done(options: argparse.Namespace) -> str:
    if options.record:
        return "recorded"
    return "written" if options.write is not None else "as recorded"


def parsed(arguments: Sequence[str] | None) -> argparse.Namespace:
    """The options; ends the program with a message where they make no sense."""
    parser = argparse.ArgumentParser(prog="python -m tests.golden", description=__doc__)
    parser.add_argument("--only", default="", help=f"some of: {', '.join(PARTS)}; or frames, games")
    parser.add_argument("--record", action="store_true", help="record again, in place of comparing")
    parser.add_argument("--reason", default="", help="why it was recorded again: goes to REASONS.md")
    parser.add_argument("--write", type=Path, help="write everything decoded to this folder instead")
    parser.add_argument("--processes", type=int, default=2, help="how many at a time [2]")
    options = parser.parse_args(arguments)
    if options.record and not options.reason.strip():
        parser.error("--record: found no --reason, expected why it is recorded again")
    if options.record and options.write is not None:
        parser.error("--record and --write: found both, expected one")
    if options.processes < 1:
        parser.error(f"--processes: found {options.processes}, expected 1 or more")
    try:
        chosen(options.only)
    except ValueError as error:
        parser.error(str(error))
    return options


if __name__ == "__main__":
    sys.exit(main())
