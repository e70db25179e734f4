"""What building and operations have to leave, corner by corner; nothing of a library is used.

Libraries number what is left as they like, and put a new or merged vertex where they like. So an
old vertex is known by its position, and a new one by not having any of those.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from experiments.harness import CheckFailedError, pack_pairs
from hem.arrays import Array

PLACED = -1
"""The name of a vertex that an operation placed; no two of them share a face."""
SPLIT = 1, 3, 2
MORE = {
    "": (0, 0, 0), "split_edge": SPLIT, "split_face": SPLIT,
    "collapse_edge": (-1, -3, -2), "flip_edge": (0, 0, 0),
}  # fmt: skip
"""Vertices, edges and faces that an operation adds to a closed mesh; building adds none."""

Face = tuple[int, int, int]


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


def check_outcome(
    title: str,
    operation: str,
    given: tuple[Array, Array],
    elements: Array,
    left: tuple[Array, Array],
) -> None:
    """Compare points and triangles with what is left of those given, in counts and face by face.

    ``elements``: (k, ·) the corners of the edges or faces, no two of which share a neighbor; none
    where a mesh was built. Raises CheckFailedError.
    """
    check_counts(title, operation, counted(*given), len(elements), counted(*left))
    old = {it.tobytes(): name for name, it in enumerate(given[0].astype(np.float32))}
    names = np.array([old.get(it.tobytes(), PLACED) for it in left[0].astype(np.float32)])
    if operation == "collapse_edge":  # into one end, the other, or between
        names[np.isin(names, elements)] = PLACED
    found = {*map(turned, names[left[1]].tolist())}
    expected = expected_faces(operation, given[1], elements)
    if wrong := found ^ expected:
        raise CheckFailedError(f"{title}: {operation or 'build'} leaves other faces: {len(wrong)}")


def expected_faces(operation: str, triangles: Array, elements: Array) -> set[Face]:
    """The faces that operations leave, each ``turned``."""
    if operation == "collapse_edge":
        names = np.where(np.isin(triangles, elements), PLACED, triangles)
        return {*map(turned, names[(names == PLACED).sum(axis=1) < 2].tolist())}
    faces = {*map(turned, triangles.tolist())}
    apex = {(a, b): c for face in faces for a, b, c in _turns(face)}
    for a, b, *more in elements.tolist():
        c, *_ = more or [apex[a, b]]
        faces.remove(turned((a, b, c)))
        if operation == "split_face":
            faces |= {(PLACED, a, b), (PLACED, b, c), (PLACED, c, a)}
            continue
        d = apex[b, a]
        faces.remove(turned((b, a, d)))
        if operation == "flip_edge":
            faces |= {turned((c, a, d)), turned((d, b, c))}
        else:
            faces |= {(PLACED, *side) for side in ((b, c), (c, a), (a, d), (d, b))}
    return faces


def _turns(face: Sequence[int]) -> Iterator[Face]:
    a, b, c = face
    yield from ((a, b, c), (b, c, a), (c, a, b))


def turned(face: Sequence[int]) -> Face:
    """A face that begins with its smallest corner, so that one name is one face."""
    return min(_turns(face))
