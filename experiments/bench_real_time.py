"""Single edits with a render mesh in step, each timed by itself: what a frame has to wait for.

A median hides the edit that stalls. So every edit is a sample: four operations in turn, each at
another place, from Python, until the arrays of the render mesh may be uploaded.
"""

from itertools import takewhile, zip_longest
from typing import Any

import numpy as np

import hem
from experiments import harness
from experiments.harness import Case, Experiment, Measurement, Preset, Timer
from hem.contract import Structure

EDITED = "split_edge", "split_face", "collapse_edge", "flip_edge"
EDITS, COMPACT = "single_edits", "compact"
RESERVED, GROWING = "reserved", "not reserved"  # whether there was room for all edits before

MOST_EDITS, MOST_SEARCHING = 1_000, 200
COMPACTIONS = 5


def cases(preset: Preset, structure: str) -> list[Case]:
    """Edits with room and without, and the compaction that follows them, by size."""
    kinds = (EDITS, RESERVED), (EDITS, GROWING), (COMPACT, None)
    family, sizes = preset.families[0], preset.real_time_sizes
    return [Case(structure, family, size, *it) for size in sizes for it in kinds]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Time single edits, or compactions after as many."""
    s = case.build()
    edits = _planned(case, s)
    if case.subject == COMPACT:
        compacted = _edited(s, edits)
        compacted.compact()
        harness.validate_operated(compacted, case)
        timed = timer(
            lambda it: it.compact(), setup=lambda: (_edited(s, edits),), rounds=COMPACTIONS
        )
        return case.result("time", s, **timed.fields)
    _edited(s, edits[:8])  # compiles
    copy = s.copy()
    render = hem.RenderMesh(copy)
    uploads: list[int] = []
    if case.order == RESERVED:
        copy.reserve(len(edits))
        render.reserve(len(edits))

    def count_bytes(upload: hem.Upload) -> None:
        ranges = upload.vertices, upload.triangles
        uploads.append(int(12 * sum(np.diff(it).sum() for it in ranges)))

    render.subscribe(count_bytes)
    following = iter(edits)
    timed = timer(
        lambda edit: copy.operate(edit[0], edit[1], point=edit[2]),
        setup=lambda: (next(following),), rounds=len(edits), warmup=0,
    )  # fmt: skip
    harness.validate_operated(copy, case, render)
    detail = {"uploads": uploads, "render": render.points.nbytes + render.indices.nbytes}
    return case.result("time", s, **timed.fields, detail=detail)


def _planned(case: Case, s: Structure) -> list[tuple[str, int, Any]]:
    """Operations in turn, each at a place of its own, where it may be done."""
    faces = harness.operation_faces(case, MOST_SEARCHING if case.searches else MOST_EDITS)
    every = len(EDITED)
    rows = [harness.operation_arguments(s, it, faces[k::every]) for k, it in enumerate(EDITED)]
    points = [np.zeros(3) if it.startswith("split") else None for it in EDITED]
    turns = zip_longest(*(it[:, 0].tolist() for it in rows))
    edits = (edit for turn in turns for edit in zip(EDITED, turn, points, strict=True))
    return list(takewhile(lambda edit: edit[1] is not None, edits))


def _edited(s: Structure, edits: list[tuple[str, int, Any]]) -> Structure:
    """A copy after these edits, with a render mesh that followed."""
    copy = s.copy()
    hem.RenderMesh(copy)
    for name, handle, point in edits:
        copy.operate(name, handle, point=point)
    return copy


EXPERIMENT = Experiment(title="Real time", cases=cases, measure=measure, copies=14, turn=65)
test_real_time = EXPERIMENT.test
