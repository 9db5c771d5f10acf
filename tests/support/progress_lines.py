"""What long work says of itself on standard error, told apart from what a test asks for."""

from __future__ import annotations

import re

LINE = re.compile(r"^[\w. -]+: +\d+ % \(.*\)\n", re.M)


def without_progress(text: str) -> str:
    """The text without the lines that say how far work is: a slow machine has some, a quick one none."""
    return LINE.sub("", text)
