"""One vehicle flown: ask, supervise, command. The one place from which setpoints go out."""

from __future__ import annotations

from math import inf

from onboard.agent.config import AgentConfig
from onboard.agent.core.ahead import Ahead, OpenStep
from onboard.agent.core.bus_view import BusView
from onboard.agent.core.clip_spells import ClipSpells
from onboard.agent.core.clocks import JumpWatch
from onboard.agent.core.command_book import SETS_OFF, Orders
from onboard.agent.core.events import Answered, Instant, Think
from onboard.agent.core.hands import Hands
from onboard.agent.core.hold_alert import HoldAlert
from onboard.agent.core.journal import Journal
from onboard.agent.core.part import Part, PartState
from onboard.agent.core.policy_from_config import only_limits
from onboard.agent.core.takeoff import TakeOff
from onboard.agent.core.to_place import by_itself, circling, own_state
from onboard.agent.core.vehicle_link import Control, VehicleLink
from onboard.autopilot.base import Adapter, ReleaseMode, Stage, Telemetry
from onboard.config.printable import named
from onboard.core.math.constants import NEVER
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.safety.policy import Action, Cause, Command, Policy, SupervisorInput
from onboard.core.safety.supervisor import (
    SupervisorOutput,
    SupervisorState,
    handed_back,
    in_another_game,
    reachable,
    reordered,
    supervise,
)
from onboard.core.safety.words import ACTIONS, CAUSES
from onboard.pilot.pilot import PilotDecision
from onboard.wire.bus import messages
from onboard.wire.mavlink.modes import Kind

SILENT_S = 1.0  # a link silent for longer explains that the autopilot changed to hold by itself
REGAIN_S = 6.0  # … for so long afterwards
RELEASES = {
    Command.RELEASE_TO_HOLD: ReleaseMode.HOLD,
    Command.RELEASE_TO_RETURN: ReleaseMode.RETURN,
    Command.RELEASE_TO_LAND: ReleaseMode.LAND,
}


