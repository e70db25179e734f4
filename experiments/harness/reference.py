"""What a query costs where its work cannot grow: what the memory alone does to it.

Copies of the smallest mesh stand side by side, as many as make a mesh of a case's size. They take
as much memory in the same records, and no walk leads from one to another. The compiled loop of the
case itself asks them, in the order of the case, and is told the counts of one copy: what scans the
mesh scans no more than that. So each answer takes the work of a small mesh, at every size, and the
cost rises as the memory makes it: by misses that overlap, or wait for each other, as the query's.
"""

from dataclasses import replace
from functools import lru_cache
from time import perf_counter

import numpy as np

import structures
from experiments.harness.cases import Case, in_order_of
from hem.arrays import Array
from hem.contract import Structure, Sweep
from hem.meshes import TriangleMesh

ROUNDS = 3
"""Before and after the rounds of a case, each a quarter as long as one of those."""


class Reference:
    """The reference loop of one case, on copies of its mesh at the ``smallest`` size."""

    def __init__(self, case: Case, smallest: int) -> None:
        small = replace(case, size=smallest, subject=None, order=None)
        self.structure, self.records = copies(small, case.vertices)
        handles = in_order_of(case, self.structure.handles(case.query.source))
        self.sweep = self.structure.prepare_sweep(case.query.name, handles)
        self._asked = 0

    def ask(self, sweep: Sweep) -> float:
        """Ask some of the handles -> seconds."""
        begin = perf_counter()
        sweep.loop(sweep.handles, sweep.out, *self.records)
        return perf_counter() - begin

    def seconds(self, many: int) -> list[float]:
        """Seconds per query of some rounds of so many; each goes on where the last one ended."""
        seconds = []
        for _ in range(ROUNDS):
            places = (self._asked + np.arange(many)) % len(self.sweep.handles)
            seconds.append(self.ask(self.sweep.some(places)) / many)
            self._asked += many
        return seconds


@lru_cache(maxsize=1)
def copies(small: Case, vertices: int) -> tuple[Structure, tuple[Array, ...]]:
    """A structure on copies of a small mesh with about so many vertices in all, and its records.

    The counts among the records are those of one copy.
    """
    mesh = small.mesh()
    count = max(1, round(vertices / len(mesh.points)))
    first = len(mesh.points) * np.arange(count, dtype=mesh.triangles.dtype)
    triangles = (mesh.triangles + first[:, None, None]).reshape(-1, 3)
    many = TriangleMesh(np.tile(mesh.points, (count, 1)), triangles)
    s = structures.build(small.structure, many, small.reference_bytes)
    one = structures.build(small.structure, mesh, small.reference_bytes)
    return s, s.records._replace(counts=one.records.counts)
