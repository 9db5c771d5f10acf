"""Every way in which a flight of the agent ends: the vehicle then holds, returns or lands, as its row says.

The rows are what is demanded of a real vehicle, not what the code has: docs/safety.md prints them. Each is
flown on the simulated autopilot, on virtual time: within 9 s of the ending (the slowest failsafe acts after
5 s, and PX4 brakes before it lands) the vehicle is in the row's mode, and for the ten seconds after that it
holds, comes home or lands. Before and after, it sinks in no other mode than LAND and RTL.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from math import hypot, inf
from typing import NamedTuple

import pytest

from onboard.agent.config import AgentConfig
from onboard.agent.preflight import Ears, Sight
from onboard.game.scenario import WINGED, Kind, SimulatedSpec, Transmitter
from onboard.pilot.predictor_choice import Predicting
from onboard.wire.bus.messages import CommandKind
from sim_bridge.vehicle.autopilot.command import Command
from sim_bridge.vehicle.autopilot.health import Fault
from tests.support.paths import ROOT
from tests.support.small_scenarios import EVADER, PURSUER, chase
from tests.support.virtual_time import virtual
from tests.support.whole_games import (
    WholeGame,
    autopilot,
    command,
    game_of,
    mode,
    order,
    place,
    speed,
    under_way,
)

pytestmark = pytest.mark.game

STICK, LOW, NONE = Transmitter.CENTRED, Transmitter.LOW, Transmitter.NONE
COPTER, PLANE, PX4, PX4_PLANE = Kind.ARDUCOPTER, Kind.ARDUPLANE, Kind.PX4, Kind.PX4_PLANE
WITHOUT = (LOW, NONE)
ALL = (STICK, LOW, NONE)
SINKS_IN = frozenset(("LAND", "RTL"))
HEARTBEAT, DO_SET_MODE = 0, 176
HELD, RETURNING, LANDING = "held", "returning", "landing"
# Parameters of a vehicle that was set up as `onboard-agent check` demands.
SET_UP = {
    COPTER: {"FS_GCS_ENABLE": 1.0, "SYSID_MYGCS": float(PURSUER), "FS_EKF_ACTION": 1.0, "FS_OPTIONS": 16.0},
    PLANE: {"FS_GCS_ENABL": 1.0, "SYSID_MYGCS": float(PURSUER), "FS_LONG_ACTN": 1.0},
    PX4: {"COM_OBL_RC_ACT": 5.0},
    PX4_PLANE: {"COM_OBL_RC_ACT": 5.0},
}


class Row(NamedTuple):
    """One line of the table."""

    ending: str
    kind: Kind
    sticks: tuple[Transmitter, ...]
    mode: str  # in which the vehicle is left
    what: str  # held, returning or landing
    more: tuple[tuple[str, float], ...] = ()  # parameters that differ from SET_UP


ORDERS = {
    (COPTER, (STICK,)): ("LOITER", "RTL", "LAND"),
    (COPTER, WITHOUT): ("BRAKE", "RTL", "LAND"),
    (PLANE, ALL): ("LOITER", "RTL", "RTL"),  # how a plane lands is its mission's business
    (PX4, ALL): ("HOLD", "RTL", "LAND"),
    (PX4_PLANE, ALL): ("HOLD", "RTL", "LAND"),
}
TABLE = [
    *(Row(ending, kind, sticks, modes[0], HELD)
      for (kind, sticks), modes in ORDERS.items()
      for ending in ("hold", "abort", "game end")),
    *(Row("return", kind, sticks, modes[1], RETURNING) for (kind, sticks), modes in ORDERS.items()),
    *(Row("land", kind, sticks, modes[2], LANDING if modes[2] == "LAND" else RETURNING)
      for (kind, sticks), modes in ORDERS.items()),
    # The agent itself leaves: ctrl-C and SIGTERM are one event to it.
    Row("ctrl-C, SIGTERM", COPTER, (STICK,), "LOITER", HELD),  # a pilot is there
    Row("ctrl-C, SIGTERM", COPTER, WITHOUT, "RTL", RETURNING),
    Row("ctrl-C, SIGTERM, FS_OPTIONS 0", COPTER, WITHOUT, "RTL", RETURNING, (("FS_OPTIONS", 0.0),)),
    Row("ctrl-C, SIGTERM", PLANE, ALL, "RTL", RETURNING),
    Row("ctrl-C, SIGTERM", PX4, ALL, "HOLD", HELD),
    Row("ctrl-C, SIGTERM", PX4_PLANE, ALL, "HOLD", HELD),
    # The agent falls silent: the autopilot's own failsafe.
    *(Row(ending, kind, ALL, left, what)
      for ending in ("kill", "crash")
      for kind, left, what in ((COPTER, "RTL", RETURNING), (PLANE, "RTL", RETURNING), (PX4, "HOLD", HELD),
                               (PX4_PLANE, "HOLD", HELD))),
    *(Row("check ends", kind, sticks, left, HELD)  # it was never flown by us: nothing changes
      for kind, sticks, left in ((COPTER, (STICK,), "LOITER"), (COPTER, WITHOUT, "BRAKE"),
                                 (PX4, ALL, "HOLD"), (PX4_PLANE, ALL, "HOLD"))),
    # ArduPlane's GCS failsafe counts from boot, heard or not: here it is off.
    Row("check ends", PLANE, ALL, "LOITER", HELD, (("FS_GCS_ENABL", 0.0),)),
    # The agent lives, and cannot go on.
    *(Row("lost bus", kind, ALL, left, HELD)
      for kind, left in ((COPTER, "GUIDED"), (PLANE, "LOITER"), (PX4, "OFFBOARD"),
                         (PX4_PLANE, "HOLD"))),
    *(Row("strategy fault", kind, ALL, left, HELD)
      for kind, left in ((COPTER, "GUIDED"), (PLANE, "LOITER"), (PX4, "HOLD"), (PX4_PLANE, "HOLD"))),
    *(Row("battery", kind, ALL, "RTL", RETURNING) for kind in (COPTER, PLANE, PX4, PX4_PLANE)),
    # Without position: the autopilot's own failsafe, and no mode that needs position.
    *(Row(ending, kind, ALL, left, what)
      for ending in ("GPS", "EKF", "hold without GPS", "ctrl-C without GPS")
      for kind, left, what in ((COPTER, "LAND", LANDING), (PLANE, "CIRCLE", HELD), (PX4, "LAND", LANDING),
                               (PX4_PLANE, "LAND", LANDING))
      if (ending, kind) != ("ctrl-C without GPS", PLANE)),
    # … out of which ArduPlane's GCS failsafe flies home by what it reckons.
    Row("ctrl-C without GPS", PLANE, ALL, "RTL", RETURNING),
]  # fmt: skip
BEGIN, END = "<!-- begin: endings -->", "<!-- end: endings -->"
NEEDS_NO_POSITION = frozenset(("LAND", "CIRCLE"))
EVERYWHERE = {  # what the suite flies each time; all else is `long`
    ("abort", COPTER, NONE), ("ctrl-C, SIGTERM", COPTER, LOW), ("crash", PLANE, NONE), ("GPS", PX4, NONE),
}  # fmt: skip


def printed() -> str:
    """The table as docs/safety.md has it."""
    columns = ((COPTER, STICK), (COPTER, NONE), (PLANE, NONE), (PX4, NONE),
               (PX4_PLANE, NONE))
    left = {
        (row.ending, row.kind, sticks): row.mode if row.what == HELD or row.mode == "LAND" else "RTL"
        for row in TABLE
        for sticks in row.sticks
    }
    names = ("the flight ends by", "ArduCopter, stick centred", "ArduCopter without", "ArduPlane",
             "PX4 multicopter", "PX4 plane")  # fmt: skip
    lines = [f"| {' | '.join(names)} |", "|---" * len(names) + "|"]
    for ending in dict.fromkeys(row.ending for row in TABLE):
        cells = [left.get((ending, *column), "") for column in columns]
        lines.append(f"| {ending} | {' | '.join(cells)} |")
    return "\n".join(lines)


async def _killed(game: WholeGame) -> None:
    game.kill_agent(PURSUER)


async def _crashed(game: WholeGame) -> None:
    """An error inside the machine: the process ends, with its words, and says no more to the autopilot."""

    def handle(*_: object) -> None:
        raise RuntimeError("a fault of the program")

    game.agents[PURSUER].core.handle = handle  # type: ignore[method-assign,assignment]
    (crashed,) = await asyncio.gather(game._tasks.pop(PURSUER), return_exceptions=True)
    assert str(crashed) == "a fault of the program"


async def _checked(game: WholeGame) -> None:
    """A preflight check listens for five seconds, asks what it asks, and ends."""
    own, heard = autopilot(game, PURSUER), set[int]()
    receive = own.receive
    own.receive = lambda now, data, peer: (  # type: ignore[method-assign]
        heard.add(int.from_bytes(data[7:10], "little")) or receive(now, data, peer)  # type: ignore[func-returns-value]
    )
    bus = game.broker.connect("check")
    ears = Ears(AgentConfig(id=PURSUER), [game.links[PURSUER]], bus, None, game.clock)
    seen = await ears.listen(Sight(bytecode=True, free_bytes=1e9), 5.0)
    assert seen.kind
    assert heard
    assert HEARTBEAT not in heard
    game.links[PURSUER].receive(lambda data, peer: None)


async def _stopped(game: WholeGame) -> None:
    game.agents[PURSUER].stop()


async def _bus_lost(game: WholeGame) -> None:
    game.broker.kill()


async def _strategy_failed(game: WholeGame) -> None:
    def ask(*_: object) -> None:
        raise ZeroDivisionError("a fault of the strategy")

    game.agents[PURSUER].core.part.ask = ask  # type: ignore[method-assign,assignment]


async def _battery_low(game: WholeGame) -> None:
    autopilot(game, PURSUER).set_battery(0.1)


async def _over(game: WholeGame) -> None:
    game.bridge.master.abort("the day is over")  # type: ignore[union-attr]


def _fails(fault: Fault) -> Callable[[WholeGame], Awaitable[None]]:
    async def fail(game: WholeGame) -> None:
        autopilot(game, PURSUER).fail(fault)

    return fail


def _ordered(kind: CommandKind) -> Callable[[WholeGame], Awaitable[None]]:
    async def give(game: WholeGame) -> None:
        await order(game, PURSUER, command(kind))

    return give


def _blind_then(then: Callable[[WholeGame], Awaitable[None]]) -> Callable[[WholeGame], Awaitable[None]]:
    async def both(game: WholeGame) -> None:
        autopilot(game, PURSUER).fail(Fault.GPS)
        await game.forward(0.7)  # known to the agent, and not yet acted upon by the autopilot
        await then(game)

    return both


ENDINGS: dict[str, Callable[[WholeGame], Awaitable[None]]] = {
    **{kind.value: _ordered(kind) for kind in (CommandKind.HOLD, CommandKind.RETURN, CommandKind.LAND,
                                               CommandKind.ABORT)},
    "game end": _over, "ctrl-C, SIGTERM": _stopped, "ctrl-C, SIGTERM, FS_OPTIONS 0": _stopped,
    "kill": _killed, "crash": _crashed, "check ends": _checked, "lost bus": _bus_lost,
    "strategy fault": _strategy_failed, "battery": _battery_low, "GPS": _fails(Fault.GPS),
    "EKF": _fails(Fault.EKF), "hold without GPS": _blind_then(_ordered(CommandKind.HOLD)),
    "ctrl-C without GPS": _blind_then(_stopped),
}  # fmt: skip


class Sinking:
    """Watches the truth from now on: how far a vehicle sinks in modes in which it must not."""

    def __init__(self, game: WholeGame) -> None:
        self._game = game
        self._high = -inf  # the greatest height in the present mode [m]
        self._mode = ""
        self.worst = ("", 0.0)

    def look(self) -> bool:
        """Look once; False, so that a wait goes on."""
        now, height = mode(self._game, PURSUER), -place(self._game, PURSUER).z
        if now != self._mode:
            self._mode, self._high = now, height
        self._high = max(self._high, height)
        if now not in SINKS_IN and self._high - height > self.worst[1]:
            self.worst = (now, self._high - height)
        return False


async def flown(row: Row, sticks: Transmitter) -> None:
    """The story of one row."""
    around = SimulatedSpec(transmitter=sticks, parameters=SET_UP[row.kind] | dict(row.more))
    scenario = chase(row.kind, simulated=around, prediction=Predicting.CONSTANT_VELOCITY)
    async with game_of(scenario, any_error=True) as game:
        game.expects_abort()
        if row.kind is PLANE:  # the set-up is the pursuer's; unwatched, the evader would fly home
            autopilot(game, EVADER).parameters.put("SYSID_MYGCS", float(EVADER))
        if row.ending == "check ends":
            game.kill_agent(PURSUER)  # at once: it has said nothing
            await game.forward(2.0)
        else:
            await under_way(game, 3.0)
        sinking = Sinking(game)
        asked = _modes_asked(game)
        await ENDINGS[row.ending](game)
        within = 150.0 if row.ending == "lost bus" else 9.0  # until what was last known is known no more
        await game.forward(within, until=lambda: sinking.look() or _there(game, row))
        await _then(game, row, sinking)
        if "GPS" in row.ending or row.ending == "EKF":
            assert set(asked) <= NEEDS_NO_POSITION, asked


def _modes_asked(game: WholeGame) -> list[str]:
    """A list that from now on receives each mode that anybody orders by DO_SET_MODE."""
    own, asked = autopilot(game, PURSUER), list[str]()
    obey = own.commands[DO_SET_MODE]
    names = {number: name for name, number in own.modes.items()}
    px4 = "OFFBOARD" in own.modes

    def obeyed(now_ns: int, order: Command) -> int:
        number = int(order.p2) << 16 | int(order.p3) << 24 if px4 else int(order.p2)
        asked.append(names[number])
        return obey(now_ns, order)

    own.commands[DO_SET_MODE] = obeyed
    return asked


def _there(game: WholeGame, row: Row) -> bool:
    """Whether the row's mode is entered; one that was flown in, too, counts once it does not move."""
    still = row.mode not in ("GUIDED", "OFFBOARD") or speed(game, PURSUER) < 0.5
    return mode(game, PURSUER) == row.mode and still


