"""The answers: pure functions over floats and vectors of the game frame, SI and radians, no arrays."""
