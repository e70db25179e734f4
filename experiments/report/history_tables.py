"""The history as tables, for a terminal and a page: runs, changes, claims by run or at a glance.

A line per run, change or claim. A terminal's fit 80 columns: structures by their abbreviations.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from typing import Any

import pandas as pd
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from experiments.claims import Outcome
from experiments.regression import MEASURES, OUTCOMES, Line, Trends, is_of
from structures import NAMED

FEW = 6
"""Claims that get a table each; more of them share one."""
WIDEST = 500
COLORS = {
    **{f"\\{outcome.mark}": outcome.color for outcome in Outcome},
    "[▲▼][^ ]+|≠": "bold yellow",
}
"""What is colored in a terminal, as regular expressions."""
SHORT = {what: what.replace("verdict by ", "by ") for what in OUTCOMES.values()}

LEGEND = """\
✓ consistent, ✗ violated, ? undetermined: by work, which decides, and by time.
Work: elements accessed; bytes: per vertex; time: in memory accesses.
* with changes that were not committed."""
LEGEND_RUNS = "Changed: verdicts by work/by time/figures."
LEGEND_CLAIMS = """\
≠ not the verdict before, ▲▼ a step to a new level, ( ) of other meshes than now.
Slopes and their intervals: --slopes."""


def show(
    trends: Trends, claim: str | None, console: Console, last: int | None, slopes: bool
) -> None:
    """Print the history of some claims, or all in brief; ``last``: just so many runs."""
    names, shown = trends.claims(claim), range(len(trends.runs))[-(last or len(trends.runs)) :]
    file, decided = trends.history.path, OUTCOMES["outcome_time"]
    if claim is None:
        _print(console, f"{len(trends.runs)} runs in {file}", runs_frame(trends)[shown.start :])
        changes = changes_frame(trends)
        recent = changes["run"].isin(shown) & (changes["figure"] != SHORT[decided])
        _print(
            console, "What changed", changes[recent][["at", "claim", "figure", "before → after"]]
        )
    elif len(names) <= FEW:
        for name in names:
            _print(console, name, _by_run(trends, name, shown, slopes))
    else:
        _print(console, f"{len(names)} claims in {file}", _at_a_glance(trends, names))
    console.print(LEGEND, LEGEND_RUNS if claim is None else LEGEND_CLAIMS, style="dim")
    machines = {run["machine"]["id"]: run["machine"] for run in trends.runs}
    told = (f"{key}: {it.get('cores')} cores of {it.get('cpu')}" for key, it in machines.items())
    console.print(f"Machine {'; '.join(told)}.", style="dim", highlight=False)
    if len(machines) > 1:
        console.print("Times are of one machine each; --machine shows one.", style="dim")
    if len({run["profile"] for run in trends.runs}) > 1:
        console.print("Different presets are not compared; --preset shows one.", style="dim")


def _print(console: Console, title: str, frame: pd.DataFrame) -> None:
    """Print a table, however wide it is: a figure that is cut is a wrong one."""
    if frame.empty:
        return
    table = Table(title=title, title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False)
    for head in frame.columns:
        numbers = head in {measure.title for measure in MEASURES.values()}
        table.add_column(head, no_wrap=True, justify="right" if numbers else "left")
    for row in frame.astype(str).itertuples(index=False):
        cells = [Text(cell) for cell in row]
        for cell in cells:
            for pattern, color in COLORS.items():
                cell.highlight_regex(pattern, color)
        table.add_row(*cells)
    wide = console.measure(table, options=console.options.update(max_width=WIDEST))
    console.print(table, width=max(console.width, wide.maximum), crop=False)


def as_html(frame: pd.DataFrame) -> str:
    """A table for a page."""
    html: str = frame.to_html(index=False, border=0, classes="numbers")
    return f'<div class="wide">{html}</div>'


def _head(trends: Trends, run: Line) -> dict[str, str]:
    """Commit, and what of preset and machine is not the same in all runs."""
    facts = {"preset": "profile", "machine": "machine"}
    several = (name for name, key in facts.items() if len({str(it[key]) for it in trends.runs}) > 1)
    known = {"preset": run["profile"], "machine": run["machine"]["id"]}
    return {"commit": short_commit(run), **{name: known[name] for name in several}}


def short_commit(run: Line) -> str:
    """The commit of a run, with a star where there were changes besides."""
    return str(run["commit"][:7]) + ("*" if run.get("dirty") else "")


def short_claim(name: str) -> str:
    """A claim with its structure's abbreviation: ``HEM vertex_faces``."""
    table, structure, subject = name.split("/")
    short = NAMED[structure].abbreviation if structure in NAMED else structure
    return f"{short} {subject}" + (" (listing)" if table == "listings" else "")


def runs_frame(trends: Trends) -> pd.DataFrame:
    """A row per run: how many claims have which outcome, and how much changed."""
    rows = []
    for k, run in enumerate(trends.runs):
        mine = Counter(trends.changes[trends.changes["run"] == k]["measure"])
        verdicts = [mine[what] for what in OUTCOMES.values()]
        changed = [*verdicts, mine.total() - sum(verdicts)]
        outcomes = {SHORT[what]: _count_outcomes(run, key) for key, what in OUTCOMES.items()}
        text = "/".join(map(str, changed)) if any(changed) else ""
        measured = {"measured": run["started"][:10]}
        rows.append({**_head(trends, run), **measured, **outcomes, "changed": text})
    return pd.DataFrame(rows)


