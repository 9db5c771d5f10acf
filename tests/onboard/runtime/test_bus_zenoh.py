"""What only real sessions show: taken ports, threads, a blocked loop, faults in words."""

from __future__ import annotations

import asyncio
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path

import pytest
import zenoh

from onboard.config.strict import ConfigError
from onboard.runtime.bus_zenoh import open_zenoh
from onboard.runtime.inbox import QUEUE_MAX, Inbox
from onboard.runtime.zenoh_config import LEASE_MS
from onboard.wire.bus.topics import Delivery
from tests.support.bus_stages import Heard, free_port
from tests.support.real_time import patience, until

STATE = "apollonius/range/vehicles/2/state"


@pytest.mark.real
async def test_the_second_to_listen_joins_as_a_client_and_says_so() -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    station, bridge = await open_zenoh(endpoint, listen=True), await open_zenoh(endpoint, listen=True)
    try:
        assert station.how == "listening"
        assert bridge.how == "joined"
        assert bridge.status() == f"joined {endpoint} as a client: its port was taken"
        await until(station.connected)
        assert station.status() == f"listening at {endpoint}"
    finally:
        await bridge.close()
        await station.close()


@pytest.mark.real
async def test_a_port_taken_by_another_program_is_told_and_waited_out() -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        endpoint = f"tcp/127.0.0.1:{other.getsockname()[1]}"
        bus = await open_zenoh(endpoint, listen=True)
        assert not bus.connected()
        assert bus.status().startswith(f"waiting for a bus at {endpoint} (")
        assert ".rs" not in bus.status()
    await until(bus.connected if bus.how == "joined" else lambda: bus.how == "listening")
    await bus.close()


@pytest.mark.real
async def test_a_blocked_loop_hears_the_latest_state_and_counts_the_rest() -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    station, vehicle = await open_zenoh(endpoint, listen=True), await open_zenoh(endpoint)
    try:
        heard = Heard(station, STATE)
        await until(lambda: vehicle.publish(STATE, b"probe", Delivery.LATEST) or heard.samples)
        await asyncio.sleep(0.2)
        heard.samples.clear()
        blocked, free = threading.Event(), threading.Event()
        asyncio.get_running_loop().call_soon(lambda: (blocked.set(), free.wait(20)))

        def flood() -> None:
            blocked.wait(20)
            for number in range(500):
                vehicle.publish(STATE, number.to_bytes(2, "big"), Delivery.LATEST)
            threading.Event().wait(0.5)
            free.set()

        flooding = threading.Thread(target=flood)
        flooding.start()
        await until(lambda: heard.payloads and heard.payloads[-1] == (499).to_bytes(2, "big"))
        flooding.join()
        assert len(heard.samples) < 20
        counts = station.counters()
        assert counts["overwritten"] > 100  # of a channel's places
        assert counts["overflow"] >= 1  # it was full: what went before is not counted one by one
    finally:
        await vehicle.close()
        await station.close()


