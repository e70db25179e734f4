"""The gate against itself: how often ``hem check`` cries wolf over code that is the same.

``python -m experiments.same_code``: seven runs, each compared with each as ``hem check RUN`` does,
and this tree timed beside itself twenty times, as by ``hem check --beside``. What is exact is left
out, as it is the same each time. Takes a quarter of an hour of a machine's whole attention.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from experiments import children, study
from experiments.a_against_a import ALARMS, LARGEST_SHARE
from experiments.check import Finding
from experiments.check_run import FACTOR, compare_runs
from experiments.gate import HERE
from experiments.provenance import describe
from experiments.reference import Measured, measured
from experiments.results import load, write_json
from experiments.turns import compare_trees
from structures import THESIS as STRUCTURES

RESULT = Path("results/reference/same_code.json")
PROCESSES = (
    ("bench_work", STRUCTURES[0]),  # tells which family verdicts are taken from
    *((it, structure) for it in ("bench_queries", "bench_valence") for structure in STRUCTURES),
)
"""What is measured: what table 1 is judged by."""
PROFILE = "quick"


def timed(root: Path, seed: int) -> Measured:
    """A run of what the gate compares by time, its cells in an order of their own."""
    folder = study.begin(PROFILE, root, STRUCTURES, seed=seed)
    for experiment, structure in PROCESSES:
        how = study.how(folder)
        code, output = children.measure(folder, experiment, structure, how, lambda: None)
        if code:
            raise RuntimeError(f"{experiment} on {structure} failed:\n{output}")
    study.finish(folder)
    return measured(load(folder))


def compared(before: Measured, after: Measured) -> dict[str, Any]:
    """What the gate says of a pair of runs."""
    return row(it for it in compare_runs(before, after).findings if _counts(it))


def beside_itself(repetition: int) -> dict[str, Any]:
    """What the gate says of this tree beside itself: all queries of one structure after another."""
    return row(compare_trees(HERE, HERE, [STRUCTURES[repetition % len(STRUCTURES)]]))


def row(findings: Iterable[Finding]) -> dict[str, Any]:
    """How often the gate said what, and its alarms in words."""
    found = list(findings)
    outcomes = Counter(it.outcome for it in found)
    return {
        "comparisons": len(found),
        "same": outcomes["same"],
        "undetermined": outcomes["undetermined"],
        "alarms": [f"{it.outcome}: {it}" for it in found if it.outcome in ALARMS],
    }


def _counts(finding: Finding) -> bool:
    """Whether chance has a say in it, and there is a verdict to be lost or won."""
    nothing = finding.before == finding.after == "undetermined"
    return finding.by_chance and not nothing


def totals(rows: Iterable[dict[str, Any]]) -> dict[str, int]:
    """Of all together: comparisons, alarms, and what cannot be told."""
    every = list(rows)
    return {
        "comparisons": sum(row["comparisons"] for row in every),
        "alarms": sum(len(row["alarms"]) for row in every),
        "undetermined": sum(row["undetermined"] for row in every),
    }


def words(kept: dict[str, Any]) -> str:
    """What was kept, in a sentence or two."""
    runs, turns = totals(kept["pairs"]), totals(kept["turns"])
    return (
        f"{kept['runs']} runs of the same code, each compared with each ({len(kept['pairs'])} "
        f"pairs): {runs['alarms']} false alarms in {runs['comparisons']:,} comparisons, "
        f"{_part(runs)} could not be told. A tree timed beside itself by turns "
        f"({len(kept['turns'])} times): {turns['alarms']} in {turns['comparisons']:,}, "
        f"{_part(turns)} could not be told."
    )


def _part(found: dict[str, int]) -> str:
    return f"{found['undetermined'] / max(found['comparisons'], 1):.1%}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure, compare, keep -> 1 if there are too many false alarms."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=7)
    parser.add_argument("--turns", type=int, default=20)
    parser.add_argument("--output", type=Path, default=RESULT)
    given = parser.parse_args(arguments)
    kept = {key: it for key, it in describe(PROFILE).items() if key != "schema"}
    kept |= {"runs": given.runs, "factor": FACTOR, "pairs": [], "turns": []}
    for repetition in range(given.turns):
        kept["turns"].append(told(beside_itself(repetition), "turns"))
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
