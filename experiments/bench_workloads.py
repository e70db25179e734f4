"""Time of what programs do with meshes, on every structure, by size; building is not included.

Each workload is written once over the contract.
"""

import heapq
from collections.abc import Callable
from time import perf_counter
from typing import NamedTuple

import numpy as np

import structures
from experiments.harness import BASE, Case, Experiment, Measurement, Preset, Timer
from hem.contract import QUERIES, Structure

KEPT = 0.1
"""The part of the vertices that a simplification leaves."""

IMPACTS = 100
IMPACT_SEED = 23

SMALL = 400
"""Vertices of the mesh on which all structures must give the same."""


class Workload(NamedTuple):
    """One workload: ``run(s)`` does it, on a mesh that is its own, and tells how many ``unit``.

    ``scans``: about how many scans of the whole mesh it takes per unit where neighbors are searched
    for, so that what would take hours is skipped beforehand.
    """

    title: str
    unit: str
    scans: float
    run: Callable[[Structure], int]


def vertex_normals(s: Structure) -> int:
    """Add every face's normal to its corners: a pass over the faces, no neighbors asked."""
    corners = s.face_vertices(s.faces()).values.reshape(-1, 3)
    a, b, c = (s.points[corners[:, i]] for i in range(3))
    normals, of_faces = np.zeros_like(s.points), np.cross(b - a, c - a)
    for i in range(3):
        np.add.at(normals, corners[:, i], of_faces)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return s.n_vertices


def smoothing(s: Structure) -> int:
    """Move every vertex to the mean of its neighbors, once."""
    vertices = s.vertices()
    rings = s.vertex_vertices(vertices)
    sums = np.add.reduceat(s.points[rings.values].astype(np.float64), rings.offsets[:-1])
    s.move_vertices(vertices, sums / rings.counts[:, None])
    return len(vertices)


def subdivision(s: Structure) -> int:
    """Split every face at its centroid."""
    return len(s.split_all_faces())


def simplify(s: Structure, part: float = KEPT) -> int:
    """Collapse the shortest edge there is until ``part`` of the vertices is left -> how many."""
    wanted = max(4, int(part * s.n_vertices))
    ends = np.sort(s.edge_vertices(s.edges()).values.reshape(-1, 2))
    lengths = np.linalg.norm(s.points[ends[:, 0]] - s.points[ends[:, 1]], axis=1)
    queue = [(x, a, b) for x, (a, b) in zip(lengths.tolist(), ends.tolist(), strict=True)]
    heapq.heapify(queue)
    alive, collapsed = np.ones(len(s.points), np.bool_), 0
    while queue and s.n_vertices > wanted:
        _, a, b = heapq.heappop(queue)
        edge = s.find_edge(a, b) if alive[a] and alive[b] else None
        if edge is None or not s.can_collapse_edge(edge):
            continue
        s.collapse_edge(edge, keep=b)
        alive[a], collapsed = False, collapsed + 1
        ring = s.vertex_vertices(b)
        lengths = np.linalg.norm(s.points[ring] - s.points[b], axis=1)
        for x, v in zip(lengths.tolist(), ring.tolist(), strict=True):
            heapq.heappush(queue, (x, min(v, b), max(v, b)))
    return collapsed


def impacts(s: Structure) -> int:
    """As in a game: split the face that is hit, ask what is around, split an edge there."""
    rng = np.random.default_rng(IMPACT_SEED)
    for face in rng.integers(0, s.n_faces, IMPACTS).tolist():
        corners = s.face_vertices(face)
        center = s.points[corners].mean(axis=0)
        new = s.split_face(face, center).vertex
        ring = s.vertex_vertices(new).tolist()
        for v in ring:
            s.vertex_faces(v)
        edge = s.find_edge(new, min(ring))
        if edge is not None:
            s.split_edge(edge, (s.points[new] + s.points[min(ring)]) / 2)
        s.face_faces(face)
    return IMPACTS


WORKLOADS = {
    "vertex_normals": Workload("Vertex normals", "vertex", 0, vertex_normals),
    "smoothing": Workload("Smoothing", "vertex", 3, smoothing),
    "subdivision": Workload("Subdivision of all faces", "face", 0, subdivision),
    "simplification": Workload("Simplification to a tenth", "collapse", 35, simplify),
    "impacts": Workload("Impacts, as in a game", "impact", 30, impacts),
}
"""Every workload by name. A new one is one function and one line here."""


def cases(preset: Preset, structure: str) -> list[Case]:
    """Every workload of the preset at every size."""
    return [
        Case(structure, preset.families[0], size, workload, "workload")
        for size in preset.workload_sizes
        for workload in preset.workloads or WORKLOADS
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time a workload on copies of a mesh, if it can be done in the time there is."""
    s, workload = case.build(), WORKLOADS[str(case.subject)]
    units = IMPACTS if case.subject == "impacts" else s.n_vertices
    scans = units * workload.scans if s.searches else 0
    reason = preset.why_too_slow(scans, s.n_faces, preset.fewest_rounds)
    if reason:
        return case.result("time", s, skipped=reason)
    _check(case, workload)
    ready = _ready(s)
    begin = perf_counter()
    units = workload.run(ready)
    rounds = preset.affordable_rounds(perf_counter() - begin)
    timed = timer(workload.run, setup=lambda: (_ready(s),), rounds=rounds, warmup=0, per=units)
    return case.result("time", s, **timed.fields)


def _ready(s: Structure) -> Structure:
    """A copy that was asked everything once, so that its methods are bound."""
    copy = s.copy()
    for query in QUERIES.values():
        getattr(copy, query.name)(int(copy.handles(query.source)[0]))
    copy.can_flip_edge(int(copy.edges()[0]))
    return copy


def _check(case: Case, workload: Workload) -> None:
    """On a small mesh the outcome is the same on every structure."""
    mesh = Case(case.structure, case.family, SMALL).mesh()
    mine, other = (structures.build(name, mesh) for name in (case.structure, BASE))
    for s in (mine, other):
        workload.run(s)
        s.validate()
    corners, expected = (np.sort(s.triangles(), axis=1) for s in (mine, other))
    same_points = np.allclose(mine.points, other.points, atol=1e-5, equal_nan=True)
    if not (np.array_equal(corners, expected) and same_points):
        raise AssertionError(f"{case.subject} on {case.structure} gives another mesh than {BASE}")


EXPERIMENT = Experiment(title="Workloads", cases=cases, measure=measure, copies=4, turn=60)
test_workload = EXPERIMENT.test
