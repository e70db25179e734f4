"""Picking: a ray to the face it hits, and what is around that face; edited now and then.

The ray is cast through a tree of boxes over the render mesh, by Warp. After an edit the tree is
built anew, or refitted: every box is computed again, bottom up, and none is made. Warp promises
that for positions that moved. It holds for other corners, too, and so for new faces if there were
unused ones when the tree was built; a test compares that with all triangles, one by one. But boxes
are not put elsewhere, so that a ray may meet more of them; hence it is timed after either.
"""

import logging
from functools import cache
from importlib.util import find_spec
from itertools import product
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

import hem
import structures
from experiments import harness
from experiments.bench_workloads import COMPILED, FROM_PYTHON
from experiments.harness import Case, Experiment, Measurement, Preset, Timer
from hem.arrays import Array, Floats
from hem.authoring import Kernel, Kernels, kernel
from hem.contract import QUERIES, Structure

RAY, FOLLOWING, NEIGHBORS = "ray", "follow_edit", "neighbors"
REBUILT, REFITTED = "rebuilt", "refitted"

PICKS, EDITS, PICK_SEED = 100, 60, 24
FEW_PICKS = 4  # how many picks a sample has where neighbors are searched for
SCANS = 4  # how often a pick scans the mesh there

WITHOUT = "It needs the package warp-lang, which is not installed: pip install warp-lang"


class Picker:
    """A render mesh as rays see it: its arrays with unused faces behind, and a tree over them.

    ``room``: for how many splits. It follows every commit; ``refit`` or ``rebuild`` must be called
    before the next ray.
    """

    def __init__(self, render: hem.RenderMesh, room: int = EDITS) -> None:
        self._render, self._room = render, room
        self._ray = np.zeros((2, 3), np.float32)
        self._face = np.zeros(1, np.int32)
        self.rebuild()
        render.subscribe(self._follow)

    def rebuild(self) -> None:
        """Make the tree anew. O(n log n)."""
        import warp

        def shared(array: Array, dtype: Any) -> Any:
            return warp.array(array, dtype=dtype, device="cpu", copy=False)

        kernel, render = _casting(), self._render
        points = np.append(render.points, np.zeros(3 * self._room, np.float32))
        self._points = points.reshape(-1, 3)
        self._indices = np.append(render.indices, np.zeros(6 * self._room, np.int32))
        self._tree = warp.Mesh(shared(self._points, warp.vec3), shared(self._indices, int))
        self._fits = True
        inputs = [self._tree.id, shared(self._ray, warp.vec3), shared(self._face, int)]
        self._cast = warp.launch(kernel, dim=1, inputs=inputs, device="cpu", record_cmd=True)

    def refit(self) -> None:
        """Compute the boxes again, or make the tree anew where there were too few. O(n)."""
        (self._tree.refit if self._fits else self.rebuild)()

    def face(self, origin: ArrayLike, direction: ArrayLike) -> int:
        """The first face that a ray hits, from either side, or -1."""
        self._ray[0], self._ray[1] = origin, direction
        self._cast.launch()
        return int(self._face[0])

    def _follow(self, upload: hem.Upload) -> None:
        points, indices = self._render.points.reshape(-1, 3), self._render.indices
        room = len(points) <= len(self._points) and len(indices) <= len(self._indices)
        self._fits = self._fits and room and not upload.resized
        if self._fits:
            for begin, end in upload.vertices.tolist():
                self._points[begin:end] = points[begin:end]
            for begin, end in (3 * upload.triangles).tolist():
                self._indices[begin:end] = indices[begin:end]


@cache
def _casting() -> Any:
    """What Warp compiles, once per machine, in some seconds."""
    import warp

    warp.config.log_level = logging.ERROR  # there need not be a graphics card

    def cast(mesh: Any, ray: Any, face: Any) -> None:
        hit = warp.mesh_query_ray(mesh, ray[0], ray[1], 1.0e30)
        face[0] = hit.face if hit.result else -1

    vectors, faces = warp.array(dtype=warp.vec3), warp.array(dtype=int)
    cast.__annotations__ = {"mesh": warp.uint64, "ray": vectors, "face": faces}
    return warp.kernel(cast, enable_backward=False)


