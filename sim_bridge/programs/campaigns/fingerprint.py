"""What a game's outcome depends on beside its scenario and seed: sources and versions."""

from __future__ import annotations

import inspect
import platform
from functools import cache
from hashlib import sha256
from importlib import metadata
from pathlib import Path

import msgspec

from onboard.config.version import version
from onboard.core.strategy.registry import EVADERS, PURSUERS
from onboard.game.plugins import evader_strategy, plugins, pursuer_strategy
from onboard.game.policy_file import PREFIX, is_policy
from onboard.game.team_knowledge import files_of, is_team
from onboard.runtime.resources import configs

ROOT = Path(__file__).resolve().parent.parent.parent.parent
COMPUTED = (
    "onboard/config", "onboard/core", "onboard/pilot", "onboard/game", "onboard/wire/geodesy.py",
    "sim_bridge/draws.py", "sim_bridge/vehicle", "sim_bridge/plane_game", "sim_bridge/campaign",
    *(f"sim_bridge/programs/campaigns/{name}.py" for name in ("play", "plan", "sweep")),
)  # fmt: skip
FLOWN = ("onboard", "sim_bridge", "gcs")
PACKAGES = ("numpy", "numba", "llvmlite", "scipy", "pyarrow")


class Fingerprint(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Sources and versions; equal ones give equal bytes on one kind of machine."""

    sources: str  # SHA-256 of the sources that play
    plugins: dict[str, str]  # of each strategy of another distribution: its release and sources
    versions: dict[str, str]
    machine: str


def fingerprint(strategies: tuple[str, ...], *, flown: bool) -> Fingerprint:
    """Of games with these strategies, computed or flown."""
    own = {*EVADERS, *PURSUERS, ""}
    foreign = sorted({name for name in strategies if name not in own})
    told = dict(plugins())
    versions = {"apollonius": version(), "python": platform.python_version()}
    versions |= {name: metadata.version(name) for name in PACKAGES}
    return Fingerprint(
        sources(FLOWN if flown else COMPUTED),
        {name: f"{told.get(name, '')} {_source_of(name)}" for name in foreign},
        versions,
        platform.machine(),
    )


@cache
def sources(parts: tuple[str, ...]) -> str:
    """SHA-256 of all Python sources and shipped aircraft below these paths."""
    total = sha256()

    def take(path: Path, place: Path) -> None:
        total.update(f"{path.relative_to(place).as_posix()}\0".encode() + path.read_bytes() + b"\0")

    for part in parts:
        named = ROOT / part
        for path in [named] if named.is_file() else sorted(named.rglob("*.py")):
            take(path, ROOT)
    for path in sorted((configs() / "aircraft").rglob("*.toml")):
        take(path, configs())
    return total.hexdigest()


def _source_of(name: str) -> str:
    """SHA-256 of a policy's file, of those of a team's knowledge, or of that in which a plug-in's function
    stands; "": it has none."""
    if is_policy(name):
        return sha256(Path(name.removeprefix(PREFIX)).read_bytes()).hexdigest()[:16]
    if is_team(name):
        contents = b"".join(file.read_bytes() for file in files_of(name))
        return sha256(contents).hexdigest()[:16] if contents else ""
    for find in (pursuer_strategy, evader_strategy):
        try:
            file = inspect.getsourcefile(inspect.unwrap(find(name)))
        except Exception:  # of the other role, or written in another language
            continue
        if file is not None:
            return sha256(Path(file).read_bytes()).hexdigest()[:16]
    return ""
