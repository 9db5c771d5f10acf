"""The table of modes, walked whole: what may lead where, that the machine runs it, and that it is drawn."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise, product
from pathlib import Path

import pytest

from onboard.autopilot.base import ReleaseMode, Stage, Telemetry
from onboard.autopilot.mode_machine import ModeMachine
from onboard.autopilot.mode_table import TABLE, ModeAction, ModeEvent, drawn_into, main, transition
from onboard.wire.mavlink.modes import Kind
from onboard.wire.mavlink.values import CommandAck
from tests.support.paths import ROOT

PAIRS = list(product(Stage, ModeEvent))
GUIDED_HEARD = {ModeEvent.GUIDED, ModeEvent.GUIDED_AGAIN, ModeEvent.FOUND}
LEAVING = {ModeEvent.LEAVE, ModeEvent.LEAVE_AGAIN}
REBOOTED = {ModeEvent.REBOOT, ModeEvent.REBOOT_AFTER_TAKING}
CHAINS = {ReleaseMode.HOLD: ("LOITER", "RTL", "LAND"), ReleaseMode.RETURN: ("RTL", "LAND")}


@pytest.mark.parametrize(("stage", "event"), PAIRS, ids=lambda one: one.name)
def test_no_row_breaks_a_rule_of_flight(stage: Stage, event: ModeEvent) -> None:
    to, actions = transition(stage, event)
    if event in LEAVING:  # leaving is always allowed
        assert to is Stage.LEAVING or (event is ModeEvent.LEAVE_AGAIN and to is stage is Stage.LEFT)
    if event is ModeEvent.ENTER:
        assert to in (Stage.ENTERING, Stage.ACTIVE)
    if event is ModeEvent.ECHO:  # an old request of our own changes no hands
        assert to is not Stage.TAKEN or stage is Stage.TAKEN
    if event is ModeEvent.FOREIGN and stage is Stage.ACTIVE:
        assert (stage, event) not in TABLE
        return
    if to is Stage.ACTIVE and stage is not Stage.ACTIVE:  # setpoints count only where the heartbeat says so
        assert event in GUIDED_HEARD
    if stage in (Stage.LEFT, Stage.TAKEN) and to is Stage.ACTIVE:  # one heartbeat may be an old one, late
        assert event is ModeEvent.GUIDED_AGAIN
    if stage is Stage.TAKEN and to is not Stage.TAKEN:  # hands off means hands off
        assert event in {ModeEvent.ENTER, ModeEvent.GUIDED_AGAIN, *LEAVING, ModeEvent.REBOOT_AFTER_TAKING}
    if event is ModeEvent.FOREIGN:  # what another station or companion chose is never flown
        assert to is not Stage.ACTIVE
        assert ModeAction.ASK_GUIDED not in actions
    if to is Stage.LEFT and stage is not Stage.LEFT:
        assert event is ModeEvent.RELEASED
    if to is Stage.TAKEN and stage is not Stage.TAKEN:
        others = {ModeEvent.RELEASED, ModeEvent.UNCHANGED, ModeEvent.OTHER, ModeEvent.FOREIGN}
        assert event in others | {ModeEvent.GIVE_BACK}
        assert ModeAction.STOP_ARMING in actions
    if stage is Stage.ACTIVE:  # whatever ends control is heard; the last two never are
        mine = GUIDED_HEARD | {ModeEvent.ENTER, ModeEvent.FOREIGN, ModeEvent.GIVE_BACK}
        assert (to is Stage.ACTIVE) == (event in mine)
    asks = event is ModeEvent.ENTER and stage not in (Stage.ENTERING, Stage.ACTIVE)
    asks |= event is ModeEvent.ECHO and stage is Stage.ACTIVE  # what undid it was an old wish of our own
    assert (ModeAction.ASK_GUIDED in actions) == asks
    if to is not stage:  # a person hears of each change that nobody on board asked for
        told = any(action.name.startswith("TELL") for action in actions)
        assert told or event in {ModeEvent.ENTER, ModeEvent.GIVE_UP, ModeEvent.GIVE_BACK, *LEAVING}
    if to is stage and (stage, event) not in TABLE:
        assert actions == ()


def test_every_stage_can_be_reached_and_left() -> None:
    reached, before = {Stage.IDLE}, set()
    while reached != before:
        before = set(reached)
        reached |= {transition(stage, event).to for stage in before for event in ModeEvent}
    assert reached == set(Stage)
    for stage in Stage:
        assert any(transition(stage, event).to is not stage for event in ModeEvent)


class Flight:
    """A machine and the heartbeats that it hears, one a second; time moves with them."""

    def __init__(self) -> None:
        self.machine = ModeMachine(1, "GUIDED")
        self.now = 100.0
        self.reboots = 0
        self.switch = 1000
        self.kinds: list[str] = []

    def beat(self, mode: str, status: int = 4, *, turned: bool = False, armed: bool = True) -> None:
        """A heartbeat a second later; `turned`: the pilot's mode switch has moved meanwhile."""
        self.now += 1.0
        self.switch = 3000 - self.switch if turned else self.switch
        channels = (1500, 1500, 1500, 1500, self.switch)
        telemetry = Telemetry(
            mode=mode, heartbeat_at=self.now, reboots=self.reboots, armed=armed, status=status,
            channels=channels, channels_at=self.now,
        )  # fmt: skip
        self.kinds += [note.kind for note in self.machine.step(self.now, telemetry).notes]

    def enter(self) -> None:
        self.machine.enter()

    def leave(self) -> None:
        self.machine.leave(ReleaseMode.HOLD, CHAINS[ReleaseMode.HOLD])


