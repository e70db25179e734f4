"""The errata of the thesis and of the article, each shown by running what is published.

Their texts stand in ``errata.toml``. A function for each runs the listing
(``structures.as_printed``) beside the sound version; those of thesis 4.4 on stand in
``later_errata``. ``bench_printed`` measures how costs grow.
"""

import tomllib
from collections.abc import Callable
from functools import partial
from importlib.resources import files
from typing import NamedTuple

import numpy as np

import hem
import structures
from experiments.claims import beside, later_errata
from experiments.claims.beside import Shown, attempt, faults_of, printed, require_valid, sound
from structures.as_printed import AsPrinted
from structures.half_edge_objects import HalfEdgeMesh, fields_accessed

KNOWN = 9  # the first so many errata were found by reading, the others by running

MISPLACED = "corners of the render mesh at another position"


class Erratum(NamedTuple):
    """What the text or the listing says, what it really does, and how that is shown."""

    title: str
    source: str
    says: str
    does: str
    show: Callable[[], Shown]


def _grows(
    as_printed: Callable[[hem.TriangleMesh, AsPrinted], object],
    as_sound: Callable[[hem.TriangleMesh, HalfEdgeMesh], object],
    at_least: float, at_most: float,
) -> Shown:  # fmt: skip
    """How the work of a call on a mesh and what is built of it grows from torus to torus."""
    work = []
    for n in (beside.SMALLER, beside.LARGER):
        mesh = hem.generate("torus", n)
        m, s = printed(mesh), sound(mesh)
        s.move_vertex(0, s.points[0])  # binds the operations
        calls = partial(as_printed, mesh, m), partial(as_sound, mesh, s)
        work.append([fields_accessed(call) for call in calls])
    one, other = (large / small for small, large in zip(*work, strict=True))
    words = f"× the work in a mesh of {beside.LARGER // beside.SMALLER} × the vertices"
    return Shown(f"{one:.1f} {words}", f"{other:.1f} {words}", one > at_least and other < at_most)


def _last_triangle() -> Shown:
    m, s = printed(whole=False), sound()
    unpaired, also = (sum(h.opposite is None for h in it.half_edges) for it in (m, s))
    words = f"{len(m.faces)} faces, {unpaired} half-edges without a partner"
    corrected = f"{s.n_faces} faces, {also} without a partner"
    return Shown(words, corrected, (len(m.faces), unpaired) == (7, 3))


def _foreign_face() -> Shown:
    m, s = printed(), sound()
    m.split_half_edge(m.half_edges[0], beside.MIDDLE)
    s.split_edge(s.half_edges[0].edge, beside.MIDDLE)
    faults, words = faults_of(m)
    lost = faults["half-edges with another face than the next one"]
    return Shown(words, require_valid(s), lost == 4)


def _cleared_pairs() -> Shown:
    m, s = printed(), sound()
    m.collapse_edge(m.half_edges[0])
    s.collapse_edge(s.half_edges[0].edge)
    faults, words = faults_of(m, "half-edge")
    cleared = faults["half-edges without an opposite, though there is one"]
    return Shown(words, require_valid(s), cleared == 4)


def _kept_half_edge() -> Shown:
    meshes = [printed() for _ in range(24)]
    for i, m in enumerate(meshes):
        m.collapse_edge(m.half_edges[i])
    kept = sum("vertices with a half-edge that is gone" in m.faults() for m in meshes)
    s = sound()
    s.collapse_edge(s.half_edges[0].edge)
    return Shown(f"after {kept} of 24 collapses a vertex keeps one", require_valid(s), kept > 0)


def _border_collapse() -> Shown:
    m, s = printed(beside.PAIR), sound(beside.PAIR)
    words = attempt(lambda: m.collapse_edge(m.half_edges[0]))
    s.collapse_edge(s.half_edges[0].edge)
    return Shown(words, require_valid(s), "null" in words and s.n_faces == 1)


def _no_link_condition() -> Shown:
    m, s = printed(beside.TETRAHEDRON), sound(beside.TETRAHEDRON)
    m.collapse_edge(m.half_edges[0])
    corners = [frozenset(h.origin.index for h in m.face_circulator(f)) for f in m.faces]
    coincident = len(corners) == 2 and len(set(corners)) == 1
    refusal = attempt(lambda: s.collapse_edge(0))
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
    words = f"{commits[0]} commits outside a transaction, {commits[1]} inside"
    confirmed = (*commits, single, within) == (0, 1, 1, 0)
    return Shown(words, f"{single} outside, {within} inside", confirmed)


def _collapse_stepping(mesh: hem.TriangleMesh, m: AsPrinted) -> None:
    m.stepping = True
    m.collapse_edge(m.half_edges[0])


# fmt: off
GROWS = {
    "quadratic_builder": (lambda mesh, m: printed(mesh), lambda mesh, s: sound(mesh), 12, 5),
    "search_for_duplicates": (
        lambda mesh, m: m.split_face(m.faces[0], (9.0, 9.0, 9.0)),
        lambda mesh, s: s.split_face(0, (9.0, 9.0, 9.0)), 2, 1.1),
    "scanning_circulator": (
        lambda mesh, m: m.vertex_circulator(m.vertices[0]),
        lambda mesh, s: s.vertices.circulator(s.vertices[0]), 3.9, 1.1),
    "stepping_collapse": (
        _collapse_stepping, lambda mesh, s: s.collapse_edge(s.half_edges[0].edge), 3.5, 1.1),
}
# fmt: on
"""What is shown by how work grows: see `_grows`."""


