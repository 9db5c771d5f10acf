"""Every command in every surrounding that a shell, a pipe, a cron job or a hurried person gives it.

`python -m tests.field.manners [WORD …]` runs the whole matrix, or the commands whose line holds a word, and
prints what broke the rules: no traceback ever; output that cannot be written is exit 74, a reader who left
141, ctrl-C 130 with one line (0 where ctrl-C is the way to end), a wrong file 2 with one line; an encoding or
a locale changes nothing.
"""

from __future__ import annotations

import itertools
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tests.support.interrupts import hear_interrupts
from tests.support.real_time import patience

ROOT = Path(__file__).parent.parent.parent
PROMISED_S = 20.0  # by every command that ends by itself, on a quiet machine
SCENARIO = """
name = "manners"
[evader]
id = {0}
position = [0, 0]
speed = 5
target = [150, 0]
[[pursuers]]
id = {1}
position = [90, 40]
speed = 4
[parameters]
horizon = 2.0
[flight]
ready_s = 0.5
prediction = "constant-velocity"
"""
DIRT = ("Traceback", "Task was destroyed", "Exception ignored", "never retrieved", "Error in sys.excepthook",
        "coredump", "Aborted", "panicked")  # fmt: skip


STARTED = ("one_line_interrupts(", "import typer", "import argparse", "program.py")


class Command(NamedTuple):
    """A command line; `FILE` in it is replaced by a wrong file, where `file` says which word that is."""

    words: tuple[str, ...]
    file: str = ""  # the word that names a file which is read
    stays: bool = False  # until ctrl-C, which is then a good end

    @property
    def line(self) -> str:
        """As a person types it."""
        return " ".join(Path(word).name if word.startswith("/") else word for word in self.words)


class Ended(NamedTuple):
    """How a command ended."""

    code: int
    out: str
    err: str

    @property
    def dirt(self) -> str:
        """The first line that nobody should see; "" = none."""
        both = f"{self.out}\n{self.err}".splitlines()
        return next((line for line in both if any(word in line for word in DIRT)), "")


