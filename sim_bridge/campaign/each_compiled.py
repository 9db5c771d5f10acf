"""The compiled forms of `onboard.core.math.each`: calls one after another of few items, of many a loop.

Written out for many items a strategy would stand in the kernel once for every pursuer, and take minutes to
compile. Short functions are written out however many items there are: a loop fills an array and fetches the
tuple from it, which costs more than what they do.
"""

from __future__ import annotations

from functools import cache
from types import FunctionType
from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.errors import TypingError
from numba.core.imputils import impl_ret_borrowed
from numba.core.typing import templates
from numba.core.typing.templates import signature as typed_signature

from onboard.core.math import each as each_module

signature: Any = typed_signature
kinds: Any = types
build: Any = cgutils
library: Any = templates
borrowed: Any = impl_ret_borrowed

WRITTEN_OUT = 6  # items up to which the calls are written out: what they have in common is then reckoned once
SHORT = 640  # bytes of bytecode, of all functions that are called in turn, up to which they are in any case


def _call_of(context: Any, function: Any, tuples: tuple[Any, ...], shared: Any) -> Any:
    """The signature of one call; None where the function does not take these types."""
    index = [types.intp] if len(tuples) == 1 else []
    return function.get_call_type(context, (*(one.dtype for one in tuples), *index, shared), {})


def _linked(context: Any, function: Any, call: Any) -> Any:
    """The function as code, of one call's signature."""
    compiled = context.get_function(function, call)
    for part in getattr(compiled, "libs", ()):
        context.active_code_library.add_linking_library(part)
    return compiled


def _results(context: Any, builder: Any, function: Any, call: Any, values: list[Any], count: int) -> Any:
    """The code that makes all results, a tuple of them; `values` are the tuples and what is shared."""
    if count > WRITTEN_OUT and not _is_short(function):
        return builder.load(_filled(context, builder, function, call, values, count))
    compiled = _linked(context, function, call)
    found = []
    for k in range(count):
        items = [builder.extract_value(value, k) for value in values[:-1]]
        index = [context.get_constant(types.intp, k)] if len(items) == 1 else []
        found.append(compiled(builder, (*items, *index, values[-1])))
    return context.make_tuple(builder, kinds.UniTuple(call.return_type, count), found)


def _is_short(function: Any) -> bool:
    """Whether a function, as numba knows it, is short with all that it calls."""
    found: set[FunctionType] = set()
    asked = [getattr(function, "typing_key", None)]
    while asked:
        one = asked.pop()
        if isinstance(one, FunctionType) and one not in found:
            found.add(one)
            asked += [one.__globals__.get(name) for name in one.__code__.co_names]
            asked += [cell.cell_contents for cell in one.__closure__ or ()]
    return 0 < sum(len(one.__code__.co_code) for one in found) <= SHORT


def _filled(context: Any, builder: Any, function: Any, call: Any, values: list[Any], count: int) -> Any:
    """The code of the loop that makes them; a pointer to the tuple on the stack."""
    compiled = _linked(context, function, call)
    places = [build.alloca_once_value(builder, value) for value in values[:-1]]
    results = build.alloca_once(builder, context.get_value_type(kinds.UniTuple(call.return_type, count)))
    zero = context.get_constant(types.intp, 0)
    with build.for_range(builder, context.get_constant(types.intp, count)) as loop:
        items = [builder.load(builder.gep(place, [zero, loop.index])) for place in places]
        index = [loop.index] if len(items) == 1 else []
        result = compiled(builder, (*items, *index, values[-1]))
        builder.store(result, builder.gep(results, [zero, loop.index]))
    return results


def _new(context, kind, fields):  # type: ignore[no-untyped-def]
    """`new`: what a call of the class makes."""
    parts = tuple(kinds.unliteral(one) for one in fields.types)
    made = kinds.BaseTuple.from_types(parts, kind.instance_class)

    def code(context, builder, _signature, values):  # type: ignore[no-untyped-def]
        found = [
            context.cast(builder, builder.extract_value(values[1], k), one, part)
            for k, (one, part) in enumerate(zip(fields.types, parts, strict=True))
        ]
        return borrowed(context, builder, made, context.make_tuple(builder, made, found))

    return signature(made, kind, fields), code


def _each(context, function, items, shared):  # type: ignore[no-untyped-def]
    """`each`."""
    if _empty(items):
        return signature(kinds.Tuple(()), function, items, shared), _nothing
    call = _call_of(context, function, (items,), shared)

    def code(context, builder, _signature, values):  # type: ignore[no-untyped-def]
        return _results(context, builder, function, call, list(values[1:]), items.count)

    return signature(kinds.UniTuple(call.return_type, items.count), function, items, shared), code


