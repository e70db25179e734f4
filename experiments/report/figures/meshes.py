"""Meshes as pictures: the figures of the thesis, made by the operations themselves."""

import base64
import gzip
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

import hem
import structures
from experiments.bench_workloads import simplification
from experiments.report.pages import Html, page
from experiments.report.style import grid, styled, words
from hem.arrays import Array
from hem.contract import Structure
from hem.fracture.show import AXES, FractureScene, Picture
from structures.plankton import Plankton

PAPER = "#f4f1ea"
TOUCHED = "#f7d9a0"
INK = "#333333"
STRONG = "#c0392b"

SAND = (0.96, 0.82, 0.55)

Step = tuple[str, Structure, dict[str, Any]]
"""A title, a mesh, and what to point out in it: ``faces``, ``edges``, ``arrows``, ``vertices``."""


def hexagon() -> hem.TriangleMesh:
    """Two inner vertices joined by an edge, in a ring of eight: enough to see an operation."""
    angle = 2 * np.pi * np.arange(8) / 8
    ring = np.stack([1.7 * np.cos(angle), 1.05 * np.sin(angle)], axis=1)
    points = np.vstack([[-0.6, 0.0], [0.6, 0.0], ring])
    fans = [(1, i) for i in (6, 7, 8, 9)] + [(0, i) for i in (2, 3, 4, 5)]
    triangles = [(center, 2 + i % 8, 2 + (i + 1) % 8) for center, i in fans]
    return hem.TriangleMesh(np.pad(points, ((0, 0), (0, 1))), [*triangles, (0, 1, 4), (1, 0, 8)])


def quad() -> hem.TriangleMesh:
    """A square of two triangles; their common edge is the one to be split."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    return hem.TriangleMesh(points, [(0, 1, 2), (0, 2, 3)])


def steps(every: Sequence[Step], labels: bool = True) -> Figure:
    """Flat meshes side by side, with their vertices numbered."""
    with styled():
        titles, *_ = zip(*every, strict=True)
        widths = [np.ptp(s.points[s.vertices(), 0]) for _, s, _ in every]
        figure, panels = grid(titles, (3.1, 2.7), sharey=True, width_ratios=widths)
        for axes, (_, s, shown) in zip(panels, every, strict=True):
            _draw_flat(axes, s, shown, labels)
    return figure


def _draw_flat(axes: Axes, s: Structure, shown: dict[str, Any], labels: bool) -> None:
    corners, flat = s.face_vertices(s.faces()), s.points[:, :2]
    marked = np.isin(s.faces(), list(shown.get("faces", ())))
    look: dict[str, Any] = {"facecolors": np.where(marked, TOUCHED, PAPER), "edgecolors": INK}
    axes.add_collection(PolyCollection([flat[row] for row in corners], **look))
    for a, b in shown.get("edges", ()):
        axes.plot(*flat[[a, b]].T, color=STRONG, linewidth=2.6, solid_capstyle="round")
    for a, b in shown.get("arrows", ()):
        look = {"arrowstyle": "-|>", "color": STRONG, "linewidth": 2, "shrinkA": 5, "shrinkB": 5}
        axes.annotate("", flat[b], flat[a], arrowprops=look)
    used = np.unique(corners.values)
    strong = np.isin(used, list(shown.get("vertices", ())))
    sizes, tones = np.where(strong, 42, 12), np.where(strong, STRONG, INK)
    axes.scatter(flat[used, 0], flat[used, 1], sizes, list(tones), zorder=3)
    place: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "va": "center"}
    for v in used.tolist() if labels else ():
        x, y = 10 * off_edges(s, v)
        axes.annotate(str(v), flat[v], (x, y), fontsize=8, **place)
    axes.margins(0.12)
    axes.set_aspect("equal")
    axes.axis("off")


def off_edges(s: Structure, v: int) -> Array:
    """The direction from a vertex of a flat mesh into the widest gap between its edges."""
    x, y = (s.points[s.vertex_vertices(v)] - s.points[v])[:, :2].T
    angles = np.sort(np.arctan2(y, x))
    gaps = np.diff(angles, append=angles[0] + 2 * np.pi)
    middle = (angles + gaps / 2)[gaps.argmax()]
    return np.array([np.cos(middle), np.sin(middle)])


def _step(title: str, s: Structure, edit: hem.Edit | None = None, **marked: Any) -> Step:
    """The mesh as it is; after an operation what that made, and the vertex it is about."""
    if edit is not None:
        made = {"faces": [*edit.created_faces, *edit.changed_faces], "vertices": [edit.vertex]}
        marked = {**made, **marked}
    return title, s.copy(), marked


def edge_of(s: Structure, a: int = 0, b: int = 1) -> int:
    """The edge that joins two vertices; in the hexagon the inner ones."""
    edge = s.find_edge(a, b)
    assert edge is not None
    return edge


def plankton_walk() -> Figure:
    """The article's figures 6 to 9: faces added around vertex 2, and the half-edge that it has."""
    s = Plankton.uncompiled().build(
        hem.PolygonMesh([(0, 0, 0), (1, 0, 0), (0.5, 0.5, 0)], [(0, 1, 2)])
    )
    added = {(): None, (2, 1, 3): (1, 1, 0), (2, 3, 4): (0, 1, 0), (0, 2, 4): None}
    shown: list[Step] = []
    for corners, point in added.items():
        if point is not None:
            s.add_vertex(point)
        faces: Any = s.add_face(*corners).created_faces if corners else []
        title = f"Face {' '.join(map(str, corners))} added" if corners else "One face"
        lies = "on the border" if s.vertex_naked_edges(2) else "inside"
        end = s.end_vertex(s.outgoing_half_edge(2))
        title += f"\nvertex 2 {lies}: 2 → {end}"
        shown.append(_step(title, s, faces=faces, arrows=[(2, end)], vertices=[2]))
    return steps(shown)


