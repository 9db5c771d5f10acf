"""Clocks of different senders are never compared: whom an agent follows, and what it takes for stale."""

from __future__ import annotations

from msgspec.structs import replace

from gcs.master import FieldMaster
from gcs.station import Station, StationSetup
from onboard.game.scenario import Parameters, Scenario, VehicleSpec
from onboard.runtime.bus_memory import MemoryBroker
from onboard.runtime.clock import RealClock, SteadyClock
from onboard.runtime.loop import EPOCH_NS
from onboard.wire.bus import topics
from onboard.wire.bus.messages import AgentStage, Phase, RulesMessage
from onboard.wire.mavlink.commands import OwnHeartbeat
from onboard.wire.mavlink.frames import Framer, Sender
from onboard.wire.mavlink.signing import MemoryStore, SignatureCheck, Signing
from tests.support.lone_agent import SQUARE, FakeMaster, LoneAgent, playing

KEY = bytes(range(32))
TINY = Scenario(
    name="tiny",
    evader=VehicleSpec(position=(0.0, 0.0, 50.0), speed=5.0),
    pursuers=(VehicleSpec(position=(100.0, 0.0, 50.0), speed=5.0),),
    parameters=Parameters(R=2.0, horizon=30.0),
)
HOUR_NS = 3600 * 10**9


def led_by(agent: LoneAgent, master: FakeMaster, setup: str) -> None:
    """A master comes to lead: it says its lease, a setup, and the phases of a whole start."""
    agent.master = master
    agent.run(1.0)
    master.setup(setup)
    start = ((Phase.STAGING, 0.0, 2.0), (Phase.READY, 2.0, 2.1), (Phase.RUNNING, 0.0, 2.0))
    for phase, in_s, wait_s in start:
        master.phase(phase, in_s)
        agent.run(wait_s)


def test_the_next_master_is_followed_after_one_whose_clock_was_ahead() -> None:
    agent = LoneAgent()
    agent.master = FakeMaster("laptop-A", 5, offset_s=600.0)
    agent.run(1.0)
    agent.master.setup("x")
    agent.master.phase(Phase.STAGING)
    agent.run(2.0)
    agent.master.phase(Phase.ENDED)
    agent.run(0.5)
    agent.master.on = False
    agent.run(3.5)
    led_by(agent, FakeMaster("laptop-B", 6), "y")
    assert agent.health is not None
    assert agent.health.stage is AgentStage.ACTING
    assert agent.core.bus.drops["old_phase"] == 0


def test_a_phase_of_somebody_or_of_nobody_changes_nothing_while_the_lease_holds() -> None:
    agent = playing()
    mine = agent.core.bus.phase
    assert mine is not None
    evil = FakeMaster("evil", 1)
    late = agent.wall_ns + HOUR_NS
    ended = evil.change(Phase.ENDED, 1, late)
    for forged in (ended, replace(ended, master="", nonce=0), replace(ended, master="laptop-A")):
        agent.hear(forged, topics.PHASE)
        agent.run(0.5)
        assert agent.core.bus.phase == mine
    setup = agent.core.bus.setup
    assert setup is not None
    for forged_setup in (
        replace(setup, master="evil", fence=None), replace(setup, nonce=0, rules=RulesMessage(99.0, 199.0)),
    ):  # fmt: skip
        agent.hear(forged_setup, topics.SETUP)
        agent.run(0.5)
        assert agent.core.bus.setup.fence is not None
        assert agent.core.bus.setup.fence.polygon == SQUARE
    assert agent.rate(1.0) > 15.0


def test_an_earlier_phase_of_ones_own_master_is_dropped_whatever_its_stamp_says() -> None:
    agent = playing()
    mine = agent.core.bus.phase
    assert mine is not None
    late = agent.wall_ns + HOUR_NS
    agent.hear(replace(mine, phase=Phase.ENDED, number=1, stamp_ns=late), topics.PHASE)
    agent.run(0.5)
    assert agent.core.bus.drops["old_phase"] == 1
    assert agent.rate(0.4) > 15.0


def test_a_running_game_is_led_on_only_by_who_took_it_over_by_name_and_after_the_lease() -> None:
    agent = playing()
    other = FakeMaster("laptop-B", 6)
    other.takes_over = "laptop-A"
    agent.hear(other.lease(agent.wall_ns), topics.MASTER)
    agent.hear(other.change(Phase.ENDED, 1, agent.wall_ns), topics.PHASE)
    agent.run(0.5)
    assert agent.core.bus.masters.name == "laptop-A"  # its lease still runs
    other.takes_over = ""
    agent.master = other
    agent.run(4.0)
    other.phase(Phase.ENDED)
    agent.run(1.0)
    assert agent.core.bus.masters.name == "laptop-A"  # nobody took over
    assert agent.rate(0.4) > 15.0
    other.takes_over = "laptop-A"
    agent.run(1.0)
    assert agent.core.bus.masters.name == "laptop-B"
    assert agent.health is not None
    agent.run(1.0)
    assert agent.health.stage is AgentStage.ENDED  # what it had said meanwhile counts now


