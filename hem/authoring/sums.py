"""Sums of positions, in compiled code four numbers at once: x, y, z, and how many there are.

To add three numbers one by one takes nine instructions, in a vector of the processor three. Python
runs the same with tuples. The compiler would find such vectors by itself, but what finds them has
been wrong so often that Numba leaves it out.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, models, overload, register_model

from hem.arrays import Array

Sum = Any
"""A vector in compiled code; to Python a tuple of four."""

_DOUBLES, _FLOATS = (ir.VectorType(it, 4) for it in (ir.DoubleType(), ir.FloatType()))
_LOAD = "llvm.masked.load.v4f32.p0"


def nothing() -> Sum:
    """The sum of no positions."""
    return 0.0, 0.0, 0.0, 0.0


def position(rows: Array, i: int) -> Sum:
    """Row i of (n, 3) float32, as the sum of one."""
    x, y, z = rows[i].tolist()
    return x, y, z, 1.0


def plus(one: Sum, other: Sum) -> Sum:
    """Both together, in float64."""
    return one[0] + other[0], one[1] + other[1], one[2] + other[2], one[3] + other[3]


def add_to(rows: Array, i: int, more: Sum) -> None:
    """Add a sum to row i of (n, 4) float64."""
    rows[i] += more


def parts(total: Sum) -> tuple[float, float, float, float]:
    """x, y and z of a sum, and of how many it is."""
    x, y, z, n = total
    return x, y, z, n


class _SumType(types.Type):  # type: ignore[misc]
    """What Numba takes a sum for."""

    def __init__(self) -> None:
        super().__init__(name="Sum")


_SUM = _SumType()


@register_model(_SumType)
class _SumModel(models.PrimitiveModel):  # type: ignore[misc]
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _DOUBLES)


def _row(context: Any, builder: Any, kind: Any, rows: Any, i: Any, columns: int) -> Any:
    """Where a row of an array begins."""
    data = context.make_array(kind)(context, builder, rows).data
    wide = builder.zext(i, ir.IntType(64)) if i.type.width < 64 else i
    return builder.gep(data, [builder.mul(wide, ir.Constant(ir.IntType(64), columns))])


@intrinsic
def _nothing(typing: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        return ir.Constant(_DOUBLES, [0.0] * 4)

    return _SUM(), generate


@intrinsic
def _position(typing: Any, rows: Any, i: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows, i = given
        row = _row(context, builder, signature.args[0], rows, i, 3)
        # What lies behind the row is not read, as it may be the end of all memory there is.
        pointer, mask = _FLOATS.as_pointer(), ir.VectorType(ir.IntType(1), 4)
        kind = ir.FunctionType(_FLOATS, [pointer, ir.IntType(32), mask, _FLOATS])
        load = builder.module.globals.get(_LOAD) or ir.Function(builder.module, kind, _LOAD)
        own = ir.Constant(mask, [1, 1, 1, 0]), ir.Constant(_FLOATS, [0.0, 0.0, 0.0, 1.0])
        align = ir.Constant(ir.IntType(32), 4)
        return builder.fpext(
            builder.call(load, [builder.bitcast(row, pointer), align, *own]), _DOUBLES
        )

    return _SUM(rows, i), generate


@intrinsic
def _plus(typing: Any, one: Any, other: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        return builder.fadd(*given)

    return _SUM(one, other), generate


@intrinsic
def _add_to(typing: Any, rows: Any, i: Any, more: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        rows, i, more = given
        row = _row(context, builder, signature.args[0], rows, i, 4)
        place = builder.bitcast(row, _DOUBLES.as_pointer())
        builder.store(builder.fadd(builder.load(place, align=8), more), place, align=8)
        return context.get_dummy_value()

    return types.none(rows, i, more), generate


@intrinsic
def _parts(typing: Any, total: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, given: Any) -> Any:
        each = [builder.extract_element(given[0], ir.Constant(ir.IntType(32), k)) for k in range(4)]
        return context.make_tuple(builder, signature.return_type, each)

    return types.UniTuple(types.float64, 4)(total), generate


for _python, _compiled in (
    (nothing, lambda: lambda: _nothing()),
    (position, lambda rows, i: lambda rows, i: _position(rows, i)),
    (plus, lambda one, other: lambda one, other: _plus(one, other)),
    (add_to, lambda rows, i, more: lambda rows, i, more: _add_to(rows, i, more)),
    (parts, lambda total: lambda total: _parts(total)),
):
    overload(_python, inline="always")(_compiled)
