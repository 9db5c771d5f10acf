"""Floods on a real bus, from a member and from strangers, beside a 20 Hz loop that hears it.

In this process runs an agent's bus (subscribed as an agent is) and a loop at 20 Hz; another process floods:
50,000 messages a second, 50 MB payloads, 20,000 datagrams a second. `python -m tests.benchmarks.bench_floods`
prints for each the loop's longest gap and rate, first without a flood: on a busy machine those gaps are the
machine's.
"""

from __future__ import annotations

import asyncio
import resource
import socket
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from onboard.runtime.bus_zenoh import open_zenoh
from onboard.wire.bus.topics import COMMAND, EVENTS, STATE, TRACK
from tests.support.field_keys import Field

SECONDS = 5.0
KINDS = ("none", "member", "huge", "strangers", "datagrams")


def flood(kind: str, folder: str, port: int) -> None:
    """The flooding process: until it is killed."""
    import zenoh

    if kind in ("strangers", "datagrams"):
        sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        data = b"APD1" + bytes(200)
        while True:
            start = time.monotonic()
            for _ in range(200):
                sock.sendto(data, ("127.0.0.1", port))
            time.sleep(max(0.0, 0.01 - (time.monotonic() - start)))
    session = zenoh.open(zenoh.Config.from_file(str(Path(folder) / "vehicle-2" / "zenoh.json5")))
    payload = bytes(50_000_000) if kind == "huge" else bytes(200)
    keys = [STATE.key("range", 2), EVENTS.key("range", 2), TRACK.key("range", 1), STATE.key("range", 3)]
    while True:
        start = time.monotonic()
        for n in range(1 if kind == "huge" else 500):
            session.put(keys[n % len(keys)], payload)
        time.sleep(max(0.0, 0.01 - (time.monotonic() - start)))


async def measure(kind: str) -> dict[str, Any]:
    """The 20 Hz loop while another process floods."""
    with tempfile.TemporaryDirectory() as place:
        field = Field(Path(place, "keys")).make()
        ground = await open_zenoh(listen=True, config_file=field.config("ground"))
        agent = await open_zenoh(config_file=field.config("vehicle-3"))
        heard = 0

        def take(sample: object) -> None:
            nonlocal heard
            heard += 1

        for key in (STATE.key("range", 2), TRACK.key("range")):
            agent.subscribe(key, take)
        agent.serve(COMMAND.key("range", 3), lambda question: question)
        ground.subscribe("apollonius/range/**", take, every=True)
        words = [sys.executable, "-m", "tests.benchmarks.bench_floods", kind]
        words += [str(field.folder), str(field.port)]
        flooding = None if kind == "none" else await asyncio.create_subprocess_exec(*words)
        await asyncio.sleep(2.0)
        gaps, begun = [], time.monotonic()
        last = due = begun
        while last - begun < SECONDS:
            due = max(due + 0.05, time.monotonic() - 0.05)  # of late ticks one is caught up
            await asyncio.sleep(max(0.0, due - time.monotonic()))
            now = time.monotonic()
            gaps.append(now - last)
            last = now
        counters = {k: n for k, n in ground.counters().items() if "limited" in k or "foreign" in k}
        if flooding is not None:
            flooding.kill()
            await flooding.wait()
        await agent.close()
        await ground.close()
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        return {"rate": len(gaps) / SECONDS, "gap": max(gaps), "heard": heard, "MB": memory, **counters}


def main() -> None:
    if len(sys.argv) > 2:
        flood(sys.argv[1], sys.argv[2], int(sys.argv[3]))
        return
    for kind in KINDS:
        found = asyncio.run(measure(kind))
        rest = {k: v for k, v in found.items() if k not in ("rate", "gap")}
        print(f"{kind}: {found['rate']:.1f} Hz, longest gap {found['gap']:.3f} s, {rest}", flush=True)


if __name__ == "__main__":
    main()
