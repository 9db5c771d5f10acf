"""A strategy of another distribution can do anything to its own process, and nothing to the agent."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from math import inf
from pathlib import Path

import pytest

from onboard.agent import strategy_child
from onboard.agent.core.events import Answered, Load, Loaded, Think
from onboard.agent.strategy_child import ANSWER_S, ApartThinker
from onboard.agent.thinker import Thinker
from onboard.core.game.rules import NO_TARGET, Control, Rules
from onboard.core.game.views import PursuerView, Sighting, Team, nearest_mate, pursuer_view
from onboard.core.math.states import Vehicle, VehicleLimits
from onboard.core.math.vectors import ZERO, Vec
from onboard.core.strategy.registry import DEFAULT_PURSUER as DEFAULT
from onboard.core.strategy.registry import PURSUERS
from onboard.pilot.setup import Side
from onboard.runtime.clock import RealClock
from tests.support import plugins
from tests.support.real_time import patience

pytestmark = pytest.mark.real


def view() -> PursuerView:
    evader = Vehicle(Vec(50.0, 20.0, -30.0), Vec(3.0, 0.0, 0.0), 4.0)
    own = Vehicle(Vec(0.0, 0.0, -30.0), Vec(1.0, 1.0, 0.0), 6.0)
    sighting = Sighting(evader, Vec(1.0, 0.0, 0.0), False, ZERO)
    alone = Team(nearest_mate(own.position, (), -1), (own,), 0, NO_TARGET)
    return pursuer_view(own, VehicleLimits(), sighting, alone, Control(), Rules(R=5.0, rho=10.0))


class Asker:
    """What an agent's shell is to the strategies."""

    def __init__(self) -> None:
        self.loaded: list[Loaded] = []
        self.answers: list[Answered] = []
        clock = RealClock()
        self.thinker = ApartThinker(Thinker(clock), self.hear, clock)

    def hear(self, message: Loaded | Answered) -> None:
        (self.loaded if isinstance(message, Loaded) else self.answers).append(message)  # type: ignore[arg-type]

    async def until(self, holds: Callable[[], bool], promised_s: float) -> None:
        end = time.monotonic() + patience(promised_s)
        while not holds():
            assert time.monotonic() < end, (self.loaded, self.answers)
            await asyncio.sleep(0.005)

    async def load(self, name: str) -> Loaded:
        self.thinker.load(Load(Side.PURSUER, name))
        await self.until(lambda: bool(self.loaded), 2.0)
        return self.loaded[0]

    async def ask(self, number: int, name: str) -> Answered:
        self.thinker.answer(Think(number, Side.PURSUER, name, view()))
        await self.until(lambda: bool(self.answers) and self.answers[-1].number == number, 1.0)
        return self.answers[-1]

    def pid(self, name: str) -> int | None:
        return self.thinker.children[Side.PURSUER, name].pid


@pytest.fixture
def asker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Asker:
    plugins.install(tmp_path)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), os.getcwd()]))
    monkeypatch.setattr(strategy_child, "ANSWER_S", patience(ANSWER_S))  # the bound is measured elsewhere
    return Asker()


def test_a_good_one_answers_as_the_same_strategy_does_here(asker: Asker) -> None:
    async def story() -> None:
        assert (await asker.load("good")).error == ""
        for number in range(1, 20):
            answer = await asker.ask(number, "good")
            assert answer.error == ""
            assert answer.decision == PURSUERS[DEFAULT].decide(view())
            assert 0.0 < answer.took_s < patience(ANSWER_S)
        asker.thinker.close()

    asyncio.run(story())


@pytest.mark.parametrize("name", ["exits", "unspeakable", "escapes"])
def test_what_raises_fails_and_may_answer_again(asker: Asker, name: str) -> None:
    async def story() -> None:
        assert (await asker.load(name)).error == ""
        assert (await asker.ask(1, name)).error == ""
        assert (await asker.ask(2, name)).error == ""
        failed = await asker.ask(3, name)
        assert failed.decision is None
        assert failed.error
        assert failed.error.isprintable()
        assert asker.pid(name) is not None
        asker.thinker.close()

    asyncio.run(story())


@pytest.mark.parametrize("name", ["leaves", "loop", "forking", "closes"])
def test_what_does_not_answer_any_more_is_ended_with_all_it_has_started(asker: Asker, name: str) -> None:
    async def story() -> None:
        assert (await asker.load(name)).error == ""
        await asker.ask(1, name)
        await asker.ask(2, name)
        pid = asker.pid(name)
        assert pid is not None
        failed = await asker.ask(3, name)
        assert (failed.decision, failed.took_s) == (None, inf)
        assert asker.pid(name) is None
        await asker.until(lambda: not group(pid), 2.0)
        assert (await asker.ask(4, name)).took_s == inf  # at once, while there is no child
        asker.thinker.close()

    asyncio.run(story())


