"""`gcs keys init`, `show` and `sheet`: what they print. Each returns an exit code."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

from onboard.config.printable import printable
from onboard.config.strict import ConfigError
from onboard.game import field_roster
from onboard.runtime.clock import RealClock

try:
    from gcs.keys import folder as keys
except ModuleNotFoundError as missing:  # an installation without the extra `gcs`
    if (missing.name or "").partition(".")[0] != "cryptography":
        raise
    raise ConfigError("keys: found no package cryptography, expected apollonius[gcs]") from None

SOON_DAYS = 3


def init(roster_file: Path, folder: Path | None) -> int:
    """Make the keys of a roster, or bring them up to date."""
    roster = field_roster.load(roster_file)
    place = folder_of(roster_file) if folder is None else folder
    issued = keys.init(roster, roster_file.read_bytes(), place, _now())
    made = ", ".join(entry.member.name for entry in issued if entry.made)
    _say(f"{place}: {len(issued)} members of field {roster.game}, new keys for {made or 'nobody'}")
    listener = issued[0].member.name
    _say(f"copy each member's folder to its computer; restart {listener}, which enforces the roster")
    _say(f"what to write where, and for browsers on gcs page {keys.BROWSER_FILE}: gcs keys sheet {place}")
    return 0


def show(folder: Path) -> int:
    """List the members; 1 where a certificate has ended."""
    roster, issued = keys.show(folder)
    now = _now()
    _say(f"field {roster.game} at {roster.endpoint}")
    for entry in issued:
        left = (entry.ends - now).total_seconds() / 86400
        until = f"until {entry.ends:%Y-%m-%d}" if left > 0 else f"EXPIRED {entry.ends:%Y-%m-%d}"
        soon = " (soon)" if 0 < left < SOON_DAYS else ""
        mavlink = f", MAVLink key {entry.mavlink}" if entry.mavlink else ""
        _say(f"  {entry.member.certificate:24} {entry.fingerprint} {until}{soon}{mavlink}")
    return 1 if any(entry.ends <= now for entry in issued) else 0


def sheet(folder: Path) -> int:
    """Print the lines that each member's configuration needs, and who may do what."""
    from onboard.game.access import Use, grants

    roster, issued = keys.show(folder)
    _say(f"# field {roster.game}, {len(issued)} members, everybody meets at {roster.endpoint}")
    for index, (member, *_) in enumerate(issued):
        _say(f"\n# {member.name}: copy {folder / member.name}/ to its computer (scp -rp), files stay 0600")
        if member.vehicle is not None:
            _say(f'# agent.toml\nzenoh = "{member.name}/{keys.ZENOH_FILE}"\nfield = true')
            _say(f'[signing]\nkey = "{member.name}/{keys.MAVLINK_FILE}"')
        else:
            _say(f'# gcs.toml\n[bus]\nzenoh = "{member.name}/{keys.ZENOH_FILE}"')
            _say(f"listen = {'true' if index == 0 else 'false'}")
        if index == 0:
            _say("# gcs page for browsers on other computers")
            _say(f'[page]\ntls_keys = "{member.name}"\nhost = "{roster.host}"')
            _say("control = false  # true: who may write orders gives them on the page, too")
        may = {
            use: sorted({grant.topic.suffix for grant in grants(member, roster) if grant.use is use})
            for use in Use
        }
        if member.vehicle is None and may[Use.READ]:
            _say(f"# its browser on the page: import {member.name}/{keys.BROWSER_FILE} (no password) as a")
            _say(f"# certificate of its own, trust {folder / keys.AUTHORITY_FILE} (no secret)")
        for use, topics in may.items():
            _say(f"# may {use.value}: {', '.join(topics) or 'nothing'}")
    return 0


def folder_of(roster_file: Path) -> Path:
    """Where a roster's keys lie unless told: beside it, in NAME-keys."""
    return roster_file.with_name(f"{roster_file.stem}-keys")


def _say(text: str) -> None:
    """Lines to standard output, whatever a folder's name holds."""
    print("\n".join(map(printable, text.split("\n"))))


def _now() -> datetime:
    return datetime.fromtimestamp(RealClock().wall_ns() / 1e9, UTC)
