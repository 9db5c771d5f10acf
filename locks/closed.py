"""Check, without a network, that every lock is closed; `--write` records what the locked packages require.

A lock is installed with `--no-deps`, so that a newer release in the index changes nothing. What is missing in
the lock is then missing in the environment. This check therefore follows every requirement of every locked
package, with its extras and markers, in every environment of `ENVIRONMENTS`, and reports each hole: the
package, its requirement, the environments, and what the lock has instead. The requirements come from
`locks/requires.json`, which `make lock` writes from the packages' own metadata.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from importlib.metadata import distributions
from itertools import chain
from pathlib import Path
from typing import NamedTuple, TypedDict

from packaging.markers import Marker
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

PYTHONS = ("3.11", "3.12", "3.13", "3.14")
MACHINES = ("x86_64", "aarch64")
EXPECTED = "name==version and its hashes"


class Environment(NamedTuple):
    """CPython on Linux for which a lock must hold: the first patch release, which needs most backports."""

    python: str  # "3.11"
    machine: str  # "x86_64" or "aarch64"

    def __str__(self) -> str:
        return f"Python {self.python} on {self.machine}"

    def active(self, marker: Marker | None, extra: str = "") -> bool:
        """Tell whether a requirement with this marker counts here, asked for by a package's extra."""
        return marker is None or marker.evaluate(
            {
                "implementation_name": "cpython",
                "implementation_version": f"{self.python}.0",
                "os_name": "posix",
                "platform_machine": self.machine,
                "platform_python_implementation": "CPython",
                "platform_release": "",
                "platform_system": "Linux",
                "platform_version": "",
                "python_full_version": f"{self.python}.0",
                "python_version": self.python,
                "sys_platform": "linux",
                "extra": extra,
            }
        )


ENVIRONMENTS = tuple(Environment(python, machine) for python in PYTHONS for machine in MACHINES)


class Locked(NamedTuple):
    """One entry of a lock."""

    name: str  # normalised as in the index
    version: str
    marker: Marker | None
    text: str  # the entry as it stands in the lock, with its hashes

    @property
    def key(self) -> str:
        """The entry's name in requires.json."""
        return f"{self.name}=={self.version}"


class Metadata(TypedDict):
    """What a locked package says of itself in its METADATA."""

    requires: list[str]  # Requires-Dist
    extras: list[str]  # Provides-Extra
    python: str  # Requires-Python, or ""


class Hole(NamedTuple):
    """A requirement that a lock leaves open in one environment."""

    lock: str
    package: str  # who requires
    requirement: str
    found: str  # what the lock has instead


def read_lock(path: Path) -> list[Locked]:
    """Read a lock's entries. ValueError: a line names an index or address, or an entry has no pin or hash."""
    entries = []
    text = re.sub(r"\\\n\s*", "", path.read_text(encoding="utf-8"))
    for line in text.splitlines():
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        head, *hashes = line.split("--hash=")
        if line.startswith("-") or "://" in line:
            raise ValueError(f"{path.name}: {line!r} names an index or address; expected {EXPECTED}")
        requirement = Requirement(head.strip())
        pins = list(requirement.specifier)
        if len(pins) != 1 or pins[0].operator != "==" or not hashes:
            raise ValueError(f"{path.name}: {head.strip()!r} has no pin or no hash; expected {EXPECTED}")
        kept = " \\\n    --hash=".join([head.strip(), *map(str.strip, hashes)])
        entries.append(Locked(canonicalize_name(requirement.name), pins[0].version, requirement.marker, kept))
    return entries


def roots(root: Path) -> dict[str, list[Requirement]]:
    """Give what each lock is made from: pyproject.toml's lists, and mavproxy.in."""
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    base = project["project"]["dependencies"]
    extras = project["project"].get("optional-dependencies", {}).values()
    groups = [project["dependency-groups"][name] for name in ("dev", "build")]
    whole = chain(base, project["build-system"]["requires"], *extras, *groups)
    lines = (root / "locks/mavproxy.in").read_text(encoding="utf-8").splitlines()
    mavproxy = [line for line in lines if line and not line.startswith("#")]
    words = {"all.lock": whole, "base.lock": base, "mavproxy.lock": mavproxy}
    return {name: [Requirement(word) for word in part] for name, part in words.items()}


