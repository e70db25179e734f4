"""What an operation needs to be allowed: one set of rules for all structures.

Around an edge from ``a`` to ``b``, with ``a`` the smaller vertex, lies its *diamond*::

            c                 a, b    the ends of the edge, a < b
          ╱   ╲               left    the face that runs a → b, with the opposite corner c
        ╱ left  ╲             right   the face that runs b → a, with the opposite corner d
      a ───────▶ b
        ╲ right ╱             Where there is no face, it and its corner are -1.
          ╲   ╱
            d

A face of more than three corners has no opposite one: it is -1, too.

Rules are written over it and over a structure's own query kernels, so each stands once. They answer
with 0 or with the code of a refusal; ``REFUSALS`` has its words. The rules of collapse and flip are
those of the link condition (Dey et al., Topology preserving edge contraction, 1999).
"""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

import numpy as np

from hem.authoring.kernels import SIDES, VERTEX_END, Array, Kernel, distinct, kernel

A, B, LEFT, RIGHT, C, D = range(6)
"""Where the parts of a diamond stand in the array that ``diamond(m, e, at)`` fills."""

ALLOWED, NEEDS_ROOM = 0, -1
(NO_EDGE, NO_FACE, NO_VERTEX, NOT_FINITE, CROWDED, NOT_AN_END) = range(-7, -1)
(LONE_FACE, SAME_CORNER, TWO_BORDERS, TETRAHEDRON, COMMON_NEIGHBOR) = range(-12, -7)
(BORDER_EDGE, JOINED, SAME_VERTEX, TAKEN, COINCIDENT, SECOND_FAN, BETWEEN) = range(-19, -12)
(NOT_TRIANGLES, SHARED_FACE, OTHER_FACE, NEIGHBORS, TOUCHING) = range(-24, -19)
(OTHER_VERTEX, BORDER_VERTEX) = range(-26, -24)

REFUSALS = {
    NO_EDGE: "there is no such edge in this mesh (any more)",
    NO_FACE: "there is no such face in this mesh (any more)",
    NO_VERTEX: "there is no such vertex in this mesh (any more)",
    NOT_FINITE: "a position must be finite, and not too large for float32",
    CROWDED: "the edge lies in more faces than a surface has there, or they run the same way along "
    "it; mend the mesh first (repair=True)",
    NOT_AN_END: "the vertex to keep is not an end of the edge",
    LONE_FACE: "a face at the edge has its other two edges on the border, and would leave an edge "
    "without a face",
    SAME_CORNER: "the two faces at the edge have the same three corners",
    TWO_BORDERS: "both ends lie on the border, but the edge does not, and the surface would be "
    "pinched in one vertex",
    TETRAHEDRON: "the faces at the edge belong to a tetrahedron, of which two coincident faces "
    "would be left",
    COMMON_NEIGHBOR: "the ends have a common neighbor that is no corner of a face at the edge, and "
    "two sheets of the surface would be glued together",
    BORDER_EDGE: "the edge lies on the border, and there is no second face to turn it in",
    JOINED: "the opposite corners are joined by an edge already",
    SAME_VERTEX: "a face has three different corners",
    TAKEN: "on that side of one of its edges lies a face already",
    COINCIDENT: "there is a face with these three corners already",
    SECOND_FAN: "at a corner the face would share no edge with the faces that are there, and two "
    "fans would meet in one vertex",
    BETWEEN: "at a corner on the border the face lies between two others, and without it two fans "
    "would meet in one vertex",
    NOT_TRIANGLES: "a face at the edge has more than three corners; split that face first",
    SHARED_FACE: "both ends are corners of a face that does not lie at the edge, and would be "
    "pinched",
    OTHER_FACE: "the two half-edges do not lie in the same face",
    NEIGHBORS: "the two corners are one, or joined by a side of the face already",
    TOUCHING: "the faces meet at other corners, too, and the new one would come past them twice",
    OTHER_VERTEX: "the two half-edges are not different ones that leave the same vertex",
    BORDER_VERTEX: "the vertex lies on the border, or no face uses it",
}
"""Why an operation is refused, in words."""


