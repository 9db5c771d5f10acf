"""The pursuers as a team: who does what, where and until when. Strategic level, kernel style.

`planner.plan` is the one entrance; `plan_types` holds what goes in and comes out.
"""
