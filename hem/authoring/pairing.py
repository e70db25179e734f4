"""Which half-edges are twins: the step that turns a list of triangles into a connected surface.

Triangle f has the half-edges 3f, 3f + 1 and 3f + 2; half-edge 3f + i runs from its corner i to its
next corner. The twin of a half-edge runs the other way between the same two vertices.

Each half-edge is put into the bucket of its smaller vertex (a counting sort), and twins meet there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import DTypeLike, NDArray

from hem.arrays import Array
from hem.authoring.invariants import require_one_fan
from hem.authoring.slices import in_slices, slice_count
from hem.errors import MeshError, NonManifoldError
from hem.meshes import PolygonMesh, TriangleMesh, require_manifold
from hem.room import roomy, rows

MOST_HALF_EDGES = np.iinfo(np.int32).max


class Pairing(NamedTuple):
    """How the half-edges of a mesh hang together."""

    twin: NDArray[np.int32]
    """(3 n_t,): half-edge → half-edge; -1 at the border."""

    vertex_half_edge: NDArray[np.int32]
    """(n_v,): vertex → the first half-edge that leaves it; -1 for an unreferenced vertex."""

    n_edges: int
    """Number of undirected edges."""

    valence: int = 0
    """The most edges that a vertex may have, where the fans were walked; 0 where they were not."""

    def leaving(self, reference: DTypeLike) -> Array:
        """``vertex_half_edge`` as references of a type, with room: itself if it is of that."""
        own = self.vertex_half_edge
        return own if own.dtype == reference else roomy(own, reference)


def pair_half_edges(mesh: TriangleMesh, room: Array | None = None) -> Pairing:
    """Pair the half-edges of a manifold mesh, with or without borders.

    ``room``: at least 24 bytes per triangle that may be overwritten, such as the records that are
    to be filled next; without one as much is taken for a while, beside 16 to 100 bytes per vertex.
    Cost O(n_v + n_t). Raises NonManifoldError with the elements for an edge in more than two faces,
    faces that run the same way along an edge and fans that meet in a vertex.
    """
    triangles, n_vertices = mesh.triangles, len(mesh.points)
    n_half_edges = 3 * len(triangles)
    if n_half_edges > MOST_HALF_EDGES:
        raise MeshError(
            f"{len(triangles):,} faces have more half-edges than int32 can name, "
            f"{MOST_HALF_EDGES:,}"
        )
    counts = np.zeros((slice_count(len(triangles)), n_vertices), np.int32)
    firsts = np.full_like(counts, -1)
    in_slices(_count, len(triangles), triangles, counts, firsts)

    starts = np.empty(n_vertices + 1, np.int32)
    vertex_half_edge = rows(n_vertices, dtype=np.int32)
    _start_buckets(counts, firsts, starts, vertex_half_edge)
    room = np.empty(2 * n_half_edges, np.int32) if room is None else room.reshape(-1).view(np.int32)
    buckets = room[: 2 * n_half_edges].reshape(-1, 2)
    twin = np.empty(n_half_edges, np.int32)
    in_slices(_fill_buckets, len(triangles), triangles, counts, buckets, twin)

    pairs = in_slices(_match, n_vertices, starts, buckets, twin)
    sound = min(pairs) >= 0
    fans = in_slices(_walk_fans, n_vertices, vertex_half_edge, twin) if sound else [(-1, 0)]
    if n_half_edges != sum(reached for reached, _ in fans):
        require_manifold(mesh)
        raise AssertionError("pairing refuses a mesh that the diagnosis finds manifold")
    valence = 1 + max(most for _, most in fans)
    return Pairing(twin, vertex_half_edge, n_half_edges - sum(pairs), valence)


def pair_polygons(mesh: PolygonMesh) -> Pairing:
    """Pair the half-edges of polygons: one for each corner of ``mesh.faces``, in their order.

    Cost O(corners · log). Raises NonManifoldError as ``pair_half_edges``.
    """
    here, there = mesh.sides()
    forth, back = here << 32 | there, there << 32 | here
    order = np.argsort(forth, kind="stable")
    again = np.diff(forth[order]) == 0
    if again.any():
        corners = order[1:][again]
        raise NonManifoldError(
            "an edge lies in more than two faces, or in two that run the same way along it",
            edges=np.stack([here, there], axis=1)[corners],
        )
    place = np.minimum(np.searchsorted(forth[order], back), max(len(order) - 1, 0))
    candidate = order[place] if len(order) else order
    paired = np.where(forth[candidate] == back, candidate, -1)
    twin: NDArray[np.int32] = paired.astype(np.int32)
    vertex = np.full(len(mesh.points), -1, np.int32)
    vertex[here[::-1]] = np.arange(len(here), dtype=np.int32)[::-1]
    clockwise = np.where(twin >= 0, mesh.faces.following[twin], -1)
    try:
        require_one_fan(here, clockwise, np.arange(len(here)))
    except MeshError as error:
        raise NonManifoldError("fans of faces meet in a vertex", **error.elements) from error
    return Pairing(twin, vertex, (len(here) + int((twin < 0).sum())) // 2)


@njit
def _corners(triangles: Array, f: int) -> tuple[np.uint64, np.uint64, np.uint64]:
    """Those of a triangle, as indices that need not be looked at for a sign."""
    return np.uint64(triangles[f, 0]), np.uint64(triangles[f, 1]), np.uint64(triangles[f, 2])


@njit(cache=True, nogil=True)
def number_edges(twin: Array, side: Array) -> None:
    """Number the two sides of every edge: 2k and 2k + 1 for the k-th edge that is met.

    ``side``: (n,) half-edge → its number; the half-edge that is met first has 2k.
    """
    end = 0
    for h in range(len(twin)):
        if twin[h] < 0 or h < twin[h]:
            side[h] = end
            end += 2
        else:
            side[h] = side[twin[h]] + 1


@njit(cache=True, nogil=True)
def _count(begin: int, end: int, part: int, triangles: Array, counts: Array, firsts: Array) -> None:
    """Per slice: how many half-edges go into each bucket, and the first to leave each vertex."""
    count, first = counts[part], firsts[part]
    for f in range(end - 1, begin - 1, -1):  # backward: what is written last is the first
        a, b, c = _corners(triangles, f)
        count[min(a, b)] += 1
        count[min(b, c)] += 1
        count[min(c, a)] += 1
        first[a], first[b], first[c] = 3 * f, 3 * f + 1, 3 * f + 2


@njit(cache=True, nogil=True)
def _start_buckets(counts: Array, firsts: Array, starts: Array, vertex_half_edge: Array) -> None:
    """Turn the slices' counts into the places where each slice begins to fill each bucket."""
    place = 0
    for v in range(counts.shape[1]):
        starts[v], vertex_half_edge[v] = place, -1
        for part in range(counts.shape[0]):
            count, counts[part, v] = counts[part, v], place
            place += count
            if vertex_half_edge[v] < 0:
                vertex_half_edge[v] = firsts[part, v]
    starts[-1] = place


