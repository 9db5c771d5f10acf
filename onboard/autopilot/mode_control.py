"""Who flies: the state machine of modes that all adapters share.

    IDLE ──enter──▶ ENTERING ──heartbeat says guided──▶ ACTIVE ──leave──▶ LEAVING ──heartbeat──▶ LEFT
                       └────────── another mode than asked for: TAKEN ─────────┘

A command is repeated at most every 80 ms until the heartbeat reports the mode: at 20 % loss each way seven
tries leave 0.08 % unconfirmed. From the second try on the heartbeat that proves it is asked for at the same
pace (it comes by itself only once a second, and may be lost); after an accepted answer it alone. After a
refusal a second passes. From IDLE, LEFT and TAKEN the pilot hands (back) by choosing the guided mode himself.
"""

from __future__ import annotations

from onboard.autopilot.base import Note, ReleaseMode, Stage, Telemetry
from onboard.core.math.constants import NEVER
from onboard.wire.mavlink import commands
from onboard.wire.mavlink.commands import Outgoing, Target
from onboard.wire.mavlink.ids import COMPANION, CommandId, MessageId
from onboard.wire.mavlink.modes import MODES, Kind
from onboard.wire.mavlink.values import CommandAck

RETRY = 0.08  # [s] between two tries
PATIENCE = 25  # tries at that pace, then a warning and
SLOW_RETRY = 0.5  # [s] this pace
AFTER_YES = 1.5  # [s] an accepted command is not repeated for so long: the heartbeat is asked for
AFTER_NO = 1.0  # [s] a refused one waits before it is tried again
ARM_AFTER_NO = 2.0  # [s] arming may be refused for many seconds although the pre-arm bit is set
RESTART = 3.0  # [s] between the first mode and the first clock of an autopilot that started again
RESULTS = {0: "accepted", 1: "temporarily rejected", 2: "denied", 3: "unsupported", 4: "failed"}


class Pacer:
    """When a command may be sent (again)."""

    def __init__(self) -> None:
        self.tries = 0
        self._next = NEVER
        self._refused = -1
        self._proof_at = NEVER  # when to ask for the proof of an accepted command
        self._proofs = 0

    @property
    def unanswered(self) -> bool:
        """Tried more than once, and never answered."""
        return self.tries > 1 and self._refused < 0 and self._proof_at == NEVER

    def proof_due(self, now: float) -> bool:
        """Whether to ask now for the proof of what was accepted; counts it."""
        if self._proof_at == NEVER or now < self._proof_at or self._proofs >= PATIENCE:
            return False
        self._proofs += 1
        self._proof_at = now + RETRY
        return True

    def due(self, now: float) -> bool:
        """Whether to send now; counts it."""
        if now < self._next:
            return False
        self.tries += 1
        self._next = now + (RETRY if self.tries < PATIENCE else SLOW_RETRY)
        return True

    def answered(self, now: float, result: int, after_no: float) -> bool:
        """Wait as the answer asks; True for a refusal not yet reported."""
        if result in (0, 5):
            self._next = now + AFTER_YES
            if self._proof_at == NEVER:
                self._proof_at = now
            return False
        self._next = now + after_no
        new = result != self._refused
        self._refused = result
        return new