def idle(f: Flight) -> None:
    f.beat("AUTO")


def entering(f: Flight) -> None:
    f.beat("AUTO")
    f.enter()
    f.beat("AUTO")


def active(f: Flight) -> None:
    entering(f)
    f.beat("GUIDED")


def leaving(f: Flight) -> None:
    active(f)
    f.leave()
    f.beat("GUIDED")


def left(f: Flight) -> None:
    leaving(f)
    f.beat("LOITER")


def taken(f: Flight) -> None:
    left(f)
    f.enter()
    f.beat("GUIDED")
    f.beat("FBWA")


def asked_back(f: Flight) -> None:
    taken(f)
    f.enter()


def again(f: Flight, *, turned: bool) -> None:
    f.beat("GUIDED", turned=turned)
    f.beat("GUIDED")


def reboot(f: Flight) -> None:
    f.reboots += 1
    f.beat("STABILIZE")


def late_reboot(f: Flight) -> None:
    f.now += 10.0
    reboot(f)


# How a stage is come into, and what then happens: (way there, what happens, the row that it must run).
STORIES: list[tuple[Callable[[Flight], None], Callable[[Flight], None], Stage, ModeEvent]] = [
    (idle, lambda f: f.enter(), Stage.IDLE, ModeEvent.ENTER),
    (idle, lambda f: f.leave(), Stage.IDLE, ModeEvent.LEAVE),
    (lambda f: None, lambda f: f.beat("GUIDED"), Stage.IDLE, ModeEvent.FOUND),
    (idle, lambda f: f.beat("GUIDED"), Stage.IDLE, ModeEvent.GUIDED),
    (idle, lambda f: again(f, turned=True), Stage.IDLE, ModeEvent.GUIDED_AGAIN),
    (idle, lambda f: again(f, turned=False), Stage.IDLE, ModeEvent.FOREIGN),
    (idle, lambda f: f.beat("RTL"), Stage.IDLE, ModeEvent.OTHER),
    (idle, late_reboot, Stage.IDLE, ModeEvent.REBOOT),
    (entering, lambda f: f.beat("GUIDED"), Stage.ENTERING, ModeEvent.GUIDED),
    (entering, lambda f: f.beat("AUTO"), Stage.ENTERING, ModeEvent.UNCHANGED),
    (entering, lambda f: f.beat("RTL"), Stage.ENTERING, ModeEvent.OTHER),
    (entering, lambda f: f.leave(), Stage.ENTERING, ModeEvent.LEAVE),
    (entering, lambda f: f.enter(), Stage.ENTERING, ModeEvent.ENTER),
    (entering, lambda f: f.machine.give_up(), Stage.ENTERING, ModeEvent.GIVE_UP),
    (asked_back, lambda f: f.machine.give_up(), Stage.ENTERING, ModeEvent.GIVE_BACK),
    (active, lambda f: f.beat("GUIDED"), Stage.ACTIVE, ModeEvent.GUIDED_AGAIN),
    (active, lambda f: f.beat("AUTO"), Stage.ACTIVE, ModeEvent.UNCHANGED),
    (active, lambda f: f.beat("RTL"), Stage.ACTIVE, ModeEvent.OTHER),
    (active, lambda f: f.leave(), Stage.ACTIVE, ModeEvent.LEAVE),
    (active, late_reboot, Stage.ACTIVE, ModeEvent.REBOOT),
    (active, lambda f: f.machine.give_up(), Stage.ACTIVE, ModeEvent.GIVE_UP),
    (leaving, lambda f: f.beat("LOITER"), Stage.LEAVING, ModeEvent.RELEASED),
    (leaving, lambda f: f.beat("GUIDED"), Stage.LEAVING, ModeEvent.GUIDED_AGAIN),
    (leaving, lambda f: f.beat("RTL"), Stage.LEAVING, ModeEvent.OTHER),
    (leaving, lambda f: f.enter(), Stage.LEAVING, ModeEvent.ENTER),
    (leaving, lambda f: f.leave(), Stage.LEAVING, ModeEvent.LEAVE_AGAIN),
    (left, lambda f: f.beat("GUIDED"), Stage.LEFT, ModeEvent.GUIDED),
    (left, lambda f: again(f, turned=True), Stage.LEFT, ModeEvent.GUIDED_AGAIN),
    (left, lambda f: again(f, turned=False), Stage.LEFT, ModeEvent.FOREIGN),
    (left, lambda f: f.beat("RTL", armed=False), Stage.LEFT, ModeEvent.UNCHANGED),
    (left, lambda f: f.beat("RTL"), Stage.LEFT, ModeEvent.OTHER),
    (left, lambda f: f.leave(), Stage.LEFT, ModeEvent.LEAVE_AGAIN),
    (left, lambda f: f.machine.leave(ReleaseMode.RETURN, ("RTL", "LAND")), Stage.LEFT, ModeEvent.LEAVE),
    (left, lambda f: f.enter(), Stage.LEFT, ModeEvent.ENTER),
    (taken, lambda f: f.beat("GUIDED"), Stage.TAKEN, ModeEvent.GUIDED),
    (taken, lambda f: again(f, turned=True), Stage.TAKEN, ModeEvent.GUIDED_AGAIN),
    (taken, lambda f: again(f, turned=False), Stage.TAKEN, ModeEvent.FOREIGN),
    (taken, lambda f: f.beat("RTL"), Stage.TAKEN, ModeEvent.OTHER),
    (taken, lambda f: f.enter(), Stage.TAKEN, ModeEvent.ENTER),
    (taken, lambda f: f.leave(), Stage.TAKEN, ModeEvent.LEAVE),
    (taken, reboot, Stage.TAKEN, ModeEvent.REBOOT_AFTER_TAKING),
    (taken, late_reboot, Stage.TAKEN, ModeEvent.REBOOT),
]


