"""How far verdicts can be trusted: judges on synthetic curves, and how many claims are determined.

``python -m experiments.validation.accuracy`` asks every judge about every synthetic curve, some
minutes, and keeps how often each gave which answer. A judge takes sizes, samples and a latency and
names a class of `hem.complexity.models`, or none. The rivals know of no latency; they are given
nanoseconds, as some of them have thresholds in absolute units.
"""

import atexit
import json
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import typer

from experiments.claims import Growth, JudgedClaim, Outcome
from experiments.runs import describe, tables
from experiments.validation.synthetic import CONDITIONS, GROWTH, Array, SyntheticCurve, make_curves
from hem.complexity import judge

RESULT = Path("results/reference/accuracy.json")
UNDETERMINED = Outcome.UNDETERMINED.value
COLUMNS = ["judge", "condition", "growth", "answer", "count"]

ASKED = {
    "steady": (0.95, 0.005), "prefetched": (0.95, 0.005), "latency known": (0.90, 0.01),
    "latency unknown": (0.0, 0.05),
}  # fmt: skip
"""By condition: the least share to be named right, and the largest to be named wrong."""

DETERMINED = {"work": 0.95, "time": 0.85}  # asked of table 1's claims on the standard preset

Judge = Callable[[Array, Sequence[Array], Array | None], str | None]

NANOSECONDS = 1e9
ROOTLESS = [name for name in GROWTH if name != "O(√n)"]  # what those know that have no O(√n)


def hem_judge(sizes: Array, samples: Sequence[Array], latency: Array | None) -> str | None:
    """`hem.complexity.judge`: the class that is consistent, of all it could be asked."""
    best = judge(sizes, samples, latency=latency, resamples=2).best
    verdict = judge(sizes, samples, best, latency, resamples=2)
    return best if verdict.outcome == "consistent" else None


def google_benchmark(
    sizes: Array, samples: Sequence[Array], latency: Array | None = None
) -> str | None:
    """Google Benchmark's rule, src/complexity.cc: MinimalLeastSq with oAuto.

    Least squares of each curve without intercept over all points; the least root mean square error
    relative to the mean wins, and O(1) where nothing beats it. It has no O(√n), and O(n³) is not
    asked about.
    """
    n, t = _points(sizes, samples)

    def square_error(name: str) -> float:
        curve = GROWTH[name](n)
        return float(np.mean((t - (t @ curve) / (curve @ curve) * curve) ** 2))

    return min(ROOTLESS, key=square_error)


def big_o(sizes: Array, samples: Sequence[Array], latency: Array | None = None) -> str | None:
    """The package big-o (P. Berkes), least residuals of least times win; it has no O(√n)."""
    from big_o import complexities, infer_big_o_class

    theirs = "Constant", "Logarithmic", "Linear", "Linearithmic", "Quadratic"
    names = {getattr(complexities, own): name for own, name in zip(theirs, ROOTLESS, strict=True)}
    least = np.array([np.min(case) for case in samples])
    best, _ = infer_big_o_class(sizes, NANOSECONDS * least, classes=list(names))
    return names[type(best)] if best is not None else None


def bigo(sizes: Array, samples: Sequence[Array], latency: Array | None = None) -> str | None:
    """The package bigo (E. Berger, S. Freund), Akaike's criterion; it drops outliers by itself."""
    from bigO import bigO, models

    atexit.unregister(bigO.save_performance_data)  # or it leaves a file where one happens to be
    theirs = "O(1)", "O(log(n))", "O(sqrt(n))", "O(n)", "O(n*log(n))", "O(n**2)"
    names = dict(zip(theirs, GROWTH, strict=True))
    n, t = _points(sizes, samples)
    fitted = models.infer_bound(n, NANOSECONDS * t).models
    return next((names[fit.model.name] for fit in fitted if fit.model.name in names), None)


def _points(sizes: Array, samples: Sequence[Array]) -> tuple[Array, Array]:
    n = np.repeat(sizes, [len(case) for case in samples])
    return n, np.concatenate([np.asarray(case, float) for case in samples])


JUDGES: dict[str, Judge] = {
    "hem": hem_judge, "bigo": bigo, "big-o": big_o, "Google Benchmark": google_benchmark,
}  # fmt: skip
"""By name. Those of packages that are not installed fail when asked: see ``installed_judges``."""

PACKAGES = {"bigo": "bigO", "big-o": "big_o"}  # their modules


def installed_judges() -> dict[str, Judge]:
    """The judges that can be asked here. Not every package has a distribution for every Python."""
    missing = {name for name, module in PACKAGES.items() if find_spec(module) is None}
    return {name: it for name, it in JUDGES.items() if name not in missing}


def count_answers(judges: dict[str, Judge], curves: Iterable[SyntheticCurve]) -> pd.DataFrame:
    """Ask every judge about every curve -> a row per judge, condition, true class and answer."""
    counts = Counter(
        (name, it.condition, it.growth, ask(it.sizes, it.samples, it.latency) or UNDETERMINED)
        for it in curves
        for name, ask in judges.items()
    )
    return pd.DataFrame([[*key, count] for key, count in counts.items()], columns=COLUMNS)


def answer_shares(answers: pd.DataFrame) -> pd.DataFrame:
    """Shares named right, wrong and left undetermined: a row per judge and condition."""
    kind = pd.Series("wrong", answers.index)
    kind[answers["answer"] == answers["growth"]] = "right"
    kind[answers["answer"] == UNDETERMINED] = UNDETERMINED
    counts = answers.assign(kind=kind).pivot_table(
        "count", ["judge", "condition"], "kind", aggfunc="sum", fill_value=0, sort=False
    )
    counts = counts.reindex(columns=["right", "wrong", UNDETERMINED], fill_value=0)
    return counts.div(counts.sum(axis=1), axis=0)


def confusions(answers: pd.DataFrame, condition: str) -> dict[str, pd.DataFrame]:
    """How often each judge gave which answer: a row per true class, a column per answer."""
    asked = answers[answers["condition"] == condition]
    return {
        str(judge): rows.pivot_table("count", "growth", "answer", aggfunc="sum", fill_value=0)
        .reindex(index=list(GROWTH), columns=[*GROWTH, UNDETERMINED], fill_value=0)
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


def main(output: Path = RESULT) -> None:
    """Ask every judge about every curve, keep the answers, and print the shares."""
    kept = {key: value for key, value in describe("").items() if key != "preset"}
    curves = [
        it for condition in CONDITIONS for name in GROWTH for it in make_curves(name, condition)
    ]
    judges = installed_judges()
    answers = count_answers(judges, curves)
    for package in PACKAGES:
        kept["versions"][package] = version(package) if package in judges else "not installed"
    kept |= {"curves": len(curves), "columns": COLUMNS, "rows": answers.to_numpy().tolist()}
    output.write_text(json.dumps(kept, indent=1) + "\n", "utf-8")
    print(accuracy_table(answers).to_string(index=False))


if __name__ == "__main__":
    typer.run(main)