def free_endpoint() -> str:
    """A Zenoh endpoint that nobody has."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


def commands(folder: Path) -> list[Command]:
    """Every command with something to do, in a folder of its own."""
    base = 100 + os.getpid() % 70 * 2
    scenario = folder / "short.toml"
    scenario.write_text(SCENARIO.format(base, base + 1), encoding="utf-8")
    run = folder / "run"
    if not run.exists():
        fly = module("sim_bridge.cli", "fly", "--fast", "--no-report", str(scenario), "--runs", "made")
        subprocess.run(
            fly, check=True, capture_output=True, cwd=folder, env=surroundings(), timeout=patience(60)
        )
        next((folder / "made").iterdir()).rename(run)
    track = folder / "track.csv"
    rows = "".join(f"{k / 5},{k},{k % 7},-50\n" for k in range(60))
    track.write_text(f"t,north,east,down\n{rows}", "utf-8")
    bus, runs = ("--bus", free_endpoint()), ("--runs", str(folder / "runs"))
    s, agent, frames = str(scenario), str(base), str(folder / "accept.tlog")
    campaign, games = ("sim_bridge.cli", "campaign"), str(folder / "games")
    bench = ("sim_bridge.cli", "bench", "--evader", "straight", "--pursuers", "paper", "--games", "2")
    lists: list[tuple[tuple[str, ...], str, bool]] = [
        (("sim_bridge.cli",), "", False),
        (("sim_bridge.cli", "list"), "", False),
        (("sim_bridge.cli", "planar", s), s, False),
        (("sim_bridge.cli", "planar", s, "--json"), s, False),
        (("sim_bridge.cli", "serve", s, *bus), s, True),
        (("sim_bridge.cli", "fly", "--fast", s, *runs, "--no-report"), s, False),
        (("sim_bridge.cli", "fly", s, *runs, *bus, "--no-report"), s, False),
        (("sim_bridge.cli", "accept", "udpin://127.0.0.1:0", "--yes", "--tlog", frames), "", False),
        (("sim_bridge.cli", "scenario", "check", s), s, False),
        (("sim_bridge.cli", "design"), "", False),
        (("sim_bridge.cli", "design", "ARGUMENT"), "ARGUMENT", False),
        (("sim_bridge.cli", "predict", str(track)), str(track), False),
        ((*campaign, "study", "encircled", "--games", "0"), "", False),
        ((*campaign, "study", "games", "--seeds", "1", "--scenario", "ARGUMENT"), "ARGUMENT", False),
        ((*campaign, "ARGUMENT", "--games", "1", "--out", games), "ARGUMENT", False),
        ((*campaign, "row01", "--sweep", "ARGUMENT", "--out", games), "ARGUMENT", False),
        ((*campaign, "show", "ARGUMENT"), "ARGUMENT", False),
        ((*campaign, "replay", "ARGUMENT", "0:1"), "ARGUMENT", False),
        ((*campaign, "fly", "ARGUMENT", "0:1"), "ARGUMENT", False),
        ((*campaign, s, "--evader", "straight", "--games", "2", "--out", games), s, False),
        ((*bench, "--scenario", s, "--out", f"{games}-ranked"), s, False),
        ((*bench, "--scenario", "ARGUMENT"), "ARGUMENT", False),
        (("gcs.cli", *bus), "", False),
        (("gcs.cli", "--plain", *bus, *runs), "", True),
        (("gcs.cli", "--config", "ARGUMENT", "status"), "ARGUMENT", False),
        (("gcs.cli", "status", *bus), "", False),
        (("gcs.cli", "command", "hold", "--all", "--within", "1", *bus), "", False),
        (("gcs.cli", "record", *bus, *runs), "", True),
        (("gcs.cli", "replay", str(run), "--plain"), str(run), False),
        (("gcs.cli", "replay", str(run), "--decide"), str(run), False),
        (("gcs.cli", "report", str(run)), str(run), False),
        (("gcs.cli", "game", "run", s, "--plain", *bus, *runs), s, True),
        (("gcs.cli", "keys", "init", "ARGUMENT"), "ARGUMENT", False),
        (("gcs.cli", "keys", "show", "ARGUMENT"), "ARGUMENT", False),
        (("onboard.cli", "--id", agent, *bus), "", True),
        (("onboard.cli", "check", "--seconds", "0.5", "--config", "ARGUMENT"), "ARGUMENT", False),
        (("onboard.cli", "check", "--id", agent, "--seconds", "1", *bus), "", False),
    ]
    return [Command(*one) for one in lists]


def module(*words: str) -> list[str]:
    """The command line of a program in this checkout."""
    return [sys.executable, "-m", *words]


def surroundings(**more: str) -> dict[str, str]:
    """An environment like a cron job's: a path, a home, no terminal."""
    kept = {name: os.environ[name] for name in ("PATH", "HOME", "LANG", "TMPDIR") if name in os.environ}
    threads = {f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL")}
    return {**kept, **threads, "PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1", **more}


def run(command: Command, folder: Path, *, out: int | None = None, ctrl_c_s: float | None = None,
        **environment: str) -> Ended:  # fmt: skip
    """Run a command to its end; a service, and whoever is to, gets ctrl-C after some time."""
    child = subprocess.Popen(
        module(*command.words), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE if out is None else out,
        stderr=subprocess.PIPE, cwd=folder, env=surroundings(**environment), start_new_session=True,
    )  # fmt: skip
    wait_s = ctrl_c_s if ctrl_c_s is not None else patience(0.4) if command.stays else patience(PROMISED_S)
    try:
        try:
            told, said = child.communicate(timeout=wait_s)
        except subprocess.TimeoutExpired:
            child.send_signal(signal.SIGINT)
            told, said = child.communicate(timeout=patience(PROMISED_S))
    finally:
        if child.poll() is None:
            os.killpg(child.pid, signal.SIGKILL)
            child.communicate()
    code = child.returncode if child.returncode >= 0 else 128 - child.returncode  # as a shell reports it
    return Ended(code, (told or b"").decode("latin-1"), said.decode("latin-1"))


def faults(command: Command, folder: Path, *, whole: bool = True) -> Iterator[str]:
    """What a command does wrong, in the surroundings that it is put in; `whole` also those that take long."""
    if command.file == "ARGUMENT":
        yield from file_faults(command, folder)
        return
    plain = run(command, folder)
    if plain.code not in (0, 1, 2) or plain.dirt:
        yield f"without a terminal: {_words(plain)}"
    for name, environment in (("LANG=C", {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}),
                              ("ascii", {"PYTHONIOENCODING": "ascii"})):  # fmt: skip
        ended = run(command, folder, **environment)
        if ended.code != plain.code or ended.dirt:
            yield f"{name}: {_words(ended)}, otherwise {plain.code}"
    yield from output_faults(command, folder, plain)
    if whole:
        yield from ctrl_c_faults(command, folder, plain, (0.1, 0.5, 1.0, 5.0))
        if command.file:
            yield from file_faults(command, folder)


def output_faults(command: Command, folder: Path, plain: Ended) -> Iterator[str]:
    """What a full disk, or a reader who left, makes a command do wrong."""
    full = os.open("/dev/full", os.O_WRONLY)
    reading, gone = os.pipe()
    os.close(reading)
    for name, out, code in (("/dev/full", full, 74), ("closed pipe", gone, 141)):
        # A service must have said something by then, on a busy machine too.
        ended = run(command, folder, out=out, ctrl_c_s=patience(3.0) if command.stays else None)
        expected = code if plain.out else plain.code
        if ended.code != expected or ended.dirt:
            yield f"{name}: {_words(ended)}, expected {expected}"
        os.close(out)


def ctrl_c_faults(command: Command, folder: Path, plain: Ended, after: tuple[float, ...]) -> Iterator[str]:
    """What a command does wrong when a person stops it."""
    for seconds in after:
        ended = run(command, folder, ctrl_c_s=seconds)
        last = ended.err.rstrip().rpartition("\n")[2]
        # One line: that it was interrupted, or how it ended where that was told already. A command that has
        # told all, and whose interpreter is taking itself down, ends without a word.
        lines = ended.out.count("\n")  # of the same number: names of folders differ
        whole = lines == plain.out.count("\n") if lines else bool(ended.err)
        told = whole and ended.err in ("", plain.err)
        stopped = ended.code == 130 and (last.count("interrupted") == 1 or told)
        # The interpreter itself was starting: nothing of the program's runs yet.
        early = ended.err.endswith("KeyboardInterrupt\n") and not any(w in ended.err for w in STARTED)
        done = ended.code == plain.code or (command.stays and ended.code == 0)
        if not (stopped or early or done) or (ended.dirt and not early):
            yield f"ctrl-C after {seconds:g} s: {_words(ended)}"


def file_faults(command: Command, folder: Path) -> Iterator[str]:
    """What a command does with a file that is missing, a folder, empty, no text, or not to be read."""
    wrong = folder / "wrong"
    wrong.mkdir(exist_ok=True)
    (wrong / "empty.toml").write_bytes(b"")
    (wrong / "noise.toml").write_bytes(bytes(range(256)) * 8)
    for name in ("missing.toml", ".", "empty.toml", "noise.toml"):
        words = tuple(str(wrong / name) if word == command.file else word for word in command.words)
        ended = run(Command(words), folder)
        harmless = name == "empty.toml" and ended.code in (0, 1)  # of a configuration: the defaults
        if (not harmless and (ended.code != 2 or ended.err.count("\n") != 1)) or ended.dirt:
            yield f"file {name}: {_words(ended)}, expected exit 2 and one line"


def _words(ended: Ended) -> str:
    last = ended.err.rstrip().rpartition("\n")[2]
    return f"exit {ended.code}, {ended.err.count(chr(10))} lines: {(ended.dirt or last)[:200]}"


def main(words: list[str]) -> int:
    """Run the matrix and print what is wrong; the number of faults is the exit code, at most 1."""
    hear_interrupts()
    wrong = 0
    with tempfile.TemporaryDirectory() as name:
        chosen = [c for c in commands(Path(name)) if not words or any(word in c.line for word in words)]
        for number, command in zip(itertools.count(1), chosen, strict=False):
            begun = time.monotonic()
            found = list(faults(command, Path(name)))
            wrong += len(found)
            took = time.monotonic() - begun
            count = len(found) or "no"
            print(f"{number:2d} of {len(chosen)} {command.line}: {count} faults ({took:.0f} s)", flush=True)
            for one in found:
                print(f"     {one}", flush=True)
    return min(wrong, 1)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
