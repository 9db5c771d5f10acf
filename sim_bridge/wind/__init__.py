"""The air: mean wind, shear, gusts, recordings."""

KERNELS = ("sim_bridge.wind.shear", "sim_bridge.wind.dryden")
"""Modules in kernel style, for `sim_bridge.compiled.register`."""