def test_with_keys_a_master_counts_under_its_certificates_name_alone() -> None:
    agent = playing(member="laptop-A")  # the member whose certificate may write as the master
    mine = agent.core.bus.phase
    assert mine is not None
    named = FakeMaster("laptop-B", 9)
    agent.master.on = False
    agent.hear(named.lease(agent.wall_ns), topics.MASTER)
    agent.run(4.0)  # the old lease has ended
    named.takes_over = "laptop-A"
    agent.hear(named.lease(agent.wall_ns), topics.MASTER)
    agent.hear(replace(mine, phase=Phase.ENDED, number=99, master="laptop-B", nonce=9), topics.PHASE)
    setup = agent.core.bus.setup
    assert setup is not None
    agent.hear(replace(setup, master="laptop-B", nonce=9, fence=None), topics.SETUP)
    agent.run(0.5)
    assert agent.core.bus.masters.name == "laptop-A"
    assert agent.core.bus.phase == mine
    assert agent.core.bus.drops["foreign_master"] == 4
    again = FakeMaster("laptop-A/00ff", 11)  # the same member, another process, taken over by a person
    again.takes_over = "laptop-A"
    agent.hear(again.lease(agent.wall_ns), topics.MASTER)
    agent.run(0.5)
    assert agent.core.bus.masters.name == "laptop-A/00ff"


def test_two_stations_without_keys_never_share_a_name_by_which_a_game_is_taken_over() -> None:
    broker, names = MemoryBroker(), set()
    for _ in range(50):
        station = Station(broker.connect(), RealClock(), StationSetup("g"))
        names.add(FieldMaster(station, TINY).rules.name)
    assert len(names) == 50
    assert all(name.startswith("gcs/") for name in names)
    with_keys = Station(broker.connect(), RealClock(), StationSetup("g", member="ground"))
    assert FieldMaster(with_keys, TINY, nonce=0xABCDE).rules.name == "ground/000abcde"


def heard(signing: Signing, sender: Sender, wall_ns: int) -> dict[str, int]:
    """What becomes of one heartbeat: nothing counted where it is taken."""
    framer = Framer(signing=signing)
    took = framer.feed(sender.pack(OwnHeartbeat(), wall_ns), wall_ns)
    return dict(framer.causes) if not took else {}


def test_a_clock_that_was_an_hour_ahead_leaves_nobody_deaf() -> None:
    store = MemoryStore()
    agent = Signing(KEY, store)
    Sender(2, 191, signing=agent).pack(OwnHeartbeat(), EPOCH_NS + HOUR_NS)  # its clock was ahead
    autopilot = Sender(2, 1, signing=Signing(KEY, MemoryStore()))
    assert heard(agent, autopilot, EPOCH_NS + 10**9) == {}  # set right, the same process
    later = Signing(KEY, store)
    assert heard(later, autopilot, EPOCH_NS + 4 * 10**9) == {}  # after a restart
    assert heard(Signing(KEY, store), autopilot, EPOCH_NS + 50 * 60 * 10**9) == {}


def test_after_a_restart_with_a_clock_set_right_who_followed_it_ahead_is_heard_and_nothing_older() -> None:
    store = MemoryStore()
    autopilot = Sender(2, 1, signing=Signing(KEY, MemoryStore()))
    ahead, agent = EPOCH_NS + HOUR_NS, Signing(KEY, store)
    long_ago = autopilot.pack(OwnHeartbeat(), ahead - 60 * 10**9)
    earlier = autopilot.pack(OwnHeartbeat(), ahead - 3 * 10**9)
    for frame in (long_ago, earlier):
        assert Framer(signing=agent).feed(frame, ahead)
    assert heard(agent, autopilot, ahead) == {}
    later = Signing(KEY, store)  # started again, its clock right: the autopilot's stamps do not run back
    for frame in (long_ago, earlier):
        again = Framer(signing=later)
        assert not again.feed(frame, EPOCH_NS)
        assert again.causes["signature_replayed"] == 1
    assert heard(later, autopilot, EPOCH_NS) == {}
    assert heard(Signing(KEY, store), autopilot, EPOCH_NS + 5 * 10**9) == {}  # and again


def test_an_autopilot_that_followed_our_clock_ahead_is_heard_when_it_is_set_right() -> None:
    agent = Signing(KEY, MemoryStore())
    autopilot = Sender(2, 1, signing=Signing(KEY, MemoryStore()))
    assert heard(agent, autopilot, EPOCH_NS + HOUR_NS) == {}
    assert heard(agent, autopilot, EPOCH_NS) == {}  # its stamps do not run back


def test_a_new_stream_from_a_minute_ago_or_from_the_future_is_still_refused() -> None:
    for off_ns, cause in ((-61 * 10**9, SignatureCheck.STALE), (61 * 10**9, SignatureCheck.FUTURE)):
        frame = Sender(2, 1, signing=Signing(KEY, MemoryStore())).pack(OwnHeartbeat(), EPOCH_NS + off_ns)
        framer = Framer(signing=Signing(KEY, MemoryStore()))
        assert not framer.feed(frame, EPOCH_NS)
        assert framer.causes[f"signature_{cause.value}"] == 1


class Set:
    """A machine's clocks, whose wall time is set by a person or by NTP."""

    wall, steady = 5_000, 1_000

    def wall_ns(self) -> int:
        return self.wall

    def monotonic_ns(self) -> int:
        return self.steady


def test_a_simulation_lives_on_steady_time() -> None:
    machine = Set()
    clock = SteadyClock(machine)
    machine.wall, machine.steady = machine.wall + HOUR_NS, machine.steady + 50
    assert (clock.wall_ns(), clock.monotonic_ns()) == (5_050, 1_050)
