"""The air: mean wind, shear, gusts, recordings."""

KERNELS = (
    "sim_bridge.draws",
    "sim_bridge.vehicle.wind.shear",
    "sim_bridge.vehicle.wind.dryden",
    "sim_bridge.vehicle.wind.estimate",
)
"""Modules in kernel style, for `sim_bridge.campaign.compiled.register`."""
