"""How this project's half-edge mesh compares with other libraries, all measured in one run.

``make peers`` installs them and runs this;
``python -m experiments.validation.peers --help`` says what else.
Competitors take turns, round by round, so that a machine that slows down slows all of them; a ratio
is that of the medians.
"""

from __future__ import annotations

import gc
import json
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from time import perf_counter
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

import hem
import structures
from experiments.harness.cases import shuffled
from experiments.validation.peer_operations import (
    ROUNDS,
    Comparison,
    Task,
    edits_by_size,
    operated,
    rendered_edits,
)
from hem.contract.queries import ELEMENTS, QUERIES, Query
from hem.contract.structure import Structure
from hem.meshes.triangles import TriangleMesh

SINGLE_QUERIES = 100_000


class Peers:
    """The other libraries, imported, with what each builds of a mesh."""

    def __init__(self) -> None:
        names = {
            "openmesh": "openmesh",
            "igl": "igl",
            "meshlib": "meshlib.mrmeshnumpy",
            "trimesh": "trimesh",
            "compas": "compas.datastructures",
        }
        try:
            self._modules = {name: import_module(module) for name, module in names.items()}
        except ImportError as error:
            raise ImportError(f"{error}; install the peers with: make peers") from error

    def __getattr__(self, name: str) -> Any:
        return self._modules[name]

    def builders(self, mesh: TriangleMesh) -> dict[str, Task]:
        """What each library does to know the neighbors in a mesh."""
        points, faces = mesh.points.astype(np.float64), mesh.triangles.astype(np.int64)
        triangles = np.array(mesh.triangles)
        return {
            "OpenMesh TriMesh": lambda: self.openmesh.TriMesh(points, triangles),
            "MeshLib meshFromFacesVerts": lambda: self.meshlib.meshFromFacesVerts(
                triangles, points
            ),
            "libigl triangle_triangle_adjacency": lambda: self.igl.triangle_triangle_adjacency(
                faces
            ),
        }


def comparisons(n_vertices: int) -> list[Comparison]:
    """Everything that is compared, on a torus of so many vertices."""
    peers, mesh = Peers(), hem.generate("torus", n_vertices)
    mixed = shuffled(mesh)
    s = structures.build("half_edge", mesh)
    om = peers.openmesh.TriMesh(mesh.points.astype(np.float64), np.array(mesh.triangles))
    faces = mesh.triangles.astype(np.int64)
    vertices, all_faces = s.vertices(), s.faces()
    return [
        Comparison(
            "build",
            5.0,
            lambda: structures.build("half_edge", mesh),
            peers.builders(mesh),
        ),
        Comparison(
            "build, renumbered at random",
            1.5,
            lambda: structures.build("half_edge", mixed),
            peers.builders(mixed),
        ),
        Comparison(
            "vertex_faces of all",
            1.5,
            lambda: s.vertex_faces(vertices),
            {
                "OpenMesh vf_indices": om.vf_indices,
                "trimesh vertex_faces": lambda: (
                    peers.trimesh.Trimesh(mesh.points, mesh.triangles, process=False).vertex_faces
                ),
                "libigl vertex_triangle_adjacency": lambda: peers.igl.vertex_triangle_adjacency(
                    faces, len(mesh.points)
                ),
            },
        ),
        Comparison(
            "face_faces of all",
            1.5,
            lambda: s.face_faces(all_faces),
            {"OpenMesh ff_indices": om.ff_indices},
        ),
        *_single_queries(peers, mesh, s, om),
        Comparison(
            "build Plankton's half-edges",
            3.0,
            lambda: structures.build("plankton", mesh),
            {"OpenMesh TriMesh": peers.builders(mesh)["OpenMesh TriMesh"]},
        ),
        *_against_half_edges(mesh, s),
        *operated(peers.openmesh),
    ]


def _against_half_edges(mesh: TriangleMesh, half_edge: Structure) -> list[Comparison]:
    """Every query of all elements on Plankton's half-edges, beside those of the half-edge mesh."""
    plankton = structures.build("plankton", mesh)
    handles = {(s, source): s.handles(source) for s in (plankton, half_edge) for source in ELEMENTS}

    def ask(s: Structure, query: Query) -> Task:
        return lambda: getattr(s, query.name)(handles[s, query.source])

    return [
        Comparison(
            f"{name} of all, Plankton",
            1 / 1.5,
            ask(plankton, query),
            {"half-edge mesh": ask(half_edge, query)},
        )
        for name, query in QUERIES.items()
    ]


def seconds_to_build_objects(n_vertices: int = 100_000) -> float:
    """The class model built of a torus: the median of three times."""
    mesh, seconds = hem.generate("torus", n_vertices), []
    for _ in range(3):
        begin = perf_counter()
        structures.build("half_edge_objects", mesh)
        seconds.append(perf_counter() - begin)
    return float(np.median(seconds))


