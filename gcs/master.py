"""The ground station as the game's master in the field: `gcs game run SCENARIO`.

The rules are `onboard.game.master.GameMaster`, the same as the bridge's. In the field nobody knows the
true motions: the referee judges the vehicles' own states, and the evader's track where it has none, put
side by side at one instant a little in the past, so that it interpolates what came early and late.
"""

from __future__ import annotations

import asyncio
import secrets
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

from gcs.picture.station_journal import SENT, Sent
from gcs.station import Station
from onboard.core.math.constants import NS_PER_S
from onboard.core.math.vectors import Vec, along, sub
from onboard.game.master import GameMaster, Standing, Timing
from onboard.game.scenario import Scenario
from onboard.game.staging import flown_targets, setup_of
from onboard.wire.bus import topics
from onboard.wire.bus.messages import (
    CommandKind,
    Health,
    Master,
    OutcomeResult,
    Phase,
    PhaseChange,
    Role,
    Severity,
    State,
    Track,
)
from onboard.wire.bus.topics import Heard, Topic

STEP_S = 0.05
LAG_NS = 300_000_000  # the instant judged lies so far back; most messages are there by then
KEPT = 64  # positions of each vehicle
LATE_NS = 1 * NS_PER_S  # a position is carried forward at most so far; then the vehicle is not judged
RECOVERY_S = 3.0


class Fix(NamedTuple):
    """Where something was."""

    at_ns: int  # by the master's clock
    position: Vec  # [m; NED]
    velocity: Vec  # [m/s; ground]


class Positions:
    """Where everybody was at an instant of the recent past. Pure."""

    def __init__(self) -> None:
        self._fixes: dict[int, deque[Fix]] = {}

    def add(self, vehicle_id: int, fix: Fix) -> None:
        """A new fix; one that is not newer than the last is dropped."""
        fixes = self._fixes.setdefault(vehicle_id, deque(maxlen=KEPT))
        if not fixes or fix.at_ns > fixes[-1].at_ns:
            fixes.append(fix)

    def at(self, at_ns: int) -> dict[int, Vec]:
        """Everybody's place at an instant: interpolated, or carried forward for at most a second."""
        found = {}
        for vehicle_id, fixes in self._fixes.items():
            place = _at(fixes, at_ns)
            if place is not None:
                found[vehicle_id] = place
        return found


def _at(fixes: deque[Fix], at_ns: int) -> Vec | None:
    newest = fixes[-1]
    if at_ns >= newest.at_ns:
        late = at_ns - newest.at_ns
        return along(newest.position, newest.velocity, late / NS_PER_S) if late <= LATE_NS else None
    after = newest
    for fix in reversed(fixes):
        if fix.at_ns <= at_ns:
            span = after.at_ns - fix.at_ns
            if span > 2 * LATE_NS:
                return None
            return along(fix.position, sub(after.position, fix.position), (at_ns - fix.at_ns) / span)
        after = fix
    return None