@pytest.mark.parametrize(
    ("there", "then", "stage", "event"), STORIES, ids=[f"{s[2].name}-{s[3].name}" for s in STORIES]
)
def test_the_machine_does_what_the_table_says(
    there: Callable[[Flight], None], then: Callable[[Flight], None], stage: Stage, event: ModeEvent
) -> None:
    flight = Flight()
    there(flight)
    assert flight.machine.stage is stage
    flight.kinds.clear()
    then(flight)
    to, actions = transition(stage, event)
    assert flight.machine.stage is to
    kinds = {
        ModeAction.TELL_CONTROL: "control",
        ModeAction.TELL_FOUND: "control",
        ModeAction.TELL_HANDED_BACK: "handed_back",
        ModeAction.TELL_RELEASED: "released",
        ModeAction.TELL_FOREIGN: "foreign_guided",
        ModeAction.TELL_TAKE_OVER: "take_over",
        ModeAction.TELL_REBOOT: "reboot",
    }
    told = [kind for kind in flight.kinds if kind in kinds.values()]
    assert told == [kinds[action] for action in actions if action in kinds]


def test_a_failsafe_is_no_pilot_by_its_status_or_by_our_own_silence() -> None:
    told = {}
    for name, status, silent, mode in (
        ("status", 5, 0.0, "RTL"), ("silence", 4, 7.0, "RTL"), ("person", 4, 0.0, "RTL"),
        ("sticks", 4, 7.0, "FBWA"),
    ):  # fmt: skip
        flight = Flight()
        active(flight)
        flight.machine._chain = ()
        flight.now += silent
        heard = Telemetry(
            kind=Kind.ARDUPLANE, mode=mode, heartbeat_at=flight.now + 1.0, armed=True, status=status
        )
        notes = flight.machine.step(flight.now + 1.0, heard).notes
        told[name] = [note.kind for note in notes]
        assert flight.machine.failsafe == (name in ("status", "silence"))
    assert told == {
        "status": ["failsafe"], "silence": ["failsafe"], "person": ["take_over"], "sticks": ["take_over"],
    }  # fmt: skip


def test_what_an_old_request_does_against_a_pilot_is_not_flown() -> None:
    """An autopilot that answers late obeys a second GUIDED after the pilot has chosen LOITER."""
    flight = Flight()
    flight.beat("AUTO")
    flight.enter()
    for k in range(4):  # no answer yet: asked for again
        flight.machine.step(flight.now + 0.2 * k, Telemetry(mode="AUTO", heartbeat_at=flight.now, armed=True))
    flight.beat("GUIDED")
    flight.beat("LOITER", turned=True)
    assert flight.machine.stage is Stage.TAKEN
    again(flight, turned=False)
    assert flight.machine.stage is Stage.TAKEN
    assert flight.kinds[-1] == "late_answer"


