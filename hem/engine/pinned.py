"""Arrays that compiled code finds by one address.

Calling compiled code with arrays costs about 70 ns for each, nearly all of it to find out its type:
several times what a query takes. Arrays that stay where they are can be pinned once instead, and
from then on a call passes two integers.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, cached_property
from typing import Any

import numpy as np
from numba import typeof, types
from numba.core.cgutils import get_null_value
from numba.extending import intrinsic
from numpy.typing import NDArray

_kinds: dict[tuple[tuple[Any, int, int], ...], Any] = {}
"""By dtype, dimensions and flags of arrays their types."""


class Pinned:
    """Arrays described in memory just as Numba describes a tuple of arrays to itself.

    ``address`` is valid as long as this object lives, which keeps the arrays alive as well. They
    may be written to, but not be resized; others of the same types may take their place.
    """

    def __init__(self, *arrays: NDArray[Any]) -> None:
        self._arrays = arrays
        self._image = np.array([word for it in arrays for word in _described(it)], np.int64)
        self.address = int(self._image.ctypes.data)

    @cached_property
    def kind(self) -> Any:
        """Their types, as the compiler has them; found out once for all alike, in 300 µs."""
        told = tuple((array.dtype, array.ndim, array.flags.num) for array in self._arrays)
        if told not in _kinds:
            _kinds[told] = types.Tuple([typeof(array) for array in self._arrays])
        return _kinds[told]

    def replace(self, *arrays: NDArray[Any]) -> None:
        """Put others of the same types at the same address; to tell where one is takes 2 µs."""
        end = 0
        for here, array in zip(self._arrays, arrays, strict=True):
            begin, end = end, end + WORDS + 2 * array.ndim
            if array is not here:
                self._image[begin:end] = _described(array)
        self._arrays = arrays


WORDS = 5  # that describe an array beside its shape and strides


def _described(array: NDArray[Any]) -> tuple[int, ...]:
    """The fields of Numba's arrays: owner and parent (none), then where and how large it is."""
    data = int(array.ctypes.data)
    return (0, 0, array.size, array.itemsize, data, *array.shape, *array.strides)


Columns = tuple[int, ...]
"""How many columns each array of records has by its fields; 0 where they do not say."""


@cache
def loader(kind: Any, columns: Columns) -> Callable[[int], Any]:
    """Make ``load(address) -> arrays`` for compiled code, for arrays pinned as this ``kind``.

    The first of them are records with so many ``columns``.
    """

    def load(context: Any, address: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            described = context.get_value_type(kind)
            words = sum(WORDS + 2 * array.ndim for array in kind)
            if context.get_abi_sizeof(described) != 8 * words:
                raise TypeError("this version of Numba lays arrays out otherwise than hem expects")
            image = described.as_pointer()
            loaded = builder.load(builder.inttoptr(arguments[0], image))
            return _without_owner(context, builder, kind, loaded, columns)

        return kind(types.intp), generate

    loading: Callable[[int], Any] = intrinsic(load)
    return loading


@cache
def borrower(columns: Columns = ()) -> Callable[[Any], Any]:
    """Make ``borrowed(arrays)``: the same, of which compiled code counts no references.

    Whoever calls keeps them alive. To count takes longer than most steps, and is no use to them.
    """

    def borrow(context: Any, given: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return _without_owner(context, builder, given, arguments[0], columns)

        return given(given), generate

    borrowing: Callable[[Any], Any] = intrinsic(borrow)
    return borrowing


def _without_owner(context: Any, builder: Any, kind: Any, value: Any, columns: Columns = ()) -> Any:
    """A value whose arrays have neither an owner nor a parent, as the compiler can see.

    Of a tuple of records, with so many ``columns``, it can see more, see ``_as_records``.
    """
    if isinstance(kind, types.BaseTuple):
        for i, part in enumerate(kind):
            own = _without_owner(context, builder, part, builder.extract_value(value, i))
            if i < len(columns):
                own = _as_records(context, builder, part, own, columns[i])
            value = builder.insert_value(value, own, i)
    if isinstance(kind, types.Array):
        array = context.make_array(kind)(context, builder, value)
        array.meminfo = get_null_value(array.meminfo.type)
        array.parent = get_null_value(array.parent.type)
        return array._getvalue()
    if not isinstance(kind, types.BaseTuple):  # a list in a plan, say, of which references count
        context.nrt.incref(builder, kind, value)
    return value


def _as_records(context: Any, builder: Any, kind: Any, value: Any, columns: int) -> Any:
    """An array of records whose shape the compiler can see: no rows, and so many columns.

    A negative index counts from the end, and to look for one at every access takes longer than the
    access. Kernels use none, nor the number of rows: where that is zero, there is nothing to do. To
    find a row by a known number of columns takes one instruction, and else a product, on which
    every step of a walk would wait.
    """
    array = context.make_array(kind)(context, builder, value)
    known = [0, columns] if columns and kind.ndim == 2 else [0]
    for dimension, size in enumerate(known):
        constant = context.get_constant(types.intp, size)
        array.shape = builder.insert_value(array.shape, constant, dimension)
    return array._getvalue()
