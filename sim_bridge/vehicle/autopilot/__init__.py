"""Simulated autopilots: sans-I/O MAVLink state machines in three personalities.

`make.autopilot_for(...)` builds one; the world calls `receive`, `step` and `outgoing`.
"""
