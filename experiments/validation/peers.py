"""How this project's half-edge mesh compares with other libraries, all measured in one run.

``make peers`` installs them and runs this. A library that has no distribution for this Python is
skipped, and said so. COMPAS' meshes are Python objects, and compared on a smaller torus.
"""

import platform
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np

import hem
import structures
from experiments.harness import shuffled
from experiments.validation.budgets import Budget, Task, print_budgets, time_interleaved
from hem import algorithms
from hem.arrays import Array

VERTICES = 1_000_000
OPERATED_VERTICES = 100_000
OBJECT_VERTICES = 20_000
COUNT = 20_000
"""Single queries, and operations."""
SAMPLED = 100_000
"""Places at which the distance of two surfaces is measured."""

MODULES = {
    "OpenMesh": "openmesh",
    "MeshLib": "meshlib.mrmeshnumpy",
    "libigl": "igl",
    "trimesh": "trimesh",
    "COMPAS": "compas.datastructures",
    "pymeshlab": "pymeshlab",
    "fast-simplification": "fast_simplification",
}

BUILDERS: dict[str, Callable[[Any, Array, Array], Any]] = {
    "OpenMesh": lambda openmesh, points, triangles: openmesh.TriMesh(points, triangles),
    "MeshLib": lambda meshlib, points, triangles: meshlib.meshFromFacesVerts(triangles, points),
    "libigl": lambda igl, _, triangles: igl.triangle_triangle_adjacency(triangles),
}
"""What each library does to know the neighbors in a mesh."""

SIMPLIFIERS: dict[str, tuple[float, Callable[[Any, hem.TriangleMesh, int], hem.TriangleMesh]]] = {
    "pymeshlab": (3.0, lambda it, mesh, faces: _simplify_by_pymeshlab(it, mesh, faces)),
    "fast-simplification": (
        1.0,
        lambda it, mesh, faces: hem.TriangleMesh(
            *it.simplify(mesh.points.copy(), mesh.triangles.copy(), target_count=faces)
        ),
    ),
}
"""How many times faster quadrics are to be, and how each library simplifies by them."""

OPERATIONS = {
    ("split_face", "split_faces"): 10.0,
    ("split_edge", "split_edges"): 10.0,
    ("collapse_edge", "collapse_edges"): 5.0,
    ("split_face", ""): 1.0,
    ("split_edge", ""): 1.0,
    ("collapse_edge", ""): 1.0,
    ("flip_edge", ""): 1.0,
}
"""How many times faster an operation is to be: by its name and that of its batch, if batched."""


def import_peers() -> dict[str, Any]:
    """The libraries that are installed, by name."""
    modules = {}
    for name, module in MODULES.items():
        try:
            modules[name] = import_module(module)
        except ImportError as error:
            print(f"{name} is skipped: {error} (Python {platform.python_version()})", flush=True)
    return modules


def compare(what: str, asked: float, ours: Task, theirs: Task) -> Budget:
    """Time both, interleaved; ``asked``: how many times faster we are to be."""
    seconds = time_interleaved([ours, theirs])
    ratio = seconds[1] / seconds[0]
    measured = f"{ratio:.2f} × ({1e3 * seconds[0]:,.1f} ms, theirs {1e3 * seconds[1]:,.1f} ms)"
    return Budget(what, f"≥ {asked:.3g} ×", measured, ratio >= asked)


def compare_building(peers: dict[str, Any], mesh: hem.TriangleMesh) -> Iterator[Budget]:
    """Build what knows the neighbors in a mesh."""
    every = [name for name in BUILDERS if name in peers]
    for what, asked, structure, built, names in (
        ("build", 5.0, "half_edge", mesh, every),
        ("build, renumbered at random", 1.5, "half_edge", shuffled(mesh), every),
        ("build Plankton's half-edges", 3.0, "plankton", mesh, {"OpenMesh"} & set(every)),
    ):
        ours = Task(partial(structures.build, structure, built))
        for name in names:
            triangles = built.triangles.astype(np.int64 if name == "libigl" else np.int32)
            points = built.points.astype(np.float64)
            theirs = Task(partial(BUILDERS[name], peers[name], points, triangles))
            yield compare(f"{what}, {name}", asked, ours, theirs)


