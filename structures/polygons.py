"""What can be done with polygons on half-edges in pairs, beside the operations of the contract.

Kernels of the same form, so that checks, room, logs and edits are derived for them alike::

    insert_vertex   a──────b   ──▶  a──v──b        The faces there have a corner more.

    split_face      ┌──────b        ┌──────b       An edge between two corners of a face. The half
                    │      │   ──▶  │   ╱  │       with the face's half-edge keeps its index, so
                    a──────┘        a──────┘       that merging undoes the split, indices and all.

    merge_faces     the way back: an edge with a face on both sides goes

    split_vertex    ╲   ╱           ╲    ╱         The new vertex w takes the half-edges from the
                      v        ──▶    w─v          first, counterclockwise, to before the second.
                    ╱   ╲           ╱    ╲         The faces at both ends have a corner more.

    erase_vertex    a vertex inside the surface goes, and all its faces become one
"""

from __future__ import annotations

import numpy as np

from hem.authoring.kernels import (
    EDGES,
    FACE_END,
    FACES,
    SIDES,
    VALENCE,
    VERTICES,
    Array,
    bury,
    distinct,
    kernel,
    named,
    place,
    vertex_exists,
)
from hem.authoring.operations import (
    Operation,
    add_faces,
    appending,
    has_room,
    has_scratch,
    is_point,
    note,
    note_faces,
)
from hem.authoring.topology import (
    ALLOWED,
    BORDER_EDGE,
    BORDER_VERTEX,
    JOINED,
    NEEDS_ROOM,
    NEIGHBORS,
    NO_EDGE,
    NO_VERTEX,
    NOT_FINITE,
    OTHER_FACE,
    OTHER_VERTEX,
    TOUCHING,
)
from hem.edit import CHANGED, CREATED, FACE, REMOVED, VERTEX
from structures.pairs import FACE as FACE_OF
from structures.pairs import (
    NEXT,
    PREVIOUS,
    START,
    PlanktonRecords,
    counterclockwise,
    edge_exists,
    insert,
    joined,
    kill,
    link,
    new_pair,
    settle,
    sides,
    tip,
)

POLYGON_OPERATIONS = {
    "insert_vertex": Operation("edge", True, True, (1, 1)),
    "cut_across": Operation("half-edge", growth=(0, 1)),
    "merge_faces": Operation("half-edge"),
    "split_vertex": Operation("half-edge", True, True, (1, 1)),
    "erase_vertex": Operation("vertex"),
}
"""The operations of polygons that are compiled, by name; see ``hem.authoring.operations``."""

new_vertex = appending(place)


@kernel
def more_corners(m: PlanktonRecords, f: int) -> None:
    """Keep the bounds for a face that may have more corners than any before."""
    if f >= 0:
        m.counts[SIDES] = max(m.counts[SIDES], sides(m, f))
        m.counts[VALENCE] = max(m.counts[VALENCE], m.counts[SIDES])


@kernel
def insert_vertex(
    m: PlanktonRecords, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
) -> int:
    """Cost O(the corners of both faces), to keep the bound on them."""
    h = args[0]
    if not edge_exists(m, h):
        return NO_EDGE
    if not is_point(point):
        return NOT_FINITE
    if dry:
        return ALLOWED
    if not has_room(m, 1, 1, log):
        return NEEDS_ROOM
    v = new_vertex(m, point)
    insert(m, h, v)
    add_faces(m, 1, 0)
    left, right = m.half_edge[h, FACE_OF], m.half_edge[h ^ 1, FACE_OF]
    more_corners(m, left)
    more_corners(m, right)
    note(log, VERTEX + CREATED, v)
    note_faces(log, CHANGED, left, right)
    return v


