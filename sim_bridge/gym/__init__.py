"""Environments for those who train: arrays of games, Gymnasium, PettingZoo (extras `sim` and `gym`).

`gymnasium.make("apollonius/Plane-v0")` finds them through the entry point `gymnasium.envs`, and without an
installation `gymnasium.make("sim_bridge.gym:apollonius/Plane-v0")` does. Importing this package imports
neither library.
"""

from __future__ import annotations

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


def _register_where_gymnasium_is() -> None:
    """Importing the package by Gymnasium's own way of naming a module registers the ids."""
    import sys

    if "gymnasium" in sys.modules:
        register_envs()


_register_where_gymnasium_is()