def holes_of(
    lock: str,
    wanted: Iterable[Requirement],
    entries: list[Locked],
    known: dict[str, Metadata],
    where: Environment,
) -> Iterator[Hole]:
    """Find what a lock leaves open in one environment, from its roots and from every entry active there."""
    here: dict[str, Locked] = {}
    for entry in entries:
        if not where.active(entry.marker):
            continue
        if entry.name in here:
            yield Hole(lock, "the lock", entry.key, f"{here[entry.name].key} as well")
        here[entry.name] = entry
        if entry.key not in known:
            yield Hole(lock, entry.key, "an entry in requires.json", "none: run make lock")
        elif not SpecifierSet(known[entry.key]["python"]).contains(f"{where.python}.0"):
            yield Hole(lock, entry.key, f"Python {known[entry.key]['python']}", "an older Python")
    todo = [("the project", requirement, "") for requirement in wanted]
    todo += [(name, Requirement(name), "") for name in here]
    seen: set[tuple[str, str]] = set()
    while todo:
        package, requirement, extra = todo.pop()
        if not where.active(requirement.marker, extra):
            continue
        wanted_name = canonicalize_name(requirement.name)
        found = here.get(wanted_name)
        if found is None:
            others = [f"{entry.key} ; {entry.marker}" for entry in entries if entry.name == wanted_name]
            yield Hole(lock, package, str(requirement), "only " + ", ".join(others) if others else "nothing")
            continue
        if not requirement.specifier.contains(found.version, prereleases=True):
            yield Hole(lock, package, str(requirement), found.key)
        said = known.get(found.key, Metadata(requires=[], extras=[], python=""))
        provided = {"", *map(canonicalize_name, said["extras"])}
        for asked in ("", *sorted(map(canonicalize_name, requirement.extras))):
            if asked not in provided and found.key in known:
                yield Hole(lock, package, str(requirement), f"{found.key}, which has no extra {asked!r}")
            elif (found.name, asked) not in seen:
                seen.add((found.name, asked))
                name = f"{found.key}[{asked}]" if asked else found.key
                todo += [(name, Requirement(word), asked) for word in said["requires"]]


def check(root: Path) -> list[str]:
    """Give one sentence for each hole of the project's locks and each stray entry of requires.json."""
    known: dict[str, Metadata] = json.loads((root / "locks/requires.json").read_text(encoding="utf-8"))
    found: dict[Hole, list[Environment]] = {}
    locked = set()
    for lock, wanted in roots(root).items():
        entries = read_lock(root / "locks" / lock)
        locked |= {entry.key for entry in entries}
        for where in ENVIRONMENTS:
            for hole in dict.fromkeys(holes_of(lock, wanted, entries, known, where)):
                found.setdefault(hole, []).append(where)
    said = []
    for hole, places in found.items():
        which = "every environment" if len(places) == len(ENVIRONMENTS) else ", ".join(map(str, places))
        said.append(f"{hole.lock}: {hole.package} requires {hole.requirement}; found {hole.found} ({which})")
    said += [f"requires.json: {key} is in no lock: run make lock" for key in sorted(set(known) - locked)]
    return said


def gather(root: Path) -> dict[str, Metadata]:
    """Read the METADATA of every package that a target environment installs, with uv, from the index."""
    known: dict[str, Metadata] = {}
    entries = {e.key + str(e.marker): e for lock in roots(root) for e in read_lock(root / "locks" / lock)}
    for where in ENVIRONMENTS:
        here = {e.key: e for e in entries.values() if where.active(e.marker) and e.key not in known}
        with tempfile.TemporaryDirectory() as name:
            place, asked = Path(name, "packages"), Path(name, "asked.txt")
            # One release a name and round: a name can be locked in two versions, in two locks.
            while batch := {entry.name: entry for entry in here.values() if entry.key not in known}:
                asked.write_text("\n".join(entry.text for entry in batch.values()), encoding="utf-8")
                words = ["uv", "pip", "install", "--quiet", "--no-deps", "--require-hashes", "-r", str(asked)]
                words += ["--python-version", where.python, "--target", str(place)]
                words += ["--python-platform", f"{where.machine}-manylinux_2_28"]
                subprocess.run(words, check=True)
                for package in distributions(path=[str(place)]):
                    said = package.metadata
                    known[f"{canonicalize_name(said['Name'])}=={package.version}"] = Metadata(
                        requires=said.get_all("Requires-Dist") or [],
                        extras=said.get_all("Provides-Extra") or [],
                        python=said["Requires-Python"] or "",
                    )
                missing = [entry.key for entry in batch.values() if entry.key not in known]
                if missing:
                    raise SystemExit(f"installed, but not with that name and version: {', '.join(missing)}")
    return dict(sorted(known.items()))


def main(words: list[str] | None = None) -> int:
    """Check the locks and return the exit status; with `--write`, write locks/requires.json first."""
    parser = argparse.ArgumentParser(description="Check that the locks are closed.")
    parser.add_argument("--write", action="store_true", help="write requires.json first (needs uv, network)")
    parser.add_argument("--root", type=Path, default=Path(__file__).parents[1], help="the project's folder")
    asked = parser.parse_args(words)
    if asked.write:
        text = json.dumps(gather(asked.root), indent=1) + "\n"
        (asked.root / "locks/requires.json").write_text(text, encoding="utf-8")
    try:
        said = check(asked.root)
    except ValueError as error:
        said = [str(error)]
    for sentence in said:
        print(sentence)
    if not said:
        print(f"the locks are closed in {len(ENVIRONMENTS)} environments")
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
