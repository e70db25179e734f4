"""The thesis' listings as published, beside their corrected versions: work and time by size.

Building, splitting, collapsing and breaking, in Python objects on both sides. The sizes are small,
because the printed builder is quadratic. Work is the number of fields of objects that are read or
written, and of an indexed mesh that of the indices of its triangles.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

import structures
from experiments import harness
from experiments.harness import Axis, Case, Experiment, Measurement, Preset, Table, Timer
from hem.arrays import Array
from hem.engine import CountingArray
from hem.fracture import MATERIALS, shatter
from hem.meshes import TriangleMesh
from structures.as_printed import AsPrinted, render_arrays
from structures.half_edge_objects import HalfEdgeMesh, fields_accessed
from structures.object_tools import HalfEdgeMeshBuilder
from structures.objects import Point
from structures.printed_breaking import find_edges, simulate_breaking

MENDED = HalfEdgeMesh.name

STEPPING = "collapse_stepping"
LISTINGS = {
    "build": "Build from a render mesh",
    **{name: harness.OPERATIONS[name] for name in ("split_edge", "split_face", "collapse_edge")},
    STEPPING: "Collapse edge, stepping",
    "create_mesh": "Create a triangle",
    "find_edges": "Find the faces at an edge",
    "simulate_breaking": "Break a surface",
}
"""``STEPPING`` is the published collapse, with the one repair that chapter 6 asks for. The faces at
an edge are searched for on an indexed mesh as published, and on half-edges as corrected."""
COUNTED, TIMED = "counted", "timed"  # the kinds of cases: work, and time
TIMED_OPERATIONS = 9
COUNTED_OPERATIONS = 3
WARM_UP = 2
BYTES = {AsPrinted.name: 1_300, MENDED: 1_000}  # per vertex of meshes of these sizes, about
MORE_FACES = {"split_edge": 2, "split_face": 2, "collapse_edge": -2, STEPPING: -2, "create_mesh": 1}
"""How many faces more there are after each, inside a surface; as many as before after others."""
BROKEN_OUT = -4  # the same of the corrected breaking: a face, and half of each beside it
BREAKING = replace(MATERIALS["wood"], scale=1e-3)
"""Its few break points lie near the impact: as corrected they fall on the face that is struck. As
published they keep the impact's height, so that most miss the mesh and are searched for in vain."""
POINTS = [(9.0, 9.0, float(i)) for i in range(TIMED_OPERATIONS + WARM_UP)]
"""Different positions where nothing is yet."""
CORNERS = [[(x + i, y, z) for x, _, i in POINTS] for y, z in ((9.0, 8.0), (8.0, 9.0), (8.0, 8.0))]
"""The corners of triangles there: their first ones, their second and their third."""

Step = partial[Any]
Calls = tuple[Any, ...]  # something to call, and its arguments, each a list


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
        samples = [_work(step) for step in steps]
        fields: dict[str, Any] = {"samples": samples, "handles": 1, "checked": True}
    else:
        waiting = iter([(step,) for step in steps])
        working_set = BYTES[case.structure] * len(case.mesh().points)
        latency = harness.latency_now(working_set)
        timed = timer(lambda step: step(), setup=waiting.__next__, rounds=len(steps), warmup=0)
        fields = {**timed.fields, "working_set": working_set, "latency": latency}
        steps = steps[: len(steps) - len(list(waiting))]  # but one with --benchmark-disable
    broken_out = (case.subject, case.structure) == ("simulate_breaking", MENDED)
    more = BROKEN_OUT if broken_out else MORE_FACES.get(str(case.subject), 0)
    expected = before + len(steps) * more
    if faces() != expected:
        raise AssertionError(f"{case.id} on {case.structure}: {faces()} faces, not {expected}")
    return case.result(EXPERIMENT.kind_of(case.order), None, reference_bytes=8, **fields)


