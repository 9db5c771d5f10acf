"""Pursuit–evasion problems with known answers: their values, both sides' optimal play, and ours against it.

`values` holds the answers as pure functions in kernel style, `problems` the ten games (`chases`, `guards`,
`raids`), `play` the arena. Nothing that flies imports this room.
"""
