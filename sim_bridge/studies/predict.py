"""`sim-bridge predict`: compares predictors on a recorded or simulated track; the example of 3.5.2."""

from __future__ import annotations

from pathlib import Path

import msgspec

from onboard.runtime.progress import Progress
from onboard.runtime.run_folder import made
from sim_bridge.studies.comparison import compare, table
from sim_bridge.studies.paper_example import example, example_table
from sim_bridge.studies.tracks import recording_of, weave


def predict(
    source: Path | None = None,
    figures: Path | None = None,
    json: bool = False,
    seed: int = 1,
    printed: bool = False,
    epochs: int = 1000,
) -> None:
    """The command: compare predictors on `source` (a CSV track or a scenario), or, without one, play the
    example of 3.5.2 and compare on a weave. Prints a table (or JSON lines); draws into `figures`.

    `printed` trains the example by the printed rule (27)–(28). Raises ConfigError for bad input."""
    recording = None if source is None else recording_of(source, seed)
    if figures is not None:
        made(figures)
    with Progress("sim-bridge") as progress:
        played = example(epochs=epochs, printed=printed, tell=progress.show) if source is None else None
    if played is not None:
        for one in played.results if json else ():
            print(msgspec.json.encode(one).decode())
        if not json:
            print(example_table(played) + "\n")
        if figures is not None:
            from sim_bridge.studies.predict_figures import draw_activation, draw_example

            draw_activation(figures)
            draw_example(played, figures)
    with Progress("sim-bridge") as progress:
        drawn = compare(recording or weave(), seed, tell=progress.show)
    print(msgspec.json.encode(drawn.comparison).decode() if json else table(drawn.comparison))
    if figures is not None:
        from sim_bridge.studies.predict_figures import draw_comparison

        written = draw_comparison(drawn, figures)
        if not json:
            print(f"figure: {written[0]}")
