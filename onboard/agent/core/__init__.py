"""The agent as a machine without input and output: events in, effects out (`machine.AgentCore`).

Nothing here opens, waits, or asks a clock: each call is told what time it is. The same events give the same
effects, in flight, on virtual time, and when a flight is replayed on the ground.
"""