def polygon_steps() -> Figure:
    """What Plankton's half-edges do with polygons, each on a fresh sheet of four quads."""

    def cut(s: Plankton) -> list[int]:
        a, _, c, _ = s.face_half_edges(0).tolist()
        half_edge = s.split_face(a, c)
        return [s.adjacent_face(half_edge), s.adjacent_face(s.pair(half_edge))]

    changes: dict[str, Callable[[Plankton], list[int]]] = {
        "Four quads": lambda s: [],
        "split_face: a diagonal": cut,
        "merge_faces": lambda s: [s.merge_faces(s.find_half_edge(1, 4) or 0)],
        "stellate": lambda s: [0, *s.stellate(0).created_faces],
        "erase_center_vertex": lambda s: [s.erase_center_vertex(4)],
        "truncate_vertex": lambda s: [s.truncate_vertex(4)],
    }
    points = [(x, y, 0) for y in range(3) for x in range(3)]
    quads = [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)]
    sheets = {
        title: Plankton.uncompiled().build(hem.PolygonMesh(points, quads)) for title in changes
    }
    shown: list[Step] = [(it, s, {"faces": changes[it](s)}) for it, s in sheets.items()]
    return steps(shown, labels=False)


def split_edge_steps(structure: str) -> Figure:
    """Figure 5: an edge is split, inside and on the border."""
    s = structures.build(structure, hexagon(), compiled=False)
    edge = edge_of(s)
    before = _step("An edge, and the faces at it", s, faces=s.edge_faces(edge), edges=[(0, 1)])
    inside = _step("split: 1 vertex, 3 edges,\n2 faces more", s, s.split_edge(edge, (0, 0.0, 0)))
    edit = s.split_edge(edge_of(s, 2, 3), 0.5 * (s.points[2] + s.points[3]))
    return steps([before, inside, _step("on the border: 1 vertex,\n2 edges, 1 face more", s, edit)])


def split_as_printed() -> Figure:
    """Erratum 3: a half-edge that moves into the new face and still names the old one."""
    from structures.as_printed import AsPrinted, render_arrays

    whole = structures.build("half_edge", quad(), compiled=False)
    m = AsPrinted.build(*render_arrays(quad().points, quad().triangles), whole=True)
    diagonal = next(h for h in m.half_edges if h.opposite is not None)
    m.split_half_edge(diagonal, (0.5, 0.5, 0.0))
    corners = [[h.origin.index for h in m.face_circulator(face)][::-1] for face in m.faces]
    s = Plankton.uncompiled().build(hem.PolygonMesh([v.point for v in m.vertices], corners))
    wrong = [(h.origin.index, h.end.index) for h in m.half_edges if h.next.face is not h.face]
    before = _step("A quad", whole, edges=[(0, 2)])
    return steps([before, _step("split as published", s, arrows=wrong, vertices=[4])])


def quad_splits(structure: str) -> Figure:
    """Figure 6: a quad split in its middle, a quarter up its left side, and a unit off that."""
    places = {
        "in the middle": ((0, 2), (0.5, 0.5, 0)),
        "a quarter up\nits left side": ((0, 3), (0.0, 0.25, 0)),
        "a unit left\nof that side": ((0, 3), (-1.0, 0.5, 0)),
    }
    every = [_step("The quad", structures.build(structure, quad(), compiled=False), edges=[(0, 2)])]
    for title, (edge, place) in places.items():
        s = structures.build(structure, quad(), compiled=False)
        every.append(_step(title, s, s.split_edge(edge_of(s, *edge), place)))
    return steps(every)