def compare_queries(peers: dict[str, Any], mesh: hem.TriangleMesh) -> Iterator[Budget]:
    """Query all elements at once, and one after the other as OpenMesh's iterators do."""
    s: Any = structures.build("half_edge", mesh)
    vertices, faces, triangles = s.vertices(), s.faces(), mesh.triangles.astype(np.int64)
    theirs: dict[str, Callable[[], Any]] = {}
    if openmesh := peers.get("OpenMesh"):
        om = openmesh.TriMesh(mesh.points.astype(np.float64), triangles)
        ours, what = Task(lambda: s.face_faces(faces)), "face_faces of all, OpenMesh ff_indices"
        yield compare(what, 1.5, ours, Task(om.ff_indices))
        yield _compare_single(
            "OpenMesh", s, lambda vertex: [it.idx() for it in om.vf(om.vertex_handle(vertex))]
        )
        theirs["OpenMesh vf_indices"] = om.vf_indices
    if tri := peers.get("trimesh"):
        theirs["trimesh"] = lambda: tri.Trimesh(mesh.points, triangles, process=False).vertex_faces
    if igl := peers.get("libigl"):
        theirs["libigl"] = lambda: igl.vertex_triangle_adjacency(triangles, len(mesh.points))
    ours = Task(lambda: s.vertex_faces(vertices))
    for name, query in theirs.items():
        yield compare(f"vertex_faces of all, {name}", 1.5, ours, Task(query))


def compare_objects(peers: dict[str, Any]) -> Iterator[Budget]:
    """Query COMPAS' objects."""
    if compas := peers.get("COMPAS"):
        mesh = hem.generate("torus", OBJECT_VERTICES)
        theirs = compas.Mesh.from_vertices_and_faces(mesh.points.tolist(), mesh.triangles.tolist())
        yield _compare_single("COMPAS", structures.build("half_edge", mesh), theirs.vertex_faces)


def _compare_single(peer: str, s: Any, ask: Callable[[int], Any]) -> Budget:
    """One query after the other from a Python loop, at random."""
    chosen = np.random.default_rng(0).permutation(s.n_vertices)[:COUNT].tolist()

    def ask_each(query: Callable[[int], Any]) -> None:
        for vertex in chosen:
            query(vertex)

    ours, theirs = Task(partial(ask_each, s.vertex_faces)), Task(partial(ask_each, ask))
    return compare(f"{COUNT:,} single vertex_faces, {peer}", 1.0, ours, theirs)


def compare_operations(peers: dict[str, Any]) -> Iterator[Budget]:
    """Operate at random, batched and one by one, on OpenMesh's meshes one by one."""
    if not (openmesh := peers.get("OpenMesh")):
        return
    mesh, rng = hem.generate("torus", OPERATED_VERTICES), np.random.default_rng(1)
    s, places = structures.build("half_edge", mesh), rng.random((COUNT, 3))
    points, triangles = mesh.points.astype(np.float64), np.array(mesh.triangles)
    for (operation, batch), asked in OPERATIONS.items():
        every = s.faces() if operation == "split_face" else s.edges()
        chosen = rng.choice(len(every), COUNT, replace=False)
        handles = every[chosen]
        arguments = (handles, places) if operation.startswith("split") else (handles,)
        ours = partial(_operate, batch or operation, bool(batch), arguments)
        theirs = partial(OPENMESH[operation], chosen.tolist(), list(places))
        yield compare(
            f"{COUNT:,} {operation}, {'batched' if batch else 'one by one'}, OpenMesh",
            asked,
            Task(ours, lambda: (_copy_with_room(s),)),
            Task(theirs, lambda: (openmesh.TriMesh(points, triangles),)),
        )


def _copy_with_room(s: Any) -> Any:
    copy = s.copy()
    copy.reserve(COUNT)
    copy.split_face(0, (0, 0, 0))  # binds the operations
    return copy


def _operate(name: str, batched: bool, arguments: tuple[Array, ...], s: Any) -> None:
    operate = getattr(s, name)
    handles, *places = arguments
    for given in [arguments] if batched else zip(handles.tolist(), *places, strict=True):
        try:
            operate(*given)
        except hem.TopologyError:
            continue


def _split(kind: str, handles: list[int], places: list[Array], mesh: Any) -> None:
    for handle, place in zip(map(getattr(mesh, kind), handles), places, strict=True):
        mesh.split(handle, mesh.add_vertex(place))


def _collapse_edges(edges: list[int], _: list[Array], mesh: Any) -> None:
    for edge in map(mesh.edge_handle, edges):
        half_edge = mesh.halfedge_handle(edge, 0)
        if not mesh.is_deleted(edge) and mesh.is_collapse_ok(half_edge):
            mesh.collapse(half_edge)


