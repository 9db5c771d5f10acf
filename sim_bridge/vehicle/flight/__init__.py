"""How vehicles move: the kinematic model, and transfer-function aircraft under their loops."""

KERNELS = ("onboard.core.math.vectors", "sim_bridge.vehicle.flight.axis", "sim_bridge.vehicle.flight.plane")
"""Modules in kernel style, for `sim_bridge.campaign.compiled.register`."""
