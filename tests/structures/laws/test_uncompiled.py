"""Python itself runs the kernels as the compiler has them: the same answers, edits and refusals."""

from __future__ import annotations

import itertools
import pickle
import sys
from pathlib import Path

import numpy as np
import pytest

import hem
import structures
from hem import algorithms
from hem.contract import QUERIES
from tests.extent import OF_EACH_KIND, exhaustive
from tests.structures.conftest import mesh_called

COMPILED = [name for name, it in structures.REGISTRY.items() if it.compiled]
OF_POLYGONS = [name for name in COMPILED if structures.REGISTRY[name].holds_polygons]
MESHES = "empty", "pillow", "octahedron", "strip", "shuffled torus"
SLOW = [(it, MESHES[-1]) for it in COMPILED if structures.REGISTRY[it].searches]
"""Where Python itself searches the whole mesh for every answer."""
TRIED = [
    pytest.param(*it, marks=exhaustive if it in SLOW else ())
    for it in itertools.product(COMPILED, MESHES)
]

Structure = structures.Structure


def both_ways(name: str, mesh: object) -> tuple[Structure, Structure]:
    return structures.build(name, mesh), structures.build(name, mesh, compiled=False)


def require_alike(one: Structure, other: Structure) -> None:
    """In where vertices lie, and in what they answer, singly and in batches."""
    assert np.array_equal(one.points, other.points, equal_nan=True)
    for query in QUERIES.values():
        handles = one.handles(query.source)
        answers, others = (getattr(s, query.name)(handles) for s in (one, other))
        assert np.array_equal(answers.values, others.values), query.name
        assert np.array_equal(answers.offsets, others.offsets), query.name
        for handle, answer in list(zip(handles.tolist(), answers, strict=True))[:5]:
            assert np.array_equal(getattr(other, query.name)(handle), answer), query.name


def edit(s: Structure) -> list[str]:
    """Operate at random, and tell how each operation ended."""
    rng, told = np.random.default_rng(5), []
    for kind in rng.permutation(["split_edge", "collapse_edge", "flip_edge", "remove_face"] * 4):
        element = s.edges() if kind.endswith("edge") else s.faces()
        if len(element):
            try:
                done = s.operate(kind, int(rng.choice(element)), point=(1, 2, 3))
                told.append(f"{kind} {done.touched.tolist()}")
            except hem.TopologyError as error:
                told.append(str(error))
    return told


@pytest.mark.parametrize(("name", "mesh"), TRIED)
def test_queries_operations_and_refusals_are_those_of_compiled_code(name, mesh):
    one, other = both_ways(name, mesh_called(mesh))
    require_alike(one, other)
    assert edit(one) == edit(other)
    require_alike(one, other)
    copies = one.copy(), pickle.loads(pickle.dumps(other))
    assert not copies[1].compiled
    for s in (*copies, one, other):
        s.split_all_faces()
        s.compact()
        s.validate()
    require_alike(*copies)
    require_alike(one, other)


@pytest.mark.parametrize("name", COMPILED)
def test_the_class_is_called_as_the_compiled_one(name):
    kind = structures.REGISTRY[name]
    assert repr(kind.uncompiled()) == repr(kind)


@pytest.mark.parametrize("name", OF_POLYGONS)
def test_polygons_are_as_in_compiled_code(name):
    points = [(x, y, 0) for y in range(3) for x in range(3)]
    quads = [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)]
    one, other = both_ways(name, hem.PolygonMesh(points, quads))
    require_alike(one, other)
    assert edit(one) == edit(other)
    require_alike(one, other)


def test_an_algorithm_makes_what_it_makes_compiled():
    """Compiled on half-edges, as it makes the same of all structures."""

    def worked_on(name: str, compiled: bool) -> Structure:
        s = structures.build(name, mesh_called("shuffled torus"), compiled=compiled)
        algorithms.simplify(s, vertices=40, by="shortest_edge")
        algorithms.smooth(s)
        algorithms.remesh(s, iterations=1)
        s.validate()
        return s

    one = worked_on("half_edge", compiled=True)
    names = [name for name in OF_EACH_KIND if name in COMPILED]
    for other in (worked_on(name, compiled=False) for name in names):
        assert np.array_equal(*(np.sort(s.triangles(), axis=1) for s in (one, other))), other
        assert np.allclose(one.points, other.points, equal_nan=True, atol=1e-6), other


@pytest.mark.parametrize("name", COMPILED)
def test_a_debugger_stops_in_the_kernels_of_a_structure(name):
    """What a debugger is told of: calls of functions that stand among the structures."""
    s, called = structures.build(name, mesh_called("octahedron"), compiled=False), set()
    own = Path(structures.__file__).parent
    sys.setprofile(lambda frame, *_: called.add(Path(frame.f_code.co_filename)))
    try:
        s.vertex_faces(0)
        s.collapse_edge(int(s.edges()[0]))
    finally:
        sys.setprofile(None)
    assert any(path.is_relative_to(own) for path in called)
