"""The knowledge model of a team: the situation as a small semantic network, and the goals that follow.

`relations.RELATIONS` says what holds between whom and how strongly, `goals.GOALS` what the team is after
then; `model.MODEL` is both, and `model.extended` adds a user's own.
"""