async def _then(game: WholeGame, row: Row, sinking: Sinking) -> None:
    """What the vehicle does from the row's mode on."""
    plane = row.kind in WINGED
    await _for(game, 4.0, sinking)
    begun, places = place(game, PURSUER), []
    for _ in range(20):
        await _for(game, 0.5, sinking)
        places.append(place(game, PURSUER))
    left = mode(game, PURSUER)
    assert left == row.mode or (row.what == LANDING and left == "HOLD")
    worst = sinking.worst
    assert worst[1] < (15.0 if plane else 2.0), f"sank {worst[1]:.1f} m in {worst[0]}"
    if row.what == LANDING:
        assert -places[-1].z < -begun.z - 3.0
    elif row.what == HELD:
        low, high = min(-p.z for p in places), max(-p.z for p in places)
        assert high - low < (15.0 if plane else 2.0)
        wide = max(hypot(p.x - q.x, p.y - q.y) for p in places for q in places)
        assert wide < (600.0 if plane else 3.0), f"{wide:.1f} m wide"
    else:
        home = autopilot(game, PURSUER).game_position(*autopilot(game, PURSUER).home)
        far = [hypot(p.x - home.x, p.y - home.y) for p in (begun, *places)]
        assert far[-1] < far[0] or far[-1] < (600.0 if plane else 3.0), f"{far[0]:.0f} to {far[-1]:.0f} m"


