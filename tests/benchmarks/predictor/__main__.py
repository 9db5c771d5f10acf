"""`python -m tests.benchmarks.predictor [FOLDER]`: the comparison of predictors in one run.

Writes predictor.md and predictor.json into FOLDER (benchmarks/results) and exits 1 when a target is missed.
"""

from __future__ import annotations

import os
import sys

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

from pathlib import Path  # noqa: E402

from tests.benchmarks.predictor.report import measure, write  # noqa: E402


def main() -> int:
    """Run everything; the number of missed targets decides the exit code."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "benchmarks/results")
    folder.mkdir(parents=True, exist_ok=True)
    missed = write(measure(lambda text: print(text, file=sys.stderr, flush=True)), folder)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