def collapse_steps(structure: str) -> Figure:
    """Figure 7: an edge collapses into one of its ends."""
    s = structures.build(structure, hexagon(), compiled=False)
    edge, ends = edge_of(s), [(0, 1)]
    before = _step("Vertex 0 is to merge into 1", s, faces=s.vertex_faces(0), edges=ends)
    gone = _step("These two faces vanish", s, faces=s.edge_faces(edge), edges=ends)
    edit = s.collapse_edge(edge, keep=1)
    return steps([before, gone, _step("collapsed: 1 vertex, 3 edges,\n2 faces fewer", s, edit)])


def split_face_steps(structure: str) -> Figure:
    """Figure 9: a face is split; and every face is."""
    s = structures.build(structure, hexagon(), compiled=False)
    before, whole = _step("A face", s, faces=[0]), s.copy()
    every = _step("all faces split", whole, vertices=whole.split_all_faces())
    edit = s.split_face(0, s.points[s.face_vertices(0)].mean(axis=0))
    one = _step("split: 1 vertex, 3 edges,\n2 faces more", s, edit)
    return steps([before, one, every], labels=False)


def flip_steps(structure: str) -> Figure:
    """An edge is turned within its two faces, and turned back."""
    s = structures.build(structure, hexagon(), compiled=False)
    edge = edge_of(s)
    before = _step("An edge", s, faces=s.edge_faces(edge), edges=[(0, 1)])
    flipped = _step("flipped: no count changes", s, s.flip_edge(edge), edges=[(4, 8)])
    edit = s.flip_edge(edge_of(s, 4, 8))
    return steps([before, flipped, _step("flipped again: as it was", s, edit, edges=[(0, 1)])])


def shaded(meshes: Mapping[str, hem.TriangleMesh]) -> Figure:
    """Meshes side by side with their edges, z up."""
    look: dict[str, Any] = {"up": AXES["z"], "wires": True}
    with styled():
        figure, panels = grid(list(meshes), (3.7, 3.0))
        for axes, mesh in zip(panels, meshes.values(), strict=True):
            with closing(Picture(mesh.points, mesh.triangles, SAND, (740, 560), **look)) as picture:
                picture.look_at(mesh.points.astype(float), -60, 22)
                axes.imshow(picture.image())
            axes.axis("off")
    return figure


def jpeg(figure: Figure) -> Any:
    """A figure of shaded pictures as a notebook shows it, in a tenth of the bytes of a PNG."""
    from IPython.display import Image as Displayed

    data = BytesIO()
    figure.savefig(data, format="jpeg", dpi=130, pil_kwargs={"quality": 85})
    width = round(float(figure.get_size_inches()[0]) * 80)
    about: dict[str, Any] = {"width": width, "alt": words(figure)}
    return Displayed(data.getvalue(), format="jpeg", **about)  # type: ignore[no-untyped-call]


def shrunk(mesh: hem.TriangleMesh, part: float, structure: str) -> hem.TriangleMesh:
    """The mesh with its shortest edges collapsed until ``part`` of its vertices is left."""
    s = structures.build(structure, mesh)
    simplification(s, part)
    return s.to_triangles()


def split_all(mesh: hem.TriangleMesh, structure: str) -> hem.TriangleMesh:
    """The mesh with every face split at its centroid."""
    s = structures.build(structure, mesh)
    s.split_all_faces()
    return s.to_triangles()


def turnable(shown: hem.TriangleMesh | FractureScene, caption: str, up: str = "y") -> Html:
    """What can be turned with the mouse: HTML without anything from elsewhere.

    Of a mesh one sees the edges; a slider moves the pieces of a fracture apart. Arrow keys turn it,
    too, and the wheel, + and - zoom. Some 15 bytes a face. O(n).
    """
    colors, piece = np.full((len(shown.triangles), 3), SAND), np.zeros(len(shown.points))
    ways = np.zeros((1, 3))
    if isinstance(shown, FractureScene):
        colors, piece = shown.colors, shown.piece
        ways = shown.exploded(1.0) - shown.fracture.mass.centers
    used = shown.points[np.unique(shown.triangles)]
    middle = (used.max(axis=0) + used.min(axis=0)) / 2
    reach = float(np.linalg.norm(used - middle, axis=1).max())
    placed = np.clip((shown.points - middle) / reach, -1, 1)
    at = "xyz".index(up)
    order = [(at + k) % 3 for k in (-1, 0, 1)]  # what goes right, up and to the front
    packed = {
        "points": _pack(np.rint(placed[:, order] * 32767), "<i2"),
        "triangles": _pack(shown.triangles, "<u4"),
        "colors": _pack(np.rint(colors * 255), "<u1"),
        "piece": _pack(piece, "<u2"),
        "ways": _pack((ways / reach)[:, order], "<f4"),
        "wires": len(ways) == 1,
    }
    return page("turnable.html.j2", mesh=packed, caption=caption)


def _pack(numbers: Array, kind: str) -> str:
    packed = gzip.compress(np.ascontiguousarray(numbers, kind).tobytes(), mtime=0)
    return base64.b64encode(packed).decode()
