"""Modes and arming of one autopilot: runs the table of `mode_table` and says what to ask the autopilot for.

A mode is asked for until the heartbeat reports it: again when the request before counts as lost, which it
does after 1.5 times the measured round trip, 80 ms at least; where a sound link brings no answer the wait
doubles with each try. From the second try on the heartbeat that proves it is asked for at the same pace (it
comes by itself only once a second, and may be lost); after an accepted answer it alone. To leave there is a
chain of modes: what is refused gives way to the next at once, what an autopilot that is heard leaves
unanswered for 0.5 s (or twice its usual time) gives way to the second alone: silence is no reason to land.
Sans I/O, and without any message of MAVLink.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from onboard.autopilot.base import Note, ReleaseMode, Stage, Telemetry
from onboard.autopilot.mode_requests import LATE, ModeRequests
from onboard.autopilot.mode_table import ModeAction, ModeEvent, transition
from onboard.autopilot.pilot_hands import PilotHands, flown_by_hand
from onboard.core.math.constants import NEVER
from onboard.core.math.each import new
from onboard.wire.mavlink.ids import COMPANION, CommandId
from onboard.wire.mavlink.values import CommandAck
from onboard.wire.retry import CommandRetry, RetryPolicy

CRITICAL = 5  # MAV_STATE of a vehicle in a failsafe, and of worse
SILENT_S = 1.0  # a link silent for longer, or an agent that did not run, explains a failsafe …
SILENCE_S = 8.0  # … for so long afterwards: the slowest (ArduPilot's) acts after 5 s
UNCONFIRMED_S = 2.0  # after which a mode that is not confirmed is an error
SOUND = 0.95  # share of frames that arrive on a link whose delays are the autopilot's
MODE_RETRY = RetryPolicy(0.08, patience=25, slow=1.0, after_accepted=1.5, after_refused=1.0)  # [s]
ARM_RETRY = MODE_RETRY._replace(after_refused=2.0)  # refused for many seconds although the pre-arm bit is set
UNANSWERED = 0.5  # [s] at least, after which the next mode of a chain is asked for
RESTART = 3.0  # [s] between the first mode and the first clock of an autopilot that started again
ACCEPTED, IN_PROGRESS = 0, 5  # MAV_RESULT
RESULTS = {1: "temporarily rejected", 2: "denied", 3: "unsupported", 4: "failed"}


class ModeStep(NamedTuple):
    """What is to be asked of the autopilot now, and what a person should know."""

    notes: tuple[Note, ...] = ()
    mode: str = ""  # the mode to ask for, in the autopilot's words; "": none
    mode_tries: int = 0  # how often that mode was asked for, this time included
    prove: bool = False  # whether to ask for a heartbeat, which proves the mode
    arm_tries: int = 0  # how often arming was asked for, this time included; 0: do not ask


class ModeMachine:
    """Who flies one autopilot. Instants are local monotonic seconds."""

    def __init__(self, system: int, guided: str, *, may_arm: bool = False) -> None:
        self.system = system  # MAVLink system id of the vehicle
        self.guided = guided  # the mode in which setpoints count, in the autopilot's words
        self.stage = Stage.IDLE
        self.leaving_by = ReleaseMode.HOLD  # what was asked for on leaving last
        self.handed = False  # the guided mode was chosen by the pilot's switch
        self.failsafe = False  # TAKEN: by the autopilot's own failsafe, not by a person
        self.hands = PilotHands()
        self._may_arm = may_arm
        self._chain: tuple[str, ...] = ()  # the modes to leave into; empty: not leaving, or forgotten
        self._link = 0  # of the chain: which is asked for
        self._asked_at = NEVER  # since when the present mode is asked for without silence on the link
        self._first_asked = NEVER  # when the present mode, or the first of its chain, was asked for
        self._complained = False
        self._deaf = False  # nothing was heard lately
        self._requests = ModeRequests()
        self._from = ""  # the mode it was in when the asking began
        self._mode = CommandRetry(MODE_RETRY)
        self._quality = 1.0  # share of the autopilot's frames that arrived lately
        self._arm: CommandRetry | None = None
        self._notes: list[Note] = []
        self._heard = (NEVER, "")  # arrival and mode of the heartbeat last judged
        self._guided_beats = 0  # heartbeats in a row that report the guided mode
        self._guided_at = NEVER  # of the first of them
        self._crossed = False  # they began with an older request of ours, obeyed after another hand's choice
        self._foreign_told = False
        self._elsewhere = False  # another mode than the guided one was heard once
        self._left_in = ""  # LEFT: the mode that was confirmed
        self._mode_heard = ""
        self._silent_at = self._stepped_at = NEVER
        self._since = NEVER  # of the stage
        self._entered_from = Stage.IDLE  # the stage in which the guided mode was asked for
        self._reboots = 0
        self._taken_at = NEVER

    def enter(self) -> None:
        """Ask for the guided mode; nothing to do where the vehicle is in it already."""
        if self.stage is not Stage.ENTERING:
            self._entered_from = self.stage
        self._happened(ModeEvent.ENTER, "")

    def leave(self, mode: ReleaseMode, chain: Sequence[str]) -> None:
        """Ask for the first mode of a chain to leave into; for the next where it is not to be had."""
        again = mode is self.leaving_by and self.stage in (Stage.LEAVING, Stage.LEFT)
        self.leaving_by = mode
        if not again:
            self._chain, self._link = tuple(chain), 0
        self._happened(ModeEvent.LEAVE_AGAIN if again else ModeEvent.LEAVE, "")

    def choose_among(self, chain: Sequence[str]) -> None:
        """Leave into another chain of modes than the one at hand: more is known now."""
        if self.stage is Stage.LEAVING and tuple(chain) != self._chain:
            self._chain, self._link = tuple(chain), 0
            self._ask()

    def give_up(self) -> None:
        """Give up control, and the wish for it; nothing to do where it is left or taken."""
        taken = self.stage is Stage.ENTERING and self._entered_from is Stage.TAKEN
        self._happened(ModeEvent.GIVE_BACK if taken else ModeEvent.GIVE_UP, "")

    def arm(self) -> bool:
        """Ask for arming until the heartbeat reports it; return whether that is allowed at all."""
        if self._may_arm and self._arm is None:
            self._arm = CommandRetry(ARM_RETRY)
        return self._may_arm

    def answers_in(self, took: float) -> None:
        """Hear how long this autopilot took to answer another command [s]; lost answers tell nothing."""
        if self._quality >= SOUND:
            self._requests.learn(took)

    def acknowledge(self, now: float, ack: CommandAck) -> None:
        """Hear the answer to a command, if it is to this agent's."""
        if ack.target_system not in (0, self.system) or ack.target_component not in (0, COMPANION):
            return
        asking = self.stage in (Stage.ENTERING, Stage.LEAVING)
        if ack.command == CommandId.SET_MODE and asking:
            self._mode_answered(now, ack.result)
        elif ack.command == CommandId.SET_MODE:
            self._requests.answered(now, accepted=ack.result in (ACCEPTED, IN_PROGRESS))
        if ack.command == CommandId.ARM and self._arm is not None:
            self._answered(now, self._arm, ack.result, "arming_refused", "arming")

    def step(self, now: float, telemetry: Telemetry, *, ready: bool = True) -> ModeStep:
        """Judge what was heard and return what is due. `ready` False holds back the request to enter."""
        self._quality = telemetry.link_quality
        self.hands.take(telemetry)
        self._listen(now, telemetry)
        if telemetry.reboots != self._reboots:
            self._reboots = telemetry.reboots
            soon = now - self._taken_at < RESTART  # its new mode may have been heard before its new clock
            self._happened(ModeEvent.REBOOT_AFTER_TAKING if soon else ModeEvent.REBOOT, telemetry.mode, now)
        known = telemetry.heartbeat_at != NEVER
        heard = (telemetry.heartbeat_at, telemetry.mode)
        if known and heard != self._heard:
            self._heard = heard
            if self._arm is not None and telemetry.armed:
                self._arm = None
                self._tell("info", "armed", "the autopilot reports armed")
            event = self._meaning(now, telemetry)
            if telemetry.mode != self._mode_heard or self.stage is not Stage.TAKEN:  # who took it stays known
                self.failsafe = self._by_failsafe(now, telemetry)
            self._mode_heard = telemetry.mode
            self._happened(event, telemetry.mode, now)
            if event is ModeEvent.RELEASED and self.stage is Stage.LEFT:
                self._left_in = telemetry.mode
        passing = self.stage in (Stage.ENTERING, Stage.LEAVING, Stage.LEFT)
        if passing and flown_by_hand(telemetry) and self.hands.at > self._since:
            self._happened(ModeEvent.OTHER, telemetry.mode, now)  # a pilot's hand is on it
        mode, prove = "", False
        silent = now - max(telemetry.heartbeat_at, telemetry.position_at) > UNANSWERED
        if silent:  # without a link there is no time to answer in
            self._asked_at = self._first_asked = NEVER
            self._deaf = True
        elif self._deaf:
            self._deaf = False
            self._mode = self._retry()  # at once, and quickly
        if known and (self.stage is Stage.LEAVING or (self.stage is Stage.ENTERING and ready)):
            self._give_way(now)
            if self._mode.due(now):
                mode = self._wanted
                self._requests.sent(now, mode)
                self._asked_at = now if self._asked_at == NEVER else self._asked_at
                self._first_asked = now if self._first_asked == NEVER else self._first_asked
                prove = self._mode.unanswered  # it may have been obeyed, and heartbeat and answer lost
            else:
                prove = self._mode.proof_due(now)
            self._complain(now, telemetry.mode)
        arm_tries = self._arm.tries if known and self._arm is not None and self._arm.due(now) else 0
        notes, self._notes = tuple(self._notes), []
        return new(ModeStep, (notes, mode, self._mode.tries, prove, arm_tries))

    @property
    def _wanted(self) -> str:
        return self._chain[self._link] if self.stage is Stage.LEAVING and self._chain else self.guided

    def _listen(self, now: float, telemetry: Telemetry) -> None:
        """Notice a link that was silent, or an agent that did not run: the autopilot's failsafes may act."""
        heard_at = max(telemetry.heartbeat_at, telemetry.position_at)
        stood = self._stepped_at != NEVER and now - self._stepped_at > SILENT_S
        if stood or (telemetry.heartbeat_at != NEVER and now - heard_at > SILENT_S):
            self._silent_at = now
        self._stepped_at = now

    def _by_failsafe(self, now: float, telemetry: Telemetry) -> bool:
        """Whether a mode that is not ours is the autopilot's own doing: it says so, or our silence was."""
        if telemetry.mode == self.guided or telemetry.status >= CRITICAL:
            return telemetry.mode != self.guided
        silence = self._silent_at != NEVER and now - self._silent_at <= SILENCE_S
        return silence and not flown_by_hand(telemetry) and not self.hands.turned(now, now)

    def _complain(self, now: float, reported: str) -> None:
        """Say once that a mode that is asked for is not reported."""
        asked_long = self._first_asked != NEVER and now - self._first_asked >= UNCONFIRMED_S
        if asked_long and not (self._complained or self._mode.declined):
            self._complained = True
            asked = f"{self._wanted} asked for {self._mode.tries} times"
            self._tell("error", "mode_unconfirmed", f"{asked}, {reported} reported: asking on")

    def _meaning(self, now: float, telemetry: Telemetry) -> ModeEvent:
        """The event that a new heartbeat is."""
        mode = telemetry.mode
        self._guided_beats = self._guided_beats + 1 if mode == self.guided else 0
        if self._guided_beats == 1:
            self._guided_at, self._crossed, self._foreign_told = now, False, False
        self._from = self._from or mode
        wanted = mode == self._wanted and self.stage in (Stage.ENTERING, Stage.LEAVING)
        echo = self._requests.echoed(now, mode, wanted=wanted)
        if echo and mode != self.guided and self.stage is Stage.ACTIVE:
            return ModeEvent.ECHO
        if mode == self.guided:
            return self._guided_heard(now, echo=echo)
        self._elsewhere, self.handed = True, False
        if self.stage is Stage.LEFT and mode != self._left_in and not echo:
            return ModeEvent.OTHER if telemetry.armed else ModeEvent.UNCHANGED  # on the ground it is nobody's
        if mode in self._chain[: self._link + 1]:
            return ModeEvent.RELEASED
        if echo and self.stage in (Stage.ENTERING, Stage.LEAVING):
            self._from = mode
        return ModeEvent.UNCHANGED if mode == self._from else ModeEvent.OTHER

    def _guided_heard(self, now: float, *, echo: bool) -> ModeEvent:
        """What the guided mode means: whose it is depends on who asked for it."""
        if echo and self.stage in (Stage.IDLE, Stage.LEFT, Stage.TAKEN):
            self._crossed = self._foreign_told = True
            return ModeEvent.ECHO
        if self.stage is Stage.IDLE and not self._elsewhere:
            return ModeEvent.FOUND
        if self._guided_beats == 1 or self.stage in (Stage.ENTERING, Stage.ACTIVE, Stage.LEAVING):
            return ModeEvent.GUIDED if self._guided_beats == 1 else ModeEvent.GUIDED_AGAIN
        if not self._crossed and self.hands.turned(now, self._guided_at):
            self.handed = True
            return ModeEvent.GUIDED_AGAIN
        return ModeEvent.FOREIGN

    def _mode_answered(self, now: float, result: int) -> None:
        """An answer to a request for a mode: the oldest that is open, which need not be the present wish."""
        accepted = result in (ACCEPTED, IN_PROGRESS)
        mode = self._requests.answered(now, accepted=accepted)
        if mode and mode != self._wanted:
            return
        wanted = self._wanted
        self._answered(now, self._mode, result, "mode_refused", wanted)
        if not accepted and self.stage is Stage.LEAVING and len(self._chain) > 1:
            self._next(wanted, "refused")

    def _give_way(self, now: float) -> None:
        """Go on in the chain where an autopilot that is heard has not answered."""
        open_ = self._asked_at != NEVER and not self._mode.answered
        if self.stage is not Stage.LEAVING or self._link > 0 or not open_:
            return
        lands = self._chain[1:2] in ((), ("LAND",))
        if lands or self.leaving_by not in (ReleaseMode.HOLD, ReleaseMode.DEPART):
            return
        patience = max(UNANSWERED, 2.0 * self._requests.round_trip)
        if now - self._asked_at >= patience:
            self._next(self._chain[0], f"not answered for {now - self._asked_at:.1f} s")

    def _next(self, mode: str, why: str) -> None:
        """Ask for the next mode of the chain; after the last one for the first again, a second later."""
        again = self._link + 1 >= len(self._chain)
        self._link = 0 if again else self._link + 1
        if not again:
            self._tell("warning", "mode_chain", f"{mode} {why}: {self._chain[self._link]} in its place")
            self._ask()

    def _answered(self, now: float, retry: CommandRetry, result: int, kind: str, what: str) -> None:
        if result in (ACCEPTED, IN_PROGRESS):
            retry.accepted(now)
        elif retry.refused(now, result):
            self._tell("warning", kind, f"{what} {RESULTS.get(result, f'result {result}')}")

    def _happened(self, event: ModeEvent, mode: str, now: float = NEVER) -> None:
        """Run the table's row; `mode` is the one reported, `now` the instant where the event has one."""
        step = transition(self.stage, event)
        was = self._left_in if self.stage is Stage.LEFT else self._wanted
        if step.to is not self.stage:
            self._since = self._stepped_at
        self.stage = step.to
        for action in step.actions:
            self._do(action, mode, was, now)

    def _do(self, action: ModeAction, mode: str, was: str, now: float) -> None:
        match action:
            case ModeAction.ASK_GUIDED:
                self._chain = ()
                self._ask()
            case ModeAction.ASK_RELEASE:
                self._ask()
            case ModeAction.FORGET:
                self._chain = ()
            case ModeAction.STOP_ARMING:
                self._arm = None
            case ModeAction.TELL_CONTROL:
                self._tell("info", "control", f"{mode} confirmed: this agent flies")
            case ModeAction.TELL_FOUND:
                self._tell("info", "control", f"found in {mode}: setpoints count")
            case ModeAction.TELL_HANDED_BACK:
                self._tell("info", "handed_back", f"{mode} chosen by the pilot's switch: setpoints count")
            case ModeAction.TELL_FOREIGN:
                if not self._foreign_told:
                    self._foreign_told = True
                    text = f"{mode}, chosen neither by this agent nor by the pilot's switch: not flown in it"
                    self._tell("warning", "foreign_guided", text)
            case ModeAction.TELL_CROSSED:
                text = f"{mode}, by an older request of this agent: choose the other mode again; hands off"
                self._tell("error", "late_answer", text)
            case ModeAction.TELL_RELEASED:
                self._tell("info", "released", f"{mode} confirmed: the autopilot flies alone")
            case ModeAction.TELL_TAKE_OVER:
                self._taken_at = now
                whose = "by the autopilot's own failsafe" if self.failsafe else "not by this agent"
                kind = "failsafe" if self.failsafe else "take_over"
                self._tell("warning", kind, f"{mode} in place of {was}, {whose}: hands off")
            case ModeAction.TELL_ECHO:
                self._tell("info", "late_answer", f"{mode} is an earlier request of this agent, obeyed late")
            case ModeAction.TELL_REBOOT:
                self._tell("error", "reboot", "the autopilot has started again: control is given up")

    def _ask(self) -> None:
        self._from = ""
        self._mode = self._retry()
        self._complained, self._first_asked = False, NEVER
        self._asked_at = NEVER
        self._heard = (NEVER, "")  # judge the present mode again in the light of the new wish

    def _retry(self) -> CommandRetry:
        """When to ask again: never while the request before may still be on its way."""
        # A link that loses answers makes the measured round trip grow without cause: no reason to ask slower.
        sound = self._quality >= SOUND
        pace = max(MODE_RETRY.every, min(LATE, 1.5 * self._requests.round_trip) if sound else 0.0)
        growth = 2.0 if sound else 1.0
        return CommandRetry(MODE_RETRY._replace(every=pace, slow=max(1.0, pace), growth=growth))

    def _tell(self, severity: str, kind: str, text: str) -> None:
        self._notes.append(Note(severity, kind, text))
