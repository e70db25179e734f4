"""The errata of the thesis and of the article, each shown by running what is printed.

One to nine are those that were known from reading; the others were found by running. ``show`` of an
erratum runs the listing (``structures.as_printed``) beside the sound version and tells what each
gives. How costs grow as printed is measured by ``bench_printed``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, cast

import numpy as np

import hem
import structures
from structures.as_printed import AsPrinted, render_arrays
from structures.half_edge_objects import HalfEdgeMesh, fields_accessed
from structures.plankton import Plankton

MIDDLE = (0.25, 0.25, 0.5)
"""A position in the octahedron where nothing is yet."""

GIVES_UP = 999
"""After so many steps Plankton's circulator takes a vertex for a runaway (quoted in thesis 5)."""


class Shown(NamedTuple):
    """What a run gave: of what is printed, of the sound version, and whether it is an erratum."""

    printed: str
    sound: str
    confirmed: bool


class Erratum(NamedTuple):
    """One erratum, and how it is shown."""

    title: str
    source: str
    says: str
    """What the text or the listing says."""

    does: str
    """What it really does."""

    show: Callable[[], Shown]


def octahedron() -> hem.TriangleMesh:
    """Six vertices, twelve edges, eight faces."""
    points = np.vstack([np.eye(3), -np.eye(3)])
    faces = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    return hem.TriangleMesh(points, faces)


def printed(mesh: hem.TriangleMesh | None = None, whole: bool = True) -> AsPrinted:
    """The mesh as the listings build it, an octahedron unless another is given."""
    mesh = mesh or octahedron()
    built = AsPrinted.build(*render_arrays(mesh.points, mesh.triangles), whole=whole)
    built.generate_render_mesh()
    return built


def sound(mesh: hem.TriangleMesh | None = None) -> HalfEdgeMesh:
    """The same mesh as the sound version builds it."""
    return cast(HalfEdgeMesh, structures.build("half_edge_objects", mesh or octahedron()))


def _said(faults: dict[str, int]) -> str:
    return "; ".join(f"{often} {what}" for what, often in faults.items()) or "nothing wrong"


def _valid(s: HalfEdgeMesh) -> str:
    s.validate()
    return f"valid: {s.n_faces} faces, {s.n_edges} edges"


def _last_triangle() -> Shown:
    m, s = printed(whole=False), sound()
    faces, unpaired = len(m.faces), sum(h.opposite is None for h in m.half_edges)
    return Shown(
        f"{faces} faces, {unpaired} half-edges without a partner",
        f"{s.n_faces} faces, {sum(h.opposite is None for h in s.half_edges)} without a partner",
        (faces, unpaired) == (7, 3),
    )


SMALLER, LARGER = 100, 400
"""Vertices of the two tori whose work is compared: four times as many."""


def _growth(call: Callable[[hem.TriangleMesh], Callable[[], object]]) -> float:
    """How many times the work that a call does grows from the smaller torus to the larger."""
    one, other = (fields_accessed(call(hem.generate("torus", n))) for n in (SMALLER, LARGER))
    return other / one


def _times(growth: float) -> str:
    return f"{growth:.1f} × the work in a mesh of {LARGER // SMALLER} × the vertices"


def _grows(
    as_printed: Callable[[hem.TriangleMesh], Callable[[], object]],
    as_mended: Callable[[hem.TriangleMesh], Callable[[], object]],
    at_least: float,
    at_most: float,
) -> Shown:
    one, other = _growth(as_printed), _growth(as_mended)
    return Shown(_times(one), _times(other), one > at_least and other < at_most)


def _quadratic_builder() -> Shown:
    return _grows(lambda mesh: lambda: printed(mesh), lambda mesh: lambda: sound(mesh), 12, 5)


def _foreign_face() -> Shown:
    m, s = printed(), sound()
    m.split_half_edge(m.half_edges[0], MIDDLE)
    s.split_edge(s.half_edges[0].edge, MIDDLE)
    faults = m.faults()
    wrong = faults.get("half-edges with another face than the next one")
    return Shown(_said(faults), _valid(s), wrong == 4)


