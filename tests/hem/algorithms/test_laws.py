"""What holds for every algorithm: it gives the same everywhere, and all that follows is in step."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import hem
import structures
from hem import algorithms
from hem.contract import Structure
from tests.hem.algorithms.meshes import MESHES, used

ALGORITHMS: dict[str, Callable[[Structure], Any]] = {
    **algorithms.SIX,
    "vertex normals": algorithms.vertex_normals,
    "taubin": lambda s: algorithms.smooth(s, 2, "taubin"),
    "loop": lambda s: algorithms.subdivide(s, "loop"),
    "quadrics": lambda s: algorithms.simplify(s, vertices=30),
    "shortest edge": lambda s: algorithms.simplify(s, faces=80, by="shortest_edge"),
    "remesh": lambda s: algorithms.remesh(s, 0.4, iterations=2),
    "impacts": lambda s: algorithms.impacts(s, s.faces()[::3] if isinstance(s, Structure) else []),
    "sqrt3 twice": lambda s: algorithms.subdivide(s, "sqrt3", times=2),
}
CHANGING = [it for it in ALGORITHMS if it not in ("circulator", "normals", "vertex normals")]


def corners_of(s: Structure) -> list[tuple[int, ...]]:
    """The corners of every live face, from the smallest on."""
    rows = s.triangles().tolist()
    return [tuple(row[(i := row.index(min(row))) :] + row[:i]) for row in rows]


@pytest.mark.parametrize("algorithm", ALGORITHMS)
@pytest.mark.parametrize("mesh", MESHES)
def test_every_structure_gives_the_same_to_the_last_bit(algorithm: str, mesh: str) -> None:
    expected = None
    for name in structures.NAMES:
        s = used(name, MESHES[mesh]())
        told = ALGORITHMS[algorithm](s)
        s.validate()
        found = told, s.points.copy(), s.faces(), corners_of(s)
        expected = expected or found
        for mine, others in zip(found, expected, strict=True):
            assert np.array_equal(mine, others, equal_nan=mine is not None), name


@pytest.mark.parametrize("algorithm", CHANGING)
@pytest.mark.parametrize("name", structures.NAMES)
def test_who_follows_is_in_step(algorithm: str, name: str) -> None:
    s = used(name, MESHES["grid"]())
    ids = s.vertex_attribute("id", np.int64, on_split="default", default=-1)
    ids[s.vertices()] = s.vertices()
    render = hem.RenderMesh(s)
    before = len(s.points)
    ALGORITHMS[algorithm](s)
    afresh = hem.RenderMesh(s)
    assert np.array_equal(render.points, afresh.points)
    assert np.array_equal(render.indices, afresh.indices)
    if algorithm != "collapse":  # which compacts
        old = s.vertices()[s.vertices() < before]
        assert np.array_equal(ids[old], old)


@pytest.mark.parametrize("algorithm", CHANGING)
@pytest.mark.parametrize("name", structures.NAMES)
def test_a_copy_is_changed_and_the_original_is_not(algorithm: str, name: str) -> None:
    s = structures.build(name, MESHES["torus"]())
    before, copy = s.copy(), s.copy()
    ALGORITHMS[algorithm](copy)
    assert s.same_as(before)


@pytest.mark.parametrize("algorithm", CHANGING)
@pytest.mark.parametrize("name", ["half_edge", "half_edge_objects"])
def test_corners_keep_the_values_of_their_side_of_a_seam(algorithm: str, name: str) -> None:
    """Every face has a value of its own at all its corners, which no operation may mix up."""
    s = structures.build(name, MESHES["grid"]())
    side = s.corner_attribute("side", np.float64)
    side[s.faces()] = 7.0
    ALGORITHMS[algorithm](s)
    assert np.allclose(side[s.faces()], 7)


class Stop(BaseException):
    """An interrupt."""


@pytest.mark.parametrize("algorithm", CHANGING)
@pytest.mark.parametrize("name", structures.NAMES)
def test_an_interrupt_leaves_a_whole_mesh_that_works(algorithm: str, name: str) -> None:
    s = structures.build(name, MESHES["torus"]())
    render = hem.RenderMesh(s)

    def stop(edit: hem.Edit) -> None:
        raise Stop

    end = s.subscribe(stop)
    with pytest.raises(Stop):
        ALGORITHMS[algorithm](s)
    end()
    s.validate()
    assert np.array_equal(render.indices, hem.RenderMesh(s).indices)
    ALGORITHMS[algorithm](s)
    s.validate()


@pytest.mark.parametrize("call", [
    lambda s: algorithms.smooth(s, -1),
    lambda s: algorithms.smooth(s, 1.5),
    lambda s: algorithms.smooth(s, True),
    lambda s: algorithms.smooth(s, 1, "gauss"),
    lambda s: algorithms.subdivide(s, "catmull"),
    lambda s: algorithms.subdivide(s, times=-1),
    lambda s: algorithms.simplify(s),
    lambda s: algorithms.remesh(s, 0.0),
    lambda s: algorithms.remesh(s, -0.1),
    lambda s: algorithms.remesh(s, float("inf")),
    lambda s: algorithms.remesh(s, "short"),
    lambda s: algorithms.remesh(s, iterations=-1),
    lambda s: algorithms.impacts(s, [0, 1, 200]),
    lambda s: algorithms.impacts(s, [0.5]),
    lambda s: algorithms.impacts(s, [-1]),
    lambda s: algorithms.simplify(s, vertices=-1),
    lambda s: algorithms.simplify(s, faces=10.0),
    lambda s: algorithms.simplify(s, error=float("nan")),
    lambda s: algorithms.simplify(s, error="small"),
    lambda s: algorithms.simplify(s, 10, by="volume"),
])  # fmt: skip
def test_a_bad_argument_is_refused_before_anything_changes(call: Callable[[Any], None]) -> None:
    s = structures.build("half_edge", MESHES["torus"]())
    before = s.copy()
    with pytest.raises(hem.MeshError):
        call(s)
    assert s.same_as(before)


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_polygons_and_what_is_no_structure_are_refused(algorithm: str) -> None:
    square = hem.PolygonMesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    polygonal = next(it for it in structures.NAMES if structures.REGISTRY[it].holds_polygons)
    s = structures.build(polygonal, square)
    with pytest.raises(hem.MeshError, match="triangles only") as error:
        ALGORITHMS[algorithm](s)
    assert error.value.elements["faces"].tolist() == [0]
    with pytest.raises(hem.MeshError, match="takes a structure"):
        ALGORITHMS[algorithm](MESHES["torus"]())  # type: ignore[arg-type]


@pytest.mark.parametrize("name", structures.NAMES)
def test_two_faces_with_the_same_corners_cannot_be_subdivided(name: str) -> None:
    s = structures.build(name, hem.TriangleMesh(np.eye(3), [(0, 1, 2), (0, 2, 1)]))
    for scheme in algorithms.SCHEMES:
        with pytest.raises(hem.TopologyError, match="same three corners"):
            algorithms.subdivide(s, scheme)
    assert s.n_vertices == 3