def _each_pair(context, function, items, others, shared):  # type: ignore[no-untyped-def]
    """`each_pair`."""
    if _empty(items):
        return signature(kinds.Tuple(()), function, items, others, shared), _nothing
    call = _call_of(context, function, (items, others), shared)

    def code(context, builder, _signature, values):  # type: ignore[no-untyped-def]
        return _results(context, builder, function, call, list(values[1:]), items.count)

    return signature(kinds.UniTuple(call.return_type, items.count), function, items, others, shared), code


def _table(context, function, items, shared):  # type: ignore[no-untyped-def]
    """`table`: a pointer to the first result."""
    if _empty(items):
        raise TypingError("table: found no items, expected one or more")
    call = _call_of(context, function, (items,), shared)

    def code(context, builder, _signature, values):  # type: ignore[no-untyped-def]
        results = _filled(context, builder, function, call, list(values[1:]), items.count)
        zero = context.get_constant(types.intp, 0)
        return builder.gep(results, [zero, zero])

    return signature(kinds.CPointer(call.return_type), function, items, shared), code


def _room(context, value, items):  # type: ignore[no-untyped-def]
    """`room`: a pointer to the first place."""

    def code(context, builder, _signature, _values):  # type: ignore[no-untyped-def]
        return build.alloca_once(builder, context.get_data_type(value), size=max(1, items.count**2))

    return signature(kinds.CPointer(value), value, items), code


def _each_at_once(context, function, at_once, items, shared):  # type: ignore[no-untyped-def]
    """`each_at_once`: a call of the second function."""
    if _empty(items):
        return signature(kinds.Tuple(()), function, at_once, items, shared), _nothing
    return _one_of(context, (function, at_once), 1, items, shared)


def _few_or_many(context, few, few_compiled, many, items, shared):  # type: ignore[no-untyped-def]
    """`few_or_many`: a call of one of them."""
    count = len(items)
    which = 2 if count >= each_module.MANY else min(count, 1)
    return _one_of(context, (few, few_compiled, many), which, items, shared)


def _some_or_none(context, some, none, items, shared):  # type: ignore[no-untyped-def]
    """`some_or_none`: a call of one of them."""
    return _one_of(context, (some, none), int(_empty(items)), items, shared)


def _one_of(context: Any, functions: tuple[Any, ...], which: int, items: Any, shared: Any) -> Any:
    """A call of one of some functions, which is known when it is compiled."""
    function = functions[which]
    call = function.get_call_type(context, (items, shared), {})

    def code(context, builder, _signature, values):  # type: ignore[no-untyped-def]
        return _linked(context, function, call)(builder, tuple(values[-2:]))

    return signature(call.return_type, *functions, items, shared), code


def _roots(context, values):  # type: ignore[no-untyped-def]
    """`roots`: of a vector."""

    def code(context, builder, _signature, given):  # type: ignore[no-untyped-def]
        vector = _vector(builder, given[0], values.count)
        kind = ir.FunctionType(vector.type, [vector.type])
        root = build.get_or_insert_function(builder.module, kind, f"llvm.sqrt.v{values.count}f64")
        return _tuple_of(context, builder, values, builder.call(root, [vector]))

    return signature(values, values), code


def _inverses(context, values):  # type: ignore[no-untyped-def]
    """`inverses`: of a vector."""

    def code(context, builder, _signature, given):  # type: ignore[no-untyped-def]
        vector = _vector(builder, given[0], values.count)
        one = ir.Constant(vector.type, [1.0] * values.count)
        return _tuple_of(context, builder, values, builder.fdiv(one, vector))

    return signature(values, values), code


def _vector(builder: Any, given: Any, count: int) -> Any:
    """A tuple of floats as a vector."""
    found = ir.Constant(ir.VectorType(ir.DoubleType(), count), ir.Undefined)
    for k in range(count):
        found = builder.insert_element(found, builder.extract_value(given, k), ir.IntType(32)(k))
    return found


def _tuple_of(context: Any, builder: Any, kind: Any, vector: Any) -> Any:
    """A vector as a tuple of floats."""
    parts = [builder.extract_element(vector, ir.IntType(32)(k)) for k in range(kind.count)]
    return context.make_tuple(builder, kind, parts)


def _empty(items: Any) -> bool:
    return len(items) == 0


def _nothing(context: Any, builder: Any, call: Any, _values: Any) -> Any:
    return context.make_tuple(builder, call.return_type, ())


@cache
def compile_each() -> None:
    """Give numba the compiled forms of its functions; idempotent.

    They become code where they are called, not functions that are called: else the array of `table` would
    end before it is used.
    """
    forms = (
        (each_module.new, _new),
        (each_module.each, _each),
        (each_module.each_pair, _each_pair),
        (each_module.table, _table),
        (each_module.each_at_once, _each_at_once),
        (each_module.few_or_many, _few_or_many),
        (each_module.room, _room),
        (each_module.some_or_none, _some_or_none),
        (each_module.roots, _roots),
        (each_module.inverses, _inverses),
    )
    for function, made in forms:
        template = library.make_intrinsic_template(function, made, made.__name__[1:])
        library.infer(template)
        library.infer_global(function, types.Function(template))
