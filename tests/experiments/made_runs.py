"""Runs made up for tests: costs that follow a law everybody knows."""

from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from experiments.bench_picking import FOLLOWING, NEIGHBORS, RAY, REBUILT, REFITTED
from experiments.bench_real_time import COMPACT, EDITS, GROWING, RESERVED
from experiments.bench_workloads import COMPILED, FROM_PYTHON, WORKLOADS
from experiments.claims import Exactly, load_claims
from experiments.harness import ANSWERING, HUBS, Measurement
from experiments.runs import CaseFile, describe, experiments, write_meta
from structures import NAMES, REGISTRY, THESIS

ORDERS = ("consecutive", "random")

SIZES = [200, 630, 2000, 6324, 20000, 63246, 200000]
VALENCES = [2**k for k in range(2, 13)]
FACES = 131_072

STEADY = {"fastest": 1e-4, "before": 1e-4, "after": 1e-4, "off_cpu": 0.0}
"""What a machine that does nothing else shows."""

Law = Callable[[int, int], float]
LAWS: dict[str, Law] = {
    "O(1)": lambda n_t, n_ev: 5.0,
    "O(n_ev)": lambda n_t, n_ev: 2.0 + 3.0 * n_ev,
    "O(n_t)": lambda n_t, n_ev: 10.0 + 3.0 * n_t,
    "O(n_t²)": lambda n_t, n_ev: 3.0 + 2e-3 * n_t**2,
    "N/A": lambda n_t, n_ev: 7.0,
    "–": lambda n_t, n_ev: 7.0,
}


def experiments_of(table: str) -> list[tuple[str, str, str]]:
    """The experiment, the order of its cases and what varies in them, for a table's claims."""
    return [
        (name, order, axis.variable)
        for name, it in experiments().items()
        if it.table is not None and it.table.name == table
        for axis, order in it.axes.items()
    ]


LIKE_THE_THESIS = [it for it in NAMES if it not in THESIS and REGISTRY[it].claims.like]
"""Structures of which the same is claimed as of one of the thesis."""

FINDING = {"walk": 1 / 2, "jump and walk": 1 / 3, "scan": 1}
"""The ways to find a face, and the power of n_t that they take in these runs."""

BUILD = {
    **{"indexed": 1e-9, "triangle_neighbor": 21e-9, "winged_edge": 41e-9, "half_edge": 31e-9},
    **{"half_edge_objects": 4e-6, "plankton": 36e-9},
}
"""Seconds per face to build, in these runs."""


def write_run(
    folder: Path,
    law_of: Callable[[str, str, str], Law] | None = None,
    only: Callable[[str, str], bool] = lambda experiment, structure: True,
) -> Path:
    """A finished run in which every claim holds, unless ``law_of(structure, query, printed)``.

    ``only``: the experiments on structures that the run has.
    """
    rng = np.random.default_rng(3)
    write_meta(folder, {**describe("quick"), "finished": "2026-01-01T00:00:00Z"})
    files: dict[tuple[str, str], list[Measurement]] = defaultdict(list)
    for claim in load_claims():
        if isinstance(claim.expects, Exactly):
            weighed = [_memory(claim.expects.value, size) for size in (4, 8)]
            files["bench_memory", claim.structure] += weighed
            continue
        chosen = law_of and law_of(claim.structure, claim.subject, claim.printed)
        law = chosen or LAWS[claim.printed]
        for experiment, order, variable in experiments_of(claim.table):
            by_size, counted = (
                variable == "faces",
                experiment.endswith("work") or order == "counted",
            )
            points = [(n, 6) for n in SIZES] if by_size else [(FACES, k) for k in VALENCES]
            for n_t, n_ev in points:
                noise = 1 if counted else 1e-9 * rng.normal(1, 0.02, 9)
                case = Measurement(
                    id=f"{claim.subject}/{n_t}/{n_ev}/{order}", kind="work" if counted else "time",
                    subject=claim.subject, order=order, family="torus" if by_size else HUBS,
                    faces=n_t, vertices=n_t // 2, valence=None if by_size else n_ev,
                    working_set=60 * n_t, latency=2e-9, noise={} if counted else STEADY,
                    calibration=[] if counted else [1e-9] * 9,
                    samples=np.atleast_1d(law(n_t, n_ev) * noise).tolist(),
                )  # fmt: skip
                files[experiment, claim.structure].append(case)
    for structure in NAMES:
        for experiment, case in _times(structure):
            files[experiment, structure].append(case)
    for (experiment, structure), cases in files.items():
        if only(experiment, structure):
            CaseFile(folder, experiment, structure).add(*cases)
    return folder


