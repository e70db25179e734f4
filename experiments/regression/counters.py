"""Deterministic counters: the same on every machine, measured on small meshes within seconds.

Memory accesses of the queries, the operations and the listings; bytes by field, in arrays, kept
after every query was asked, and allocated while a mesh grows; and the classes that the accesses
show. No time is taken.
"""

import tracemalloc
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from numpy.lib import tracemalloc_domain

import structures
from experiments.harness import PRESETS, Case, Experiment, Measurement, time_rounds
from experiments.regression.baseline import COUNTERS, Measured
from experiments.regression.snapshots import class_figures
from experiments.runs import Run, describe, experiments
from hem.contract import QUERIES, REFERENCE_TYPES, Structure
from hem.room import behind, give_back

EXTENT = replace(
    PRESETS["quick"],
    what="deterministic counters, on small meshes",
    work_sizes=(100, 200, 400, 800),  # the fewest that a class can be judged from
    valences=(4, 8, 16, 32),
    work_faces=1024,
    operations=(),
    printed_sizes=(50, 100),
)

BYTES = "bytes"  # what stands for an experiment where bytes are counted here
WEIGHED, GROWING = 1_000, 100  # vertices of the mesh that is weighed, and of that which grows
SPLITS = 500  # how often one of its faces is split
Task = tuple[str, str, Measurement, Callable[[], Iterable[Measurement]]]
"""An experiment, a structure, what is kept if nothing can be measured, and how it is."""


def measure_counters(chosen: Collection[str] = ()) -> Measured:
    """Measure all counters, some ten seconds; what raises is skipped with the reason, not lost."""
    found = []
    for experiment, structure, failed, measure in _tasks(chosen):
        try:
            measured = list(measure())
        except Exception as error:  # whatever a broken structure does is a finding, not an end
            reason = f"{type(error).__name__}: {error}".splitlines()[0]
            measured = [replace(failed, skipped=reason)]
        found += [(experiment, structure, "", it) for it in measured]
    run = Run.of(Path(COUNTERS), describe(COUNTERS), found)
    return Measured(run, class_figures(run))


def _tasks(chosen: Collection[str]) -> Iterator[Task]:
    for it in experiments().values():
        for name in it.structures if it.table else ():
            for case in it.cases(EXTENT.of(name), name) if not chosen or name in chosen else ():
                if it.kind_of(case.order) == "work":
                    yield it.name, name, case.not_measured("work", ""), partial(_work, it, case)
    for name in structures.NAMES:
        if not chosen or name in chosen:
            for measure in (_bytes, _growing) if structures.REGISTRY[name].compiled else (_bytes,):
                failed = Measurement(measure.__name__.strip("_"), "bytes")
                yield BYTES, name, failed, partial(measure, name)


def _work(experiment: Experiment, case: Case) -> Iterator[Measurement]:
    yield experiment.measure(case, EXTENT, time_rounds)


def _bytes(name: str) -> Iterator[Measurement]:
    """Bytes per field by the model, and what the arrays really take, once built and once asked."""
    case = Case(name, EXTENT.families[0], WEIGHED)
    mesh = case.mesh()
    for reference_bytes in REFERENCE_TYPES:
        build = partial(structures.build, name, mesh, reference_bytes)
        build()  # compiles, unweighed
        s, built = _weigh(build)
        for part, size in {**s.memory(), "arrays once built": built}.items():
            yield _weighed(case, part, [size], reference_bytes)
    _ask(structures.build(name, mesh))
    _, asked = _weigh(lambda: _ask(structures.build(name, mesh)))
    yield _weighed(case, "arrays once asked", [asked])


def _growing(name: str) -> Iterator[Measurement]:
    """Bytes of the arrays each time they are made anew while faces are split one by one."""
    case = Case(name, EXTENT.families[0], GROWING)
    s = structures.build(name, case.mesh())
    sizes: list[int] = []
    for face in range(SPLITS + 1):
        size = sum(array.nbytes for array in s.arrays)
        if size not in sizes[-1:]:
            sizes.append(size)
        if face < SPLITS:
            s.split_face(face, (0.0, 0.0, 0.0))
    s.validate()
    yield _weighed(case, f"arrays while {SPLITS} faces are split", sizes)


def _weighed(case: Case, part: str, sizes: list[int], reference_bytes: int = 0) -> Measurement:
    references = [f"{reference_bytes}-byte references"] if reference_bytes else []
    return Measurement(
        "/".join([case.family, str(case.size), *references, part]), "bytes",
        subject=part, family=case.family, faces=len(case.mesh().triangles),
        reference_bytes=reference_bytes, samples=list(map(float, sizes)),
    )  # fmt: skip


def _ask(s: Structure) -> Structure:
    """Ask every query once: what it keeps for the next time shows then."""
    for name, query in QUERIES.items():
        ask: Any = getattr(s, name)
        ask(s.handles(query.source)[:3])
    return s


def _weigh(make: Callable[[], Structure]) -> tuple[Structure, int]:
    """Make something -> it, and the bytes of arrays still there, without unwritten addresses."""
    # NumPy tells of every array, wherever it hides; other objects differ between versions.
    of_arrays = tracemalloc.DomainFilter(inclusive=True, domain=tracemalloc_domain)
    give_back()  # memory that is used again would not be traced
    tracemalloc.start()
    try:
        made = make()
        give_back()  # what is kept for later is nobody's
        traces = tracemalloc.take_snapshot().filter_traces([of_arrays]).traces
        return made, sum(trace.size for trace in traces) - behind(*made.arrays)
    finally:
        tracemalloc.stop()
