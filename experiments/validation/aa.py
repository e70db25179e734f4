"""The A/A test of the gates: how often ``hem check`` raises an alarm over identical code.

``python -m experiments.validation.aa`` makes seven runs of the queries of table 1 and compares each
with each other as ``hem check RUN`` does. Twenty times it times the queries of one structure in
this tree and in a copy of it, interleaved, as ``hem check --beside`` does. Deterministic counters
are not compared, as they are the same each time. Takes twenty minutes of a machine's whole
attention.
"""

import json
import tempfile
from collections import Counter
from collections.abc import Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import typer

from experiments import regression
from experiments.regression import Change, Finding, Measured
from experiments.runs import describe, load, study
from experiments.validation.mutants import copied_tree
from structures import THESIS as STRUCTURES

RESULT = Path("results/reference/aa.json")
MEASURED = ("bench_work", "bench_queries")
"""What a run measures: what table 1 is judged by. The work tells the family that is judged."""
PRESET = "quick"
LARGEST_SHARE = 1e-3  # false alarms per comparison that are accepted


def measure_run(root: Path, seed: int) -> Measured:
    """Measure what the gate compares by time, the cases in an order of their own."""
    folder = study.begin(PRESET, root, STRUCTURES, experiments=MEASURED, seed=seed)
    study.run(folder)
    return regression.reduce_run(load(folder))


def compare_pair(before: Measured, after: Measured) -> dict[str, Any]:
    """Count what the gate says of two runs, where there is a verdict to be lost or won."""
    open_twice = (Change.UNDETERMINED, Change.UNDETERMINED)
    findings = regression.compare_runs(before, after).findings
    told = [it for it in findings if it.random and (it.before, it.after) != open_twice]
    return count_findings(told)


def count_findings(findings: Sequence[Finding]) -> dict[str, Any]:
    """How often the gate said what, and its alarms in words."""
    outcomes = Counter(finding.change for finding in findings)
    alarms = (it for it in findings if it.change in (Change.WORSE, Change.BETTER))
    return {
        "comparisons": len(findings), "same": outcomes[Change.SAME],
        "undetermined": outcomes[Change.UNDETERMINED], "exit_code": regression.exit_code(findings),
        "alarms": [f"{it.change}: {it.kind} {it.where} {it.difference}" for it in alarms],
    }  # fmt: skip


def sum_counts(rows: Sequence[dict[str, Any]]) -> dict[str, int]:
    """Sum up rows: comparisons, alarms, those left open, and how often these were too many."""
    return {
        "comparisons": sum(row["comparisons"] for row in rows),
        "alarms": sum(len(row["alarms"]) for row in rows),
        "undetermined": sum(row["undetermined"] for row in rows),
        "indecisive": sum(row["exit_code"] == 2 for row in rows),
    }


def in_words(kept: dict[str, Any]) -> str:
    """Say what was kept in a sentence or two."""
    pairs, interleaved = kept["pairs"], kept["interleaved"]
    of_pairs, of_interleaved = (
        "{alarms} false alarms in {comparisons:,} comparisons, {undetermined} left open, which "
        "was too many {indecisive} times.".format(**sum_counts(rows))
        for rows in (pairs, interleaved)
    )
    return (
        f"{kept['runs']} runs of the same code, each compared with each other, {len(pairs)} pairs: "
        f"{of_pairs} A tree and a copy of it, interleaved, {len(interleaved)} times: "
        f"{of_interleaved}"
    )


def main(runs: int = 7, interleaved: int = 20, output: Path = RESULT) -> None:
    """Measure, compare, keep; exit with 1 if there are too many false alarms."""
    kept = {key: value for key, value in describe(PRESET).items() if key != "schema"}
    kept |= {"runs": runs, "pairs": [], "interleaved": []}
    kept |= {"factor": regression.RUN_FACTOR, "factor_interleaved": regression.INTERLEAVED_FACTOR}
    with copied_tree() as copy:
        for k in range(interleaved):
            structure = STRUCTURES[k % len(STRUCTURES)]
            findings = regression.compare_trees(copy, structures=[structure])
            kept["interleaved"].append(count_findings(findings))
            print("interleaved", kept["interleaved"][-1], flush=True)
    with tempfile.TemporaryDirectory(prefix="hem-aa-") as root:
        measured = [measure_run(Path(root), seed) for seed in range(runs)]
        for pair in combinations(measured, 2):
            kept["pairs"].append(compare_pair(*pair))
            print("pair", kept["pairs"][-1], flush=True)
    kept |= sum_counts(kept["pairs"] + kept["interleaved"])
    output.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    print(in_words(kept))
    raise SystemExit(int(kept["alarms"] > LARGEST_SHARE * kept["comparisons"]))


if __name__ == "__main__":
    typer.run(main)
