"""Mutants: would the tests notice? cosmic-ray changes the code a little, and the tests of its room are run.

`python -m tests.mutants [--seed N] [--each N] [--resume FILE] [ROOM ...]`: of each room a sample of so many
mutants, drawn with the seed. The room's tests run once unchanged, to learn which run which line; upon a
mutant those of its line run, the quickest first, half a minute of them at most. Killed are mutants upon
which a test fails or takes too long. Survivors whose reason stands in `reasons.toml` are told with it;
equivalent ones count as survivors.
"""

from __future__ import annotations

import argparse
import sys
import tomllib
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tests.mutants.trial import Bench, Ledger, Mutant, changed, mutants
from tests.support import benchmark_record
from tests.support.paths import ROOT

QUICK = [  # on virtual time, in seconds
    "core_parts", "lone_agent", "lone_agent_limits", "orders", "radio", "bus_view", "floods",
]  # fmt: skip
FIELD = ["clocks_and_masters", "who_sent_it", "unknown_is_no_default"]
AGENT = [
    *(f"tests/onboard/agent/test_{name}.py" for name in QUICK),
    *(f"tests/field/test_{name}.py" for name in FIELD),
    "-m", "not real and not long and not game",
]  # fmt: skip
ROOMS = {
    "safety": (["onboard/core/safety/"], ["tests/onboard/core/safety"]),
    "signing": (["onboard/wire/mavlink/signing.py"], ["tests/onboard/wire/test_signing.py"]),
    "commands": (["gcs/picture/command_book.py"], ["tests/gcs/picture"]),
    "agent": (["onboard/agent/core/"], AGENT),
}
REASONS = Path(__file__).with_name("reasons.toml")


def change(mutant: Mutant) -> tuple[str, str]:
    """The line that a mutant changes, as it is and as it becomes."""
    whole = (ROOT / mutant.file).read_text(encoding="utf-8")
    pairs = zip(whole.splitlines(), changed(mutant).splitlines(), strict=False)
    return next(((old.strip(), new.strip()) for old, new in pairs if old != new), ("?", "?"))


def told(mutant: Mutant, reasons: dict[str, str]) -> str:
    """A survivor in a line."""
    old, new = change(mutant)
    reason = reasons.get(f"{mutant.file} {new}", "")
    return f"- {mutant.file}: `{old}` → `{new}`{': ' + reason if reason else ''}"


def main() -> None:
    """Draw, try, tell."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", type=int, default=80)
    parser.add_argument("--resume", type=Path, help="what was found so far; a run that was ended goes on")
    parser.add_argument("--place", type=Path, help="where the copy is made and stays")
    parser.add_argument("--at-most", type=int, default=10**9, help="so many in this run, then end")
    parser.add_argument("rooms", nargs="*", default=list(ROOMS), metavar="ROOM")
    asked = parser.parse_args()
    ledger = Ledger(asked.resume)
    reasons = tomllib.loads(REASONS.read_text(encoding="utf-8")) if REASONS.exists() else {}
    lines = ["| room | mutants there are | tried | killed |", "|---|---|---|---|"]
    left: list[Mutant] = []
    all_tried = all_killed = 0
    with TemporaryDirectory() as name:
        place = asked.place or Path(name)
        for room in asked.rooms:
            files, tests = ROOMS[room]
            there = mutants(files)
            drawn = Random(f"{asked.seed} {room}").sample(there, min(asked.each, len(there)))
            bench = None
            alive = []
            for mutant in drawn:
                verdict = ledger.get(mutant)
                if verdict is None:
                    if asked.at_most <= 0:
                        return
                    asked.at_most -= 1
                    if bench is None:
                        bench = Bench(place, room, tests)
                        bench.look(files)
                    verdict = bench.judge(mutant)
                    ledger.put(mutant, verdict)
                    word = "killed" if verdict.killed else "SURVIVES"
                    print(f"{room}: {word} {mutant}, {verdict.tests} tests", flush=True)
                if not verdict.killed:
                    alive.append(mutant)
            left += alive
            killed = len(drawn) - len(alive)
            all_tried, all_killed = all_tried + len(drawn), all_killed + killed
            lines.append(f"| {room} | {len(there)} | {len(drawn)} | {killed} ({killed / len(drawn):.0%}) |")
    lines.append(f"| all | | {all_tried} | {all_killed} ({all_killed / all_tried:.0%}) |")
    lines += ["", "Survivors, equivalent ones among them:", ""]
    lines += [told(mutant, reasons) for mutant in left] or ["- none"]
    print("\n".join(lines))
    command = f"python -m tests.mutants --seed {asked.seed} --each {asked.each} {' '.join(asked.rooms)}"
    benchmark_record.write("mutants.md", "Mutants that the tests notice", command, lines)


if __name__ == "__main__":
    sys.exit(main())
