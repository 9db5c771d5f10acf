"""`sim-bridge classic`: problems with known values, and what strategies reach of them."""
