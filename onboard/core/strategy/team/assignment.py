"""Who takes which task: the assignment of least total cost.

Kernel style but for local lists. The Hungarian method as shortest augmenting paths (Kuhn 1955; Jonker and
Volgenant 1987), cubic in the number of tasks.
"""

from __future__ import annotations

FAR = 1e30  # more than any path costs
FORBIDDEN = 1e12  # cost of a task that a member cannot do


def assigned(costs: list[float], members: int, tasks: int) -> list[int]:
    """The task of every member, each task done by one at most, so that the costs' sum is least.

    `costs` is row by row: member i pays costs[i * tasks + j] for task j. There must be at least as many
    tasks as members. Of equally cheap assignments the answer is always the same one.
    """
    price = [0.0] * (members + 1)
    rent = [0.0] * (tasks + 1)
    doer = [0] * (tasks + 1)  # member + 1 that does a task, 0 = nobody; doer[0] is the one being placed
    for member in range(1, members + 1):
        doer[0] = member
        _place(costs, tasks, price, rent, doer)
    found = [0] * members
    for task in range(1, tasks + 1):
        if doer[task] > 0:
            found[doer[task] - 1] = task - 1
    return found


def _place(costs: list[float], tasks: int, price: list[float], rent: list[float], doer: list[int]) -> None:
    """Give the member doer[0] a task along the cheapest path of exchanges. Changes its lists in place."""
    least = [FAR] * (tasks + 1)
    via = [0] * (tasks + 1)
    done = [False] * (tasks + 1)
    task = 0
    while True:
        done[task] = True
        member = doer[task]
        row = (member - 1) * tasks - 1
        step = FAR
        best = 0
        for other in range(1, tasks + 1):
            if done[other]:
                continue
            left = costs[row + other] - price[member] - rent[other]
            if left < least[other]:
                least[other] = left
                via[other] = task
            if least[other] < step:
                step = least[other]
                best = other
        for other in range(tasks + 1):
            if done[other]:
                price[doer[other]] += step
                rent[other] -= step
            else:
                least[other] -= step
        task = best
        if doer[task] == 0:
            break
    while task != 0:
        before = via[task]
        doer[task] = doer[before]
        task = before


def total(costs: list[float], tasks: int, found: list[int]) -> float:
    """What an assignment costs."""
    sum_ = 0.0
    for member in range(len(found)):
        sum_ += costs[member * tasks + found[member]]
    return sum_
