"""From one kernel, what is called: queries single and batched, operations, algorithms.

The derived functions are cached on disk. Numba decides by the file of the function itself whether
its cache is stale, so their names carry a digest of the files, code and constants that are baked
in: an edited kernel never meets old machine code.
"""

from __future__ import annotations

import hashlib
import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from enum import Enum, EnumType
from functools import cache, cached_property
from opcode import EXTENDED_ARG, opmap
from pathlib import Path
from types import CodeType, FunctionType, ModuleType, NoneType
from typing import Any

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from hem.arrays import Array
from hem.authoring import BLOCK, Field, Kernel, field_at
from hem.engine import templates
from hem.engine.counting import (
    CountingArray,
    Read,
    TracedArray,
    interpreted,
    is_compiled,
    source_of,
)
from hem.engine.fresh import fresh
from hem.engine.pinned import Columns, borrower, loader
from hem.engine.plans import everywhere

SHARED = ("edit.py", "authoring/**/*.py", "engine/*.py")
"""What every structure's machine code is made of, beside its own files."""


class Uses:
    """The uses of one kernel on one kind of records: a ``NamedTuple`` of arrays of ``columns``."""

    ahead = BLOCK
    """How many operations are prefetched at a time."""

    def __init__(self, kernel: Kernel, records: type[Any], columns: Columns) -> None:
        self._kernel, self._records, self._columns = kernel, records, columns
        self._made: dict[Any, Callable[..., Any]] = {}

    def single(self, pinned: Any, exists: Kernel) -> Callable[[int, Any], Array]:
        """``single(handle, pinned.address) -> neighbors``, for records and an ``out`` as these.

        There are none also where ``exists(m, handle)`` is false, and where ``out`` is too small.
        """
        return self._bound(templates.single, pinned.kind, _EXISTS=exists)

    def step(self, pinned: Any, exists: Kernel) -> Callable[[int, int], int]:
        """``step(handle, pinned.address) -> handle``, for a step from one element to another."""
        return self._bound(templates.step, pinned.kind, _EXISTS=exists)

    def walk(self, exists: Kernel) -> Callable[..., int]:
        """``walk(handles, found, *records) -> end``: a step from each, up to one that is none."""
        return self._compiled(templates.walk, _EXISTS=exists)

    def perform(self, pinned: Any, prefetch: Kernel) -> Callable[[int], Array]:
        """``perform(pinned.address) -> touched``, for an operation.

        Pinned are the records and ``task`` (``MODE``, ``BEGIN``, ``END``, ``LOGS``, ``AHEAD``,
        ``ENDED``), ``args`` (n, 3), ``points`` (n or 1, 3), ``results`` (n,), ``seen``, ``at``,
        ``out`` and ``log`` (see ``hem.authoring.operations``). Ends before the element that needs
        more room; if the mode is ``DO``, also before one that is refused. Codes of refusals are
        among the results. ``CHECK`` changes nothing. The log begins anew; it is told if ``LOGS`` is
        ``TELL``. ``AHEAD``: how many operations are prefetched at a time, at most ``BLOCK``, or 0.
        """
        return self._bound(templates.perform, pinned.kind, _PREFETCH=prefetch)

    def _bound(self, template: Kernel, kind: Any, **scope: Any) -> Callable[..., Any]:
        """``template`` for arrays pinned as this ``kind``."""
        return self._compiled(template, str(kind), _LOAD=loader(kind, self._columns), **scope)

    @cached_property
    def batch(self) -> Callable[..., Array]:
        """``batch(handles, offsets, values, width, *records) -> values``.

        ``offsets`` (n,) is filled. ``values`` is room to begin with, replaced by more where it is
        too small; ``width`` is the most neighbors that one element can have. What is returned is a
        view just as long as the answer.
        """
        return self._compiled(templates.batch)

    @cached_property
    def sweep(self) -> Callable[..., int]:
        """``sweep(handles, out, *records) -> checksum``; every answer overwrites the last."""
        return self._compiled(templates.sweep)

    @cached_property
    def tally(self) -> Callable[..., None]:
        """``tally(handles, times, out, *records)``: adds up how many times each is an answer."""
        return self._compiled(templates.tally)

    def copy_touched(self, exists: Kernel, coordinate: Kernel) -> Callable[..., int]:
        """``copy(touched, points, indices, out, *records) -> end``, from ``face_vertices``.

        Points and clockwise corners of what the log of an edit names; zeros for what is dead. Ends
        before what is not there.
        """
        return self._compiled(templates.copy_touched, _EXISTS=exists, _COORDINATE=coordinate)

    def run(self, plan: Any, *records: Any) -> int:
        """``run(plan, *records) -> result``, for an algorithm ``kernel(m, plan)``."""
        return self._run(everywhere(plan), *records)

    @cached_property
    def _run(self) -> Callable[..., int]:
        return self._compiled(templates.run)

    @property
    def kernel(self) -> Kernel:
        """What it is the uses of."""
        return self._kernel

    def find_edge(
        self, pinned: Any, exists: Kernel, edge_vertices: Kernel
    ) -> Callable[[int, int, Any], int]:
        """``find_edge(a, b, pinned.address) -> edge or -1``, from ``vertex_edges``.

        Pinned are the records, and scratch for the edges at a vertex and the ends of one.
        """
        bound = {"_EXISTS": exists, "_EDGE_VERTICES": edge_vertices}
        return self._bound(templates.find_edge, pinned.kind, **bound)

    def work(self, handles: Array, out: Array, records: tuple[Array, ...]) -> NDArray[np.int64]:
        """(n,) int64: how many array elements the kernel reads for each handle, exactly."""
        counters = [CountingArray(array) for array in records[:-1]]
        answer, m = interpreted(self._kernel), self._records(*counters, records[-1])
        totals = [0]
        for handle in handles.tolist():
            answer(m, handle, out)
            totals.append(sum(counter.accesses for counter in counters))
        return np.diff(totals)

    def reads(
        self, handle: int, out: Array, records: tuple[Array, ...], fields: Sequence[Field]
    ) -> list[Read]:
        """Which elements of its fields the kernel reads for a handle, in order."""
        trace: list[tuple[str, Any]] = []
        names = self._records._fields[:-1]
        traced = [TracedArray(array, it, trace) for it, array in zip(names, records, strict=False)]
        interpreted(self._kernel)(self._records(*traced, records[-1]), handle, out)
        keys = [(name, *(key if isinstance(key, tuple) else (key, 0))) for name, key in trace]
        named = [field_at(fields, name, column) for name, _, column in keys]
        return [
            Read(field, int(row), place)
            for (field, place), (_, row, _) in zip(named, keys, strict=True)
        ]

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

    def _compiled(self, template: Kernel, variant: str = "", **scope: Any) -> Callable[..., Any]:
        """``template`` with its free names bound to this kernel, compiled and cached on disk.

        ``variant`` tells apart what is bound otherwise than by the kernel. All structures share
        what is made: machine code that is loaded stays in memory as long as the process.
        """
        key = template, variant, *scope.values()
        if key not in self._made:
            self._made[key] = self._compile(template, variant, scope)
        return self._made[key]

    def _compile(
        self, template: Kernel, variant: str, scope: Mapping[str, Any]
    ) -> Callable[..., Any]:
        borrowed = {"_BORROWED": borrower(), "_OWN": borrower(self._columns)}
        bound = {"_KERNEL": self._kernel, "_RECORDS": self._records, "_FRESH": fresh}
        scope = {**bound, **borrowed, **scope}
        function = FunctionType(template.__code__, {**template.__globals__, **scope})
        names = template.__name__, self._records.__name__, source_of(self._kernel).__name__
        function.__qualname__ = "_".join(
            [*names, _digest(scope.values(), f"{variant} {self._columns}")]
        )
        # To let other threads run would take longer than a query.
        nogil = template in (templates.batch, templates.sweep, templates.walk, templates.run)
        compiled: Callable[..., Any] = njit(cache=True, nogil=nogil, no_cfunc_wrapper=True)(
            function
        )
        return compiled


