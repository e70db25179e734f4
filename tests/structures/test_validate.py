"""The validators: sound records pass, and any single reference that is changed is found."""

from __future__ import annotations

import numpy as np
import pytest

import hem
import structures
from tests.structures.conftest import HOLDS_ANYTHING, NEEDS_MANIFOLD, OF_ARRAYS, shuffled


def test_what_was_built_is_valid(name, mesh):
    structures.build(name, mesh).validate()


def references(s: structures.Structure) -> list[tuple[str, np.ndarray]]:
    named = zip(s.records._fields, s.records, strict=True)
    return [(field, array) for field, array in named if field not in ("vertex_point", "counts")]


def sound_alternatives(s: structures.Structure, field: str, row: int) -> set[int]:
    """Other values that are just as good: any element at a vertex or face may stand for it."""
    name = s.name
    kind, _, target = field.partition("_")
    if field in ("triangle", "edge", "half_edge"):
        return set()
    if target == "half_edge":
        column = {"vertex": 0, "face": 1}[kind]
        mine = s.records.half_edge[:, column] == row
        if name == "plankton" and kind == "vertex" and (s.records.half_edge[mine, 1] < 0).any():
            return set()  # at the border there is just one
        return set(np.flatnonzero(mine).tolist())
    return set(
        getattr(s, f"{kind}_{target}s" if target == "edge" else "vertex_faces")(row).tolist()
    )


@pytest.mark.parametrize("name", OF_ARRAYS)
@pytest.mark.parametrize("family", ["torus", "grid"])
def test_a_reference_changed_anywhere_is_found(name, family):
    if name not in NEEDS_MANIFOLD:
        return  # any three different vertices that exist are legal there; see below
    s, rng = structures.build(name, shuffled(hem.generate(family, 49))), np.random.default_rng(5)
    for field, array in references(s):
        for _ in range(60):
            place = tuple(int(rng.integers(k)) for k in array.shape)
            kept, top = int(array[place]), int(array.max()) + 2
            sound = sound_alternatives(s, field, place[0]) | {kept}
            array[place] = rng.choice([k for k in range(-2, top) if k not in sound])
            with pytest.raises(hem.MeshError, match="broken invariant"):
                s.validate()
            array[place] = kept
    s.validate()


@pytest.mark.parametrize("name", HOLDS_ANYTHING)
@pytest.mark.parametrize("wrong", [-1, 100, "repeated"])
def test_a_corner_that_cannot_be_is_found_in_an_indexed_mesh(name, wrong):
    s = structures.build(name, hem.generate("torus", 100))
    triangle = s.records.triangle
    triangle[7, 1] = triangle[7, 0] if wrong == "repeated" else wrong
    with pytest.raises(hem.MeshError, match=r"corner|vertex") as broken:
        s.validate()
    assert broken.value.elements["faces"].tolist() == [7]


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_a_position_that_is_not_finite_is_found(name):
    s = structures.build(name, hem.generate("torus", 100))
    s.records.vertex_point[3, 1] = np.inf
    with pytest.raises(hem.MeshError, match="finite") as broken:
        s.validate()
    assert broken.value.elements["vertices"].tolist() == [3]


@pytest.mark.parametrize("name", OF_ARRAYS)
def test_two_fans_joined_in_one_vertex_are_found(name):
    """Two tetrahedra that share a vertex: every record is consistent, the surface is not."""
    if name not in NEEDS_MANIFOLD:
        return
    tetrahedron = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    mesh = hem.TriangleMesh(
        np.random.default_rng(0).random((8, 3)), [*tetrahedron, *(tetrahedron + 4)]
    )
    s = structures.build(name, mesh)
    vertices = {
        "triangle_neighbor": ("triangle", slice(3, 6)),
        "winged_edge": ("edge", slice(0, 2)),
    }
    field, columns = vertices.get(name, ("half_edge", slice(0, 1)))
    array = getattr(s.records, field)[:, columns]
    array[array == 4] = 0
    s.records[1][4] = -1
    with pytest.raises(hem.MeshError, match="one fan") as broken:
        s.validate()
    assert broken.value.elements["vertices"].tolist() == [0]
