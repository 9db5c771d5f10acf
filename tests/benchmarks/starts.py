"""How near to its place, heading and airspeed the paper's aircraft is at t₀, led there in wind and gusts.

    python -m tests.benchmarks.starts

The aircraft `nose`, its autopilot, gusts and estimate of the wind step by step; places up to 1.3 km off,
headings, winds and courses drawn by the seed. Half fly at 50 m/s, half at 40.
"""

from __future__ import annotations

import argparse
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from onboard.game.scenario import WindSpec
from tests.onboard.pilot.test_approach import Passed, Way
from tests.support import benchmark_record

SKIES = {
    "calm": WindSpec(),
    "wind of 13.5 m/s": WindSpec(speed=5.0, shear=True),
    "the same with gusts of 3 m/s rms": WindSpec(speed=5.0, shear=True, gust_sigma=3.0),
}


def passed(seed: int, wind: WindSpec) -> Passed:
    """One way; the wind comes from where the seed says."""
    angle = float(np.random.default_rng(seed + 1000).uniform(0.0, 360.0))
    spec = WindSpec(speed=wind.speed, from_deg=angle, shear=wind.shear, gust_sigma=wind.gust_sigma)
    return Way(seed, 50.0 if seed % 2 else 40.0, spec).passed()


def spread(values: NDArray[np.float64]) -> str:
    """Median, 95 % and most."""
    return f"{np.median(values):.1f}, {np.quantile(values, 0.95):.1f}, {values.max():.1f}"


def main() -> None:
    """Fly and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--out", type=Path, default=Path("benchmarks/results/starts.md"))
    options = parser.parse_args()
    made = f"{datetime.now(UTC):%Y-%m-%d} on {benchmark_record.machine()}"
    command = f"python -m tests.benchmarks.starts --seeds {options.seeds}"
    lines = [
        "# At the start in time\n",
        f"`{command}`, {made}: {options.seeds} ways in each sky.",
        "Median, 95 % and most of what each left to be wished for at t₀; commands that the supervisor",
        "clipped.\n",
        "| sky | away [m] | height [m] | nose [°] | airspeed [m/s] | clipped |",
        "|---|---|---|---|---|---|",
    ]
    for name, wind in SKIES.items():
        found = np.array([passed(seed, wind) for seed in range(1, options.seeds + 1)])
        away, height, turned, airspeed, clips = found.T
        cells = (name, *map(spread, (away, height, np.degrees(turned), airspeed)), f"{clips.sum():.0f}")
        lines.append(f"| {' | '.join(cells)} |")
        print(lines[-1], flush=True)
    lines += [
        "",
        "What is left are the gusts of the last seconds, which nobody makes up for at the game's airspeed,",
        "and the estimate of the wind (compass 1°, airspeed 1 %, 1σ), by which the nose is not quite where",
        "the course is. Outliers were carried along by gusts of more than 4 m/s for half a minute on the",
        "last straight line, and turned away too little before it: whoever would miss by more than two",
        "seconds of flight asks for another t₀ and goes round.",
    ]
    options.out.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
