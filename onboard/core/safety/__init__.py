"""The supervisor between every decision and the link: pure rules over floats, time passed in.

`policy` holds thresholds, actions and causes; `envelope`, `fence` and `separation` clip what a
strategy wants; `health` says what the state of vehicle, links and clock demands; `machine` is the
one state machine that joins them; `field` is the field profile; `words` puts causes into words.
"""
