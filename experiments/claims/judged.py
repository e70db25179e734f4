"""From a run to a verdict on every claim: by work and by time, in each variable apart.

Work counts are exact, so they decide; time is judged beside them. Asked in consecutive order, a
query finds what it needs in the caches, and time shows its steps. Asked at random it waits for
memory, which is slower the larger the mesh. Both are judged against the latency measured beside.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from experiments.claims.growth import (
    BOUND,
    MEMORY,
    OPERATIONS,
    VARIABLES,
    Claim,
    load_claims,
)
from experiments.harness.presets import HUBS
from experiments.runs.results import Run, write_json
from hem.complexity import Bound, Verdict, judge

Array = NDArray[Any]

OUTCOMES = {
    "consistent": "✓",
    "violated": "✗",
    "undetermined": "?",
    "no claim": "–",
}
"""What a verdict can be, and its mark."""

CELL_ERROR = 0.15
"""How far cases of one curve stray, beyond what their own rounds tell: each is measured within some
milliseconds, and neighbors on the machine slow its caches for longer than that."""

PARTS = (4, 16)
"""By how much less than its working set a query or an operation may touch: one of several arrays,
or what was just copied. It then waits for memory as a smaller mesh does."""

LEAST_SLOPE = 0.01
"""Slopes of counts that differ by less are the same one: not even they come out alike everywhere,
to the last digit."""

DIGITS = 5
NOTHING = 1e-12

SOURCES = {
    ("work", "faces"): {
        "queries": ("bench_work", "random"),
        "operations": ("bench_operation_work", "counted"),
        "listings": ("bench_printed", "counted"),
    },
    ("work", "valence"): {
        "queries": ("bench_work", "random"),
        "operations": ("bench_operation_work", "counted"),
    },
    ("time", "faces"): {
        "queries": ("bench_queries", "consecutive"),
        "operations": ("bench_operations", "batched"),
        "listings": ("bench_printed", "timed"),
    },
    ("time", "valence"): {
        "queries": ("bench_valence", "random"),
        "operations": ("bench_operations", "batched"),
    },
    ("random", "faces"): {"queries": ("bench_queries", "random")},
}
"""The experiment and the order of handles that hold the evidence, by measure and variable, for the
queries of table 1 and for the operations."""


class Evidence:
    """The cases of a run that bear on the claims."""

    def __init__(self, run: Run) -> None:
        self.cases = run.cases

    @cached_property
    def judged_family(self) -> str | None:
        """The family whose valence is the same at every size: that of the work counts."""
        families = self.cases.query("experiment == 'bench_work' and family != @HUBS")["family"]
        return None if families.empty else str(families.iloc[0])

    @cached_property
    def _latency(self) -> tuple[Array, Array]:
        cases = self.cases[self.cases["experiment"] == "bench_latency"].sort_values("working_set")
        seconds = [np.median(samples) for samples in cases["samples"]]
        return cases["working_set"].to_numpy(float), np.array(seconds)

    def latency(self, working_sets: Array) -> Array | None:
        """Seconds per access at each working set, between those that were measured."""
        sizes, seconds = self._latency
        if len(sizes) == 0:
            return None
        return np.exp(np.interp(np.log(working_sets), np.log(sizes), np.log(seconds)))

    def latencies(self, cases: pd.DataFrame) -> Array:
        """(a, k): what each case may have waited for, beside it or in a part of its working set."""
        beside = cases["latency"].to_numpy(float)
        sets = np.maximum(cases["working_set"].to_numpy(float), 1)
        within = [self.latency(sets / part) for part in PARTS]
        return np.vstack([beside, *(it for it in within if it is not None)])

    @cached_property
    def _curves(self) -> dict[Any, Any]:
        """The rows of each curve."""
        by = ["experiment", "structure", "subject", "family", "order"]
        return self.cases.groupby(by).indices

    def curve(
        self, measure: str, variable: str, structure: str, query: str, table: str = ""
    ) -> pd.DataFrame:
        """The cases along one variable, ascending: of the judged family, or of the hubs."""
        table = table or ("operations" if query in OPERATIONS else "queries")
        experiment, order = SOURCES[measure, variable].get(table, (None, None))
        family = HUBS if variable == "valence" else self.judged_family
        rows = self._curves.get((experiment, structure, query, family, order), [])
        return self.cases.iloc[rows].sort_values(variable)

    def verdict(self, claim: Claim, measure: str, variable: str) -> Verdict | None:
        """Judge one claim by one measure in one variable; None without any cases.

        Where nothing is claimed the class found is what matters, and O(1) is asked about.
        """
        cases = self.curve(measure, variable, claim.structure, claim.subject, claim.table)
        if cases.empty:
            return None
        exact = measure == "work"
        # What reads nothing at all costs something all the same: the call.
        samples = [np.maximum(it, 1) if exact else it for it in cases["samples"]]
        latency = None if exact else self.latencies(cases)
        # A batch's mesh was written just before, see `operating.Bench.restore`.
        unseen = claim.table == "operations" and variable == "faces"
        expected = claim.expected.get(variable, "O(1)")
        bound: Bound = "upper" if expected.startswith(BOUND) else "tight"
        sizes, expected = cases[variable].to_numpy(float), expected.removeprefix(BOUND)
        return judge(
            sizes, samples, expected, latency,
            exact=exact, latency_error=CELL_ERROR, unseen=unseen, bound=bound,
        )  # fmt: skip

    def largest(self, measure: str, claim: Claim) -> float:
        """Cost per query at the largest size: the median over rounds, or the mean reads."""
        cases = self.curve(measure, "faces", claim.structure, claim.subject, claim.table)
        if cases.empty:
            return float("nan")
        samples = cases["samples"].iloc[-1]
        return float(np.mean(samples) if measure == "work" else np.median(samples))

    def memory(self, structure: str, reference_bytes: int) -> pd.DataFrame:
        """The judged family's cases of the memory experiment, by size."""
        wanted = (
            (self.cases["experiment"] == "bench_memory")
            & (self.cases["structure"] == structure)
            & (self.cases["family"] == self.judged_family)
            & (self.cases["reference_bytes"] == reference_bytes)
        )
        return self.cases[wanted].sort_values("vertices")

    def bytes_per_vertex(self, structure: str, reference_bytes: int = 8) -> float:
        """Bytes in the arrays per vertex, at the largest size of the judged family."""
        cases = self.memory(structure, reference_bytes)
        if cases.empty:
            return float("nan")
        return float(cases["samples"].iloc[-1][0] / cases["vertices"].iloc[-1])


