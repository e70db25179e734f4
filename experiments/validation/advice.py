"""How far ``hem advise`` can be trusted: what it predicts, held against what programs then take.

``python -m experiments.validation.advice`` measures queries, operations and building on this
machine, and then programs that no price was made of: the algorithms, breaking a surface, mixes
drawn at random, on families and real models. What a program does is recorded on a small torus and
one structure; its own part comes from timing it there, on one of two meshes. Every other structure,
and every other mesh, is predicted. Takes an hour of a machine's whole attention; ten minutes of it
where a ``run`` has measured the prices.
"""

import json
import os
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import typer

import hem
import structures
from experiments.advice import ALIKE, Measured, Prices, Workload, best, predict, recorded
from experiments.bench_workloads import WORKLOADS, impacts
from experiments.harness import IRREGULAR, calibration_loop, took
from experiments.runs import describe, load, study
from hem import algorithms
from hem.contract import QUERIES, Structure

RESULT = Path("results/reference/advice.json")
NEEDED = ("bench_queries", "bench_operations", "bench_build")
PRESET = "standard"

RECORDED, TIMED = "torus:400", {"": "torus:5000", IRREGULAR: f"{IRREGULAR}:5000"}
"""The mesh that programs are recorded on; and those that they are timed on to learn their own part,
by the family of the prices: one is as regular as the mesh that is predicted."""
ON = ("torus:20000", "sphere:5000", "terrain:5000", "cow", "bunny")  # the meshes that are predicted
ROUNDS, FEWEST = 15, 6
TURN = 0.005
"""Seconds that a structure's turn takes at least: whoever comes after one that searched for long
finds the caches and the guesses of branches another's, and took up to twice as long."""
LONGEST = 1.0  # seconds that a program may take; after so many in all it has its fewest rounds

MIXES, STEPS, BATCH, SPLITS = 6, 20, (500, 3_000), 100
"""How many random mixes there are, and their batches: how many, of how many, and of splits."""

ASKED, HITS = 1_000, 1_000

COMPILED = {name: it for name, it in structures.REGISTRY.items() if it.compiled}
BASE = next(name for name, it in COMPILED.items() if not (it.searches or it.rebuilds))
"""What programs are recorded and timed on."""


class Program(NamedTuple):
    """What is done to a mesh; ``each``: in proportion to what it takes."""

    run: Callable[[Structure], Any]
    each: str = "vertex"


def _mix(seed: int) -> Callable[[Structure], None]:
    """Batches of queries at random or in order, some with splits, as drawn by the seed."""

    def run(s: Structure) -> None:
        rng = np.random.default_rng(seed)
        names = rng.choice(list(QUERIES), 3, replace=False)
        for step in range(STEPS):
            query, count = QUERIES[str(rng.choice(names))], int(rng.integers(*BATCH))
            first, n = int(rng.integers(s.n_vertices)), s.n_vertices
            some = (first + np.arange(count)) % n if step % 2 else rng.integers(n, size=count)
            asked = s.face_edges(some).values[::3] if query.source == "edge" else some
            getattr(s, query.name)(asked)
            if seed % 2 and step % 5 == 0:
                s.split_faces(rng.choice(n, SPLITS, replace=False), np.zeros((SPLITS, 3)))

    return run


def _asking(s: Structure) -> None:
    """What a plug-in does: one question after the other, from Python."""
    for v in np.random.default_rng(2).integers(0, s.n_vertices, ASKED).tolist():
        for f in s.vertex_faces(v).tolist():
            s.face_vertices(f)
        s.vertex_vertices(v)


def _hit(s: Structure, count: int) -> list[int]:
    """Faces at random, as many on every structure."""
    faces: list[int] = np.random.default_rng(1).integers(0, s.n_faces, count).tolist()
    return faces