class Flight:
    """Flies one vehicle's part under supervision."""

    def __init__(
        self, config: AgentConfig, vehicle: VehicleLink, bus: BusView, orders: Orders, journal: Journal,
        part: Part,
    ) -> None:  # fmt: skip
        self.config = config
        self.part = part
        self.decision: PilotDecision | None = None  # the last one; None while the part is not on
        self.output: SupervisorOutput | None = None  # the last one; None while nothing is supervised
        self.playing = False  # the part is on
        self.wanted = ZERO  # [m/s; air] of the last decision, as far as the vehicle can follow within a step
        self.setpoint = ZERO  # [m/s; ground] let through in this step
        self.clips = ClipSpells()
        self.failures = 0  # of the strategy
        self.take_off = TakeOff(config.take_off_height)
        self.open: OpenStep | None = None
        self.ahead = Ahead(config, part)
        self.ending = False  # the process ends: the vehicle is left in the autopilot's mode to hold
        self.vehicle, self.bus, self._orders, self._journal = vehicle, bus, orders, journal
        self._state = SupervisorState()
        self._latched = (Action.PASS, Cause.NONE)  # as an order that sets off found it
        self._policy = part.policy
        self._jumps = JumpWatch(config.safety.clock_jump_s)
        self.hands = Hands(config, vehicle, orders)
        self.hold = HoldAlert(journal)
        self._number, self._failing = 0, False
        self._alive_at = NEVER  # the strategy's last sign of life [s]
        self._silent_at = NEVER  # when the link was last found silent [s]
        self._ran_at = NEVER  # the last control step [s]

    # ------------------------------------------------------------------ the control step

    def step(self, now: Instant) -> Think | None:
        """Begin a control step. Where a strategy is to be asked, `answered` completes it."""
        jump = self._jumps.look(now)
        if jump != 0.0:
            self.bus.clock.restart()
            self._journal.error("clock_jump", f"the wall clock jumped by {jump:+.3f} s")
        self.part.follow(now)  # it may fix the frame in which positions count
        telemetry = self.vehicle.look(now.s)
        state = self.part.state(now.wall_ns)
        self.hands.follow(state)
        if self.part.policy is not self._policy:
            if not only_limits(self._policy, self.part.policy):  # another game: what is latched stays
                self._state = in_another_game(self._state)
            self._policy = self.part.policy
        heard_at = max(telemetry.heartbeat_at, telemetry.position_at)
        stood = self._ran_at != NEVER and now.s - self._ran_at > SILENT_S
        if stood or (telemetry.heartbeat_at != NEVER and now.s - heard_at > SILENT_S):
            self._silent_at = now.s
        self._ran_at = now.s
        self.setpoint = ZERO
        if not state.on:
            self.decision = self.output = self.open = None
            self.playing = False
            self._stand_by(now, telemetry, state)
            return None
        self.playing = True
        self.hands.took = self.hands.took or self.hands.leave
        self.vehicle.facing = None
        return self._ask(now, telemetry)

    def answered(self, answer: Answered) -> bool:
        """Complete the control step that asked; False where none waits for this answer."""
        step = self.open
        if self.ahead.answered(answer) or step is None or step.number != answer.number:
            return False
        self.open = None
        error = answer.error or ("no decision" if answer.decision is None else "")
        if answer.decision is not None and step.question is not None:
            try:
                self.decision = self.part.conclude(step.question, answer.decision)
            except Exception as trouble:  # a strategy of another distribution may answer anything
                error = named(trouble)
        self._complete(step, answer.took_s, error)
        return True

    def given_up(self, now: float) -> None:
        """Complete the open control step without an answer: the strategy has not spoken in time."""
        step, self.open = self.open, None
        if step is not None:
            took = now - step.begun.s
            self._complete(step, took, f"no answer within {took:.2f} s")

    def _ask(self, now: Instant, t: Telemetry) -> Think | None:
        own = own_state(now.s, t, hovers=self.vehicle.hovers is not False)
        self._number += 1
        foreseen = self.ahead.take(now.s)
        self.ahead.stepped(now)
        if foreseen is not None:
            self.decision = foreseen.decision
            self._complete(OpenStep(self._number, now, t, own.wind, None), foreseen.age, "")
            self._alive_at = foreseen.made
            return None
        try:
            asked = self.part.ask(now, own)
        except Exception as trouble:  # an error of thinking must not end the flight: the supervisor acts
            self._complete(OpenStep(self._number, now, t, own.wind, None), 0.0, named(trouble))
            return None
        if isinstance(asked, PilotDecision):
            self.decision = asked
            self._complete(OpenStep(self._number, now, t, own.wind, None), 0.0, "")
            return None
        self.open = OpenStep(self._number, now, t, own.wind, asked)
        return Think(self._number, self.part.side, self.part.strategy, asked.view)

    def look_ahead(self, now: Instant) -> Think | None:
        """Ask the strategy for the next step, before its position has come."""
        self._number += 1
        t, hovers = self.vehicle.telemetry, self.vehicle.hovers is not False
        return self.ahead.ask(self._number, now.s, t, hovers=hovers, due=self.playing and self.open is None)

    def _complete(self, step: OpenStep, took_s: float, error: str) -> None:
        """Supervise what was decided, and command it. `took_s`: how long the strategy took [s]."""
        now, t = step.begun.s, step.telemetry
        self.failures += bool(error)
        if error and not self._failing:
            self._journal.error("strategy", error)
        if not error:
            self._alive_at = now + took_s
        self._failing = bool(error)
        decision = self.decision
        age, sigma = max(took_s, now - self._alive_at), inf if decision is None else decision.sigma
        seen = self._input(now, t, step.wind, age, sigma)
        wanted = decision.velocity if decision is not None and decision.decides else ZERO
        self.wanted = reachable(wanted, seen, self._thresholds(), self._state)
        self._judge(self.wanted, seen)

    def obey(self, now: float) -> None:
        """Follow at once what the ground has ordered, or what it gives back."""
        if self.vehicle.adapter is None:
            return
        telemetry = self.vehicle.look(now)
        if self._orders.order is Action.PASS:
            if not self.hands.given(now):
                self._latched = (self._state.floor, self._state.floor_cause)
            self.hands.give(now)
            self.part.let_in()
            self.resumed()
            self._judge(ZERO, self._input(now, telemetry), streams=False)
        else:
            self.hands.entered()
            self._state = reordered(self._state)
            self._judge(ZERO, self._input(now, telemetry))

    def withdraw(self, now: float) -> None:
        """What had set off came to nothing: what was in force before is again, and nothing is asked for."""
        self.hands.entered()
        self.part.withdraw()
        self._state = reordered(self._state)._replace(floor=self._latched[0], floor_cause=self._latched[1])
        self.take_off.climbing = False
        if self.vehicle.adapter is not None:
            self.vehicle.adapter.forget(now)

    def leave(self, now: float) -> None:
        """The process ends: leave the vehicle in a mode that the autopilot holds alone, or going home."""
        self.ending, self.open = True, None
        self._judge(ZERO, self._input(now, self.vehicle.look(now)))

    def _input(
        self, now: float, t: Telemetry, wind: Vec = ZERO, age: float = 0.0, sigma: float = 0.0
    ) -> SupervisorInput:
        """What the supervisor looks at; wind, age and error of the track [m] belong to a decision."""
        return SupervisorInput(
            now=now,
            id=self.config.id,
            position=t.position,
            velocity=t.velocity,
            mates=self.bus.mates_at(now) + self.part.obstacles(now),
            telemetry_age=now - t.position_at if t.placed else inf,
            heartbeat_age=now - t.heartbeat_at,
            ground_age=now - self.bus.master_at,
            clock_jump_age=now - self._jumps.jumped_at,
            battery=t.battery,
            ekf_ok=t.ekf_ok or t.ekf_at == NEVER,
            gps_fix=t.gps_fix if t.gps_at != NEVER else 3,
            pilot=self.vehicle.stage is Stage.TAKEN and not self.hands.given(now),
            failsafe=self.vehicle.by_failsafe,
            order=max(self._orders.order, Action.HOLD) if self.ending else self._orders.order,
            wind=wind,
            strategy_age=age,
            track_sigma=sigma,
        )

    @property
    def latched(self) -> str:
        """Why the vehicle is not flown until a person gives control back; '' where nothing is latched."""
        return "" if self._state.floor is Action.PASS else CAUSES[self._state.floor_cause]

    @property
    def unasked(self) -> bool:
        """Whether the vehicle is in the guided mode without this process's leave to fly it."""
        return self.vehicle.stage is Stage.ACTIVE and not self.hands.leave

    def _thresholds(self) -> Policy:
        """The part's, for the kind of vehicle that was found."""
        policy, hovers = self.part.policy, self.vehicle.hovers is not False
        if policy.envelope.hovers == hovers:
            return policy
        return policy._replace(envelope=policy.envelope._replace(hovers=hovers))

    def _judge(
        self, wanted: Vec, seen: SupervisorInput, *, streams: bool = True, enters: bool = True
    ) -> SupervisorOutput:
        """Let the supervisor judge this step, do what it commands, and tell where that is something new.

        Without `streams` a velocity that it lets pass is not sent. With `enters` the guided mode is asked for
        where a velocity may pass and the vehicle is not in it."""
        before = self._state.action
        output = supervise(wanted, seen, self._thresholds(), self._state)
        self._state, self.output = output.state, output
        self._carry_out(seen.now, output, streams=streams, enters=enters)
        told = self.clips.look(seen.now, before, output.action, output.cause)
        if told or (output.changed and output.action > Action.CLIP):
            self._say(output, told)
        return output

    def _carry_out(self, now: float, output: SupervisorOutput, *, streams: bool, enters: bool) -> None:
        """From the supervisor's verdict to what the adapter is asked for."""
        adapter = self.vehicle.adapter
        if adapter is None:
            return
        stage, unasked = adapter.stage, self.unasked
        ours = stage in (Stage.ACTIVE, Stage.ENTERING) and not unasked
        command = output.command
        known = not self.vehicle.unread  # of what its limits are; until then no setpoint leaves
        if command is Command.STREAM:
            if enters and known:
                hands, idle = self.hands, not ours and not unasked
                if idle and ((stage is not Stage.TAKEN and hands.may_control) or hands.given(now)):
                    hands.took = True
                    adapter.enter(now)
                self.hands.entered()
            if streams and known and not unasked:
                self.setpoint = output.ground
        elif command is Command.END_STREAM:
            adapter.end(now)
        elif command in RELEASES:
            # Without an order only what is ours is released, or what is on its way to a milder mode.
            leaving = stage is Stage.LEAVING and command is not Command.RELEASE_TO_HOLD
            if ours or leaving or self._orders.order is not Action.PASS or self.take_off.climbing:
                ends = self.ending and self._orders.order is Action.PASS
                departs = ends and command is Command.RELEASE_TO_HOLD
                adapter.leave(now, ReleaseMode.DEPART if departs else RELEASES[command])
        flown = known and streams and not unasked and (command is Command.STREAM or ours)
        self.drive(now, output if flown else None)

    # ------------------------------------------------------------------ before and after the part

    def _stand_by(self, instant: Instant, t: Telemetry, state: PartState) -> None:
        """Take control when the part is about to begin; what is or becomes ours is judged in each step."""
        adapter, now = self.vehicle.adapter, instant.s
        self.vehicle.facing = None
        if adapter is None:
            return
        held = self._orders.order is not Action.PASS
        unasked = not self.hands.leave  # found in the guided mode, and not this process's yet
        ours = not unasked and adapter.stage in (Stage.ENTERING, Stage.ACTIVE, Stage.LEAVING)
        wanted = not held and not state.over and self._wanted(now, adapter, state)
        climbs = not held and not state.over and self._climbs(t, state)
        if not (held or ours or wanted or climbs):
            self.drive(now)
            return
        before = self._state
        # To its place; else a multicopter hovers, and a plane in its guided mode circles by itself.
        hovers = not adapter.holds_airspeed
        own = own_state(now, t, hovers=hovers)
        seen = self._input(now, t)._replace(over=state.over, wind=own.wind)
        still = ZERO if hovers else by_itself(own, self.part.policy.envelope)
        free = not (climbs or unasked or held)
        lives = adapter.kind is Kind.PX4_PLANE  # in OFFBOARD by its targets alone
        near = adapter.stage is Stage.ACTIVE or (lives and adapter.stage is Stage.ENTERING)
        way = self.part.approach(instant, own) if free and near else None
        if way is not None:
            still, self.vehicle.facing = way.velocity, way.heading
        elif lives:
            still = circling(own, self.part.policy.envelope)
        if climbs and not (held or ours or wanted):  # what keeps it on the ground is no end of a flight
            if supervise(still, seen, self._thresholds(), before).command is Command.STREAM:
                self.take_off.step(now, self.vehicle)
            self.drive(now)
            return
        streams = (hovers or lives or way is not None) and not (climbs or unasked)
        output = self._judge(still, seen, streams=streams, enters=wanted)
        if not (held or ours):  # what was not ours has latched nothing
            self._state = self._state._replace(floor=before.floor, floor_cause=before.floor_cause)
        if climbs and output.command is Command.STREAM and self.take_off.step(now, self.vehicle):
            self.drive(now)

    def _wanted(self, now: float, adapter: Adapter, state: PartState) -> bool:
        """Whether control is to be taken, if the supervisor lets it."""
        idle = adapter.stage in (Stage.IDLE, Stage.LEFT)
        return self.hands.given(now) or (state.engaged and state.near and idle and self.hands.may_control)

    def _climbs(self, t: Telemetry, state: PartState) -> bool:
        """Whether a ground start is this agent's to do, and is not done."""
        return self.config.may_arm and state.engaged and self.hands.may_control and self.take_off.pending(t)

    # ------------------------------------------------------------------ whose hands fly

    def objection(self, now: float, command: messages.Command) -> str:
        """Why a command cannot be obeyed as things stand; "" where it can.

        Control is not given where the supervisor would take it away in the same moment, and for long."""
        why = self.hands.objection(now, command)
        if why or command.kind not in SETS_OFF:
            return why
        free = self._input(now, self.vehicle.telemetry)._replace(pilot=False, order=Action.PASS)
        verdict = supervise(ZERO, free, self._thresholds(), SupervisorState())
        return f"{CAUSES[verdict.cause]}: it would not fly" if verdict.action >= Action.RETURN else ""

    def drive(self, now: float, verdict: SupervisorOutput | None = None) -> None:
        """Let the adapter do what is due, with the verdict on this step or without a setpoint."""
        change = self.vehicle.step(now, verdict)
        self.hold.look(now, self.vehicle, self.part.policy.envelope)
        if change is Control.TAKEN:
            self._taken(now)
        elif change is not Control.SAME:
            if change is Control.HANDED_BACK:
                self.part.let_in()
            self.hands.handed_back()
            self.resumed()

    def resumed(self) -> None:
        """Control is given back to the agent: what the supervisor had latched is over."""
        self._state = SupervisorState() if not self.playing else handed_back(self._state)

    def _taken(self, now: float) -> None:
        t = self.vehicle.telemetry
        fell_back = t.mode == "HOLD" and now - self._silent_at < REGAIN_S
        if fell_back and (self._orders.granted or self.hands.trusted):
            self._journal.warning("regain", f"{t.mode} while the link was silent: asking again")
            self.hands.give(now)
        else:
            self.hands.taken()

    # ------------------------------------------------------------------ inside

    def _say(self, output: SupervisorOutput, told: str) -> None:
        """Tell a verdict that is news, with the level and module whose decision it met."""
        action, decision = output.action, self.decision
        severity = messages.Severity.INFO
        if action > Action.CLIP and output.cause is not Cause.OVER:
            severity = messages.Severity.ERROR if action is Action.END else messages.Severity.WARNING
        level, module = (decision.level, decision.module) if decision is not None else ("", "")
        word = ACTIONS[action]
        text = told or f"{word}: {CAUSES[output.cause]}"
        self._journal.say(severity, f"supervisor_{word}", text, level, module)
