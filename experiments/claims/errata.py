"""The errata of the thesis and of the article, each shown by running what is published.

Their texts stand in ``errata.toml``. A function for each runs the listing
(``structures.as_printed``) beside the sound version. ``bench_printed`` measures how costs grow.
"""

import tomllib
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from importlib.resources import files
from typing import NamedTuple, cast

import numpy as np

import hem
import structures
from structures.as_printed import AsPrinted, render_arrays
from structures.half_edge_objects import HalfEdgeMesh, fields_accessed
from structures.plankton import Plankton

KNOWN = 9  # the first so many errata were found by reading, the others by running

POINTS = np.vstack([np.eye(3), -np.eye(3)])
OCTAHEDRON = hem.TriangleMesh(
    POINTS, [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
)
TETRAHEDRON = hem.TriangleMesh(POINTS[:4], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
TRIANGLE = hem.TriangleMesh(POINTS[:3], [(0, 1, 2)])
BOOK = hem.TriangleMesh(POINTS[:5], [(0, 1, 2), (1, 0, 3), (0, 1, 4)])  # three faces at one edge

MIDDLE = (0.25, 0.25, 0.5)  # a position in the octahedron where nothing is yet

GIVES_UP = 999  # after so many steps Plankton takes a vertex for a runaway (quoted in thesis 5)

SMALLER, LARGER = 100, 400  # vertices of the two tori whose work is compared: four times as many

MISPLACED = "corners of the render mesh at another position"


class Shown(NamedTuple):
    """What a run gave: of what is published, of the sound version; whether it is an erratum."""

    printed: str
    sound: str
    confirmed: bool


class Erratum(NamedTuple):
    """What the text or the listing says, what it really does, and how that is shown."""

    title: str
    source: str
    says: str
    does: str
    show: Callable[[], Shown]


def printed(mesh: hem.TriangleMesh = OCTAHEDRON, whole: bool = True) -> AsPrinted:
    """The mesh as the listings build it."""
    built = AsPrinted.build(*render_arrays(mesh.points, mesh.triangles), whole=whole)
    built.generate_render_mesh()
    return built


def sound(mesh: hem.TriangleMesh = OCTAHEDRON) -> HalfEdgeMesh:
    """The same mesh as the sound version builds it."""
    return cast(HalfEdgeMesh, structures.build("half_edge_objects", mesh))


def _faults(m: AsPrinted, about: str = "") -> tuple[Counter[str], str]:
    """What does not hold together, of what has ``about`` in its name; and the same in words."""
    faults = Counter({what: often for what, often in m.faults().items() if about in what})
    return faults, "; ".join(f"{often} {what}" for what, often in faults.items()) or "nothing wrong"


def _valid(s: HalfEdgeMesh) -> str:
    s.validate()
    return f"valid: {s.n_faces} faces, {s.n_edges} edges"


def _attempt(call: Callable[[], object]) -> str:
    """What becomes of a call that should be refused."""
    try:
        call()
    except (hem.NonManifoldError, hem.TopologyError) as error:
        return f"refused: {error.reason}"
    except AttributeError as error:
        return f"a null reference: {error}"
    return "done"


def _grows(
    as_printed: Callable[[hem.TriangleMesh, AsPrinted], object],
    as_sound: Callable[[hem.TriangleMesh, HalfEdgeMesh], object],
    at_least: float, at_most: float,
) -> Shown:  # fmt: skip
    """How the work of a call on a mesh and what is built of it grows from torus to torus."""
    work = []
    for n in (SMALLER, LARGER):
        mesh = hem.generate("torus", n)
        m, s = printed(mesh), sound(mesh)
        s.move_vertex(0, s.points[0])  # binds the operations
        calls = partial(as_printed, mesh, m), partial(as_sound, mesh, s)
        work.append([fields_accessed(call) for call in calls])
    one, other = (large / small for small, large in zip(*work, strict=True))
    words = f"× the work in a mesh of {LARGER // SMALLER} × the vertices"
    return Shown(f"{one:.1f} {words}", f"{other:.1f} {words}", one > at_least and other < at_most)


def _last_triangle() -> Shown:
    m, s = printed(whole=False), sound()
    faces, unpaired = len(m.faces), sum(h.opposite is None for h in m.half_edges)
    return Shown(
        f"{faces} faces, {unpaired} half-edges without a partner",
        f"{s.n_faces} faces, {sum(h.opposite is None for h in s.half_edges)} without a partner",
        (faces, unpaired) == (7, 3),
    )


def _quadratic_builder() -> Shown:
    return _grows(lambda mesh, m: printed(mesh), lambda mesh, s: sound(mesh), 12, 5)


def _foreign_face() -> Shown:
    m, s = printed(), sound()
    m.split_half_edge(m.half_edges[0], MIDDLE)
    s.split_edge(s.half_edges[0].edge, MIDDLE)
    faults, words = _faults(m)
    return Shown(words, _valid(s), faults["half-edges with another face than the next one"] == 4)


def _cleared_pairs() -> Shown:
    m, s = printed(), sound()
    m.collapse_edge(m.half_edges[0])
    s.collapse_edge(s.half_edges[0].edge)
    faults, words = _faults(m, "half-edge")
    cleared = faults["half-edges without an opposite, though there is one"]
    return Shown(words, _valid(s), cleared == 4)


def _kept_half_edge() -> Shown:
    meshes = [printed() for _ in range(24)]
    for i, m in enumerate(meshes):
        m.collapse_edge(m.half_edges[i])
    kept = sum("vertices with a half-edge that is gone" in m.faults() for m in meshes)
    s = sound()
    s.collapse_edge(s.half_edges[0].edge)
    return Shown(f"after {kept} of 24 collapses a vertex keeps one", _valid(s), kept > 0)


def _border_collapse() -> Shown:
    m, s = printed(TRIANGLE), sound(TRIANGLE)
    words = _attempt(lambda: m.collapse_edge(m.half_edges[0]))
    refusal = _attempt(lambda: s.collapse_edge(0))
    return Shown(words, refusal, "null" in words and "refused" in refusal)


def _no_link_condition() -> Shown:
    m, s = printed(TETRAHEDRON), sound(TETRAHEDRON)
    m.collapse_edge(m.half_edges[0])
    corners = [frozenset(h.origin.index for h in m.face_circulator(f)) for f in m.faces]
    coincident = len(corners) == 2 and len(set(corners)) == 1
    refusal = _attempt(lambda: s.collapse_edge(0))
    return Shown("two coincident faces are left of a tetrahedron", refusal, coincident)


def _inverted_commit() -> Shown:
    m, commits = printed(), []
    for is_transaction in (False, True):
        before = m.render.commits
        m.split_face(m.faces[0], (9.0, 9.0, float(is_transaction)), is_transaction)
        commits.append(m.render.commits - before)
    render = hem.RenderMesh(s := sound())
    s.split_face(0, (9, 9, 0))
    single = render.commits
    with render.transaction():
        s.split_face(1, (9, 9, 1))
        within = render.commits - single
    return Shown(
        f"{commits[0]} commits outside a transaction, {commits[1]} inside",
        f"{single} outside, {within} inside",
        (*commits, single, within) == (0, 1, 1, 0),
    )


def _search_for_duplicates() -> Shown:
    there = (9.0, 9.0, 9.0)
    return _grows(
        lambda mesh, m: m.split_face(m.faces[0], there),
        lambda mesh, s: s.split_face(0, there), 2, 1.1,
    )  # fmt: skip


def _scanning_circulator() -> Shown:
    return _grows(
        lambda mesh, m: m.vertex_circulator(m.vertices[0]),
        lambda mesh, s: s.vertices.circulator(s.vertices[0]), 3.9, 1.1,
    )  # fmt: skip


def _stepping_collapse() -> Shown:
    def collapse(mesh: hem.TriangleMesh, m: AsPrinted) -> None:
        m.stepping = True
        m.collapse_edge(m.half_edges[0])

    return _grows(collapse, lambda mesh, s: s.collapse_edge(s.half_edges[0].edge), 3.5, 1.1)


def _there_and_back() -> Shown:
    reads = []
    for valence in (8, 64):
        s = structures.build("winged_edge", hem.valence_mesh(valence, 256))
        hub = np.asarray(hem.valence_hubs(valence, 256))[:1]
        asked = ("edge_faces", s.vertex_edges(hub).values[:1]), ("vertex_edges", hub)
        reads.append([int(s.work(query, handles)[0]) for query, handles in asked])
    (there, back), (still_there, further_back) = reads
    return Shown(
        f"from an edge to its faces {there} accesses at a valence of 8, {still_there} at 64",
        f"from a vertex to its edges {back} and {further_back}, as table 1 says",
        there == still_there and further_back > 4 * back,
    )


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
    sizes: list[int] = []
    uploads: list[int] = []
    for n in (SMALLER, LARGER):
        mesh = hem.generate("torus", n)
        m, s = printed(mesh), sound(mesh)
        m.split_half_edge(m.half_edges[0], (9.0, 9.0, 9.0))
        sizes.append(len(m.render.committed))
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
    faults, words = _faults(m, "index")
    return Shown(words, _valid(s), bool(faults))


def _shifted_render_mesh() -> Shown:
    m, s = printed(), sound()
    m.collapse_edge(m.half_edges[0])
    render = hem.RenderMesh(s)
    s.collapse_edge(s.half_edges[0].edge)
    wrong = m.faults().get(MISPLACED, 0)
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
    points, misplaced = len(m.render.points), m.faults().get(MISPLACED, 0)
    return Shown(
        f"{points} points for {len(m.vertices)} vertices, {misplaced} corners at another position",
        f"{len(hem.RenderMesh(s).points) // 3} points for {s.n_vertices} vertices",
        points == len(m.vertices) + 2 and misplaced > 0,
    )


def _lonely_vertices() -> Shown:
    m, s = printed(TRIANGLE), sound(TRIANGLE)
    m.remove_face(m.faces[0])
    s.remove_face(0)
    s.validate()
    return Shown(
        f"{len(m.vertices)} vertices are left, though the listing means to remove them",
        f"{s.n_vertices} vertices are left, as documented: remove_face keeps vertices",
        len(m.vertices) == 3,
    )


def _stolen_partner() -> Shown:
    faults, words = _faults(printed(BOOK), "opposite has")
    refusal = _attempt(lambda: sound(BOOK))
    return Shown(words, refusal, bool(faults) and refusal.startswith("refused"))


def _runaway() -> Shown:
    valence = 2_000
    s = cast(Plankton, structures.build("plankton", hem.valence_mesh(valence, 2 * valence)))
    hub = int(hem.valence_hubs(valence, 2 * valence)[0])
    start = s.outgoing_half_edge(hub)
    h, steps = s.next_half_edge(s.pair(start)), 0
    while steps <= GIVES_UP and h != start:  # as quoted in thesis 5
        h, steps = s.next_half_edge(s.pair(h)), steps + 1
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
    m, s = printed(), structures.build("half_edge", OCTAHEDRON)
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


_TEXTS = tomllib.loads((files("experiments.claims") / "errata.toml").read_text("utf-8"))
ERRATA = tuple(
    Erratum(it["title"], it["source"], it["says"], it["does"], globals()[f"_{it['show']}"])
    for it in _TEXTS["erratum"]
)
"""All of them, in the order in which they are numbered from 1."""
