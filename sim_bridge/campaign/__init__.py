"""Campaigns: many flights and games over paired seeds, compiled from the kernels that fly onboard."""