def kept(function: Kernel) -> Kernel:
    """Compile a function that uses what stands in other files, and is kept on disk like a use.

    It is not inlined, which must be said: Numba takes it from whoever calls first.
    """
    function.__qualname__ += f"_{_digest([function], '')}"
    compiled: Kernel = njit(cache=True, forceinline=False)(function)
    return compiled


def _digest(bound: Iterable[Any], variant: str) -> str:
    """Of records, kernels and all that they call: the files they stand in, and which they are."""
    parts = {part for it in bound for part in parts_of(it, set())}
    files = sorted({inspect.getfile(part) for part in parts})
    told: dict[Any, str] = {}
    told_apart = "".join(sorted(_told_apart(part, told) for part in parts)) + variant
    content = b"".join(map(_contents, files)) + _shared_contents() + told_apart.encode()
    return hashlib.blake2b(content, digest_size=6).hexdigest()


def _told_apart(part: Any, told: dict[Any, str]) -> str:
    """What tells a function from others of its name in its file: its code, and what is baked in.

    Two kernels that one function makes differ by nothing else. Constants come from other files as
    well, and a cell of a notebook has none. ``told``: of those that were asked about already.
    """
    if part not in told:
        told[part] = part.__qualname__  # where it names itself
        if not isinstance(part, type):
            values = {name: _spelled(it, told) for name, it in _named(part).items()}
            which = [part.__code__.co_firstlineno, _spelled(part.__defaults__, told)]
            content = f"{which} {sorted(values.items())} {_written(part.__code__)}"
            told[part] += " " + hashlib.blake2b(content.encode(), digest_size=8).hexdigest()
    return told[part]


