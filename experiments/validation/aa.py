"""The gate against itself: how often ``hem check`` cries wolf over code that is the same.

``python -m experiments.validation.aa``:
seven runs of the queries of table 1, each compared with each
other as by ``hem check RUN``, and twenty times the queries of one structure in this tree beside a
copy of it, as by ``hem check --beside``. What is exact is left out, as it is the same each time.
Takes twenty minutes of a machine's whole attention.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from experiments.regression import significance
from experiments.regression.baseline import Measured, measured
from experiments.regression.compare_runs import FACTOR as RUN_FACTOR
from experiments.regression.compare_runs import compare_runs
from experiments.regression.findings import Finding, code
from experiments.regression.gate import HERE
from experiments.regression.interleaved import compare_trees
from experiments.runs import study, worker
from experiments.runs.provenance import describe
from experiments.runs.results import load, write_json
from experiments.validation.a_against_a import ALARMS, LARGEST_SHARE
from experiments.validation.mutants import copied
from structures import THESIS as STRUCTURES

RESULT = Path("results/reference/same_code.json")
PROCESSES = (
    ("bench_work", STRUCTURES[0]),  # tells which family verdicts are taken from
    *((it, structure) for it in ("bench_queries", "bench_valence") for structure in STRUCTURES),
)
"""What is measured: what table 1 is judged by."""
PROFILE = "quick"


def timed(root: Path, seed: int) -> Measured:
    """A run of what the gate compares by time, its cases in an order of their own."""
    folder = study.begin(PROFILE, root, STRUCTURES, seed=seed)
    for experiment, structure in PROCESSES:
        how = study.how(folder)
        code, output = worker.measure(folder, experiment, structure, how, lambda: None)
        if code:
            raise RuntimeError(f"{experiment} on {structure} failed:\n{output}")
    study.finish(folder)
    return measured(load(folder))


def compared(before: Measured, after: Measured) -> dict[str, Any]:
    """What the gate says of a pair of runs."""
    return row(it for it in compare_runs(before, after).findings if _counts(it))


def beside_itself(copy: Path, repetition: int) -> dict[str, Any]:
    """What the gate says of this tree beside a copy: each time the queries of another structure."""
    return row(compare_trees(copy, HERE, [STRUCTURES[repetition % len(STRUCTURES)]]))


def row(findings: Iterable[Finding]) -> dict[str, Any]:
    """How often the gate said what, and its alarms in words."""
    found = list(findings)
    outcomes = Counter(it.outcome for it in found)
    return {
        "comparisons": len(found),
        "same": outcomes["same"],
        "undetermined": outcomes["undetermined"],
        "code": code(found),
        "alarms": [f"{it.outcome}: {it}" for it in found if it.outcome in ALARMS],
    }


def _counts(finding: Finding) -> bool:
    """Whether chance has a say in it, and there is a verdict to be lost or won."""
    nothing = finding.before == finding.after == "undetermined"
    return finding.by_chance and not nothing


def totals(rows: Iterable[dict[str, Any]]) -> dict[str, int]:
    """Of all together: comparisons, alarms, what is left open, and how often that was too much."""
    every = list(rows)
    return {
        "comparisons": sum(row["comparisons"] for row in every),
        "alarms": sum(len(row["alarms"]) for row in every),
        "undetermined": sum(row["undetermined"] for row in every),
        "not_told": sum(row["code"] == 2 for row in every),
    }


def words(kept: dict[str, Any]) -> str:
    """What was kept, in a sentence or two."""
    runs, turns = totals(kept["pairs"]), totals(kept["turns"])
    return (
        f"{kept['runs']} runs of the same code, each compared with each other, "
        f"{len(kept['pairs'])} pairs: {_words(runs)} A tree timed by turns beside a copy of "
        f"itself, {len(kept['turns'])} times: {_words(turns)}"
    )


def _words(found: dict[str, int]) -> str:
    return (
        f"{found['alarms']} false alarms in {found['comparisons']:,} comparisons, "
        f"{found['undetermined']} left open, which was too many {found['not_told']} times."
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, compare, keep -> 1 if there are too many false alarms."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--turns", type=int, default=20)
    parser.add_argument("--output", type=Path, default=RESULT)
    given = parser.parse_args(arguments)
    kept = {key: it for key, it in describe(PROFILE).items() if key != "schema"}
    kept |= {"runs": given.runs, "pairs": [], "turns": []}
    kept |= {"factor": RUN_FACTOR, "factor_by_turns": significance.FACTOR}
    with copied() as copy:
        for repetition in range(given.turns):
            kept["turns"].append(told(beside_itself(copy, repetition), "turns"))
    with tempfile.TemporaryDirectory(prefix="hem-same-") as root:
        runs: list[Measured] = []
        for seed in range(given.runs):
            run = timed(Path(root), seed)
            kept["pairs"] += [told(compared(it, run), "runs") for it in runs]
            runs.append(run)
    kept |= totals(kept["pairs"] + kept["turns"])
    write_json(given.output, kept)
    print(words(kept))
    return int(kept["alarms"] > LARGEST_SHARE * kept["comparisons"])


def told(found: dict[str, Any], what: str) -> dict[str, Any]:
    """Print a row as it comes."""
    counts = f"{found['same']:4} same {found['undetermined']:4} undetermined"
    print(f"{what:5} {counts}", *found["alarms"], sep="\n   ", flush=True)
    return found


if __name__ == "__main__":
    sys.exit(main())
