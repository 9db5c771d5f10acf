"""Who is an evader, who a pursuer, and in which colour each is shown, from roles by id."""

from __future__ import annotations

from collections.abc import Mapping

from onboard.game import palette
from onboard.game.palette import Colour
from onboard.wire.bus.messages import Role


def evaders(roles: Mapping[int, Role | None]) -> tuple[int, ...]:
    """The ids of the evaders, ascending."""
    return tuple(sorted(id for id, role in roles.items() if role is Role.EVADER))


def pursuers(roles: Mapping[int, Role | None]) -> tuple[int, ...]:
    """The ids of the pursuers, ascending."""
    return tuple(sorted(id for id, role in roles.items() if role is Role.PURSUER))


def colours(roles: Mapping[int, Role | None]) -> dict[int, Colour]:
    """The colour of each vehicle in a game of these roles; those of no side are grey."""
    ranks = {id: rank for rank, id in enumerate(evaders(roles))}
    found = {id: palette.vehicle(id, True, rank) for id, rank in ranks.items()}
    found |= {id: palette.vehicle(id, False) for id in pursuers(roles)}
    return {id: found.get(id, palette.FAINT) for id in roles}
