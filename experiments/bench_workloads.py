"""Time of what programs do with meshes, on every structure, by size; building is not included.

Each workload is written once over the contract, in two ways: compiled, which measures the structure
and is what claims rest on, and as a loop in Python, which measures the interpreter, too.
"""

import heapq
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import structures
from experiments import harness
from experiments.harness import Case, Experiment, Measurement, Preset, Timed, Timer
from hem import algorithms
from hem.arrays import Floats
from hem.contract import QUERIES, Structure

KEPT = 0.1  # the part of the vertices that a simplification leaves
IMPACTS, IMPACT_SEED = (100, 1_000), 23
SMALL = 400  # vertices of the mesh on which all structures must give the same
REBUILT = 20  # about how many scans it takes to find all neighbors anew
COMPILED, FROM_PYTHON = "compiled", "from Python"


class Workload(NamedTuple):
    """One workload, on a mesh that is its own, ``compiled`` and ``from_python``; see ``UNITS``.

    What would take hours is skipped beforehand. So ``scans`` says about how many scans of the whole
    mesh a unit takes where neighbors are searched for, compiled and from Python, ``moves`` how many
    where moving a vertex searches, and ``edits`` how many edits are followed by a question for
    neighbors. ``one``: the compiled way for one unit, where the call itself takes longer than that:
    it is done beforehand, and taken off.
    """

    title: str
    unit: str
    scans: tuple[float, float]
    moves: int
    edits: int
    compiled: Callable[[Structure], Any]
    from_python: Callable[[Structure], Any]
    one: Callable[[Structure], Any] | None = None

    def run(self, order: str | None) -> Callable[[Structure], Any]:
        """The way that an order names."""
        return self.compiled if order == COMPILED else self.from_python


UNITS: dict[str, Callable[[Structure, Structure], int]] = {
    "vertex": lambda before, after: before.n_vertices,
    "face": lambda before, after: before.n_faces,
    "collapse": lambda before, after: before.n_vertices - after.n_vertices,
    "impact": lambda before, after: _hits(before),
}
"""How many units a workload has done, from the structure before and after it."""


def vertex_normals(s: Structure) -> Floats:
    """Add every face's normal to its corners: a pass over the faces, no neighbors asked."""
    corners, points = s.face_vertices(s.faces()).values.reshape(-1, 3), s.points
    a, b, c = points[corners.T]
    normals, of_faces = np.zeros_like(points), np.cross(b - a, c - a)
    for i in range(3):
        np.add.at(normals, corners[:, i], of_faces)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def smoothing(s: Structure) -> None:
    """Move every vertex to the mean of its neighbors, once; those on a border or alone stay."""
    rings = s.vertex_vertices(s.vertices())
    some = rings.counts > 0
    vertices, counts = s.vertices()[some], rings.counts[some]
    sums = np.add.reduceat(s.points[rings.values].astype(np.float64), rings.offsets[:-1][some])
    means = sums / counts[:, None]
    if len(rings.values) == s.n_half_edges:  # closed
        s.move_vertices(vertices, means)
    else:
        inside = counts == s.vertex_faces(vertices).counts
        s.move_vertices(vertices[inside], means[inside])


def subdivision(s: Structure) -> None:
    """Split every face at its centroid."""
    corners = s.face_vertices(s.faces()).values.reshape(-1, 3)
    centers = s.points[corners].mean(axis=1)
    for face, center in zip(s.faces().tolist(), centers, strict=True):
        s.split_face(face, center)


def _simplify(s: Structure) -> None:
    algorithms.simplify(s, vertices=max(4, int(KEPT * s.n_vertices)), by="shortest_edge")


def simplification(s: Structure, part: float = KEPT) -> None:
    """Collapse the shortest edge there is until ``part`` of the vertices is left.

    A plain one: it looks at no normals and no borders, and keeps the end with the larger number.
    The compiled one refuses what turns a face over, and keeps borders; it leaves another mesh.
    """
    wanted = max(4, int(part * s.n_vertices))
    ends = np.sort(s.edge_vertices(s.edges()).values.reshape(-1, 2))
    points = s.points  # where those that stay will be, too
    lengths = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    queue = [(x, a, b) for x, (a, b) in zip(lengths.tolist(), ends.tolist(), strict=True)]
    heapq.heapify(queue)
    alive = np.ones(len(points), np.bool_)
    while queue and s.n_vertices > wanted:
        _, a, b = heapq.heappop(queue)
        edge = s.find_edge(a, b) if alive[a] and alive[b] else None
        if edge is None or not s.can_collapse_edge(edge):
            continue
        s.collapse_edge(edge, keep=b)
        alive[a] = False
        ring = s.vertex_vertices(b)
        lengths = np.linalg.norm(points[ring] - points[b], axis=1)
        for x, v in zip(lengths.tolist(), ring.tolist(), strict=True):
            heapq.heappush(queue, (x, min(v, b), max(v, b)))


