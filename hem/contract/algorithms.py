"""Algorithms of one's own, written over the queries and operations of any structure."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np

from hem.arrays import Array
from hem.authoring import ENTRIES, Kernel, Kernels
from hem.contract.operating import Operating
from hem.edit import Edit
from hem.engine import Uses

Algorithm = Callable[[Kernels, Kernels], Kernel]
"""Makes an algorithm of one structure's queries and operations, see ``Algorithms.run``."""


class Algorithms(Operating, abstract=True):
    """What is run over a mesh in one go, beside single queries and operations."""

    uses_type: ClassVar[type[Uses]] = Uses
    """How kernels become what is called."""

    _algorithms: ClassVar[dict[Algorithm, Uses]]

    def run(self, make: Algorithm, plan: Any) -> int:
        """Run an algorithm over this mesh in one go, compiled where the structure is.

        ``make(queries, operations)`` gets the kernels of this structure by name and makes one of
        them, ``algorithm(m, plan) -> result``; it is asked once per structure. ``plan`` is a
        ``NamedTuple`` of arrays. Operations need room and scratch, see ``scratch``, and are told to
        subscribers by ``tell``.
        """
        return int(type(self)._algorithm(make).run(plan, *self.records))

    def scratch(self, splits: int) -> tuple[Any, Array]:
        """Make room for so many splits -> scratch for all of them, and a log.

        Cost O(1) per split in the long run.
        """
        self._count_edges()
        self._make_room(splits, 2 * splits)
        self._widen(splits)
        return self._out["edge"], np.zeros(ENTRIES * (splits + 2), np.int64)

    def tell(self, kind: str, touched: Array) -> None:
        """Tell subscribers of one edit, by the log of what an algorithm touched."""
        if self._subscribers or self._attributes:
            self._publish(Edit(kind, -1, touched))

    @classmethod
    def _algorithm(cls, make: Algorithm) -> Uses:
        if make not in cls._algorithms:
            operations = {name: uses.kernel for name, uses in cls._operation_uses.items()}
            made = make(cls.kernels, operations)
            cls._algorithms[make] = cls.uses_type(made, cls.records_type)
        return cls._algorithms[make]
