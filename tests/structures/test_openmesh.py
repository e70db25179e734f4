"""The same random operations on OpenMesh: accepted and refused alike, with equal surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hem
import structures
from tests.structures.conftest import SURFACES

openmesh = pytest.importorskip("openmesh", reason="pip install openmesh compares with it")

STEPS = 400


def surface(triangles: Any) -> list[tuple[int, ...]]:
    """The triangles, each from its smallest corner on, sorted."""
    rows = np.asarray(triangles)
    turned = rows.argmin(axis=1)[:, None]
    return sorted(map(tuple, np.take_along_axis(rows, (turned + range(3)) % 3, 1).tolist()))


class Judge:
    """An OpenMesh that is asked for what our structures are asked for, in vertices."""

    def __init__(self, mesh: hem.TriangleMesh) -> None:
        self.mesh = openmesh.TriMesh(mesh.points.astype(float), mesh.triangles)

    def surface(self) -> list[tuple[int, ...]]:
        """Its live triangles."""
        return surface(
            [
                [v.idx() for v in self.mesh.fv(f)]
                for f in self.mesh.faces()
                if not self.mesh.is_deleted(f)
            ]
        )

    def half_edge(self, a: int, b: int) -> Any:
        """From a to b."""
        return self.mesh.find_halfedge(*(self.mesh.vertex_handle(v) for v in (a, b)))

    def flip_edge(self, a: int, b: int) -> bool:
        """Whether it could be done."""
        edge = self.mesh.edge_handle(self.half_edge(a, b))
        allowed = self.mesh.is_flip_ok(edge)
        if allowed:
            self.mesh.flip(edge)
        return bool(allowed)

    def collapse_edge(self, a: int, b: int) -> bool:
        """The vertex a into b, unless that leaves two coincident triangles, which it would do."""
        gone = self.half_edge(a, b)
        allowed = self.mesh.is_collapse_ok(gone) and not self._is_tetrahedron(a, b)
        if allowed:
            self.mesh.collapse(gone)
        return bool(allowed)

    def _is_tetrahedron(self, a: int, b: int) -> bool:
        rings = [{v.idx() for v in self.mesh.vv(self.mesh.vertex_handle(it))} for it in (a, b)]
        open_ends = [self.mesh.is_boundary(self.mesh.vertex_handle(it)) for it in (a, b)]
        closed = rings[0] | rings[1] == {a, b} | (rings[0] & rings[1]) and not any(open_ends)
        return closed and len(rings[0]) == len(rings[1]) == 3

    def split_edge(self, a: int, b: int) -> bool:
        """At a new vertex."""
        new = self.mesh.add_vertex(np.zeros(3))
        self.mesh.split(self.mesh.edge_handle(self.half_edge(a, b)), new)
        return True

    def split_face(self, *corners: int) -> bool:
        """At a new vertex."""
        new = self.mesh.add_vertex(np.zeros(3))
        face = self.mesh.face_handle(self.half_edge(*corners[:2]))
        self.mesh.split(face, new)
        return True


def ours(s: structures.Structure, kind: str, corners: list[int], face: int) -> bool:
    """Whether it could be done."""
    edge = s.find_edge(*corners[:2])
    try:
        if kind == "collapse_edge":
            s.collapse_edge(edge, keep=corners[1])
        elif kind == "flip_edge":
            s.flip_edge(edge)
        elif kind == "split_edge":
            s.split_edge(edge, (0, 0, 0))
        else:
            s.split_face(face, (0, 0, 0))
    except hem.TopologyError:
        return False
    return True


@pytest.mark.parametrize("name", structures.NAMES)
@pytest.mark.parametrize("source", SURFACES)
def test_random_operations_are_those_of_openmesh(name: str, source: str):
    mesh = SURFACES[source]()
    s, judge = structures.build(name, mesh), Judge(mesh)
    rng = np.random.default_rng(len(name + source))
    kinds = ["split_edge", "split_face", *3 * ["collapse_edge"], *2 * ["flip_edge"]]
    answers = []
    for _ in range(STEPS):
        kind, face = str(rng.choice(kinds)), int(rng.choice(s.faces()))
        corners = np.roll(s.face_vertices(face), rng.integers(3)).tolist()
        before = s.triangles()
        named = corners if kind == "split_face" else corners[:2]
        answers.append(ours(s, kind, corners, face))
        assert getattr(judge, kind)(*named) == answers[-1], (kind, named, before.tolist())
        if len(answers) % 20 == 0:
            assert surface(s.triangles()) == judge.surface()
    assert surface(s.triangles()) == judge.surface()
    assert 0.4 < np.mean(answers) < 0.99
    s.validate()
