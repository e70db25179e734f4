"""What is compiled around a kernel, once for every kernel.

The names in capitals are free: ``Uses`` makes a copy of a template's code in which they are bound
to the kernels and records of one structure. So the copies are functions of a module, which Numba
can keep on disk; closures over kernels it could not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit

from hem.arrays import Array
from hem.authoring import FACE_END, NEEDS_ROOM, SIDES, VALENCE, VERTEX_END, WIDTH, Kernel
from hem.edit import FACE, PARENT

MODE, BEGIN, END, LOGS, AHEAD, ENDED = range(6)
"""The parts of a task, the last of which it writes itself."""

DO, CHECK, PERSIST = range(3)
"""What to do with operations: do them, only check them, or pass over those that are refused."""

KEEP, TELL, FORGET = range(3)
"""What to do with the log: keep it where it is, tell it, or log each operation over the last."""


def unbound(*_: Any) -> Any:
    """Stands where ``Uses`` puts a kernel."""
    raise TypeError("a template is called that is not bound to a kernel")


def itself(arrays: Any) -> Any:
    """Stands where ``Uses`` puts what ``borrower`` makes, for records ``_OWN``, if it compiles."""
    return arrays


def first(values: Any, count: int) -> Any:
    """Stands where ``Uses`` puts ``fresh``: an array (count,) of the first of ``values``."""
    return np.array(values[:count])


_KERNEL: Kernel = unbound
_RECORDS: Callable[..., Any] = unbound
_LOAD: Callable[..., Any] = unbound
_EXISTS: Kernel = unbound
_PREFETCH: Kernel = unbound
_EDGE_VERTICES: Kernel = unbound
_COORDINATE: Kernel = unbound
_BORROWED: Callable[[Any], Any] = itself
_OWN: Callable[[Any], Any] = itself
_FRESH: Callable[[Any, int], Any] = first


def single(handle: int, address: int) -> Array:
    """One handle, called from Python; nothing where it names nothing or ``out`` is too small.

    No other thread runs until the answer has been copied out of the scratch.
    """
    arrays = _LOAD(address)
    m, out = _RECORDS(*arrays[:-1]), arrays[-1]
    count = 0
    if WIDTH * (m.counts[VALENCE] + 1) <= len(out) and _EXISTS(m, handle):
        count = _KERNEL(m, handle, out)
    found: Array = _FRESH(out, count)
    return found


def step(handle: int, address: int) -> int:
    """One step from one handle, called from Python; -1 where it names nothing, or leads nowhere."""
    m = _RECORDS(*_LOAD(address))
    found: int = _KERNEL(m, handle) if _EXISTS(m, handle) else -1
    return found


def walk(handles: Array, found: Array, *arrays: Array) -> int:
    """One step from each of many handles -> the place of the first that names nothing."""
    m = _RECORDS(*_OWN(arrays))
    for i in range(len(handles)):
        if not _EXISTS(m, handles[i]):
            return i
        found[i] = _KERNEL(m, handles[i])
    return len(handles)


def perform(address: int) -> Array:
    """One operation or many, up to the end or to one that could not be done -> the log, if told."""
    arrays = _LOAD(address)
    m = _RECORDS(*arrays[:-8])
    task, args, points, results, seen, at, out, log = arrays[-8:]
    mode, end, logs, many = task[MODE], task[END], task[LOGS], len(points) > 1
    log[0] = 0
    i = task[BEGIN]
    begin = i if task[AHEAD] else end  # of the next to be prefetched
    while i < end:
        if i == begin:
            begin = min(end, i + task[AHEAD])
            _PREFETCH(m, args[i:begin], at, out, seen)
        if logs == FORGET:
            log[0] = 0
        point = points[i if many else 0]
        results[i] = _KERNEL(m, args[i], point, at, out, log, mode == CHECK)
        if results[i] == NEEDS_ROOM or (results[i] < 0 and mode == DO):
            break
        i += 1
    task[ENDED] = i
    touched: Array = _FRESH(log[1:], log[0] if logs == TELL else 0)
    return touched


def batch(handles: Array, offsets: Array, values: Array, width: int, *arrays: Array) -> Array:
    """Many handles into offsets and values."""
    m = _RECORDS(*_OWN(arrays))
    i, end = 0, 0
    while i < len(handles):
        room = _BORROWED(values)  # nothing but this in the loop, or references to it are counted
        while i < len(handles) and end + width <= len(values):
            offsets[i] = end
            end += _KERNEL(m, handles[i], room[end:])
            i += 1
        if i < len(handles):
            grown = np.empty(2 * len(values) + width, values.dtype)
            move(values[:end], grown, 0)  # to compile an assignment of slices takes a second
            values = grown
    return values[:end]


def sweep(handles: Array, out: Array, *arrays: Array) -> int:
    """Many handles with nothing kept, for timing -> a checksum."""
    m = _RECORDS(*_OWN(arrays))
    checksum, out = 0, _BORROWED(out)
    for i in range(len(handles)):
        count = _KERNEL(m, handles[i], out)
        checksum += count
        if count > 0:
            checksum ^= out[count - 1]
    return checksum


def tally(handles: Array, times: Array, out: Array, *arrays: Array) -> None:
    """How many times each element is an answer, added to what ``times`` has."""
    m, times, out = _RECORDS(*_OWN(arrays)), _BORROWED(times), _BORROWED(out)
    for i in range(len(handles)):
        for j in range(_KERNEL(m, handles[i], out)):
            times[out[j]] += 1


def copy_touched(touched: Array, points: Array, indices: Array, out: Array, *arrays: Array) -> int:
    """Points and clockwise corners of what a log names, zeros for what is dead -> the end.

    Or the place of the first entry that names what is not there, or has no row.
    """
    m = _RECORDS(*_OWN(arrays))
    if points.shape[1] != 3 or indices.shape[1] != 3 or m.counts[SIDES] > len(out):
        return 0
    vertices = min(len(points), m.counts[VERTEX_END])
    faces = min(len(indices), m.counts[FACE_END])
    for k in range(len(touched)):
        index, what = touched[k] >> 3, touched[k] & 7
        if what == PARENT:
            continue
        if not 0 <= index < (vertices if what < FACE else faces):
            return k
        if what < FACE:
            for i in range(3):
                value = _COORDINATE(m, index, i)
                points[index, i] = value if not np.isnan(value) else 0
        elif _EXISTS(m, index):
            _KERNEL(m, index, out)
            indices[index, 0], indices[index, 1], indices[index, 2] = out[0], out[2], out[1]
        else:
            indices[index, 0], indices[index, 1], indices[index, 2] = 0, 0, 0
    return len(touched)


def run(plan: Any, *arrays: Array) -> int:
    """An algorithm."""
    result: int = _KERNEL(_RECORDS(*_OWN(arrays)), _BORROWED(plan))
    return result


def find_edge(a: int, b: int, address: int) -> int:
    """The edge at vertex a that ends at b; -1 where there is none, or the scratch is too small."""
    arrays = _LOAD(address)
    m, out, vertices = _RECORDS(*arrays[:-2]), arrays[-2], arrays[-1]
    if a == b or WIDTH * (m.counts[VALENCE] + 1) > len(out):
        return -1
    if not _EXISTS(m, a) or not _EXISTS(m, b):
        return -1
    for i in range(_KERNEL(m, a, out)):
        _EDGE_VERTICES(m, out[i], vertices)
        if vertices[0] == b or vertices[1] == b:
            found: int = out[i]
            return found
    return -1


@njit(cache=True, nogil=True)
def move(values: Array, target: Array, begin: int) -> None:
    """Copy ``values`` to ``target[begin:]``, which may overlap them from below."""
    for i in range(len(values)):
        target[begin + i] = values[i]
