"""Measurements along one variable: what plots draw and what claims are judged by."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import pandas as pd

from experiments.claims.claim import Claim
from experiments.harness import HUBS, QUERIES_TABLE, Axis
from experiments.runs import Run, experiments, noise, tables
from hem.arrays import Array

PARTS = (4, 16)
"""By how much less than its working set a query or an operation may touch: one of several arrays,
or what was just copied. It then waits for memory as a smaller mesh does."""

TOO_BUSY = "By time it looks violated, but the machine was too busy to accuse anything by time."

_NONE = np.zeros(0, np.intp)


@dataclass(frozen=True, eq=False)
class Curve:
    """The cases of one structure and subject along one variable, ascending."""

    variable: str
    cases: pd.DataFrame

    def __len__(self) -> int:
        return len(self.cases)

    @property
    def sizes(self) -> Array:
        """(k,) the variable."""
        return self.cases[self.variable].to_numpy(float)

    @property
    def samples(self) -> list[Array]:
        """The samples of each case."""
        return list(self.cases["samples"])

    @cached_property
    def centers(self) -> Array:
        """(k,) the cost of each case: mean accesses, or median seconds."""
        center = np.mean if (self.cases["kind"] == "work").any() else np.median
        return np.array([float(center(it)) for it in self.samples])

    @cached_property
    def by_size(self) -> pd.Series:
        """The cost of each case by its number of vertices."""
        return pd.Series(self.centers, self.cases["vertices"].astype(int), dtype=float)

    @property
    def largest(self) -> float:
        """The cost at the largest size, nan without any case."""
        return float(self.centers[-1]) if len(self) else np.nan


class Curves:
    """Every curve of a run."""

    def __init__(self, run: Run) -> None:
        self.cases = run.cases
        self.too_busy = noise(run).too_busy
        self.of_machines = bool(run.machines)
        self._made: dict[tuple[str, bytes], Curve] = {}
        self._jobs: dict[Any, Any] = self.cases.groupby(["experiment", "structure"]).indices
        self._columns = {str(name): column.to_numpy() for name, column in self.cases.items()}
        latency = self.cases[self.cases["experiment"] == "bench_latency"]
        self._latency = Curve("working_set", latency.sort_values("working_set"))

    @cached_property
    def judged_family(self) -> str | None:
        """The family that is measured first and most: its valence is the same at every size."""
        families = self.cases["family"]
        counted = self.cases[(self.cases["kind"] == "work") & (families != HUBS)]["family"]
        if len(counted):
            return str(counted.iloc[0])
        others = families[families.notna() & ~families.isin((HUBS, "chase"))]
        return None if others.empty else str(others.mode().iloc[0])

    def curve(self, axis: Axis, structure: str, subject: str, table: str = "") -> Curve:
        """The cases along one axis: of the judged family, or of the hubs."""
        experiment, order = _sources().get((table or table_of(subject), axis), ("", ""))
        family = HUBS if axis.variable == "valence" else self.judged_family
        known = {"subject": subject, "order": order, "family": family}
        return self._select(axis.variable, experiment, structure, **known)

    def of(self, claim: Claim, axis: Axis) -> Curve:
        """What a claim is judged by along an axis."""
        return self.curve(axis, claim.structure, claim.subject, claim.table)

    def on_one_mesh(self, claim: Claim) -> tuple[int, float, float]:
        """The faces of the largest mesh on which work was counted and timed, and both there.

        Asked at random where that was measured; zero and nan where there is no such mesh.
        """
        timed = self.of(claim, Axis.RANDOM_FACES)
        timed = timed if len(timed) else self.of(claim, Axis.TIME_FACES)
        every = self.of(claim, Axis.WORK_FACES), timed
        work, seconds = (pd.Series(it.centers, it.sizes, dtype=float) for it in every)
        most = work.index.intersection(seconds.index).max()
        return (0, np.nan, np.nan) if np.isnan(most) else (int(most), work[most], seconds[most])

    def named(
        self, experiment: str, structure: str, subject: str = "", order: str = "", *,
        width: int = 4, family: str = "",
    ) -> Curve:  # fmt: skip
        """Cases by size, of the judged family unless told; ``width``: bytes of a reference."""
        known: dict[str, Any] = {"family": family or self.judged_family, "reference_bytes": width}
        known |= {name: it for name, it in (("subject", subject), ("order", order)) if it}
        return self._select("faces", experiment, structure, **known)

    def _select(self, variable: str, experiment: str, structure: str, **known: Any) -> Curve:
        """The cases with what is known; the same curve each time, so that it is summed up once."""
        rows = self._jobs.get((experiment, structure), _NONE)
        for name, value in known.items():
            rows = rows[self._columns[name][rows] == value]
        key = variable, rows.tobytes()
        if key not in self._made:
            self._made[key] = Curve(variable, self.cases.iloc[rows].sort_values(variable))
        return self._made[key]

    def memory(self, structure: str, width: int = 8) -> Curve:
        """The bytes of a structure by size."""
        return self.named("bench_memory", structure, width=width)

    def bytes_per_vertex(self, structure: str, width: int = 8) -> float:
        """Bytes in the arrays per vertex, at the largest size of the judged family."""
        curve = self.memory(structure, width)
        return curve.largest / float(curve.cases["vertices"].max())

    @property
    def faces_per_vertex(self) -> float:
        """That of the largest mesh of the judged family, nan without any."""
        sizes = self.cases.loc[self.cases["family"] == self.judged_family, ["faces", "vertices"]]
        largest = sizes.astype(float).nlargest(1, "vertices")
        return float((largest["faces"] / largest["vertices"]).max())

    @staticmethod
    def reference(curve: Curve) -> Array | None:
        """(k,) seconds of constant work beside each case; None where that was not measured."""
        beside = curve.cases["reference"].to_numpy(float)
        return None if np.isnan(beside).any() else beside

    def latencies(self, curve: Curve) -> Array | None:
        """(a, k): what cases may have waited for, beside them or in part of their working sets."""
        beside = curve.cases["latency"].to_numpy(float)
        if np.isnan(beside).any():
            return None
        sets = np.maximum(curve.cases["working_set"].to_numpy(float), 1)
        within = [self.latency(sets / part) for part in PARTS]
        return np.vstack([beside, *(it for it in within if it is not None)])

    def latency(self, working_sets: Array) -> Array | None:
        """Seconds per access at each working set, between those that were measured."""
        if not len(curve := self._latency):
            return None
        return np.exp(np.interp(np.log(working_sets), np.log(curve.sizes), np.log(curve.centers)))


@lru_cache(maxsize=4)
def curves(run: Run) -> Curves:
    """The curves of a run, the same object each time."""
    return Curves(run)


@lru_cache(maxsize=256)
def table_of(subject: str) -> str:
    """The first table that has a row for a subject; of the bytes that of the queries."""
    found = (it.name for it in tables().values() if subject in it.subjects)
    return next(found, QUERIES_TABLE.name)


@lru_cache(maxsize=1)
def _sources() -> dict[tuple[str, Axis], tuple[str, str]]:
    """By table and axis the experiment, and the order of its cases."""
    return {
        (it.table.name, axis): (name, order)
        for name, it in experiments().items()
        if it.table is not None
        for axis, order in it.axes.items()
    }


def axes_of(table: str) -> list[Axis]:
    """The axes along which a table's claims are judged."""
    return [axis for axis in Axis if (table, axis) in _sources()]
