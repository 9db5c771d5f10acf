"""The roster of a field: who takes part in a game on a real network, and by which certificate.

`gcs keys init ROSTER` reads it. A member's certificate carries `NAME.KEY`: to revoke a certificate that was
lost, raise the member's `key` and run it again; to revoke a member, take its entry out.
"""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated, NamedTuple

from msgspec import Meta

from onboard.config import strict as config
from onboard.config.bounds import SystemId
from onboard.config.names import GameName
from onboard.config.strict import StrictConfig, demand
from onboard.wire.bus.messages import Role
from onboard.wire.bus.topics import DEFAULT_GAME, Party

KeyNumber = Annotated[int, Meta(ge=1, le=9999, description="a number of a key from 1 to 9999")]
Port = Annotated[int, Meta(ge=1, le=65535, description="a port from 1 to 65535")]
Days = Annotated[int, Meta(ge=1, le=3650, description="1 to 3650 days")]
StationName = Annotated[
    str,
    Meta(
        pattern=r"\A[a-z][a-z0-9-]{0,30}\Z",
        description="a name of small letters, digits and hyphens, of at most 31 characters",
    ),
]
Host = Annotated[
    str,
    Meta(pattern=r"\A[A-Za-z0-9.:-]{1,253}\Z", description="a host name or an IP address, without a port"),
]


class StationPart(Enum):
    """What a station may do, beside seeing all and commanding."""

    MASTER = "master"  # stage and lead games
    SENSOR = "sensor"  # report tracks


class VehicleEntry(StrictConfig, frozen=True):
    """A vehicle and its agent."""

    id: SystemId
    role: Role
    key: KeyNumber = 1  # counts up when a certificate is revoked

    @property
    def name(self) -> str:
        """The member's name, and its folder's."""
        return f"vehicle-{self.id}"


class StationEntry(StrictConfig, frozen=True):
    """A ground station, or whatever else takes part without flying."""

    name: StationName
    parts: tuple[StationPart, ...] = ()
    commands: bool = True  # may order vehicles and see everything; false for a mere sensor
    key: KeyNumber = 1

    def __post_init__(self) -> None:
        demand(not self.name.startswith("vehicle-"), "name", self.name, "no name that vehicles have")
        demand(self.commands or bool(self.parts), "commands", "false", "true, or `parts` that it plays")


class FieldRoster(StrictConfig, frozen=True):
    """Everybody who takes part, and where they meet: the first station listens."""

    host: Host  # where the others find the first station
    vehicles: Annotated[tuple[VehicleEntry, ...], Meta(min_length=1, max_length=250)]
    stations: Annotated[tuple[StationEntry, ...], Meta(min_length=1, max_length=32)]
    game: GameName = DEFAULT_GAME
    port: Port = 7447
    days: Days = 30  # how long new certificates are valid

    def __post_init__(self) -> None:
        ids = [vehicle.id for vehicle in self.vehicles]
        demand(len(set(ids)) == len(ids), "vehicles.id", ids, "ids that differ")
        names = [station.name for station in self.stations]
        demand(len(set(names)) == len(names), "stations.name", names, "names that differ")
        masters = [s.name for s in self.stations if StationPart.MASTER in s.parts]
        demand(len(masters) <= 1, "stations.parts", f"masters {', '.join(masters)}", "one master at most")

    @property
    def endpoint(self) -> str:
        """Where the members connect."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"tls/{host}:{self.port}"

    @property
    def members(self) -> tuple[Member, ...]:
        """Everybody, the listening station first."""
        return (
            *(Member(s.name, f"{s.name}.{s.key}", _parties(s)) for s in self.stations),
            *(Member(v.name, f"{v.name}.{v.key}", vehicle=v) for v in self.vehicles),
        )


class Member(NamedTuple):
    """One who holds a certificate."""

    name: str
    certificate: str  # its common name
    parties: frozenset[Party] = frozenset()  # of a station
    vehicle: VehicleEntry | None = None  # of an agent

    def vehicles_of(self, party: Party, roster: FieldRoster) -> tuple[int, ...]:
        """For which vehicles' keys this member is `party`: ids of the roster."""
        if self.vehicle is None:
            return tuple(v.id for v in roster.vehicles) if party in self.parties else ()
        own, role = self.vehicle.id, self.vehicle.role
        if party is Party.OWN_AGENT:
            return (own,)
        if party is Party.SAME_SIDE:
            return tuple(v.id for v in roster.vehicles if v.role is role and v.id != own)
        if party is Party.ANY_AGENT or (party is Party.EVADER and role is Role.EVADER):
            return tuple(v.id for v in roster.vehicles)
        return ()


def _parties(station: StationEntry) -> frozenset[Party]:
    named = {StationPart.MASTER: Party.MASTER, StationPart.SENSOR: Party.SENSOR}
    parts = {named[part] for part in station.parts}
    return frozenset(parts | ({Party.STATION} if station.commands else set()))


def load(path: Path) -> FieldRoster:
    """Read a roster. Raises ConfigError, one line."""
    return config.read(path, FieldRoster)