def _there_and_back() -> Shown:
    reads = []
    for valence in (8, 64):
        s = structures.build("winged_edge", hem.valence_mesh(valence, 256), compiled=False)
        hub = np.asarray(hem.valence_hubs(valence, 256))[:1]
        asked = ("edge_faces", s.vertex_edges(hub).values[:1]), ("vertex_edges", hub)
        reads.append([int(s.work(query, handles)[0]) for query, handles in asked])
    (there, back), (still_there, further_back) = reads
    words = f"from an edge to its faces {there} accesses at a valence of 8, {still_there} at 64"
    also = f"from a vertex to its edges {back} and {further_back}, as table 1 says"
    return Shown(words, also, there == still_there and further_back > 4 * back)


def _silent_weld() -> Shown:
    m, s = printed(), sound()
    there = m.vertices[3].point
    m.split_face(m.faces[0], there)
    s.split_face(0, there)
    many = len(m.vertices), s.n_vertices
    words = f"{many[0]} vertices after a split at the position of another"
    return Shown(words, f"{many[1]} vertices", many == (6, 7))


def _full_commit() -> Shown:
    sizes: list[int] = []
    uploads: list[int] = []
    for n in (beside.SMALLER, beside.LARGER):
        mesh = hem.generate("torus", n)
        m, s = printed(mesh), sound(mesh)
        m.split_half_edge(m.half_edges[0], (9.0, 9.0, 9.0))
        sizes.append(len(m.render.committed))
        render = hem.RenderMesh(s)
        s.split_face(0, (9, 9, 9))  # makes room
        render.subscribe(lambda it: uploads.append(3 * int(np.diff(it.triangles).sum())))
        s.split_edge(s.half_edges[0].edge, (9, 9, 8))
    words = f"a split hands over {sizes[0]:,} and {sizes[1]:,} indices"
    also = f"it hands over {uploads[0]} and {uploads[1]}"
    return Shown(words, also, sizes[1] > 3.5 * sizes[0] and uploads[0] == uploads[1])


def _colliding_indices() -> Shown:
    m, s = printed(), sound()
    m.remove_face(m.faces[0])
    m.split_face(m.faces[0], beside.MIDDLE)
    s.remove_face(0)
    s.split_face(1, beside.MIDDLE)
    faults, words = faults_of(m, "index")
    return Shown(words, require_valid(s), bool(faults))


def _shifted_render_mesh() -> Shown:
    m, s = printed(), sound()
    m.collapse_edge(m.half_edges[0])
    render = hem.RenderMesh(s)
    s.collapse_edge(s.half_edges[0].edge)
    wrong, faces = m.faults().get(MISPLACED, 0), len(render.to_triangles().triangles)
    beyond = max(m.render.committed) >= len(m.render.points)
    words = f"{wrong} of {3 * len(m.faces)} corners show another position"
    words += ", some beyond the last point" if beyond else ""
    kept = f"the render mesh has the {faces} faces of the structure"
    return Shown(words, kept, wrong > 0 and faces == s.n_faces)


def _doubled_render_point() -> Shown:
    m, s = printed(), sound()
    for i, z in enumerate((0.5, 0.25)):
        m.split_half_edge(m.half_edges[i], (0.25, 0.25, z))
        s.split_edge(s.half_edges[i].edge, (0.25, 0.25, z))
    points, vertices = len(m.render.points), len(m.vertices)
    misplaced = m.faults().get(MISPLACED, 0)
    words = f"{points} points for {vertices} vertices, {misplaced} corners at another position"
    also = f"{len(hem.RenderMesh(s).points) // 3} points for {s.n_vertices} vertices"
    return Shown(words, also, points == vertices + 2 and misplaced > 0)


def _lonely_vertices() -> Shown:
    m, s = printed(beside.TRIANGLE), sound(beside.TRIANGLE)
    m.remove_face(m.faces[0])
    s.remove_face(0)
    s.validate()
    words = f"{len(m.vertices)} vertices are left, though the listing means to remove them"
    also = f"{s.n_vertices} vertices are left, as documented: remove_face keeps vertices"
    return Shown(words, also, len(m.vertices) == 3)


def _stolen_partner() -> Shown:
    faults, words = faults_of(printed(beside.BOOK), "opposite has")
    refusal = attempt(lambda: sound(beside.BOOK))
    return Shown(words, refusal, bool(faults) and refusal.startswith("refused"))


_TEXTS = tomllib.loads((files("experiments.claims") / "errata.toml").read_text("utf-8"))
_SHOWS = vars(later_errata) | {name[1:]: it for name, it in globals().items() if name[0] == "_"}
_SHOWS |= {name: partial(_grows, *it) for name, it in GROWS.items()}
ERRATA = tuple(Erratum(**it, show=_SHOWS[name]) for name, it in _TEXTS.items())
"""All of them, in the order in which they are numbered from 1."""
