"""The operations beside those of OpenMesh, batched and one by one, at random and in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import hem
import structures
from experiments.validation.budgets import Comparison, Task

VERTICES = 100_000
OPERATED = 20_000

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


def compare_operations(openmesh: Any) -> Iterator[Comparison]:
    """Operate on a half-edge mesh and on OpenMesh's, each round on a fresh copy."""
    mesh, rng = hem.generate("torus", VERTICES), np.random.default_rng(1)
    s, places = structures.build("half_edge", mesh), rng.random((OPERATED, 3))
    points, triangles = mesh.points.astype(np.float64), np.array(mesh.triangles)
    orders: dict[str, Callable[[Any], Any]] = {
        "at random": lambda handles: rng.choice(handles, OPERATED, replace=False),
        "in order": lambda handles: handles[:: len(handles) // OPERATED][:OPERATED],
    }
    for order, choose in orders.items():
        for (operation, batch), asked in ASKED.items():
            on_faces = operation == "split_face"
            mine = choose(s.faces() if on_faces else s.edges())
            other = mine if on_faces else choose(np.arange(s.n_edges))
            ours = (
                _operate_batched(batch, mine, places)
                if batch
                else _operate(operation, mine, places)
            )
            theirs = _operate_openmesh(operation, other.tolist(), list(places))
            yield Comparison(
                f"{OPERATED:,} {operation}, {'batched' if batch else 'one by one'}, {order}",
                asked,
                "OpenMesh",
                Task(ours, lambda: _copy_with_room(s)),
                Task(theirs, lambda: openmesh.TriMesh(points, triangles)),
            )


def _copy_with_room(s: Any) -> Any:
    copy = s.copy()
    copy.reserve(OPERATED)
    copy.split_face(0, (0, 0, 0))  # binds the operations
    return copy


def _operate_batched(batch: str, handles: Any, places: Any) -> Callable[[Any], Any]:
    if batch == "collapse_edges":
        return lambda mesh: mesh.collapse_edges(handles)
    return lambda mesh: getattr(mesh, batch)(handles, places)


def _operate(operation: str, handles: Any, places: Any) -> Callable[[Any], None]:
    columns = (handles.tolist(), places) if operation.startswith("split") else (handles.tolist(),)
    given = list(zip(*columns, strict=True))

    def operate(mesh: Any) -> None:
        method = getattr(mesh, operation)
        for arguments in given:
            try:
                method(*arguments)
            except hem.TopologyError:
                continue

    return operate


def _operate_openmesh(
    operation: str, handles: list[int], places: list[Any]
) -> Callable[[Any], None]:
    """The same in OpenMesh, one by one, as its Python module has them; only what may be done."""

    def split(mesh: Any, handle: Callable[[int], Any]) -> None:
        for index, place in zip(handles, places, strict=True):
            mesh.split(handle(index), mesh.add_vertex(place))

    def collapse(mesh: Any) -> None:
        for index in handles:
            edge = mesh.edge_handle(index)
            half_edge = mesh.halfedge_handle(edge, 0)
            if not mesh.is_deleted(edge) and mesh.is_collapse_ok(half_edge):
                mesh.collapse(half_edge)

    def flip(mesh: Any) -> None:
        for index in handles:
            edge = mesh.edge_handle(index)
            if mesh.is_flip_ok(edge):
                mesh.flip(edge)

    return {
        "split_face": lambda mesh: split(mesh, mesh.face_handle),
        "split_edge": lambda mesh: split(mesh, mesh.edge_handle),
        "collapse_edge": collapse,
        "flip_edge": flip,
    }[operation]
