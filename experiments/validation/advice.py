"""How far ``hem advise`` can be trusted: what it predicts, held against what programs then take.

``python -m experiments.validation.advice`` measures queries, operations and building on this
machine, and then programs that no price was made of: the algorithms, breaking a surface, mixes
drawn at random, on families and real models. What a program does is recorded on a small torus and
one structure; its own part comes from timing it there. Every other structure is predicted. Takes a
quarter of an hour of a machine's whole attention, most of it to compile.
"""

import json
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
import typer

import hem
import structures
from experiments.advice import Measured, Prices, Workload, predict, recorded
from experiments.runs import describe, load, study
from hem import algorithms
from hem.contract import QUERIES, Structure

RESULT = Path("results/reference/advice.json")
NEEDED = ("bench_queries", "bench_operations", "bench_build")
PRESET = "quick"

RECORDED, TIMED = "torus:400", "torus:2000"
"""The meshes that programs are recorded on, and timed on to learn their own part."""

ON = ("torus:20000", "sphere:5000", "terrain:5000", "cow", "bunny")
"""The meshes that are predicted."""

ROUNDS = 5
LONGEST = 4.0
"""Seconds a program may take; where more is predicted it is not run."""

ALIKE = 1.1
MIXES = 4
STEPS = 60

COMPILED = [name for name, it in structures.REGISTRY.items() if it.compiled]
BASE = next(
    name for name in COMPILED
    if not (structures.REGISTRY[name].searches or structures.REGISTRY[name].rebuilds)
)  # fmt: skip
"""What programs are recorded and timed on."""


class Program(NamedTuple):
    """What is done to a mesh; ``each``: in proportion to what it takes."""

    run: Callable[[Structure], Any]
    each: str = "vertex"


def _impacts(s: Structure) -> None:
    algorithms.impacts(s, np.random.default_rng(1).integers(0, s.n_faces, 100))


def _mix(seed: int) -> Callable[[Structure], None]:
    """Batches of queries at random or in order, and batches of splits, as drawn by the seed."""

    def run(s: Structure) -> None:
        rng = np.random.default_rng(seed)
        names = rng.choice(list(QUERIES), 4, replace=False)
        for step in range(STEPS):
            query = QUERIES[str(rng.choice(names))]
            handles = s.handles(query.source)
            count = int(rng.integers(50, 400))
            first = int(rng.integers(len(handles)))
            some = first + np.arange(count) if step % 2 else rng.integers(len(handles), size=count)
            getattr(s, query.name)(handles[some % len(handles)])
            if seed % 2 and step % 20 == 0:
                faces = rng.choice(s.faces(), 20, replace=False)
                s.split_faces(faces, np.zeros((20, 3)))

    return run


def _asking(s: Structure) -> None:
    """What a plug-in does: one question after the other, from Python."""
    for v in np.random.default_rng(2).integers(0, s.n_vertices, 300).tolist():
        for f in s.vertex_faces(v).tolist():
            s.face_vertices(f)
        s.vertex_vertices(v)


