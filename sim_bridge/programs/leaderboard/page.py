"""The leaderboard as one page of HTML that needs nothing else, and as JSON: equal bytes for equal games."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape

import msgspec
import numpy as np

from onboard.core.strategy.registry import EVADERS, PURSUERS, NamedEvader, NamedPursuer
from onboard.game import palette
from sim_bridge.programs.campaigns.plan import Chosen, Plan
from sim_bridge.programs.leaderboard.ratings import Array, Board, Score

STYLE = """
:root{{--ink:{ink.light};--faint:{faint.light};--paper:{paper.light};--grid:{grid.light};--bar:{bar.light}}}
@media(prefers-color-scheme:dark){{:root{{--ink:{ink.dark};--faint:{faint.dark};--paper:{paper.dark};
--grid:{grid.dark};--bar:{bar.dark}}}}}
body{{color:var(--ink);background:var(--paper);font:15px/1.5 system-ui,sans-serif;max-width:70rem;
margin:2rem auto;padding:0 1rem}}
h1{{font-size:1.6rem;margin:0}}h2{{font-size:1.15rem;margin:2rem 0 .5rem}}p,summary{{color:var(--faint)}}
table{{border-collapse:collapse;font-variant-numeric:tabular-nums}}
th,td{{padding:.25rem .6rem;text-align:right;border-bottom:1px solid var(--grid)}}
th:first-child,td:first-child{{text-align:left}}small{{color:var(--faint)}}th{{font-weight:600}}
.matrix td+td{{min-width:4.5rem;text-align:center;color:#111}}.scroll{{overflow-x:auto}}
svg{{vertical-align:middle}}code{{font-size:.9em}}
"""
LOW, HIGH = (245, 243, 238), (0, 104, 179)  # of the shades: nobody captured, everybody
WIDTH = 260  # [px] of the bars


def page(plan: Plan, board: Board, commitment: str) -> str:
    """The whole page."""
    style = STYLE.format(
        ink=palette.INK, faint=palette.FAINT, paper=palette.PAPER, grid=palette.GRID, bar=palette.PURSUERS[0]
    )
    versions = ", ".join(f"{name} {value}" for name, value in sorted(plan.fingerprint.versions.items()))
    plugins = ", ".join(f"{name} ({value.rpartition(' ')[0]})" for name, value in
                        sorted(plan.fingerprint.plugins.items()))  # fmt: skip
    foreign = f"; plug-ins: {plugins}" if plugins else ""
    seeds = "public seeds" if not commitment else f"seeds hidden by a key (SHA-256 {commitment})"
    total = board.games * board.points.size
    details = "".join(
        f"<details><summary>{escape(_told(one))}</summary>{_matrix(board, k)}</details>"
        for k, one in enumerate(plan.scenarios)
    )
    counts = " × ".join(
        _counted(count, word)
        for count, word in ((len(board.pursuers), "strategy of the pursuers"),
                            (len(board.evaders), "strategy of the evader"),
                            (len(board.scenarios), "scenario"), (board.games, "game"))
    )  # fmt: skip
    return f"""<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>Leaderboard of pursuit and evasion</title><style>{style}</style>
<h1>Leaderboard of pursuit and evasion</h1>
<p>Pursuers hunt an evader that wants to its target. {counts} = {total} games; {escape(seeds)}.</p>
<h2>Pursuers</h2>{_scores(board.pursuer_scores, _words(PURSUERS, plan))}
<h2>Evaders</h2>{_scores(board.evader_scores, _words(EVADERS, plan))}
<p>How to read it: who has 100 points of rating more than another wins 64 of 100 games where the other wins
50, 400 points more: 91. A bar is the interval that holds 95 % of the ratings of games drawn again; of two
whose bars overlap neither is shown to be better. 0 is the mean of a side. Points are the share of the games
won, a draw being half a game.</p>
<p>The pursuers win by capture or by denying the target, the evader by arriving or, where there is no target,
by escaping; an escape that has a target is a draw. Ratings are on Elo's scale by the model of Bradley and
Terry with a term for each scenario.</p>
<h2>Captured, over all scenarios</h2>
<p>The share of its games in which a strategy of the pursuers (a row) captures an evader (a column).</p>
{_matrix(board, None)}
<h2>Scenario by scenario</h2>{details}
<h2>Played with</h2>
<p><code>sim-bridge bench</code> of {escape(versions)}; sources
<code>{plan.fingerprint.sources[:16]}</code>{escape(foreign)}.</p>
</html>
"""


def _counted(count: int, word: str) -> str:
    """`1 game`, `2 games`; `strategies of the evader`."""
    first, _, rest = word.partition(" ")
    more = f"{first[:-1]}ies" if first.endswith("y") else f"{first}s"
    return f"{count} {first if count == 1 else more} {rest}".rstrip()


def _told(one: Chosen) -> str:
    """A scenario in words: its short name and what it is."""
    words: str = one.data.get("description") or one.data["name"]
    return words if words.startswith(f"{one.label}:") else f"{one.label}: {words}"


def _words(known: Mapping[str, NamedPursuer | NamedEvader], plan: Plan) -> dict[str, str]:
    """What each strategy does, in a line; of a plug-in whose it is."""
    foreign = {name: f"of {told.rpartition(' ')[0]}" for name, told in plan.fingerprint.plugins.items()}
    return foreign | {name: one.words for name, one in known.items()}


def _scores(scores: list[Score], words: Mapping[str, str]) -> str:
    low = min(score.low for score in scores)
    span = max(max(score.high for score in scores) - low, 1.0)

    def bar(score: Score) -> str:
        places = (score.low, score.high, score.rating, 0.0)
        a, b, m, mean = ((value - low) / span * (WIDTH - 10) + 5 for value in places)
        return (
            f'<svg width="{WIDTH}" height="14" role="img"'
            f' aria-label="{round(score.low)} to {round(score.high)}">'
            f'<line x1="{mean:.1f}" x2="{mean:.1f}" y1="0" y2="14" stroke="var(--faint)" stroke-width=".5"/>'
            f'<line x1="{a:.1f}" x2="{b:.1f}" y1="7" y2="7" stroke="var(--bar)" stroke-width="3"/>'
            f'<circle cx="{m:.1f}" cy="7" r="4.5" fill="var(--bar)"/></svg>'
        )

    rows = "".join(
        f"<tr><td><b>{escape(score.name)}</b><br><small>{escape(words.get(score.name, ''))}</small></td>"
        f"<td>{score.rating:+.0f}</td>"
        f"<td>({score.low:+.0f} … {score.high:+.0f})</td><td>{bar(score)}</td><td>{score.share:.1%}</td></tr>"
        for score in scores
    )
    head = "<tr><th>strategy</th><th>rating</th><th>95 %</th><th></th><th>points</th></tr>"
    return f'<div class="scroll"><table>{head}{rows}</table></div>'


def _matrix(board: Board, scenario: int | None) -> str:
    """Shares captured: a row a strategy of the pursuers, a column an evader, both best first."""
    shares: Array = board.captured.mean(axis=0) if scenario is None else board.captured[scenario]
    evaders = [score.name for score in board.evader_scores]
    head = "".join(f"<th>{escape(name)}</th>" for name in evaders)
    rows = ""
    for score in board.pursuer_scores:
        cells = ""
        for name in evaders:
            share = float(shares[board.evaders.index(name), board.pursuers.index(score.name)])
            ink = "#fff" if share > 0.8 else "#111"
            cells += f'<td style="background:{_shade(share)};color:{ink}">{share:.0%}</td>'
        rows += f"<tr><td>{escape(score.name)}</td>{cells}</tr>"
    corner = "pursuers \\ evader"
    return f'<div class="scroll"><table class="matrix"><tr><th>{corner}</th>{head}</tr>{rows}</table></div>'


def _shade(share: float) -> str:
    mixed = (round(a + (b - a) * share) for a, b in zip(LOW, HIGH, strict=True))
    return "rgb({},{},{})".format(*mixed)


def as_json(plan: Plan, board: Board, commitment: str) -> bytes:
    """The same for programs: ratings, and the shares of every scenario and pair."""
    rounded = {
        name: np.round(values, 6).tolist()
        for name, values in (("evaders_points", board.points), ("captured", board.captured))
    }
    data = {
        "scenarios": board.scenarios, "evaders": board.evaders, "pursuers": board.pursuers,
        "games": board.games, "key_sha256": commitment, "sources": plan.fingerprint.sources,
        "versions": plan.fingerprint.versions, "plugins": plan.fingerprint.plugins,
        "pursuer_ratings": [_plain(score) for score in board.pursuer_scores],
        "evader_ratings": [_plain(score) for score in board.evader_scores],
        **rounded,
    }  # fmt: skip
    return msgspec.json.format(msgspec.json.encode(data), indent=1) + b"\n"


def _plain(score: Score) -> dict[str, object]:
    return {name: value if isinstance(value, str) else round(value, 1 if name != "share" else 6)
            for name, value in score._asdict().items()}  # fmt: skip


def text(board: Board) -> str:
    """The ratings for a terminal."""
    lines = []
    for side, scores in (("pursuers", board.pursuer_scores), ("evaders", board.evader_scores)):
        width = max(len(side), *(len(score.name) for score in scores))
        lines.append(f"{side:<{width}}  rating  95 %             points")
        lines += [
            f"{s.name:<{width}}  {s.rating:+6.0f}  {f'({s.low:+.0f} … {s.high:+.0f})':<15}  {s.share:6.1%}"
            for s in scores
        ]
        lines.append("")
    return "\n".join(lines[:-1])
