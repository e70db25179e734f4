"""How this project's half-edge mesh compares with other libraries, all measured in one run.

``make peers`` installs them and runs this. One that has no distribution for this Python is skipped,
and said so. COMPAS, whose meshes are Python objects, is compared on a smaller mesh than the others.
"""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

import hem
import structures
from experiments.harness import shuffled
from experiments.validation.budgets import (
    Budget,
    Comparison,
    Task,
    peak_bytes,
    print_budgets,
    run_in_new_process,
    time_interleaved,
)
from experiments.validation.peer_operations import compare_operations
from hem.meshes import TriangleMesh

Array = NDArray[Any]

VERTICES = 1_000_000
OBJECT_VERTICES = 20_000
SINGLE_QUERIES = 100_000

MODULES = {
    "OpenMesh": "openmesh",
    "MeshLib": "meshlib.mrmeshnumpy",
    "libigl": "igl",
    "trimesh": "trimesh",
    "COMPAS": "compas.datastructures",
}

BUILDERS: dict[str, Callable[[Any, Array, Array], Any]] = {
    "OpenMesh": lambda openmesh, points, triangles: openmesh.TriMesh(points, triangles),
    "MeshLib": lambda meshlib, points, triangles: meshlib.meshFromFacesVerts(triangles, points),
    "libigl": lambda igl, _, triangles: igl.triangle_triangle_adjacency(triangles),
}


def import_peers() -> dict[str, Any]:
    """The libraries that are installed, by name."""
    modules = {}
    for name, module in MODULES.items():
        try:
            modules[name] = import_module(module)
        except ImportError as error:
            print(f"{name} is skipped: {error} (Python {platform.python_version()})", flush=True)
    return modules


def compare_building(peers: dict[str, Any], mesh: TriangleMesh) -> Iterator[Comparison]:
    """What each library does to know the neighbors in a mesh."""
    cases = (
        ("build", 5.0, "half_edge", mesh, BUILDERS),
        ("build, renumbered at random", 1.5, "half_edge", shuffled(mesh), BUILDERS),
        ("build Plankton's half-edges", 3.0, "plankton", mesh, ("OpenMesh",)),
    )
    for what, asked, structure, built, names in cases:
        ours = Task(partial(structures.build, structure, built))
        points, triangles = built.points.astype(np.float64), built.triangles.astype(np.int64)
        for name in names:
            if name in peers:
                theirs = Task(partial(BUILDERS[name], peers[name], points, triangles))
                yield Comparison(what, asked, name, ours, theirs)


def compare_queries(peers: dict[str, Any], mesh: TriangleMesh) -> Iterator[Comparison]:
    """Queries of all elements at once."""
    s = structures.build("half_edge", mesh)
    vertices, all_faces, faces = s.vertices(), s.faces(), mesh.triangles.astype(np.int64)
    vertex_faces = Task(lambda: s.vertex_faces(vertices))
    if openmesh := peers.get("OpenMesh"):
        om = openmesh.TriMesh(mesh.points.astype(np.float64), np.array(mesh.triangles))
        yield Comparison(
            "vertex_faces of all", 1.5, "OpenMesh vf_indices", vertex_faces, Task(om.vf_indices)
        )
        ours, theirs = Task(lambda: s.face_faces(all_faces)), Task(om.ff_indices)
        yield Comparison("face_faces of all", 1.5, "OpenMesh ff_indices", ours, theirs)
        yield from _compare_single_queries(
            "OpenMesh iterator", s, lambda v: [face.idx() for face in om.vf(om.vertex_handle(v))]
        )
    if trimesh := peers.get("trimesh"):
        theirs = Task(lambda: trimesh.Trimesh(mesh.points, faces, process=False).vertex_faces)
        yield Comparison("vertex_faces of all", 1.5, "trimesh", vertex_faces, theirs)
    if igl := peers.get("libigl"):
        theirs = Task(lambda: igl.vertex_triangle_adjacency(faces, len(mesh.points)))
        yield Comparison("vertex_faces of all", 1.5, "libigl", vertex_faces, theirs)


def compare_objects(peers: dict[str, Any]) -> Iterator[Comparison]:
    """One query after the other, as COMPAS answers them."""
    if compas := peers.get("COMPAS"):
        mesh = hem.generate("torus", OBJECT_VERTICES)
        s = structures.build("half_edge", mesh)
        theirs = compas.Mesh.from_vertices_and_faces(mesh.points.tolist(), mesh.triangles.tolist())
        what = f"COMPAS, torus of {OBJECT_VERTICES:,} vertices"
        yield from _compare_single_queries(what, s, theirs.vertex_faces)


def _compare_single_queries(peer: str, s: Any, ask: Callable[[int], Any]) -> Iterator[Comparison]:
    """One query after the other from a Python loop, in two orders of the vertices."""
    shuffled_vertices = np.random.default_rng(0).permutation(s.n_vertices)[:SINGLE_QUERIES]
    count = len(shuffled_vertices)
    for order, chosen in (("at random", shuffled_vertices), ("in order", np.arange(count))):
        what = f"{count:,} single vertex_faces {order}"
        yield Comparison(what, 1.0, peer, _ask_each(s.vertex_faces, chosen), _ask_each(ask, chosen))


def _ask_each(ask: Callable[[int], Any], vertices: NDArray[np.int64]) -> Task:
    handles = vertices.tolist()

    def ask_each() -> None:
        for vertex in handles:
            ask(vertex)

    return Task(ask_each)


def measure_building() -> list[Budget]:
    """The memory that building takes, in a process of its own, and how long objects take."""
    size, peak = run_in_new_process(_build_and_weigh)
    mesh = hem.generate("torus", 100_000)
    (seconds,) = time_interleaved([Task(lambda: structures.build("half_edge_objects", mesh))], 1)
    return [
        Budget(
            "peak while building, by what is built",
            "< 3 ×",
            f"{peak / size:.2f} ×",
            peak < 3 * size,
        ),
        Budget("build objects of 100,000 vertices", "< 5 s", f"{seconds:.2f} s", seconds < 5),
    ]


def _build_and_weigh() -> tuple[int, int]:
    structures.build("half_edge", hem.generate("torus", 400))  # compiles
    mesh = hem.generate("torus", VERTICES)
    s, peak = peak_bytes(lambda: structures.build("half_edge", mesh))
    return sum(s.memory().values()), peak


def main() -> None:
    """Compare with OpenMesh, MeshLib, libigl, trimesh and COMPAS; print a table after each part."""
    peers, mesh = import_peers(), hem.generate("torus", VERTICES)
    size = f"torus of {VERTICES:,} vertices"
    parts: dict[str, Iterator[Comparison]] = {
        f"Building, {size}": compare_building(peers, mesh),
        f"Queries, {size}": compare_queries(peers, mesh),
        "Queries of objects": compare_objects(peers),
    }
    if openmesh := peers.get("OpenMesh"):
        parts["Operations, torus of 100,000 vertices"] = compare_operations(openmesh)
    for title, comparisons in parts.items():
        print_budgets(title, [comparison.measure() for comparison in comparisons])
    print_budgets("Our own", measure_building())


if __name__ == "__main__":
    main()