def _cleared_pairs() -> Shown:
    m, s = printed(), sound()
    m.collapse_edge(m.half_edges[0])
    s.collapse_edge(s.half_edges[0].edge)
    faults = {what: often for what, often in m.faults().items() if "render" not in what}
    wrong = faults.get("half-edges without an opposite, though there is one")
    return Shown(_said(faults), _valid(s), wrong == 4)


def _kept_half_edge() -> Shown:
    kept = 0
    for i in range(24):
        m = printed()
        m.collapse_edge(m.half_edges[i])
        kept += "vertices with a half-edge that is gone" in m.faults()
    s = sound()
    s.collapse_edge(s.half_edges[0].edge)
    return Shown(f"after {kept} of 24 collapses a vertex keeps one", _valid(s), kept > 0)


def _border_collapse() -> Shown:
    mesh = hem.TriangleMesh(np.eye(3), [(0, 1, 2)])
    m, s = printed(mesh), sound(mesh)
    try:
        m.collapse_edge(m.half_edges[0])
        words = "done"
    except AttributeError as error:
        words = f"a null reference: {error}"
    try:
        s.collapse_edge(0)
        refusal = "done"
    except hem.TopologyError as error:
        refusal = f"refused: {error.reason}"
    return Shown(words, refusal, "null" in words and "refused" in refusal)


