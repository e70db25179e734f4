"""NumPy arrays that compiled code makes for Python.

An array of Numba's own comes to Python with two objects more, which keep alive what it holds. That
takes longer than most queries do. NumPy's own function makes one that needs none, in a quarter of
the time.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
from llvmlite import binding, ir
from numba import types
from numba.core.cgutils import (
    alloca_once_value,
    get_or_insert_function,
    if_likely,
    is_not_null,
    raw_memcpy,
)
from numba.extending import box, intrinsic, models, register_model

NEW, KIND = "hem_PyArray_New", "hem_PyArray_Type"
TABLE = {NEW: 93, KIND: 2}
"""Their places in the table of NumPy's functions, where they have been since version 1.0."""

HEAD_BYTES = object.__basicsize__
"""What every object of Python begins with; of an array, the address of its data comes next."""


class _Fresh(types.Type):  # type: ignore[misc]
    """An array made by NumPy, to be returned at once: compiled code can do nothing else with it."""

    def __init__(self) -> None:
        super().__init__("fresh array of NumPy")


register_model(_Fresh)(models.OpaqueModel)


@box(_Fresh)
def _hand_over(kind: Any, made: Any, context: Any) -> Any:
    return made


def _name_for_the_linker() -> None:
    """By name also machine code that was kept on disk finds what it needs of NumPy."""
    kind = ctypes.PYFUNCTYPE(ctypes.c_void_p, ctypes.py_object, ctypes.c_char_p)
    pointer_of = kind(("PyCapsule_GetPointer", ctypes.pythonapi))
    capsule = np._core._multiarray_umath._ARRAY_API  # type: ignore[attr-defined]
    table = ctypes.cast(pointer_of(capsule, None), ctypes.POINTER(ctypes.c_void_p))
    for name, place in TABLE.items():
        binding.add_symbol(name, table[place])


_name_for_the_linker()


@intrinsic
def fresh(context: Any, values: Any, count: Any) -> Any:
    """A new array (count,) of the first of ``values``. Not for code that lets other threads run."""
    item, result = np.dtype(str(values.dtype)), _Fresh()

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        integer, size = ir.IntType(32), ir.IntType(64)
        pointer = ir.IntType(8).as_pointer()
        none, zero = pointer(None), integer(0)
        shape = alloca_once_value(builder, arguments[1])
        kind = ir.FunctionType(pointer, [])
        kind = builder.bitcast(get_or_insert_function(builder.module, kind, KIND), pointer)
        # The class, dimensions, type, strides, data, bytes per item, flags, what it is made like.
        given = kind, integer(1), shape, integer(item.num), none, none, zero, zero, none
        new = ir.FunctionType(pointer, [it.type for it in given])
        made = builder.call(get_or_insert_function(builder.module, new, NEW), given)
        with if_likely(builder, is_not_null(builder, made)):  # or Python raises a MemoryError
            place = builder.bitcast(builder.gep(made, [size(HEAD_BYTES)]), pointer.as_pointer())
            source = context.make_array(values)(context, builder, arguments[0]).data
            target, source = builder.load(place), builder.bitcast(source, pointer)
            raw_memcpy(builder, target, source, arguments[1], item.itemsize)
        return made

    return result(values, types.intp), generate
