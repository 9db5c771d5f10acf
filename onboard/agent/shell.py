"""The agent's shell: moves bytes between the machine and links, bus, files and children; decides nothing."""

from __future__ import annotations

import asyncio
import sys
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable, Sequence
from functools import partial
from math import inf
from typing import Any, NamedTuple

from onboard.agent.adapter_child import AdapterChild
from onboard.agent.config import AgentConfig
from onboard.agent.core.ahead import SHARE
from onboard.agent.core.events import (
    ANY_PEER,
    Announce,
    AnyEvent,
    Beat,
    BusMessage,
    BusState,
    ChildEnd,
    ChildLine,
    ChildStart,
    Count,
    Counted,
    End,
    Idle,
    Instant,
    Keep,
    LinkBytes,
    LinkFacts,
    Load,
    Note,
    Publish,
    Reply,
    Request,
    Send,
    Serve,
    Started,
    Stop,
    Subscribe,
    Think,
    Tick,
    Unsubscribe,
)
from onboard.agent.core.machine import AgentCore, Facts
from onboard.agent.event_file import EventFile
from onboard.agent.strategy_child import ApartThinker
from onboard.agent.thinker import Thinker
from onboard.agent.timing import Timing
from onboard.config.printable import printable
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.each import new
from onboard.game.route_file import Route
from onboard.runtime.fast_loop import grain_s
from onboard.runtime.protocols import Bus, Clock, Link, Sample, Subscription
from onboard.runtime.rate_limit import BESIDE, FROM_AUTOPILOT, FROM_OTHERS, RateLimit
from onboard.wire.mavlink.frames import first_number
from onboard.wire.mavlink.signing import Signing
from onboard.wire.mavlink.telemetry import FLIGHT

IDLE = Idle()
READY_S = 0.008  # before the strategy is asked again: what has come on the bus is taken in then
PEERS_MAX = 64  # of one link that are numbered; who was heard longest ago is forgotten


def to_stderr(line: str) -> None:
    """One line to standard error, at once: it may wait for whoever reads there."""
    print(printable(line), file=sys.stderr, flush=True)


class Equipment(NamedTuple):
    """What an agent is given besides its configuration, clock, links and bus."""

    nonce: int = 0  # random for each process
    version: str = ""  # of the package
    log: Callable[[str], None] = to_stderr  # takes the lines of the agent's events
    record: Callable[[int, bytes], None] | None = None  # (wall [ns], frame): sees every MAVLink frame
    events: EventFile | None = None  # records everything that happens
    signing: Signing | None = None
    beat: Callable[[], None] | None = None  # called with each control step: a service's watchdog
    route: Route | None = None  # of a tracker
    counters: Callable[[], dict[str, int]] = dict  # of the files that are written, for health reports
    master: str = ""  # the member of the field whose certificate may write as the master; "" = any
    apart: bool = False  # strategies of other distributions answer from child processes: on real time


class _Port:
    """One link, and the numbers of its peers."""

    def __init__(self, link: Link) -> None:
        self.link = link
        self.numbers: OrderedDict[Hashable, int] = OrderedDict()
        self.peers: dict[int, Hashable] = {}
        self.told: Hashable = None  # to whom was sent last: the autopilot
        self._next = 0

    def number(self, peer: Hashable) -> int:
        """The number of a peer: the same as long as it is not forgotten."""
        number = self.numbers.get(peer)
        if number is not None:
            if len(self.numbers) > 1:
                self.numbers.move_to_end(peer)
            return number
        if len(self.numbers) >= PEERS_MAX:
            _, old = self.numbers.popitem(last=False)
            del self.peers[old]
        number, self._next = self._next, self._next + 1
        self.numbers[peer] = number
        self.peers[number] = peer
        return number

    def send(self, peer: int, frame: bytes) -> None:
        """Send to a peer; nothing is sent to one who was forgotten."""
        if peer == ANY_PEER:
            self.link.send(frame, None)
        elif peer in self.peers:
            self.told = self.peers[peer]
            self.link.send(frame, self.told)