def _steps(case: Case, most: int) -> tuple[list[Step], Callable[[], int]]:
    """What is to be counted or timed on one mesh, one after the other; and its faces by now."""
    mesh = case.mesh()
    if case.subject == "build":
        times = 3 if most == TIMED_OPERATIONS else 1
        return [partial(_build, case.structure, mesh)] * times, lambda: len(mesh.triangles)
    faces = harness.operation_faces(case, most + WARM_UP)
    if case.structure == MENDED:
        m: Any = structures.build(MENDED, mesh)
        calls = _corrected(m, faces)
    else:
        m = _build(case.structure, mesh)
        m.generate_render_mesh()
        m.stepping = case.subject == STEPPING
        calls = _published(m, faces)
    method, *arguments = calls[str(case.subject)]
    steps = [partial(method, *given) for given in zip(*arguments, strict=False)]
    # The first ones bind methods and make room for many more, which takes a pass over the mesh.
    first = min(WARM_UP, len(steps) - 1)
    for step in steps[:first]:
        step()

    def count_faces() -> int:
        if case.structure == MENDED:
            m.validate()
        return m.n_faces if case.structure == MENDED else len(m.faces)

    return steps[first:], count_faces


def _published(m: AsPrinted, faces: Array) -> dict[str, Calls]:
    """The listings on a mesh, and what to call them with at these faces."""
    targets = [m.faces[f] for f in faces.tolist()]
    edges = [face.half_edge for face in targets]
    ends = [(h.origin.index, h.end.index) for h in edges]
    triangles = np.array(m.render.committed)
    corners = [[h.origin.point for h in m.face_circulator(face)] for face in targets]
    impacts = [tuple(np.mean(it, axis=0).tolist()) for it in corners]
    breaking = partial(simulate_breaking, m, circles=BREAKING.circles)
    return {
        "split_edge": (m.split_half_edge, edges, POINTS),
        "split_face": (m.split_face, targets, POINTS),
        **dict.fromkeys(("collapse_edge", STEPPING), (m.collapse_edge, edges)),
        "create_mesh": (m.create_mesh, *CORNERS),
        "find_edges": (partial(find_edges, triangles), *zip(*ends, strict=True)),
        "simulate_breaking": (breaking, impacts),
    }


def _corrected(m: HalfEdgeMesh, faces: Array) -> dict[str, Calls]:
    """The same as corrected."""
    corners = m.face_vertices(faces).values.reshape(-1, 3)
    edges = m.face_edges(faces).values.reshape(-1, 3)[:, 0].tolist()
    impacts = m.points[corners].mean(axis=1).tolist()

    def create(*points: Point) -> None:
        m.add_face(*(m.add_vertex(it).vertex for it in points))

    def faces_at(a: int, b: int) -> Array:
        edge = m.find_edge(a, b)
        assert edge is not None  # as a face has it
        return m.edge_faces(edge)

    return {
        "split_edge": (m.split_edge, edges, POINTS),
        "split_face": (m.split_face, faces.tolist(), POINTS),
        "collapse_edge": (m.collapse_edge, edges),
        "create_mesh": (create, *CORNERS),
        "find_edges": (faces_at, *corners[:, :2].T.tolist()),
        "simulate_breaking": (lambda impact: shatter(m, impact, BREAKING), impacts),
    }


def _work(step: Step) -> int:
    """Fields of objects that a step accesses, and indices of triangles."""
    given = [CountingArray(it) if isinstance(it, np.ndarray) else it for it in step.args]
    fields = fields_accessed(partial(step.func, *given, **step.keywords))
    return fields + sum(it.accesses for it in given if isinstance(it, CountingArray))


def _build(structure: str, mesh: TriangleMesh) -> Any:
    if structure == MENDED:
        built: Any = HalfEdgeMeshBuilder.records(mesh)
    else:
        built = AsPrinted.build(*render_arrays(mesh.points, mesh.triangles), whole=True)
    if len(built.faces) != (count := len(mesh.triangles)):
        raise AssertionError(f"{structure} builds {len(built.faces)} of {count} faces")
    return built


EXPERIMENT = Experiment(
    title="The listings, published and corrected", cases=cases, measure=measure, copies=3, turn=43,
    structures=(AsPrinted.name, MENDED), counted=(COUNTED,),
    table=Table("listings", "The listings, as published and corrected", LISTINGS, "errata"),
    axes={Axis.WORK_FACES: COUNTED, Axis.TIME_FACES: TIMED}, baseline_orders=(TIMED,),
)  # fmt: skip
test_listing = EXPERIMENT.test