@kernel
def cut_across(
    m: PlanktonRecords, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
) -> int:
    """From the start of one half-edge to that of another in the same face. O(corners + n_ev)."""
    a, b = args[0], args[1]
    if not edge_exists(m, a) or not edge_exists(m, b):
        return NO_EDGE
    face = m.half_edge[a, FACE_OF]
    if face < 0 or m.half_edge[b, FACE_OF] != face:
        return OTHER_FACE
    if a == b or m.half_edge[a, NEXT] == b or m.half_edge[b, NEXT] == a:
        return NEIGHBORS
    from_a, from_b = m.half_edge[a, START], m.half_edge[b, START]
    if joined(m, from_a, from_b):
        return JOINED
    if dry:
        return ALLOWED
    if not has_room(m, 0, 1, log):
        return NEEDS_ROOM
    first, with_a, h = m.face_half_edge[face], False, a
    while h != b:
        with_a = with_a or h == first
        h = m.half_edge[h, NEXT]
    before_a, before_b = m.half_edge[a, PREVIOUS], m.half_edge[b, PREVIOUS]
    back = new_pair(m, from_b, from_a)  # closes the loop of a, its pair that of b
    link(m, before_b, back)
    link(m, back, a)
    link(m, before_a, back ^ 1)
    link(m, back ^ 1, b)
    kept = back if with_a else back ^ 1
    f = m.counts[FACE_END]
    m.half_edge[kept, FACE_OF] = face
    m.face_half_edge[f] = kept ^ 1
    h = kept ^ 1
    while m.half_edge[h, FACE_OF] != f:
        m.half_edge[h, FACE_OF] = f
        h = m.half_edge[h, NEXT]
    add_faces(m, 1, 1)
    m.counts[VALENCE] += 1
    note_faces(log, CHANGED, face, -1)
    note_faces(log, CREATED, f, -1)
    return int(kept)


@kernel
def corners_into(m: PlanktonRecords, h: int, out: Array, count: int) -> int:
    """Append the corners of the loop of h to ``out`` -> the new count."""
    g = h
    while True:
        out[count] = m.half_edge[g, START]
        count += 1
        g = m.half_edge[g, NEXT]
        if g == h:
            return count


@kernel
def merge_faces(
    m: PlanktonRecords, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
) -> int:
    """The face of the half-edge takes in the one beyond. Cost O(corners of both)."""
    h = args[0]
    if not edge_exists(m, h):
        return NO_EDGE
    stays, goes = m.half_edge[h, FACE_OF], m.half_edge[h ^ 1, FACE_OF]
    if stays < 0 or goes < 0:
        return BORDER_EDGE
    if not has_room(m, 0, 0, log) or not has_scratch(m, out, log):
        return NEEDS_ROOM
    both = corners_into(m, h ^ 1, out, corners_into(m, h, out, 0))
    if both - distinct(out, both) != 2:
        return TOUCHING
    if dry:
        return ALLOWED
    after, before = m.half_edge[h, NEXT], m.half_edge[h, PREVIOUS]
    other_after, other_before = m.half_edge[h ^ 1, NEXT], m.half_edge[h ^ 1, PREVIOUS]
    if m.face_half_edge[stays] == h:
        m.face_half_edge[stays] = after
    m.face_half_edge[goes] = -1
    a, b = m.half_edge[h, START], tip(m, h)
    if m.vertex_half_edge[a] == h:
        m.vertex_half_edge[a] = other_after
    if m.vertex_half_edge[b] == h ^ 1:
        m.vertex_half_edge[b] = after
    g = other_after
    while g != h ^ 1:
        m.half_edge[g, FACE_OF] = stays
        g = m.half_edge[g, NEXT]
    link(m, before, other_after)
    link(m, other_before, after)
    kill(m, h)
    take_away(m, 1, 1)
    more_corners(m, stays)
    note_faces(log, CHANGED, stays, -1)
    note_faces(log, REMOVED, goes, -1)
    return int(stays)


@kernel
def take_away(m: PlanktonRecords, edges: int, faces: int) -> None:
    """Count edges and faces that are gone."""
    m.counts[EDGES] -= edges
    m.counts[FACES] -= faces


