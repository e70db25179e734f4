"""Rows as a table for a terminal, in 80 columns, or in Markdown; and so the tables of claims."""

from collections import Counter
from collections.abc import Iterable, Sequence
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.markup import escape

from experiments.claims import (
    CLAIMED,
    NO_CLAIM,
    NOT_POSSIBLE,
    SENTENCES,
    JudgedClaim,
    Kind,
    Outcome,
    class_told,
    judge_run,
    tally,
)
from experiments.harness import QUERIES_TABLE
from experiments.report import rows as plain
from experiments.report.rows import two_digits
from experiments.report.session import MissingError
from experiments.runs import Run, load, noise, resume_command, tables
from structures import NAMED, NAMES, THESIS

COLORS = {
    **{f"[{it.mark}{it.own}]": it.color for it in Outcome if it is not Outcome.NO_CLAIM},
    rf"^({NO_CLAIM}|{NOT_POSSIBLE}).*": Outcome.NO_CLAIM.color,
    "[▲▼][^ ]+|≠": "bold yellow",
}
"""What is colored in a terminal, as regular expressions."""

MEASURES = {"decides": "work, bytes, value", "time": "time in order", "random": "time at random"}
"""The heads of a tally; what is exact decides."""

SHOWN = Outcome.CONSISTENT, Outcome.VIOLATED, Outcome.UNDETERMINED


def legend() -> list[str]:
    """How to read a cell, in lines: the order of its marks, and whose claim they stand for."""
    words = ", ".join(f"{it.mark} {it.value}" for it in SHOWN)
    marks = {kind: " ".join(kind.marks([it]) for it in SHOWN) for kind in CLAIMED}
    whose = "; ".join(f"{marks[kind]} {kind.about}" for kind in CLAIMED)
    return [
        "Each cell has what is claimed, and its marks: by work (memory accesses), by time in order "
        "(by valence: at random in a mesh that is no larger; of operations: far apart), and for "
        "queries by time at random. Work is exact, and it decides.",
        f"{words}. Whose claim it is: {whose}.",
        f"{NO_CLAIM} {Kind.NOBODY.about}. Near a class: the costs do not tell which, and that one "
        f"comes closest. {NOT_POSSIBLE}: table 1 prints this where a structure records no edges; "
        "what was found is the cost with the edge named by its two vertices.",
        "n_t is the number of triangles, n_ev that of the edges at a vertex.",
    ]


def tally_rows(claims: Iterable[JudgedClaim]) -> list[list[str]]:
    """How many claims of each kind came out how, the heads first: in tables, then in sentences."""
    every = [it for it in claims if it.claim.claims_something]
    rows = [["", "claims", *MEASURES.values()]]
    for kind in CLAIMED:
        of_kind = [it for it in every if it.claim.kind is kind]
        for place, inside in (("in tables", False), ("in sentences", True)):
            if mine := [it for it in of_kind if (it.claim.table == SENTENCES) == inside]:
                counts = tally(mine)
                timed = [counts.pop((kind, it), Counter()) for it in list(MEASURES)[1:]]
                decides = sum(counts.values(), Counter[Outcome]())
                cells = [_counted(kind, it) for it in (decides, *timed)]
                rows.append([f"{kind.value}, {place}", str(len(mine)), *cells])
    return rows


def table_1_in_words(claims: Iterable[JudgedClaim]) -> str:
    """What became of the cells that table 1 prints, by what is counted and by time."""
    in_table = [it for it in claims if it.claim.table == QUERIES_TABLE.name]
    cells = [it for it in in_table if it.claim.claimant is Kind.PRINTED]
    outcomes = Counter(it.outcome for it in cells)
    counts = ", ".join(f"{outcomes[it]} {it.value}" for it in SHOWN if outcomes[it])
    timed = []
    for way, order in (("time", "in order"), ("random", "at random")):
        seen = Counter(it.outcomes[way] for it in cells if it.outcomes)
        holds, violated, undetermined = (seen[it] for it in SHOWN)
        found = f"{violated} violated and {undetermined} undetermined"
        timed.append(f"{order} {holds} of {seen.total()} cells are consistent, {found}")
    return (
        f"Of the {len(cells)} cells that table 1 of the thesis prints, work and bytes find "
        f"{counts}. By time {'; '.join(timed)}."
    )


