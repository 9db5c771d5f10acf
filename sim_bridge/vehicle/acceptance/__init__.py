"""Acceptance flights: the same stories flown by a real autopilot and by its simulated twin, and compared.

Sans I/O: a story is a generator of pauses; who flies it brings the time, the link and a person's consent.
"""
