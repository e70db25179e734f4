"""How far verdicts can be trusted: judges on synthetic curves, and how many claims are determined.

``python -m experiments.validation.accuracy`` asks every judge of `experiments.validation.judges`
about every synthetic curve, some minutes, and keeps how often each gave which answer.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version
from itertools import product
from pathlib import Path
from typing import Any

import pandas as pd

from experiments.claims import Growth, JudgedClaim, Outcome
from experiments.runs import describe, tables
from experiments.validation.judges import PACKAGES, Judge, installed_judges
from experiments.validation.synthetic import CONDITIONS, GROWTH, SyntheticCurve, make_curves

RESULT = Path("results/reference/accuracy.json")
UNDETERMINED = Outcome.UNDETERMINED.value
COLUMNS = ["judge", "condition", "growth", "answer", "count"]

ASKED = {
    "steady": (0.95, 0.005),
    "prefetched": (0.95, 0.005),
    "latency known": (0.90, 0.01),
    "latency unknown": (0.0, 0.05),
}
"""By condition: the least share to be named right, and the largest to be named wrong."""

DETERMINED = {"work": 0.95, "time": 0.85}
"""Share of table 1's claims that must be determined, by measure, on the standard preset."""


def count_answers(judges: dict[str, Judge], curves: Iterable[SyntheticCurve]) -> pd.DataFrame:
    """Ask every judge about every curve -> a row per judge, condition, true class and answer."""
    counts = Counter[tuple[str, str, str, str]]()
    for curve in curves:
        for name, judge in judges.items():
            answer = judge(curve.sizes, curve.samples, curve.latency) or UNDETERMINED
            counts[name, curve.condition, curve.growth, answer] += 1
    return pd.DataFrame([[*key, count] for key, count in counts.items()], columns=COLUMNS)


def answer_shares(answers: pd.DataFrame) -> pd.DataFrame:
    """Shares named right, wrong and left undetermined: a row per judge and condition."""
    kind = pd.Series("wrong", answers.index)
    kind[answers["answer"] == answers["growth"]] = "right"
    kind[answers["answer"] == UNDETERMINED] = UNDETERMINED
    counts = answers.assign(kind=kind).pivot_table(
        index=["judge", "condition"], columns="kind", values="count", aggfunc="sum", fill_value=0,
        sort=False,
    )  # fmt: skip
    counts = counts.reindex(columns=["right", "wrong", UNDETERMINED], fill_value=0)
    return counts.div(counts.sum(axis=1), axis=0)


def confusions(answers: pd.DataFrame, condition: str) -> dict[str, pd.DataFrame]:
    """How often each judge gave which answer: a row per true class, a column per answer."""
    columns = [*GROWTH, UNDETERMINED]
    asked = answers[answers["condition"] == condition]
    return {
        str(judge): rows.pivot_table(index="growth", columns="answer", values="count")
        .reindex(index=list(GROWTH), columns=columns)
        .fillna(0)
        .astype(int)
        for judge, rows in asked.groupby("judge", sort=False)
    }


def determined_shares(judged: Iterable[JudgedClaim]) -> pd.DataFrame:
    """By table: how many claims of growth it has, and the shares that work and time determine."""
    rows = [
        (it.claim.table, it.outcome != UNDETERMINED, it.outcome_time != UNDETERMINED)
        for it in judged
        if isinstance(it.claim.expects, Growth) and it.claim.claims_something
    ]
    by_table = pd.DataFrame(rows, columns=["table", "work", "time"]).groupby("table", sort=False)
    shares = by_table.agg(claims=("work", "size"), work=("work", "mean"), time=("time", "mean"))
    return shares.rename(index={name: table.title for name, table in tables().items()})


def load_accuracy(path: Path = RESULT) -> tuple[dict[str, Any], pd.DataFrame]:
    """What was measured when, and the answers."""
    kept = json.loads(path.read_text("utf-8"))
    return kept, pd.DataFrame(kept["rows"], columns=kept["columns"])


def accuracy_table(answers: pd.DataFrame) -> pd.DataFrame:
    """The shares as a page shows them; a judge that is not installed has a row that says so."""
    table = answer_shares(answers).map("{:.1%}".format).reset_index()
    table["condition"] = table["condition"].map(CONDITIONS)
    missing = [name for name in PACKAGES if name not in set(answers["judge"])]
    rows = pd.DataFrame({"judge": missing, "condition": "not installed"})
    return pd.concat([table, rows]).fillna("")


def describe_origin(kept: dict[str, Any]) -> str:
    """Where kept measurements come from, in a sentence."""
    versions = ", ".join(f"{name} {number}" for name, number in kept["versions"].items())
    machine = kept["machine"]
    return (
        f"Measured {kept['started'][:10]} at commit {kept['commit'][:10]}"
        f"{' with changes that are not committed' if kept.get('dirty') else ''} "
        f"on {machine['cpu']}, {machine['cores']} cores, with {versions}; not by this page."
    )


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"


def main() -> None:
    """Run as a command."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--output", type=Path, default=RESULT)
    given = parser.parse_args()
    kinds = product(CONDITIONS, GROWTH)
    curves = [it for condition, growth in kinds for it in make_curves(growth, condition)]
    answers = count_answers(installed_judges(), curves)
    head = {key: value for key, value in describe("").items() if key != "preset"}
    head["versions"] |= {package: _version(package) for package in PACKAGES}
    kept = {"curves": len(curves), "columns": COLUMNS, "rows": answers.to_numpy().tolist()}
    given.output.write_text(json.dumps(head | kept, indent=1) + "\n", "utf-8")
    print(accuracy_table(answers).to_string(index=False))


if __name__ == "__main__":
    main()
