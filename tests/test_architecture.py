"""ARCHITECTURE.md names only what exists."""

from __future__ import annotations

import re

from tests.support.paths import ROOT

ROOMS = ("core", "config", "pilot", "wire", "game", "runtime", "autopilot", "agent")


def test_every_place_that_the_architecture_names_exists() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    tops = "|".join(("onboard", "gcs", "sim_bridge", "tests", "examples", "configs", *ROOMS))
    named = re.findall(rf"`((?:{tops})/[\w/.-]+)`", text)
    assert len(named) > 30
    missing = []
    for place in named:
        path = ROOT / (f"onboard/{place}" if place.split("/")[0] in ROOMS else place)
        if not (path.exists() or path.with_name(path.name + ".py").exists()):
            missing.append(place)
    assert missing == []
