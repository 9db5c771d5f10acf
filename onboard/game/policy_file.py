"""Files of trained policies: NumPy's `.npz`, read without executing anything of it.

A file holds `format` (1), `role` ("pursuer" or "evader"), `axes`, `steering` and `squash` by the names of the
core's enumerations in small letters, `planar`, `acceleration` [m/s²], `dt` [s], `scale` (what each number of
an observation is divided by), and `w0`, `b0`, `w1`, `b1`, …: matrices (outputs, inputs) and biases. The
outputs are the action. `policy:FILE` names such a strategy.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from onboard.config.strict import ConfigError
from onboard.core.strategy.features import (
    Axes,
    Form,
    Steering,
    action_width,
    dimensions,
    evader_width,
    pursuer_width,
)
from onboard.core.strategy.policy import Net, Squash, evader_policy, pursuer_policy

PREFIX = "policy:"
FORMAT = 1
LAYERS = 8  # at most
WIDTH = 512  # of a layer, at most
ACCELERATION_MAX = 1000.0  # [m/s²]

Array = NDArray[np.float64]


class Policy(NamedTuple):
    """A policy as it stands in a file."""

    role: str  # "pursuer" or "evader"
    form: Form
    squash: Squash
    scale: Array  # (inputs,)
    layers: tuple[tuple[Array, Array], ...]  # matrix (outputs, inputs) and bias


def save(path: Path, policy: Policy) -> None:
    """Write a policy's file. Raises ConfigError for one that `load` would refuse, OSError."""
    _demand_fits(policy, str(path))
    form = policy.form
    layers: dict[str, Any] = {}
    for k, (matrix, bias) in enumerate(policy.layers):
        layers |= {f"w{k}": matrix.astype(np.float32), f"b{k}": bias.astype(np.float32)}
    with path.open("wb") as file:
        np.savez_compressed(
            file, format=FORMAT, role=policy.role, axes=Axes(form.axes).name.lower(),
            steering=Steering(form.steering).name.lower(), squash=Squash(policy.squash).name.lower(),
            planar=form.planar, acceleration=form.acceleration, dt=form.dt, scale=policy.scale, **layers,
        )  # fmt: skip


def load(path: Path) -> Policy:
    """Read a policy's file. Raises ConfigError that names the file, the key, what was found and expected."""
    from zipfile import BadZipFile  # with five compressors: for who has a policy

    try:
        found = np.load(path, allow_pickle=False)
        if isinstance(found, np.ndarray):
            raise ConfigError(f"{path}: found one array, expected a policy's .npz")
        with found as data:
            content = {key: data[key] for key in data.files}
    except OSError as error:
        raise ConfigError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    except (ValueError, EOFError, KeyError, BadZipFile) as error:
        raise ConfigError(f"{path}: found no policy, expected NumPy's .npz: {error}") from None
    read = _Reader(str(path), content)
    if read.number("format", 1, 1) != FORMAT:
        raise ConfigError(f"{path}: format: expected {FORMAT}")
    form = Form(
        Axes[read.word("axes", [one.name.lower() for one in Axes]).upper()],
        Steering[read.word("steering", [one.name.lower() for one in Steering]).upper()],
        bool(read.number("planar", 0, 1)),
        read.number("acceleration", 0.0, ACCELERATION_MAX),
        read.number("dt", 1e-4, 10.0),
    )
    role = read.word("role", ["pursuer", "evader"])
    squash = Squash[read.word("squash", [one.name.lower() for one in Squash]).upper()]
    policy = Policy(role, form, squash, read.numbers("scale", 1), read.layers())
    read.demand_nothing_else()
    _demand_fits(policy, str(path))
    return policy


def is_policy(name: str) -> bool:
    """Whether a strategy's name means a policy's file."""
    return name.startswith(PREFIX)


def strategy(name: str, role: str) -> Any:
    """The strategy of the name `policy:FILE` for a role. Raises ConfigError.

    Its attribute `kernel` is the same strategy over arrays, as compiled games take it.
    """
    path = Path(name.removeprefix(PREFIX)).absolute()
    try:
        changed = path.stat().st_mtime_ns
    except OSError as error:
        raise ConfigError(f"strategy: {path}: {(error.strerror or str(error)).lower()}") from None
    return _strategy(path, changed, role)