def test_one_that_eats_memory_is_bounded_and_fails(asker: Asker) -> None:
    async def story() -> None:
        assert (await asker.load("hungry")).error == ""
        await asker.ask(1, "hungry")
        await asker.ask(2, "hungry")
        failed = await asker.ask(3, "hungry")
        assert failed.decision is None
        assert "MemoryError" in failed.error or "no answer" in failed.error or "ended" in failed.error
        asker.thinker.close()

    asyncio.run(story())


def test_what_it_prints_reaches_neither_the_terminal_nor_the_answers(
    asker: Asker, capfd: pytest.CaptureFixture[str]
) -> None:
    async def story() -> None:
        assert (await asker.load("scribbler")).error == ""
        for number in range(1, 6):
            assert (await asker.ask(number, "scribbler")).error == ""
        asker.thinker.close()

    asyncio.run(story())
    assert capfd.readouterr() == ("", "")


def test_one_that_exits_while_it_is_loaded_is_refused_with_the_reason(asker: Asker) -> None:
    async def story() -> None:
        assert "exits_at_import" in (await asker.load("exits_at_import")).error
        assert "does not load" in (await asker.ask(1, "exits_at_import")).error
        asker.thinker.close()

    asyncio.run(story())


def test_one_that_hangs_while_it_is_loaded_is_refused_in_time(
    asker: Asker, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(strategy_child, "LOAD_S", 0.3)

    async def story() -> None:
        assert "does not load within" in (await asker.load("hangs_at_import")).error
        asker.thinker.close()

    asyncio.run(story())


def test_one_that_was_ended_is_started_again_a_few_times_and_not_at_once(
    asker: Asker, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(strategy_child, "AGAIN_S", 0.2)
    monkeypatch.setattr(strategy_child, "STARTS_MAX", 2)

    async def story() -> None:
        assert (await asker.load("leaves")).error == ""
        child = asker.thinker.children[Side.PURSUER, "leaves"]
        number = 0
        for starts in (1, 2):
            await asker.until(lambda: child._ready, 2.0)
            assert child.starts == starts
            for _ in range(3):
                number += 1
                answer = await asker.ask(number, "leaves")
            assert answer.took_s == inf
        await asyncio.sleep(0.5)
        assert child.pid is None
        assert len(asker.loaded) == 1
        asker.thinker.close()

    asyncio.run(story())


def test_a_disk_that_holds_up_the_start_of_a_process_holds_up_nobody(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plugins.install(tmp_path)
    paths = os.pathsep.join([str(tmp_path), *sys.path])
    monkeypatch.setenv("PYTHONPATH", paths)
    thaw, popen = threading.Event(), subprocess.Popen

    def frozen(*words: object, **how: object) -> object:
        assert thaw.wait(60.0)
        return popen(*words, **how)  # type: ignore[call-overload]

    async def story() -> None:
        asker = Asker()
        monkeypatch.setattr(strategy_child.subprocess, "Popen", frozen)
        begun = time.monotonic()
        asker.thinker.load(Load(Side.PURSUER, "good"))
        answer = await asker.ask(1, "good")
        assert time.monotonic() - begun < patience(0.2)
        assert "being started" in answer.error
        thaw.set()
        while not asker.loaded:  # noqa: ASYNC110
            await asyncio.sleep(0.01)
        assert asker.loaded[0].error == ""
        assert (await asker.ask(2, "good")).decision is not None
        child = asker.pid("good")
        await asyncio.sleep(1.0)  # the thread that began it still lives: nothing kills it
        assert (asker.pid("good"), child is not None) == (child, True)
        asker.thinker.close()

    asyncio.run(story())


def test_none_outlives_an_agent_that_is_killed(tmp_path: Path) -> None:
    plugins.install(tmp_path)
    code = (
        "from tests.onboard.agent.test_strategy_child import *\n"
        "strategy_child.LOAD_S = 60.0\n"
        "async def begin():\n"
        "    asker = Asker(); asker.thinker.load(Load(Side.PURSUER, 'hangs_at_import'))\n"
        "    while asker.pid('hangs_at_import') is None: await asyncio.sleep(0.01)\n"
        "    print(asker.pid('hangs_at_import'), flush=True); await asyncio.sleep(60)\n"
        "asyncio.run(begin())\n"
    )
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), os.getcwd()])}
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, env=env, text=True) as parent:
        assert parent.stdout is not None
        pid = int(parent.stdout.readline())
        until(lambda: busy(pid), 5.0)
        parent.kill()
    until(lambda: not alive(pid), 2.0)


def until(holds: Callable[[], bool], promised_s: float) -> None:
    end = time.monotonic() + patience(promised_s)
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


def busy(pid: int) -> bool:
    """Whether a process has used two seconds of a core: it is past its beginning."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return int(fields[11]) / os.sysconf("SC_CLK_TCK") > 2.0


def alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in ("Z", "X")
    except FileNotFoundError:
        return False


def group(leader: int) -> list[int]:
    """The living processes of a group."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                state, _, number = (entry / "stat").read_text().rsplit(")", 1)[1].split()[:3]
            except (FileNotFoundError, ProcessLookupError):
                continue
            if int(number) == leader and state not in ("Z", "X"):
                found.append(int(entry.name))
    return found