def _hits(s: Structure) -> int:
    """How many impacts there are: more where they take so little that a call is much of it."""
    fewest, most = IMPACTS
    few = s.searches or s.rebuilds
    return fewest if few else int(np.clip(s.n_vertices // 4, fewest, most))


def _hit(s: Structure) -> Any:
    return np.random.default_rng(IMPACT_SEED).integers(0, s.n_faces, _hits(s)).tolist()


def impacts(s: Structure, faces: Iterable[int]) -> None:
    """As in a game: split every face that is hit, ask what is around, split an edge there."""
    for face in faces:
        center = s.positions(s.face_vertices(face)).mean(axis=0)
        new = s.split_face(face, center).vertex
        ring = s.vertex_vertices(new).tolist()
        for v in ring:
            s.vertex_faces(v)
        edge = s.find_edge(new, min(ring))
        if edge is not None:
            s.split_edge(edge, s.positions([new, min(ring)]).sum(axis=0) / 2)
        s.face_faces(face)


def _strike(strikes: Callable[..., Any], s: Structure, faces: list[int] | None = None) -> Any:
    return strikes(s, _hit(s) if faces is None else faces)


WORKLOADS = {
    "vertex_normals": Workload(
        "Vertex normals", "vertex", (0, 0), 0, 0, algorithms.vertex_normals, vertex_normals),
    "smoothing": Workload("Smoothing", "vertex", (0, 3), 1, 0, algorithms.smooth, smoothing),
    "subdivision": Workload(
        "Splitting of all faces", "face", (0, 0), 0, 0, lambda s: s.split_all_faces(), subdivision),
    "simplification": Workload(
        "Simplification to a tenth", "collapse", (35, 35), 0, 1, _simplify, simplification),
    "impacts": Workload(
        "Impacts, as in a game", "impact", (30, 30), 0, 2,
        partial(_strike, algorithms.impacts), partial(_strike, impacts),
        lambda s: algorithms.impacts(s, _hit(s)[:1])),
}  # fmt: skip
"""Every workload by name. A new one is its two functions and one line here."""


def cases(preset: Preset, structure: str) -> list[Case]:
    """Every workload of the preset at every size, in both ways where anything is compiled."""
    orders = (COMPILED, FROM_PYTHON) if structures.REGISTRY[structure].compiled else (FROM_PYTHON,)
    return [
        Case(structure, preset.families[0], size, workload, order)
        for size in preset.workload_sizes
        for workload in preset.workloads or WORKLOADS
        for order in orders
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time a workload on copies of a mesh, if it can be done in the time there is."""
    s, workload = case.build(), WORKLOADS[str(case.subject)]
    units, run = _hits(s) if case.subject == "impacts" else s.n_vertices, workload.run(case.order)
    scans = workload.scans[case.order == FROM_PYTHON] * s.searches
    scans += workload.moves * s.searches_to_move + REBUILT * workload.edits * s.rebuilds
    if reason := preset.why_too_slow(units * scans, s.n_faces, preset.fewest_rounds):
        return case.result("time", s, skipped=reason)
    _check(case, run)
    before = workload.one if case.order == COMPILED else None
    begun = _ready(s, before)
    done = begun.copy()
    rounds = preset.affordable_rounds(harness.took(partial(run, done))[1])
    if not (units := UNITS[workload.unit](begun, done)):
        raise harness.NothingToMeasureError(f"there is no {workload.unit} to be done")
    del begun, done  # which would take memory while others are timed
    given: Any = {"setup": lambda: (_ready(s, before),), "rounds": rounds, "warmup": 0}
    timed = timer(run, **given, per=units)
    if before:
        timed = without_call(timed, float(np.median(harness.time_rounds(before, **given).samples)))
    return case.result("time", s, **timed.fields)


def without_call(timed: Timed, one: float) -> Timed:
    """Rounds without the call itself, which took ``one`` seconds with one unit.

    The others shared what is left. A round in which nothing is left tells nothing, and goes.
    """
    each = (timed.samples * timed.per - one) / (timed.per - 1)
    return Timed(each[each > 0], timed.calibration[each > 0], timed.per)


def _ready(s: Structure, before: Callable[[Structure], Any] | None) -> Structure:
    """A copy that was asked everything once, so that its methods are bound, with room for impacts.

    To make room copies the whole mesh, which is spread over more edits than so few. ``before``:
    what is done to it.
    """
    copy = s.copy()
    copy.scratch(3 * IMPACTS[1])
    for query in QUERIES.values():
        getattr(copy, query.name)(int(copy.handles(query.source)[0]))
    copy.can_flip_edge(int(copy.edges()[0]))
    if before:
        before(copy)
    return copy


def _check(case: Case, run: Callable[..., Any]) -> None:
    """On a small mesh the outcome is the same on every structure."""
    mesh = Case(case.structure, case.family, SMALL).mesh()
    mine, other = (structures.build(name, mesh) for name in (case.structure, harness.BASE))
    same = [_hit(mine)] if case.subject == "impacts" else []  # of which others get fewer
    told = [np.array(run(s, *same), float) for s in (mine, other)]  # of None nan
    for s in (mine, other):
        s.validate()
    corners, expected = (np.sort(s.triangles(), axis=1) for s in (mine, other))
    pairs = (mine.points, other.points), told
    alike = all(np.allclose(a, b, atol=1e-5, equal_nan=True) for a, b in pairs)
    if not (np.array_equal(corners, expected) and alike):
        raise AssertionError(f"{case.subject} on {case.structure} differs from {harness.BASE}")


EXPERIMENT = Experiment(title="Workloads", cases=cases, measure=measure, copies=4, turn=60)
test_workload = EXPERIMENT.test
