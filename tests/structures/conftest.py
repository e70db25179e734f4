"""Small meshes of every kind that a structure must hold."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import hem
import structures
from hem.authoring import BITS, MARK
from hem.contract import Navigable

_declared = structures.REGISTRY.items()
HOLDS_ANYTHING = tuple(name for name, it in _declared if it.searches or it.rebuilds)
"""Where nothing is recorded that would hold faces together."""

NEEDS_MANIFOLD = tuple(name for name in structures.NAMES if name not in HOLDS_ANYTHING)
OF_ARRAYS = tuple(name for name in structures.NAMES if structures.REGISTRY[name].fields)
"""Those whose records can be changed at random; the others are made of objects."""


WALKED = tuple(name for name, it in _declared if issubclass(it, Navigable))
"""Where half-edges are recorded, so that an edge has two handles."""


def other_name(s: Navigable, edge: int) -> int:
    """An edge that is not on the border by its other half-edge."""
    if s.stable_edge_handles:
        return s.twin(edge)
    return s.twin(edge >> BITS) << BITS | edge & MARK


def octahedron() -> hem.TriangleMesh:
    points = np.vstack([np.eye(3), -np.eye(3)])
    faces = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    return hem.TriangleMesh(points, faces)


def strip(n: int) -> hem.TriangleMesh:
    """``n`` triangles in a row: every vertex lies on the border."""
    points = np.array([(i / 2, i % 2, 0) for i in range(n + 2)])
    faces = [(i, i + 1, i + 2) if i % 2 else (i + 1, i, i + 2) for i in range(n)]
    return hem.TriangleMesh(points, faces)


def shuffled(mesh: hem.TriangleMesh, seed: int = 0) -> hem.TriangleMesh:
    """The same surface with vertices and faces renumbered and corners turned."""
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(mesh.points))
    points = np.empty_like(mesh.points)
    points[order] = mesh.points
    faces = [np.roll(order[face], rng.integers(3)) for face in mesh.triangles]
    return hem.TriangleMesh(points, rng.permutation(np.array(faces)))


MESHES = {
    "empty": lambda: hem.TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), int)),
    "one triangle": lambda: hem.TriangleMesh(np.eye(3), [(0, 1, 2)]),
    "pillow": lambda: hem.TriangleMesh(np.eye(3), [(0, 1, 2), (0, 2, 1)]),
    "unreferenced vertices": lambda: hem.TriangleMesh(np.ones((6, 3)), [(1, 3, 4)]),
    "octahedron": octahedron,
    "strip": lambda: strip(7),
    "shuffled torus": lambda: shuffled(hem.generate("torus", 100)),
    "shuffled grid": lambda: shuffled(hem.generate("grid", 49)),
    "cone": lambda: shuffled(hem.generate("cone", 100)),
}


@cache
def mesh_called(name: str) -> hem.TriangleMesh:
    """One of ``MESHES``; a mesh does not change, so one will do for all tests."""
    return MESHES[name]()


@pytest.fixture(params=MESHES)
def mesh(request: pytest.FixtureRequest) -> hem.TriangleMesh:
    return mesh_called(request.param)


@pytest.fixture(params=structures.NAMES)
def name(request: pytest.FixtureRequest) -> str:
    return request.param


SURFACES = {
    "torus": lambda: shuffled(hem.generate("torus", 100)),
    "grid": lambda: shuffled(hem.generate("grid", 64)),
    "sphere": lambda: hem.generate("sphere", 162),
}
"""Large enough to operate on at many places."""


@cache
def surface_called(name: str) -> hem.TriangleMesh:
    """One of ``SURFACES``."""
    return SURFACES[name]()


@pytest.fixture(params=SURFACES)
def s(request: pytest.FixtureRequest, name: str) -> structures.Structure:
    return structures.build(name, surface_called(request.param))
