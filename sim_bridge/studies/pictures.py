"""Matplotlib without a screen, and how the studies save their figures. Loaded at the first figure (0.5 s)."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def pyplot() -> Any:
    """The module matplotlib.pyplot, drawing into files; the same figure gives the same SVG."""
    import matplotlib

    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "apollonius"
    import matplotlib.pyplot as plt

    return plt


def save(figure: Any, path: Path, dpi: int = 110) -> Path:
    """Write a figure in the format that the path's ending names, undated, and make its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=dpi, metadata={"Date": None} if path.suffix == ".svg" else None)
    return path


def save_both(figure: Any, folder: Path, stem: str) -> list[Path]:
    """Write a figure as PNG and as SVG and close it; gives the paths."""
    written = [save(figure, folder / f"{stem}.{ending}") for ending in ("png", "svg")]
    pyplot().close(figure)
    return written
