"""From one compiled kernel, four uses.

A kernel answers one query for one element: ``vertex_faces(m, v, out) -> count`` reads the records
``m``, writes the neighbors of ``v`` to ``out`` and tells how many there are. ``Uses`` derives

1. ``single``: one handle, called from Python;
2. ``batch``: many handles into offsets and values, in one compiled loop;
3. ``sweep``: the same loop with nothing kept, for timing;
4. ``work``: the same source, uncompiled, over arrays that count their reads.

An operation has two: ``perform``, for one or for many of them, and its work. An algorithm made of
queries and operations has one: ``run``.

The derived functions are cached on disk. Numba decides by the file of the function itself whether
its cache is stale, so their names carry a digest of the kernel's own file: an edited kernel never
meets old machine code. Kernels may therefore call only what stands in their own file, in
``hem.authoring.kernels``, ``hem.authoring.topology`` or ``hem.authoring.operations``.
"""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable
from functools import cache, cached_property
from pathlib import Path
from types import CellType, FunctionType
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hem.authoring import kernels, operations, topology
from hem.authoring.kernels import VALENCE, Array, Kernel
from hem.authoring.operations import WIDTH
from hem.authoring.topology import NEEDS_ROOM
from hem.edit import FACE
from hem.engine.pinned import loader

MODE, BEGIN, END = range(3)
"""The parts of a task."""

DO, CHECK, PERSIST = range(3)
"""What to do with operations: do them, only check them, or pass over those that are refused."""

# What the templates below call; bound anew for every query and operation of every structure.
_KERNEL: Kernel = len
_RECORDS: Callable[..., Any] = tuple
_LOAD: Callable[..., Any] = len
_EXISTS: Kernel = len
_EDGE_VERTICES: Kernel = len
_COORDINATE: Kernel = len


def _single(handle: int, address: int) -> int:
    arrays = _LOAD(address)
    m, out = _RECORDS(*arrays[:-1]), arrays[-1]
    if WIDTH * (m.counts[VALENCE] + 1) > len(out) or not _EXISTS(m, handle):
        return 0
    count: int = _KERNEL(m, handle, out)
    return count


def _perform(address: int) -> int:
    arrays = _LOAD(address)
    m = _RECORDS(*arrays[:-7])
    task, args, points, results, at, out, log = arrays[-7:]
    mode, end = task[MODE], task[END]
    log[0] = 0
    for i in range(task[BEGIN], end):
        results[i] = _KERNEL(m, args[i], points[i % len(points)], at, out, log, mode == CHECK)
        if results[i] == NEEDS_ROOM or (results[i] < 0 and mode == DO):
            return i
    return end


def _batch(handles: Array, offsets: Array, values: Array, width: int, *arrays: Array) -> Array:
    m = _RECORDS(*arrays)
    end = 0
    for i in range(len(handles)):
        offsets[i] = end
        if end + width > len(values):
            grown = np.empty(2 * len(values) + width, values.dtype)
            grown[:end] = values[:end]
            values = grown
        end += _KERNEL(m, handles[i], values[end:])
    return values[:end]


def _sweep(handles: Array, out: Array, *arrays: Array) -> int:
    m = _RECORDS(*arrays)
    checksum = 0
    for i in range(len(handles)):
        count = _KERNEL(m, handles[i], out)
        checksum += count
        if count > 0:
            checksum ^= out[count - 1]
    return checksum


def _copy_touched(
    touched: Array, points: Array, indices: Array, out: Array, *arrays: Array
) -> None:
    m = _RECORDS(*arrays)
    for entry in touched:
        index = entry >> 3
        if entry & 7 < FACE:
            for i in range(3):
                value = _COORDINATE(m, index, i)
                points[index, i] = value if not np.isnan(value) else 0
        elif _EXISTS(m, index):
            _KERNEL(m, index, out)
            indices[index, 0], indices[index, 1], indices[index, 2] = out[0], out[2], out[1]
        else:
            indices[index, 0], indices[index, 1], indices[index, 2] = 0, 0, 0


def _run(plan: Any, *arrays: Array) -> int:
    result: int = _KERNEL(_RECORDS(*arrays), plan)
    return result


def _find_edge(a: int, b: int, out: Array, vertices: Array, *arrays: Array) -> int:
    m = _RECORDS(*arrays)
    for i in range(_KERNEL(m, a, out)):
        _EDGE_VERTICES(m, out[i], vertices)
        if vertices[0] == b or vertices[1] == b:
            found: int = out[i]
            return found
    return -1


