"""Meshes to run algorithms on, and a mesh that has been operated on."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import hem
import structures
from hem.contract import Structure


def dented(family: str, n: int) -> hem.TriangleMesh:
    """A mesh of a family, its vertices moved a little at random."""
    mesh = hem.generate(family, n)
    moved = np.random.default_rng(5).normal(0, 0.02, mesh.points.shape)
    return hem.TriangleMesh(mesh.points + moved.astype(np.float32), mesh.triangles)


MESHES: dict[str, Callable[[], hem.TriangleMesh]] = {
    "torus": lambda: dented("torus", 144),  # more faces than are looked up together
    "grid": lambda: dented("grid", 81),
    "empty": lambda: hem.TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), int)),
    "unreferenced vertices": lambda: hem.TriangleMesh(np.eye(3)[[0, 0, 1, 2, 2]], [(1, 2, 3)]),
}


def used(name: str, mesh: hem.TriangleMesh) -> Structure:
    """A structure with dead vertices and faces, and new ones."""
    s = structures.build(name, mesh)
    if s.n_faces > 8:
        s.remove_faces(s.vertex_faces(int(s.vertices()[-1])))
        corners = s.face_vertices(3).tolist()
        s.collapse_edge(s.find_edge(corners[0], corners[1]), keep=corners[1])
        s.split_face(int(s.faces()[4]), s.points[s.face_vertices(int(s.faces()[4]))].mean(axis=0))
    return s
