"""What building and operations have to leave, corner by corner; nothing of a library is used.

Libraries number what is left as they like, and put a new or merged vertex where they like. So an
old vertex is known by its position, and a new one by not having any of those.
"""

from collections.abc import Sequence

import numpy as np

from experiments.harness import CheckFailedError, pack_pairs, turned
from hem import TriangleMesh
from hem.arrays import Array

Arrays = tuple[Array, Array]
"""Points and triangles."""
PLACED = -1
"""The name of a vertex that an operation placed; no two of them share a face."""
SPLIT = 1, 3, 2
MORE = {
    "": (0, 0, 0), "split_edge": SPLIT, "split_face": SPLIT,
    "collapse_edge": (-1, -3, -2), "flip_edge": (0, 0, 0),
}  # fmt: skip
"""Vertices, edges and faces that an operation adds to a closed mesh; building adds none."""

TURNS = np.array([[0, 1, 2], [1, 2, 0], [2, 0, 1]])


def as_given(mesh: TriangleMesh) -> Arrays:
    """Positions and triangles, as libraries take them."""
    return mesh.points.astype(np.float64), mesh.triangles.astype(np.int32)


def check_counts(
    title: str, operation: str, before: Sequence[int], done: int, left: Sequence[int]
) -> None:
    """Compare vertices, edges and faces with what so many operations leave of those before."""
    expected = np.add(before, np.multiply(done, MORE[operation])).tolist()
    if [*left] != expected:
        raise CheckFailedError(
            f"{title}: {done} × {operation or 'build'} leaves {[*left]} vertices, edges and faces, "
            f"not {expected}"
        )


def counted(points: Array, triangles: Array) -> list[int]:
    """The number of vertices, edges and faces."""
    sides = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    return [len(points), len(np.unique(pack_pairs(sides))), len(triangles)]


def check_outcome(title: str, operation: str, given: Arrays, elements: Array, left: Arrays) -> None:
    """Compare points and triangles with what is left of those given, in counts and face by face.

    ``elements``: (k, ·) the corners of the edges or faces, no two of which share a neighbor; none
    where a mesh was built. Raises CheckFailedError.
    """
    check_counts(title, operation, counted(*given), len(elements), counted(*left))
    both = np.concatenate([given[0], left[0]]).astype(np.float32)
    _, place = np.unique(both, axis=0, return_inverse=True)
    old = np.full(len(both), PLACED)
    old[place[: len(given[0])]] = np.arange(len(given[0]))
    names = old[place[len(given[0]) :]]
    if operation == "collapse_edge":  # into one end, the other, or between
        names[np.isin(names, elements)] = PLACED
    expected = _in_order(expected_faces(operation, given[1], elements))
    found = _in_order(names[left[1]])
    if found.shape != expected.shape or (found != expected).any():
        raise CheckFailedError(f"{title}: {operation or 'build'} leaves other faces")


def expected_faces(operation: str, triangles: Array, elements: Array) -> Array:
    """(f, 3) the faces that operations leave."""
    if operation == "collapse_edge":
        names = np.where(np.isin(triangles, elements), PLACED, triangles)
        return names[(names == PLACED).sum(axis=1) < 2]
    if not len(elements):
        return triangles
    turns = triangles[:, TURNS].reshape(-1, 3).astype(np.int64)
    ends = elements[:, 0].astype(np.int64), elements[:, 1].astype(np.int64)
    sides = turns[:, 0] << 32 | turns[:, 1]
    order = np.argsort(sides)
    first, second = (
        order[np.searchsorted(sides[order], tail << 32 | tip)] for tail, tip in (ends, ends[::-1])
    )
    a, b, c, d = *ends, turns[first, 2], turns[second, 2]
    new = np.full(len(a), PLACED)
    gone = first // 3 if operation == "split_face" else np.concatenate([first // 3, second // 3])
    made = {
        "split_face": [(new, a, b), (new, b, c), (new, c, a)],
        "split_edge": [(new, b, c), (new, c, a), (new, a, d), (new, d, b)],
        "flip_edge": [(c, a, d), (d, b, c)],
    }[operation]
    faces = [np.stack(it, axis=1) for it in made]
    return np.concatenate([np.delete(triangles, gone, axis=0), *faces])


def _in_order(faces: Array) -> Array:
    """Faces that begin with their smallest corner, in one order, so that one set is one array."""
    faces = turned(faces)
    return faces[np.lexsort(faces.T)]
