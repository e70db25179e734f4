"""How far verdicts can be trusted: judges on curves of known class; and how many are determined.

``python -m experiments.validation.accuracy`` asks every judge of
`experiments.validation.judges` about the corpus,
some minutes, and keeps how often each named what.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from experiments.claims.growth import MEMORY, TABLES
from experiments.claims.judged import judged
from experiments.runs.provenance import describe
from experiments.runs.results import Run, read_json, write_json
from experiments.validation.judges import PACKAGES, Judge, installed
from experiments.validation.synthetic import CURVES, PARTS, Curve, corpus

RESULT = Path("results/reference/rigour.json")
UNDETERMINED = "undetermined"
COUNT = 144
"""Curves of each class and part."""

ASKED = {
    "none": (0.95, 0.005),
    "prefetched": (0.95, 0.005),
    "measured": (0.90, 0.01),
    "unmeasured": (0.0, 0.05),
}
"""By part of the corpus: the least share to be named right, and the largest to be named wrong."""

DETERMINED = {"work": 0.95, "time": 0.85}
"""Share of table 1's cases that must be determined, by measure, on the standard profile."""


class Shares(NamedTuple):
    """Of the claims of a table, how many are determined, and out of how many, by measure."""

    claims: int
    work: float
    time: float


def named(judges: dict[str, Judge], curves: Iterable[Curve]) -> pd.DataFrame:
    """Ask every judge about every curve -> columns judge, part, true, named, count."""
    counts = Counter[tuple[str, str, str, str]]()
    for it in curves:
        for name, judge in judges.items():
            answer = judge(it.sizes, it.samples, it.latency) or UNDETERMINED
            counts[name, it.part, it.name, answer] += 1
    columns = ["judge", "part", "true", "named", "count"]
    return pd.DataFrame([[*key, count] for key, count in counts.items()], columns=columns)


def shares(table: pd.DataFrame, by: tuple[str, ...] = ("judge", "part")) -> pd.DataFrame:
    """Shares named right, wrong and left undetermined, from what ``named`` gives, a row per key."""
    kind = pd.Series("wrong", table.index)
    kind[table["named"] == table["true"]] = "right"
    kind[table["named"] == UNDETERMINED] = UNDETERMINED
    counts = table.assign(kind=kind).pivot_table(
        index=list(by), columns="kind", values="count", aggfunc="sum", fill_value=0, sort=False
    )
    counts = counts.reindex(columns=["right", "wrong", UNDETERMINED], fill_value=0)
    return counts.div(counts.sum(axis=1), axis=0)


def confusion(table: pd.DataFrame, judge: str, part: str) -> pd.DataFrame:
    """How often one judge named what: a row per true class, a column per answer."""
    own = table[(table["judge"] == judge) & (table["part"] == part)]
    wide = own.pivot_table(index="true", columns="named", values="count", aggfunc="sum")
    return wide.reindex(index=list(CURVES), columns=[*CURVES, UNDETERMINED]).fillna(0).astype(int)


def determined(table: pd.DataFrame) -> dict[str, Shares]:
    """By table, the shares of its claims with a verdict other than undetermined.

    table: a row per claim, as `experiments.claims.judged.judged` gives. Claims about memory are not
    judged by growth, and cases that claim nothing are not counted.
    """
    table = table[(table["subject"] != MEMORY) & (table["outcome"] != "no claim")]
    return {
        str(name): Shares(
            len(rows),
            *(float((rows[f"outcome_{it}"] != UNDETERMINED).mean()) for it in ("work", "time")),
        )
        for name, rows in table.groupby("table", sort=False)
    }


def saved(path: Path = RESULT) -> tuple[dict[str, Any], pd.DataFrame]:
    """What was measured when, and the counts. Raises ResultsError without the file."""
    kept = read_json(path)
    return kept, pd.DataFrame(kept["rows"], columns=kept["columns"])


def table(named_: pd.DataFrame) -> pd.DataFrame:
    """Shares by judge and part, in words, as a page shows them."""
    found = shares(named_)
    rows = [
        {"curves": what, "judge": judge}
        | {kind: f"{found.loc[(judge, part)][kind]:.1%}" for kind in found.columns}
        for part, what in PARTS.items()
        for judge in dict.fromkeys(named_["judge"])
    ]
    return pd.DataFrame(rows)


def determined_table(run: Run) -> pd.DataFrame:
    """Shares of claims that are determined in a run, in words, as a page shows them."""
    rows = [
        {"table": TABLES[name], "claims": it.claims}
        | {f"determined by {measure}": f"{getattr(it, measure):.0%}" for measure in DETERMINED}
        for name, it in determined(judged(run)).items()
    ]
    return pd.DataFrame(rows)


def provenance(kept: dict[str, Any]) -> str:
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
    parser.add_argument("--count", type=int, default=COUNT, help="curves of each class and part")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--output", type=Path, default=RESULT)
    given = parser.parse_args()
    table = named(installed(), corpus(given.count, given.seed))
    head = {key: value for key, value in describe("rigour").items() if key != "profile"}
    head["versions"] |= {package: _version(package) for package in PACKAGES}
    drawn = {"curves": given.count * len(CURVES) * len(PARTS), "seed": given.seed}
    rows = {"columns": list(table.columns), "rows": table.to_numpy().tolist()}
    write_json(given.output, head | drawn | rows)
    print(shares(table).to_string(float_format=lambda share: f"{share:.4f}"))


if __name__ == "__main__":
    main()
