"""What mypy checks of `new(Kind, (…))`, as it does of `Kind(…)`: how many fields, and of which types."""

from __future__ import annotations

from collections.abc import Callable

from mypy.errorcodes import CALL_ARG
from mypy.plugin import MethodContext, Plugin
from mypy.subtypes import is_subtype
from mypy.types import AnyType, CallableType, Instance, TupleType, Type, get_proper_type

NEW = "onboard.core.math.each.New.__call__"


def _checked(context: MethodContext) -> Type:
    """The type of a call of `new`; what is wrong with it is said."""
    if not all(context.arg_types):
        return context.default_return_type  # too few arguments: mypy has said so
    kind, fields = (get_proper_type(one[0]) for one in context.arg_types)
    made = get_proper_type(kind.ret_type) if isinstance(kind, CallableType) else None
    if not isinstance(made, TupleType) or not isinstance(made.partial_fallback, Instance):
        context.api.fail("new: the first argument is no NamedTuple", context.context, code=CALL_ARG)
        return context.default_return_type
    name, wanted = made.partial_fallback.type.name, made.items
    if not isinstance(fields, TupleType):
        return context.default_return_type if isinstance(fields, AnyType) else _unknown(context, name)
    if len(fields.items) != len(wanted):
        text = f"new({name}, …): found {len(fields.items)} fields, expected {len(wanted)}"
        context.api.fail(text, context.context, code=CALL_ARG)
        return context.default_return_type
    for number, (found, expected) in enumerate(zip(fields.items, wanted, strict=True), 1):
        if not is_subtype(found, expected):
            text = f"new({name}, …): field {number} is {found}, expected {expected}"
            context.api.fail(text, context.context, code=CALL_ARG)
    return context.default_return_type


def _unknown(context: MethodContext, name: str) -> Type:
    context.api.fail(f"new({name}, …): how many fields it gives is not known", context.context, code=CALL_ARG)
    return context.default_return_type


class _NewIsChecked(Plugin):
    def get_method_hook(self, fullname: str) -> Callable[[MethodContext], Type] | None:
        return _checked if fullname == NEW else None


def plugin(_version: str) -> type[Plugin]:
    """Mypy's way in."""
    return _NewIsChecked
