"""What becomes of the claims on queries on each family of meshes that was timed.

Claims are judged on one family, whose vertices all have the same valence, and whose work is
counted. Others are timed alone, so that what holds there is told by time.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import pandas as pd

from experiments.claims.claim import MEMORY, JudgedClaim, Outcome
from experiments.claims.curves import curves
from experiments.claims.verdicts import judge_cells
from experiments.harness import QUERIES_TABLE, Axis
from experiments.runs import Run

BY_TIME = Axis.TIME_FACES, Axis.RANDOM_FACES
DETERMINED = {Outcome.CONSISTENT, Outcome.VIOLATED}


class Family(NamedTuple):
    """A family: its largest mesh as a case of the run, and the judged claims on its queries."""

    name: str
    largest: pd.Series
    claims: list[JudgedClaim]

    def outcomes(self, axis: Axis) -> dict[str, Outcome]:
        """What became of every claim along an axis, by its key."""
        found = {it.claim.key: it.verdicts.get(axis) for it in self.claims}
        return {key: Outcome(it.outcome) for key, it in found.items() if it is not None}

    def against(self, other: "Family", axis: Axis) -> Iterator[JudgedClaim]:
        """The claims that hold on one of the two families, and are violated on the other."""
        mine, others = self.outcomes(axis), other.outcomes(axis)
        for it in self.claims:
            if {mine.get(it.claim.key), others.get(it.claim.key)} == DETERMINED:
                yield it


def judge_families(run: Run, judged: Sequence[JudgedClaim]) -> list[Family]:
    """All families whose queries were timed, the judged one first: its claims are ``judged``."""
    first = curves(run).judged_family
    timed = run.cases[run.cases["experiment"].isin(("bench_queries", "bench_latency"))]
    queries = [it for it in judged if it.claim.table == QUERIES_TABLE.name]
    asked = [it for it in queries if it.claim.claims_something and it.claim.subject != MEMORY]
    largest = timed[timed["experiment"] == "bench_queries"].sort_values("vertices")
    meshes = {name: of_family.iloc[-1] for name, of_family in largest.groupby("family")}
    families = []
    for name in sorted(meshes, key=lambda it: (it != first, it)):
        others = timed["family"].isin([it for it in meshes if it != name])
        alone = Run(run.folder, run.meta, timed[~others].reset_index(drop=True), run.skipped)
        found = asked if name == first else judge_cells(alone, [it.claim for it in asked])
        families.append(Family(str(name), meshes[name], found))
    return families
