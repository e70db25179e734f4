"""Laws of checking what a library left: what our structures do passes, whatever else does not."""

from dataclasses import replace

import numpy as np
import pytest

import hem
import structures
from experiments.harness import Case, CheckFailedError, operation_faces
from experiments.peers import OURS, PEERS, as_given
from experiments.peers.outcome import MORE, check_outcome
from tests.experiments.peers.slow_library import LIBRARY
from tests.experiments.peers.test_peers import PRESET, measured

CASE = Case("half_edge", "torus", 400)
GIVEN = as_given(CASE.mesh())
APART = GIVEN[1][operation_faces(CASE)]


def operated(operation: str) -> tuple[np.ndarray, hem.TriangleMesh]:
    """Corners of edges or faces, and what one of our structures leaves of the mesh."""
    if operation == "":
        return APART[:0], CASE.mesh()
    s = structures.build("half_edge", CASE.mesh())
    elements = APART if operation == "split_face" else APART[:, :2]
    for corners in elements.tolist():
        handle = s.find_edge(*corners[:2])
        if operation == "split_face":
            (handle,) = np.flatnonzero((GIVEN[1] == corners).all(axis=1))
        place = [np.random.default_rng(3).random(3)] if operation.startswith("split") else []
        getattr(s, operation)(int(handle), *place)
    return elements, s.to_triangles()


@pytest.mark.parametrize("operation", MORE)
def test_what_ours_leaves_passes_and_anything_else_of_as_many_faces_does_not(operation):
    elements, left = operated(operation)
    points, triangles = as_given(left)
    check_outcome("ours", operation, GIVEN, elements, (points, triangles))
    shuffled = np.random.default_rng(0).permutation(len(points))
    renamed = points[np.argsort(shuffled)], shuffled[triangles]
    check_outcome("ours, numbered anew", operation, GIVEN, elements, renamed)
    wrong = {
        "turned over": triangles[:, ::-1],
        "a face twice": np.concatenate([triangles[1:], triangles[-1:]]),
        "a hole": triangles[1:],
        "two corners changed": np.where(triangles < 2, 1 - triangles, triangles),
    }
    for how, faces in wrong.items():
        with pytest.raises(CheckFailedError, match=operation or "build"):
            check_outcome(how, operation, GIVEN, elements, (points, faces))
    loose = np.concatenate([points, np.ones((1, 3))])
    with pytest.raises(CheckFailedError, match="vertices, edges and faces"):
        check_outcome("a loose vertex", operation, GIVEN, elements, (loose, triangles))


@pytest.mark.parametrize("operation", ["split_edge", "collapse_edge", "flip_edge"])
def test_an_operation_at_the_next_edge_does_not_pass(operation):
    left = as_given(operated(operation)[1])
    with pytest.raises(CheckFailedError, match="leaves other faces"):
        check_outcome("the next edge", operation, GIVEN, APART[:, 1:], left)


def test_a_library_that_says_it_flipped_and_did_not_is_found(monkeypatch):
    idle = {"flip_edge": lambda m, handles, places: len(handles)}
    monkeypatch.setitem(PEERS, "idle", replace(PEERS[OURS], operations=idle))
    with pytest.raises(CheckFailedError, match="flip_edge leaves other faces"):
        measured("idle", subject="flip_edge")


def test_a_library_that_builds_other_faces_is_found(monkeypatch):
    def turn(m):
        return m.points, m.triangles[:, ::-1]

    monkeypatch.setitem(PEERS, "turned", replace(LIBRARY, arrays=turn))
    with pytest.raises(CheckFailedError, match="build leaves other faces"):
        measured("turned", subject="build", size=PRESET.sizes[0])


def test_what_operates_has_to_show_what_it_leaves():
    with pytest.raises(ValueError, match="arrays"):
        replace(LIBRARY, arrays=None)