async def test_an_inbox_keeps_the_newest_of_its_queue_and_survives_a_bad_receiver() -> None:
    loop = asyncio.get_running_loop()
    faults: list[object] = []
    loop.set_exception_handler(lambda _, context: faults.append(context["exception"]))
    inbox, ran = Inbox(loop), list[int]()
    inbox.queue(lambda: ran.append(-1))
    for number in range(QUEUE_MAX):
        inbox.queue(lambda number=number: ran.append(number // (number != 5)))  # type: ignore[misc]
    await asyncio.sleep(0)
    assert ran == [number for number in range(QUEUE_MAX) if number != 5]
    assert inbox.counts == {"overflow": 1}
    assert [type(fault) for fault in faults] == [ZeroDivisionError]


@pytest.mark.real
@pytest.mark.parametrize("endpoint", ["127.0.0.1:7447", "nonsense", "tcp/"])
async def test_a_wrong_endpoint_is_one_clear_line(endpoint: str) -> None:
    with pytest.raises(ConfigError, match=r"^bus: .*expected e\.g\. tcp/127\.0\.0\.1:7447$"):
        await open_zenoh(endpoint)


@pytest.mark.real
async def test_a_wrong_configuration_file_is_one_clear_line(tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as caught:
        await open_zenoh(config_file=tmp_path / "none.json5")
    assert "none.json5" in str(caught.value)
    bad = tmp_path / "bad.json5"
    bad.write_text('{ mode: "captain" }')
    with pytest.raises(ConfigError) as caught:
        await open_zenoh(config_file=bad)
    assert str(caught.value).startswith(str(bad))
    assert "\n" not in str(caught.value)


@pytest.mark.real
async def test_endpoints_may_come_from_a_zenoh_file(tmp_path: Path) -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    station = await open_zenoh(endpoint, listen=True)
    file = tmp_path / "client.json5"
    file.write_text(
        f'{{ mode: "client", connect: {{ endpoints: ["{endpoint}"] }}, '
        "scouting: { multicast: { enabled: false } } }"
    )
    bus = await open_zenoh(config_file=file)
    try:
        assert bus.connected()
    finally:
        await bus.close()
        await station.close()


@pytest.mark.real
@pytest.mark.parametrize("closing", ["await bus.close()", "pass"])
def test_a_program_ends_whether_the_bus_ever_came_or_not(closing: str) -> None:
    program = f"""
import asyncio
from onboard.runtime.bus_zenoh import open_zenoh
async def main():
    bus = await open_zenoh("tcp/127.0.0.1:{free_port()}")
    bus.announce("apollonius/range/vehicles/2/alive")
    {closing}
asyncio.run(main())
print("ended")
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=patience(20.0), check=False
    )
    assert (done.returncode, done.stdout) == (0, "ended\n"), done.stderr


@pytest.mark.real
@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGSTOP])
async def test_a_process_that_dies_or_hangs_is_seen_to_leave(end: signal.Signals) -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    program = f"""
import asyncio
from onboard.runtime.bus_zenoh import open_zenoh
async def main():
    bus = await open_zenoh("{endpoint}")
    bus.announce("apollonius/range/vehicles/2/alive")
    await asyncio.sleep(3600)
asyncio.run(main())
"""
    station = await open_zenoh(endpoint, listen=True)
    seen: list[bool] = []
    station.presence("apollonius/range/vehicles/*/alive", lambda key, alive: seen.append(alive))
    child = await asyncio.create_subprocess_exec(sys.executable, "-c", program)
    try:
        await until(lambda: seen == [True], 10.0)
        child.send_signal(end)
        await until(lambda: seen == [True, False], LEASE_MS / 1000)
        await until(lambda: not station.connected(), LEASE_MS / 1000)  # told apart, in any order
    finally:
        if child.returncode is None:
            child.send_signal(signal.SIGCONT)
            child.kill()
        await child.wait()
        await station.close()


@pytest.mark.real
async def test_a_panic_of_zenoh_does_not_end_the_opener(monkeypatch: pytest.MonkeyPatch) -> None:
    class PanicException(BaseException):
        """As PyO3's: no Exception."""

    opened = zenoh.open
    panics = 2

    def failing(config: zenoh.Config) -> object:
        nonlocal panics
        panics -= 1
        if panics >= 0:
            raise PanicException("Failed to init net\x1b[2J")
        return opened(config)

    monkeypatch.setattr("onboard.runtime.zenoh_session.zenoh.open", failing)
    monkeypatch.setattr("onboard.runtime.zenoh_session.RETRY_S", 0.1)
    bus = await open_zenoh(f"tcp/127.0.0.1:{free_port()}", listen=True)
    try:
        await until(lambda: bus.how in ("listening", "joined"))
        assert bus.counters()["open_failed"] >= 1
    finally:
        await bus.close()