PROGRAMS = {
    "vertex normals": Program(algorithms.vertex_normals),
    "smoothing": Program(algorithms.smooth),
    "split all faces": Program(lambda s: s.split_all_faces()),
    "loop subdivision": Program(lambda s: algorithms.subdivide(s, "loop")),
    "sqrt3 subdivision": Program(lambda s: algorithms.subdivide(s, "sqrt3")),
    "simplify": Program(lambda s: algorithms.simplify(s, vertices=s.n_vertices // 4)),
    "remesh": Program(lambda s: algorithms.remesh(s, iterations=1)),
    "impacts": Program(_impacts, ""),
    "circulate": Program(algorithms.circulate),
    "split and collapse": Program(algorithms.split_and_collapse),
    "shatter": Program(lambda s: hem.fracture.shatter(s, s.points[s.vertices()[0]]), ""),
    "asking from Python": Program(_asking, ""),
    **{f"mix {seed}": Program(_mix(seed), "") for seed in range(MIXES)},
}


def learned(prices: Prices, name: str) -> Workload:
    """What a program does, and its own part: from one structure on a torus."""
    program = PROGRAMS[name]
    s = structures.build(BASE, hem.find_mesh(RECORDED))
    with hem.record(s) as recording:
        program.run(s)
    workload = recorded(recording, name, program.each)
    mesh = hem.find_mesh(TIMED)
    known = Measured(BASE, len(mesh.points), timed(program, BASE, mesh))
    return replace(workload, measured=known)


def timed(program: Program, structure: str, mesh: Any) -> float:
    """Seconds, the median of some rounds on copies."""
    s, seconds = structures.build(structure, mesh), []
    for _ in range(ROUNDS + 1):
        copy = s.copy()
        copy.scratch(0)
        if structures.REGISTRY[structure].rebuilds:
            copy.vertex_faces(0)
        begin = perf_counter()
        program.run(copy)
        seconds.append(perf_counter() - begin)
        if sum(seconds) > LONGEST:
            break
    return median(seconds[1:] or seconds)


def compare(prices: Prices, name: str, mesh_name: str) -> dict[str, Any]:
    """Predict a program on a mesh for every structure, then run it on all that are not hopeless."""
    workload, mesh = learned(prices, name), hem.find_mesh(mesh_name, triangulate=True)
    faces = len(mesh.triangles)
    rows = []
    for structure in COMPILED:
        found = predict(prices, workload, structure, faces)
        row = {"structure": structure, "low": found.low, "high": found.high}
        row |= {"predicted": found.seconds, "taken": None}
        if found.seconds < LONGEST:
            row["taken"] = timed(PROGRAMS[name], structure, mesh)
        rows.append(row)
    return {"program": name, "mesh": mesh_name, "faces": faces, "structures": rows}


def pairs() -> Iterator[tuple[str, str]]:
    """Every program on two of the meshes, in turn."""
    for place, name in enumerate(PROGRAMS):
        for step in (0, 2):
            yield name, ON[(place + step) % len(ON)]


def figures(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """How far off the predictions were; what they learned from is not among them."""
    told = [
        it for row in rows for it in row["structures"] if it["taken"] and it["structure"] != BASE
    ]
    errors = [abs(it["predicted"] / it["taken"] - 1) for it in told]
    right = [_is_right(row["structures"]) for row in rows]
    return {
        "workloads": len(rows),
        "predictions": len(told),
        "median_error": float(np.median(errors)),
        "within_30_percent": float(np.mean(np.array(errors) <= 0.3)),
        "within_interval": float(np.mean([it["low"] <= it["taken"] <= it["high"] for it in told])),
        "winner_right": float(np.mean(right)),
    }


def _is_right(rows: list[dict[str, Any]]) -> bool:
    """Whether the predicted best is alike the best; what was not run is far behind."""
    ran = [it for it in rows if it["taken"]]
    chosen = min(ran, key=lambda it: it["predicted"])
    return bool(chosen["taken"] <= ALIKE * min(it["taken"] for it in ran))


def in_words(kept: dict[str, Any]) -> str:
    """Say what was kept in a sentence."""
    return (
        "Of {workloads} workloads, {predictions} predictions: off by {median_error:.0%} in the "
        "median, {within_30_percent:.0%} within 30 %, {within_interval:.0%} within the interval; "
        "the best structure was told in {winner_right:.0%}.".format(**kept)
    )


def main(output: Path = RESULT, run: Path | None = None) -> None:
    """Measure, predict, compare, keep. ``run``: prices that this machine measured before."""
    with tempfile.TemporaryDirectory(prefix="hem-advice-") as root:
        folder = run or study.begin(PRESET, Path(root), COMPILED, NEEDED)
        if run is None:
            study.run(folder)
        prices = Prices(load(folder))
        rows = []
        for name, mesh in pairs():
            rows.append(compare(prices, name, mesh))
            print(name, mesh, figures(rows[-1:]), flush=True)
    kept = {key: value for key, value in describe(PRESET).items() if key != "schema"}
    kept |= {"learned_from": BASE, **figures(rows), "rows": rows}
    output.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    print(in_words(kept))


if __name__ == "__main__":
    typer.run(main)
