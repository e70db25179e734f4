"""The thesis' listings as printed, beside their mended versions: work and time by size.

Building, splitting and collapsing, in Python objects on both sides. The sizes are small, because
the printed builder is quadratic. Work is the number of fields of objects that are read or written.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import structures
from experiments.harness import (
    OPERATIONS,
    Axis,
    Case,
    Experiment,
    Keep,
    Measurement,
    Preset,
    Table,
    Timer,
    operation_faces,
)
from experiments.harness.latency import latency_now
from hem.meshes import TriangleMesh
from structures.as_printed import AsPrinted, render_arrays
from structures.half_edge_objects import HalfEdgeMesh, fields_accessed
from structures.object_tools import HalfEdgeMeshBuilder

Array = NDArray[Any]

MENDED = HalfEdgeMesh.name

LISTINGS = {
    "build": "Build from a render mesh",
    **{name: OPERATIONS[name] for name in ("split_edge", "split_face", "collapse_edge")},
}
COUNTED, TIMED = "counted", "timed"
"""The kinds of cases: work, and time."""

TIMED_OPERATIONS = 9
COUNTED_OPERATIONS = 3
WARM_UP = 2

MORE_FACES = {"build": 0, "split_edge": 2, "split_face": 2, "collapse_edge": -2}
"""How many faces more there are after each, inside a surface."""

POINTS = [(9.0, 9.0, float(i)) for i in range(TIMED_OPERATIONS + WARM_UP)]
"""Different positions where nothing is yet."""

Step = Callable[[], Any]


def cases(preset: Preset, structure: str) -> list[Case]:
    """Every listing at every size."""
    return [
        Case(structure, preset.families[0], size, listing, order)
        for size in preset.printed_sizes
        for listing in LISTINGS
        for order in (COUNTED, TIMED)
    ]


class Steps(NamedTuple):
    """What is to be counted or timed, one after the other, on one mesh, and its faces by now."""

    steps: list[Step]
    faces: Callable[[], int]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Count or time what a listing does, and check what it made by the number of faces."""
    counted = case.order == COUNTED
    todo = _steps(case, COUNTED_OPERATIONS if counted else TIMED_OPERATIONS)
    before = todo.faces()
    if counted:
        fields: dict[str, Any] = {"samples": [fields_accessed(step) for step in todo.steps]}
    else:
        waiting, latency = iter(todo.steps), latency_now(500 * len(case.mesh().points))
        timed = timer(
            lambda step: step(),
            setup=lambda: ((next(waiting),), {}),
            rounds=len(todo.steps),
            warmup=0,
        )
        fields = {**timed.fields, "latency": latency}
    expected = before + MORE_FACES[str(case.subject)] * len(todo.steps)
    if todo.faces() != expected:
        raise AssertionError(f"{case.id} on {case.structure}: {todo.faces()} faces, not {expected}")
    return _measurement(case, "work" if counted else "time", fields)


def _steps(case: Case, most: int) -> Steps:
    mesh = case.mesh()
    if case.subject == "build":
        times = 3 if most == TIMED_OPERATIONS else 1
        return Steps([partial(_built, case.structure, mesh)] * times, lambda: len(mesh.triangles))
    faces = operation_faces(case, most + WARM_UP)
    steps, counted = _mended(case, faces) if case.structure == MENDED else _printed(case, faces)
    # The first ones bind methods and make room for many more, which takes a pass over the mesh.
    first = min(WARM_UP, len(steps) - 1)
    for step in steps[:first]:
        step()
    return Steps(steps[first:], counted)


def _printed(case: Case, faces: Array) -> Steps:
    m = _built(case.structure, case.mesh())
    m.generate_render_mesh()
    targets = [m.faces[f] for f in faces.tolist()]
    sides = [face.half_edge for face in targets]
    calls: dict[str, tuple[Any, ...]] = {
        "split_edge": (m.split_half_edge, sides, POINTS),
        "split_face": (m.split_face, targets, POINTS),
        "collapse_edge": (m.collapse_edge, sides),
    }
    return Steps(_calls(*calls[str(case.subject)]), lambda: len(m.faces))


def _mended(case: Case, faces: Array) -> Steps:
    s = structures.build(MENDED, case.mesh())
    edges = s.face_edges(faces).values.reshape(-1, 3)[:, 0].tolist()
    calls: dict[str, tuple[Any, ...]] = {
        "split_edge": (s.split_edge, edges, POINTS),
        "split_face": (s.split_face, faces.tolist(), POINTS),
        "collapse_edge": (s.collapse_edge, edges),
    }

    def counted() -> int:
        s.validate()
        return s.n_faces

    return Steps(_calls(*calls[str(case.subject)]), counted)


def _calls(method: Callable[..., Any], *arguments: list[Any]) -> list[Step]:
    return [partial(method, *given) for given in zip(*arguments, strict=False)]


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


def _measurement(case: Case, kind: str, fields: dict[str, Any]) -> Measurement:
    summary = case.mesh().summary()
    return Measurement(
        id=case.id,
        kind=kind,
        subject=case.subject,
        order=case.order,
        family=case.family,
        vertices=summary.vertices,
        edges=summary.edges,
        faces=summary.faces,
        valence_max=summary.valence_max,
        reference_bytes=8,
        handles=1,
        checked=True,
        **{**fields, "samples": np.asarray(fields["samples"], float).tolist()},
    )


EXPERIMENT = Experiment(
    title="The listings, published and corrected",
    kind="time",
    cases=cases,
    measure=measure,
    structures=(AsPrinted.name, MENDED),
    copies=3,
    turn=43,
    counted=(COUNTED,),
    table=Table("listings", "The listings, as published and corrected", LISTINGS, "errata"),
    axes={Axis.WORK_FACES: COUNTED, Axis.TIME_FACES: TIMED},
    baseline_orders=(TIMED,),
)


def test_listing(case: Case, preset: Preset, timer: Timer, keep: Keep) -> None:
    """Count or time one case."""
    keep(measure(case, preset, timer))