def _count_outcomes(run: Line, key: str) -> str:
    """How many claims of a run have each outcome, such as ``85✓ 3✗``."""
    counts = Counter(claim[key] for claim in run["claims"].values() if key in claim)
    shown = (Outcome.CONSISTENT, Outcome.VIOLATED, Outcome.UNDETERMINED)
    return " ".join(f"{counts[it]}{it.mark}" for it in shown if counts[it])


def changes_frame(trends: Trends) -> pd.DataFrame:
    """A row per change of a verdict or a figure, in the order of the commits."""
    changes = trends.changes
    pairs = zip(changes["before"].map(_mark), changes["after"].map(_mark), strict=True)
    return pd.DataFrame(
        {
            "run": changes["run"],
            "at": [short_commit(trends.runs[k]) for k in changes["run"]],
            "claim": changes["claim"].map(short_claim),
            "figure": changes["measure"].replace(SHORT),
            "before → after": [f"{before} → {after}" for before, after in pairs],
            "machine": changes["machine"].replace("", "any"),
        }
    )


def _mark(outcome: str) -> str:
    """A verdict's mark, or any other text as it is."""
    return Outcome(outcome).mark if outcome in set(Outcome) else outcome


def _by_run(trends: Trends, name: str, shown: Collection[int], slopes: bool) -> pd.DataFrame:
    """A row per run of one claim, a column per figure."""
    figures = is_of([name], trends.figures)
    figures = figures[figures["measure"].map(lambda it: MEASURES[it].slope == slopes)]
    cells = figures.assign(text=[_figure(row) for row in figures.itertuples()])
    table = cells.pivot_table("text", "run", "measure", aggfunc="first", sort=False).fillna("–")
    table = table.rename(columns={key: measure.title for key, measure in MEASURES.items()})
    verdicts = _verdicts(trends, name)
    rows = {k: {**_head(trends, trends.runs[k]), "verdict": verdicts[k]} for k in verdicts}
    heads = pd.DataFrame.from_dict(rows, orient="index")
    joined = heads.join(table).fillna("–")
    return joined[joined.index.isin(shown)]


def _verdicts(trends: Trends, name: str) -> dict[int, str]:
    """By run the verdicts by work and by time, marked where they are not as before."""
    rows = is_of([name], trends.verdicts)
    changed = rows["before"].notna() & (rows["before"] != rows["outcome"])
    marks = rows["outcome"].map(_mark) + changed.map({True: "≠ ", False: "  "})
    texts: Any = marks.groupby(rows["run"]).sum()
    return dict(texts)


def _figure(row: Any) -> str:
    """A figure, of time a slope with its interval; in parentheses if it is of other meshes."""
    measure = MEASURES[row.measure]
    text = _slope(row.value) if measure.slope else f"{row.value:,.5g}"
    text += f" [{_slope(row.low)}, {_slope(row.high)}]" if measure.slope > measure.exact else ""
    text = text if row.comparable else f"({text})"
    if pd.isna(row.before):
        return text
    ratio = measure.slope or not row.before
    step = f"{row.after - row.before:+.2f}" if ratio else f"{row.after / row.before - 1:+.1%}"
    return f"{text} {'▲' if row.after > row.before else '▼'}{step}"


def _slope(value: float) -> str:
    return f"{round(value, 2) + 0:.2f}"


def _at_a_glance(trends: Trends, names: list[str]) -> pd.DataFrame:
    """A row per claim: where its verdict and figures are now, and when they changed last."""
    newest = is_of(names, trends.figures).groupby(["claim", "measure"])["value"].last()
    by_time = trends.changes["measure"] == OUTCOMES["outcome_time"]
    changed = trends.changes[~by_time].groupby("claim")["run"].last()
    rows = []
    for name in names:
        work = newest.get((name, "bytes"), newest.get((name, "work")))
        values = {"work or bytes": work, "time": newest.get((name, "time"))}
        cells = {key: "–" if it is None else f"{it:,.5g}" for key, it in values.items()}
        at = short_commit(trends.runs[changed[name]]) if name in changed.index else ""
        verdict = list(_verdicts(trends, name).values())[-1].replace("≠", " ")
        rows.append({"claim": short_claim(name), "verdict": verdict, **cells, "changed": at})
    return pd.DataFrame(rows)


def as_json(trends: Trends, claim: str | None, last: int | None) -> dict[str, Any]:
    """Everything that is shown, as records; ``run`` is an index into ``runs``."""
    names, first = trends.claims(claim), len(trends.runs) - (last or len(trends.runs))
    tables = {name: getattr(trends, name) for name in ("figures", "verdicts", "changes")}
    heads = [{key: run[key] for key in run if key != "claims"} for run in trends.runs]
    records = {
        name: is_of(names, table[table["run"] >= first]).astype(object)
        for name, table in tables.items()
    }
    return {
        "file": str(trends.history.path),
        "faults": trends.history.faults,
        "runs": heads,
        **{name: it.where(it.notna(), None).to_dict("records") for name, it in records.items()},
    }


def describe_history(trends: Trends) -> str:
    """What the chapter says first: how many runs there are, and what to do if they are few."""
    count, machines = len(trends.runs), len({run["machine"]["id"] for run in trends.runs})
    measure = "run `hem study`, then `hem history add`"
    if not count:
        return f"There is no history yet. At each commit that is to be compared, {measure}."
    text = f"The history has {_plural(count, 'run')}, of {_plural(machines, 'machine')}."
    few = (
        " A course needs three at least, and a step in the times three on either side of it: "
        f"check out another commit, or come back after the next one, and {measure}."
    )
    return text + (few if count < 3 else "")


def _plural(count: int, what: str) -> str:
    return f"one {what}" if count == 1 else f"{count} {what}s"
