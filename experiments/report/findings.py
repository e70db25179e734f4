"""How findings are told: in a terminal, as JSON, and for a pull request."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from itertools import groupby
from typing import Any

from rich.console import Console
from rich.markup import escape

from experiments.regression import Change, Finding, exit_code
from experiments.report.tables import markdown_rows
from structures import NAMED

TITLES = {
    Change.WORSE: ("Worse", "red"),
    Change.UNDETERMINED: ("Cannot be told", "yellow"),
    Change.BETTER: ("Better", "green"),
}
"""What is told of, in the order that a reader needs it, and its color; the rest is counted."""

MOST = 40  # findings of one title that a terminal and a pull request show; JSON has all
WIDTH = 42  # columns of the case in a line of a terminal

SUMMARY = {
    0: "Nothing got worse.",
    1: "Something got worse.",
    2: "Too much of it cannot be told, so this is no pass.",
}
"""What the exit codes mean."""
PASSED_SO_FAR = "Nothing got worse, as far as can be told."


def summary(findings: Sequence[Finding]) -> str:
    """What the exit code means, and of a pass that a part of it is open, where one is."""
    code = exit_code(findings)
    left_open = any(it.change == Change.UNDETERMINED for it in findings)
    return PASSED_SO_FAR if left_open and code == 0 else SUMMARY[code]


def show(findings: Sequence[Finding], notes: Sequence[str], console: Console) -> None:
    """Print what is not as before, worst first, a line each under its claim; then the counts."""
    for title, color, chosen in _by_change(findings):
        console.print(f"[bold {color}]{title}: {len(chosen):,}[/]")
        for claim, part in groupby(chosen[:MOST], lambda finding: finding.claim):
            lines = [f"[dim]{escape(claim)}[/]"] if claim else []
            console.print(*lines, *(escape(line(it)) for it in part), sep="\n", highlight=False)
        if len(chosen) > MOST:
            console.print(f"  … and {len(chosen) - MOST:,} more; all of them with --json")
    last = [f"Note: {note}" for note in notes] + [f"Compared: {count_same(findings)}"]
    if any(finding.change == Change.BETTER for finding in findings):
        last.append("What got better becomes the baseline with: hem baseline update")
    last += [f"Next: {it}" for it in dict.fromkeys(it.next for it in findings if it.next)]
    console.print(escape("\n".join(last)), highlight=False)
    console.print(f"[bold]{summary(findings)}[/]")


def line(finding: Finding) -> str:
    """One line: the kind, the case with its structure abbreviated, and what changed."""
    case = finding.case
    if case.structure in NAMED:
        case = case._replace(structure=NAMED[case.structure].abbreviation, experiment="")
    where = f"{case} {finding.axis}".strip()
    return f"  {finding.kind:<5} {where:<{WIDTH}} {finding.difference}"


def count_same(findings: Sequence[Finding]) -> str:
    """How many of each kind, and of claims by who claims them, and how many are as before."""
    named = [(" ".join((it.kind, it.claimed)).strip(), it.change) for it in findings]
    every = Counter(kind for kind, _ in named)
    same = Counter(kind for kind, change in named if change == Change.SAME)
    parts = (f"{kind} {same[kind]:,} of {count:,}" for kind, count in every.items())
    return ("as before are " + ", ".join(parts)) if every else "nothing"


def as_json(findings: Sequence[Finding], notes: Sequence[str]) -> dict[str, Any]:
    """All findings that are not as before, how many there are of each, and the exit code."""
    return {
        "code": exit_code(findings),
        "counts": dict(Counter(finding.change for finding in findings)),
        "notes": list(notes),
        "findings": [
            {**asdict(it), "outcome": it.change, "where": it.where, "case": it.case._asdict()}
            for it in findings
            if it.change != Change.SAME
        ],
    }


def as_markdown(findings: Sequence[Finding], notes: Sequence[str]) -> str:
    """A summary for a pull request: a table for each title."""
    parts = [f"## hem check: {summary(findings)}", f"Compared: {count_same(findings)}."]
    for title, _, chosen in _by_change(findings):
        rows = [["what", "where", "before", "after", "claim"]]
        for it in chosen[:MOST]:
            after = f"{it.after} ({it.why})" if it.why else it.after
            cells = it.kind, f"`{it.where}`", it.before, after.strip(), it.claim
            rows.append([cell.replace("|", "\\|") for cell in cells])
        parts += [f"### {title}: {len(chosen):,}", markdown_rows(rows)]
        if len(chosen) > MOST:
            parts.append(f"… and {len(chosen) - MOST:,} more.")
    return "\n\n".join([*parts, "\n".join(f"- {note}" for note in notes)]).rstrip() + "\n"


def _by_change(findings: Sequence[Finding]) -> Iterator[tuple[str, str, list[Finding]]]:
    for change, (title, color) in TITLES.items():
        if chosen := [it for it in findings if it.change == change]:
            yield title, color, chosen
