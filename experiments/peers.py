"""How this project's half-edge mesh compares with other libraries, all measured in one run.

``make peers`` installs them and runs this; ``python -m experiments.peers --help`` says what else.
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
from typing import Annotated, Any, NamedTuple

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

import hem
import structures
from experiments.latency import latency_now
from experiments.subjects import shuffled
from hem.mesh import TriangleMesh

ROUNDS = 7
SINGLE_QUERIES = 100_000
OPERATED = 20_000
OPERATED_VERTICES = 100_000

Task = Callable[[], Any]


class Comparison(NamedTuple):
    """One task, done by us and by others; ``asked``: how many times faster we are to be.

    Tasks of one argument are given what ``fresh`` makes for them, untimed: a mesh to operate on.
    """

    what: str
    asked: float
    ours: Callable[..., Any]
    theirs: dict[str, Callable[..., Any]]
    fresh: dict[str, Task] = {}  # noqa: RUF012  by the name of the peer, "" for us


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
        *_operations(peers),
    ]


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


def _operations(peers: Peers) -> list[Comparison]:
    """Operations on elements at random, batched and one by one, against OpenMesh's from Python."""
    mesh, rng = hem.generate("torus", OPERATED_VERTICES), np.random.default_rng(1)
    s = structures.build("half_edge", mesh)
    points = rng.random((OPERATED, 3))
    places = list(points)
    orders: dict[str, Callable[[Any], Any]] = {
        "at random": lambda every: rng.choice(every, OPERATED, replace=False),
        "in order": lambda every: every[:: len(every) // OPERATED][:OPERATED],
    }

    def reserved() -> Any:
        copy = s.copy()
        copy.reserve(OPERATED)
        copy.split_face(0, (0, 0, 0))  # binds the operations
        return copy

    def openmesh() -> Any:
        return peers.openmesh.TriMesh(mesh.points.astype(np.float64), np.array(mesh.triangles))

    def comparison(what: str, asked: float, ours: Any, theirs: Any) -> Comparison:
        fresh = {"": reserved, "OpenMesh": openmesh}
        return Comparison(f"{OPERATED:,} {what}", asked, ours, {"OpenMesh": theirs}, fresh)

    def om_split_faces(faces: list[int]) -> Callable[[Any], None]:
        def split(om: Any) -> None:
            for face, place in zip(faces, places, strict=True):
                om.split(om.face_handle(face), om.add_vertex(place))

        return split

    def om_split_edges(edges: list[int]) -> Callable[[Any], None]:
        def split(om: Any) -> None:
            for edge, place in zip(edges, places, strict=True):
                om.split(om.edge_handle(edge), om.add_vertex(place))

        return split

    def om_collapse(edges: list[int]) -> Callable[[Any], None]:
        def collapse(om: Any) -> None:
            for edge in edges:
                handle = om.halfedge_handle(om.edge_handle(edge), 0)
                if not om.is_deleted(om.edge_handle(edge)) and om.is_collapse_ok(handle):
                    om.collapse(handle)

        return collapse

    def om_flip(edges: list[int]) -> Callable[[Any], None]:
        def flip(om: Any) -> None:
            for edge in edges:
                handle = om.edge_handle(edge)
                if om.is_flip_ok(handle):
                    om.flip(handle)

        return flip

    def one_by_one(operation: str, handles: list[int], with_points: bool) -> Callable[[Any], None]:
        def operate(mine: Any) -> None:
            method = getattr(mine, operation)
            for i, handle in enumerate(handles):
                try:
                    _ = method(handle, places[i]) if with_points else method(handle)
                except hem.TopologyError:
                    continue

        return operate

    every: list[Comparison] = []
    for order, choose in orders.items():
        faces, edges = choose(s.faces()), choose(s.edges())
        om_edges = choose(np.arange(s.n_edges)).tolist()
        handles = edges.tolist()
        every += [
            comparison(
                f"face splits, batched, {order}",
                10.0,
                lambda mine, it=faces: mine.split_faces(it, points),
                om_split_faces(faces.tolist()),
            ),
            comparison(
                f"edge splits, batched, {order}",
                10.0,
                lambda mine, it=edges: mine.split_edges(it, points),
                om_split_edges(om_edges),
            ),
            comparison(
                f"collapses, batched, {order}",
                5.0,
                lambda mine, it=edges: mine.collapse_edges(it),
                om_collapse(om_edges),
            ),
            comparison(
                f"face splits, one by one, {order}",
                1.0,
                one_by_one("split_face", faces.tolist(), True),
                om_split_faces(faces.tolist()),
            ),
            comparison(
                f"edge splits, one by one, {order}",
                1.0,
                one_by_one("split_edge", handles, True),
                om_split_edges(om_edges),
            ),
            comparison(
                f"collapses, one by one, {order}",
                1.0,
                one_by_one("collapse_edge", handles, False),
                om_collapse(om_edges),
            ),
            comparison(
                f"flips, one by one, {order}",
                1.0,
                one_by_one("flip_edge", handles, False),
                om_flip(om_edges),
            ),
        ]
    return every


def edits_by_size(small: int = 10_000, large: int = 1_000_000) -> dict[str, dict[str, float]]:
    """How many times as much a random edit costs on the large mesh, by structure and operation.

    Nanoseconds per edit, small and large, and of the memory's latency at each working set.
    """
    found: dict[str, dict[str, float]] = {}
    for name in ("triangle_neighbor", "winged_edge", "half_edge"):
        for operation in ("split_face", "split_edge", "collapse_edge", "flip_edge"):
            row: dict[str, float] = {}
            for label, n_vertices in (("small", small), ("large", large)):
                s = structures.build(name, hem.generate("torus", n_vertices))
                row[f"latency {label}"] = 1e9 * latency_now(sum(s.memory().values()))
                row[label] = 1e9 * _seconds_per_edit(s, operation)
            found[f"{name} {operation}"] = row
    return found


def _seconds_per_edit(s: Any, operation: str) -> float:
    """Of so many random edits, restored in between; the median of some rounds."""
    rng, seconds = np.random.default_rng(3), []
    every = s.faces() if operation == "split_face" else s.edges()
    chosen = rng.choice(every, min(OPERATED, len(every) // 4), replace=False)
    copies = [s.copy() for _ in range(ROUNDS)]
    for copy in copies:
        prepared = copy.prepare(operation, chosen, np.zeros((len(chosen), 3)))
        begin = perf_counter()
        prepared.run()
        seconds.append((perf_counter() - begin) / len(chosen))
    return float(np.median(seconds[1:]))


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


def _rendered_edits(edits: dict[str, dict[str, float]]) -> Table:
    table = Table(title=f"{OPERATED:,} random edits on 10,000 and on 1,000,000 vertices")
    heads = ("edit", "small, ns", "large, ns", "ratio", "latency's", "ratio less latency", "asked")
    for head in heads:
        table.add_column(head, justify="left" if head == "edit" else "right")
    for name, row in edits.items():
        ratio = row["large"] / row["small"]
        latency = row["latency large"] / row["latency small"]
        numbers = f"{row['small']:.0f}", f"{row['large']:.0f}", f"{ratio:.2f}", f"{latency:.2f}"
        table.add_row(name, *numbers, f"{ratio / latency:.2f}", "≤ 2")
    return table


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
            cells = f"{1e3 * ours:.1f}", peer, f"{1e3 * theirs:.1f}", f"{ratio:.2f}"
            table.add_row(comparison.what, *cells, f"{comparison.asked:g}", met)
        table.add_section()
    console.print(table)
    edits = edits_by_size()
    console.print(_rendered_edits(edits))
    sizes = memory_while_building(vertices)
    for how in ("traced", "resident"):
        ratio = sizes[how] / sizes["finished"]
        console.print(f"Peak while building, {how}: {ratio:.2f} × the finished structure (under 3)")
    if output:
        output.write_text(json.dumps({"seconds": kept, "edits": edits, "bytes": sizes}, indent=1))


if __name__ == "__main__":
    typer.run(main)
