"""The errata of thesis 4.4 to 7, and of listings that no compiler takes, as in ``errata.py``."""

from dataclasses import replace
from typing import Any

import numpy as np

import hem
import structures
from experiments.claims.beside import LARGER, MIDDLE, OCTAHEDRON, Shown, attempt, printed, sound
from experiments.claims.demonstrations import TOUCHING, coincident_vertices
from hem.fracture import MATERIALS, shatter
from hem.fracture.surface import break_points
from structures import printed_breaking as listings
from structures.objects import HalfEdge, Vertex
from structures.plankton import Plankton

GLASS = MATERIALS["glass"]
IMPACT = (-4.7, 5.2)  # in a plate of ten by ten, inside a face


def _plate(across: int) -> tuple[hem.TriangleMesh, tuple[float, float, float]]:
    """A square of 10 units over x and another axis, and an impact on it."""
    flat = hem.generate("grid", 100)
    points, impact = np.zeros_like(flat.points), np.zeros(3)
    points[:, [0, across]] = 10 * flat.points[:, :2]
    impact[[0, across]] = IMPACT
    x, y, z = impact.tolist()
    return hem.TriangleMesh(points, flat.triangles), (x, y, z)


def height_kept() -> Shown:
    """Break points of a level plate and of an upright one, as published and as corrected."""
    published, corrected = [], []
    for across in (2, 1):
        mesh, impact = _plate(across)
        m, scattered = printed(mesh), listings.breaking_points(impact, GLASS.circles)
        published.append(sum(listings.face_containing(m, it) is not None for it in scattered))
        s = structures.build("half_edge", mesh, compiled=False)
        outside = shatter(s, impact, GLASS, scale=1.0).counts["outside"]
        corrected.append(len(scattered) - outside)
    words = f"of {sum(GLASS.circles)} break points on a level plate, {{}} on an upright one"
    (level, upright), (even, also_upright) = published, corrected
    confirmed = upright < level / 2 and even == also_upright
    said = f"{level} {words.format(upright)}", f"{even} {words.format(also_upright)}"
    return Shown(*said, confirmed)


def discs() -> Shown:
    """How many break points of the largest circle lie in the one before it."""
    count, before = GLASS.circles[-1], len(GLASS.circles) - 1.5
    every = listings.breaking_points((0.0, 0.0, 0.0), GLASS.circles), break_points(GLASS, 0, 1.0)
    far = [np.linalg.norm(it[-count:], axis=1) for it in every]
    inside, also = (int((it < before).sum()) for it in far)
    words = f"of {count} break points of the last circle lie in the one before it"
    kept = f"{also} {words}: kept, as breaking is finer inside"
    return Shown(f"{inside} {words}", kept, inside > 0)


def left_behind() -> Shown:
    """What stays of the face that is struck."""
    m, s = printed(), structures.build("half_edge", OCTAHEDRON, compiled=False)
    shards = listings.simulate_breaking(m, MIDDLE, ())
    points = [[h.origin.point for h in m.face_circulator(face)] for face in m.faces]
    rest = shatter(s, MIDDLE, replace(GLASS, circles=())).rest[0]
    every = np.array(points), rest.points[rest.triangles]  # (n, 3, 3)
    # The first face of the octahedron is where x + y + z = 1.
    left, also = (int(np.isclose(it.sum(axis=2), 1).all(axis=1).sum()) for it in every)
    words = "of the face that was struck"
    printed_words = f"{len(shards)} shards, and {left} part {words} stays behind"
    return Shown(printed_words, f"{also} parts {words} stay behind", left > 0 == also)


def runaway() -> Shown:
    """A vertex of many edges, walked around as quoted."""
    valence = 2_000
    s = Plankton.uncompiled().build(hem.valence_mesh(valence, 2 * valence))
    hub, steps, gives_up = int(hem.valence_hubs(valence, 2 * valence)[0]), 0, False
    try:
        for _ in listings.quoted_circulator(s, s.outgoing_half_edge(hub)):
            steps += 1
    except LookupError:
        gives_up = True
    words, around = f"gives up after {steps:,} of {valence:,} half-edges", s.valence(hub)
    return Shown(words, f"{around:,} half-edges", gives_up and around == valence)