def _times(structure: str) -> Iterator[tuple[str, Measurement]]:
    """Building, the workloads, and the ways to keep a render mesh in step."""
    slow, per_face = structure == "indexed", BUILD.get(structure, BUILD["half_edge"])
    rendered = "in a transaction", "rendered", "one by one", "render mesh built anew"
    ways = COMPILED, FROM_PYTHON
    for n_t in SIZES:
        about = {"kind": "time", "family": "torus", "faces": n_t, "vertices": n_t // 2}
        scan = n_t if slow else 1
        every = [("bench_build", None, it, per_face * n_t) for it in (*ORDERS, ANSWERING)]
        every += [
            ("bench_workloads", name, way, 1e-6 * (scan if it.scans[way == FROM_PYTHON] else 1))
            for name, it in WORKLOADS.items()
            for way in ways
        ]
        every += [
            ("bench_operations", "split_face", order, 1e-6 * (k + 1) * (n_t if k == 3 else 1))
            for k, order in enumerate(rendered)
        ]
        every += [("bench_fracture", "shatter", None, 1e-6 * scan)]
        every += [("bench_fracture", "find_face", it, 1e-8 * n_t**k) for it, k in FINDING.items()]
        every += [("bench_picking", NEIGHBORS, it, 1e-6 * (n_t if slow else 3)) for it in ways]
        for how in (REBUILT, REFITTED) if slow else ():
            every += [
                ("bench_picking", RAY, how, 4e-6),
                ("bench_picking", FOLLOWING, how, 1e-6 * n_t),
            ]
        for experiment, what, order, seconds in every:
            yield experiment, Measurement(
                id=f"{what}/{n_t}/{order}", subject=what, order=order, samples=[seconds], handles=1,
                latency=2e-9, **about,
            )  # fmt: skip
        yield from _edits(n_t, about)


def _edits(n_t: int, about: dict) -> Iterator[tuple[str, Measurement]]:
    """Single edits, and what of the faces is looked at to find one."""
    for subject, order in ((EDITS, RESERVED), (EDITS, GROWING), (COMPACT, None)):
        yield "bench_real_time", Measurement(
            id=f"{subject}/{n_t}/{order}", subject=subject, order=order,
            samples=[4e-3, *20 * [2e-5]], detail={"uploads": [12 * n_t, *20 * [84]]}, **about,
        )  # fmt: skip
    for way, power in FINDING.items():
        order = f"{way}, faces looked at"
        counted = {**about, "kind": "work", "samples": [float(round(n_t**power))]}
        yield (
            "bench_fracture",
            Measurement(id=f"{order}/{n_t}", subject="find_face", order=order, **counted),
        )


def _memory(bytes_per_vertex: float | None, reference_bytes: int) -> Measurement:
    size = 1000 * int(bytes_per_vertex or 150) * reference_bytes // 8
    fields = {"vertex.point": size}
    detail = {"fields": fields, "clr": fields, "traced": size, "peak": size}
    return Measurement(
        id=f"torus/1000/{reference_bytes}", kind="bytes", family="torus", vertices=1000, faces=2000,
        reference_bytes=reference_bytes, samples=[float(size)], detail=detail,
    )  # fmt: skip


def rewrite(folder: Path, experiment: str, structure: str, changed: Callable) -> None:
    """Replace fields of measurements in a run: what ``changed(measurement)`` says."""
    file = CaseFile(folder, experiment, structure)
    file.path.unlink()
    new = [replace(it, **changed(it)) for it in file.measurements]
    CaseFile(folder, experiment, structure).add(*new)
