"""The history as tables, for a terminal and a page: runs, changes, claims by run or at a glance.

A line per run, change or claim. A terminal's fit 80 columns: structures by their abbreviations.
"""

from collections import Counter
from typing import Any

import pandas as pd
from rich.console import Console

from experiments.claims import Outcome, in_digits
from experiments.regression import MEASURES, OUTCOMES, ClaimName, Trends
from experiments.report.rows import two_digits
from experiments.report.tables import SHOWN, abbreviations, show_rows
from structures import NAMED

FEW = 6  # claims that get a table each; more of them share one
MARKS = {it.value: it.mark for it in Outcome}
SHORT = {what: what.replace("verdict by ", "by ") for what in OUTCOMES.values()}

LEGEND = """\
✓ consistent, ✗ violated, ? undetermined: by work, which decides, and by time.
Work: elements accessed; bytes: per vertex; time: in memory accesses.
* with changes that were not committed; ~ too busy to judge by time."""
LEGEND_RUNS = "Changed: verdicts by work/by time/figures."
LEGEND_CLAIMS = """\
≠ not the verdict before, ▲▼ a step to a new level, ( ) of other meshes than now.
Slopes and their intervals: --slopes."""


def show(
    trends: Trends, claim: str | None, console: Console, last: int | None, slopes: bool
) -> None:
    """Print the history of some claims, or all in brief; ``last``: just so many runs."""
    names, last, file = trends.claims(claim), last or len(trends.runs), trends.history.path
    if claim is None:
        changes = changes_frame(trends)
        first = len(trends.runs) - last
        recent = (changes["run"] >= first) & (changes["figure"] != SHORT[OUTCOMES["outcome_time"]])
        tables = {
            f"Runs in {file}: {len(trends.runs)}": runs_frame(trends)[-last:],
            "What changed": changes[recent].drop(columns=["run", "machine"]),
        }
    elif len(names) <= FEW:
        tables = {name: _by_run(trends, name, last, slopes) for name in names}
    else:
        tables = {f"{len(names)} claims in {file}": _at_a_glance(trends, names)}
    numbers = [measure.title for measure in MEASURES.values()]
    for title, frame in tables.items():
        if len(frame):
            rows = [list(frame.columns), *frame.astype(str).to_numpy().tolist()]
            show_rows(console, rows, title, numbers)
    machines = {run["machine"]["id"]: run["machine"] for run in trends.runs}
    facts = {key: [str(it[k]) for k in ("cores", "cpu") if k in it] for key, it in machines.items()}
    told = (f"{key}: {' cores of '.join(it)}" for key, it in facts.items())  # or so many machines
    legend = LEGEND_RUNS if claim is None else LEGEND_CLAIMS
    last_words = [LEGEND, legend, f"{abbreviations(NAMED)}.", f"Machine {'; '.join(told)}."]
    if len(machines) > 1:
        last_words.append("Times are of one machine each; --machine shows one.")
    if len({run["profile"] for run in trends.runs}) > 1:
        last_words.append("Different presets are not compared; --preset shows one.")
    console.print(*last_words, sep="\n", style="dim", markup=False, highlight=False)


def _heads(trends: Trends) -> pd.DataFrame:
    """By run its commit, and what of preset and machine is not the same in all runs."""
    several = trends.about.nunique() > 1
    return trends.about.loc[:, several | (several.index == "commit")]


def short_claim(name: str) -> str:
    """A claim with its structure's abbreviation: ``HEM vertex_faces``."""
    table, structure, subject = ClaimName.read(name)
    short = NAMED[structure].abbreviation if structure in NAMED else structure
    return f"{short} {subject}" + (" (listing)" if table == "listings" else "")


def runs_frame(trends: Trends) -> pd.DataFrame:
    """A row per run: how many claims have which outcome, and how much changed."""
    runs = _heads(trends).assign(measured=[run["started"][:10] for run in trends.runs])
    counts = trends.verdicts.groupby(["run", "measure"])["outcome"].agg(_count_outcomes).unstack()
    counts = counts.reindex(runs.index, columns=list(SHORT)).fillna("")
    runs = runs.join(counts.rename(columns=SHORT))
    changes, kinds = trends.changes, [*SHORT, "figures"]
    kind = changes["measure"].where(changes["measure"].isin(SHORT), kinds[-1])
    counted = pd.crosstab(changes["run"], kind).reindex(runs.index, columns=kinds, fill_value=0)
    text = counted.astype(str).agg("/".join, axis=1)
    return runs.assign(changed=text.where(counted.any(axis=1), ""))