@kernel
def split_vertex(
    m: PlanktonRecords, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
) -> int:
    """Cost O(n_ev + corners of both faces)."""
    first, second = args[0], args[1]
    if not edge_exists(m, first) or not edge_exists(m, second):
        return NO_EDGE
    v = m.half_edge[first, START]
    if first == second or m.half_edge[second, START] != v:
        return OTHER_VERTEX
    if not is_point(point):
        return NOT_FINITE
    if dry:
        return ALLOWED
    if not has_room(m, 1, 1, log) or not has_scratch(m, out, log):
        return NEEDS_ROOM
    before_first = m.half_edge[first ^ 1, NEXT]
    w = new_vertex(m, point)
    note(log, VERTEX + CREATED, w)
    last = first
    while True:
        m.half_edge[last, START] = w
        note_faces(log, CHANGED, m.half_edge[last, FACE_OF], -1)
        if counterclockwise(m, last) == second:
            break
        last = counterclockwise(m, last)
    h = new_pair(m, v, w)
    left, right = m.half_edge[last, FACE_OF], m.half_edge[before_first, FACE_OF]
    m.half_edge[h, FACE_OF], m.half_edge[h ^ 1, FACE_OF] = left, right
    link(m, second ^ 1, h)
    link(m, h, last)
    link(m, first ^ 1, h ^ 1)
    link(m, h ^ 1, before_first)
    settle(m, v, h)
    settle(m, w, h ^ 1)
    add_faces(m, 1, 0)
    more_corners(m, left)
    more_corners(m, right)
    note_faces(log, CHANGED, right, -1)
    return w


@kernel
def erase_vertex(
    m: PlanktonRecords, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
) -> int:
    """Cost O(corners of all faces around)."""
    v = args[0]
    if not vertex_exists(m, v) or np.isnan(m.vertex_point[v, 0]):
        return NO_VERTEX
    first = m.vertex_half_edge[v]
    if first < 0 or m.half_edge[first, FACE_OF] < 0:
        return BORDER_VERTEX
    corners, spoke = 0, first
    while True:
        corners += sides(m, m.half_edge[spoke, FACE_OF]) - 2
        spoke = counterclockwise(m, spoke)
        if spoke == first:
            break
    m.counts[SIDES] = max(m.counts[SIDES], corners)
    m.counts[VALENCE] = max(m.counts[VALENCE], corners)
    if not has_room(m, 0, 0, log) or not has_scratch(m, out, log):
        return NEEDS_ROOM
    count = 0
    while True:  # the corners across, face by face, without the last of each
        h = m.half_edge[spoke, NEXT]
        while tip(m, h) != v:
            out[count] = m.half_edge[h, START]
            count += 1
            h = m.half_edge[h, NEXT]
        spoke = counterclockwise(m, spoke)
        if spoke == first:
            break
    if distinct(out, count) != count or count < 3:
        return TOUCHING
    if dry:
        return ALLOWED
    stays = m.half_edge[first, FACE_OF]
    ring = m.half_edge[first, NEXT]
    edges = 0
    while True:
        edges += 1
        following, face = counterclockwise(m, spoke), m.half_edge[spoke, FACE_OF]
        end = tip(m, spoke)
        if m.vertex_half_edge[end] == spoke ^ 1:
            m.vertex_half_edge[end] = m.half_edge[spoke, NEXT]
        link(m, m.half_edge[spoke ^ 1, PREVIOUS], m.half_edge[spoke, NEXT])
        if face != stays:
            m.face_half_edge[face] = -1
            note(log, FACE + REMOVED, face)
        kill(m, spoke)
        spoke = following
        if spoke == first:
            break
    m.face_half_edge[stays] = ring
    h = ring
    while True:
        m.half_edge[h, FACE_OF] = stays
        h = m.half_edge[h, NEXT]
        if h == ring:
            break
    m.vertex_half_edge[v] = -1
    bury(m, v)
    m.counts[VERTICES] -= 1
    take_away(m, edges, edges - 1)
    note(log, VERTEX + REMOVED, v)
    note_faces(log, CHANGED, stays, -1)
    return int(stays)


POLYGON_KERNELS = named(insert_vertex, cut_across, merge_faces, split_vertex, erase_vertex)