class Uses:
    """The uses of one query kernel on one kind of records (a ``NamedTuple`` of arrays)."""

    def __init__(self, kernel: Kernel, records: type[Any]) -> None:
        self._kernel, self._records = kernel, records
        self._by_kind: dict[Any, Callable[..., Any]] = {}

    def single(self, pinned: Any, exists: Kernel) -> Callable[[int, int], int]:
        """``single(handle, pinned.address) -> count``, for records and an ``out`` as these.

        The count is 0 also where ``exists(m, handle)`` is false, and where ``out`` is too small.
        """
        return self._bound(_single, pinned.kind, _EXISTS=exists)

    def perform(self, pinned: Any) -> Callable[[int], int]:
        """``perform(pinned.address) -> end``, for an operation.

        Pinned are the records and ``task`` (``MODE``, ``BEGIN``, ``END``), ``args`` (n, 3),
        ``points`` (n or 1, 3), ``results`` (n,), ``at``, ``out`` and ``log`` (see
        ``hem.authoring.operations``). Ends before the element that needs
        more room; if the mode is ``DO``, also before one that is refused. Codes of refusals are
        among the results. ``CHECK`` changes nothing. The log begins anew.
        """
        return self._bound(_perform, pinned.kind)

    def _bound(self, template: Kernel, kind: Any, **scope: Any) -> Callable[..., Any]:
        """``template`` for arrays pinned as this ``kind``; all structures of a kind share it."""
        if kind not in self._by_kind:
            load = loader(kind)
            self._by_kind[kind] = self._compiled(template, str(kind), _LOAD=load, **scope)
        return self._by_kind[kind]

    @cached_property
    def batch(self) -> Callable[..., Array]:
        """``batch(handles, offsets, values, width, *records) -> values``.

        ``offsets`` (n,) is filled. ``values`` is room to begin with, replaced by more where it is
        too small; ``width`` is the most neighbors that one element can have. What is returned is a
        view just as long as the answer.
        """
        return self._compiled(_batch)

    @cached_property
    def sweep(self) -> Callable[..., int]:
        """``sweep(handles, out, *records) -> checksum``; every answer overwrites the last."""
        return self._compiled(_sweep)

    def copy_touched(self, exists: Kernel, coordinate: Kernel) -> Callable[..., None]:
        """``copy(touched, points, indices, out, *records)``, from ``face_vertices``.

        Points and clockwise corners of what the log of an edit names; zeros for what is dead.
        """
        return self._compiled(_copy_touched, _EXISTS=exists, _COORDINATE=coordinate)

    @cached_property
    def run(self) -> Callable[..., int]:
        """``run(plan, *records) -> result``, for an algorithm ``kernel(m, plan)``."""
        return self._compiled(_run)

    @property
    def kernel(self) -> Kernel:
        """What it is the uses of."""
        return self._kernel

    def find_edge(self, edge_vertices: Kernel) -> Callable[..., int]:
        """``find_edge(a, b, out, vertices, *records) -> edge or -1``, from ``vertex_edges``."""
        return self._compiled(_find_edge, _EDGE_VERTICES=edge_vertices)

    def work(self, handles: Array, out: Array, records: tuple[Array, ...]) -> NDArray[np.int64]:
        """(n,) int64: how many array elements the kernel reads for each handle, exactly."""
        counters = [CountingArray(array) for array in records[:-1]]
        answer, m = interpreted(self._kernel), self._records(*counters, records[-1])
        totals = [0]
        for handle in handles.tolist():
            answer(m, handle, out)
            totals.append(sum(counter.accesses for counter in counters))
        return np.diff(totals)

    def operation_work(
        self, args: list[int], point: Array, out: Array, log: Any, records: tuple[Array, ...]
    ) -> tuple[int, int]:
        """Perform an operation uncompiled -> its result, and the elements it read and wrote.

        In scratch of Python's own numbers, where True and True are 2 as they are when compiled.
        """
        counters = [CountingArray(array) for array in records[:-1]]
        perform, m = interpreted(self._kernel), self._records(*counters, records[-1])
        result = int(perform(m, args, point, [0] * 6, out, log, False))
        return result, sum(counter.accesses for counter in counters)

    def _digest(self, variant: str) -> str:
        """Of the structure's file, of the parts that its kernels share, and of this file."""
        shared = kernels.__file__, topology.__file__, operations.__file__, __file__
        own = {inspect.getfile(it) for it in (self._records, _source(self._kernel))}
        files = (*sorted(own), *shared)
        sources = b"".join(Path(file).read_bytes() for file in files)
        return hashlib.blake2b(sources + variant.encode(), digest_size=6).hexdigest()

    def _compiled(self, template: Kernel, variant: str = "", **scope: Any) -> Callable[..., Any]:
        """``template`` with its free names bound to this kernel, compiled and cached on disk.

        ``variant`` tells apart what is bound otherwise than by the kernel.
        """
        scope = {"_KERNEL": self._kernel, "_RECORDS": self._records, **scope}
        function = FunctionType(template.__code__, {**template.__globals__, **scope})
        names = template, self._records, _source(self._kernel)
        function.__qualname__ = "_".join([*(it.__name__ for it in names), self._digest(variant)])
        nogil = template not in (_single, _perform)  # it would take longer than a query
        compiled: Callable[..., Any] = njit(cache=True, nogil=nogil)(function)
        return compiled


@njit(cache=True, nogil=True)
def move(values: Array, target: Array, begin: int) -> None:
    """Copy ``values`` to ``target[begin:]``, which may overlap them from below."""
    for i in range(len(values)):
        target[begin + i] = values[i]


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
    source = _source(function)
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


def _source(function: Any) -> Any:
    return getattr(function, "py_func", function)