def cases(preset: Preset, structure: str) -> list[Case]:
    """What is around a face on every structure; rays on one, as the render mesh is the same."""
    compiled = (COMPILED,) if structures.REGISTRY[structure].compiled else ()
    kinds = [(NEIGHBORS, it) for it in (*compiled, FROM_PYTHON)]
    if structure == harness.BASE:
        kinds += product((RAY, FOLLOWING), (REBUILT, REFITTED))
    family, sizes = preset.families[0], preset.real_time_sizes
    return [Case(structure, family, size, *it) for size in sizes for it in kinds]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time rays, what follows an edit, or the questions after a hit."""
    s = case.build()
    if case.subject == NEIGHBORS:
        return _time_neighbors(case, s, preset, timer)
    if find_spec("warp") is None:
        return case.result("time", s, skipped=WITHOUT)
    s = s.copy()
    render, rays = hem.RenderMesh(s), aimed(s, PICKS)
    picker = Picker(render)
    follow = picker.refit if case.order == REFITTED else picker.rebuild
    hits = iter([picker.face(*ray) for ray in rays])

    def edit() -> tuple[()]:
        face = next(hits)
        s.split_face(face, s.points[s.face_vertices(face)].mean(axis=0))
        return ()

    rounds = preset.affordable_rounds(harness.took(follow)[1])
    if case.subject == FOLLOWING:
        timed = timer(follow, setup=edit, rounds=rounds, warmup=1)
    else:
        for _ in range(EDITS):
            edit()
        follow()
        timed = timer(lambda: [picker.face(*it) for it in rays], rounds=preset.rounds, per=PICKS)
    afresh = Picker(render)
    if [picker.face(*ray) for ray in rays] != [afresh.face(*ray) for ray in rays]:
        raise AssertionError(f"{case.id}: another face is hit than with a tree made anew")
    return case.result("time", s, **timed.fields)


def _time_neighbors(case: Case, s: Structure, preset: Preset, timer: Timer) -> Measurement:
    """Time what is asked about a face that is hit: its neighbors, and the faces at its corners."""
    picks = FEW_PICKS if s.searches else PICKS
    reason = preset.why_too_slow(SCANS * picks, s.n_faces, preset.fewest_rounds)
    if s.searches and reason:
        return case.result("time", s, skipped=reason)
    faces = np.random.default_rng(PICK_SEED).choice(s.faces(), picks)
    for kind, asked in ("face_faces", faces[:1]), ("vertex_faces", s.face_vertices(faces[0])):
        harness.check_query(s, case.mesh(), QUERIES[kind], asked)
    ask = ask_compiled if case.order == COMPILED else ask_from_python
    answers = ask(s, faces)  # compiles
    if answers != ask_from_python(s, faces):
        raise AssertionError(f"{case.id}: {answers} neighbors, and otherwise from Python")
    rounds = preset.affordable_rounds(harness.took(ask, s, faces)[1])
    timed = timer(ask, setup=lambda: (s, faces), rounds=rounds, warmup=0, per=picks)
    return case.result("time", s, **timed.fields)


def ask_from_python(s: Structure, faces: Array) -> int:
    """Ask for the neighbors of faces and the faces at their corners -> how many there are."""
    found = 0
    for face in faces.tolist():
        found += len(s.face_faces(face))
        for v in s.face_vertices(face).tolist():
            found += len(s.vertex_faces(v))
    return found


class Picks(NamedTuple):
    """The faces that were hit, room for the corners of one, how much was found, and scratch."""

    faces: Array
    corners: Array
    found: Array
    out: Array


def asking(queries: Kernels, operations: Kernels) -> Kernel:
    """Make ``ask(m, picks) -> 0``, which does the same compiled."""
    face_vertices, face_faces = queries["face_vertices"], queries["face_faces"]
    vertex_faces = queries["vertex_faces"]

    @kernel
    def ask(m: Any, picks: Picks) -> int:
        for f in picks.faces:
            picks.found[0] += face_faces(m, f, picks.out)
            face_vertices(m, f, picks.out)
            for i in range(3):
                picks.corners[i] = picks.out[i]
            for i in range(3):
                picks.found[0] += vertex_faces(m, picks.corners[i], picks.out)
        return 0

    return ask


def ask_compiled(s: Structure, faces: Array) -> int:
    """The same in one compiled loop."""
    picks = Picks(faces, np.zeros(3, np.int64), np.zeros(1, np.int64), s.scratch(0)[0])
    s.run(asking, picks)
    return int(picks.found[0])


def aimed(s: Structure, count: int) -> list[tuple[Floats, Floats]]:
    """Rays from outside of the mesh to as many faces, at random; to their middle, but no center."""
    faces = np.random.default_rng(PICK_SEED).choice(s.faces(), count)
    corners = s.points[s.face_vertices(faces).values.reshape(-1, 3)].astype(np.float64)
    goals = np.einsum("c,kcx->kx", (0.25, 0.33, 0.42), corners)
    low, high = (it(s.points, axis=0).astype(np.float64) for it in (np.nanmin, np.nanmax))
    size = high - low
    # A flat mesh must not be looked at from within its plane.
    eye = high + np.where(size > 0, size, size.max()) * (0.31, 0.47, 1.13)
    return [(eye, goal - eye) for goal in goals]


EXPERIMENT = Experiment(title="Picking", cases=cases, measure=measure, copies=15, turn=66)
test_picking = EXPERIMENT.test
