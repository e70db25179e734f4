"""What is exact and the same on every machine, measured on small meshes within seconds.

Work of the queries, the operations and the listings; bytes by field, in arrays, kept after every
query was asked, and allocated while a mesh grows; and the classes that the work shows. No time is
taken. `hem check` compares all of it with what is committed.
"""

from __future__ import annotations

import platform
import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import tracemalloc_domain

import structures
from experiments.claims.growth import Claim, load_claims
from experiments.harness import PRESETS, Case, Experiment, Measurement, time_rounds
from experiments.runs.catalog import experiments
from experiments.runs.results import Run
from hem.contract import QUERIES, REFERENCE_TYPES, Structure

Value = list[int] | str
"""Counts, one per handle or field; or a growth class and what it says of the claim."""

EXTENT = replace(
    PRESETS["quick"],
    what="all that is exact, on small meshes",
    work_sizes=(100, 200, 400, 800),  # the fewest that a class can be judged from
    valences=(4, 8, 16, 32),
    work_faces=1024,
    printed_sizes=(50, 100),
)

WEIGHED = 1_000
"""Vertices of the mesh whose bytes are counted."""

GROWING = 100
"""Vertices of the mesh that is made to grow."""

SPLITS = 500
"""How often one of its faces is split."""


@dataclass
class Exact:
    """Values by key, such as ``work/half_edge/vertex_faces/torus/100/random``.

    ``python``: the version whose objects were weighed. ``failed``: what could not be measured, by
    key, and why.
    """

    cases: dict[str, Value] = field(default_factory=dict)
    failed: dict[str, str] = field(default_factory=dict)
    python: str = ".".join(platform.python_version_tuple()[:2])


def measure(chosen: Sequence[str] = ()) -> Exact:
    """Measure all that is exact, of these structures or of all: some ten seconds.

    What raises is not measured, and the reason kept: whoever compares must not pass it over.
    """
    found, rows = Exact(), []
    for experiment in experiments().values():
        for name in _wanted(experiment.structures, chosen):
            for case in experiment.cases(EXTENT.of(name), name):
                if experiment.table is not None and experiment.kind_of(case) == "work":
                    rows += _counted(found, experiment, case)
    for name in _wanted(structures.NAMES, chosen):
        _try(found, f"bytes/{name}", partial(_bytes, name))
        if structures.REGISTRY[name].compiled:
            _try(found, f"bytes/{name}/growing", partial(_growing, name))
    found.cases |= _classes(rows, chosen)
    return found


def _wanted(names: Sequence[str], chosen: Sequence[str]) -> list[str]:
    return [name for name in names if not chosen or name in chosen]


def _counted(found: Exact, experiment: Experiment, case: Case) -> list[dict[str, Any]]:
    """Count one case -> its row as in a run, or none if it failed."""
    table = "listing/" if experiment.name == "bench_printed" else ""
    key, kept = f"work/{case.structure}/{table}{case.id}", list[Measurement]()

    def counted() -> dict[str, Value]:
        kept.append(experiment.measure(case, EXTENT, time_rounds))
        return {key: [int(it) for it in kept[0].samples]}

    _try(found, key, counted)
    return [
        {"experiment": experiment.name, "structure": case.structure, **asdict(it)} for it in kept
    ]


def _try(found: Exact, key: str, measured: Callable[[], dict[str, Value]]) -> None:
    try:
        found.cases |= measured()
    except Exception as error:  # whatever a broken structure does is a finding, not an end
        found.failed[key] = f"{type(error).__name__}: {error}".splitlines()[0]


def _bytes(name: str) -> dict[str, Value]:
    """Bytes per field by the model, and what the arrays really take, once built and once asked."""
    case = Case(name, EXTENT.families[0], WEIGHED)
    mesh, head = case.mesh(), f"bytes/{name}/{case.family}/{WEIGHED}"
    found: dict[str, Value] = {}
    for reference_bytes in REFERENCE_TYPES:
        build = partial(structures.build, name, mesh, reference_bytes)
        build()  # compiles, unweighed
        s, built = _weighed(build)
        of = f"{head}/{reference_bytes}-byte references"
        found |= {f"{of}/{part}": [size] for part, size in s.memory().items()}
        found[f"{of}/arrays once built"] = [built]
    _asked(structures.build(name, mesh))
    _, asked = _weighed(lambda: _asked(structures.build(name, mesh)))
    return found | {f"{head}/arrays once asked": [asked]}


def _asked(s: Structure) -> Structure:
    """Ask every query once: what it keeps for the next time shows then."""
    for name, query in QUERIES.items():
        ask: Any = getattr(s, name)
        ask(s.handles(query.source)[:3])
    return s


def _weighed(make: Callable[[], Structure]) -> tuple[Structure, int]:
    """Make something -> it, and the bytes of all arrays that were made and are still there.

    NumPy tells tracemalloc of every array, wherever it hides; Python's own objects, which take
    other sizes in other versions, are left out.
    """
    tracemalloc.start()
    try:
        before = _in_arrays()
        made = make()
        return made, _in_arrays() - before
    finally:
        tracemalloc.stop()


def _in_arrays() -> int:
    only = tracemalloc.DomainFilter(inclusive=True, domain=tracemalloc_domain)
    snapshot = tracemalloc.take_snapshot().filter_traces([only])
    return sum(trace.size for trace in snapshot.traces)


def _growing(name: str) -> dict[str, Value]:
    """Bytes of the arrays each time they are made anew while faces are split one by one."""
    case = Case(name, EXTENT.families[0], GROWING)
    s = structures.build(name, case.mesh())
    sizes = [_size(s)]
    for face in range(SPLITS):
        s.split_face(face, (0.0, 0.0, 0.0))
        if _size(s) != sizes[-1]:
            sizes.append(_size(s))
    s.validate()
    key = f"bytes/{name}/{case.family}/{GROWING}/arrays while {SPLITS} faces are split"
    return {key: list[int](sizes)}


def _size(s: Structure) -> int:
    return sum(array.nbytes for array in s.arrays)


def _classes(rows: list[dict[str, Any]], chosen: Sequence[str]) -> dict[str, Value]:
    """The class that work shows for each claim, in each variable: what it is, not how much."""
    import pandas as pd

    from experiments.claims.judged import SOURCES, Evidence

    cases = pd.DataFrame(rows)
    if cases.empty:
        return {}
    cases["samples"] = cases["samples"].map(lambda it: np.asarray(it, float))
    evidence = Evidence(Run(Path(), {}, cases, cases[:0]))
    return {
        f"class/{claim.structure}/{claim.subject}/{variable}": named(
            verdict.best, verdict.outcome if variable in claim.expected else "no claim"
        )
        for claim in _claims(chosen)
        for measure, variable in SOURCES
        if measure == "work"
        for verdict in [evidence.verdict(claim, measure, variable)]
        if verdict
    }


def named(best: str, outcome: str) -> str:
    """A class and what became of the claim, as one text: ``O(n), consistent``."""
    return f"{best}, {outcome}"


def _claims(chosen: Sequence[str]) -> Iterator[Claim]:
    for claim in load_claims():
        if claim.table != "listings" and (not chosen or claim.structure in chosen):
            yield claim
