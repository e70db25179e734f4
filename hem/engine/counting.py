"""How work is counted: kernels as Python runs them, over arrays that count their reads."""

from __future__ import annotations

from dis import get_instructions
from functools import cache
from types import CellType, FunctionType
from typing import Any, NamedTuple

import numpy as np

from hem.arrays import Array
from hem.authoring import Kernel


class CountingArray:
    """An array that counts how many of its elements are read or written, as Python numbers.

    IndexError for a negative index, which compiled code takes for memory before the array.
    """

    def __init__(self, array: Array) -> None:
        self._array, self._elements = array, array.data  # whose numbers are Python's, in no time
        self.accesses = 0

    def __getitem__(self, key: Any) -> Any:
        if (key[0] if type(key) is tuple else key) < 0:
            _refuse(key)
        try:
            value = self._elements[key]
        except NotImplementedError:  # a row, and not an element
            value = self._array[key]
            self.accesses += value.size
            return value
        self.accesses += 1
        return value

    def __setitem__(self, key: Any, value: Any) -> None:
        if (key[0] if type(key) is tuple else key) < 0:
            _refuse(key)
        self._array[key] = value
        self.accesses += 1 if type(value) in (int, float) else int(np.size(value))

    def __len__(self) -> int:
        return len(self._array)

    @property
    def shape(self) -> tuple[int, ...]:
        """As the array's own; looking at it reads no element."""
        return self._array.shape


def _refuse(key: Any) -> None:
    raise IndexError(f"a kernel asks for {key}, which lies before the array")


def of_pythons_numbers(plan: Any) -> Any:
    """Integers of arrays become Python's own, which do not overflow and whose True is 1."""
    if isinstance(plan, tuple):
        return type(plan)(*map(of_pythons_numbers, plan))
    if not isinstance(plan, np.ndarray) or plan.dtype.kind not in "iub":
        return plan
    return plan.data if plan.ndim == 1 and plan.flags.c_contiguous else CountingArray(plan)


class Read(NamedTuple):
    """What a kernel reads at a time: a field by its name, of which record, and where in a wide one.

    Of an object that has no index, such as a list, the row is -1.
    """

    field: str
    row: int
    column: int = 0


class TracedArray(CountingArray):
    """An array that also keeps in order which of its elements are read, as keys in ``trace``."""

    def __init__(self, array: Array, name: str, trace: list[tuple[str, Any]]) -> None:
        super().__init__(array)
        self._name, self._trace = name, trace

    def __getitem__(self, key: Any) -> Any:
        self._trace.append((self._name, key))
        return super().__getitem__(key)


@cache
def interpreted(function: Kernel) -> Kernel:
    """The Python source of a compiled function, its compiled callees replaced by theirs as well."""
    source = source_of(function)
    scope = source.__globals__
    # Not co_names: what is an attribute there may be a global of the same name.
    named = {it.argval for it in get_instructions(source) if it.opname == "LOAD_GLOBAL"}
    called = {name: scope[name] for name in named if name in scope}
    closure = tuple(CellType(_uncompiled(cell.cell_contents)) for cell in source.__closure__ or ())
    return FunctionType(
        source.__code__,
        {**scope, **{name: _uncompiled(value) for name, value in called.items()}},
        source.__name__,
        source.__defaults__,
        closure,
    )


def _uncompiled(value: Any) -> Any:
    return interpreted(value) if is_compiled(value) else value


def is_compiled(value: Any) -> bool:
    """Whether it is a function that Numba compiles."""
    return hasattr(value, "py_func")


def source_of(function: Any) -> Any:
    """The Python function that a kernel was compiled from."""
    return getattr(function, "py_func", function)
