"""Where compiled kernels are kept; imports no numba, so that who finds nothing there has lost no time.

The folder is `apollonius/kernels` in `XDG_CACHE_HOME` (`~/.cache`), or that of the environment's
`APOLLONIUS_KERNELS`; `off` there keeps none.
"""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path

FOLDER = "APOLLONIUS_KERNELS"
OFF = "off"


def folder() -> Path | None:
    """Where kernels are kept; None: nowhere."""
    told = os.environ.get(FOLDER, "")
    if told == OFF:
        return None
    if told:
        return Path(told)
    home = os.environ.get("XDG_CACHE_HOME", "")
    if not os.path.isabs(home):  # as the XDG Base Directory Specification has it
        home = os.path.expanduser("~/.cache")
    return Path(home) / "apollonius" / "kernels" if os.path.isabs(home) else None


def any_kept(name: str) -> bool:
    """Whether numba is installed and some kernel of a function of this name is on disk."""
    home = folder()
    return home is not None and find_spec("numba") is not None and any(home.glob(f"{name}-*.kernel"))