def _flip_edges(edges: list[int], _: list[Array], mesh: Any) -> None:
    for edge in map(mesh.edge_handle, edges):
        if mesh.is_flip_ok(edge):
            mesh.flip(edge)


OPENMESH: dict[str, Callable[[list[int], list[Array], Any], None]] = {
    "split_face": partial(_split, "face_handle"),
    "split_edge": partial(_split, "edge_handle"),
    "collapse_edge": _collapse_edges,
    "flip_edge": _flip_edges,
}


def compare_simplification(peers: dict[str, Any], mesh: hem.TriangleMesh) -> Iterator[Budget]:
    """Simplify by quadrics to a tenth of the faces: the time, and how far the result is off."""
    faces, names = len(mesh.triangles) // 10, [name for name in SIMPLIFIERS if name in peers]
    made: dict[str, hem.TriangleMesh] = {}

    def ours(s: structures.Structure) -> None:
        algorithms.simplify(s, faces=faces)
        made["ours"] = s.to_triangles()

    def theirs(name: str) -> None:
        made[name] = SIMPLIFIERS[name][1](peers[name], mesh, faces)

    tasks = [Task(ours, lambda: (structures.build("half_edge", mesh),))]
    seconds = time_interleaved([*tasks, *(Task(partial(theirs, name)) for name in names)])
    for name, taken in zip(names, seconds[1:], strict=True):
        asked, ratio = SIMPLIFIERS[name][0], taken / seconds[0]
        measured = f"{ratio:.2f} × ({seconds[0]:,.1f} s, theirs {taken:,.1f} s)"
        what = f"quadrics to a tenth, {name}"
        yield Budget(what, f"≥ {asked:.3g} ×", measured, ratio >= asked)
        if lab := peers.get("pymeshlab"):
            off = [_distance(lab, mesh, made[it]) for it in ("ours", name)]
            measured = (
                f"{off[0] / off[1]:.2f} × (of the diagonal {off[0]:.1e}, theirs {off[1]:.1e})"
            )
            yield Budget(f"{what}: error", "≤ 1 ×", measured, off[0] <= off[1])


def _terrain(n_vertices: int) -> hem.TriangleMesh:
    """A grid with hills of four sizes."""
    grid = hem.generate("grid", n_vertices)
    points = grid.points.copy()
    low, high = grid.bounds
    x, y = 20 * ((points - low)[:, :2] / (high - low)[:2]).T
    for size in (1, 3, 9, 27):
        points[:, 2] += np.sin(size * x + size) * np.cos(0.8 * size * y) / (20 * size)
    return hem.TriangleMesh(points, grid.triangles)


def _scene(pymeshlab: Any, *meshes: hem.TriangleMesh) -> Any:
    scene = pymeshlab.MeshSet()
    for mesh in meshes:
        scene.add_mesh(pymeshlab.Mesh(mesh.points, mesh.triangles))
    return scene


def _simplify_by_pymeshlab(pymeshlab: Any, mesh: hem.TriangleMesh, faces: int) -> hem.TriangleMesh:
    scene = _scene(pymeshlab, mesh)
    scene.meshing_decimation_quadric_edge_collapse(targetfacenum=faces)
    found = scene.current_mesh()
    return hem.TriangleMesh(found.vertex_matrix(), found.face_matrix())


def _distance(pymeshlab: Any, one: hem.TriangleMesh, other: hem.TriangleMesh) -> float:
    """Root mean square of the distances, both ways, in parts of the diagonal."""
    scene = _scene(pymeshlab, one, other)
    found = [
        scene.get_hausdorff_distance(sampledmesh=a, targetmesh=1 - a, samplenum=SAMPLED)
        for a in (0, 1)
    ]
    return float(np.sqrt(np.mean([(it["RMS"] / it["diag_mesh_0"]) ** 2 for it in found])))


def main() -> None:
    """Compare with every library that is installed; print a table after each part."""
    peers, mesh = import_peers(), hem.generate("torus", VERTICES)
    print_budgets(f"Building, torus of {VERTICES:,} vertices", compare_building(peers, mesh))
    print_budgets(f"Queries, torus of {VERTICES:,} vertices", compare_queries(peers, mesh))
    print_budgets(f"Queries, torus of {OBJECT_VERTICES:,} vertices", compare_objects(peers))
    print_budgets(f"Operations, torus of {OPERATED_VERTICES:,}", compare_operations(peers))
    terrain = compare_simplification(peers, _terrain(VERTICES))
    print_budgets(f"Simplification, terrain of {VERTICES:,} vertices", terrain)


if __name__ == "__main__":
    main()
