"""Strategies of a distribution of its own, made in a folder: what a plug-in may do to an agent."""

from __future__ import annotations

from pathlib import Path

MODULE = """
import os, sys, time
from onboard.core.strategy.pursuit import *
from onboard.core.strategy.registry import DEFAULT_PURSUER as DEFAULT
from onboard.core.strategy.registry import PURSUERS
own = PURSUERS[DEFAULT].decide
asked = 0

class Strategy:
    role = "pursuer"
    def __init__(self, act, after=2):
        self.act, self.after = act, after
    def decide(self, view):
        global asked
        asked += 1
        if asked > self.after:
            self.act()
        return own(view)

class Unspeakable(BaseException):
    def __str__(self):
        raise RuntimeError("words fail")

def fails(error):
    raise error

def loops():
    while True:
        pass

def eats():
    eaten = []
    while True:
        eaten.append(bytearray(64 << 20))

def forks():
    for _ in range(20):
        if os.fork() == 0:
            while True:
                time.sleep(1)
    while True:
        pass

def scribbles():
    print("\\x1b[2J", flush=True)
    os.write(1, b"\\xff" * 100)
    sys.stderr.write("\\x1b[2J")

good = Strategy(lambda: None)
exits = Strategy(lambda: sys.exit(3))
leaves = Strategy(lambda: os._exit(0))
loop = Strategy(loops)
hungry = Strategy(eats)
forking = Strategy(forks)
scribbler = Strategy(scribbles)
unspeakable = Strategy(lambda: fails(Unspeakable()))
escapes = Strategy(lambda: fails(ValueError("\\x1b[2J\\nforged line")))
closes = Strategy(lambda: os.closerange(0, 64))
"""
NAMES = (
    *("good", "exits", "leaves", "loop", "hungry", "forking", "scribbler", "unspeakable", "escapes"),
    "closes",
)
AT_IMPORT = {"exits_at_import": "import sys; sys.exit(5)", "hangs_at_import": "while True: pass"}


def install(folder: Path) -> None:
    """Make the distribution in a folder, which then belongs on the path of imports."""
    (folder / "wild_strategies.py").write_text(MODULE, encoding="utf-8")
    for name, text in AT_IMPORT.items():
        (folder / f"wild_{name}.py").write_text(text + "\n", encoding="utf-8")
    info = folder / "wild_strategies-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: wild-strategies\nVersion: 1.0\n", "utf-8")
    points = [f"{name} = wild_strategies:{name}" for name in NAMES]
    points += [f"{name} = wild_{name}:x" for name in AT_IMPORT]
    (info / "entry_points.txt").write_text(
        "[apollonius.strategies]\n" + "\n".join(points) + "\n", encoding="utf-8"
    )
