"""What a case costs where its work cannot grow: what the memory alone does to it.

Copies of the smallest mesh stand side by side, as many as make a mesh of a case's size. They take
as much memory in the same records, and no walk leads from one to another. The compiled loop of the
case itself asks them, in the order of the case, and is told the counts of one copy: what scans the
mesh scans no more than that. So each answer takes the work of a small mesh, at every size, and the
cost rises as the memory makes it: by misses that overlap, or wait for each other, as the query's.

Operations number new elements, so theirs are the counts of all copies. A structure that looks at
the whole mesh to operate has no reference; tests count that no other does more on more copies.
"""

from dataclasses import replace
from functools import lru_cache
from time import perf_counter

import numpy as np

import structures
from experiments.harness.cases import Case, in_order_of
from experiments.presets import HUBS, Preset
from hem.arrays import Array
from hem.contract import Structure, Sweep
from hem.meshes import TriangleMesh

ROUNDS = 3
"""Before and after the rounds of a case, each a quarter as long as one of those."""
TRIED = 1_000
"""Handles that are asked to know how many make a round, and the fewest of one."""
MOST_HANDLES = 250_000
SMALL_HUBS = 256
"""Faces of the small mesh where the valence varies."""


def typical(seconds: Array | list[float]) -> float | None:
    """Of some rounds the quicker quartile, as delays only add; None of none."""
    return float(np.quantile(seconds, 0.25)) if len(seconds) else None


class Reference:
    """The reference loop of one case."""

    def __init__(self, case: Case, preset: Preset) -> None:
        self.structure, self.records = copies(small_case(case, preset), case.vertices)
        handles = in_order_of(case, self.structure.handles(case.query.source))
        self.sweep = self.structure.prepare_sweep(case.query.name, handles)
        self._asked = 0

    def ask(self, sweep: Sweep) -> float:
        """Ask some of the handles -> seconds."""
        begin = perf_counter()
        sweep.loop(sweep.handles, sweep.out, *self.records)
        return perf_counter() - begin

    def seconds(self, long: float) -> list[float]:
        """Seconds per query of some rounds about so ``long``; each goes on where the last ended."""
        many, seconds = TRIED, []
        for _ in range(1 + ROUNDS):
            seconds.append(self.ask(self.sweep.successive(self._asked, many)) / many)
            self._asked += many
            many = int(np.clip(long / seconds[0], TRIED, MOST_HANDLES))
        return seconds[1:]


def small_case(case: Case, preset: Preset) -> Case:
    """The small mesh that a case is compared with copies of, of the smallest valence."""
    if case.family != HUBS:
        return replace(case, size=preset.sizes[0], subject=None, order=None)
    valence = preset.valences[0]
    return replace(case, size=SMALL_HUBS, valence=valence, subject=None, order=None)


def copies_of(faces: Array, small: Case, s: Structure) -> Array:
    """Faces of a small mesh, in each of its copies."""
    each = len(small.mesh().triangles)
    return np.add.outer(each * np.arange(s.n_faces // each), faces).ravel()


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
