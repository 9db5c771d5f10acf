"""`gcs command` from a shell. It imports little, so that an abort leaves at once."""

from __future__ import annotations

import asyncio
import sys
from typing import NamedTuple

from gcs.picture.command_book import ENDS_A_FLIGHT, SETS_OFF
from gcs.picture.terminal_text import printable
from gcs.picture.values import Leg, LegState
from gcs.session import Session, on_air
from gcs.settings import Settings
from onboard.config.strict import ConfigError
from onboard.core.math.constants import NS_PER_S
from onboard.wire.bus.messages import CommandKind, Role

GATHER_S = 1.5  # to learn who is there


class Order(NamedTuple):
    """A command from a shell, to the vehicles named, to those of a role, or to all."""

    kind: CommandKind
    ids: tuple[int, ...]  # empty: all that are known, of `role` if that is given
    role: Role | None
    within_s: float  # how long confirmations are waited for


async def command(settings: Settings, order: Order, *, sure: bool) -> int:
    """Give a command and wait for the confirmations; exit code 0 when all have confirmed.

    An abort goes out at once: to the ids given, or called out to everybody, and to those who are only known
    later as they appear. Whatever else is commanded without ids is given to those who are heard first.
    """
    async with on_air(settings, listen=False, record=False, versions=False) as session:
        if order.kind is not CommandKind.ABORT:
            await _gather(session, order)
            ids = _whom(session, order)
            if ids and order.kind in ENDS_A_FLIGHT and not sure and not await _asked(order, ids):
                print("gcs: not done", file=sys.stderr)
                return 1
        return _tell(session, order, await _carry(session, order), settings.game)


async def _carry(session: Session, order: Order) -> tuple[Leg, ...]:
    """Give the command, also to who appears later, until it is settled or time is up; how all answered."""
    station = session.station
    everybody = order.kind is CommandKind.ABORT and not order.ids and order.role is None
    given: dict[str, None] = {station.abort_everybody(): None} if everybody else {}  # command ids
    legs: tuple[Leg, ...] = ()
    ends_ns = station.now_ns() + round(order.within_s * NS_PER_S)
    gathered_ns = ends_ns if order.kind is CommandKind.ABORT and not order.ids else station.now_ns()
    while station.now_ns() < ends_ns:
        told = {leg.id for leg in legs}
        fresh = [i for i in _whom(session, order) if i not in told]
        if everybody:
            for id in fresh:
                station.give_also(next(iter(given)), id)
        elif fresh:
            given[station.command(order.kind, fresh, named=len(order.ids) == 1)] = None
        if legs or session.bus.connected():
            gathered_ns = min(gathered_ns, station.now_ns() + round(GATHER_S * NS_PER_S))
        views = [station.reducer.book.view(command_id, station.now_ns()) for command_id in given]
        legs = tuple(leg for view in views if view is not None for leg in view.legs)
        if station.now_ns() >= gathered_ns and not any(leg.open for leg in legs):
            break
        await asyncio.sleep(0.02)
    return legs


def _tell(session: Session, order: Order, legs: tuple[Leg, ...], game: str) -> int:
    """Say who has confirmed; the exit code."""
    if not legs:
        print(f"gcs: nobody to command in game {game}: {session.bus.status()}", file=sys.stderr)
        return 1
    confirmed = sum(leg.state is LegState.CONFIRMED for leg in legs)
    print(f"{order.kind.value}: {confirmed} of {len(legs)} confirmed", flush=True)
    for leg in sorted(legs, key=lambda leg: leg.id):
        parts = [f"  vehicle {leg.id}: {leg.state.words}", f"({leg.reason})" if leg.reason else "", leg.mode]
        print(printable(" ".join(part for part in (*parts, f"after {leg.took_s:.2f} s") if part)), flush=True)
    return 0 if confirmed == len(legs) else 1


async def _gather(session: Session, order: Order) -> None:
    """Listen until who is meant is known: with ids there is nothing to wait for but the bus."""
    for _ in range(round(GATHER_S / 0.05)):
        fleet, now_ns = session.station.reducer.fleet, session.station.now_ns()
        met = order.kind not in SETS_OFF or all(fleet.quote(id, now_ns).agent for id in order.ids)
        if order.ids and session.bus.connected() and met:
            return
        await asyncio.sleep(0.05)


def _whom(session: Session, order: Order) -> tuple[int, ...]:
    if order.ids:
        return tuple(sorted(set(order.ids)))
    return session.station.ids(order.role)


async def _asked(order: Order, ids: tuple[int, ...]) -> bool:
    if not sys.stdin.isatty():
        raise ConfigError(f"{order.kind.value} ends a flight: found no terminal to ask, expected --yes")
    print(f"{order.kind.value} {', '.join(map(str, ids))}? type yes: ", end="", flush=True)
    answer: str = await asyncio.get_running_loop().run_in_executor(None, sys.stdin.readline)
    return answer.strip().lower() == "yes"
