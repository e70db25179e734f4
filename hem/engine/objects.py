"""The uses of kernels that Python itself runs: the same templates, uncompiled.

A structure made of objects has nothing that could be compiled. Its kernels are plain functions of
the same signatures, and the operations' drivers and rules run uncompiled around them. Kernels over
arrays are run like this to be stepped through, or where they are asked too little to be compiled.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from types import FunctionType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hem.arrays import Array
from hem.authoring import VALENCE, WIDTH, Kernel
from hem.engine.counting import (
    CountingArray,
    Read,
    interpreted,
    is_compiled,
    of_pythons_numbers,
)
from hem.engine.uses import Uses


class Held:
    """What ``Pinned`` is for arrays: records and scratch that kernels find by one ``address``."""

    kind = "held"

    def __init__(self, *things: Any) -> None:
        self.things = things

    @property
    def address(self) -> Held:
        """Python needs no other than the object."""
        return self

    def replace(self, *things: Any) -> None:
        """Put others in the same place."""
        self.things = things


class UncompiledUses(Uses):
    """The uses of one kernel over arrays, whose elements it is given as Python's numbers.

    Those of an int32 array would overflow where compiled code takes them for int64.
    """

    ahead = 0

    def _elements(self, arrays: tuple[Any, ...]) -> tuple[Any, ...]:
        """Arrays of which the first are records; the last of these are the counts, all int64."""
        count = len(self._records._fields) - 1
        return (*map(CountingArray, arrays[:count]), *arrays[count:])

    def _load(self, address: Held) -> tuple[Any, ...]:
        return self._elements(address.things)

    def _bound(self, template: Kernel, kind: Any, **scope: Any) -> Callable[..., Any]:
        return self._compiled(template, _LOAD=self._load, **scope)

    def _compile(
        self, template: Kernel, variant: str, scope: Mapping[str, Any]
    ) -> Callable[..., Any]:
        own = {"_KERNEL": self._kernel, "_RECORDS": self._records, **scope}
        own |= {"_OWN": self._elements, "_BORROWED": of_pythons_numbers}
        bound = {name: interpreted(it) if is_compiled(it) else it for name, it in own.items()}
        return FunctionType(template.__code__, {**template.__globals__, **bound})

    def single(self, pinned: Held, exists: Kernel) -> Callable[[int, Any], Array]:
        """As ``Uses.single``; each call has scratch of its own, as Python may switch threads."""
        answer, records = interpreted(self._kernel), self._records

        def ask(handle: int, held: Held) -> Array:
            *things, shared = self._load(held)
            m, out = records(*things), memoryview(np.empty(len(shared), shared.format).data)
            enough = WIDTH * (m.counts[VALENCE] + 1) <= len(out)
            count = answer(m, handle, out) if enough and exists(m, handle) else 0
            return np.array(out[:count])

        return ask

    def find_edge(
        self, pinned: Held, exists: Kernel, edge_vertices: Kernel
    ) -> Callable[[int, int, Any], int]:
        """As ``Uses.find_edge``, with scratch of its own per call."""
        bound = super().find_edge(pinned, exists, edge_vertices)

        def find(a: int, b: int, held: Held) -> int:
            *things, out, ends = held.things
            own = [memoryview(np.empty(len(it), it.format).data) for it in (out, ends)]
            return bound(a, b, Held(*things, *own))

        return find


class InterpretedUses(UncompiledUses):
    """The uses of one kernel over objects; the classes to count are those with ``__slots__``."""

    counted_classes: Sequence[type[Any]] = ()

    def work(self, handles: Array, out: Any, records: tuple[Any, ...]) -> NDArray[np.int64]:
        """(n,) int64: how many fields of objects the kernel reads for each handle, exactly."""
        answer, m = interpreted(self._kernel), self._records(*records)
        totals = [0]
        with counting(self.counted_classes) as counter:
            for handle in handles.tolist():
                answer(m, handle, out)
                totals.append(counter[0])
        return np.diff(totals)

    def reads(self, handle: int, out: Any, records: tuple[Any, ...], fields: Any) -> list[Read]:
        """As ``Uses.reads``; a field is that of a class: ``half_edge.next`` of ``HalfEdge``."""
        trace: list[tuple[Any, str]] = []
        m = self._records(*records)
        with counting(self.counted_classes, trace):
            interpreted(self._kernel)(m, handle, out)
        return [
            Read(f"{_words(type(it).__name__)}.{field}", getattr(it, "index", -1))
            for it, field in trace
        ]

    def operation_work(
        self, args: list[int], point: Array, out: Any, log: Any, records: tuple[Any, ...]
    ) -> tuple[int, int]:
        """Perform an operation -> its result, and the fields of objects it read and wrote."""
        perform, m = interpreted(self._kernel), self._records(*records)
        with counting(self.counted_classes) as counter:
            result = int(perform(m, args, point, [0] * 6, out, log, False))
        return result, counter[0]

    def _elements(self, arrays: tuple[Any, ...]) -> tuple[Any, ...]:
        return arrays


def _words(name: str) -> str:
    """``HalfEdge`` -> ``half_edge``."""
    return re.sub(r"\B(?=[A-Z])", "_", name).lower()


@contextmanager
def counting(
    classes: Sequence[type[Any]], trace: list[tuple[Any, str]] | None = None
) -> Iterator[list[int]]:
    """Count every read and write of the ``__slots__`` of ``classes`` -> the count, in a list.

    ``trace`` gets each read: the object, and the slot. Concerns the whole process, until the end of
    the block.
    """
    counter = [0]
    slots = [(it, name, it.__dict__[name]) for it in classes for name in it.__slots__]
    for owner, name, slot in slots:
        setattr(owner, name, _CountingSlot(slot, counter, trace))
    try:
        yield counter
    finally:
        for owner, name, slot in slots:
            setattr(owner, name, slot)


class _CountingSlot:
    """Stands in for a slot of a class while its uses are counted."""

    def __init__(self, slot: Any, counter: list[int], trace: list[tuple[Any, str]] | None) -> None:
        self._slot, self._counter, self._trace = slot, counter, trace

    def __get__(self, owner: Any, kind: Any = None) -> Any:
        self._counter[0] += 1
        if self._trace is not None:
            self._trace.append((owner, self._slot.__name__))
        return self._slot.__get__(owner, kind)

    def __set__(self, owner: Any, value: Any) -> None:
        self._counter[0] += 1
        self._slot.__set__(owner, value)