def _counted(kind: Kind, counts: Counter[Outcome]) -> str:
    """Such as ``33 ✓ 3 ✗``."""
    return " ".join(f"{counts[it]} {kind.marks([it])}" for it in SHOWN if counts[it])


show_rows = partial(plain.show_rows, colors=COLORS)


def markdown_rows(rows: Iterable[Sequence[str]]) -> str:
    """A table for a page in Markdown; rows: its heads first."""
    heads, *body = rows
    return "\n".join(f"| {' | '.join(it)} |" for it in (heads, ["---"] * len(heads), *body))


def by_subject(
    claims: Iterable[JudgedClaim], name: str
) -> tuple[list[str], dict[str, dict[str, JudgedClaim]]]:
    """A table's measured structures; title -> structure -> claim. MissingError: there are none."""
    mine = [it for it in claims if it.claim.table == name and it.claim.structure]
    columns = list(dict.fromkeys(it.claim.structure for it in mine if it.was_measured))
    if not columns:
        raise MissingError("This run has measured nothing of this table.")
    rows: dict[str, dict[str, JudgedClaim]] = {}
    for it in mine:
        if it.claim.structure in columns:
            rows.setdefault(it.claim.title, {})[it.claim.structure] = it
    return columns, rows


def abbreviations(names: Iterable[str] = NAMES) -> str:
    """What the short name of each of these structures stands for, where it is not the title."""
    pairs = ((NAMED[it].abbreviation, NAMED[it].title) for it in names)
    return ", ".join(f"{short}: {title}" for short, title in pairs if short != title)


def show_claims(
    run_folder: Path, console: Console, every: bool = False, slopes: bool = False
) -> None:
    """Print the claims of a run and their verdicts: of the thesis' four structures, or of all."""
    run = load(run_folder)
    claims = _shown_claims(run, every)
    unfinished = "" if "finished" in run.meta else ", not finished"
    about = f"preset {run.meta.get('preset')}{unfinished}"
    console.print(f"[bold]{escape(run.folder.name)}[/], {about}", highlight=False)
    for name, table in tables().items():
        if mine := [it for it in claims if it.claim.table == name]:
            console.print(f"\n[bold]{table.title}[/]", highlight=False)
            if slopes:
                _show_slopes(console, mine)
            else:
                columns, rows = by_subject(mine, name)
                heads = ["", *(NAMED[it].abbreviation for it in columns)]
                shown = [[it, *(_cell(row.get(at)) for at in columns)] for it, row in rows.items()]
                show_rows(console, [heads, *shown])
            console.print(_summary(mine), highlight=False)
    if (seen := noise(run)).too_busy:
        console.print(f"[yellow]{seen.words}[/]", highlight=False)
    console.print("\n[bold]Who claims what, of all structures[/]")
    show_rows(console, tally_rows(judge_run(run)))
    of = {it.claim.structure for it in claims if not slopes}
    short = abbreviations(it for it in NAMED if it in of)
    words = [*legend(), f"{short}."] if short else legend()
    console.print(*words, sep="\n", style="dim", highlight=False)


def _shown_claims(run: Run, every: bool) -> list[JudgedClaim]:
    """What was measured of the thesis' structures, else of all. Raises MissingError for nothing."""
    if run.cases.empty:
        resume = resume_command(run.folder)
        raise MissingError(f"{run.folder} holds no case; resume it with: {resume}")
    measured = [it for it in judge_run(run) if it.claim.structure in NAMED and it.was_measured]
    if not measured:
        of_peers = (run.cases["experiment"] == "bench_peers").any()
        instead = "try --peers" if of_peers else "hem report shows what there is"
        raise MissingError(f"{run.folder} holds nothing of the tables: {instead}")
    return [it for it in measured if every or it.claim.structure in THESIS] or measured


def claims_as_json(run_folder: Path, every: bool = False) -> dict[str, Any]:
    """What ``show_claims`` prints, slopes included, as records; NaN where there is no number."""
    run = load(run_folder)
    about = {"run": run.folder.name, "preset": run.meta.get("preset")}
    about["finished"] = run.meta.get("finished")
    claims = [_record(it) for it in _shown_claims(run, every)]
    return {**about, "too_busy": bool(noise(run).too_busy), "claims": claims}


