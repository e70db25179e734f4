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

from hem.arrays import Array
from hem.authoring import (
    ALLOWED,
    EDGES,
    FACE_END,
    FACES,
    NEEDS_ROOM,
    SIDES,
    VALENCE,
    VERTICES,
    Operation,
    Refusal,
    count_new,
    distinct,
    has_room,
    has_scratch,
    is_point,
    kernel,
    kill_vertex,
    log_element,
    log_faces,
    log_parts,
    set_point,
    vertex_exists,
    vertex_maker,
)
from hem.edit import CHANGED, CREATED, FACE, PARENT, REMOVED, VERTEX
from structures.pairs import FACE as FACE_OF
from structures.pairs import (
    NEXT,
    PREVIOUS,
    START,
    PlanktonRecords,
    are_joined,
    counterclockwise,
    edge_exists,
    insert,
    kill,
    link,
    new_pair,
    settle,
    sides,
    tip,
)

new_vertex = vertex_maker(set_point)


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
        return Refusal.NO_EDGE
    if not is_point(point):
        return Refusal.NOT_FINITE
    if dry:
        return ALLOWED
    if not has_room(m, 1, 1, log):
        return NEEDS_ROOM
    v = new_vertex(m, point)
    onward = insert(m, h, v)
    count_new(m, 1, 0)
    left, right = m.half_edge[h, FACE_OF], m.half_edge[h ^ 1, FACE_OF]
    more_corners(m, left)
    more_corners(m, right)
    log[0] = log_element(log, log[0], VERTEX + CREATED, v)
    log[0] = log_element(log, log[0], PARENT, m.half_edge[h, START])
    log[0] = log_element(log, log[0], PARENT, m.half_edge[onward ^ 1, START])
    log[0] = log_faces(log, log[0], CHANGED, left, right)
    return v


@kernel
def may_cut_across(m: PlanktonRecords, a: int, b: int) -> int:
    """Whether the corners where two half-edges of one face start may be joined."""
    if not edge_exists(m, a) or not edge_exists(m, b):
        return Refusal.NO_EDGE
    face = m.half_edge[a, FACE_OF]
    if face < 0 or m.half_edge[b, FACE_OF] != face:
        return Refusal.OTHER_FACE
    if a == b or m.half_edge[a, NEXT] == b or m.half_edge[b, NEXT] == a:
        return Refusal.NEIGHBORS
    if are_joined(m, m.half_edge[a, START], m.half_edge[b, START]):
        return Refusal.JOINED
    return ALLOWED


@kernel
def set_loop_face(m: PlanktonRecords, h: int, f: int) -> None:
    """Let all half-edges in the loop of h lie in face f."""
    g = h
    while True:
        m.half_edge[g, FACE_OF] = f
        g = m.half_edge[g, NEXT]
        if g == h:
            return


@kernel
def cut_across(
    m: PlanktonRecords, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
) -> int:
    """From the start of one half-edge to that of another in the same face. O(corners + n_ev)."""
    a, b = args[0], args[1]
    refusal = may_cut_across(m, a, b)
    if refusal != ALLOWED or dry:
        return refusal
    if not has_room(m, 0, 1, log):
        return NEEDS_ROOM
    face = m.half_edge[a, FACE_OF]
    first, with_a, h = m.face_half_edge[face], False, a
    while h != b:
        with_a = with_a or h == first
        h = m.half_edge[h, NEXT]
    before_a, before_b = m.half_edge[a, PREVIOUS], m.half_edge[b, PREVIOUS]
    # Its half from b to a closes the loop of a, the other one that of b.
    back = new_pair(m, m.half_edge[b, START], m.half_edge[a, START])
    link(m, before_b, back)
    link(m, back, a)
    link(m, before_a, back ^ 1)
    link(m, back ^ 1, b)
    kept = back if with_a else back ^ 1
    f = m.counts[FACE_END]
    m.half_edge[kept, FACE_OF] = face
    m.face_half_edge[f] = kept ^ 1
    set_loop_face(m, kept ^ 1, f)
    count_new(m, 1, 1)
    m.counts[VALENCE] += 1
    log[0] = log_faces(log, log[0], CHANGED, face, -1)
    log[0] = log_parts(log, log[0], f, 1, face)
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
        return Refusal.NO_EDGE
    stays, goes = m.half_edge[h, FACE_OF], m.half_edge[h ^ 1, FACE_OF]
    if stays < 0 or goes < 0:
        return Refusal.BORDER_EDGE
    if not has_room(m, 0, 0, log) or not has_scratch(m, out, log):
        return NEEDS_ROOM
    both = corners_into(m, h ^ 1, out, corners_into(m, h, out, 0))
    if both - distinct(out, both) != 2:
        return Refusal.TOUCHING
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
    log[0] = log_faces(log, log[0], CHANGED, stays, -1)
    log[0] = log_faces(log, log[0], REMOVED, goes, -1)
    return int(np.int64(stays))  # as wide as refusals


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
        return Refusal.NO_EDGE
    v = m.half_edge[first, START]
    if first == second or m.half_edge[second, START] != v:
        return Refusal.OTHER_VERTEX
    if not is_point(point):
        return Refusal.NOT_FINITE
    if dry:
        return ALLOWED
    if not has_room(m, 1, 1, log) or not has_scratch(m, out, log):
        return NEEDS_ROOM
    before_first, w = m.half_edge[first ^ 1, NEXT], new_vertex(m, point)
    log[0] = log_element(log, log[0], VERTEX + CREATED, w)
    log[0] = log_element(log, log[0], PARENT, v)
    last = first
    while True:
        m.half_edge[last, START] = w
        log[0] = log_faces(log, log[0], CHANGED, m.half_edge[last, FACE_OF], -1)
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
    count_new(m, 1, 0)
    more_corners(m, left)
    more_corners(m, right)
    log[0] = log_faces(log, log[0], CHANGED, right, -1)
    return w


