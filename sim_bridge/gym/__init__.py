"""Environments for those who train: arrays of games, Gymnasium, PettingZoo (extras `sim` and `gym`).

Importing it registers `apollonius/Plane-v0` and its like with Gymnasium where that is installed;
`gymnasium.make("sim_bridge.gym:apollonius/Plane-v0")` does both at once.
"""

from __future__ import annotations

import contextlib
from typing import Any

IDS: dict[str, dict[str, Any]] = {
    "apollonius/Plane-v0": {"scenario": "plane"},
    "apollonius/Space-v0": {"scenario": "space"},
    "apollonius/Aircraft-v0": {"scenario": "spatial/five", "motion": "aircraft"},
}
"""What is registered with Gymnasium, and what each presets."""


def register_envs() -> None:
    """Register the ids with Gymnasium; idempotent."""
    from gymnasium.envs.registration import register, registry

    for id, preset in IDS.items():
        if id not in registry:
            register(id=id, entry_point="sim_bridge.gym.single:GameEnv", kwargs=dict(preset))


with contextlib.suppress(ImportError):  # the arrays need no Gymnasium
    register_envs()