def _count_outcomes(outcomes: pd.Series) -> str:
    """How many claims have each outcome, such as ``85✓ 3✗``."""
    counts = Counter(outcomes)
    return " ".join(f"{counts[it]}{it.mark}" for it in SHOWN if counts[it])


def changes_frame(trends: Trends) -> pd.DataFrame:
    """A row per change of a verdict or a figure, in the order of the commits."""
    changes = trends.changes.replace(MARKS)
    frame = changes[["run"]].assign(
        at=changes["run"].map(trends.about["commit"]),
        claim=changes["claim"].map(short_claim),
        figure=changes["measure"].replace(SHORT),
    )
    frame["before → after"] = changes["before"] + " → " + changes["after"]
    return frame.assign(machine=changes["machine"].replace("", "any"))


def _by_run(trends: Trends, name: str, last: int, slopes: bool) -> pd.DataFrame:
    """A row for each of the last runs that measured one claim, a column per figure."""
    titles = {key: measure.title for key, measure in MEASURES.items() if measure.slope == slopes}
    figures = trends.figures.query("claim == @name and measure in @titles")
    cells = figures.assign(text=[_figure(row) for row in figures.itertuples()])
    table = cells.pivot_table("text", "run", "measure", aggfunc="first", sort=False)
    measured = [k for k, run in enumerate(trends.runs) if name in run["claims"]][-last:]
    verdicts = _verdicts(trends, [name]).set_axis(["verdict"], axis=1)
    return _heads(trends).loc[measured].join([verdicts, table.rename(columns=titles)]).fillna("–")


def _verdicts(trends: Trends, names: list[str]) -> pd.DataFrame:
    """By run and claim the verdicts by work and by time, marked where they are not as before."""
    rows = trends.verdicts
    marks = rows["outcome"].replace(MARKS) + rows["changed"].map({True: "≠ ", False: "  "})
    table = marks.groupby([rows["run"], rows["claim"]]).sum().unstack()
    return table.reindex(index=trends.about.index, columns=names)  # a busy run may have none


def _figure(row: Any) -> str:
    """A figure, of time a slope with its interval; in parentheses if it is of other meshes."""
    measure = MEASURES[row.measure]
    text = two_digits(row.value) if measure.slope else in_digits(row.value, 5)
    if measure.slope and not measure.exact:
        text += f" [{two_digits(row.low)}, {two_digits(row.high)}]"
    text = text if row.comparable else f"({text})"
    if pd.notna(change := row.after - row.before):
        relative = row.before and not measure.slope
        step = f"{change / row.before:+.1%}" if relative else f"{change:+.2f}"
        text += f" {'▲' if change > 0 else '▼'}{step}"
    return text


def _at_a_glance(trends: Trends, names: list[str]) -> pd.DataFrame:
    """A row per claim: where its verdict and figures are now, and when they changed last."""
    verdicts, changes = _verdicts(trends, names), trends.changes
    newest = trends.figures.groupby(["claim", "measure"])["value"].last().unstack()
    newest = newest.reindex(index=names, columns=list(MEASURES))
    changed = changes[changes["measure"] != OUTCOMES["outcome_time"]].groupby("claim")["run"].last()
    shown = {"work or bytes": newest["bytes"].fillna(newest["work"]), "time": newest["time"]}
    texts = pd.DataFrame(shown).map(in_digits, count=5).replace("NaN", "–")
    glance = texts.assign(changed=changed.map(trends.about["commit"]).reindex(names).fillna(""))
    glance.insert(0, "claim", [short_claim(name) for name in names])
    glance.insert(1, "verdict", verdicts.ffill().iloc[-1].fillna("–").str.replace("≠", " "))
    return glance


def as_json(trends: Trends, claim: str | None, last: int | None) -> dict[str, Any]:
    """Everything that is shown, as records, NaN where nothing is; ``run``: an index of ``runs``."""
    names = trends.claims(claim)
    runs = [k for k, it in enumerate(trends.runs) if claim is None or it["claims"].keys() & names]
    content: dict[str, Any] = {
        "file": str(trends.history.path),
        "faults": trends.history.faults,
        "runs": [{key: run[key] for key in run if key != "claims"} for run in trends.runs],
    }
    for name in ("figures", "verdicts", "changes"):
        rows = getattr(trends, name)
        shown = rows["claim"].isin(names) & rows["run"].isin(runs[-(last or 0) :])
        content[name] = rows[shown].to_dict("records")
    return content