def judged(run: Run, claims: list[Claim] | None = None) -> pd.DataFrame:
    """One row per claim: what is printed, what was found, and the verdicts behind it.

    Columns: structure, query (or operation), title, table, printed, source, outcome, outcome_work,
    outcome_time, for every key of ``SOURCES`` ``<measure>_<variable>`` (a ``Verdict`` or None),
    work_per_query, seconds_per_query (random handles, largest size), bytes_per_vertex.
    """
    evidence = Evidence(run)
    rows = [_row(evidence, claim) for claim in claims or load_claims()]
    table = pd.DataFrame(rows)
    for measure, variable in SOURCES:  # a column without any verdict would become one of numbers
        name = f"{measure}_{variable}"
        table[name] = pd.Series([row.get(name) for row in rows], dtype=object)
    return table


def save(run: Run, table: pd.DataFrame, folder: Path | None = None) -> Path:
    """Keep the verdicts as ``verdicts.json`` in ``folder``, or in the run's own ``derived``."""
    path = (folder or run.folder / "derived") / "verdicts.json"
    rows = [
        {str(key): _plain(value) for key, value in row.items()} for row in table.to_dict("records")
    ]
    write_json(path, {"run": run.folder.name, "claims": rows})
    return path


KEPT = ("outcome", "expected", "best", "runner_up", "margin", "slope", "slope_low", "slope_high")
"""What of a verdict is kept in a file; the rest follows from the samples."""


def _plain(value: Any) -> Any:
    """A case of the table in what JSON knows; numbers to five digits, none where there is none."""
    if isinstance(value, Verdict):
        return {key: _plain(getattr(value, key)) for key in KEPT}
    if isinstance(value, float):
        return short(value) if np.isfinite(value) else None
    return value


def short(value: float) -> float:
    """Five digits, and none of 1e-12 or less, which is what rounding leaves of nothing."""
    return float(f"{value:.{DIGITS}g}") if abs(value) > NOTHING else 0.0


def _row(evidence: Evidence, claim: Claim) -> dict[str, Any]:
    row: dict[str, Any] = {
        "structure": claim.structure,
        "subject": claim.subject,
        "title": claim.title,
        "table": claim.table,
        "printed": claim.printed,
        "source": claim.source,
    }
    if claim.subject == MEMORY:
        found = evidence.bytes_per_vertex(claim.structure)
        outcome = "consistent" if found == claim.bytes_per_vertex else "violated"
        outcome = "undetermined" if np.isnan(found) else outcome
        outcome = "no claim" if claim.bytes_per_vertex is None else outcome
        return row | {"outcome": outcome, "bytes_per_vertex": found}
    verdicts = {
        f"{measure}_{variable}": evidence.verdict(claim, measure, variable)
        for measure, variable in SOURCES
    }
    outcomes = {
        f"outcome_{measure}": combined(
            claim, [verdicts[f"{measure}_{it}"] for it in claim.expected or VARIABLES]
        )
        for measure in ("work", "time")
    }
    return row | {
        "outcome": outcomes["outcome_work"],
        **outcomes,
        **verdicts,
        "work_per_query": evidence.largest("work", claim),
        "seconds_per_query": evidence.largest(
            "random" if claim.table == "queries" else "time", claim
        ),
        "bytes_per_vertex": float("nan"),
    }


def combined(claim: Claim, verdicts: list[Verdict | None]) -> str:
    """The verdict on a claim from those in each variable: the worst of them, if it claims any."""
    if not claim.expected:
        return "no claim"
    found = {verdict.outcome if verdict else "undetermined" for verdict in verdicts}
    return next(it for it in ("violated", "undetermined", "consistent") if it in found)
