"""Meshes as pictures: the figures of the thesis, made by the operations themselves."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from functools import partial
from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

import hem
import structures
from experiments.harness.workloads import simplify
from experiments.report.style import styled
from hem.contract import Structure
from hem.fracture.show import AXES, Image, Picture, PicturesMissingError
from structures.plankton import Plankton

Array = NDArray[Any]

PAPER = "#f4f1ea"
TOUCHED = "#f7d9a0"
INK = "#333333"
STRONG = "#c0392b"

SAND = (0.96, 0.82, 0.55)

Step = tuple[str, Structure, dict[str, Any]]
"""A title, a mesh, and what to point out in it: ``faces``, ``edges``, ``vertices``."""


def hexagon() -> hem.TriangleMesh:
    """Two inner vertices joined by an edge, in a ring of eight: enough to see an operation."""
    angle = 2 * np.pi * np.arange(8) / 8
    ring = np.stack([1.7 * np.cos(angle), 1.05 * np.sin(angle)], axis=1)
    points = np.vstack([[-0.6, 0.0], [0.6, 0.0], ring])
    fans = [(1, i) for i in (6, 7, 8, 9)] + [(0, i) for i in (2, 3, 4, 5)]
    triangles = [(center, 2 + i % 8, 2 + (i + 1) % 8) for center, i in fans]
    triangles += [(0, 1, 4), (1, 0, 8)]
    return hem.TriangleMesh(np.column_stack([points, np.zeros(10)]), triangles)


def quad() -> hem.TriangleMesh:
    """A square of two triangles; their common edge is the one to be split."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    return hem.TriangleMesh(points, [(0, 1, 2), (0, 2, 3)])


def steps(every: Sequence[Step], labels: bool = True) -> Figure:
    """Flat meshes side by side, with their vertices numbered."""
    with styled():
        figure = Figure(figsize=(3.1 * len(every), 2.7), layout="constrained")
        panels = figure.subplots(1, len(every), squeeze=False)[0]
        for axes, (title, s, shown) in zip(panels, every, strict=True):
            _flat(axes, s, shown, labels)
            axes.set_title(title)
        _same_view(panels)
    return figure


def _flat(axes: Axes, s: Structure, shown: dict[str, Any], labels: bool) -> None:
    faces = s.faces()
    corners = s.face_vertices(faces)
    flat = s.points[:, :2]
    marked = np.isin(faces, list(shown.get("faces", ())))
    colors = np.where(marked, TOUCHED, PAPER)
    outlines = [flat[row] for row in corners]
    axes.add_collection(PolyCollection(outlines, facecolors=colors, edgecolors=INK))
    for a, b in shown.get("edges", ()):
        axes.plot(*flat[[a, b]].T, color=STRONG, linewidth=2.6, solid_capstyle="round")
    for a, b in shown.get("arrows", ()):
        look = {"arrowstyle": "-|>", "color": STRONG, "linewidth": 2, "shrinkA": 5, "shrinkB": 5}
        axes.annotate("", flat[b], flat[a], arrowprops=look)
    used = np.unique(corners.values)
    strong = np.isin(used, list(shown.get("vertices", ())))
    sizes, tones = np.where(strong, 42, 12), np.where(strong, STRONG, INK)
    axes.scatter(flat[used, 0], flat[used, 1], sizes, list(tones), zorder=3)
    if labels:
        for v in used.tolist():
            axes.annotate(str(v), flat[v], (4, 4), textcoords="offset points", fontsize=8)
    axes.set_aspect("equal")
    axes.axis("off")


def _same_view(panels: Sequence[Axes]) -> None:
    boxes = []
    for axes in panels:
        axes.autoscale_view()
        boxes.append((*axes.get_xlim(), *axes.get_ylim()))
    low, high = np.min(boxes, axis=0), np.max(boxes, axis=0)
    for axes in panels:
        axes.set(xlim=(low[0], high[1]), ylim=(low[2], high[3]))


def plankton_walk() -> Figure:
    """The article's figures 6 to 9: faces added around vertex 2, and the half-edge that it has."""
    s = Plankton.build(hem.PolygonMesh([(0, 0, 0), (1, 0, 0), (0.5, 0.5, 0)], [(0, 1, 2)]))
    shown: list[Step] = []

    def show(title: str) -> None:
        end = s.end_vertex(s.outgoing_half_edge(2))
        lies = "on the border" if s.vertex_naked_edges(2) else "inside"
        title = f"{title}\nvertex 2 {lies}: 2 → {end}"
        shown.append((title, s.copy(), {"arrows": [(2, end)], "vertices": [2]}))

    show("One face")
    for corners, point in (((2, 1, 3), (1, 1, 0)), ((2, 3, 4), (0, 1, 0)), ((0, 2, 4), None)):
        if point is not None:
            s.add_vertex(point)
        added = s.add_face(*corners)
        show(f"Face {' '.join(map(str, corners))} added")
        shown[-1][2]["faces"] = added.created_faces.tolist()
    return steps(shown)


