"""The agent: flies one vehicle. `Agent` joins clock, links, bus, adapter, pilot and supervisor.

It is indifferent to what kind of loop it runs on: real time, or virtual time with memory links and
bus, many agents in one process.
"""
