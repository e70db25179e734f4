"""Operations as they are measured: on which elements, on a copy that is made new each time."""

from contextlib import suppress
from functools import lru_cache, partial
from typing import Any

import numpy as np

import hem
import structures
from experiments.harness.calibration import latency_now
from experiments.harness.cases import BASE, Case, NothingToMeasureError
from experiments.harness.oracle import turned
from experiments.harness.reference import copies, copies_of, small_case, typical
from experiments.harness.timer import Timed, Timer, time_rounds, took
from experiments.presets import HUBS, Preset
from hem.arrays import Array
from hem.contract import Structure
from hem.engine import END
from hem.meshes import undirected_edges

MOST_IMPOSSIBLE = 0.5  # part of the rounds that may be so, for the others to tell something
MOST_ELEMENTS = 2_000
FEWEST_ELEMENTS, TRIED_ELEMENTS = 4, 8  # where each takes a scan; tried to see how long it takes
FEWEST_OPERATIONS = 500
MOST_TURNS = 16
"""A sample is of at least so many operations, in up to so many turns on a mesh made new each time.

One mesh, so that a small one is found in the caches however many operations there is room for.
"""
IDLE_CALLS = 15
CYCLE = 2e-10  # seconds of a clock cycle, at the least: no operation takes less
REFERENCE_ROUNDS = 4  # before and after the rounds of a case
ELEMENT_SEED = 22
CHOICES = 16  # of elements in a reference's small mesh: its copies are not all operated on alike
SMALL = 20_000  # faces up to which triangles are looked at, and compared with the indexed mesh


def operation_faces(case: Case, count: int = MOST_ELEMENTS) -> Array:
    """Faces (k,) too far apart to meet, ascending; at hubs each has one as its first corner."""
    return _some(_apart(case.family, case.size, case.valence), count)


@lru_cache(maxsize=4 * CHOICES)
def _apart(family: str, size: int, valence: int | None, seed: int = ELEMENT_SEED) -> Array:
    mesh = Case(BASE, family, size, valence=valence).mesh()
    if family == HUBS:
        hubs = hem.valence_hubs(int(valence or 0), size)[::2]  # one of each bipyramid
        order = np.argsort(mesh.triangles[:, 0], kind="stable")
        # Half-way around, not where every walk around the hub begins.
        across = np.searchsorted(mesh.triangles[order, 0], hubs) + int(valence or 0) // 2
        return np.sort(order[across])
    from scipy.sparse import coo_array

    n, (edges, _) = len(mesh.points), undirected_edges(mesh.triangles)
    ends = np.concatenate([edges, edges[:, ::-1]]).T
    joined = coo_array((np.ones(ends.shape[1], np.bool_), tuple(ends)), (n, n)).tocsr()
    begin, neighbors = joined.indptr, joined.indices
    taken, chosen = np.zeros(n, np.bool_), []
    tried = np.random.default_rng(seed).permutation(len(mesh.triangles))
    for face in tried[: 40 * MOST_ELEMENTS].tolist():
        corners = mesh.triangles[face].tolist()
        ring = np.concatenate([neighbors[begin[v] : begin[v + 1]] for v in corners])
        if not taken[ring].any():
            taken[ring] = True
            chosen.append(face)
        if len(chosen) == MOST_ELEMENTS:
            break
    return np.sort(chosen)


def operation_arguments(s: Structure, operation: str, faces: Array) -> Array:
    """(k, 3) the handles of the operations at these faces: their first edges, or they themselves.

    Those that may be done; in a mesh of one's own there are others. To be added are faces that are
    not there yet: ``s`` loses them. Raises NothingToMeasureError if nothing may be done.
    """
    if operation == "add_face":
        faces = operation_arguments(s, "remove_face", faces)[:, 0]  # at a border some may not go
    rows = np.full((len(faces), 3), -1, np.int64)
    if s.operations[operation].element == "edge":
        rows[:, 0] = s.face_edges(faces).values.reshape(-1, 3)[:, 0]
    elif operation == "add_face":
        rows[:] = s.face_vertices(faces).values.reshape(-1, 3)
        for face in faces.tolist():
            s.remove_face(face)
    else:
        rows[:, 0] = faces
    allowed = rows[s.prepare(operation, rows, np.zeros((len(rows), 3))).check()]
    if not len(allowed):
        why = f"none of {len(rows)} elements of the mesh allows {operation}"
        raise NothingToMeasureError(why)
    return allowed


