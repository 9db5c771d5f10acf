"""Modes and arming of one autopilot: runs the table of `mode_table` and says what to ask the autopilot for.

A mode is asked for every 80 ms, or at the pace at which this autopilot answers, until the heartbeat reports
it. From the second try on the heartbeat that proves it is asked for at the same pace (it comes by itself only
once a second, and may be lost); after an accepted answer it alone. To leave there is a chain of modes: what
is refused gives way to the next at once, what an autopilot that is heard leaves unanswered for 0.5 s (or
twice its usual time) gives way to the second alone: silence is no reason to land.
Sans I/O, and without any message of MAVLink.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from onboard.autopilot.base import Note, ReleaseMode, Stage, Telemetry
from onboard.autopilot.mode_requests import ModeRequests
from onboard.autopilot.mode_table import ModeAction, ModeEvent, transition
from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.ids import COMPANION, CommandId
from onboard.wire.mavlink.values import CommandAck
from onboard.wire.retry import CommandRetry, RetryPolicy

SOUND = 0.95  # share of frames that arrive on a link whose delays are the autopilot's
MODE_RETRY = RetryPolicy(0.08, patience=25, slow=0.5, after_accepted=1.5, after_refused=1.0)  # [s]
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
        self._may_arm = may_arm
        self._chain: tuple[str, ...] = ()  # the modes to leave into; empty: not leaving, or forgotten
        self._link = 0  # of the chain: which is asked for
        self._asked_at = NEVER  # since when the present mode is asked for on a link that works
        self._requests = ModeRequests()
        self._from = ""  # the mode it was in when the asking began
        self._mode = CommandRetry(MODE_RETRY)
        self._quality = 1.0  # share of the autopilot's frames that arrived lately
        self._arm: CommandRetry | None = None
        self._notes: list[Note] = []
        self._heard = (NEVER, "")  # arrival and mode of the heartbeat last judged
        self._guided_beats = 0  # heartbeats in a row that report the guided mode
        self._reboots = 0
        self._taken_at = NEVER

    def enter(self) -> None:
        """Ask for the guided mode; nothing to do where the vehicle is in it already."""
        self._happened(ModeEvent.ENTER, "")

    def leave(self, mode: ReleaseMode, chain: Sequence[str]) -> None:
        """Ask for the first mode of a chain to leave into; for the next where it is not to be had."""
        again = mode is self.leaving_by and self.stage in (Stage.LEAVING, Stage.LEFT)
        self.leaving_by = mode
        if not again:
            self._chain, self._link = tuple(chain), 0
        self._happened(ModeEvent.LEAVE_AGAIN if again else ModeEvent.LEAVE, "")

    def give_up(self) -> None:
        """Give up control: what flew by this machine's leave has ended."""
        self._happened(ModeEvent.GIVE_UP, "")

    def arm(self) -> bool:
        """Ask for arming until the heartbeat reports it; return whether that is allowed at all."""
        if self._may_arm and self._arm is None:
            self._arm = CommandRetry(ARM_RETRY)
        return self._may_arm

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
            self._happened(self._meaning(now, telemetry.mode), telemetry.mode, now)
        mode, prove = "", False
        silent = now - max(telemetry.heartbeat_at, telemetry.position_at) > UNANSWERED
        if self._asked_at == NEVER or silent:  # without a link there is no time to answer in
            self._asked_at = now
        if known and (self.stage is Stage.LEAVING or (self.stage is Stage.ENTERING and ready)):
            if self._mode.due(now):
                self._give_way(now)
                mode = self._wanted
                self._requests.sent(now, mode)
                prove = self._mode.unanswered  # it may have been obeyed, and heartbeat and answer lost
                if self._mode.impatient:
                    asked = f"{mode} asked for {self._mode.tries} times"
                    self._tell("error", "mode_unconfirmed", f"{asked}, {telemetry.mode} reported: asking on")
            else:
                prove = self._mode.proof_due(now)
        arm_tries = self._arm.tries if known and self._arm is not None and self._arm.due(now) else 0
        notes, self._notes = tuple(self._notes), []
        return ModeStep(notes, mode, self._mode.tries, prove, arm_tries)

    @property
    def _wanted(self) -> str:
        return self._chain[self._link] if self.stage is Stage.LEAVING and self._chain else self.guided

    def _meaning(self, now: float, mode: str) -> ModeEvent:
        """The event that a new heartbeat in `mode` is."""
        self._guided_beats = self._guided_beats + 1 if mode == self.guided else 0
        self._from = self._from or mode
        wanted = mode == self._wanted and self.stage in (Stage.ENTERING, Stage.LEAVING)
        echo = self._requests.echoed(now, mode, wanted=wanted)
        if echo and mode != self.guided and self.stage is Stage.ACTIVE:
            return ModeEvent.ECHO
        if mode == self.guided:
            if echo and self.stage is Stage.LEFT:
                return ModeEvent.ECHO
            return ModeEvent.GUIDED if self._guided_beats == 1 else ModeEvent.GUIDED_AGAIN
        if mode in self._chain[: self._link + 1]:
            return ModeEvent.RELEASED
        if echo and self.stage in (Stage.ENTERING, Stage.LEAVING):
            self._from = mode
        return ModeEvent.UNCHANGED if mode == self._from else ModeEvent.OTHER

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
        if self.stage is not Stage.LEAVING or self._link > 0 or self._mode.answered:
            return
        lands = self._chain[1:2] in ((), ("LAND",))
        if lands or self.leaving_by not in (ReleaseMode.HOLD, ReleaseMode.DEPART):
            return
        patience = max(UNANSWERED, 2.0 * self._requests.round_trip)
        if now - self._asked_at >= patience:
            self._next(self._chain[0], f"not answered for {now - self._asked_at:.1f} s")
            self._mode.due(now)  # this try is the new mode's

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
        was = self._wanted
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
                self._tell("info", "handed_back", f"{mode} chosen by another hand: setpoints count")
            case ModeAction.TELL_RELEASED:
                self._tell("info", "released", f"{mode} confirmed: the autopilot flies alone")
            case ModeAction.TELL_TAKE_OVER:
                self._taken_at = now
                text = f"{mode} in place of {was}, not by this agent: hands off"
                self._tell("warning", "take_over", text)
            case ModeAction.TELL_ECHO:
                self._tell("info", "late_answer", f"{mode} is an earlier request of this agent, obeyed late")
            case ModeAction.TELL_REBOOT:
                self._tell("error", "reboot", "the autopilot has started again: control is given up")

    def _ask(self) -> None:
        self._from = ""
        # A link that loses answers makes the measured round trip grow without cause: no reason to ask slower.
        slow = min(1.0, self._requests.round_trip) if self._quality >= SOUND else 0.0
        pace = max(MODE_RETRY.every, slow)
        self._mode = CommandRetry(MODE_RETRY._replace(every=pace))
        self._asked_at = NEVER
        self._heard = (NEVER, "")  # judge the present mode again in the light of the new wish

    def _tell(self, severity: str, kind: str, text: str) -> None:
        self._notes.append(Note(severity, kind, text))
