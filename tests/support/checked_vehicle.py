"""What the preflight check says of a simulated autopilot: the ears of the agent on virtual time."""

from __future__ import annotations

import asyncio
from random import Random
from typing import Any, cast

from onboard.agent.config import AgentConfig
from onboard.agent.preflight import Ears
from onboard.agent.preflight_rows import Row, Sight, judge
from onboard.core.math.constants import NS_PER_S
from onboard.game.scenario import Kind
from onboard.runtime.links import memory_pair
from onboard.runtime.loop import VirtualLoop, run_virtual
from onboard.wire.mavlink.signing import Signing
from tests.support.flown_autopilot import EPOCH_NS, FlownAutopilot

SYSTEM = 2
TICK_S = 0.02
SETTLED_S = 20.0  # from boot until the check begins: estimate, GPS and pre-arm checks are done


def checked(
    kind: Kind,
    *,
    seconds: float = 8.0,
    signing: Signing | None = None,
    theirs: Signing | None = None,
    twin: bool = False,
    loss: float = 0.0,
    vehicle_type: int | None = None,
    **options: Any,
) -> tuple[dict[str, Row], list[FlownAutopilot]]:
    """The rows of a check by name, and the vehicles: one, or with `twin` two of one system id.

    `signing` is the check's, `theirs` the autopilot's; `loss` the share of frames lost either way;
    `vehicle_type` a MAV_TYPE that the heartbeat says in place of the kind's."""
    options |= {"signing": theirs, "vehicle_type": vehicle_type}
    return run_virtual(_checked(kind, seconds, signing, (twin, loss), options), epoch_ns=EPOCH_NS)


async def _checked(
    kind: Kind, seconds: float, signing: Signing | None, link: tuple[bool, float], options: dict[str, Any]
) -> tuple[dict[str, Row], list[FlownAutopilot]]:
    clock = cast(VirtualLoop, asyncio.get_running_loop()).clock
    near, far = memory_pair("wire")
    (twin, loss), rng = link, Random(7)
    vehicle_type = options.pop("vehicle_type")
    flown = [FlownAutopilot(kind, system=SYSTEM, tick_s=TICK_S, **options) for _ in range(2 if twin else 1)]
    for number, one in enumerate(flown):  # a twin was switched on earlier
        if vehicle_type is not None:
            one.autopilot.vehicle_type = vehicle_type  # type: ignore[misc]
        one.forward(SETTLED_S + 30.0 * number)
        one.frames.clear()

    def arrived(data: bytes, peer: object) -> None:
        for one in flown if rng.random() >= loss else ():
            one.autopilot.receive(one.now_ns, data, "check")

    async def fly() -> None:
        while True:
            for one in flown:
                one.forward(TICK_S)
                for frame in one.frames:
                    if rng.random() >= loss:
                        far.send(frame)
                one.frames.clear()
            await asyncio.sleep(TICK_S)

    far.receive(arrived)
    task = asyncio.create_task(fly())
    config = AgentConfig(id=SYSTEM)
    seen = await Ears(config, [near], None, signing, clock).listen(Sight(signed=signing is not None), seconds)
    task.cancel()
    assert clock.monotonic_ns() >= seconds * NS_PER_S
    return {row.name: row for row in judge(config, seen)}, flown
