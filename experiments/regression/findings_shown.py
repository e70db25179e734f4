"""How `hem check` tells what it found: for a terminal, as JSON, and for a pull request."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rich.console import Console
from rich.markup import escape

from experiments.regression.findings import TITLES, Finding, Outcome, code

COLORS: dict[Outcome, str] = {"worse": "red", "undetermined": "yellow", "better": "green"}

MOST = 40
"""Findings of one outcome that a terminal and a pull request show; JSON has all."""

SUMMARY = {
    0: "Nothing got worse.",
    1: "Something got worse.",
    2: "Too much of it cannot be told, so this is no pass.",
}
"""What the exit codes mean."""


def show(findings: Sequence[Finding], notes: Sequence[str], console: Console) -> None:
    """Print what is not as before, worst first, and the counts of all."""
    for outcome, title, chosen in _chosen(findings):
        console.print(f"[bold {COLORS[outcome]}]{title}: {len(chosen):,}[/]")
        for it in chosen[:MOST]:
            console.print(f"  {escape(str(it))}", highlight=False, soft_wrap=True)
        if len(chosen) > MOST:
            console.print(f"  … and {len(chosen) - MOST:,} more; all of them with --json")
    for note in notes:
        console.print(f"Note: {escape(note)}", highlight=False, soft_wrap=True)
    console.print(f"Compared: {counts(findings)}", highlight=False, soft_wrap=True)
    if any(it.outcome == "better" for it in findings):
        console.print("What got better becomes the reference with: hem reference update")
    console.print(f"[bold]{SUMMARY[code(findings)]}[/]")


def counts(findings: Sequence[Finding]) -> str:
    """How many of each kind, and how many of them are as before."""
    every = Counter(it.kind for it in findings)
    same = Counter(it.kind for it in findings if it.outcome == "same")
    parts = (f"{kind} {same[kind]:,} of {count:,}" for kind, count in every.items())
    return ("as before are " + ", ".join(parts)) if every else "nothing"


def as_json(findings: Sequence[Finding], notes: Sequence[str]) -> dict[str, Any]:
    """All findings that are not as before, how many there are of each, and the exit code."""
    return {
        "code": code(findings),
        "counts": dict(Counter(it.outcome for it in findings)),
        "notes": list(notes),
        "findings": [asdict(it) for it in findings if it.outcome != "same"],
    }


def as_markdown(findings: Sequence[Finding], notes: Sequence[str]) -> str:
    """A summary for a pull request: a table for each outcome but "as before"."""
    lines = [f"## hem check: {SUMMARY[code(findings)]}", "", f"Compared: {counts(findings)}.", ""]
    for _, title, chosen in _chosen(findings):
        lines += [f"### {title}: {len(chosen):,}", "", "| what | where | before | after | claim |"]
        lines += ["|---|---|---|---|---|"]
        for it in chosen[:MOST]:
            after = " ".join(part for part in (it.after, f"({it.why})" if it.why else "") if part)
            cases = it.kind, f"`{it.where}`", it.before, after, it.claim
            lines.append("| " + " | ".join(case.replace("|", "\\|") for case in cases) + " |")
        more = len(chosen) - MOST
        lines += [f"\n… and {more:,} more.", ""] if more > 0 else [""]
    return "\n".join([*lines, *(f"- {note}" for note in notes)]).rstrip() + "\n"


def _chosen(findings: Sequence[Finding]) -> list[tuple[Outcome, str, list[Finding]]]:
    found = [
        (outcome, title, [it for it in findings if it.outcome == outcome])
        for outcome, title in TITLES.items()
        if outcome != "same"
    ]
    return [it for it in found if it[2]]