def rules(k: Mapping[str, Kernel]) -> Any:
    """The rules for one structure, compiled from its query kernels and a few readings of it.

    ``diamond(m, e, at) -> faces`` fills the diamond of a live edge and tells the number of its
    faces: 0 for no edge, 3 for more than a surface has. ``joined(m, a, b)`` tells whether an edge
    joins two vertices; ``beside(m, a, b)`` is the face that runs a → b, or -1; ``coordinate(m, v,
    i)`` is NaN for a dead vertex. Rules may overwrite ``out``; ``at`` holds the diamond when they
    are done.
    """
    diamond, joined, beside = k["diamond"], k["joined"], k["beside"]
    edge_exists, face_exists = k["edge_exists"], k["face_exists"]
    vertex_vertices, vertex_faces = k["vertex_vertices"], k["vertex_faces"]
    face_faces, face_vertices = k["face_faces"], k["face_vertices"]
    coordinate, sides = k["coordinate"], k["sides"]

    @kernel
    def surface_edge(m: Any, e: int, at: Array) -> int:
        if not edge_exists(m, e):
            return NO_EDGE
        faces = diamond(m, e, at)
        if faces == 0:
            return NO_EDGE
        return CROWDED if faces > 2 else ALLOWED

    @kernel
    def triangle_edge(m: Any, e: int, at: Array) -> int:
        refusal = surface_edge(m, e, at)
        if refusal == ALLOWED and ((at[LEFT] >= 0 > at[C]) or (at[RIGHT] >= 0 > at[D])):
            return NOT_TRIANGLES
        return refusal

    @kernel
    def alone(m: Any, face: int, corner: int, others: int, out: Array) -> bool:
        return corner >= 0 and face_faces(m, face, out) == others

    @kernel
    def are_triangles(m: Any, a: int, b: int, c: int, d: int) -> bool:
        """Whether the faces that run a → b and c → d are triangles."""
        if m.counts[SIDES] == 3:
            return True
        return sides(m, beside(m, a, b)) == 3 and sides(m, beside(m, c, d)) == 3

    @kernel
    def on_border(m: Any, v: int, neighbors: int, out: Array) -> bool:
        return vertex_faces(m, v, out) < neighbors

    @kernel
    def may_collapse(m: Any, e: int, at: Array, out: Array) -> int:
        """Cost: that of ``vertex_vertices`` at both ends."""
        refusal = surface_edge(m, e, at)
        if refusal != ALLOWED:
            return refusal
        faces = 2 if at[LEFT] >= 0 and at[RIGHT] >= 0 else 1
        triangles = (at[C] >= 0) + (at[D] >= 0)
        if triangles == 2 and at[C] == at[D]:
            return SAME_CORNER
        others = faces - 1
        if alone(m, at[LEFT], at[C], others, out) or alone(m, at[RIGHT], at[D], others, out):
            return LONE_FACE
        around_a = vertex_vertices(m, at[A], out)
        border_a = on_border(m, at[A], around_a, out[around_a:])
        around_b = vertex_vertices(m, at[B], out[around_a:])
        both = around_a + around_b
        border_b = on_border(m, at[B], around_b, out[both:])
        if faces == 2 and border_a and border_b:
            return TWO_BORDERS
        closed = around_a == 3 and around_b == 3 and not border_a and not border_b
        if closed and triangles == 2 and are_triangles(m, at[A], at[C], at[C], at[B]):
            return TETRAHEDRON
        if both - distinct(out, both) != triangles:
            return COMMON_NEIGHBOR
        if m.counts[SIDES] > 3:
            around_a = vertex_faces(m, at[A], out)
            both = around_a + vertex_faces(m, at[B], out[around_a:])
            if both - distinct(out, both) != faces:
                return SHARED_FACE
        return ALLOWED

    @kernel
    def may_flip(m: Any, e: int, at: Array) -> int:
        """Cost: that of finding the edge, and O(the smaller valence of the opposite corners)."""
        refusal = triangle_edge(m, e, at)
        if refusal != ALLOWED:
            return refusal
        if at[LEFT] < 0 or at[RIGHT] < 0:
            return BORDER_EDGE
        if at[C] == at[D]:
            return SAME_CORNER
        return JOINED if joined(m, at[C], at[D]) else ALLOWED

    @kernel
    def live_vertex(m: Any, v: int) -> bool:
        return 0 <= v < m.counts[VERTEX_END] and not np.isnan(coordinate(m, v, 0))

    @kernel
    def may_add_face(m: Any, corners: Array, out: Array) -> int:
        """Cost: that of ``vertex_faces`` at the corners."""
        n = len(corners)
        for i in range(n):
            if not live_vertex(m, corners[i]):
                return NO_VERTEX
            for j in range(i):
                if corners[i] == corners[j]:
                    return SAME_VERTEX
        alike, last = True, beside(m, corners[0], corners[n - 1])
        for i in range(n):
            a, b = corners[i], corners[(i + 1) % n]
            if beside(m, a, b) >= 0:
                return TAKEN
            beyond = beside(m, b, a)
            alike = alike and beyond >= 0 and beyond == last
            if beyond < 0 and last < 0 and vertex_faces(m, a, out) > 0:
                return SECOND_FAN
            last = beyond
        return COINCIDENT if alike else ALLOWED

    @kernel
    def between(m: Any, v: int, before: int, after: int, out: Array) -> bool:
        """Whether the face lies inside the open fan of v: with faces on both sides there."""
        if before < 0 or after < 0:
            return False
        return on_border(m, v, vertex_vertices(m, v, out), out)

    @kernel
    def may_remove_face(m: Any, f: int, out: Array) -> int:
        """Cost: that of ``vertex_vertices`` at the corners."""
        if not face_exists(m, f):
            return NO_FACE
        n = face_vertices(m, f, out)
        before = beside(m, out[0], out[n - 1])
        for i in range(n):
            v = out[i]
            after = beside(m, out[(i + 1) % n], v)
            if between(m, v, before, after, out[n:]):
                return BETWEEN
            before = after
        return ALLOWED

    return SimpleNamespace(
        surface_edge=surface_edge,
        triangle_edge=triangle_edge,
        may_collapse=may_collapse,
        may_flip=may_flip,
        live_vertex=live_vertex,
        may_add_face=may_add_face,
        may_remove_face=may_remove_face,
    )
