"""Bytes of each structure: by the thesis' model, by its arrays, and as the process sees them."""

import tracemalloc

import numpy as np

import structures
from experiments.harness import Case, Experiment, Measurement, Preset, Timer, own_mesh
from hem.room import behind, give_back
from structures.half_edge_objects import HalfEdgeMesh

SMALLEST = 1_000  # vertices from which on a mesh is weighed, unless it is one's own


def cases(preset: Preset, structure: str) -> list[Case]:
    """The judged family by size and the real models, at both sizes of a reference."""
    every = ((preset.families[0], size) for size in preset.build_sizes)
    sizes = [it for it in every if it[1] >= SMALLEST or own_mesh.is_own(*it)]
    return [
        Case(structure, family, size, reference_bytes=reference_bytes)
        for family, size in [*sizes, *((model, 0) for model in preset.models)]
        for reference_bytes in (4, 8)
    ]


def measure(case: Case, preset: Preset, timer: Timer) -> Measurement:
    """Weigh the structure: the model counts just what arrays hold, and about what objects take."""
    mesh = case.mesh()
    structures.build(case.structure, mesh, case.reference_bytes)  # compiles, unweighed
    give_back()  # memory that is used again would not be traced
    tracemalloc.start()
    s = structures.build(case.structure, mesh, case.reference_bytes)
    _, peak = tracemalloc.get_traced_memory()
    unwritten, kept = behind(*s.arrays), give_back()  # what is kept for later is nobody's
    traced, peak = tracemalloc.get_traced_memory()[0] - unwritten, peak - unwritten - kept
    tracemalloc.stop()
    fields = s.memory()
    if s.compiled:
        assert sum(s.memory(names=True).values()) == sum(array.nbytes for array in s.arrays)
    elif len(mesh.points) >= SMALLEST:  # or the structure itself counts
        assert 0.8 < sum(fields.values()) / traced < 1.25
    detail = {"fields": fields, "traced": traced, "peak": peak}
    if isinstance(s, HalfEdgeMesh):
        detail["clr"] = s.clr_memory()
    model = np.array([sum(fields.values())])
    return case.result("bytes", s, model, checked=True, detail=detail)


EXPERIMENT = Experiment("Bytes", cases, measure, kind="bytes", copies=2, turn=20)
test_memory = EXPERIMENT.test