async def _for(game: WholeGame, seconds: float, sinking: Sinking) -> None:
    end = game.clock.monotonic_ns() + round(seconds * 1e9)
    await game.until(lambda: sinking.look() or game.clock.monotonic_ns() >= end, seconds + 1.0)


def cases() -> list[object]:
    """Each row with each state of the sticks."""
    found = []
    for row in TABLE:
        for sticks in row.sticks:
            here = (row.ending, row.kind, sticks) in EVERYWHERE
            marks = () if here else (pytest.mark.long,)
            name = f"{row.ending}-{row.kind.value}-{sticks.value}"
            found.append(pytest.param(row, sticks, id=name, marks=marks))
    return found


@pytest.mark.parametrize(("row", "sticks"), cases())
@virtual
async def test_the_vehicle_is_left_as_its_row_says(row: Row, sticks: Transmitter) -> None:
    await flown(row, sticks)


def test_the_handbook_prints_the_table() -> None:
    page = (ROOT / "docs" / "safety.md").read_text(encoding="utf-8")
    assert f"{BEGIN}\n{printed()}\n{END}" in page, printed()


def test_every_ending_is_in_the_table_for_every_kind_with_every_state_of_the_sticks() -> None:
    covered = {(row.ending, row.kind, sticks) for row in TABLE for sticks in row.sticks}
    special = "ctrl-C, SIGTERM, FS_OPTIONS 0"
    for ending in ENDINGS:
        for kind in (COPTER, PLANE, PX4, PX4_PLANE):
            for sticks in ALL:
                assert (ending, kind, sticks) in covered or ending == special, (ending, kind, sticks)
    assert len(covered) == sum(len(row.sticks) for row in TABLE)
