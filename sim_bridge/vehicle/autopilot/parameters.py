"""The parameter protocol: PARAM_REQUEST_LIST, _READ and _SET over one table.

ArduPilot sends the number itself as a float; PX4 puts the bytes of an integer into the float.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from struct import pack, unpack
from typing import NamedTuple

from onboard.wire.mavlink.dialect import MavMessage, dialect

INT8: int = dialect.MAV_PARAM_TYPE_INT8
INT16: int = dialect.MAV_PARAM_TYPE_INT16
INT32: int = dialect.MAV_PARAM_TYPE_INT32
REAL32: int = dialect.MAV_PARAM_TYPE_REAL32
LARGEST = 3.4e38  # that a float of the wire can carry
UNNUMBERED = 65535  # param_index of an answer to a write
RANGES = {INT8: (-(2**7), 2**7 - 1), INT16: (-(2**15), 2**15 - 1), INT32: (-(2**31), 2**31 - 1)}


class Parameter(NamedTuple):
    """One parameter: name, value as delivered and type on the wire."""

    name: str
    default: float
    kind: int  # MAV_PARAM_TYPE


class Renamed(NamedTuple):
    """A parameter's name in another generation of firmware; its value is the recorded one times `factor`."""

    name: str
    factor: float = 1.0
    kind: int | None = None  # MAV_PARAM_TYPE where that changed too


class Parameters:
    """One autopilot's parameters, and the values still to be sent."""

    def __init__(
        self,
        table: tuple[Parameter, ...],
        overrides: Mapping[str, float],
        *,
        bytewise: bool,
        aliases: Mapping[str, Renamed] = {},
    ) -> None:
        """`overrides` take the place of the defaults. `aliases` say under which name and in which unit
        a parameter is delivered: the simulation goes on to read and put it under its own.
        """
        self._aliases = dict(aliases)
        self.changes = 0  # counted: what hangs on values is reckoned anew only then
        self._table = tuple(sorted(self._delivered(parameter) for parameter in table))
        self._numbers = {parameter.name: number for number, parameter in enumerate(self._table)}
        self._values = {p.name: p.default for p in self._table}
        self._read: dict[str, float] = {}  # what was read lately, by the names it is read under
        unknown = sorted(name for name in overrides if name not in self)
        if unknown:
            raise ValueError(f"no such parameters: {', '.join(unknown)}")
        for name, value in overrides.items():
            self.put(name, float(value))
        self._bytewise = bytewise
        self._listing = len(self._table)  # next number to send; beyond the last: none

    def __getitem__(self, name: str) -> float:
        value = self._read.get(name)
        if value is None:
            alias = self._aliases.get(name)
            value = self._values[name] if alias is None else self._values[alias.name] / alias.factor
            self._read[name] = value
        return value

    def __len__(self) -> int:
        return len(self._table)

    def __contains__(self, name: str) -> bool:
        return name in self._values or name in self._aliases

    def put(self, name: str, value: float) -> None:
        """Change a value from within. Raises KeyError for a name it does not know."""
        alias = self._aliases.get(name, Renamed(name))
        if alias.name not in self._numbers:
            raise KeyError(name)
        self._read.clear()
        self.changes += 1
        self._values[alias.name] = min(max(value * alias.factor, -LARGEST), LARGEST)

    def list_all(self) -> None:
        """Begin to send the whole table."""
        self._listing = 0

    @property
    def listed(self) -> bool:
        """Whether no listing is under way."""
        return self._listing >= len(self._table)

    def due(self, most: int) -> list[MavMessage]:
        """The next values of a listing under way."""
        first = self._listing
        if first >= len(self._table):
            return []
        self._listing = min(len(self._table), first + most)
        return [self._value(p, number) for number, p in enumerate(self._table[first : self._listing], first)]

    def read(self, name: str, number: int) -> MavMessage | None:
        """Answer to PARAM_REQUEST_READ: by number where that is not −1, else by name."""
        if number < 0:
            number = self._numbers.get(name, len(self._table))
        return self._value(self._table[number], number) if number < len(self._table) else None

    def write(self, name: str, value: float) -> MavMessage | None:
        """Answer to PARAM_SET: the value it now has. None for a name it does not know."""
        number = self._numbers.get(name)
        if number is None:
            return None
        parameter = self._table[number]
        if self._bytewise and parameter.kind != REAL32:
            value = float(unpack("<i", pack("<f", value))[0])
        if isfinite(value):
            if parameter.kind != REAL32:
                low, high = RANGES[parameter.kind]
                value = float(min(max(round(value), low), high))
            self._read.clear()
            self.changes += 1
            self._values[name] = value
        return self._value(parameter, UNNUMBERED)

    def _delivered(self, parameter: Parameter) -> Parameter:
        alias = self._aliases.get(parameter.name, Renamed(parameter.name))
        kind = parameter.kind if alias.kind is None else alias.kind
        return Parameter(alias.name, float(parameter.default) * alias.factor, kind)

    def _value(self, parameter: Parameter, number: int) -> MavMessage:
        value = self._values[parameter.name]
        if self._bytewise and parameter.kind != REAL32:
            value = unpack("<f", pack("<i", int(value)))[0]
        message: MavMessage = dialect.MAVLink_param_value_message(
            parameter.name.encode(), value, parameter.kind, len(self._table), number
        )
        return message