def polygon_steps() -> Figure:
    """What Plankton's half-edges do with polygons, each on a fresh sheet of four quads."""
    return steps(
        [
            _polygon_step("Four quads", lambda s: []),
            _polygon_step("split_face: a diagonal", _cut_first_face),
            _polygon_step("merge_faces", lambda s: [s.merge_faces(_between_faces(s, 0, 1))]),
            _polygon_step("stellate", _stellate_first_face),
            _polygon_step("erase_center_vertex", lambda s: [s.erase_center_vertex(4)]),
            _polygon_step("truncate_vertex", lambda s: [s.truncate_vertex(4)]),
        ],
        labels=False,
    )


def _polygon_step(title: str, change: Callable[[Plankton], list[int]]) -> Step:
    at = np.arange(9).reshape(3, 3)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=2).reshape(-1, 4)
    y, x = np.divmod(np.arange(9), 3)
    s = Plankton.build(hem.PolygonMesh(np.stack([x, y, 0 * x], axis=1), quads.tolist()))
    return title, s, {"faces": change(s)}


def _cut_first_face(s: Plankton) -> list[int]:
    a, _, c, _ = s.face_half_edges(0).tolist()
    s.split_face(a, c)
    return [0, 4]


def _stellate_first_face(s: Plankton) -> list[int]:
    return [0, *s.stellate(0).created_faces.tolist()]


def _between_faces(s: Plankton, face: int, other: int) -> int:
    """The half-edge of a face that has another one beyond."""
    sides = s.face_half_edges(face).tolist()
    return next(h for h in sides if s.adjacent_face(s.pair(h)) == other)


def split_edge_steps(structure: str) -> Figure:
    """Figure 5: an edge is split, inside and on the border."""
    s = structures.build(structure, hexagon())
    before, edge = s.copy(), s.find_edge(0, 1)
    around = s.edge_faces(int(edge or 0)).tolist()
    edit = s.split_edge(_edge(s, 0, 1), (0, 0.0, 0))
    middle = s.copy()
    border = s.split_edge(_edge(s, 2, 3), _between(s, 2, 3))
    return steps(
        [
            ("An edge, and the faces at it", before, {"faces": around, "edges": [(0, 1)]}),
            (
                "split: 1 vertex, 3 edges,\n2 faces more",
                middle,
                {"faces": _touched(edit), "vertices": [edit.vertex]},
            ),
            (
                "on the border: 1 vertex,\n2 edges, 1 face more",
                s,
                {"faces": _touched(border), "vertices": [border.vertex]},
            ),
        ]
    )


def split_as_printed() -> Figure:
    """Erratum 3: a half-edge that moves into the new face and still names the old one."""
    from structures.as_printed import AsPrinted, render_arrays

    mesh = quad()
    m = AsPrinted.build(*render_arrays(mesh.points, mesh.triangles), whole=True)
    diagonal = next(h for h in m.half_edges if h.opposite is not None)
    m.split_half_edge(diagonal, (0.5, 0.5, 0.0))
    corners = [[h.origin.index for h in m.face_circulator(face)][::-1] for face in m.faces]
    s = Plankton.build(hem.PolygonMesh([v.point for v in m.vertices], corners))
    wrong = [(h.origin.index, h.end.index) for h in m.half_edges if h.next.face is not h.face]
    return steps(
        [
            ("A quad", structures.build("half_edge", mesh), {"edges": [(0, 2)]}),
            ("split as printed", s, {"arrows": wrong, "vertices": [4]}),
        ]
    )


def quad_splits(structure: str) -> Figure:
    """Figure 6: the diagonal of a quad split in the middle, a quarter up its side, and off it."""
    places = {
        "in the middle": (0.5, 0.5, 0),
        "a quarter up the left side": (0.0, 0.25, 0),
        "off the edge": (0.75, 0.4, 0),
    }
    every: list[Step] = [("The quad", structures.build(structure, quad()), {"edges": [(0, 2)]})]
    for title, place in places.items():
        s = structures.build(structure, quad())
        edge = (0, 3) if "left" in title else (0, 2)
        edit = s.split_edge(_edge(s, *edge), place)
        every.append((title, s, {"faces": _touched(edit), "vertices": [edit.vertex]}))
    return steps(every)


