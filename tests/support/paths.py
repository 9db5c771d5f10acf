"""Where the tests find the repository's own files."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]  # of the repository
RECORDINGS = ROOT / "tests" / "field" / "recordings"  # of real autopilots
RESULTS = ROOT / "benchmarks" / "results"
