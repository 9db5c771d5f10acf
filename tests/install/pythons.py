"""`make check-pythons`: the later Pythons that this machine has, each in an environment from the lock.

3.11 runs the whole suite; the others a share of it that touches every library: frames, bus, files, compiled
kernels, a whole game on virtual time, command lines. A Python that is not here is named, and not an error.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
LOCK = ROOT / "locks" / "all.lock"
LATER = ("3.12", "3.13", "3.14")
SMOKE = (
    "tests/test_command_lines.py",
    "tests/test_every_setting_acts.py",
    "tests/onboard/config/test_strict.py",
    "tests/onboard/core/game",
    "tests/onboard/runtime/test_loop.py",
    "tests/onboard/runtime/test_program.py",
    "tests/onboard/wire/test_framer.py",
    "tests/onboard/wire/test_tlog.py",
    "tests/onboard/wire/test_topics.py",
    "tests/sim_bridge/campaign/test_compiled.py::test_a_compiled_game_is_the_plane_game_of_the_command",
    "tests/gcs/replay/test_replay_decide.py::test_the_same_machine_wants_the_same_done_again_byte_for_byte",
)


def interpreter(version: str) -> str | None:
    """A Python of this version: on the path, or one of pyenv's or uv's; None where there is none."""
    homes = (Path.home() / ".pyenv/versions", Path.home() / ".local/share/uv/python")
    places = [shutil.which(f"python{version}")]
    places += [str(path) for home in homes for path in sorted(home.glob(f"*{version}.*/bin/python{version}"))]
    for place in places:
        asked = [str(place), "-c", "import sys, venv; print('%d.%d' % sys.version_info[:2])"]
        if place is not None:  # it may be a shim, which only complains
            told = subprocess.run(asked, capture_output=True, text=True, check=False)
            if told.stdout.strip() == version:
                return place
    return None


def environment(version: str, python: str) -> Path:
    """The environment `.venv-VERSION`, made anew where the lock has changed. Raises CalledProcessError."""
    folder = ROOT / f".venv-{version}"
    stamp, digest = folder / ".lock", hashlib.sha256(LOCK.read_bytes()).hexdigest()
    if not stamp.exists() or stamp.read_text() != digest:
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run([python, str(ROOT / "locks/install.py"), str(folder), str(LOCK)], check=True, cwd=ROOT)
        stamp.write_text(digest)
    return folder / "bin" / "python"


def main() -> int:
    """Try every later Python; gives the exit code."""
    failed = 0
    for version in LATER:
        python = interpreter(version)
        if python is None:
            print(f"Python {version}: none on this machine, not tried", flush=True)
            continue
        print(f"Python {version}: {python}", flush=True)
        own = str(environment(version, python))
        env = {**os.environ, "PYTHONPATH": str(ROOT)}
        types = ["-m", "mypy", "--cache-dir", f".venv-{version}/.mypy_cache"]
        for command in (types, ["-m", "pytest", *SMOKE]):
            failed += subprocess.run([own, *command], cwd=ROOT, env=env, check=False).returncode != 0
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(main())
