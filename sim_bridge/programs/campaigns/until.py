"""When a campaign has seen enough: `ci<0.01`, judged after whole blocks of seeds, in order."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from typing import NamedTuple

from onboard.config.strict import ConfigError

Z = 1.959963984540054  # of the normal distribution at 97.5 %
_RULE = re.compile(
    r"\s*ci(?:\(\s*(captured|arrived|denied|escaped)\s*\))?\s*<\s*(0?\.\d+|\d+(?:\.\d+)?e-\d+)\s*"
)


class Until(NamedTuple):
    """A rule: half of Wilson's 95 % interval of a verdict's share is narrower than this in every cell."""

    verdict: str
    half_width: float


def parse(text: str) -> Until:
    """Read a rule. Raises ConfigError."""
    found = _RULE.fullmatch(text)
    if found is None or not 0.0 < float(found[2]) < 0.5:
        raise ConfigError(f"--until: found {text!r}, expected 'ci<0.01', or 'ci(arrived)<0.01', with a number"
                          " below 0.5")  # fmt: skip
    return Until(found[1] or "captured", float(found[2]))


def wilson(count: int, games: int) -> tuple[float, float]:
    """Wilson's 95 % confidence interval of a share."""
    if games == 0:
        return 0.0, 1.0
    share, z2 = count / games, Z * Z
    middle = (share + z2 / (2 * games)) / (1 + z2 / games)
    half = Z / (1 + z2 / games) * (share * (1 - share) / games + z2 / (4 * games * games)) ** 0.5
    return (0.0 if count == 0 else middle - half), (1.0 if count == games else middle + half)


def enough(rule: Until, seen: Mapping[int, Counter[str]]) -> bool:
    """Whether the rule holds in all cells, by how often each had each verdict."""
    for verdicts in seen.values():
        low, high = wilson(verdicts[rule.verdict], verdicts.total())
        if 0.5 * (high - low) >= rule.half_width:
            return False
    return True
