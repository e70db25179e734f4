"""The history on a page: how much there is of it, its runs, and what changed."""

from __future__ import annotations

import pandas as pd

from experiments.regression import OUTCOMES, Trends
from experiments.report.history_tables import count_outcomes, short_commit

SHOWN = 40
"""Changes on a page, the newest."""


def describe_history(trends: Trends) -> str:
    """What the chapter says first: how many runs there are, and what to do if they are few."""
    count, machines = len(trends.runs), {run["machine"]["id"] for run in trends.runs}
    if not count:
        return (
            "There is no history yet. Measure and keep what was found with "
            "`hem study`, then `hem history add`; do so at each commit that is to be compared."
        )
    text = f"The history has {_plural(count, 'run')}, of {_plural(len(machines), 'machine')}."
    if count < 3:
        text += (
            " A course needs three at least, and a step in the times three on either side of it: "
            "check out another commit, or come back after the next one, and run "
            "`hem study`, then `hem history add`."
        )
    return text


def _plural(count: int, what: str) -> str:
    return f"one {what}" if count == 1 else f"{count} {what}s"


def runs_table(trends: Trends) -> str:
    """A table of the runs, the newest first: what they found, and how many verdicts changed."""
    counts = trends.changes.groupby(["run", "measure"]).size().to_dict()
    rows = [
        {
            "commit": short_commit(run),
            "of": (run.get("committed") or "unknown")[:10],
            "measured": run["started"][:16].replace("T", " "),
            "profile": run["profile"],
            "machine": run["machine"]["id"],
            "by work": count_outcomes(run, "outcome"),
            "by time": count_outcomes(run, "outcome_time"),
            "changed by work": counts.get((k, OUTCOMES["outcome"]), ""),
            "by time ": counts.get((k, OUTCOMES["outcome_time"]), ""),
        }
        for k, run in enumerate(trends.runs)
    ]
    return _table(pd.DataFrame(rows[::-1]))


def changes_table(trends: Trends) -> str:
    """A table of the figures and verdicts by work that changed, the newest first."""
    found = trends.changes[trends.changes["measure"] != OUTCOMES["outcome_time"]]
    found = found.sort_values("run", ascending=False, kind="stable")
    if found.empty:
        return "<p>Nothing changed so far.</p>"
    older = len(found) - SHOWN
    more = f"<p>And {older} older ones: <code>hem history show</code>.</p>" if older > 0 else ""
    found = found.assign(
        at=found["run"].map(lambda k: short_commit(trends.runs[k])),
        machine=found["machine"].replace("", "any"),
    ).rename(columns={"measure": "figure"})
    return _table(found[["at", "claim", "figure", "before", "after", "machine"]][:SHOWN]) + more


def _table(rows: pd.DataFrame) -> str:
    html: str = rows.to_html(index=False, border=0, classes="numbers")
    return f'<div class="wide">{html}</div>'
