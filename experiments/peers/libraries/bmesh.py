"""BMesh: Blender's mesh for editing, in which edges list the loops of their faces."""

from collections.abc import Callable
from operator import attrgetter
from typing import Any

import numpy as np

from experiments.peers.peer import Ask, Lazy, Mesh, Peer
from hem.arrays import Array

bpy, bmesh = Lazy("bpy"), Lazy("bmesh")
"""The second is there once the first was asked for something."""


def _build(points: Array, triangles: Array) -> Mesh:
    """By way of Blender's mesh in arrays, which takes them at once."""
    flat = bpy.data.meshes.new("built")
    flat.vertices.add(len(points))
    flat.vertices.foreach_set("co", points.astype(np.float32).ravel())
    flat.loops.add(triangles.size)
    flat.loops.foreach_set("vertex_index", triangles.ravel())
    flat.polygons.add(len(triangles))
    flat.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    flat.update(calc_edges=True)
    m = bmesh.new()
    m.from_mesh(flat)
    bpy.data.meshes.remove(flat)
    for elements in (m.verts, m.edges, m.faces):
        elements.ensure_lookup_table()
    return m


def _handles(m: Mesh, element: str, numbers: list[int]) -> list[Any]:
    elements = {"vertex": m.verts, "edge": m.edges, "face": m.faces}[element]
    return [elements[number] for number in numbers]


def _listed(name: str) -> Callable[[Mesh], Ask]:
    """What reads an element's list of others."""
    read = attrgetter(name)
    return lambda m: lambda it: [other.index for other in read(it)]


def _poke(m: Mesh, faces: list[Any], places: Array) -> int:
    for face in faces:
        bmesh.ops.poke(m, faces=[face])
    return len(faces)


def _poke_all(m: Mesh, faces: list[Any], places: Array) -> int:
    bmesh.ops.poke(m, faces=faces)
    return len(faces)


def _collapse(m: Mesh, edges: list[Any], places: Array) -> int:
    done = 0
    for edge in edges:
        if edge.is_valid:
            bmesh.ops.collapse(m, edges=[edge])
            done += 1
    return done


def _rotate(m: Mesh, edges: list[Any], places: Array) -> int:
    return sum(bmesh.utils.edge_rotate(edge) is not None for edge in edges)


def _arrays(m: Mesh) -> tuple[Array, Array]:
    m.verts.index_update()
    faces = [[v.index for v in it.verts] for it in m.faces]
    return np.array([it.co for it in m.verts]), np.array(faces)


def _normals(m: Mesh) -> Array:
    m.normal_update()
    return np.array([it.normal for it in m.verts])


def _smooth(m: Mesh) -> None:
    axes = {f"use_axis_{it}": True for it in "xyz"}
    bmesh.ops.smooth_vert(m, verts=m.verts, factor=1.0, **axes)


PEER = Peer(
    title="BMesh (Blender)",
    distribution="bpy",
    site="https://docs.blender.org/api/current/bmesh.html",
    manual="Lists of each element (`link_edges`, `link_faces`, `verts`) and loops from face to "
    "face; operators `bmesh.ops` of many elements at a time.",
    more="Faces of any number of corners and edges of any number of faces, layers of "
    "attributes, and Blender around it: modeling, modifiers, rendering.",
    build=_build,
    faces=lambda m: len(m.faces),
    arrays=_arrays,
    ends=lambda m: np.array([[v.index for v in it.verts] for it in m.edges]),
    handles=_handles,
    single={
        "vertex_vertices": lambda m: lambda v: [it.other_vert(v).index for it in v.link_edges],
        "vertex_edges": _listed("link_edges"),
        "vertex_faces": _listed("link_faces"),
        "edge_vertices": _listed("verts"),
        "edge_faces": _listed("link_faces"),
        "face_vertices": _listed("verts"),
        "face_edges": _listed("edges"),
        "face_faces": lambda m: lambda f: [it.link_loop_radial_next.face.index for it in f.loops],
    },
    operations={"split_face": _poke, "collapse_edge": _collapse, "flip_edge": _rotate},
    batches={"split_face": _poke_all},
    algorithms={"vertex_normals": _normals, "smooth": _smooth},
)