@njit(cache=True, nogil=True)
def _fill_buckets(
    begin: int, end: int, part: int, triangles: Array, places: Array, buckets: Array, twin: Array
) -> None:
    """Enter each half-edge as (larger vertex, half-edge); ~half-edge if it starts at the larger."""
    place = places[part]
    for f in range(begin, end):
        a, b, c = _corners(triangles, f)
        for start, tip, h in ((a, b, 3 * f), (b, c, 3 * f + 1), (c, a, 3 * f + 2)):
            smaller, larger = min(start, tip), max(start, tip)
            k = np.uint64(place[smaller])
            place[smaller] = k + 1
            twin[h] = -1
            buckets[k, 0] = larger
            buckets[k, 1] = h if start < tip else ~h


@njit(cache=True, nogil=True)
def _match(begin: int, end: int, part: int, starts: Array, buckets: Array, twin: Array) -> int:
    """Make twins of the entries with the same larger vertex -> how many pairs; -1 for a fault.

    ``latest``: by larger vertex the last entry so far, which is of this bucket or of one before.
    """
    pairs, latest = 0, np.full(len(starts) - 1, -1, np.int32)
    for v in range(begin, end):
        first = starts[v]
        for k in range(first, starts[v + 1]):
            larger, h = buckets[k, 0], buckets[k, 1]
            before, latest[larger] = latest[larger], k
            if before >= first:
                g = buckets[before, 1]
                opposite = (g < 0) != (h < 0)
                g, h = max(g, ~g), max(h, ~h)
                if not opposite or twin[g] >= 0:  # in one face more, or another the same way
                    return -1
                twin[g], twin[h] = h, g
                pairs += 1
    return pairs


@njit(cache=True, nogil=True)
def _walk_fans(
    begin: int, end: int, part: int, vertex_half_edge: Array, twin: Array
) -> tuple[int, int]:
    """How many half-edges the fans of each vertex' first have, and how many the largest.

    All that there are, unless a vertex has a second fan.
    """
    reached, most = 0, 0
    for v in range(begin, end):
        before, start = reached, vertex_half_edge[v]
        h = start
        while h >= 0:  # clockwise
            reached += 1
            h = twin[np.uint64(h)]
            if h >= 0:
                h += 1 - 3 * (h % 3 == 2)
            if h == start:
                break
        if h < 0 <= start:  # the border was met, so the rest lies counterclockwise
            h = twin[start - 1 if start % 3 else start + 2]
            while h >= 0:
                reached += 1
                h = twin[h - 1 if h % 3 else h + 2]
        most = max(most, reached - before)
    return reached, most
