"""How the operations compare with OpenMesh's from Python, and with themselves on a large mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from time import perf_counter
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from rich.table import Table

import hem
import structures
from experiments.harness.latency import latency_now

ROUNDS = 7
OPERATED = 20_000
OPERATED_VERTICES = 100_000

Task = Callable[[], Any]
Loop = Callable[[Any], Any]
"""Operates on the mesh it is given."""


class Comparison(NamedTuple):
    """One task, done by us and by others; ``asked``: how many times faster we are to be.

    Tasks of one argument are given what ``fresh`` makes for them, untimed: a mesh to operate on.
    """

    what: str
    asked: float
    ours: Callable[..., Any]
    theirs: dict[str, Callable[..., Any]]
    fresh: Mapping[str, Task] = MappingProxyType({})  # by the name of the peer, "" for us


class OpenMesh:
    """The same operations in OpenMesh, one by one, as its Python module has them."""

    def __init__(self, places: list[Any]) -> None:
        self.places = places

    def split_face(self, faces: list[int]) -> Loop:
        """Each face at a place."""

        def loop(mesh: Any) -> None:
            for face, place in zip(faces, self.places, strict=True):
                mesh.split(mesh.face_handle(face), mesh.add_vertex(place))

        return loop

    def split_edge(self, edges: list[int]) -> Loop:
        """Each edge at a place."""

        def loop(mesh: Any) -> None:
            for edge, place in zip(edges, self.places, strict=True):
                mesh.split(mesh.edge_handle(edge), mesh.add_vertex(place))

        return loop

    def collapse_edge(self, edges: list[int]) -> Loop:
        """Those that are there and may be."""

        def loop(mesh: Any) -> None:
            for edge in edges:
                handle = mesh.halfedge_handle(mesh.edge_handle(edge), 0)
                if not mesh.is_deleted(mesh.edge_handle(edge)) and mesh.is_collapse_ok(handle):
                    mesh.collapse(handle)

        return loop

    def flip_edge(self, edges: list[int]) -> Loop:
        """Those that may be."""

        def loop(mesh: Any) -> None:
            for edge in edges:
                handle = mesh.edge_handle(edge)
                if mesh.is_flip_ok(handle):
                    mesh.flip(handle)

        return loop


ASKED = {
    ("split_face", "split_faces"): 10.0,
    ("split_edge", "split_edges"): 10.0,
    ("collapse_edge", "collapse_edges"): 5.0,
    ("split_face", ""): 1.0,
    ("split_edge", ""): 1.0,
    ("collapse_edge", ""): 1.0,
    ("flip_edge", ""): 1.0,
}
"""How many times faster an operation is to be: by its name and that of its batch, if batched."""


def operated(openmesh: Any) -> list[Comparison]:
    """Operations on a half-edge mesh, batched and one by one, at random and in order."""
    mesh, rng = hem.generate("torus", OPERATED_VERTICES), np.random.default_rng(1)
    s, places = structures.build("half_edge", mesh), rng.random((OPERATED, 3))
    theirs = OpenMesh(list(places))
    fresh: dict[str, Task] = {
        "": lambda: _with_room(s),
        "OpenMesh": lambda: openmesh.TriMesh(
            mesh.points.astype(np.float64), np.array(mesh.triangles)
        ),
    }
    orders: dict[str, Callable[[Any], Any]] = {
        "at random": lambda every: rng.choice(every, OPERATED, replace=False),
        "in order": lambda every: every[:: len(every) // OPERATED][:OPERATED],
    }
    every = []
    for order, choose in orders.items():
        for (operation, batch), asked in ASKED.items():
            on_faces = operation == "split_face"
            mine = choose(s.faces() if on_faces else s.edges())
            other = mine if on_faces else choose(np.arange(s.n_edges))
            ours = _batched(batch, mine, places) if batch else _singly(operation, mine, places)
            what = f"{OPERATED:,} {operation}, {'batched' if batch else 'one by one'}, {order}"
            loops: dict[str, Loop] = {"OpenMesh": getattr(theirs, operation)(other.tolist())}
            every.append(Comparison(what, asked, ours, loops, fresh))
    return every


def _with_room(s: Any) -> Any:
    copy = s.copy()
    copy.reserve(OPERATED)
    copy.split_face(0, (0, 0, 0))  # binds the operations
    return copy


def _batched(batch: str, handles: Any, places: Any) -> Loop:
    if batch == "collapse_edges":
        return lambda mesh: mesh.collapse_edges(handles)
    return lambda mesh: getattr(mesh, batch)(handles, places)


def _singly(operation: str, handles: Any, places: Any) -> Loop:
    points = list(places) if operation.startswith("split") else None

    def loop(mesh: Any) -> None:
        method = getattr(mesh, operation)
        for i, handle in enumerate(handles.tolist()):
            try:
                _ = method(handle, points[i]) if points else method(handle)
            except hem.TopologyError:
                continue

    return loop


def edits_by_size(small: int = 10_000, large: int = 1_000_000) -> dict[str, dict[str, float]]:
    """How many times as much a random edit costs on the large mesh, by structure and operation.

    Nanoseconds per edit, small and large, and of the memory's latency at each working set.
    """
    found: dict[str, dict[str, float]] = {}
    for name in ("triangle_neighbor", "winged_edge", "half_edge"):
        for operation in ("split_face", "split_edge", "collapse_edge", "flip_edge"):
            row: dict[str, float] = {}
            for label, n_vertices in (("small", small), ("large", large)):
                s = structures.build(name, hem.generate("torus", n_vertices))
                row[f"latency {label}"] = 1e9 * latency_now(sum(s.memory().values()))
                row[label] = 1e9 * _seconds_per_edit(s, operation)
            found[f"{name} {operation}"] = row
    return found


def _seconds_per_edit(s: Any, operation: str) -> float:
    """Of so many random edits, restored in between; the median of some rounds."""
    rng, seconds = np.random.default_rng(3), []
    every = s.faces() if operation == "split_face" else s.edges()
    chosen = rng.choice(every, min(OPERATED, len(every) // 4), replace=False)
    copies = [s.copy() for _ in range(ROUNDS)]
    for copy in copies:
        prepared = copy.prepare(operation, chosen, np.zeros((len(chosen), 3)))
        begin = perf_counter()
        prepared.run()
        seconds.append((perf_counter() - begin) / len(chosen))
    return float(np.median(seconds[1:]))


def rendered_edits(edits: dict[str, dict[str, float]]) -> Table:
    """The table of ``edits_by_size``."""
    table = Table(title=f"{OPERATED:,} random edits on 10,000 and on 1,000,000 vertices")
    heads = ("edit", "small, ns", "large, ns", "ratio", "latency's", "ratio less latency", "asked")
    for head in heads:
        table.add_column(head, justify="left" if head == "edit" else "right")
    for name, row in edits.items():
        ratio = row["large"] / row["small"]
        latency = row["latency large"] / row["latency small"]
        numbers = f"{row['small']:.0f}", f"{row['large']:.0f}", f"{ratio:.2f}", f"{latency:.2f}"
        table.add_row(name, *numbers, f"{ratio / latency:.2f}", "≤ 2")
    return table