@cache
def _strategy(path: Path, _changed: int, role: str) -> Any:
    policy = load(path)
    if policy.role != role:
        raise ConfigError(f"strategy: {path} is for the role '{policy.role}', expected '{role}'")
    form = policy.form
    # Plain numbers: members of enumerations are for people.
    plain = form._replace(axes=int(form.axes), steering=int(form.steering))  # type: ignore[arg-type]
    sizes = (len(policy.scale), *(len(bias) for _, bias in policy.layers))
    net = Net(sizes, int(policy.squash))  # type: ignore[arg-type]
    weights: Any = flat(policy)
    make = pursuer_policy if role == "pursuer" else evader_policy
    decide: Any = make(net, plain, weights.tolist())
    decide.kernel = make(net, plain, weights)
    return decide


def flat(policy: Policy) -> Array:
    """All weights in the kernel's order, the scale of the observation within the first matrix."""
    parts = []
    for k, (matrix, bias) in enumerate(policy.layers):
        parts += [(matrix / policy.scale if k == 0 else matrix).ravel(), bias]
    return np.concatenate(parts)


def _demand_fits(policy: Policy, name: str) -> None:
    form = policy.form
    sizes = [len(policy.scale)]
    for k, (matrix, bias) in enumerate(policy.layers):
        if matrix.shape != (len(bias), sizes[-1]):
            raise ConfigError(
                f"{name}: w{k}: found the shape {matrix.shape}, expected {(len(bias), sizes[-1])}"
            )
        sizes.append(len(bias))
    for key, array in [("scale", policy.scale), *((f"w{k}, b{k}", a) for k, pair in enumerate(policy.layers)
                                                 for a in pair)]:  # fmt: skip
        if not np.isfinite(array).all():
            raise ConfigError(f"{name}: {key}: found a number that is not finite")
    if not np.all(policy.scale > 0.0):
        raise ConfigError(f"{name}: scale: found {policy.scale.min():g}, expected numbers above 0")
    if sizes[-1] != action_width(form):
        last, wanted = len(sizes) - 2, action_width(form)
        raise ConfigError(f"{name}: b{last}: found {sizes[-1]} outputs, expected {wanted}")
    wanted = pursuer_width(form)
    if policy.role == "evader":
        each = evader_width(form, 1) - evader_width(form, 0)
        rest = sizes[0] - evader_width(form, 0)
        wanted = sizes[0] if rest > 0 and rest % each == 0 else evader_width(form, 1)
    if sizes[0] != wanted:
        who = f"a {policy.role} with {dimensions(form)} axes"
        raise ConfigError(f"{name}: scale: found {sizes[0]} inputs, expected {wanted} of {who}")


class _Reader:
    """The values of a file by key, each looked at once."""

    def __init__(self, name: str, content: dict[str, Any]) -> None:
        self._name, self._left = name, content

    def _take(self, key: str) -> Any:
        if key not in self._left:
            raise ConfigError(f"{self._name}: {key}: found none, expected a value")
        return self._left.pop(key)

    def word(self, key: str, known: list[str]) -> str:
        found = self._take(key)
        text = str(found.item()) if found.shape == () and found.dtype.kind == "U" else repr(found)
        if text not in known:
            words = ", ".join(known)
            raise ConfigError(f"{self._name}: {key}: found {text[:40]!r}, expected one of: {words}")
        return text

    def number(self, key: str, low: float, high: float) -> float:
        found = self._take(key)
        if found.shape != () or found.dtype.kind not in "biuf" or not low <= float(found) <= high:
            raise ConfigError(f"{self._name}: {key}: found {str(found)[:40]}, expected {low:g} to {high:g}")
        return float(found)

    def numbers(self, key: str, axes: int) -> Array:
        found = self._take(key)
        if found.ndim != axes or found.dtype.kind not in "iuf" or not 0 < max(found.shape) <= WIDTH:
            what = f"found {found.dtype} of shape {found.shape}"
            raise ConfigError(f"{self._name}: {key}: {what}, expected {axes} dimensions of at most {WIDTH}")
        return np.asarray(found, dtype=np.float64)

    def layers(self) -> tuple[tuple[Array, Array], ...]:
        count = sum(1 for k in range(LAYERS) if f"w{k}" in self._left)
        if count == 0:
            raise ConfigError(f"{self._name}: w0: found none, expected a matrix")
        return tuple((self.numbers(f"w{k}", 2), self.numbers(f"b{k}", 1)) for k in range(count))

    def demand_nothing_else(self) -> None:
        if self._left:
            raise ConfigError(f"{self._name}: {sorted(self._left)[0]}: found, expected no such key")
