"""Operations as they are measured: on which elements, on copies that are as they were each time."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hem
import structures
from experiments.latency import latency_now
from experiments.profiles import Profile
from experiments.subjects import HUBS, Cell
from hem.records import copied
from hem.structure import Structure

Array = NDArray[Any]

ON_EDGES = ("split_edge", "collapse_edge", "flip_edge")

NOT_SCANNED = ("split_face",)
"""What does not search the whole mesh even where nothing is known of neighbors."""

MOST_ELEMENTS = 2_000
MOST_COPIES = 16
FEWEST_OPERATIONS = 500
"""Per round, where as many copies of a small mesh allow for it."""

ELEMENT_SEED = 22
SMALL = 20_000
"""Faces up to which the outcome is judged from its triangles, and against the indexed mesh."""


def faces_of(cell: Cell, count: int = MOST_ELEMENTS) -> Array:
    """Faces (k,) so far apart that what is done at one leaves the others as they are, ascending.

    Where the valence varies each has a hub as its first corner.
    """
    chosen = _apart(cell.family, cell.size, cell.valence)
    if len(chosen) > count:
        chosen = np.sort(np.random.default_rng(ELEMENT_SEED).choice(chosen, count, replace=False))
    return chosen


@lru_cache(maxsize=2)
def _apart(family: str, size: int, valence: int | None) -> Array:
    mesh = Cell("half_edge", family, size, valence=valence).mesh()
    if family == HUBS:
        hubs = hem.valence_hubs(int(valence or 0), size)[::2]  # one of each bipyramid
        order = np.argsort(mesh.triangles[:, 0], kind="stable")
        # Half-way around, not where every walk around the hub begins.
        across = np.searchsorted(mesh.triangles[order, 0], hubs) + int(valence or 0) // 2
        return np.sort(order[across])
    s = structures.build("half_edge", mesh)
    taken, chosen = np.zeros(s.n_vertices, np.bool_), []
    tried = np.random.default_rng(ELEMENT_SEED).permutation(s.n_faces)[: 40 * MOST_ELEMENTS]
    around = s.vertex_vertices(mesh.triangles[tried].ravel())
    for i, face in enumerate(tried.tolist()):
        ring = around.values[around.offsets[3 * i] : around.offsets[3 * i + 3]]
        if not taken[ring].any():
            taken[ring] = True
            chosen.append(face)
        if len(chosen) == MOST_ELEMENTS:
            break
    return np.sort(chosen)


def arguments(s: Structure, operation: str, faces: Array) -> Array:
    """(k, 3) the handles of the operations at these faces: their first edges, or they themselves.

    To be added are faces that are not there yet: ``s`` loses them.
    """
    rows = np.full((len(faces), 3), -1, np.int64)
    if operation in ON_EDGES:
        rows[:, 0] = s.face_edges(faces).values.reshape(-1, 3)[:, 0]
    elif operation == "add_face":
        rows[:] = s.face_vertices(faces).values.reshape(-1, 3)
        for face in faces.tolist():
            s.remove_face(face)
    else:
        rows[:, 0] = faces
    return rows


class Copies:
    """A structure and its copies, to operate on over and over."""

    def __init__(self, s: Structure, operation: str, faces: Array, most: int = MOST_COPIES) -> None:
        first = s.copy()
        args = arguments(first, operation, faces)
        points = np.zeros((len(args), 3))
        args = args[first.prepare(operation, args, points).check()]
        self.operations, points = len(args), points[: len(args)]
        count = int(np.clip(FEWEST_OPERATIONS // max(len(args), 1), 1, most))
        self.meshes = [first, *(first.copy() for _ in range(count - 1))]
        self._prepared = [it.prepare(operation, args, points) for it in self.meshes]
        self._fresh = copied(first.records)

    def restore(self) -> None:
        """Make all copies what they were."""
        for mesh in self.meshes:
            for array, fresh in zip(mesh.records, self._fresh, strict=True):
                np.copyto(array, fresh)

    def operate(self) -> None:
        """Do every operation on every copy."""
        for prepared in self._prepared:
            prepared.run()


def validate(operated: Structure) -> None:
    """Validate what operations made, by its records and where that is quick by its triangles."""
    operated.validate()
    if operated.n_faces <= SMALL:
        hem.require_sound(operated.to_triangles())


def check(cell: Cell, operated: Structure, faces: Array) -> None:
    """Validate what operations made, and compare it with the indexed mesh where that is quick."""
    validate(operated)
    if operated.n_faces <= SMALL and cell.structure != "indexed":
        both = [_operated(name, cell, faces[:20]) for name in (cell.structure, "indexed")]
        if both[0] != both[1]:
            raise AssertionError(f"{cell.id} on {cell.structure} gives another mesh than indexed")


def _operated(name: str, cell: Cell, faces: Array) -> list[tuple[int, ...]]:
    copies = Copies(structures.build(name, cell.mesh()), str(cell.query), faces, most=1)
    copies.operate()
    return _triangles(copies.meshes[0])


def _triangles(s: Structure) -> list[tuple[int, ...]]:
    rows = s.face_vertices(s.faces()).values.reshape(-1, 3)
    return sorted(tuple(np.roll(row, -int(row.argmin())).tolist()) for row in rows)


def time_operations(benchmark: Any, cell: Cell, profile: Profile) -> dict[str, Any]:
    """Time operations in one compiled loop -> samples, how many per sample, and latency."""
    s, faces = cell.build(), faces_of(cell)
    if cell.structure == "indexed" and cell.query not in NOT_SCANNED:
        faces = faces[: max(4, int(profile.round_seconds / (5e-9 * s.n_faces)))]
    copies = Copies(s, str(cell.query), faces, most=1)
    copies.operate()
    check(cell, copies.meshes[0], faces)
    done = copies.operations * len(copies.meshes)
    latency = latency_now(sum(s.memory().values()))
    benchmark.pedantic(copies.operate, setup=copies.restore, rounds=profile.rounds, warmup_rounds=1)
    data = benchmark.stats.stats.data if benchmark.stats else []
    return {"samples": np.array(data) / done, "handles": done, "latency": latency}
