"""The thesis' listings as published, beside their corrected versions: work and time by size.

Building, splitting and collapsing, in Python objects on both sides. The sizes are small, because
the printed builder is quadratic. Work is the number of fields of objects that are read or written.
"""

from collections.abc import Callable
from functools import partial
from typing import Any

import structures
from experiments.harness import (
    OPERATIONS,
    Axis,
    Case,
    Experiment,
    Measurement,
    Preset,
    Table,
    Timer,
    operation_faces,
)
from experiments.harness.calibration import latency_now
from hem.meshes import TriangleMesh
from structures.as_printed import AsPrinted, render_arrays
from structures.half_edge_objects import HalfEdgeMesh, fields_accessed
from structures.object_tools import HalfEdgeMeshBuilder

MENDED = HalfEdgeMesh.name

STEPPING = "collapse_stepping"
LISTINGS = {
    "build": "Build from a render mesh",
    **{name: OPERATIONS[name] for name in ("split_edge", "split_face", "collapse_edge")},
    STEPPING: "Collapse edge, with a circulator that steps",
}
"""``STEPPING`` is the published collapse, with the one repair that chapter 6 asks for."""
COUNTED, TIMED = "counted", "timed"
"""The kinds of cases: work, and time."""
TIMED_OPERATIONS = 9
COUNTED_OPERATIONS = 3
WARM_UP = 2
MORE_FACES = {"build": 0, "split_edge": 2, "split_face": 2, "collapse_edge": -2, STEPPING: -2}
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
        if (listing, structure) != (STEPPING, MENDED)  # whose circulator steps anyway
        for order in (COUNTED, TIMED)
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Count or time what a listing does, and check what it made by the number of faces."""
    counted = case.order == COUNTED
    steps, faces = _steps(case, COUNTED_OPERATIONS if counted else TIMED_OPERATIONS)
    before = faces()
    if counted:
        samples = [fields_accessed(step) for step in steps]
        fields: dict[str, Any] = {"samples": samples, "handles": 1, "checked": True}
    else:
        waiting = iter([(step,) for step in steps])
        latency = latency_now(500 * len(case.mesh().points))
        timed = timer(lambda step: step(), setup=waiting.__next__, rounds=len(steps), warmup=0)
        fields = {**timed.fields, "latency": latency}
        steps = steps[: len(steps) - len(list(waiting))]  # but one with --benchmark-disable
    expected = before + MORE_FACES[str(case.subject)] * len(steps)
    if faces() != expected:
        raise AssertionError(f"{case.id} on {case.structure}: {faces()} faces, not {expected}")
    kind = EXPERIMENT.kind_of(case)
    return case.result(kind, None, reference_bytes=8, **fields)


def _steps(case: Case, most: int) -> tuple[list[Step], Callable[[], int]]:
    """What is to be counted or timed on one mesh, one after the other; and its faces by now."""
    mesh = case.mesh()
    if case.subject == "build":
        times = 3 if most == TIMED_OPERATIONS else 1
        return [partial(_build, case.structure, mesh)] * times, lambda: len(mesh.triangles)
    faces = operation_faces(case, most + WARM_UP)
    if case.structure == MENDED:
        m: Any = structures.build(MENDED, mesh)
        edges, targets = m.face_edges(faces).values.reshape(-1, 3)[:, 0].tolist(), faces.tolist()
        split_edge = m.split_edge
    else:
        m = _build(case.structure, mesh)
        m.generate_render_mesh()
        m.stepping = case.subject == STEPPING
        targets = [m.faces[f] for f in faces.tolist()]
        edges, split_edge = [face.half_edge for face in targets], m.split_half_edge
    calls: dict[str, tuple[Any, ...]] = {
        "split_edge": (split_edge, edges, POINTS),
        "split_face": (m.split_face, targets, POINTS),
        **dict.fromkeys(("collapse_edge", STEPPING), (m.collapse_edge, edges)),
    }
    method, *arguments = calls[str(case.subject)]
    steps: list[Step] = [partial(method, *given) for given in zip(*arguments, strict=False)]
    # The first ones bind methods and make room for many more, which takes a pass over the mesh.
    first = min(WARM_UP, len(steps) - 1)
    for step in steps[:first]:
        step()
    return steps[first:], partial(_count_faces, m)


def _count_faces(m: Any) -> int:
    if isinstance(m, HalfEdgeMesh):
        m.validate()
        return m.n_faces
    return len(m.faces)


def _build(structure: str, mesh: TriangleMesh) -> Any:
    if structure == MENDED:
        built: Any = HalfEdgeMeshBuilder.records(mesh)
    else:
        built = AsPrinted.build(*render_arrays(mesh.points, mesh.triangles), whole=True)
    if len(built.faces) != len(mesh.triangles):
        raise AssertionError(
            f"{structure} builds {len(built.faces)} of {len(mesh.triangles)} faces"
        )
    return built


EXPERIMENT = Experiment(
    title="The listings, published and corrected",
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
test_listing = EXPERIMENT.test