def test_a_pilot_who_moves_a_stick_while_the_agent_asks_keeps_the_vehicle() -> None:
    """He is in LOITER already, and chooses nothing: only his stick says that he flies."""
    machine = ModeMachine(1, "GUIDED")
    beat = Telemetry(
        kind=Kind.ARDUCOPTER, mode="LOITER", heartbeat_at=100.0, armed=True, channels=(1500,) * 5,
        channels_at=100.0,
    )  # fmt: skip
    machine.step(100.0, beat)
    machine.enter()
    assert machine.step(100.1, beat._replace(position_at=100.1)).mode == "GUIDED"
    moved = beat._replace(channels=(1500, 1600, 1500, 1500, 1500), channels_at=100.2, position_at=100.2)
    asked = [machine.step(100.2 + 0.1 * k, moved._replace(position_at=100.2 + 0.1 * k)) for k in range(30)]
    assert machine.stage is Stage.TAKEN
    assert not [step.mode for step in asked if step.mode]


def test_a_throttle_that_falls_is_no_hand_but_a_stick_in_a_hold_is_one() -> None:
    """LOITER, in which the agent has left a copter, is the pilot's as soon as he moves it."""
    for channel, pulse, whose in ((2, 1000, Stage.LEFT), (2, 1700, Stage.TAKEN), (0, 1550, Stage.TAKEN)):
        machine = ModeMachine(1, "GUIDED")
        rest = [1500] * 5
        beat = Telemetry(
            kind=Kind.ARDUCOPTER, mode="GUIDED", heartbeat_at=100.0, armed=True, channels=tuple(rest),
            channels_at=100.0,
        )  # fmt: skip
        machine.step(100.0, beat)
        machine.leave(ReleaseMode.HOLD, ("LOITER", "RTL", "LAND"))
        machine.step(100.1, beat)
        machine.step(100.2, beat._replace(mode="LOITER", heartbeat_at=100.2))
        assert machine.stage is Stage.LEFT
        rest[channel] = pulse
        machine.step(100.7, beat._replace(
            mode="LOITER", heartbeat_at=100.2, channels=tuple(rest), channels_at=100.7,
        ))  # fmt: skip
        assert machine.stage is whose, (channel, pulse)


def test_one_request_at_a_time_is_on_its_way() -> None:
    """Once the round trip is known, a mode is asked for again only when that time has passed."""
    machine = ModeMachine(1, "GUIDED")
    beat = Telemetry(mode="AUTO", heartbeat_at=100.0, position_at=200.0, armed=True)
    machine.enter()
    machine.step(100.0, beat)
    machine.acknowledge(100.9, CommandAck(176, 0, 1, 191))  # 0.9 s late
    machine.step(101.0, beat._replace(mode="GUIDED", heartbeat_at=101.0))
    machine.leave(ReleaseMode.RETURN, CHAINS[ReleaseMode.RETURN])
    asked = []
    for k in range(300):
        now = 102.0 + 0.02 * k
        step = machine.step(now, beat._replace(mode="GUIDED", heartbeat_at=102.0, position_at=now))
        asked += [now] if step.mode else []
    assert min(b - a for a, b in pairwise(asked)) >= 1.35 - 1e-6


def test_a_try_says_how_often_the_mode_was_asked_for() -> None:
    machine = ModeMachine(1, "GUIDED")
    machine.enter()
    steps = [machine.step(k * 0.1, Telemetry(mode="AUTO", heartbeat_at=0.0)) for k in (0, 1, 2, 3)]
    assert [(step.mode, step.mode_tries) for step in steps if step.mode] == [
        ("GUIDED", 1), ("GUIDED", 2), ("GUIDED", 3),
    ]  # fmt: skip
    machine.acknowledge(0.3, CommandAck(176, 0, 1, 191))
    after = machine.step(0.4, Telemetry(mode="AUTO", heartbeat_at=0.0))
    assert (after.mode, after.prove) == ("", True)


def test_the_diagram_in_the_handbook_is_the_tables() -> None:
    """`python -m onboard.autopilot.mode_table --into docs/safety.md` draws it again."""
    text = (ROOT / "docs" / "safety.md").read_text(encoding="utf-8")
    assert drawn_into(text) == text


def test_the_command_draws_and_says_what_it_lacks(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    drawn = capsys.readouterr().out
    assert all(f" {stage.value} --> " in drawn for stage in Stage)
    file = tmp_path / "page.md"
    file.write_text("no marks here")
    with pytest.raises(ValueError, match="found no place for the diagram"):
        main(["--into", str(file)])
    assert main(["--onto", str(file)]) == 2
