"""How vehicles move: the kinematic model, and transfer-function aircraft under their loops."""

KERNELS = ("onboard.core.vectors", "sim_bridge.flight.axis", "sim_bridge.flight.plane")
"""Modules in kernel style, for `sim_bridge.compiled.register`."""
