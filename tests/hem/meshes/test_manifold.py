"""The diagnosis from the triangles, against sets and walks worked out face by face."""

from itertools import permutations

import numpy as np
import pytest

import hem
from hem.meshes import euler_number, non_manifold_edges, same_way_edges, split_vertices

Faces = list[list[int]]
PILLOW = [[0, 1, 2], [0, 2, 1]]
TETRAHEDRON = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
FAN = [[0, 1, 2], [0, 2, 3], [0, 3, 4]]
FIN = [[0, 1, 2], [1, 0, 3], [0, 1, 4]]
TWISTED = [[0, 1, 2], [0, 1, 3]]
BOW_TIE = [[0, 1, 2], [0, 3, 4]]


def mesh_of(faces: Faces, n: int = 5) -> hem.TriangleMesh:
    return hem.TriangleMesh(np.random.default_rng(0).random((n, 3)), faces)


def directed(faces: Faces) -> list[tuple[int, int]]:
    return [(f[i], f[(i + 1) % 3]) for f in faces for i in range(3)]


def fans_at(faces: Faces, vertex: int) -> int:
    """How many fans: faces at the vertex, merged while two share an edge there."""
    fans = [set(f) - {vertex} for f in faces if vertex in f]
    for a, b in permutations(range(len(fans)), 2):
        if fans[a] & fans[b]:
            fans[a], fans[b] = set(), fans[a] | fans[b]
    return len([fan for fan in fans if fan])


def soups() -> list[Faces]:
    random = np.random.default_rng(7)
    drawn = [random.integers(0, n, (m, 3)).tolist() for n in (4, 6, 9) for m in (2, 4, 7, 12)] * 3
    return [[f for f in random.permutation(soup).tolist() if len(set(f)) == 3] for soup in drawn]


@pytest.mark.parametrize("faces", [PILLOW, TETRAHEDRON, FAN, FIN, TWISTED, BOW_TIE, *soups()])
def test_faults_are_those_that_sets_find(faces: Faces) -> None:
    triangles = mesh_of(faces, 9).triangles
    runs = directed(faces)
    around = {e: runs.count(e) + runs.count(e[::-1]) for e in {(min(r), max(r)) for r in runs}}
    crowded = sorted(e for e, k in around.items() if k > 2)
    same = sorted(e for e, k in around.items() if k == 2 and runs.count(e) != 1)
    split = sorted(v for v in {v for f in faces for v in f} if fans_at(faces, v) > 1)
    assert [tuple(e) for e in non_manifold_edges(triangles).tolist()] == crowded
    assert [tuple(e) for e in same_way_edges(triangles).tolist()] == same
    assert split_vertices(triangles).tolist() == split


@pytest.mark.parametrize("faces", [[], PILLOW, TETRAHEDRON, FAN])
def test_surfaces_pass(faces: Faces) -> None:
    hem.require_manifold(mesh_of(faces))


@pytest.mark.parametrize(
    ("faces", "words", "kind", "elements", "at"),
    [
        (FIN, "1 edge in more than two faces", "edges", [[0, 1]], [1, 2, 3]),
        (TWISTED, "run the same way", "edges", [[0, 1]], [1, 2]),
        (BOW_TIE, "1 vertex where more than one fan", "vertices", [0], [1, 2]),
    ],
)
def test_what_is_no_surface_is_refused_naming_the_elements(
    faces: Faces, words: str, kind: str, elements: list[int], at: list[int]
) -> None:
    with pytest.raises(hem.NonManifoldError, match=words) as refusal:
        hem.require_manifold(mesh_of([[5, 6, 7], *faces], 9))
    assert refusal.value.elements[kind].tolist() == elements
    assert refusal.value.elements["faces"].tolist() == at


def test_all_faults_are_told_at_once() -> None:
    with pytest.raises(hem.NonManifoldError) as refusal:
        hem.require_manifold(mesh_of([*FIN, [0, 5, 6], [7, 8, 5], [7, 8, 6]], 9))
    assert {"more than two faces", "same way", "more than one fan"} <= {
        words for words in ("more than two faces", "same way", "more than one fan")
        if words in str(refusal.value)
    }  # fmt: skip
    assert refusal.value.elements["edges"].tolist() == [[0, 1], [7, 8]]


@pytest.mark.parametrize("faces", [[], PILLOW, TETRAHEDRON, FAN, *soups()])
def test_eulers_number_is_that_of_the_vertices_edges_and_faces_in_sets(faces: Faces) -> None:
    edges = {frozenset(e) for e in directed(faces)}
    vertices = {v for f in faces for v in f}
    assert euler_number(mesh_of(faces, 9)) == len(vertices) - len(edges) + len(faces)


def test_a_mesh_is_sound_as_a_surface_with_no_face_twice_and_eulers_number_as_foretold() -> None:
    for faces, euler in (([], 0), (TETRAHEDRON, 2), (FAN, 1), ([*FAN, [5, 6, 7]], 2)):
        mesh = mesh_of(faces, 9)
        hem.require_sound(mesh)
        hem.require_sound(mesh, euler)
        for wrong in {euler + 1, 0} - {euler}:
            with pytest.raises(hem.MeshError, match=f"number is {euler} instead of {wrong}"):
                hem.require_sound(mesh, wrong)
    with pytest.raises(hem.NonManifoldError):
        hem.require_sound(mesh_of(TWISTED))
    with pytest.raises(hem.MeshError, match="the same three corners as others") as refusal:
        hem.require_sound(mesh_of([[5, 6, 7], *PILLOW], 9))
    assert refusal.value.elements["faces"].tolist() == [2]
