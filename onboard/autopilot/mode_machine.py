"""Modes and arming of one autopilot: runs the table of `mode_table` and says what to ask the autopilot for.

A mode is asked for every 80 ms until the heartbeat reports it. From the second try on the heartbeat that
proves it is asked for at the same pace (it comes by itself only once a second, and may be lost); after an
accepted answer it alone. After a refusal a second passes. Sans I/O, and without any message of MAVLink.
"""

from __future__ import annotations

from typing import NamedTuple

from onboard.autopilot.base import Note, ReleaseMode, Stage, Telemetry
from onboard.autopilot.mode_table import ModeAction, ModeEvent, transition
from onboard.core.math.constants import NEVER
from onboard.wire.mavlink.ids import COMPANION, CommandId
from onboard.wire.mavlink.values import CommandAck
from onboard.wire.retry import CommandRetry, RetryPolicy

MODE_RETRY = RetryPolicy(0.08, patience=25, slow=0.5, after_accepted=1.5, after_refused=1.0)  # [s]
ARM_RETRY = MODE_RETRY._replace(after_refused=2.0)  # refused for many seconds although the pre-arm bit is set
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

    def __init__(
        self, system: int, guided: str, release: dict[ReleaseMode, str], *, may_arm: bool = False
    ) -> None:
        self.system = system  # MAVLink system id of the vehicle
        self.guided = guided  # the mode in which setpoints count, in the autopilot's words
        self.stage = Stage.IDLE
        self.leaving_by = ReleaseMode.HOLD  # what was asked for on leaving last
        self._may_arm = may_arm
        self._modes = release
        self._release = ""  # the mode to leave into; "": not leaving, or forgotten
        self._from = ""  # the mode it was in when the asking began
        self._mode = CommandRetry(MODE_RETRY)
        self._arm: CommandRetry | None = None
        self._notes: list[Note] = []
        self._heard = (NEVER, "")  # arrival and mode of the heartbeat last judged
        self._guided_beats = 0  # heartbeats in a row that report the guided mode
        self._reboots = 0
        self._taken_at = NEVER

    def enter(self) -> None:
        """Ask for the guided mode; nothing to do where the vehicle is in it already."""
        self._happened(ModeEvent.ENTER, "")

    def leave(self, mode: ReleaseMode) -> None:
        """Ask for the mode to leave into."""
        again = self._modes[mode] == self._release
        self.leaving_by, self._release = mode, self._modes[mode]
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
            self._answered(now, self._mode, ack.result, "mode_refused", self._wanted)
        if ack.command == CommandId.ARM and self._arm is not None:
            self._answered(now, self._arm, ack.result, "arming_refused", "arming")

    def step(self, now: float, telemetry: Telemetry, *, ready: bool = True) -> ModeStep:
        """Judge what was heard and return what is due. `ready` False holds back the request to enter."""
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
            self._happened(self._meaning(telemetry.mode), telemetry.mode, now)
        mode, prove = "", False
        if known and (self.stage is Stage.LEAVING or (self.stage is Stage.ENTERING and ready)):
            if self._mode.due(now):
                mode = self._wanted
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
        return self._release if self.stage is Stage.LEAVING else self.guided

    def _meaning(self, mode: str) -> ModeEvent:
        """The event that a new heartbeat in `mode` is."""
        self._guided_beats = self._guided_beats + 1 if mode == self.guided else 0
        self._from = self._from or mode
        if mode == self.guided:
            return ModeEvent.GUIDED if self._guided_beats == 1 else ModeEvent.GUIDED_AGAIN
        if mode == self._release:
            return ModeEvent.RELEASED
        return ModeEvent.UNCHANGED if mode == self._from else ModeEvent.OTHER

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
                self._release = ""
                self._ask()
            case ModeAction.ASK_RELEASE:
                self._ask()
            case ModeAction.FORGET:
                self._release = ""
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
            case ModeAction.TELL_REBOOT:
                self._tell("error", "reboot", "the autopilot has started again: control is given up")

    def _ask(self) -> None:
        self._from = ""
        self._mode = CommandRetry(MODE_RETRY)
        self._heard = (NEVER, "")  # judge the present mode again in the light of the new wish

    def _tell(self, severity: str, kind: str, text: str) -> None:
        self._notes.append(Note(severity, kind, text))