class Agent:
    """Flies one vehicle. Everything it needs is handed in; `run` it on any loop, end it with `stop`.

    Cancelling `run` falls silent at once, as a kill would; `stop` first leaves the vehicle in a mode that its
    autopilot can hold alone. Links and bus are the caller's. Raises ConfigError as `AgentCore` does.
    """

    def __init__(
        self, config: AgentConfig, clock: Clock, links: Sequence[Link], bus: Bus, equipment: Equipment
    ) -> None:
        self.config = config
        self.id = config.id
        self.clock = clock
        self.bus = bus
        self.timing = Timing(1.0 / config.control_rate_hz)
        self.thinker = Thinker(clock)
        self.apart = ApartThinker(self.thinker, self.feed, clock) if equipment.apart else None
        facts = Facts(
            equipment.nonce,
            tuple(LinkFacts(link.name, link.name.startswith("serial:")) for link in links),
            equipment.version,
            equipment.route,
            equipment.signing is not None,
            equipment.master,
        )
        self.core = AgentCore(config, facts, equipment.signing)
        self._equipment = equipment
        if equipment.events is not None:
            equipment.events.begin(config, facts)
        self._ports = [_Port(link) for link in links]
        self._link_limit = RateLimit()
        self._child = AdapterChild(self.feed)
        self._subscriptions: dict[str, Subscription] = {}
        self._held: list[Subscription] = []
        self._replies: dict[int, bytes] = {}
        self._token = 0
        self._connected = True
        self._waiting: deque[tuple[AnyEvent, Instant]] = deque()
        self._busy = False
        self._last, self._last_ns = Instant(0.0, 0), -1
        share = SHARE if config.decide_ahead else 1.0  # of a period, until the strategy is asked again
        self._next_thought = max(0.0, share / config.control_rate_hz - READY_S)
        self._arrived_ns = 0  # when the datagram arrived that is being handled; 0 = none is
        self._timer: asyncio.TimerHandle | None = None
        self._timer_at = inf
        self._grain = 0.0  # by which the loop's timers may be early [s]
        self._ended: asyncio.Future[None] | None = None
        self._stopping = False
        self._effects: dict[type, Callable[[Any], None]] = {
            Send: lambda effect: self._ports[effect.link].send(effect.peer, effect.frame),
            Think: self._think,
            Load: self._load,
            Count: self._count,
            Publish: lambda effect: self.bus.publish(effect.key, effect.payload, effect.delivery),
            Reply: lambda effect: self._replies.__setitem__(effect.token, effect.payload),
            Subscribe: self._subscribe,
            Unsubscribe: lambda effect: self._subscriptions.pop(effect.key).close(),
            Serve: lambda effect: self._held.append(self.bus.serve(effect.key, self._request)),
            Announce: lambda effect: self._held.append(self.bus.announce(effect.key)),
            ChildStart: lambda effect: self._child.start(*effect.arguments),
            ChildLine: lambda effect: self._child.write(effect.data),
            ChildEnd: lambda effect: self._child.close(),
            Keep: self._keep,
            Beat: self._beat,
            Note: lambda effect: equipment.log(effect.line),
            End: lambda effect: self._end(),
        }

    @property
    def now(self) -> float:
        """Monotonic time [s]."""
        return self.clock.monotonic_ns() / NS_PER_S

    async def run(self) -> None:
        """Fly until `stop` (or until cancelled). Raises what the machine raises."""
        loop = asyncio.get_running_loop()
        self._ended, self._grain = loop.create_future(), grain_s(loop)
        for index, port in enumerate(self._ports):
            port.link.receive(partial(self._arrived, index))
        self.feed(Started())
        if self._stopping:
            self.feed(Stop())
        try:
            await self._ended
        finally:
            self._ended = None
            if self._timer is not None:
                self._timer.cancel()
            self._child.close()
            if self.apart is not None:
                self.apart.close()
            for subscription in (*self._subscriptions.values(), *self._held):
                subscription.close()
            if self._equipment.events is not None:
                self._equipment.events.close()

    def stop(self) -> None:
        """Leave the vehicle and end `run`."""
        if self._stopping:
            return
        self._stopping = True
        if self._ended is not None:
            self.feed(Stop())

    # ------------------------------------------------------------------ events in, effects out

    def feed(self, event: AnyEvent) -> None:
        """Give the machine an event and do what it wants done, and then what can wait."""
        ended = self._ended
        if ended is None or ended.done():
            return
        if self._busy:
            self._put(event)
            return
        self._busy = True
        core, waiting, do, events = self.core, self._waiting, self._effects, self._equipment.events
        try:
            now = self._instant()
            effects = core.handle(event, now)
            while True:
                for effect in effects:
                    do[type(effect)](effect)
                if events is not None:
                    events.add(now, event, effects)
                if waiting:
                    event, now = waiting.popleft()
                    effects = core.handle(event, now)
                elif core.pending:
                    event, now = IDLE, self._instant()
                    effects = core.idle(now)
                else:
                    break
            self._arm()
        except Exception as error:  # on a loop's callback it would only be logged: the agent must end
            if not ended.done():
                ended.set_exception(error)
        finally:
            self._busy = False

    def _put(self, event: AnyEvent) -> None:
        self._waiting.append((event, self._instant()))

    def _instant(self) -> Instant:
        clock, last = self.clock, self._last
        elapsed_ns, wall_ns = clock.monotonic_ns(), clock.wall_ns()
        if elapsed_ns != self._last_ns or wall_ns != last.wall_ns:  # much happens at one instant, if virtual
            self._last_ns = elapsed_ns
            self._last = last = new(Instant, (elapsed_ns / NS_PER_S, wall_ns))
        return last

    def _arm(self) -> None:
        """Set the one timer."""
        at = self.core.next_deadline()
        if at == self._timer_at and self._timer is not None:
            return
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        self._timer_at = at
        if at < inf:
            loop, wait = asyncio.get_running_loop(), at - self.now
            self._timer = loop.call_later(wait + self._grain if wait > 0.0 else 0.0, self._tick)

    def _tick(self) -> None:
        self._timer = None
        self.feed(Tick())

    # ------------------------------------------------------------------ links, bus, requests

    def _arrived(self, index: int, data: bytes, peer: Hashable) -> None:
        now_ns = self.clock.monotonic_ns()
        port = self._ports[index]
        if not self._admits(index, data, peer == port.told, now_ns / NS_PER_S):
            return
        self._arrived_ns = now_ns
        self.feed(LinkBytes(index, port.number(peer), data))
        if self._arrived_ns == 0:  # a control step is done: what has come is wanted shortly before the next
            self.bus.wanted_in(self._next_thought)
        self._arrived_ns = 0

    def _admits(self, index: int, data: bytes, autopilot: bool, now: float) -> bool:
        """Whether a datagram is within the bounds of its sender and kind."""
        if not autopilot:
            return self._link_limit.admits((index, "others"), "link", FROM_OTHERS, now)
        number = first_number(data)
        if number in FLIGHT:
            return self._link_limit.admits((index, number), "autopilot", FROM_AUTOPILOT, now)
        return self._link_limit.admits((index, "beside"), "autopilot", BESIDE, now)

    def _subscribe(self, effect: Subscribe) -> None:
        self._subscriptions[effect.key] = self.bus.subscribe(effect.key, self._heard)

    def _heard(self, sample: Sample) -> None:
        self.feed(BusMessage(sample.key, sample.payload))

    def _request(self, payload: bytes) -> bytes:
        """Answer a request; nothing where the agent has ended."""
        self._token += 1
        self.feed(Request(self._token, payload))
        return self._replies.pop(self._token, b"")

    def _count(self, effect: Count) -> None:
        connected = self.bus.connected()
        if connected != self._connected:
            self._connected = connected
            self._put(BusState(connected))
        links: dict[str, int] = {}
        for port in self._ports:
            for cause, number in port.link.counters().items():
                links[cause] = links.get(cause, 0) + number
        for kind, number in self._link_limit.limited.items():
            links[f"limited_{kind}"] = number
        shell = self.timing.counters() | self._equipment.counters()
        if self._equipment.events is not None:
            shell |= self._equipment.events.counters()
        self._put(Counted(links, self.bus.counters(), shell))

    def _keep(self, effect: Keep) -> None:
        if self._equipment.record is not None:
            self._equipment.record(effect.wall_ns, effect.frame)

    def _beat(self, effect: Beat) -> None:
        if self._arrived_ns:
            self.timing.answered(self.clock.monotonic_ns() - self._arrived_ns)
            self._arrived_ns = 0
        if self._equipment.beat is not None:
            self._equipment.beat()

    def _end(self) -> None:
        if self._ended is not None and not self._ended.done():
            self._ended.set_result(None)

    # ------------------------------------------------------------------ strategies

    def _think(self, effect: Think) -> None:
        if self.apart is None:
            self._put(self.thinker.answer(effect))
        else:
            self.apart.answer(effect)

    def _load(self, effect: Load) -> None:
        if self.apart is None:
            self._put(self.thinker.load(effect))
        else:
            self.apart.load(effect)
