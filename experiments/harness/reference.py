"""What a case costs where its work cannot grow: what the memory alone does to it.

Copies of the smallest mesh stand side by side, as many as make a mesh of a case's size. They take
as much memory in the same records, and no walk leads from one to another. The compiled loop of the
case itself asks them, in the order of the case, and is told the counts of one copy: what scans the
mesh scans no more than that. So each answer takes the work of a small mesh, at every size, and the
cost rises as the memory makes it: by misses that overlap, or wait for each other, as the query's.

Operations number new elements, so theirs are the counts of all copies. A structure that looks at
the whole mesh to operate has no reference; tests count that no other does more on more copies.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np

import structures
from experiments.harness.cases import Case, in_order_of
from experiments.harness.timer import time_rounds
from experiments.presets import HUBS, Preset
from hem.arrays import Array
from hem.contract import Structure, Sweep
from hem.meshes import TriangleMesh

ROUNDS = 2  # before and after the rounds of a case, each of as many handles as those
FEWEST_HANDLES = 1_000
SMALL_HUBS = 256  # faces of the small mesh where the valence varies


def typical(seconds: Sequence[float]) -> float | None:
    """The median of some rounds, by which cases are told, too; None where there are no rounds."""
    return float(np.median(seconds)) if len(seconds) else None


class Reference:
    """The reference loop of one case."""

    def __init__(self, case: Case, preset: Preset) -> None:
        self.structure, self.records = copies(small_case(case, preset), case.vertices)
        handles = in_order_of(case, self.structure.handles(case.query.source))
        self.sweep = self.structure.prepare_sweep(case.query.name, handles)
        self._asked = 0

    def ask(self, sweep: Sweep) -> None:
        """Ask some of the handles."""
        sweep.loop(sweep.handles, sweep.out, *self.records)

    def seconds(self, many: int) -> list[float]:
        """Seconds per query of some rounds; each goes on where the last ended.

        Of as many handles as a round of the case: what a round begins with, and the handles
        themselves, then weigh as much in both.
        """
        many = max(many, FEWEST_HANDLES)

        def successive() -> tuple[Sweep]:
            begin = self._asked
            self._asked += many
            return (self.sweep.successive(begin, many),)

        first = int(self._asked == 0)
        timed = time_rounds(self.ask, setup=successive, rounds=ROUNDS, warmup=first, per=many)
        return list(timed.samples)


def small_case(case: Case, preset: Preset) -> Case:
    """The small mesh that a case is compared with copies of, of the smallest valence."""
    size, valence = preset.sizes[0], case.valence
    if case.family == HUBS:
        size, valence = SMALL_HUBS, preset.valences[0]
    return replace(case, size=size, valence=valence, subject=None, order=None)


def copies_of(chosen: Sequence[Array], small: Case, s: Structure) -> Array:
    """Faces of a small mesh in its copies, ascending: those of one choice after another in turn."""
    each = len(small.mesh().triangles)
    places = _places(small, each, s.n_faces // each)
    ways = len(chosen)
    return np.sort(np.concatenate([places[i::ways, it].ravel() for i, it in enumerate(chosen)]))


@lru_cache(maxsize=1)
def copies(small: Case, vertices: int) -> tuple[Structure, tuple[Array, ...]]:
    """A structure on copies of a small mesh, about so many vertices; its counts are of one copy."""
    mesh = small.mesh()
    n_points, n_faces = len(mesh.points), len(mesh.triangles)
    count = max(1, round(vertices / n_points))
    vertex, face = _places(small, n_points, count, small.hubs), _places(small, n_faces, count)
    points = np.empty((count * n_points, 3), mesh.points.dtype)
    triangles = np.empty((count * n_faces, 3), mesh.triangles.dtype)
    points[vertex], triangles[face] = mesh.points, vertex[:, mesh.triangles]
    # A soup looks further where points are alike, so no two copies are in one place.
    apart = 2 * np.ptp(mesh.points[:, 0]) * np.arange(count)
    points[vertex, 0] += apart[:, None].astype(points.dtype)
    s = structures.build(small.structure, TriangleMesh(points, triangles), small.reference_bytes)
    one = structures.build(small.structure, mesh, small.reference_bytes)
    return s, s.records._replace(counts=one.records.counts)


@lru_cache(maxsize=2)
def _places(small: Case, n: int, count: int, hubs: int = 0) -> Array:
    """(count, n): where each of n elements of a small mesh stands, in each of its copies.

    As in one large mesh, so that a query finds in the caches what one did just before. In that
    neighbors stand a row apart: copies stand side by side, in as many rows as each has copies, and
    of a row of copies come first the first rows of each. Where the valence varies, copies stand
    behind each other, but for their ``hubs``, which come first.
    """
    copy, element = np.divmod(np.arange(count * n), n)
    if small.family == HUBS:
        order = np.argsort(element >= hubs, kind="stable")
    else:
        parts = max(1, round(np.sqrt(len(small.mesh().points))))
        row = copy // max(1, round(np.sqrt(count)))
        order = np.argsort(row * parts + element * parts // n, kind="stable")
    places = np.empty(count * n, np.int64)
    places[order] = np.arange(count * n)
    return places.reshape(count, n)