class FieldMaster:
    """Runs a game from a station. `run` it as a task; `over` tells when there is nothing left to do."""

    def __init__(
        self,
        station: Station,
        scenario: Scenario,
        *,
        auto_start: bool = True,
        nonce: int | None = None,
        takes_over: str = "",
        say: Callable[[str], None] = lambda line: None,
    ) -> None:
        flight = scenario.flight
        timing = Timing(flight.ready_s, flight.timeout_s if auto_start else 0.0, RECOVERY_S, auto_start)
        nonce = secrets.randbits(48) if nonce is None else nonce
        name = f"{station.member}/{nonce & 0xFFFFFFFF:08x}"  # a person takes over by name: no two have one
        self.rules = GameMaster(
            setup_of(scenario, station.game, name),
            flown_targets(scenario),
            name,
            nonce,
            timing,
            takes_over,
        )
        self._station = station
        self._say = say
        self._positions = Positions()
        self._offsets: dict[int, int] = {}  # agents' clocks − the master's [ns], as they measure it
        self._roles = {member.id: member.role for member in self.rules.setup.roster}
        self._heard_own: dict[int, int] = {}  # vehicle → its last own state
        self._takers: dict[Topic[Any], Callable[[Any, int], None]] = {
            topics.MASTER: self._on_master,
            topics.PHASE: self._on_phase,
            topics.HEALTH: self._on_health,
            topics.STATE: self._on_state,
            topics.TRACK: self._on_track,
            SENT: self._on_sent,
        }

    @property
    def over(self) -> bool:
        """The game has ended and been wound up, or somebody else is the master."""
        return self.rules.phase is Phase.RECOVERY or self.rules.standing is Standing.YIELDED

    @property
    def exit_code(self) -> int:
        """0 where the game ended with a verdict."""
        outcome = self.rules.outcome
        return 0 if outcome is not None and outcome.verdict is not OutcomeResult.ABORTED else 1

    def status(self) -> str:
        """For people: what it waits for."""
        if self.rules.standing is not Standing.HOLDING:
            return f"master {self.rules.standing.value}"
        now_ns = self._station.now_ns()
        lacking = self.rules.lacking(now_ns, now_ns) if self.rules.phase is Phase.STAGING else {}
        if lacking:
            vehicle_id, reason = min(lacking.items())
            return f"master: vehicle {vehicle_id}: {reason}"
        return f"master: {self.rules.phase.value}"

    async def run(self) -> None:
        """Be the master until cancelled; who leaves in mid-game ends it."""
        try:
            with self._station.heard_by(self._hear):
                while True:
                    self.step()
                    await asyncio.sleep(STEP_S)
        finally:
            if self.rules.standing is Standing.HOLDING and self.rules.outcome is None:
                now_ns = self._station.now_ns()
                self.rules.abort(now_ns, now_ns, "the ground station left")
                self.step()

    def step(self) -> None:
        """Judge what is due, and say what is due."""
        now_ns = self._station.now_ns()  # steady: wall and monotonic time in one
        self.rules.tick(now_ns, now_ns)
        judged_ns = now_ns - LAG_NS
        if judged_ns >= self.rules.t0_ns:
            self.rules.observe(judged_ns, now_ns, self._positions.at(judged_ns))
        for topic, message, id in self.rules.outgoing():
            key = topic.key(self._station.game, id)
            self._station.bus.publish(key, topic.encode(message), topic.delivery)
        for line in self.rules.news():
            self._say(line)
            self._station.remark(Severity.INFO, "master", line)

    def _hear(self, heard: Heard, now_ns: int) -> None:
        take = self._takers.get(heard.topic)
        if take is not None:
            take(heard.message, now_ns)

    def _on_master(self, master: Master, now_ns: int) -> None:
        self.rules.heard_master(master, now_ns)

    def _on_phase(self, phase: PhaseChange, now_ns: int) -> None:
        self.rules.heard_phase(phase)

    def _on_health(self, health: Health, now_ns: int) -> None:
        self._offsets[health.id] = round(health.clock_offset_s * NS_PER_S)
        self.rules.heard_health(health, now_ns)

    def _on_state(self, state: State, now_ns: int) -> None:
        if state.id not in self._roles:
            return
        self._heard_own[state.id] = now_ns
        at_ns = min(state.stamp_ns - self._offsets.get(state.id, 0), now_ns)
        self._positions.add(state.id, Fix(at_ns, Vec(*state.position), Vec(*state.velocity)))

    def _on_track(self, track: Track, now_ns: int) -> None:
        if self._roles.get(track.id) is not Role.EVADER:
            return
        self.rules.heard_track(track)
        if now_ns - self._heard_own.get(track.id, 0) < LATE_NS:
            return  # its own state is the better word
        self._positions.add(track.id, Fix(track.stamp_ns, Vec(*track.position), Vec(*track.velocity)))

    def _on_sent(self, sent: Sent, now_ns: int) -> None:
        """The operator's `start` starts, and an abort of everybody ends the game."""
        if sent.command.kind is CommandKind.START:
            self.rules.start()
        elif sent.command.kind is CommandKind.ABORT and set(self._roles) <= set(sent.ids):
            self.rules.abort(now_ns, now_ns, f"abort by {sent.command.sender}")
