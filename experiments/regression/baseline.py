"""The baseline: committed measurements that others are held against, in ``results/reference/``.

Two reduced runs in the run's own format: the counters, and ``run``, of a whole run what can be
compared. Beside the cases of each, ``claims.jsonl`` holds what they said of every claim when they
were measured, a line per claim.

Counters are deterministic, the same on every machine, and measured on small meshes within seconds:
memory accesses of the queries, the operations and the listings; bytes by field, in arrays, kept
after every query was asked, and allocated while a mesh grows; and the classes that the accesses
show. No time is taken.
"""

import json
import shutil
import tracemalloc
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import astuple, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, Self

import numpy as np
import pandas as pd
from numpy.lib import tracemalloc_domain

import structures
from experiments.harness import PRESETS, Case, Experiment, Measurement, time_rounds
from experiments.regression.snapshots import Figures, claim_figures, class_figures
from experiments.runs import (
    CaseFile,
    ResultsError,
    Run,
    describe,
    experiments,
    load,
    noise,
    write_meta,
)
from hem.contract import QUERIES, REFERENCE_TYPES, Structure
from hem.room import behind
from hem.whole_files import write_whole

FOLDER = Path("results/reference")
COUNTERS, RUN = "counters", "run"
CLAIMS = "claims.jsonl"
UPDATE = {COUNTERS: "hem baseline update", RUN: "hem baseline update RUN"}

HEAD = (
    *("schema", "preset", "structures", "commit", "dirty", "machine", "versions"),
    *("started", "finished", "run", "too_busy"),
)
"""What is kept of the head of a run."""
KEPT = (
    *("id", "kind", "subject", "order", "family", "vertices", "faces", "valence"),
    *("working_set", "latency", "reference"),
)
"""What is kept of a case besides its samples and the calibration loop's readings."""
LEAST_ROUNDS = 9  # rounds on either side with which a comparison of times can decide at all


@dataclass(frozen=True)
class Measured:
    """A run, and what it said of every claim."""

    run: Run
    claims: dict[str, Figures]

    def only(self, structures: list[str]) -> Self:
        """What is of these structures."""
        run = self.run
        parts = (rows[rows["structure"].isin(structures)] for rows in (run.cases, run.skipped))
        claims = {name: it for name, it in self.claims.items() if name.split("/")[1] in structures}
        return type(self)(Run(run.folder, run.meta, *parts), claims)


def reduce_run(run: Run) -> Measured:
    """What of a run can be compared: counts, and named times to four digits. Judges it: seconds."""
    meta = {**run.meta, "run": run.folder.resolve().name, "too_busy": noise(run).too_busy}
    cases = run.cases[[_is_comparable(case) for case in run.cases.to_dict("records")]].copy()
    timed = cases["kind"] == "time"
    for column in ("samples", "calibration"):  # four digits are more than a clock tells
        short = cases.loc[timed, column].map(lambda rounds: [float(f"{it:.4g}") for it in rounds])
        cases.loc[timed, column] = short
    cases["samples"] = cases["samples"].map(np.asarray)
    kept = Run(run.folder, {key: meta.get(key) for key in HEAD}, cases, run.skipped[:0])
    return Measured(kept, claim_figures(run))


def _is_comparable(case: Mapping[Any, Any]) -> bool:
    if case["kind"] != "time":
        return True
    declared = experiments().get(case["experiment"])
    wanted = declared is not None and case["order"] in declared.baseline_orders
    return wanted and len(case["calibration"]) > 0 and len(case["samples"]) >= LEAST_ROUNDS


def load_baseline(part: str, folder: Path = FOLDER) -> Measured:
    """The counters or the run of the baseline. Raises ResultsError that names the way out."""
    try:
        run = load(folder / part)
        lines = (folder / part / CLAIMS).read_text("utf-8").splitlines()
        return Measured(run, {claim.pop("claim"): claim for claim in map(json.loads, lines)})
    except (ValueError, OSError, KeyError) as error:
        told = f"the baseline cannot be read: {error}. Make it anew: {UPDATE[part]}"
        raise ResultsError(told) from error


def save_baseline(part: str, measured: Measured, folder: Path = FOLDER) -> None:
    """Put it in the place of what there is. Raises OSError, and leaves that as it was."""
    beside = folder / f"{part}.part"
    shutil.rmtree(beside, ignore_errors=True)
    for (experiment, structure), rows in measured.run.cases.groupby(["experiment", "structure"]):
        file = CaseFile(beside, str(experiment), str(structure))
        file.add(*map(_reduced, rows.sort_values("id").to_dict("records")))
    write_meta(beside, measured.run.meta)
    lines = (json.dumps({"claim": name, **it}) + "\n" for name, it in measured.claims.items())
    write_whole(beside / CLAIMS, "".join(lines))
    shutil.rmtree(folder / part, ignore_errors=True)
    beside.rename(folder / part)


def _reduced(case: Mapping[Any, Any]) -> Measurement:
    """A row of a run as a line of the baseline."""
    values: dict[str, Any] = {key: None if pd.isna(case[key]) else case[key] for key in KEPT}
    if values["valence"] is not None:
        values["valence"] = int(values["valence"])
    return Measurement(
        **values,
        reference_bytes=int(case["reference_bytes"]),
        samples=[it if case["kind"] == "time" else int(it) for it in case["samples"]],
        calibration=list(case["calibration"]),
    )


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
    rows = []
    for experiment, structure, failed, measure in _tasks(chosen):
        try:
            measured = list(measure())
        except Exception as error:  # whatever a broken structure does is a finding, not an end
            reason = f"{type(error).__name__}: {error}".splitlines()[0]
            measured = [replace(failed, skipped=reason)]
        rows += [(experiment, structure, *astuple(it)) for it in measured]
    cases = pd.DataFrame(rows, columns=["experiment", "structure", *Measurement.__annotations__])
    cases["samples"] = cases["samples"].map(lambda samples: np.asarray(samples, float))
    skipped = cases["skipped"] != ""
    run = Run(Path(COUNTERS), describe(COUNTERS), cases[~skipped], cases[skipped])
    return Measured(run, class_figures(run))


def _tasks(chosen: Collection[str]) -> Iterator[Task]:
    for it in experiments().values():
        for name in it.structures if it.table else ():
            for case in it.cases(EXTENT.of(name), name) if not chosen or name in chosen else ():
                if it.kind_of(case) == "work":
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
    tracemalloc.start()
    try:
        made = make()
        traces = tracemalloc.take_snapshot().filter_traces([of_arrays]).traces
        return made, sum(trace.size for trace in traces) - behind(*made.arrays)
    finally:
        tracemalloc.stop()