@kernel
def corners_around(m: PlanktonRecords, first: int) -> int:
    """How many corners the face will have that takes the place of a vertex, a half-edge of it."""
    corners, spoke = 0, first
    while True:
        corners += sides(m, m.half_edge[spoke, FACE_OF]) - 2
        spoke = counterclockwise(m, spoke)
        if spoke == first:
            return corners


@kernel
def ring_touches(m: PlanktonRecords, first: int) -> bool:
    """Whether a corner across from a vertex, a half-edge of it, comes twice. O(corners).

    What those refer to that were met is turned negative meanwhile: that takes no scratch.
    """
    v, touches = m.half_edge[first, START], False
    for back in range(2):
        spoke = first
        while True:
            h = m.half_edge[spoke, NEXT]
            while tip(m, h) != v:
                corner = m.half_edge[h, START]
                met = m.vertex_half_edge[corner] < 0
                touches |= met and not back
                if met == back:
                    m.vertex_half_edge[corner] = ~m.vertex_half_edge[corner]
                h = m.half_edge[h, NEXT]
            spoke = counterclockwise(m, spoke)
            if spoke == first:
                break
    return touches


@kernel
def kill_spokes(m: PlanktonRecords, first: int, stays: int, log: Array) -> int:
    """Take the edges at a vertex away, and the faces but for ``stays`` -> how many edges."""
    spoke, edges = first, 0
    while True:
        edges += 1
        following, face = counterclockwise(m, spoke), m.half_edge[spoke, FACE_OF]
        end = tip(m, spoke)
        if m.vertex_half_edge[end] == spoke ^ 1:
            m.vertex_half_edge[end] = m.half_edge[spoke, NEXT]
        link(m, m.half_edge[spoke ^ 1, PREVIOUS], m.half_edge[spoke, NEXT])
        if face != stays:
            m.face_half_edge[face] = -1
            log[0] = log_element(log, log[0], FACE + REMOVED, face)
        kill(m, spoke)
        spoke = following
        if spoke == first:
            return edges


@kernel
def erase_vertex(
    m: PlanktonRecords, args: Array, point: Array, at: Array, out: Array, log: Array, dry: bool
) -> int:
    """Cost O(corners of all faces around)."""
    v = args[0]
    if not vertex_exists(m, v) or np.isnan(m.vertex_point[v, 0]):
        return Refusal.NO_VERTEX
    first = m.vertex_half_edge[v]
    if first < 0 or m.half_edge[first, FACE_OF] < 0:
        return Refusal.BORDER_VERTEX
    if corners_around(m, first) < 3 or ring_touches(m, first):
        return Refusal.TOUCHING
    if dry:
        return ALLOWED
    if not has_room(m, 0, 0, log) or not has_scratch(m, out, log):
        return NEEDS_ROOM
    stays, ring = m.half_edge[first, FACE_OF], m.half_edge[first, NEXT]
    edges = kill_spokes(m, first, stays, log)
    m.face_half_edge[stays] = ring
    set_loop_face(m, ring, stays)
    more_corners(m, stays)
    m.vertex_half_edge[v] = -1
    kill_vertex(m, v)
    m.counts[VERTICES] -= 1
    take_away(m, edges, edges - 1)
    log[0] = log_element(log, log[0], VERTEX + REMOVED, v)
    log[0] = log_faces(log, log[0], CHANGED, stays, -1)
    return int(np.int64(stays))  # as wide as refusals


POLYGON_OPERATIONS = {
    "insert_vertex": Operation(lambda k: insert_vertex, "edge", True, True, (1, 1)),
    "cut_across": Operation(lambda k: cut_across, "half-edge", growth=(0, 1)),
    "merge_faces": Operation(lambda k: merge_faces, "half-edge"),
    "split_vertex": Operation(lambda k: split_vertex, "half-edge", True, True, (1, 1)),
    "erase_vertex": Operation(lambda k: erase_vertex, "vertex"),
}
"""The operations of polygons that are compiled, by name; see ``hem.authoring.operations``."""
