"""The briefs of several evaders on a bus with certificates: nobody is sent another one's."""

from __future__ import annotations

import asyncio
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from onboard.runtime.bus_zenoh import open_zenoh
from onboard.wire.bus.messages import OwnBrief
from onboard.wire.bus.topics import OWN_BRIEF, SETUP, Delivery, everything
from tests.support.field_keys import Field
from tests.support.real_time import until

GAME = "range"
FIRST, SECOND = 1, 4  # the evaders
BRIEFS = {id: OwnBrief(id, 7, ((float(id), 2.0, -3.0),)) for id in (FIRST, SECOND)}


@pytest.mark.real
async def test_each_evader_is_sent_its_own_brief_alone_and_a_pursuer_none(tmp_path: Path) -> None:
    field = Field(tmp_path / "keys")
    second = f'id = {SECOND}\nrole = "evader"\n\n[[vehicles]]\n'
    field.change("id = 2\n", f"{second}id = 2\n")
    field.make()
    ground = await open_zenoh(listen=True, config_file=field.config("ground"))
    buses = [ground]
    heard: dict[str, list[tuple[str, bytes]]] = {}
    asked = [everything(GAME), OWN_BRIEF.key(GAME), *(OWN_BRIEF.key(GAME, id) for id in BRIEFS)]
    try:
        for who in ("vehicle-1", "vehicle-4", "vehicle-2"):
            bus = await open_zenoh(config_file=field.config(who))
            buses.append(bus)
            heard[who] = []

            def take(sample: Any, who: str = who) -> None:
                heard[who].append((sample.key, sample.payload))

            for key in (SETUP.key(GAME), *asked):
                bus.subscribe(key, take)
            await until(bus.connected)
        for id, brief in BRIEFS.items():
            ground.publish(OWN_BRIEF.key(GAME, id), OWN_BRIEF.encode(brief), Delivery.CACHED)
        ground.publish(SETUP.key(GAME), b"setup", Delivery.CACHED)
        await until(lambda: all(any(key == SETUP.key(GAME) for key, _ in one) for one in heard.values()))
        await until(lambda: all(OWN_BRIEF.key(GAME, id) in dict(heard[f"vehicle-{id}"]) for id in BRIEFS))
        await asyncio.sleep(0.5)
        found = {
            who: {key: OWN_BRIEF.decode(data, Counter()) for key, data in one if key.endswith("/brief")}
            for who, one in heard.items()
        }
        assert found == {
            "vehicle-1": {OWN_BRIEF.key(GAME, FIRST): BRIEFS[FIRST]},
            "vehicle-4": {OWN_BRIEF.key(GAME, SECOND): BRIEFS[SECOND]},
            "vehicle-2": {},
        }
    finally:
        for bus in buses[::-1]:
            await bus.close()
