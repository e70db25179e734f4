"""The history on a page: how much there is of it, its runs, and what changed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Any

import pandas as pd

from experiments.claims.judged import OUTCOMES as MARKS
from experiments.regression.history import History
from experiments.regression.trends import OUTCOMES, changes

SHOWN = 40
"""Changes on a page, the newest."""


def told(history: History) -> str:
    """What the chapter says first: how many runs there are, and what to do if they are few."""
    count, machines = len(history.runs), {it["machine"]["id"] for it in history.runs}
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


def runs(history: History) -> str:
    """A table of the runs, the newest first: what they found, and how many verdicts changed."""
    found = Counter((it.run, it.what) for it in changes(history) if it.is_verdict)
    rows = [
        {
            "commit": run["commit"][:10] + ("*" if run.get("dirty") else ""),
            "of": (run.get("committed") or "unknown")[:10],
            "measured": run["started"][:16].replace("T", " "),
            "profile": run["profile"],
            "machine": run["machine"]["id"],
            **{
                what.replace("verdict ", ""): _counts(run["claims"].values(), key)
                for key, what in OUTCOMES.items()
            },
            "changed by work": found[k, OUTCOMES["outcome"]] or "",
            "by time ": found[k, OUTCOMES["outcome_time"]] or "",
        }
        for k, run in enumerate(history.runs)
    ]
    return _table(rows[::-1])


def changed(history: History) -> str:
    """A table of the figures and verdicts by work that changed, the newest first."""
    found = [it for it in changes(history) if it.what != OUTCOMES["outcome_time"]]
    found.sort(key=lambda it: -it.run)
    if not found:
        return "<p>Nothing changed so far.</p>"
    rows = [
        {
            "at": history.runs[it.run]["commit"][:10],
            "claim": it.claim,
            "figure": it.what,
            "before": it.before,
            "after": it.after,
            "machine": it.machine or "any",
        }
        for it in found[:SHOWN]
    ]
    older = len(found) - SHOWN
    more = f"<p>And {older} older ones: <code>hem history show</code>.</p>" if older > 0 else ""
    return _table(rows) + more


def _counts(claims: Iterable[dict[str, Any]], key: str) -> str:
    counts = Counter(it[key] for it in claims if key in it)
    shown = ("consistent", "violated", "undetermined")
    return " ".join(f"{counts[it]}{MARKS[it]}" for it in shown if counts[it])


def _table(rows: list[dict[str, Any]]) -> str:
    html: str = pd.DataFrame(rows).to_html(index=False, border=0, classes="numbers")
    return f'<div class="wide">{html}</div>'
