"""What kernels are made of: the compiler's decorator, and the parts that structures share.

A kernel answers one query for one element: ``vertex_faces(m, v, out) -> count`` reads the records
``m``, writes the neighbors of ``v`` to ``out`` and tells how many there are.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from types import FunctionType
from typing import Any

from numba import config, njit
from numba.core.registry import CPUDispatcher

from hem.arrays import Array

if config.DISABLE_JIT:  # with which functions that Numba makes are none of Python's
    raise ImportError(
        "meshes need Numba's compiler: unset NUMBA_DISABLE_JIT; Python runs the kernels of "
        "structures.build(…, compiled=False)"
    )

Kernel = Callable[..., Any]
Kernels = Mapping[str, Kernel]
"""The kernels of one structure, by name."""

WITHOUT_WRAPPERS = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Of what compiled code calls: what Python would call takes a third of the compiling."""


def _in_python(called: Any, *given: Any) -> Any:
    """Run the source, as there is nothing compiled that Python could call."""
    return called.py_func(*given)


_INSIDE = type("Inside", (CPUDispatcher,), {"__call__": _in_python})


def kernel(function: Kernel) -> Kernel:
    """Compile a kernel or a part of one, inlined wherever it is called.

    A call would push some forty fields of the records' arrays, which takes longer than most
    queries; an operation that is called takes up to four times as long. Called from Python it is
    run by Python.
    """
    compiled: Kernel = njit(forceinline=True, **WITHOUT_WRAPPERS)(function)
    compiled.__class__ = _INSIDE
    return compiled


VERTICES, EDGES, FACES, VERTEX_END, EDGE_END, FACE_END = range(6)
"""Columns of a structure's ``counts``: how many elements are live, and how many records are in use.

Live and dead elements lie before the end, room for new ones behind it.
"""

VERTEX_ROOM, EDGE_ROOM, FACE_ROOM, VALENCE, SIDES, EDGE_GROWTH = range(6, 12)
"""More columns: how many records there is room for, bounds on the valence of any vertex and on the
sides of any face, and how many records of edges a new face may need.

The bound on the valence is one on the sides as well: there is scratch for that many neighbors.
"""


def kernels_of(module: str) -> dict[str, Kernel]:
    """Every kernel in a module by its name: what is compiled, and functions defined there."""
    return {
        name: it
        for name, it in vars(sys.modules[module]).items()
        if hasattr(it, "py_func") or (isinstance(it, FunctionType) and it.__module__ == module)
    }


try:
    njit(cache=True)(kernels_of)  # is nothing to compile, but Numba looks where it could be kept
except RuntimeError as error:
    words = "set NUMBA_CACHE_DIR to a folder that can be written, where machine code is kept"
    raise ImportError(f"{words}: {error}") from error


@kernel
def without(out: Array, count: int, value: int) -> int:
    """Take ``value`` out of the first ``count`` elements, in place -> how many are left."""
    left = 0
    for i in range(count):
        if out[i] != value:
            out[left] = out[i]
            left += 1
    return left


@kernel
def append_face(out: Array, count: int, face: int) -> int:
    """Append a face beyond the next edge of a triangle, unless it was just met -> the new count.

    Two triangles that share two edges share all three, so the last one met is the only candidate.
    """
    if count and out[count - 1] == face:
        return count
    out[count] = face
    return count + 1


@kernel
def distinct(out: Array, count: int) -> int:
    """Keep each of the first ``count`` elements once, in order, in place -> how many are left.

    The next up to 4 · ``count`` elements of ``out`` serve as a hash table. Cost O(count) expected.
    """
    size = 1
    while size < 2 * count:
        size *= 2
    table = out[count : count + size]
    for i in range(size):
        table[i] = -1
    kept = 0
    for i in range(count):
        value = out[i]
        place = (value * 40503 + (value >> 16)) & (size - 1)
        while table[place] >= 0 and table[place] != value:
            place = (place + 1) & (size - 1)
        if table[place] < 0:
            table[place] = value
            out[kept] = value
            kept += 1
    return kept


FEW = 256
"""Pairs of elements that are compared sooner than a table is made."""


@kernel
def count_shared(out: Array, one: int, other: int) -> int:
    """How many of the first ``one`` elements are among the ``other`` after them; no two are alike.

    What follows in ``out`` is overwritten, and may be these. Cost O(one + other) expected.
    """
    if one * other > FEW:
        return one + other - int(distinct(out, one + other))
    count = 0
    for i in range(one):
        for j in range(one, one + other):
            count += out[i] == out[j]
    return count
