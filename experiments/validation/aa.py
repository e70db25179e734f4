"""The A/A test of the gates: how often ``hem check`` raises an alarm over identical code.

``python -m experiments.validation.aa`` makes seven runs of the queries of table 1 and compares each
with each other as ``hem check RUN`` does. Twenty times it times the queries of one structure in
this tree and in a copy of it, interleaved, as ``hem check --beside`` does. Deterministic counters
are not compared, as they are the same each time. Takes twenty minutes of a machine's whole
attention.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from experiments.regression import (
    HERE,
    INTERLEAVED_FACTOR,
    RUN_FACTOR,
    Change,
    Finding,
    Measured,
    compare_runs,
    compare_trees,
    exit_code,
    reduce_run,
)
from experiments.runs import describe, load, study
from experiments.validation.mutants import copied_tree
from structures import THESIS as STRUCTURES

RESULT = Path("results/reference/aa.json")
MEASURED = ("bench_work", "bench_queries", "bench_valence")
"""What a run measures: what table 1 is judged by. The work tells the family that is judged."""
PRESET = "quick"
ALARMS = (Change.WORSE, Change.BETTER)
LARGEST_SHARE = 1e-3
"""False alarms per comparison that are accepted."""


def measure_run(root: Path, seed: int) -> Measured:
    """Measure what the gate compares by time, the cases in an order of their own."""
    folder = study.begin(PRESET, root, STRUCTURES, experiments=MEASURED, seed=seed)
    study.run(folder)
    return reduce_run(load(folder))


def compare_pair(before: Measured, after: Measured) -> dict[str, Any]:
    """Count what the gate says of two runs, where there is a verdict to be lost or won."""
    findings = compare_runs(before, after).findings
    open_twice = (Change.UNDETERMINED, Change.UNDETERMINED)
    return count_findings(
        it for it in findings if it.random and (it.before, it.after) != open_twice
    )


def compare_with_copy(copy: Path, repetition: int) -> dict[str, Any]:
    """Count what the gate says of this tree and a copy: each time of another structure."""
    return count_findings(compare_trees(copy, HERE, [STRUCTURES[repetition % len(STRUCTURES)]]))


def count_findings(findings: Iterable[Finding]) -> dict[str, Any]:
    """How often the gate said what, and its alarms in words."""
    findings = list(findings)
    outcomes = Counter(finding.change for finding in findings)
    return {
        "comparisons": len(findings),
        "same": outcomes[Change.SAME],
        "undetermined": outcomes[Change.UNDETERMINED],
        "exit_code": exit_code(findings),
        "alarms": [
            f"{it.change}: {it.kind} {it.where} {it.difference}"
            for it in findings
            if it.change in ALARMS
        ],
    }


def sum_counts(rows: Iterable[dict[str, Any]]) -> dict[str, int]:
    """Sum up rows: comparisons, alarms, those left open, and how often these were too many."""
    rows = list(rows)
    return {
        "comparisons": sum(row["comparisons"] for row in rows),
        "alarms": sum(len(row["alarms"]) for row in rows),
        "undetermined": sum(row["undetermined"] for row in rows),
        "indecisive": sum(row["exit_code"] == 2 for row in rows),
    }


def in_words(kept: dict[str, Any]) -> str:
    """Say what was kept in a sentence or two."""
    pairs, interleaved = kept["pairs"], kept["interleaved"]
    return (
        f"{kept['runs']} runs of the same code, each compared with each other, {len(pairs)} pairs: "
        f"{_count_in_words(pairs)} A tree and a copy of it, interleaved, {len(interleaved)} times: "
        f"{_count_in_words(interleaved)}"
    )


def _count_in_words(rows: list[dict[str, Any]]) -> str:
    total = sum_counts(rows)
    return (
        f"{total['alarms']} false alarms in {total['comparisons']:,} comparisons, "
        f"{total['undetermined']} left open, which was too many {total['indecisive']} times."
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, compare, keep -> 1 if there are too many false alarms."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--interleaved", type=int, default=20)
    parser.add_argument("--output", type=Path, default=RESULT)
    given = parser.parse_args(arguments)
    kept = {key: value for key, value in describe(PRESET).items() if key != "schema"}
    kept |= {"runs": given.runs, "pairs": [], "interleaved": []}
    kept |= {"factor": RUN_FACTOR, "factor_interleaved": INTERLEAVED_FACTOR}
    with copied_tree() as copy:
        for repetition in range(given.interleaved):
            row = compare_with_copy(copy, repetition)
            kept["interleaved"].append(_print_row("interleaved", row))
    with tempfile.TemporaryDirectory(prefix="hem-aa-") as root:
        runs: list[Measured] = []
        for seed in range(given.runs):
            run = measure_run(Path(root), seed)
            kept["pairs"] += [_print_row("pair", compare_pair(other, run)) for other in runs]
            runs.append(run)
    kept |= sum_counts(kept["pairs"] + kept["interleaved"])
    given.output.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    print(in_words(kept))
    return int(kept["alarms"] > LARGEST_SHARE * kept["comparisons"])


def _print_row(kind: str, row: dict[str, Any]) -> dict[str, Any]:
    counts = f"{row['same']:4} same {row['undetermined']:4} undetermined"
    print(f"{kind:11} {counts}", *row["alarms"], sep="\n   ", flush=True)
    return row


if __name__ == "__main__":
    sys.exit(main())