def _single_queries(peers: Peers, mesh: TriangleMesh, s: Any, om: Any) -> list[Comparison]:
    """One query after the other from a Python loop, in two orders of the vertices."""
    compas = peers.compas.Mesh.from_vertices_and_faces(
        mesh.points.tolist(), mesh.triangles.tolist()
    )
    random = np.random.default_rng(0).permutation(len(mesh.points))[:SINGLE_QUERIES]
    orders = {"at random": random, "in order": np.arange(len(random))}
    ask, ask_compas = s.vertex_faces, compas.vertex_faces

    def ask_openmesh(vertex: int) -> list[int]:
        return [face.idx() for face in om.vf(om.vertex_handle(vertex))]

    def loop(query: Callable[[int], Any], vertices: list[int]) -> Task:
        def ask_all() -> None:
            for vertex in vertices:
                query(vertex)

        return ask_all

    return [
        Comparison(
            f"{len(vertices):,} single vertex_faces {name}",
            1.0,
            loop(ask, vertices.tolist()),
            {
                "OpenMesh iterator": loop(ask_openmesh, vertices.tolist()),
                "COMPAS vertex_faces": loop(ask_compas, vertices.tolist()),
            },
        )
        for name, vertices in orders.items()
    ]


def measure(comparison: Comparison) -> dict[str, list[float]]:
    """Seconds per round for us ("") and every peer, in turns, after one round for warming up."""
    tasks = {"": comparison.ours, **comparison.theirs}
    seconds: dict[str, list[float]] = {name: [] for name in tasks}
    for turn in range(ROUNDS + 1):
        for name, task in tasks.items():
            fresh = comparison.fresh.get(name)
            given = () if fresh is None else (fresh(),)
            gc.collect()
            begin = perf_counter()
            result = task(*given)
            took = perf_counter() - begin
            del result, given
            if turn:
                seconds[name].append(took)
    return seconds


def memory_while_building(n_vertices: int) -> dict[str, float]:
    """Bytes in a process of its own: the finished structure, and the most while it was built."""
    script = (
        "import sys, json, tracemalloc, hem, structures\n"
        "mesh = hem.generate('torus', int(sys.argv[1]))\n"
        "structures.build('half_edge', hem.generate('torus', 400))\n"
        "def status(key):\n"
        "    lines = open('/proc/self/status').read().splitlines()\n"
        "    return 1024 * int(next(l for l in lines if l.startswith(key)).split()[1])\n"
        "open('/proc/self/clear_refs', 'w').write('5')\n"
        "before = status('VmRSS')\n"
        "s = structures.build('half_edge', mesh)\n"
        "resident = status('VmHWM') - before\n"
        "del s\n"
        "tracemalloc.start()\n"
        "s = structures.build('half_edge', mesh)\n"
        "traced = tracemalloc.get_traced_memory()[1]\n"
        "size = sum(s.memory().values())\n"
        "print(json.dumps({'finished': size, 'traced': traced, 'resident': resident}))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, str(n_vertices)], capture_output=True, text=True, check=True
    )
    sizes: dict[str, float] = json.loads(done.stdout)
    return sizes


def main(
    vertices: Annotated[int, typer.Option(help="Size of the torus.")] = 1_000_000,
    output: Annotated[Path | None, typer.Option("--json", help="Keep the rounds here.")] = None,
) -> None:
    """Compare with OpenMesh, libigl, MeshLib, trimesh and COMPAS, and print the ratios."""
    console = Console()
    table = Table(title=f"Half-edge mesh against its peers, torus of {vertices:,} vertices")
    for head in ("what", "ours, ms", "peer", "peer's, ms", "times faster", "asked", ""):
        right = head not in ("what", "peer", "")
        table.add_column(head, justify="right" if right else "left")
    kept = {}
    try:
        every = comparisons(vertices)
    except ImportError as error:
        console.print(f"[bold red]hem:[/] {error}")
        raise typer.Exit(1) from error
    for comparison in every:
        seconds = kept[comparison.what] = measure(comparison)
        ours = float(np.median(seconds[""]))
        for peer in comparison.theirs:
            theirs = float(np.median(seconds[peer]))
            ratio = theirs / ours
            met = "✓" if ratio >= comparison.asked else "✗"
            cases = f"{1e3 * ours:.1f}", peer, f"{1e3 * theirs:.1f}", f"{ratio:.2f}"
            table.add_row(comparison.what, *cases, f"{comparison.asked:.3g}", met)
        table.add_section()
    console.print(table)
    edits = edits_by_size()
    console.print(rendered_edits(edits))
    sizes = memory_while_building(vertices)
    for how in ("traced", "resident"):
        ratio = sizes[how] / sizes["finished"]
        console.print(f"Peak while building, {how}: {ratio:.2f} × the finished structure (under 3)")
    objects = seconds_to_build_objects()
    console.print(f"Objects of 100,000 vertices: built in {objects:.2f} s (under 5)")
    if output:
        output.write_text(json.dumps({"seconds": kept, "edits": edits, "bytes": sizes}, indent=1))


if __name__ == "__main__":
    typer.run(main)
