"""The verdict board: every claim on one list, to filter and to search, with what it rests on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from html import escape
from pathlib import Path

from experiments.claims.growth import NO_CLAIM, VARIABLES
from experiments.claims.judged import OUTCOMES
from experiments.report.claim_figures import MEASURES
from experiments.report.entries import FOLDER, KINDS, Entry, Plot
from hem.complexity.judge import Verdict
from structures import NAMED


def board(entries: list[Entry], chapters: dict[str, str]) -> str:
    """All claims. Without scripts all of them are shown, and unfold one by one."""
    rows = "".join(_entry(it, chapters) for it in entries)
    return (
        f'<form class="filters" id="filters" role="search" hidden>{_search()}{_filters(entries)}'
        f'</form><p id="shown" class="soft" role="status">{len(entries)} claims</p>'
        f'<div id="board">{rows}</div>'
        '<p id="none" hidden>No claim is like that. <button type="button" id="all">Show all'
        "</button></p>"
    )


def write_files(entries: Iterable[Entry], folder: Path) -> None:
    """Write the plots and the data of every claim to the folder that the board links to."""
    (folder / FOLDER).mkdir()
    for entry in entries:
        (folder / FOLDER / f"{entry.file}.csv").write_text(entry.data, "utf-8")
        for plot in entry.plots:
            path = folder / FOLDER / f"{entry.file}.{plot.name}.svg"
            path.write_text(plot.drawing, "utf-8")


def _search() -> str:
    return (
        '<p><label for="search">Search the claims</label>'
        '<input type="search" id="search" autocomplete="off" '
        'placeholder="half-edge collapse, chapter 4.1, O(n_ev)"></p>'
    )


def _filters(entries: list[Entry]) -> str:
    """A group of buttons each for outcome, structure and table, with how many there are of each."""
    structures = list(dict.fromkeys(it.structure for it in entries if it.structure))
    groups = {
        "outcome": {it: f"{mark} {it}" for it, mark in OUTCOMES.items()},
        "structure": {it: str(NAMED[it].title) for it in structures},
        "kind": dict(KINDS),
    }
    names = {"outcome": "Verdict", "structure": "Structure", "kind": "Table"}
    shown = []
    for group, choices in groups.items():
        counts = Counter(getattr(it, group) for it in entries)
        buttons = "".join(
            f'<button type="button" aria-pressed="false" data-group="{group}" '
            f'data-value="{escape(value)}">{escape(title)} <span>{counts[value]}</span></button>'
            for value, title in choices.items()
        )
        shown.append(
            f'<div role="group" aria-label="{names[group]}"><b>{names[group]}</b>{buttons}</div>'
        )
    return "".join(shown)


def _entry(entry: Entry, chapters: dict[str, str]) -> str:
    css = entry.outcome.replace(" ", "-")
    about = escape(entry.structure_title or "in a sentence")
    mark = f'<b class="mark" title="{entry.outcome}">{OUTCOMES[entry.outcome]}</b>'
    claimed = "" if entry.claimed == NO_CLAIM else f"claimed {entry.claimed}, "
    found = f'<span class="found">{escape(f"{claimed}found {entry.found}")}</span>'
    time = (
        f" · time: {entry.outcome_time}"
        if entry.outcome_time and entry.outcome_time != entry.outcome
        else ""
    )
    return (
        f'<details class="entry {css}" id="{entry.key}" data-outcome="{entry.outcome}" '
        f'data-structure="{entry.structure}" data-kind="{entry.kind}">'
        f'<summary>{mark}<span class="what">{escape(entry.title)}</span>'
        f'<span class="who">{about}</span>{found}'
        f'<span class="outcome">{entry.outcome}{time}</span></summary>'
        f"{_body(entry, chapters)}</details>\n"
    )


def _body(entry: Entry, chapters: dict[str, str]) -> str:
    link = f'<a href="{FOLDER}/{escape(entry.file)}.csv">the data (CSV)</a>'
    if entry.chapter in chapters:
        link += f' · <a href="{entry.chapter}.html">{escape(chapters[entry.chapter])}</a>'
    here = f'<a href="#{entry.key}">link to this claim</a>'
    return (
        f'<div class="body"><p class="words">{escape(entry.words)} '
        f'<span class="source">({escape(entry.source)})</span></p>'
        f'<div class="plots">{"".join(_plot(entry, it) for it in entry.plots)}</div>'
        f'{_reasons(entry)}<p class="soft files">{link} · {here}</p></div>'
    )


def _plot(entry: Entry, plot: Plot) -> str:
    alt = f"{entry.title}, {entry.structure_title}: {plot.title}; {plot.caption}"
    return (
        f'<figure><img loading="lazy" src="{FOLDER}/{escape(entry.file)}.{plot.name}.svg" '
        f'alt="{escape(alt)}"><figcaption><b>{escape(plot.title)}</b> '
        f"{escape(plot.caption)}</figcaption></figure>"
    )


def _reasons(entry: Entry) -> str:
    """Why each verdict is what it is, as a table."""
    if not entry.verdicts:
        return ""
    claimed = entry.claimed != NO_CLAIM
    rows = "".join(
        f"<tr><th>{MEASURES[measure][0]} in {VARIABLES[variable]}</th>"
        f"<td>{_outcome(verdict, claimed)}</td><td>{escape(verdict.reason)}</td></tr>"
        for (measure, variable), verdict in entry.verdicts.items()
    )
    return f'<div class="wide"><table class="reasons"><tbody>{rows}</tbody></table></div>'


def _outcome(verdict: Verdict, claimed: bool) -> str:
    return f"{OUTCOMES[verdict.outcome]} {verdict.outcome}" if claimed else "–"
