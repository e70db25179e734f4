"""How fast our structures are beside other libraries, up to a million vertices: one run of all.

``python -m experiments.validation.speed`` has every program work in turn on a torus, and simplify a
terrain, on one core, in seconds of the processor: of C++ and of ours in compiled loops. What is
built, asked of all elements and simplified is so once more on all cores, in seconds that pass; all
else uses one thread anyway. The least of several rounds stands. It takes the extra ``peers`` and a
quarter of an hour.
"""

import json
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from importlib.metadata import version
from importlib.util import find_spec
from itertools import chain, product
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter, process_time
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import psutil
import typer

import hem
import structures
from experiments.harness import Clock, pin, took
from experiments.peers import BATCHED, BUILD, OURS, PART, PEERS, SIX, Lazy, as_given, ask_each
from experiments.peers.libraries.ours import build, looped
from experiments.runs import describe
from hem import TriangleMesh, algorithms
from hem.arrays import Array
from hem.sources import meshlab

RESULT = Path("results/reference/speed.json")
COLUMNS = ["work", "vertices", "cores", "program", "value"]
fast_simplification = Lazy("fast_simplification")
SIZES = 100_000, 1_000_000
TURNS, ROUNDS = 2, 3
ASKED = 20_000
"""Elements that are asked and operated on one by one."""
SAMPLES = 200_000
"""Points of each mesh whose distance to the other is measured."""
ONE, ALL = "one", "all"
CLOCKS = {ONE: process_time, ALL: perf_counter}
THREADS = "NUMBA_NUM_THREADS"
"""How many threads a process of ours uses at most, which it reads when it begins."""
WARM = 2_000
"""Vertices of what is worked on first, so that all is compiled."""

STRUCTURES = [
    name
    for name, it in structures.REGISTRY.items()
    if it.compiled and not (it.searches or it.rebuilds)
]
"""Ours that walk from neighbor to neighbor."""
COMPILED = "cgal", "openmesh_cpp"
"""Libraries that are asked in loops of their own."""
BUILT = "openmesh", "libigl", "meshlib"
"""Those that are built from arrays in Python, of neighbors."""
ASKED_SINGLY = "openmesh", "meshlib", "compas"
"""Those that are asked one element after the other."""
WORKS = {
    "In compiled loops": {
        **SIX,
        **{it: f"{it.replace('_', ' ').capitalize()}, each of a batch" for it in BATCHED},
        "all vertex_faces": "vertex → faces of all, each",
        "all face_faces": "face → faces of all, each",
    },
    "Built from arrays": {BUILD: "Build"},
    "From Python, one after the other": {
        "one in order": "vertex → faces, in order",
        "one random": "vertex → faces, at random",
        "flip_edge": "Flip, at random",
    },
    "A terrain simplified by quadrics": {
        "simplify": "To a tenth",
        "rms": "Its error, root mean square",
        "largest": "Its largest error",
    },
}
"""What is measured, and how tables call it: seconds, or parts of the diagonal."""
ERRORS = "largest", "rms"


class Simplifier(NamedTuple):
    """Builds a mesh of points and triangles, simplifies it to so many faces, gives the outcome."""

    build: Callable[[Array, Array], Any]
    simplify: Callable[[Any, int], Any]
    outcome: Callable[[Any, Any], TriangleMesh]


Rows = Iterator[tuple[str, int, str, str, float]]
"""By ``COLUMNS``: what a program took for a work, or how far off it was."""


def _with_children() -> float:
    """Seconds of the processor of this process and of pymeshlab's."""
    children = (it.cpu_times() for it in psutil.Process().children())
    return process_time() + sum(it.user + it.system for it in children)


def _least(call: Callable[..., Any], *given: Any, clock: Clock = process_time) -> float:
    return min(took(call, *given, clock=clock)[1] for _ in range(ROUNDS))


def in_loops(vertices: int) -> Rows:
    """The six and batches; in C++ building and queries of all elements, too."""
    mesh = hem.generate("torus", vertices)
    given = mesh.points, mesh.triangles
    loops: dict[str, Any] = {name: partial(looped, structure=name) for name in STRUCTURES}
    loops |= {name: PEERS[name].looped for name in COMPILED if PEERS[name].version}
    for _, (name, loop) in product(range(TURNS), loops.items()):
        for work, seconds in loop(*given, rounds=0, whole=ROUNDS)["times"].items():
            yield work, vertices, ONE, name, min(seconds)


def all_at_once(vertices: int, cores: str) -> Rows:
    """Queries of all elements of ours; the programs in C++ have theirs among their loops."""
    mesh = hem.generate("torus", vertices)
    for _, name in product(range(TURNS), STRUCTURES):
        s = structures.build(name, mesh)
        for query, elements in (("vertex_faces", s.n_vertices), ("face_faces", s.n_faces)):
            taken = _least(getattr(s, query), clock=CLOCKS[cores])
            yield f"all {query}", vertices, cores, name, taken / elements


def building(vertices: int, cores: str) -> Rows:
    """From arrays in Python."""
    mesh, clock = hem.generate("torus", vertices), CLOCKS[cores]
    builds = {name: partial(structures.build, name, mesh) for name in STRUCTURES}
    builds |= {it: partial(PEERS[it].build, *as_given(mesh)) for it in BUILT if PEERS[it].version}
    for _, (name, call) in product(range(TURNS), builds.items()):
        yield BUILD, vertices, cores, name, _least(call, clock=clock)


