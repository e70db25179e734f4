"""HTML from the templates: whole pages, and the tables that chapters show."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, partial
from html import escape
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from experiments.claims import SENTENCES, JudgedClaim, Outcome
from experiments.claims.errata import Erratum
from experiments.harness import Axis
from experiments.report import session
from experiments.report.notebooks import page_titles
from experiments.runs import Run, in_words, tables
from structures import NAMED

Heads = Mapping[str, Callable[[Any], str]]
"""What stands above the columns of a table of numbers, and how their values are written."""


class Html(str):
    """A piece of a page, which notebooks show as it is."""

    def _repr_html_(self) -> str:
        return str(self)

    def __html__(self) -> str:
        return str(self)


@cache
def _templates() -> Environment:
    environment = Environment(
        loader=PackageLoader("experiments.report"), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.globals |= {
        "NAMED": NAMED,
        "Outcome": Outcome,
        "heads": lambda columns: ["", *(NAMED[it].title for it in columns)],
        "link": session.link,
        "claim_link": session.claim_link,
        "static": lambda name: Html((files("experiments.report") / "static" / name).read_text()),
    }
    environment.filters |= {"time": duration, "two_digits": two_digits}
    return environment


def page(template: str, **content: Any) -> str:
    """A whole page, or a part of one, from a template."""
    return _templates().get_template(template).render(**content)


def table(macro: str, *content: Any) -> Html:
    """A table by the name of its macro in ``tables.html.j2``."""
    module: Any = _templates().get_template("tables.html.j2").module
    return Html(getattr(module, macro)(*content))


def verdicts(claims: Iterable[JudgedClaim], name: str) -> Html:
    """A table of claims at a glance: what is printed, and whether it holds."""
    return table("verdicts", *by_subject(claims, name))


def slopes(claims: Iterable[JudgedClaim], name: str) -> Html:
    """The same with the slopes along every axis, their intervals, and what a query costs."""
    return table("slopes", *by_subject(claims, name), list(Axis))


def sentences(claims: Iterable[JudgedClaim]) -> Html:
    """What the documents say in sentences, what was measured of it, and the verdict."""
    return table("sentences", [it for it in claims if it.claim.table == SENTENCES])


def claim_tables(claims: Iterable[JudgedClaim]) -> Html:
    """Every table at a glance, each under its title."""
    parts = []
    for name, it in tables().items():
        if any(judged.claim.structure and judged.claim.table == name for judged in claims):
            parts.append(
                f"<h3>{escape(it.title)}</h3>{or_missing(partial(verdicts, claims, name))}"
            )
    return Html("\n".join(parts))


def reasons(claims: Iterable[JudgedClaim], name: str) -> Html:
    """Why time leaves claims of a table undetermined."""
    mine = (it for it in claims if it.claim.table == name)
    rows = [
        (it.claim.title, NAMED[it.claim.structure].title, axis.label, verdict.reason)
        for it in mine
        if it.outcome_time is Outcome.UNDETERMINED
        for axis, verdict in it.verdicts.items()
        if not axis.exact and verdict.outcome == it.outcome_time.value
    ]
    return table("words", ["Query", "Structure", "Axis", "Reason"], rows)


def errata(every: Iterable[Erratum]) -> Html:
    """What is published, what it does, and what a run of it gave beside the corrected version."""
    return table("errata", [(it, it.show(), number) for number, it in enumerate(every, start=1)])


def about_run(run: Run) -> Html:
    """What was run where, and which cases were skipped, by reason."""
    return table("about_run", in_words(run), Counter(run.skipped["skipped"]))


def chapter_list() -> Html:
    """The chapters, to choose from."""
    return table("chapter_list", page_titles())


def or_missing(part: Callable[[], str]) -> str:
    """A part of a page, or a word on why it is not there."""
    try:
        return part()
    except session.MissingError as missing:
        return f'<p class="missing">{escape(str(missing))}</p>'


def numbers(rows: Sequence[Sequence[Any]], heads: Heads) -> Html:
    """A table of numbers; ``heads``: what stands above a column, and how its values are written.

    Raises MissingError where there is no row.
    """
    if not rows:
        raise session.MissingError("This run has not measured what would stand here.")
    formatted = [[how(it) for it, how in zip(row, heads.values(), strict=True)] for row in rows]
    return table("numbers", list(heads), formatted)


def by_subject(
    claims: Iterable[JudgedClaim], name: str
) -> tuple[list[str], dict[str, dict[str, JudgedClaim]]]:
    """The columns and the rows of a table of claims: structures; title -> structure -> claim.

    A structure of which nothing was measured has no column. Raises MissingError if none is left.
    """
    mine = [it for it in claims if it.claim.table == name and it.claim.structure]
    columns = list(dict.fromkeys(it.claim.structure for it in mine if was_measured(it)))
    if not columns:
        raise session.MissingError("This run has measured nothing of this table.")
    rows: dict[str, dict[str, JudgedClaim]] = {}
    for it in mine:
        if it.claim.structure in columns:
            rows.setdefault(it.claim.title, {})[it.claim.structure] = it
    return columns, rows


def was_measured(judged: JudgedClaim) -> bool:
    """Whether a run has anything to say about a claim."""
    known = judged.bytes_per_vertex == judged.bytes_per_vertex  # not nan
    return bool(judged.verdicts) or len(judged.values) > 0 or known


def duration(seconds: float) -> str:
    """A time with two digits that count: 3.1 µs, 250 ms."""
    units = ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns"))
    size, unit = next((it for it in units if seconds >= 0.995 * it[0]), units[-1])
    return f"{digits(seconds / size)} {unit}"


def digits(value: float, count: int = 2) -> str:
    """So many digits that count, without powers: 0.036, 5.1, 64, 12,000."""
    if not 0 < abs(value) < float("inf"):
        return "0" if value == 0 else "–"
    rounded = float(f"{value:.{count - 1}e}")
    behind = count - 1 - int(f"{abs(rounded):e}".partition("e")[2])
    return f"{rounded:,.{max(behind, 0)}f}"


def two_digits(value: float) -> str:
    """A slope: 1.00, never -0.00."""
    return f"{round(value, 2) + 0:.2f}"


def answer(text: str, rests: Mapping[str, str], needs: Sequence[float], missing: str) -> Html:
    """One sentence of the front page with its links, or ``missing`` where a number is."""
    measured = all(value == value for value in needs)  # nan where nothing was measured
    return table("answer", text if measured else missing, measured, rests)
