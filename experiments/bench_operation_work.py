"""Work of the operations, counted in array elements read and written: by size, and by valence.

Each is done uncompiled on a copy of the mesh. The counts are exact and the same on every machine.
"""

from __future__ import annotations

import numpy as np

from experiments.claims.growth import OPERATIONS
from experiments.conftest import Keep
from experiments.harness.cases import Case
from experiments.harness.operations import arguments, faces_of, validate
from experiments.harness.presets import Preset
from structures import NAMES as STRUCTURES

REPETITIONS = 3
SCANNED = 1  # one scan of a mesh reads as much as another


def cases(profile: Preset, structure: str) -> list[Case]:
    """The judged family by size, then the hubs by valence."""
    return [
        Case(structure, family, size, operation, "counted", valence)
        for family, size, valence in profile.work_points()
        for operation in OPERATIONS
    ]


def test_operation_work(case: Case, keep: Keep) -> None:
    """Count what operations read and write, and check what they make of the mesh."""
    s, operation = case.build().copy(), str(case.subject)
    faces = faces_of(case, SCANNED if case.structure == "indexed" else REPETITIONS)
    rows = arguments(s, operation, faces).tolist()
    work = [s.operation_work(operation, *row) for row in rows]
    validate(s)
    keep(case.result("work", case.build(), np.array(work), handles=1, checked=True))


__all__ = ["STRUCTURES", "cases", "test_operation_work"]