def _record(judged: JudgedClaim) -> dict[str, Any]:
    """A judged claim in words and numbers."""
    claim = judged.claim
    said = {key: getattr(claim, key) for key in ("key", "table", "title", "structure", "source")}
    said |= {"kind": claim.kind.value, "claimed": claim.printed, "outcome": judged.outcome.value}
    axes = []
    for axis, it in judged.verdicts.items():
        slopes = {key: float(getattr(it, key)) for key in ("slope", "slope_low", "slope_high")}
        outcome = it.outcome if claim.claims_something else Outcome.NO_CLAIM.value
        about = {"measure": axis.measure, "variable": axis.symbol, "outcome": outcome}
        about |= {"expected": it.expected, "bound": it.bound} if claim.claims_something else {}
        axes.append({**about, "found": class_told(it), **slopes})
    costs = {"accesses": float(judged.work), "seconds": float(judged.seconds)}
    return said | {"found": judged.found, "reason": judged.reason, "axes": axes} | costs


def _cell(judged: JudgedClaim | None) -> str:
    """What is claimed, its marks, and what was found where it differs."""
    if judged is None or judged.outcome is Outcome.NO_CLAIM:
        return f"{judged.claim.printed} {judged.found}" if judged and judged.was_measured else ""
    found = "" if judged.outcome is Outcome.CONSISTENT else f" {judged.found}"
    return f"{judged.claim.printed} {judged.marks}{found}"


def _show_slopes(console: Console, claims: Sequence[JudgedClaim]) -> None:
    """By structure a line per claim and axis: both slopes, the class found, the verdict."""
    for structure in dict.fromkeys(judged.claim.structure for judged in claims):
        rows = [("", "raw slope", "memory out", "interval", "claimed", "found", "")]
        for judged in (it for it in claims if it.claim.structure == structure):
            for axis, it in judged.verdicts.items():
                low, high = two_digits(it.slope_low), two_digits(it.slope_high)
                slopes = two_digits(it.raw_slope), two_digits(it.slope), f"{low}…{high}"
                claimed = judged.claim.claims_something
                outcome = Outcome(it.outcome) if claimed else Outcome.NO_CLAIM
                bound = f"{'≤ ' if it.bound == 'upper' else ''}{it.expected}" if claimed else ""
                title = f"{judged.claim.title}, {axis.measure} {axis.symbol}"
                mark = judged.claim.kind.marks([outcome])
                rows.append((title, *slopes, bound, class_told(it), mark))
        if len(rows) > 1:
            show_rows(console, rows, NAMED[structure].title, numbers=["raw slope", "memory out"])


def _summary(claims: Sequence[JudgedClaim]) -> str:
    """A line per kind of claim: by which measure how many came out how."""
    lines: dict[Kind, list[str]] = {}
    for (kind, measure), counts in tally(claims).items():
        lines.setdefault(kind, []).append(f"{measure} {_counted(kind, counts)}")
    return "\n".join(f"{kind.value}: {', '.join(lines[kind])}" for kind in CLAIMED if kind in lines)


def duration(seconds: float) -> str:
    """A time with two digits that count: 3.1 µs, 250 ms."""
    if seconds != seconds:
        return "–"
    units = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"))
    size, unit = next((it for it in units if seconds >= 0.995 * it[0]), units[-1])
    return f"{digits(seconds / size)} {unit}"


def digits(value: float, count: int = 2) -> str:
    """So many digits that count, without powers: 0.036, 5.1, 64, 12,000."""
    if not 0 < abs(value) < float("inf"):
        return "0" if value == 0 else "–"
    return f"{Decimal(f'{value:#.{count}g}'):,f}"


def count(value: float) -> str:
    """A whole number: 12,000; a dash where there is none."""
    return f"{value:,.0f}" if value == value else NO_CLAIM


def spelled(name: str) -> str:
    """A name of a record or a field as one writes it."""
    return name.replace("half_edge", "half-edge").replace("_", " ")