class Control:
    """Modes and arming of one autopilot."""

    def __init__(
        self, kind: Kind, to: Target, guided: str, ways: dict[ReleaseMode, str], *, may_arm: bool = False
    ) -> None:
        self.kind = kind
        self.to = to
        self.guided = guided
        self.stage = Stage.IDLE
        self.may_arm = may_arm
        self._ways = ways
        self._wanted = ""
        self._from = ""  # the mode it was in when the asking began
        self._mode = Pacer()
        self._arm: Pacer | None = None
        self._notes: list[Note] = []
        self._heard = (NEVER, "")  # arrival and mode of the heartbeat last judged
        self._guided_beats = 0  # heartbeats in a row that report the guided mode
        self._reboots = 0
        self._taken_at = NEVER

    def enter(self, now: float) -> None:
        """Ask for the guided mode; nothing to do where it is ours already."""
        if self.stage not in (Stage.ACTIVE, Stage.ENTERING):
            self._ask(Stage.ENTERING, self.guided)

    def leave(self, now: float, way: ReleaseMode) -> None:
        """Ask for the mode of `way`."""
        wanted = self._ways[way]
        if self.stage not in (Stage.LEAVING, Stage.LEFT) or self._wanted != wanted:
            self._ask(Stage.LEAVING, wanted)

    def release(self) -> None:
        """Hands off: ask for nothing any more."""
        self.stage = Stage.IDLE
        self._wanted = ""
        self._arm = None

    def arm(self) -> bool:
        """Ask for arming, if that is allowed at all."""
        if self.may_arm and self._arm is None:
            self._arm = Pacer()
        return self.may_arm

    def acknowledge(self, now: float, ack: CommandAck) -> None:
        """Hear an answer, if it is to us."""
        if ack.target_system not in (0, self.to.system) or ack.target_component not in (0, COMPANION):
            return
        why = RESULTS.get(ack.result, f"result {ack.result}")
        asking = self.stage in (Stage.ENTERING, Stage.LEAVING)
        if ack.command == CommandId.SET_MODE and asking and self._mode.answered(now, ack.result, AFTER_NO):
            self._notes.append(Note("warning", "mode_refused", f"{self._wanted} {why}"))
        arming = self._arm if ack.command == CommandId.ARM else None
        if arming is not None and arming.answered(now, ack.result, ARM_AFTER_NO):
            self._notes.append(Note("warning", "arming_refused", f"arming {why}"))

    def step(
        self, now: float, telemetry: Telemetry, *, ready: bool = True
    ) -> tuple[list[Outgoing], list[Note]]:
        """Commands due now, and what changed. `ready` False holds the request for the guided mode back."""
        messages: list[Outgoing] = []
        if telemetry.reboots != self._reboots:
            self._restarted(now, telemetry)
        heard = (telemetry.heartbeat_at, telemetry.mode)
        known = telemetry.heartbeat_at != NEVER
        if known and heard != self._heard:
            self._heard = heard
            self._judge(now, telemetry)
        asking = self.stage is Stage.LEAVING or (self.stage is Stage.ENTERING and ready)
        if asking and known and self._mode.due(now):
            number = MODES[self.kind][self._wanted]
            px4 = self.kind is Kind.PX4_MULTICOPTER
            messages.append(commands.set_mode(self.to, number, px4=px4))
            if self._mode.unanswered:  # it may have been obeyed, and heartbeat and answer lost
                messages.append(commands.request_message(self.to, MessageId.HEARTBEAT))
            if self._mode.tries == PATIENCE:
                text = f"{self._wanted} asked for {PATIENCE} times, {telemetry.mode} reported: asking on"
                self._notes.append(Note("error", "mode_unconfirmed", text))
        elif asking and known and self._mode.proof_due(now):
            messages.append(commands.request_message(self.to, MessageId.HEARTBEAT))
        if self._arm is not None and known and self._arm.due(now):
            messages.append(commands.arm(self.to))
        notes, self._notes = self._notes, []
        return messages, notes

    def _ask(self, stage: Stage, wanted: str) -> None:
        self.stage = stage
        self._wanted = wanted
        self._from = ""
        self._mode = Pacer()
        self._heard = (NEVER, "")  # judge the present mode again in the light of the new wish

    def _restarted(self, now: float, telemetry: Telemetry) -> None:
        """The autopilot started again: that ended our control, and no pilot did (its new mode may have been
        heard before its new clock)."""
        self._reboots = telemetry.reboots
        if self.stage is Stage.ACTIVE or (self.stage is Stage.TAKEN and now - self._taken_at < RESTART):
            self._wanted = ""
            self._now(Stage.IDLE, "error", "reboot", "the autopilot has started again: control is given up")

    def _judge(self, now: float, telemetry: Telemetry) -> None:
        """One new heartbeat: what does its mode mean?"""
        mode, stage = telemetry.mode, self.stage
        self._guided_beats = self._guided_beats + 1 if mode == self.guided else 0
        if self._arm is not None and telemetry.armed:
            self._arm = None
            self._notes.append(Note("info", "armed", "the autopilot reports armed"))
        self._from = self._from or mode
        if stage is Stage.ENTERING:
            if mode == self.guided:
                self._now(Stage.ACTIVE, "info", "control", f"{mode} confirmed: this agent flies")
            elif mode != self._from:
                self._taken(now, mode)
        elif stage is Stage.ACTIVE and mode != self.guided:
            self._taken(now, mode)
        elif stage is Stage.LEAVING:
            if mode == self._wanted:
                self._now(Stage.LEFT, "info", "released", f"{mode} confirmed: the autopilot flies alone")
            elif mode not in (self._from, self.guided):
                self._taken(now, mode)
        elif stage is Stage.IDLE and mode == self.guided:
            self._now(Stage.ACTIVE, "info", "control", f"found in {mode}: setpoints count")
        elif stage in (Stage.LEFT, Stage.TAKEN) and self._guided_beats >= 2:
            self._now(Stage.ACTIVE, "info", "handed_back", f"{mode} chosen by another hand: setpoints count")

    def _taken(self, now: float, mode: str) -> None:
        was = self._wanted if self.stage is Stage.LEAVING else self.guided
        text = f"{mode} in place of {was}, not by this agent: hands off"
        self._taken_at = now
        self._now(Stage.TAKEN, "warning", "take_over", text)
        self._arm = None

    def _now(self, stage: Stage, severity: str, kind: str, text: str) -> None:
        self.stage = stage
        self._notes.append(Note(severity, kind, text))