PROGRAMS = {
    "vertex normals": Program(algorithms.vertex_normals),
    "smoothing": Program(algorithms.smooth),
    "split all faces": Program(lambda s: s.split_all_faces()),
    "loop subdivision": Program(lambda s: algorithms.subdivide(s, "loop")),
    "sqrt3 subdivision": Program(lambda s: algorithms.subdivide(s, "sqrt3")),
    "simplify": Program(lambda s: algorithms.simplify(s, vertices=s.n_vertices // 4)),
    "remesh": Program(lambda s: algorithms.remesh(s, iterations=1)),
    "impacts": Program(lambda s: algorithms.impacts(s, _hit(s, HITS)), ""),
    "circulate": Program(algorithms.circulate),
    "split and collapse": Program(algorithms.split_and_collapse),
    "shatter": Program(lambda s: hem.fracture.shatter(s, s.points[s.vertices()[0]]), ""),
    "asking from Python": Program(_asking, ""),
    **{
        f"{name} from Python": Program(it.from_python)
        for name, it in WORKLOADS.items()
        if name != "impacts"  # of which structures that search are given fewer
    },
    "impacts from Python": Program(lambda s: impacts(s, _hit(s, HITS // 10)), ""),
    **{f"mix {seed}": Program(_mix(seed), "") for seed in range(MIXES)},
}


@cache
def learned(prices: Prices, name: str) -> Workload:
    """What a program does, and its own part: from one structure on a mesh as that of the prices."""
    program, mesh = PROGRAMS[name], hem.find_mesh(TIMED[prices.family])
    s = structures.build(BASE, hem.find_mesh(RECORDED))
    with hem.record(s) as recording:
        program.run(s)
    known = Measured(BASE, len(mesh.points), timed(prices, program, [BASE], mesh)[BASE])
    return replace(recorded(recording, name, program.each), measured=known)


def timed(prices: Prices, program: Program, names: Iterable[str], mesh: Any) -> dict[str, float]:
    """Seconds of the processor by structure, the least of some rounds on copies.

    The structures take turns, so that what slows the machine slows them all; what is short runs
    again and again in its turn. Times are those at the speed that the machine had when the prices
    were measured.
    """
    held = {}
    for name in names:
        program.run(structures.build(name, hem.find_mesh(RECORDED)))  # compiles
        held[name] = structures.build(name, mesh)
        held[name].scratch(0)  # counts the edges, once per mesh
    least, spent = dict.fromkeys(held, np.inf), dict.fromkeys(held, 0.0)
    for k in range(ROUNDS):
        for name, s in held.items():
            if k < FEWEST or spent[name] < LONGEST:
                before, turn = calibration_loop(), list[float]()
                while sum(turn) < TURN:
                    copy = s.copy()
                    if s.rebuilds:
                        copy.vertex_faces(0)
                    turn.append(took(program.run, copy, clock=process_time)[1])
                loop = (before + calibration_loop()) / 2
                spent[name] += sum(turn)
                least[name] = min(least[name], min(turn) * (prices.step / loop))
    return least


def compare(prices: Prices, name: str, mesh_name: str) -> dict[str, Any]:
    """Predict a program on a mesh for every structure, then run it on all that are not hopeless."""
    mesh = hem.find_mesh(mesh_name, triangulate=True)
    faces, prices = len(mesh.triangles), prices.like(mesh.triangles)
    workload = learned(prices, name)
    told = [predict(prices, workload, structure, faces) for structure in COMPILED]
    counted = replace(workload, measured=None)
    untimed = {it: predict(prices, counted, it, faces).seconds for it in COMPILED}
    hopeful = [it.structure for it in told if it.seconds < LONGEST]
    taken = timed(prices, PROGRAMS[name], hopeful, mesh)
    rows = []
    for it in told:
        row = {"structure": it.structure, "low": it.low, "high": it.high, "predicted": it.seconds}
        rows.append({**row, "counted": untimed[it.structure], "taken": taken.get(it.structure)})
    return {"program": name, "mesh": mesh_name, "faces": faces, "structures": rows}


def figures(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """How far off the predictions were; what they learned from is not among them."""
    every = ([it for it in row["structures"] if it["taken"]] for row in rows)
    ran = [some for some in every if some]
    told = [it for some in ran for it in some if it["structure"] != BASE]
    errors, counted = (
        np.array([abs(it[by] / it["taken"] - 1) for it in told]) for by in ("predicted", "counted")
    )
    return {
        "workloads": len(rows),
        "predictions": len(told),
        "median_error": float(np.median(errors)),
        "median_error_counted": float(np.median(counted)),
        "within_30_percent": float(np.mean(errors <= 0.3)),
        "within_interval": float(np.mean([it["low"] <= it["taken"] <= it["high"] for it in told])),
        "winner_right": float(np.mean([_is_alike(it, "predicted", "taken", BASE) for it in ran])),
        "winner_right_counted": float(np.mean([_is_alike(it, "counted", "taken") for it in ran])),
        "best_among_alike": float(np.mean([_is_alike(it, "taken", "predicted") for it in ran])),
    }


def _is_alike(ran: list[dict[str, Any]], best_by: str, by: str, held: str = "") -> bool:
    """Whether the best by one figure is alike the best by the other; what did not run is not."""
    chosen = best({it["structure"]: it[best_by] for it in ran}, held)
    costs = {it["structure"]: it[by] for it in ran}
    return bool(costs[chosen] <= ALIKE * min(costs.values()))


def table(kept: dict[str, Any]) -> pd.DataFrame:
    """A row per program: how far off its predictions were, and whether the best was told."""
    rows = []
    for name in dict.fromkeys(row["program"] for row in kept["rows"]):
        mine = [row for row in kept["rows"] if row["program"] == name]
        found = figures(mine)
        title, on = name[0].upper() + name[1:].replace("_", " "), (row["mesh"] for row in mine)
        shares = (f"{found[key]:.0%}" for key in ("median_error", "within_interval"))
        told = f"{found['winner_right'] * len(mine):.0f} of {len(mine)}"
        rows.append((title, ", ".join(on), *shares, told))
    heads = "Program", "on", "off by, median", "within the interval", "best structure told"
    return pd.DataFrame(rows, columns=heads)


def in_words(kept: dict[str, Any]) -> str:
    """Say what was kept in a sentence."""
    return (
        "Of {workloads} workloads, {predictions} predictions: off by {median_error:.0%} in the "
        "median, and by {median_error_counted:.0%} where the program was only counted and never "
        "timed; {within_30_percent:.0%} within 30 %, {within_interval:.0%} within the interval, "
        "whose width an earlier run of them chose; "
        "the best structure was told in {winner_right:.0%} (the one that programs were timed on, "
        "where none is predicted to be a tenth quicker), in {winner_right_counted:.0%} by counts "
        "alone, as where no whole program was timed, and in {best_among_alike:.0%} it was "
        "among those that are predicted to be within a tenth of the best. Meanwhile the load of "
        "the machine was {load:.1f}.".format(**kept)
    )


def main(output: Path = RESULT, run: Path | None = None, program: list[str] | None = None) -> None:
    """Measure, predict, compare, keep: ``program`` alone, by the prices of ``run`` where given."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})  # prices are those of one core
    kept = {key: value for key, value in describe(PRESET).items() if key != "schema"}
    with tempfile.TemporaryDirectory(prefix="hem-advice-") as root:
        folder = run or study.begin(PRESET, Path(root), list(COMPILED), NEEDED)
        if run is None:
            study.run(folder)
        prices = Prices(load(folder))
        rows = []
        names = list(program or PROGRAMS)  # every one on two of the meshes, in turn
        pairs = [(name, ON[(k + n) % len(ON)]) for k, name in enumerate(names) for n in (0, 2)]
        for name, mesh in pairs:
            rows.append(compare(prices, name, mesh))
            ran = [it for it in rows[-1]["structures"] if it["taken"]]
            ratios = {it["structure"]: round(it["predicted"] / it["taken"], 2) for it in ran}
            print(name, mesh, ratios, flush=True)
    kept |= {"load": os.getloadavg()[0]}
    kept |= {"prices": str(prices.run.folder.name), "finished": prices.run.meta.get("finished")}
    kept |= {"learned_from": BASE, **figures(rows), "rows": rows}
    output.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    print(in_words(kept))


if __name__ == "__main__":
    typer.run(main)
