"""How work is counted: kernels as Python runs them, over arrays that count their reads."""

from __future__ import annotations

from functools import cache
from types import CellType, FunctionType
from typing import Any

import numpy as np

from hem.arrays import Array
from hem.authoring import Kernel


class CountingArray:
    """An array that counts how many of its elements are read or written, as Python numbers."""

    def __init__(self, array: Array) -> None:
        self._array = array
        self.accesses = 0

    def __getitem__(self, key: Any) -> Any:
        value = self._array[key]
        self.accesses += int(np.size(value))
        return value.item() if np.ndim(value) == 0 else value

    def __setitem__(self, key: Any, value: Any) -> None:
        self._array[key] = value
        self.accesses += int(np.size(value))

    def __len__(self) -> int:
        return len(self._array)

    @property
    def shape(self) -> tuple[int, ...]:
        """As the array's own; looking at it reads no element."""
        return self._array.shape


@cache
def interpreted(function: Kernel) -> Kernel:
    """The Python source of a compiled function, its compiled callees replaced by theirs as well."""
    source = source_of(function)
    scope = source.__globals__
    called = {name: scope[name] for name in source.__code__.co_names if name in scope}
    closure = tuple(CellType(_uncompiled(cell.cell_contents)) for cell in source.__closure__ or ())
    return FunctionType(
        source.__code__,
        {**scope, **{name: _uncompiled(value) for name, value in called.items()}},
        source.__name__,
        source.__defaults__,
        closure,
    )


def _uncompiled(value: Any) -> Any:
    return interpreted(value) if hasattr(value, "py_func") else value


def source_of(function: Any) -> Any:
    """The Python function that a kernel was compiled from."""
    return getattr(function, "py_func", function)
