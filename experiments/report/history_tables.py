"""The history as tables: runs in brief, a claim from run to run, or many claims at a glance."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, replace
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from experiments.claims.judged import OUTCOMES as MARKS
from experiments.regression.history import History, Line
from experiments.regression.trends import (
    MEASURES,
    OUTCOMES,
    Change,
    Series,
    changes,
    series,
)
from experiments.report.tables import STYLES

FEW = 6
"""Claims that get a table each; more of them share one."""
WIDE = 110
"""Columns of a terminal from which on intervals are shown."""
BARS = "▁▂▃▄▅▆▇█"


def of(history: History, machine: str | None, profile: str | None) -> History:
    """The runs of one machine, of one profile, or both. Raises ValueError if there are none."""
    runs = history.runs
    if machine is not None:
        runs = [it for it in runs if machine and it["machine"]["id"].startswith(machine)]
        if not runs:
            known = {it["machine"]["id"]: it["machine"].get("cpu") for it in history.runs}
            there = ", ".join(f"{key} ({cpu})" for key, cpu in known.items())
            raise ValueError(f"no run is of machine {machine!r}; there are {there}")
        matched = sorted({it["machine"]["id"] for it in runs})
        if len(matched) > 1:
            raise ValueError(f"machine {machine!r} might be {' or '.join(matched)}: say more of it")
    if profile is not None:
        runs, before = [it for it in runs if it["profile"] == profile], runs
        if not runs:
            there = ", ".join(dict.fromkeys(it["profile"] for it in before))
            raise ValueError(f"no run is of profile {profile!r}; there are {there}")
    return replace(history, runs=runs)


def show(
    history: History, names: list[str], console: Console, last: int | None, brief: bool
) -> None:
    """Print the history of some claims; ``last``: just so many runs. ``brief``: the runs first."""
    shown = range(len(history.runs))[-(last or len(history.runs)) :]
    found = [it for it in changes(history, names) if it.run in shown]
    if brief:
        console.print(_runs(history, shown, found))
        _print_changes(
            history, [it for it in found if it.what != OUTCOMES["outcome_time"]], console
        )
    elif len(names) <= FEW:
        for name in names:
            console.print(_claim(history, name, shown, found, console.width >= WIDE))
    else:
        console.print(_glance(history, names, shown, found))
    console.print(_legend(history, brief), style="dim", highlight=False)


def _runs(history: History, shown: Sequence[int], found: list[Change]) -> Table:
    table = _headed(history, f"{len(history.runs)} runs in {history.path}")
    for head in ("by work", "by time"):
        table.add_column(head, no_wrap=True)
    for head in ("verdicts changed", "figures changed"):
        table.add_column(head, justify="right")
    for k in shown:
        mine = [it for it in found if it.run == k]
        verdicts = [sum(it.what == what for it in mine) for what in OUTCOMES.values()]
        changed = " + ".join(map(str, verdicts)) if any(verdicts) else ""
        figures = sum(not it.is_verdict for it in mine)
        table.add_row(
            *_head(history, k),
            *(_counts(history.runs[k], key) for key in OUTCOMES),
            Text(changed, style="bold yellow" if verdicts[0] else ""),
            str(figures or ""),
        )
    return table


def _headed(history: History, title: str) -> Table:
    """A table with the columns of ``_head``."""
    table = Table(title=title, pad_edge=False)
    for head in ("commit", "measured", *_told_apart(history)):
        table.add_column(head, no_wrap=True)
    return table


def _head(history: History, k: int) -> list[str]:
    run = history.runs[k]
    facts = {"profile": run["profile"], "machine": run["machine"]["id"]}
    return [short(run), run["started"][:10], *(facts[it] for it in _told_apart(history))]


def _told_apart(history: History) -> list[str]:
    """What of profile and machine is not the same in all runs."""
    several = {
        "profile": len({it["profile"] for it in history.runs}) > 1,
        "machine": len({it["machine"]["id"] for it in history.runs}) > 1,
    }
    return [name for name, needed in several.items() if needed]


def short(run: Line) -> str:
    """The commit of a run, with a star where there were changes besides."""
    return str(run["commit"][:7]) + ("*" if run.get("dirty") else "")


def _counts(run: Line, key: str) -> Text:
    counts = Counter(it[key] for it in run["claims"].values() if key in it)
    text = Text()
    for outcome in ("consistent", "violated", "undetermined"):
        if counts[outcome]:
            text.append(f"{counts[outcome]}{MARKS[outcome]} ", style=STYLES[outcome])
    return text


def _print_changes(history: History, found: list[Change], console: Console) -> None:
    if not found:
        return
    machines = "machine" in _told_apart(history)
    table = Table(title="What changed", pad_edge=False)
    for head in ("at", "claim", "figure", "before → after", *(["machine"] if machines else [])):
        table.add_column(head, no_wrap=head in ("at", "claim"))
    for it in found:
        after = Text(f"{it.before} → {it.after}", style=STYLES.get(it.after, ""))
        claim = _without_table(it.claim)
        where = [it.machine or "any"] if machines else []
        table.add_row(short(history.runs[it.run]), claim, it.what, after, *where)
    console.print(table)


def _without_table(claim: str) -> str:
    return claim.removeprefix("queries/").removeprefix("operations/")


def _claim(
    history: History, name: str, shown: Sequence[int], found: list[Change], wide: bool
) -> Table:
    """A row per run, a column per figure; below each column how it went."""
    table = _headed(history, name)
    table.show_footer = True
    table.add_column("verdict", no_wrap=True)
    lines = {it: series(history, name, it) for it in MEASURES}
    lines = {it: each for it, each in lines.items() if each}
    for measure, each in lines.items():
        newest = max(each, key=lambda it: it.at[-1])
        spark = sparkline([dict(zip(newest.at, newest.values, strict=True)).get(k) for k in shown])
        table.add_column(MEASURES[measure].title, footer=spark, justify="right")
    for k in shown:
        claim = history.runs[k]["claims"].get(name)
        if claim is None:
            continue
        changed = {it.what for it in found if it.run == k and it.claim == name}
        cells = [_figure(measure, each, claim, k, wide) for measure, each in lines.items()]
        table.add_row(*_head(history, k), _verdict(claim, changed), *cells)
    return table


def _verdict(claim: dict[str, Any], changed: set[str]) -> Text:
    text = Text()
    for key, what in OUTCOMES.items():
        if key in claim:
            mark = MARKS.get(claim[key], claim[key]) + ("≠" if what in changed else " ")
            text.append(f"{mark} ", style=STYLES.get(claim[key], ""))
    return text


def _figure(measure: str, lines: list[Series], claim: dict[str, Any], run: int, wide: bool) -> Text:
    """A figure with its interval or, where it is not comparable, in gray; marked where it steps."""
    it = MEASURES[measure]
    value = it.value(claim)
    if value is None:
        return Text("–", style="dim")
    text = Text(f"{round(value, 3) + 0:.3f}" if it.slope else f"{value:,.5g}")
    bounds = it.bounds(claim)
    if bounds and wide and not it.exact:
        text.append(f" [{bounds[0]:.2f}, {bounds[1]:.2f}]", style="dim")
    if not any(run in line.at for line in lines):
        text.stylize("dim")
    for line in lines:
        for step in line.steps:
            if line.at[step.index] == run:
                text.append(_mark(measure, step.before, step.after), style="bold yellow")
    return text


def _mark(measure: str, before: float, after: float) -> str:
    arrow = " ▲" if after > before else " ▼"
    if MEASURES[measure].slope:
        return f"{arrow}{after - before:+.2f}"
    return arrow + (f"{after / before - 1:+.1%}" if before else "")


def _glance(history: History, names: list[str], shown: Sequence[int], found: list[Change]) -> Table:
    """A row per claim: how its figures went, where they are now, and when they changed last."""
    table = Table(title=f"{len(names)} claims in {history.path}", pad_edge=False)
    table.add_column("claim", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    for head in ("work or bytes", "time"):
        table.add_column(head, no_wrap=True)
    table.add_column("changed", min_width=10, no_wrap=True)
    for name in names:
        work = series(history, name, "bytes") or series(history, name, "work")
        cells = [_course(it, shown) for it in (work, series(history, name, "time"))]
        mine = [it for it in found if it.claim == name and it.what != OUTCOMES["outcome_time"]]
        at = list(dict.fromkeys(short(history.runs[it.run]) for it in mine))
        changed = (at[-1] if at else "") + (f" +{len(at) - 1}" if len(at) > 1 else "")
        newest = next(it["claims"][name] for it in reversed(history.runs) if name in it["claims"])
        claim = _without_table(name)
        table.add_row(claim, _verdict(newest, set()), *cells, changed)
    return table


def _course(lines: list[Series], shown: Sequence[int]) -> Text:
    if not lines:
        return Text("–", style="dim")
    line = max(lines, key=lambda it: it.at[-1])
    values = dict(zip(line.at, line.values, strict=True))
    return Text(f"{sparkline([values.get(k) for k in shown])} {line.values[-1]:,.5g}")


def sparkline(values: Sequence[float | None]) -> str:
    """A bar per value between the lowest and the highest; a gap where there is none.

    Values within 2 % of each other are drawn level, as they are.
    """
    there = [value for value in values if value is not None]
    if not there:
        return ""
    low, high = min(there), max(there)
    flat = high - low <= 0.02 * max(abs(low), abs(high), 1e-9)
    span = (high - low) or 1.0
    top = len(BARS) - 1
    bars = [
        " " if value is None else BARS[3] if flat else BARS[round(top * (value - low) / span)]
        for value in values
    ]
    return "".join(bars)


def _legend(history: History, brief: bool) -> str:
    machines = {it["machine"]["id"]: it["machine"] for it in history.runs}
    text = "✓ consistent, ✗ violated, ? undetermined; first by work, which decides, then by time. "
    if brief:
        text += "Verdicts changed: by work + by time. "
    else:
        text += "≠ not the verdict before, ▲▼ a step to a new level. "
    text += "* with changes that were not committed."
    told = "; ".join(
        f"{key}: {it.get('cores')} cores of {it.get('cpu')}" for key, it in machines.items()
    )
    text += "\nWork: elements accessed; bytes: per vertex; time: in memory accesses."
    text += f"\nMachine {told}. {_profiles(history)}"
    if len(machines) > 1:
        text += (
            "\nWork, bytes and verdicts by work are compared between the machines, times are not: "
            "each machine has its own; --machine shows one."
        )
    return text


def _profiles(history: History) -> str:
    names = list(dict.fromkeys(it["profile"] for it in history.runs))
    if len(names) == 1:
        return f"Preset {names[0]}."
    return "Runs of different profiles are not compared; --profile shows one."


def as_json(history: History, names: list[str], last: int | None) -> dict[str, Any]:
    """Everything that is shown; ``at`` and ``run`` are indices into ``runs``."""
    first = len(history.runs) - min(last or len(history.runs), len(history.runs))
    heads = [
        {key: value for key, value in run.items() if key != "claims"} | {"index": k}
        for k, run in enumerate(history.runs)
    ]
    return {
        "file": str(history.path),
        "faults": history.faults,
        "runs": heads,
        "series": [
            asdict(line) for name in names for it in MEASURES for line in series(history, name, it)
        ],
        "changes": [
            {**asdict(it), "commit": history.runs[it.run]["commit"]}
            for it in changes(history, names)
            if it.run >= first
        ],
    }