def _no_link_condition() -> Shown:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    mesh = hem.TriangleMesh(points, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    m, s = printed(mesh), sound(mesh)
    m.collapse_edge(m.half_edges[0])
    corners = [frozenset(h.origin.index for h in m.face_circulator(f)) for f in m.faces]
    try:
        s.collapse_edge(0)
        refusal = "done"
    except hem.TopologyError as error:
        refusal = f"refused: {error.reason}"
    coincident = len(corners) == 2 and len(set(corners)) == 1
    return Shown("two coincident faces are left of a tetrahedron", refusal, coincident)


def _inverted_commit() -> Shown:
    m = printed()
    alone: list[int] = []
    within: list[int] = []
    for is_transaction, commits in ((False, alone), (True, within)):
        before = m.render.commits
        m.split_face(m.faces[0], (9.0, 9.0, float(is_transaction)), is_transaction)
        commits.append(m.render.commits - before)
    render = hem.RenderMesh(s := sound())
    s.split_face(0, (9, 9, 0))
    single = render.commits
    with render.transaction():
        s.split_face(1, (9, 9, 1))
        within_sound = render.commits - single
    return Shown(
        f"{alone[0]} commits outside a transaction, {within[0]} inside",
        f"{single} outside, {within_sound} inside",
        (alone, within, single, within_sound) == ([0], [1], 1, 0),
    )


def _search_for_duplicates() -> Shown:
    def split(mesh: hem.TriangleMesh) -> Callable[[], object]:
        m = printed(mesh)
        return lambda: m.split_face(m.faces[0], (9.0, 9.0, 9.0))

    def mended(mesh: hem.TriangleMesh) -> Callable[[], object]:
        s = sound(mesh)
        s.move_vertex(0, s.points[0])  # binds the operations
        return lambda: s.split_face(0, (9, 9, 9))

    return _grows(split, mended, 2, 1.1)


def _silent_weld() -> Shown:
    m, s = printed(), sound()
    there = m.vertices[3].point
    m.split_face(m.faces[0], there)
    s.split_face(0, there)
    return Shown(
        f"{len(m.vertices)} vertices after a split at the position of another",
        f"{s.n_vertices} vertices",
        (len(m.vertices), s.n_vertices) == (6, 7),
    )


def _full_commit() -> Shown:
    sizes = []
    for n in (SMALLER, LARGER):
        m = printed(hem.generate("torus", n))
        m.split_half_edge(m.half_edges[0], (9.0, 9.0, 9.0))
        sizes.append(len(m.render.committed))
    uploads = []
    for n in (SMALLER, LARGER):
        s = sound(hem.generate("torus", n))
        s.split_face(0, (9, 9, 9))
        render = hem.RenderMesh(s)
        s.split_edge(s.half_edges[0].edge, (9, 9, 9))  # makes room
        render.subscribe(lambda upload: uploads.append(int(np.diff(upload.triangles).sum())))
        s.split_face(0, (9, 9, 8))
    return Shown(
        f"a split hands over {sizes[0]:,} and {sizes[1]:,} indices",
        f"it touches {uploads[0]} and {uploads[1]} triangles",
        sizes[1] > 3.5 * sizes[0] and max(uploads) <= 40,
    )


def _scanning_circulator() -> Shown:
    def scan(mesh: hem.TriangleMesh) -> Callable[[], object]:
        m = printed(mesh)
        return lambda: m.vertex_circulator(m.vertices[0])

    def circulate(mesh: hem.TriangleMesh) -> Callable[[], object]:
        s = sound(mesh)
        return lambda: s.vertices.circulator(s.vertices[0])

    return _grows(scan, circulate, 3.9, 1.1)


def _twice_as_many() -> Shown:
    s = hem.generate("torus", LARGER).summary()
    return Shown(
        "n_v ≈ 2 n_t", f"n_t = {s.faces / s.vertices:g} n_v on a torus", s.faces == 2 * s.vertices
    )


def _bytes_left_out() -> Shown:
    mesh = hem.generate("torus", LARGER)
    total = sum(sound(mesh).clr_memory().values()) / len(mesh.points)
    return Shown("228 bytes per vertex", f"{total:g} with all that the classes have", total > 228)


def _colliding_indices() -> Shown:
    m, s = printed(), sound()
    m.remove_face(m.faces[0])
    m.split_face(m.faces[0], MIDDLE)
    s.remove_face(0)
    s.split_face(1, MIDDLE)
    faults = {what: often for what, often in m.faults().items() if "index" in what}
    return Shown(_said(faults), _valid(s), bool(faults))


def _shifted_render_mesh() -> Shown:
    m, s = printed(), sound()
    m.collapse_edge(m.half_edges[0])
    render = hem.RenderMesh(s)
    s.collapse_edge(s.half_edges[0].edge)
    wrong = m.faults().get("corners of the render mesh at another position", 0)
    beyond = max(m.render.committed) >= len(m.render.points)
    words = ", some beyond the last point" if beyond else ""
    kept = render.to_triangles()
    return Shown(
        f"{wrong} of {3 * len(m.faces)} corners show another position{words}",
        f"the render mesh has the {len(kept.triangles)} faces of the structure",
        wrong > 0 and len(kept.triangles) == s.n_faces,
    )


def _doubled_render_point() -> Shown:
    m, s = printed(), sound()
    for i, z in enumerate((0.5, 0.25)):
        m.split_half_edge(m.half_edges[i], (0.25, 0.25, z))
        s.split_edge(s.half_edges[i].edge, (0.25, 0.25, z))
    points, wrong = len(m.render.points), m.faults()
    misplaced = wrong.get("corners of the render mesh at another position", 0)
    return Shown(
        f"{points} points for {len(m.vertices)} vertices, {misplaced} corners at another position",
        f"{len(hem.RenderMesh(s).points) // 3} points for {s.n_vertices} vertices",
        points == len(m.vertices) + 2 and misplaced > 0,
    )


def _lonely_vertices() -> Shown:
    mesh = hem.TriangleMesh(np.eye(3), [(0, 1, 2)])
    m = printed(mesh)
    m.remove_face(m.faces[0])
    s = sound(mesh)
    s.remove_face(0)
    s.validate()
    return Shown(
        f"{len(m.vertices)} vertices are left, though the listing means to remove them",
        f"{s.n_vertices} vertices are left, as documented: remove_face keeps vertices",
        len(m.vertices) == 3,
    )


def _stolen_partner() -> Shown:
    mesh = hem.TriangleMesh(
        np.random.default_rng(0).random((5, 3)), [(0, 1, 2), (1, 0, 3), (0, 1, 4)]
    )
    m = printed(mesh)
    try:
        sound(mesh)
        refusal = "built"
    except hem.NonManifoldError as error:
        refusal = f"refused: {error.reason}"
    faults = {what: often for what, often in m.faults().items() if "opposite has" in what}
    return Shown(_said(faults), refusal, bool(faults) and refusal.startswith("refused"))


def _runaway() -> Shown:
    valence = 2_000
    s = cast(Plankton, structures.build("plankton", hem.valence_mesh(valence, 2 * valence)))
    hub = int(hem.valence_hubs(valence, 2 * valence)[0])
    start = s.outgoing_half_edge(hub)
    h, steps = start, 0
    while True:  # as quoted in thesis 5
        h = s.next_half_edge(s.pair(h))
        if steps > GIVES_UP or h == start:
            break
        steps += 1
    return Shown(
        f"gives up after {steps:,} of {valence:,} half-edges",
        f"{s.valence(hub):,} half-edges",
        h != start and s.valence(hub) == valence,
    )


def _needs_no_closed_mesh() -> Shown:
    s = cast(Plankton, structures.build("plankton", hem.generate("grid", LARGER)))
    border = [v for v in s.vertices().tolist() if s.vertex_naked_edges(v)]
    answered = sum(s.valence(v) == len(s.vertex_vertices(v)) for v in border)
    return Shown(
        "“works only if no half-edge lacks its neighbor”",
        f"comes round at all {answered} vertices on the border of a grid: it has half-edges, too",
        answered == len(border) > 0,
    )


def _left_behind() -> Shown:
    m, s = printed(), structures.build("half_edge", octahedron())
    before = list(m.faces)
    m.split_face(m.faces[0], MIDDLE)
    created = [face for face in m.faces if not any(face is it for it in before)]
    only_there = replace(hem.fracture.MATERIALS["glass"], circles=())
    rest = hem.fracture.shatter(s, np.full(3, 1 / 3), only_there).rest[0]
    struck = np.isclose(rest.points[rest.triangles].sum(axis=2), 1).all(axis=1)
    return Shown(
        f"{len(created)} of the 3 parts of the face are new, and 1 stays behind",
        f"{struck.sum()} parts of the face that was struck stay behind",
        len(created) == 2 and not struck.any(),
    )


ERRATA = (
    Erratum(
        "The builder loses the last triangle", "thesis 3.3.2",
        "for i = 0; i < triangles.Length − 3; i += 3: a face for every three indices.",
        "The loop ends one triangle early, so that its neighbors stay without partners.",
        _last_triangle,
    ),
    Erratum(
        "The builder is quadratic", "thesis 3.3.2",
        "Half-edges to pair are found by a scan of all, duplicates by a scan of all vertices.",
        "Twice the mesh takes four times the work; looking sides up takes twice.",
        _quadratic_builder,
    ),
    Erratum(
        "A split moves a half-edge into a face that it does not know of", "thesis 4.1",
        "The half-edge before the split one becomes part of the new face.",
        "Its Next is set, its Face is not: it still names the old face.",
        _foreign_face,
    ),
    Erratum(
        "A collapse clears the very pairs it has just made", "thesis 4.2",
        "First the outer half-edges are paired, then both faces are removed.",
        "RemoveFace sets the opposite's opposite to null, which is the new pairing by then.",
        _cleared_pairs,
    ),
    Erratum(
        "Split face commits when it should not", "thesis 4.3",
        "if (isTransaction) CommitMeshTriangles()",
        "The condition is inverted: alone nothing is committed, in a transaction every step is.",
        _inverted_commit,
    ),
    Erratum(
        "The constant splits are linear", "thesis 4.1, 4.3 and 5",
        "SplitHalfEdge and SplitFace take constant time.",
        "Both create a vertex, and that searches all positions for a duplicate.",
        _search_for_duplicates,
    ),
    Erratum(
        "The vertex circulator is a scan", "thesis 5, table 1",
        "Table 1 gives O(n_ev) for the queries from a vertex.",
        "GetVertexCirculator looks at every half-edge of the mesh.",
        _scanning_circulator,
    ),
    Erratum(
        "Twice as many vertices as triangles", "thesis 7",
        "“ungefähr doppelt so viele Eckpunkte wie Dreiecke”",
        "It is the other way round, as the formula n_t ≈ 2 n_v and Euler say.",
        _twice_as_many,
    ),
    Erratum(
        "The bytes leave out what the classes have", "thesis 7.4 and 3.2.2",
        "228 bytes per vertex.",
        "There are an index per element, the event, the headers of the objects and the lists.",
        _bytes_left_out,
    ),
    Erratum(
        "A vertex keeps a half-edge that is gone", "thesis 4.2 (of erratum 4)",
        "All references are set from one vertex to the other.",
        "The half-edge of a vertex is not set anew when it is removed.",
        _kept_half_edge,
    ),
    Erratum(
        "A border edge cannot be collapsed", "thesis 4.2 (of erratum 4)",
        "The pair's face is taken apart as well.",
        "At the border there is no pair.",
        _border_collapse,
    ),
    Erratum(
        "No link condition", "thesis 4.2 (of erratum 4)",
        "Any half-edge can be collapsed.",
        "Of a tetrahedron two faces are left that lie on each other.",
        _no_link_condition,
    ),
    Erratum(
        "A split at an existing position welds", "thesis 3.3.2 and 4.3 (of erratum 6)",
        "CreateVertex gives the first vertex at the position.",
        "The new faces are joined to a vertex elsewhere in the mesh.",
        _silent_weld,
    ),
    Erratum(
        "Every split hands over the whole render mesh", "thesis 3.3.1 and 4.1 (of erratum 6)",
        "Local changes do not generate the whole net anew.",
        "CommitMeshTriangles turns the whole dictionary into a list.",
        _full_commit,
    ),
    Erratum(
        "Indices collide after a removal", "thesis 3.2.3; found here",
        "A new element gets the count of its list as its index.",
        "After a removal another element has that index, and in the cache of triangles its place.",
        _colliding_indices,
    ),
    Erratum(
        "After a collapse the render mesh shows other points", "thesis 3.3.1 and 4.2; found here",
        "Triangles name points by the index of the vertex, points are listed in order.",
        "Removing a vertex moves the points behind it up, and no index with them.",
        _shifted_render_mesh,
    ),
    Erratum(
        "A split adds its point to the render mesh twice", "thesis 4.1; found here",
        "AddMeshVertex(newPoint.Point), once per side of the edge.",
        "From the second split on the indices of new vertices lead to other points.",
        _doubled_render_point,
    ),
    Erratum(
        "Vertices without faces are never removed", "thesis 4.2; found here",
        "RemoveFace removes a vertex that has no half-edges left.",
        "It asks while the half-edges are still there, so the answer is never none.",
        _lonely_vertices,
    ),
    Erratum(
        "A third face at an edge steals the partner", "thesis 3.3.2; found here",
        "Half-edges between the same vertices are paired.",
        "Nothing asks whether they have a partner: his stays paired with a stranger.",
        _stolen_partner,
    ),
    Erratum(
        "Plankton's circulator takes many edges for a runaway", "quoted in thesis 5; found here",
        "if (count++ > 999) throw “Runaway vertex circulator”",
        "A vertex of more than a thousand half-edges is legal, and is not answered.",
        _runaway,
    ),
    Erratum(
        "Plankton's circulator does not need a closed mesh", "thesis 5; found here",
        "It works only on the assumption that no half-edge lacks its neighbor.",
        "In Plankton none does: the border has half-edges of its own.",
        _needs_no_closed_mesh,
    ),
    Erratum(
        "Breaking leaves a part of every split face behind", "thesis 4.3 and 4.4; found here",
        "The new faces are cut out of the mesh and become shards.",
        "The first part of a split face is no new one: it keeps its face, and stays in the hole.",
        _left_behind,
    ),
)  # fmt: skip
"""All of them, in the order in which they are numbered from 1."""

KNOWN = 9
"""The first so many were found by reading; some of the others are further parts of them."""