def one_after_the_other(vertices: int) -> Rows:
    """Single calls of Python: queries, in order and at random, and flips."""
    given, draw = as_given(hem.generate("torus", vertices)), np.random.default_rng(1).permutation
    orders = {"in order": [*range(min(ASKED, vertices))], "random": draw(vertices)[:ASKED].tolist()}
    edges = draw(3 * vertices)[:ASKED].tolist()
    peers = {it: PEERS[it] for it in ASKED_SINGLY if PEERS[it].version}
    peers |= {it: replace(PEERS[OURS], build=partial(build, structure=it)) for it in STRUCTURES}
    meshes = {name: it.build(*given) for name, it in peers.items()}
    for _, (name, peer) in product(range(TURNS), peers.items()):
        ask = peer.single["vertex_faces"](meshes[name])
        for order, numbers in orders.items():
            handles = peer.handles(meshes[name], "vertex", numbers)
            taken = _least(ask_each, ask, handles)
            yield f"one {order}", vertices, ONE, name, taken / len(handles)
        if flip := peer.operations.get("flip_edge"):
            fresh = [peer.build(*given) for _ in range(ROUNDS)]
            named = [(m, peer.handles(m, "edge", edges)) for m in fresh]
            flips = [took(flip, *it, None, clock=process_time) for it in named]
            yield "flip_edge", vertices, ONE, name, min(taken / done for done, taken in flips)


def simplifiers() -> dict[str, Simplifier]:
    """Ours and others, OpenMesh where it is installed."""
    openmesh, quadrics = PEERS["openmesh"], "meshing_decimation_quadric_edge_collapse"
    found = {
        name: Simplifier(
            partial(build, structure=name),
            lambda s, faces: algorithms.simplify(s, faces=faces),
            lambda s, _: s.to_triangles(),
        )
        for name in STRUCTURES
    }
    if openmesh.version:
        found["openmesh"] = Simplifier(
            openmesh.build,
            openmesh.algorithms["simplify"],
            lambda m, _: TriangleMesh(m.points(), m.face_vertex_indices()),
        )
    found["fast-simplification"] = Simplifier(
        lambda *given: given,
        lambda given, faces: fast_simplification.simplify(*given, target_count=faces),
        lambda _, made: TriangleMesh(*made),
    )
    found["pymeshlab"] = Simplifier(
        TriangleMesh,
        lambda m, faces: meshlab.apply(quadrics, m, targetfacenum=faces, preserveboundary=True),
        lambda _, made: made,
    )
    return found


def simplifying(vertices: int, cores: str) -> Rows:
    """A terrain to a tenth by quadrics, and how far that is from it."""
    mesh = hem.generate("terrain", vertices)
    faces, clock = len(mesh.triangles) // PART, _with_children if cores == ONE else perf_counter
    for name, it in simplifiers().items():
        for _ in range(TURNS):
            m = it.build(*as_given(mesh))
            made, taken = took(it.simplify, m, faces, clock=clock)
            yield "simplify", vertices, cores, name, taken
        if cores == ONE:
            errors = meshlab.distances(mesh, it.outcome(m, made), SAMPLES)
            for work, value in zip(ERRORS, errors, strict=True):
                yield work, vertices, cores, name, value


def measured(cores: str, many: int, few: int) -> list[tuple[Any, ...]]:
    """All rows of a process, on one core or on all, at these numbers of vertices."""
    works = [building(many, cores), all_at_once(many, cores), simplifying(many, cores)]
    if cores == ONE:
        works += [in_loops(few), in_loops(many), one_after_the_other(few)]
    rows = []
    for row in chain.from_iterable(works):
        print(*row, flush=True)  # so that nobody waits for a quarter of an hour without a word
        rows.append(row)
    return rows


def load_speed(path: Path = RESULT) -> tuple[dict[str, Any], pd.DataFrame]:
    """What was measured when, and the least of each: a row per work, size and cores."""
    kept = json.loads(path.read_text("utf-8"))
    rows = pd.DataFrame(kept["rows"], columns=COLUMNS)
    keys = COLUMNS[:3]
    return kept, rows.pivot_table("value", keys, "program", aggfunc="min", sort=False)


def left_out() -> str:
    """Which of our structures are not measured, and why."""
    absent = [it.title for name, it in structures.REGISTRY.items() if name not in STRUCTURES]
    return (
        f"Left out are {', '.join(absent)}: they search the mesh, find all neighbors again after "
        "an edit, or are objects, whose steps Python runs."
    )


def versions() -> dict[str, str]:
    """By program, of the libraries that are measured; empty where one is not installed."""
    peers = {it: PEERS[it].version for it in (*COMPILED, *BUILT, *ASKED_SINGLY)}
    return {**peers, "fast-simplification": version("fast-simplification")}


def require(output: Path) -> None:
    """Say now what is missing, and not in a quarter of an hour."""
    if not output.parent.is_dir():
        raise typer.BadParameter(f"there is no folder {output.parent}; run it from the checkout")
    if absent := meshlab.problem():
        raise typer.BadParameter(absent)
    if not find_spec("fast_simplification"):
        raise typer.BadParameter("it takes fast-simplification: pip install 'hem-mesh[peers]'")


def main(output: Path = RESULT, many: int = SIZES[1], few: int = SIZES[0]) -> None:
    """Measure all, keep it, and print the least of each."""
    require(output)
    kept = {key: value for key, value in describe("").items() if key != "preset"}
    rows: list[tuple[Any, ...]] = []
    for cores in CLOCKS:
        os.environ[THREADS] = "1" if cores == ONE else str(os.cpu_count() or 1)
        first = pin if cores == ONE else None
        with ProcessPoolExecutor(1, get_context("spawn"), first) as process:
            process.submit(measured, cores, WARM, WARM).result()  # compiles all that will be timed
            rows += process.submit(measured, cores, many, few).result()
    kept |= {"columns": COLUMNS, "rows": rows, "versions": kept["versions"] | versions()}
    output.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    print(load_speed(output)[1].to_string(float_format="{:.3g}".format))


if __name__ == "__main__":
    typer.run(main)
