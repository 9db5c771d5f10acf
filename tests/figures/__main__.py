"""`python -m tests.figures [PAGE ...] [--stale]`: make the committed figures again, all of them in one sweep.

Each page ends with date, version, machine, and a hash of the sources it measures. `--stale` makes only those
whose sources have changed since; `--list` says which these are, and makes nothing.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from collections.abc import Sequence
from datetime import UTC, datetime

from tests.figures.catalogue import FIGURES, Figure
from tests.figures.sources import fingerprint, stamp, stamped
from tests.support.paths import RESULTS, ROOT


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the chosen pages; the exit code is 1 when a command fails."""
    parser = argparse.ArgumentParser(prog="python -m tests.figures", description=__doc__)
    parser.add_argument("pages", nargs="*", help="pages to make, such as games.md; default: all")
    parser.add_argument("--stale", action="store_true", help="only pages of other sources than today's")
    parser.add_argument("--list", action="store_true", help="say what is stale; make nothing")
    options = parser.parse_args(arguments)
    unknown = set(options.pages) - {figure.page for figure in FIGURES}
    if unknown:
        parser.error(f"found {sorted(unknown)}, expected some of {[figure.page for figure in FIGURES]}")
    chosen = [figure for figure in FIGURES if not options.pages or figure.page in options.pages]
    if options.list:
        for figure in chosen:
            print(f"{figure.page}: {'stale' if is_stale(figure) else 'up to date'}")
        return 0
    return max([make(figure) for figure in chosen if not options.stale or is_stale(figure)], default=0)


def is_stale(figure: Figure) -> bool:
    """Was the committed page made from other sources than today's, or never?"""
    return not (RESULTS / figure.page).exists() or stamped(figure.text()) != fingerprint(figure)


def make(figure: Figure) -> int:
    """Run the command of a page and stamp what it wrote; gives its exit code (1: a target missed)."""
    print(f"{figure.page}: python {' '.join(figure.command)}", flush=True)
    page = RESULTS / figure.page
    before = page.stat().st_mtime_ns if page.exists() else 0
    code = subprocess.run([sys.executable, *figure.command], cwd=ROOT, check=False).returncode
    if code:
        print(f"{figure.page}: the command ended with {code}: a target was missed, or it failed")
    if not page.exists() or page.stat().st_mtime_ns == before:
        print(f"{figure.page}: nothing was written")
        return code or 1
    line = stamp(figure, datetime.now(UTC).date().isoformat())
    page.write_text(f"{figure.text().rstrip()}\n\n{line}\n", encoding="utf-8")
    return code


if __name__ == "__main__":
    sys.exit(main())
