"""What a strategy is made of, where that is not the project's own."""

from __future__ import annotations

from types import FunctionType


def reached(
    function: FunctionType, ours: tuple[str, ...], seen: set[int] | None = None
) -> list[FunctionType]:
    """The functions of other distributions, and of users' files, that one reaches by its closures.

    `ours` begin the names of the modules whose functions are registered with them.
    """
    seen = set() if seen is None else seen
    found: list[FunctionType] = []
    for cell in function.__closure__ or ():
        part = cell.cell_contents
        if isinstance(part, FunctionType) and id(part) not in seen:
            seen.add(id(part))
            if not part.__module__.startswith(ours):
                found += [one for name in part.__code__.co_names
                          if isinstance(one := part.__globals__.get(name), FunctionType)]  # fmt: skip
                found.append(part)
            found += reached(part, ours, seen)
    return found
