"""Runs made up for tests: costs that follow a law everybody knows."""

from __future__ import annotations

from collections.abc import Callable
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
    files = {}
    for claim in load_claims():
        if isinstance(claim.expects, Exactly):
            for size in (4, 8):
                case = _memory(claim.expects.value, size)
                _add(files, folder, "bench_memory", claim.structure, case)
            continue
        chosen = law_of and law_of(claim.structure, claim.subject, claim.printed)
        law = chosen or LAWS[claim.printed]
        for experiment, order, variable in experiments_of(claim.table):
            points = (
                [(n, 6) for n in SIZES] if variable == "faces" else [(FACES, k) for k in VALENCES]
            )
            for n_t, n_ev in points:
                kind = "work" if experiment.endswith("work") or order == "counted" else "time"
                noise = 1 if kind == "work" else 1e-9 * rng.normal(1, 0.02, 9)
                case = Measurement(
                    id=f"{claim.subject}/{n_t}/{n_ev}/{order}", kind=kind, subject=claim.subject,
                    order=order, family=HUBS if variable == "valence" else "torus", faces=n_t,
                    vertices=n_t // 2, valence=n_ev if variable == "valence" else None,
                    working_set=60 * n_t, latency=2e-9, noise=STEADY if kind == "time" else {},
                    calibration=[1e-9] * 9 if kind == "time" else [],
                    samples=np.atleast_1d(law(n_t, n_ev) * noise).tolist(),
                )  # fmt: skip
                _add(files, folder, experiment, claim.structure, case)
    for structure in NAMES:
        _add_times(files, folder, structure)
    for (experiment, structure), cases in files.items():
        if only(experiment, structure):
            CaseFile(folder, experiment, structure).add(*(Measurement(**case) for case in cases))
    return folder


def _add_times(files: dict, folder: Path, structure: str) -> None:
    """Building, the workloads, and the ways to keep a render mesh in step."""
    slow = structure == "indexed"
    orders = ("in a transaction", "rendered", "one by one", "render mesh built anew")
    for n_t in SIZES:
        about = {"kind": "time", "family": "torus", "faces": n_t, "vertices": n_t // 2}
        every = [
            ("bench_build", None, order, BUILD.get(structure, BUILD["half_edge"]) * n_t)
            for order in (*ORDERS, ANSWERING)
        ]
        every += [
            (
                "bench_workloads",
                name,
                order,
                1e-6 * (n_t if slow and it.scans[order == FROM_PYTHON] else 1),
            )
            for name, it in WORKLOADS.items()
            for order in (COMPILED, FROM_PYTHON)
        ]
        every += [
            ("bench_operations", "split_face", order, 1e-6 * (k + 1) * (n_t if k == 3 else 1))
            for k, order in enumerate(orders)
        ]
        every += [("bench_fracture", "shatter", None, 1e-6 * (n_t if slow else 1))]
        every += [("bench_fracture", "find_face", it, 1e-8 * n_t**k) for it, k in FINDING.items()]
        every += [
            ("bench_picking", NEIGHBORS, it, 1e-6 * (n_t if slow else 3))
            for it in (COMPILED, FROM_PYTHON)
        ]
        for how in (REBUILT, REFITTED) if slow else ():
            every += [
                ("bench_picking", it, how, 1e-6 * k) for it, k in ((RAY, 4), (FOLLOWING, n_t))
            ]
        for experiment, what, order, seconds in every:
            case = Measurement(
                id=f"{what}/{n_t}/{order}", subject=what, order=order, samples=[seconds], handles=1,
                latency=2e-9, **about,
            )  # fmt: skip
            _add(files, folder, experiment, structure, case)
        _add_edits(files, folder, structure, n_t, about)


def _add_edits(files: dict, folder: Path, structure: str, n_t: int, about: dict) -> None:
    """Single edits, and what of the faces is looked at to find one."""
    for subject, order in ((EDITS, RESERVED), (EDITS, GROWING), (COMPACT, None)):
        edits = Measurement(
            id=f"{subject}/{n_t}/{order}", subject=subject, order=order,
            samples=[4e-3, *20 * [2e-5]], detail={"uploads": [12 * n_t, *20 * [84]]}, **about,
        )  # fmt: skip
        _add(files, folder, "bench_real_time", structure, edits)
    for way, power in FINDING.items():
        order = f"{way}, faces looked at"
        counted = {**about, "kind": "work", "samples": [float(round(n_t**power))]}
        case = Measurement(id=f"{order}/{n_t}", subject="find_face", order=order, **counted)
        _add(files, folder, "bench_fracture", structure, case)


def _memory(bytes_per_vertex: float | None, reference_bytes: int) -> Measurement:
    size = 1000 * int(bytes_per_vertex or 150) * reference_bytes // 8
    fields = {"vertex.point": size}
    detail = {"fields": fields, "clr": fields, "traced": size, "peak": size}
    return Measurement(
        id=f"torus/1000/{reference_bytes}", kind="bytes", family="torus", vertices=1000, faces=2000,
        reference_bytes=reference_bytes, samples=[float(size)], detail=detail,
    )  # fmt: skip


def _add(files: dict, folder: Path, experiment: str, structure: str, case: Measurement) -> None:
    files.setdefault((experiment, structure), []).append(case.__dict__)


def rewrite(folder: Path, experiment: str, structure: str, changed: Callable) -> None:
    """Replace fields of measurements in a run: what ``changed(measurement)`` says."""
    file = CaseFile(folder, experiment, structure)
    file.path.unlink()
    CaseFile(folder, experiment, structure).add(
        *(replace(it, **changed(it)) for it in file.measurements)
    )
