"""A kernel is made machine code of once, whole; what it calls can be part of others, and of numba's own."""

from __future__ import annotations

import threading
from importlib.util import module_from_spec, spec_from_file_location
from math import sqrt
from pathlib import Path
from typing import Any

import numba
import pytest
from numba.core import codegen, cpu
from numba.core.errors import TypingError
from numba.extending import register_jitable

from sim_bridge.campaign import as_one
from sim_bridge.campaign.kernel_cache import kernel
from sim_bridge.campaign.kernel_folder import FOLDER, OFF


@register_jitable(forceinline=True, no_cfunc_wrapper=True)
def root(x: float) -> float:
    return sqrt(x)


@register_jitable(no_cfunc_wrapper=True)
def hypotenuse(x: float, y: float) -> float:
    return root(x * x + y * y)


def around(x: float, y: float) -> float:
    return x + y + hypotenuse(x, y)


def shorter(x: float, y: float) -> float:
    return x + y - hypotenuse(x, y)


def wrong(x: float) -> float:
    return hypotenuse(x, "east")  # type: ignore[arg-type]


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Libraries that machine code was made of, in this test alone and without a folder of kernels."""
    monkeypatch.setenv(FOLDER, OFF)
    found: list[str] = []
    library: Any = codegen.JITCodeLibrary
    make = library._finalize_specific

    def counted(self: Any) -> None:
        found.append(self.name)
        make(self)

    monkeypatch.setattr(library, "_finalize_specific", counted)
    return found


def test_machine_code_is_made_once_of_a_kernel_and_its_parts_serve_others(
    made: list[str],
) -> None:
    assert kernel(around)(3.0, 4.0) == 12.0
    assert [name.split(".")[-1] for name in made] == ["around"]
    assert kernel(shorter)(3.0, 4.0) == 2.0
    assert [name.split(".")[-1] for name in made] == ["around", "shorter"]
    assert numba.njit(lambda x, y: hypotenuse(x, y))(3.0, 4.0) == 5.0
    assert kernel(lambda x: root(x))(16.0) == 4.0


def test_a_kernel_that_another_calls_is_a_whole_of_its_own(made: list[str]) -> None:
    inner = kernel(around)
    assert kernel(lambda x: 2.0 * inner(x, x))(0.0) == 0.0
    assert inner(3.0, 4.0) == 12.0


def test_after_a_kernel_that_does_not_compile_numba_s_own_functions_run(made: list[str]) -> None:
    with pytest.raises(TypingError):
        kernel(wrong)(1.0)
    mine = numba.njit(lambda x: x + 1.0)
    assert mine(1.0) == 2.0
    assert mine(1) == 2


def test_what_another_thread_compiles_meanwhile_runs(made: list[str]) -> None:
    found: list[float] = []

    def others() -> None:
        for number in range(5):
            found.append(numba.njit(lambda x, number=number: x + number)(0.5))

    thread = threading.Thread(target=others)
    thread.start()
    for _ in range(3):
        assert kernel(around)(3.0, 4.0) == 12.0
    thread.join()
    assert found == [0.5, 1.5, 2.5, 3.5, 4.5]


def test_another_release_of_numba_is_left_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its inner names may be others: nothing is asked of them, nothing is put in their place."""
    assert as_one.KNOWN, "the release that is installed here is the one of the lock"
    finalize, executable = codegen.JITCodeLibrary.finalize, cpu.CPUContext.get_executable
    monkeypatch.setattr(numba, "__version__", "0.99.0")
    monkeypatch.delattr(cpu, "_dynfunc")
    spec = spec_from_file_location("as_one_of_another", Path(as_one.__file__))
    assert spec is not None
    assert spec.loader is not None
    other = module_from_spec(spec)
    spec.loader.exec_module(other)
    assert codegen.JITCodeLibrary.finalize is finalize
    assert cpu.CPUContext.get_executable is executable
    machine = numba.njit(lambda x: x + 1.0)
    compile_it = machine._compiler.compile
    other.as_one(machine)
    assert machine._compiler.compile == compile_it
