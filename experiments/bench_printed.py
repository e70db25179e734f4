"""The thesis' listings as printed, beside their mended versions: work and time by size.

Building, splitting and collapsing, in Python objects on both sides. The sizes are small, because
the printed builder is quadratic. Work is the number of fields of objects that are read or written.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import repeat
from typing import Any, cast

import numpy as np

import structures
from experiments.conftest import Keep
from experiments.latency import latency_now
from experiments.operating import faces_of
from experiments.profiles import Profile
from experiments.results import CellResult
from experiments.subjects import Cell
from hem.mesh import TriangleMesh
from structures.as_printed import AsPrinted, render_arrays
from structures.half_edge_objects import HalfEdgeMesh, HalfEdgeMeshBuilder, fields_accessed

MENDED = HalfEdgeMesh.name
STRUCTURES = (AsPrinted.name, MENDED)

LISTINGS = ("build", "split_edge", "split_face", "collapse_edge")
ORDERS = ("counted", "timed")
"""The kinds of cells: work, and time."""

TIMED_OPERATIONS = 9
COUNTED_OPERATIONS = 3
WARM_UP = 2

Step = Callable[[], Any]


def cells(profile: Profile, structure: str) -> list[Cell]:
    """Every listing at every size."""
    return [
        Cell(structure, profile.families[0], size, listing, order)
        for size in profile.printed_sizes
        for listing in LISTINGS
        for order in ORDERS
    ]


def test_listing(cell: Cell, profile: Profile, benchmark: Any, keep: Keep) -> None:
    """Count or time what a listing does, and check what it made by the number of faces."""
    if cell.order == "counted":
        benchmark.pedantic(lambda: None)
        samples = [fields_accessed(step) for step in _steps(cell, COUNTED_OPERATIONS)]
        keep(_result(cell, "work", samples))
        return
    steps = _steps(cell, TIMED_OPERATIONS)
    waiting, latency = iter(steps), latency_now(500 * len(cell.mesh().points))
    benchmark.pedantic(lambda step: step(), setup=lambda: ((next(waiting),), {}), rounds=len(steps))
    data = benchmark.stats.stats.data if benchmark.stats else []
    keep(_result(cell, "time", data, latency=latency))


def _steps(cell: Cell, most: int) -> list[Step]:
    """What is counted or timed, one after the other, on one mesh."""
    mesh = cell.mesh()
    if cell.query == "build":
        return [partial(_built, cell.structure, mesh)] * (3 if most == TIMED_OPERATIONS else 1)
    faces = faces_of(cell, most + WARM_UP).tolist()
    steps = _mended(cell, faces) if cell.structure == MENDED else _printed(cell, faces)
    # The first ones bind methods and make room for many more, which takes a pass over the mesh.
    first = min(WARM_UP, len(steps) - 1)
    for step in steps[:first]:
        step()
    return steps[first:]


def _printed(cell: Cell, faces: list[int]) -> list[Step]:
    m = _built(cell.structure, cell.mesh())
    m.generate_render_mesh()
    targets = [m.faces[f] for f in faces]
    sides = [face.half_edge for face in targets]
    points = [(9.0, 9.0, float(i)) for i in range(len(faces))]
    calls = {
        "split_edge": map(partial, repeat(m.split_half_edge), sides, points),
        "split_face": map(partial, repeat(m.split_face), targets, points),
        "collapse_edge": map(partial, repeat(m.collapse_edge), sides),
    }
    return list(calls[str(cell.query)])


def _mended(cell: Cell, faces: list[int]) -> list[Step]:
    s = cast(HalfEdgeMesh, structures.build(MENDED, cell.mesh()))
    edges = s.face_edges(np.array(faces)).values.reshape(-1, 3)[:, 0].tolist()
    points = [(9.0, 9.0, float(i)) for i in range(len(faces))]
    calls = {
        "split_edge": map(partial, repeat(s.split_edge), edges, points),
        "split_face": map(partial, repeat(s.split_face), faces, points),
        "collapse_edge": map(partial, repeat(s.collapse_edge), edges),
    }
    return list(calls[str(cell.query)])


def _built(structure: str, mesh: TriangleMesh) -> Any:
    if structure == MENDED:
        built: Any = HalfEdgeMeshBuilder.records(mesh)
    else:
        built = AsPrinted.build(*render_arrays(mesh.points, mesh.triangles), whole=True)
    if len(built.faces) != len(mesh.triangles):
        raise AssertionError(
            f"{structure} builds {len(built.faces)} of {len(mesh.triangles)} faces"
        )
    return built


def _result(cell: Cell, kind: str, samples: Any, latency: float | None = None) -> CellResult:
    summary = cell.mesh().summary()
    return CellResult(
        id=cell.id,
        kind=kind,
        query=cell.query,
        order=cell.order,
        family=cell.family,
        vertices=summary.vertices,
        edges=summary.edges,
        faces=summary.faces,
        valence_max=summary.valence_max,
        reference_bytes=8,
        handles=1,
        checked=True,
        latency=latency,
        samples=np.asarray(samples, float).tolist(),
    )


__all__ = ["STRUCTURES", "cells", "test_listing"]
