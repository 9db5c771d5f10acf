"""Where the files that come with the distribution lie (`configs/`), and their short names."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from onboard.config.in_words import nearest
from onboard.config.strict import ConfigError

_PACKAGE = Path(__file__).resolve().parent.parent


class Shelf(NamedTuple):
    """A kind of shipped files: a folder of `configs/`; its rooms in the order in which names are sought."""

    folder: str  # and the word for such files
    rooms: tuple[str, ...] = ("",)

    def sought_first(self, room: str) -> Shelf:
        """The same files, where a bare name means the one in `room` before those elsewhere."""
        return self._replace(rooms=(room, *(one for one in self.rooms if one != room)))


SCENARIOS = Shelf("scenarios", ("flight", "spatial", "table1", "gym", "classic"))
CLASSIC = Shelf("scenarios", ("classic",))  # problems with known values
AIRCRAFT = Shelf("aircraft")
ROUTES = Shelf("routes")


def configs() -> Path:
    """The folder `configs/`: inside an installed wheel, or beside the packages in a checkout."""
    inside = _PACKAGE / "configs"
    return inside if inside.is_dir() else _PACKAGE.parent / "configs"


def shipped_file(given: Path, shelf: Shelf) -> Path:
    """The file that is meant: a path as given, or a name (`one-on-one`, `table1/row03`) of a shipped one.

    A file of one's own goes before a shipped one of the same name, a folder does not. Raises ConfigError
    where there is neither.
    """
    if given.exists() and not given.is_dir():
        return given
    if not given.is_absolute() and ".." not in given.parts:
        shelved = configs() / shelf.folder
        for room in ("", *shelf.rooms):
            for candidate in (shelved / room / given, shelved / room / f"{given}.toml"):
                if candidate.is_file():
                    return candidate
    if given.exists():
        raise ConfigError(f"{given}: is a directory")
    known = list(named_files(shelf))
    if given.suffix or len(given.parts) > 1:
        raise ConfigError(f"{given}: no such file or directory{nearest(given.stem, known)}")
    hint = nearest(given, known)
    raise ConfigError(f"{given}: no such file; shipped {shelf.folder}: {', '.join(known)}{hint}")


def files(shelf: Shelf) -> list[Path]:
    """The shipped files of a kind, room by room."""
    return [path for room in shelf.rooms for path in sorted((configs() / shelf.folder / room).glob("*.toml"))]


def named_files(shelf: Shelf) -> dict[str, Path]:
    """The shipped files by their shortest names: with the room where a bare name means another file."""
    found: dict[str, Path] = {}
    for path in files(shelf):
        found[f"{path.parent.name}/{path.stem}" if path.stem in found else path.stem] = path
    return found