@cache
def _written(code: CodeType) -> str:
    """What stands in the code of a function and of all within, names and constants included."""
    constants = [_spelled(it, {}) for code in _codes(code) for it in code.co_consts]
    return f"{[(it.co_code.hex(), it.co_names) for it in _codes(code)]} {constants}"


def _spelled(value: Any, told: dict[Any, str]) -> str:
    """A value that can be baked in, alike in every process: no address, no order by hashes."""
    if isinstance(value, np.ndarray) and not value.dtype.hasobject:
        content = hashlib.blake2b(value.tobytes()).hexdigest()
        return f"{value.dtype.descr} {value.shape} {content}"
    if isinstance(value, tuple | list):
        return f"{type(value).__qualname__} {[_spelled(it, told) for it in value]}"
    if isinstance(value, frozenset):
        return f"frozenset {sorted(_spelled(it, told) for it in value)}"
    if is_compiled(value):
        return _told_apart(source_of(value), told)
    if isinstance(value, _SPELLED):
        return repr(value)
    name = getattr(value, "__qualname__", getattr(value, "__name__", None))  # of ufuncs, as well
    return f"{getattr(value, '__module__', '')} {name or type(value).__qualname__}"


_SPELLED = (
    *(bool, int, float, complex, str, bytes, NoneType, Enum),
    *(np.generic, np.dtype, types.Type),
)


def _named(source: FunctionType) -> dict[str, Any]:
    """What a function names beside its own variables: of its module, of others, in its closure."""
    read, names = _names(source.__code__)
    cells = zip(source.__code__.co_freevars, source.__closure__ or (), strict=True)
    found = {name: source.__globals__[name] for name in read if name in source.__globals__}
    found |= {name: cell.cell_contents for name, cell in cells}
    scopes = [it for it in found.items() if isinstance(it[1], _SCOPES)]
    for path, scope in scopes:  # which grows by those within, each of them once
        inside = vars(scope) if isinstance(scope, ModuleType) else scope.__members__
        more = {f"{path}.{it}": inside[it] for it in names if it in inside}
        inner = (it for it in more.items() if isinstance(it[1], _SCOPES))
        scopes += [it for it in inner if not any(it[1] is one for one in found.values())]
        found |= more
    return found


_SCOPES = ModuleType, EnumType


def _codes(code: CodeType) -> list[CodeType]:
    """The code of a function, and of all within it."""
    inner = [it for it in code.co_consts if isinstance(it, CodeType)]
    return [code, *(found for it in inner for found in _codes(it))]


@cache
def _names(code: CodeType) -> tuple[list[str], list[str]]:
    """The globals that a function reads, and all names in it, attributes as well; both in order.

    An attribute may be called like a global. What ``dis`` tells, in a fiftieth of the time.
    """
    found, extended, codes = set(), 0, _codes(code)
    for it in codes:
        for operation, argument in zip(it.co_code[::2], it.co_code[1::2], strict=True):
            argument |= extended
            extended = argument << 8 if operation == EXTENDED_ARG else 0
            if operation == _LOAD_GLOBAL:
                found.add(it.co_names[argument >> 1])
    return sorted(found), sorted({name for it in codes for name in it.co_names})


_LOAD_GLOBAL = opmap["LOAD_GLOBAL"]


def parts_of(bound: Any, seen: set[Any]) -> set[Any]:
    """The class of records, or the source of a kernel and of all kernels that it calls."""
    source = source_of(bound)
    if source in seen or not isinstance(source, type | FunctionType):
        return seen
    seen.add(source)
    if isinstance(source, FunctionType):
        for value in _named(source).values():
            if is_compiled(value):
                parts_of(value, seen)
    return seen


@cache
def _shared_contents() -> bytes:
    home = Path(__file__).parents[1]
    files = sorted(file for pattern in SHARED for file in home.glob(pattern))
    return b"".join(_contents(str(file)) for file in files)


@cache
def _contents(file: str) -> bytes:
    """A digest of those of a file."""
    path = Path(file)  # a cell of a notebook is none
    return hashlib.blake2b(path.read_bytes()).digest() if path.exists() else b""