class OperationBatch:
    """A copy of a structure to operate on over and over."""

    def __init__(self, s: Structure, operation: str, faces: Array) -> None:
        self.mesh = s.copy()
        args = operation_arguments(self.mesh, operation, faces)
        self.operations = len(args)
        self._prepared = self.mesh.prepare(operation, args, np.zeros((len(args), 3)))
        self._fresh = self.mesh.snapshot()
        # As bare as can be, but for the call itself, see ``idle_seconds``.
        self.operate = partial(self._prepared.perform, self._prepared.pinned.address)

    def operate_all(self) -> None:
        """Operate, and see that all could be tried; RuntimeError if not."""
        self._prepared.run()

    def seconds_each(self) -> float:
        """What one operation takes, about; they are compiled before."""
        self.operate()
        self.restore()
        return took(self.operate)[1] / self.operations

    def idle(self) -> float:
        """Call for no operation -> seconds."""
        self._prepared.task[END] = 0
        seconds = took(self.operate)[1]
        self._prepared.task[END] = self.operations
        return seconds

    def idle_seconds(self) -> float:
        """What a call takes that does no operation: about as long as a few of them."""
        seconds = []
        for _ in range(IDLE_CALLS if self.mesh.compiled else 1):
            self.ready()
            seconds.append(self.idle())
        return float(np.median(seconds))

    def each(self, timed: Timed, idle: float) -> tuple[Timed, float]:
        """Rounds as seconds per operation, and the part of them that cannot be.

        Those are left out: less than a clock cycle remains once an ``idle`` call is taken off.
        """
        seconds = (timed.samples - idle) / self.operations
        possible = seconds >= CYCLE
        kept = Timed(seconds[possible], timed.calibration[possible], timed.per * self.operations)
        return kept, float(1 - possible.mean()) if len(seconds) else 0.0

    def restore(self) -> tuple[()]:
        """Make the mesh what it was, as the setup of a round.

        Just written, up to some 20 MB of it lie in the last caches, and its original beside it; a
        chase of as much memory, read before, was measured to wait up to three times as long.
        """
        self.mesh.restore(self._fresh)
        return ()

    def ready(self) -> tuple[()]:
        """Restore, then call for nothing, as the setup of a round.

        A copy drives from the caches what a call needs itself. To find that again takes as long as
        dozens of operations, and another time each round.
        """
        self.restore()
        self.idle()
        return ()


def validate_operated(
    operated: Structure, case: Case, render: hem.RenderMesh | None = None
) -> None:
    """Validate what operations made, by its records and where that is quick by its triangles.

    ``render``: one that followed, to be compared with one made anew.
    """
    operated.validate()
    if render:
        anew = hem.RenderMesh(operated)
        pairs = (render.points, anew.points), (render.indices, anew.indices)
        if not all(np.array_equal(*it) for it in pairs):
            raise AssertionError(f"{case.id} on {case.structure}: the render mesh is not in step")
    if operated.n_faces <= SMALL:
        try:
            hem.require_sound(case.mesh())
        except hem.MeshError:  # a mesh of one's own need not be a surface, before or after
            return
        hem.require_sound(operated.to_triangles())


def _operated(name: str, case: Case, faces: Array) -> list[list[int]]:
    batch = OperationBatch(structures.build(name, case.mesh()), str(case.subject), faces)
    batch.operate()
    return sorted(turned(batch.mesh.triangles()).tolist())


def time_operations(case: Case, preset: Preset, timer: Timer) -> dict[str, Any]:
    """Time operations in compiled loops, and check what they make -> fields of a measurement."""
    s, faces = case.build(), operation_faces(case)
    most = MOST_TURNS if s.compiled else 1  # interpreted ones last long enough
    if case.searches:  # so does to scan a large mesh, even for a few
        few = OperationBatch(s, str(case.subject), faces[:: max(1, len(faces) // TRIED_ELEMENTS)])
        lasting = preset.round_seconds / few.seconds_each()
        faces = faces[: max(FEWEST_ELEMENTS, int(lasting))]
        most = int(np.clip(lasting / len(faces), 1, most))
    batch = OperationBatch(s, str(case.subject), faces)
    batch.operate_all()
    validate_operated(batch.mesh, case)
    if batch.mesh.n_faces <= SMALL and case.structure != BASE:
        mine, other = (_operated(name, case, faces[:20]) for name in (case.structure, BASE))
        if mine != other:
            raise AssertionError(f"{case.id} on {case.structure} gives another mesh than {BASE}")
    turns = int(np.clip(FEWEST_OPERATIONS // batch.operations, 1, most))
    latency = latency_now(sum(s.memory().values()))
    idle = batch.idle_seconds()
    constant = constant_work(case, preset, batch.operations) if s.compiled else None
    beside = _rounds_of(constant, turns, idle)
    timed = timer(batch.operate, setup=batch.ready, rounds=turns * preset.rounds, warmup=2)
    beside += _rounds_of(constant, turns, idle)
    timed, impossible = batch.each(timed.averaged(turns), idle)
    noise = {"impossible": impossible}
    told = {"latency": latency, "reference": typical(beside), "noise": noise}
    if impossible > MOST_IMPOSSIBLE:
        return {**told, "skipped": "the operations take no longer than a call that does none"}
    return {**timed.fields, **told}


def constant_work(case: Case, preset: Preset, count: int) -> OperationBatch | None:
    """As many operations whose work cannot grow, see ``reference.py``; None if not compared."""
    if case.family not in (HUBS, preset.families[0]) or case.searches:
        return None
    small = small_case(case, preset)
    s, _ = copies(small, case.vertices)
    mesh = small.family, small.size, small.valence
    faces = copies_of([_apart(*mesh, seed) for seed in range(CHOICES)], small, s)
    if case.family == HUBS:  # at distances as even as theirs, which is easily foreseen
        hubs = min(len(_apart(case.family, case.size, case.valence)), len(faces))
        faces = faces[np.linspace(0, len(faces) - 1, hubs).astype(int)]
    with suppress(NothingToMeasureError):  # a mesh of one's own may have too small a version
        return OperationBatch(s, str(case.subject), _some(faces, count))
    return None


def _some(faces: Array, count: int) -> Array:
    """So many of the faces, or all if there are no more; ascending."""
    if len(faces) <= count:
        return faces
    return np.sort(np.random.default_rng(ELEMENT_SEED).choice(faces, count, replace=False))


def _rounds_of(batch: OperationBatch | None, turns: int, idle: float) -> list[float]:
    """Seconds per operation of some rounds of a reference; none without one."""
    if batch is None:
        return []
    timed = time_rounds(batch.operate, setup=batch.ready, rounds=turns * REFERENCE_ROUNDS)
    return list(batch.each(timed.averaged(turns), idle)[0].samples)