def needs_no_closed_mesh() -> Shown:
    """Vertices at a border, walked around."""
    s = Plankton.uncompiled().build(hem.generate("grid", LARGER))
    border, leaving = np.flatnonzero(s.is_border()), np.bincount(s.start_vertex(s.half_edges()))
    walks = [[*listings.quoted_circulator(s, s.outgoing_half_edge(v))] for v in border.tolist()]
    answered = int((leaving[border] == list(map(len, walks))).sum())
    return Shown(
        "“works only if no half-edge lacks its neighbor”",
        f"comes round at all {answered} vertices on the border of a grid: it has half-edges, too",
        answered == len(border) > 0,
    )


def guard_one_short() -> Shown:
    """The half-edge behind the last one, as the quoted guard and as ours take it."""
    s = Plankton.uncompiled().build(OCTAHEDRON)
    count = len(s.half_edges())
    given = next(listings.quoted_circulator(s, count), None)
    refusal = attempt(lambda: s.next_half_edge(count))
    words = f"gives half-edge {given} of a mesh whose last one is {count - 1}"
    return Shown(words, refusal, given == count and refusal.startswith("refused"))


def other_types() -> Shown:
    """Statements of listings, as published and as mended: the declared type, and what is set."""
    m, s = printed(), sound()
    mine, other = m.faces[0], s.faces[0]
    around = s.faces.circulator(other)
    points, _ = listings.quad()
    published = [
        (list, Vertex, [it.point for it in m.vertices]),  # 3.3.1: List<Vertex>, of points
        (HalfEdge, HalfEdge, m.face_circulator(mine)),  # 3.3.1: HalfEdge, a List of them
        (list, tuple, points),  # 3.3.2: List<Vector3>, an array
        (list, HalfEdge, filter(lambda h: h.face is mine, m.half_edges)),  # 3.3.2: .Where, lazy
        (list, HalfEdge, (h.next for h in m.face_circulator(mine))),  # 4.4: .Select, lazy
        (Vertex, Vertex, mine.half_edge.origin.point),  # 4.4: Vertex, a point
    ]
    mended = [
        (list, tuple, [it.point for it in s.vertices]),
        (list, HalfEdge, around),
        (list, tuple, [tuple(it) for it in points.tolist()]),
        (list, HalfEdge, [h for h in s.half_edges if h.face is other]),
        (list, HalfEdge, [h.next for h in around]),
        (Vertex, Vertex, other.half_edge.origin),
    ]
    wrong, still = (sum(not _is_declared(*it) for it in every) for every in (published, mended))
    words = f"of {len(published)} statements set something of another type than they declare"
    return Shown(f"{wrong} {words}", f"{still} {words}", wrong == len(published) and not still)


def _is_declared(kind: type[Any], of: type[Any], value: Any) -> bool:
    """Whether a value is of a type, and a list one of elements of a type."""
    return isinstance(value, kind) and (kind is of or all(isinstance(it, of) for it in value))


def twice_as_many() -> Shown:
    """Faces per vertex."""
    s = hem.generate("torus", LARGER).summary()
    counted = f"n_t = {s.faces / s.vertices:g} n_v on a torus"
    return Shown("n_v ≈ 2 n_t", counted, s.faces == 2 * s.vertices)


def bytes_left_out() -> Shown:
    """Bytes with all that the classes have."""
    mesh = hem.generate("torus", LARGER)
    total = sum(sound(mesh).clr_memory().values()) / len(mesh.points)
    return Shown("228 bytes per vertex", f"{total:g} with all that the classes have", total > 228)


def closed_only() -> Shown:
    """Bytes of a mesh with a border, beside the sum of thesis 7 for its vertices and faces."""
    s = structures.build("winged_edge", hem.generate("grid", LARGER), 8, compiled=False)
    held, edges, n = sum(s.memory().values()), 1.5 * s.n_faces, s.n_vertices
    told = 20 * n + 8 * s.n_faces + 64 * edges
    return Shown(
        f"{edges:,.0f} edges and {told:,.0f} bytes by 7.3, of a grid of {n} vertices",
        f"{s.n_edges:,} edges and {held:,} bytes, {held / n:.3g} per vertex and not 228",
        edges < s.n_edges and told < held,
    )


def coincident() -> Shown:
    """Vertices at the position of another, of a sheet that meets itself: as it is, and welded."""
    welded = hem.mesh_from_render(TOUCHING.points, TOUCHING.triangles[:, [0, 2, 1]].reshape(-1))
    found, left = (int(*coincident_vertices(it)) for it in (TOUCHING, welded))
    words = "vertices at the position of another, in a valid half-edge mesh"
    return Shown(f"{words}: {found}", f"{left} where points are welded before", found > 0 == left)
