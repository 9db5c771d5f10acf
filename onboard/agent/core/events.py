"""What happens to an agent (events) and what it wants done (effects): plain values that a file can keep.

Events and effects are frozen structs in MessagePack, so that `onboard.agent.event_file` can record a flight
and `gcs replay --decide` can feed it to the same machine again.
"""

from __future__ import annotations

from typing import NamedTuple

import msgspec

from onboard.core.game.views import EvaderView, PursuerView
from onboard.core.strategy.knowledge import Decision
from onboard.pilot.setup import Side
from onboard.wire.bus.messages import Severity
from onboard.wire.bus.topics import Delivery

ANY_PEER = -1  # of a link: whom it was configured for, or who was last heard


class Instant(NamedTuple):
    """One moment on the agent's two clocks."""

    s: float  # local monotonic time [s]: every timeout and age
    wall_ns: int  # wall time [ns since the epoch]: stamps of data


class LinkFacts(NamedTuple):
    """What the machine is told of one MAVLink link."""

    name: str  # for people: the URL that it was opened with
    stream: bool  # a serial line, for people; frames may be cut anywhere on every link


# ---------------------------------------------------------------------- events


class Event(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Base of all events."""


class Started(Event, frozen=True, tag=1):
    """Links and bus are open: the agent begins."""


class LinkBytes(Event, frozen=True, tag=2):
    """A datagram, or a piece of a byte stream, arrived on a MAVLink link."""

    link: int  # index among the agent's links
    peer: int  # who sent it, numbered by the shell for each link
    data: bytes


class BusMessage(Event, frozen=True, tag=3):
    """A message arrived on a subscribed key of the swarm bus."""

    key: str
    payload: bytes


class Request(Event, frozen=True, tag=4):
    """A request arrived on the agent's command key; it is answered by a `Reply` with the same token."""

    token: int
    payload: bytes


class BusState(Event, frozen=True, tag=5):
    """The bus came or went."""

    connected: bool


class ChildSaid(Event, frozen=True, tag=6):
    """The adapter's child process wrote one line (without its end)."""

    line: bytes


class ChildExited(Event, frozen=True, tag=7):
    """The adapter's child process has ended."""


class Answered(Event, frozen=True, tag=8):
    """A strategy has answered the `Think` of the same number, or failed."""

    number: int
    decision: Decision | None  # None: it failed, and `error` says how
    error: str
    took_s: float  # how long the strategy took [s]; inf = it will not answer any more


class Loaded(Event, frozen=True, tag=9):
    """A strategy was looked up for `Load`."""

    strategy: str  # its name
    error: str  # '' = it is there; otherwise why it cannot be used


class Counted(Event, frozen=True, tag=10):
    """What the shell counts, for a health report."""

    links: dict[str, int]  # of all links together, by cause
    bus: dict[str, int]  # of the bus, by cause
    shell: dict[str, int]  # of the shell: duration of control steps, what could not be recorded


class Stop(Event, frozen=True, tag=11):
    """The agent is to leave its vehicle and end."""


class Tick(Event, frozen=True, tag=12):
    """A deadline of the machine has come."""


class Idle(Event, frozen=True, tag=13):
    """What is urgent has been sent: `AgentCore.idle` is called."""


AnyEvent = (
    Started | LinkBytes | BusMessage | Request | BusState | ChildSaid | ChildExited | Answered | Loaded
    | Counted | Stop | Tick | Idle
)  # fmt: skip


# ---------------------------------------------------------------------- effects


class Effect(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Base of all effects."""


class Send(Effect, frozen=True, tag=1):
    """Send a MAVLink frame."""

    link: int  # index among the agent's links
    peer: int  # number of the peer as in `LinkBytes`, or ANY_PEER
    frame: bytes


class Think(Effect, frozen=True, tag=2):
    """Ask a strategy; the answer comes back as `Answered`."""

    number: int  # counts the questions
    side: Side
    strategy: str  # its name
    view: EvaderView | PursuerView  # what the strategy is shown


class Load(Effect, frozen=True, tag=3):
    """Look a strategy up; the result comes back as `Loaded`."""

    side: Side
    strategy: str


class Count(Effect, frozen=True, tag=4):
    """Report the shell's counters (`BusState` where that changed, and `Counted`)."""


class Publish(Effect, frozen=True, tag=5):
    """Put a message on the swarm bus."""

    key: str
    payload: bytes
    delivery: Delivery


class Reply(Effect, frozen=True, tag=6):
    """Answer a `Request`."""

    token: int
    payload: bytes


class Subscribe(Effect, frozen=True, tag=7):
    """Hear what is published on a key or pattern."""

    key: str


class Unsubscribe(Effect, frozen=True, tag=8):
    """Hear no more of it."""

    key: str


class Serve(Effect, frozen=True, tag=9):
    """Take requests on a key, for as long as the agent lives."""

    key: str


class Announce(Effect, frozen=True, tag=10):
    """Declare a token of liveliness, for as long as the agent lives."""

    key: str


class ChildStart(Effect, frozen=True, tag=11):
    """Start the adapter's child process."""

    arguments: tuple[str, ...]  # of its module


class ChildLine(Effect, frozen=True, tag=12):
    """Write to the child process without waiting."""

    data: bytes


class ChildEnd(Effect, frozen=True, tag=13):
    """Close the child's input: it then ends by itself."""


class Keep(Effect, frozen=True, tag=14):
    """Write a MAVLink frame that was received or sent to the telemetry log."""

    wall_ns: int
    frame: bytes


class Beat(Effect, frozen=True, tag=15):
    """A control step is complete: the service's watchdog is fed."""


class Note(Effect, frozen=True, tag=16):
    """One line for the log."""

    severity: Severity
    line: str


class End(Effect, frozen=True, tag=17):
    """The agent has left its vehicle: the process may end."""


AnyEffect = (
    Send | Think | Load | Count | Publish | Reply | Subscribe | Unsubscribe | Serve | Announce | ChildStart
    | ChildLine | ChildEnd | Keep | Beat | Note | End
)  # fmt: skip


class Outbox:
    """The effects of one call, in the order in which they are to be done."""

    def __init__(self) -> None:
        self._effects: list[AnyEffect] = []

    def put(self, effect: AnyEffect) -> None:
        """Add one."""
        self._effects.append(effect)

    def take(self) -> list[AnyEffect]:
        """All of them; the box is empty afterwards."""
        effects, self._effects = self._effects, []
        return effects