def collapse_steps(structure: str) -> Figure:
    """Figure 7: an edge collapses into one of its ends."""
    s = structures.build(structure, hexagon())
    edge = _edge(s, 0, 1)
    before, gone = s.copy(), s.edge_faces(edge).tolist()
    around = s.vertex_faces(0).tolist()
    edit = s.collapse_edge(edge, keep=1)
    return steps(
        [
            ("Vertex 0 is to merge into 1", before, {"edges": [(0, 1)], "faces": around}),
            ("These two faces vanish", before, {"faces": gone, "edges": [(0, 1)]}),
            ("collapsed: 1 vertex, 3 edges,\n2 faces fewer", s, {
                "faces": _touched(edit), "vertices": [1]}),
        ]
    )  # fmt: skip


def split_face_steps(structure: str) -> Figure:
    """Figure 9: a face is split; and every face is."""
    s = structures.build(structure, hexagon())
    before = s.copy()
    edit = s.split_face(0, s.points[s.face_vertices(0)].mean(axis=0))
    one = s.copy()
    whole = before.copy()
    new = whole.split_all_faces()
    return steps(
        [
            ("A face", before, {"faces": [0]}),
            ("split: 1 vertex, 3 edges,\n2 faces more", one, {
                "faces": _touched(edit), "vertices": [edit.vertex]}),
            ("all faces split", whole, {"vertices": new.tolist()}),
        ],
        labels=False,
    )  # fmt: skip


def flip_steps(structure: str) -> Figure:
    """An edge is turned within its two faces, and turned back."""
    s = structures.build(structure, hexagon())
    edge = _edge(s, 0, 1)
    a, b = s.copy(), s.copy()
    edit = b.flip_edge(edge)
    faces = _touched(edit)
    c = b.copy()
    c.flip_edge(_edge(c, 4, 8))
    return steps(
        [
            ("An edge", a, {"faces": faces, "edges": [(0, 1)]}),
            ("flipped: no count changes", b, {"faces": faces, "edges": [(4, 8)]}),
            ("flipped again: as it was", c, {"faces": faces, "edges": [(0, 1)]}),
        ]
    )


def _edge(s: Structure, a: int, b: int) -> int:
    edge = s.find_edge(a, b)
    assert edge is not None
    return edge


def _between(s: Structure, a: int, b: int) -> ArrayLike:
    return 0.5 * (s.points[a] + s.points[b])


def _touched(edit: hem.Edit) -> list[int]:
    return [*edit.created_faces.tolist(), *edit.changed_faces.tolist()]


def shaded(
    meshes: dict[str, hem.TriangleMesh], azimuth: float = -60, elevation: float = 22
) -> Figure:
    """Meshes side by side with their edges, z up, seen from ``azimuth`` and ``elevation`` (°)."""

    def draw(mesh: hem.TriangleMesh) -> Image:
        look: dict[str, Any] = {"up": AXES["z"], "wires": True}
        with closing(Picture(mesh.points, mesh.triangles, SAND, (740, 560), **look)) as picture:
            picture.look_at(mesh.points.astype(float), azimuth, elevation)
            return picture.image()

    with styled():
        figure = Figure(figsize=(3.7 * len(meshes), 3.0), layout="constrained")
        panels = figure.subplots(1, len(meshes), squeeze=False)[0]
        for axes, (title, mesh) in zip(panels, meshes.items(), strict=True):
            show_picture(axes, title, partial(draw, mesh))
    return figure


def show_picture(axes: Axes, title: str, draw: Callable[[], Image]) -> None:
    """Put a picture into a panel; without PyVista what is missing is said there instead."""
    axes.set_title(title)
    axes.axis("off")
    try:
        axes.imshow(draw())
    except PicturesMissingError as missing:
        axes.text(0.5, 0.5, str(missing), ha="center", va="center", wrap=True)


def jpeg(figure: Figure) -> Any:
    """A figure of shaded pictures as a notebook shows it, in a tenth of the bytes of a PNG."""
    from IPython.display import Image as Displayed

    data = BytesIO()
    figure.savefig(data, format="jpeg", dpi=130, pil_kwargs={"quality": 85})
    width = round(float(figure.get_size_inches()[0]) * 80)
    return Displayed(data.getvalue(), format="jpeg", width=width)  # type: ignore[no-untyped-call]


def shrunk(mesh: hem.TriangleMesh, part: float, structure: str) -> hem.TriangleMesh:
    """The mesh with its shortest edges collapsed until ``part`` of its vertices is left."""
    s = structures.build(structure, mesh)
    simplify(s, part)
    return s.to_triangles()


def split_all(mesh: hem.TriangleMesh, structure: str) -> hem.TriangleMesh:
    """The mesh with every face split at its centroid."""
    s = structures.build(structure, mesh)
    s.split_all_faces()
    return s.to_triangles()


FIGURES: dict[str, Callable[[str], Figure]] = {
    "split edge": split_edge_steps,
    "quad": quad_splits,
    "collapse": collapse_steps,
    "split face": split_face_steps,
    "flip": flip_steps,
}
"""The flat figures, each made by a structure of the given name."""
