"""HTML from the templates: whole pages, the claim browser, and the tables that chapters show."""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from html import escape
from importlib.resources import files
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from experiments.claims import SENTENCES, JudgedClaim, Kind, Outcome, curves
from experiments.claims.errata import Erratum
from experiments.harness import Axis, Table
from experiments.report import session
from experiments.report import tables as written
from experiments.report.notebooks import page_titles
from experiments.runs import Run, in_words, tables
from structures import NAMED

Heads = Mapping[str, Callable[[Any], str]]
"""What stands above the columns of a table of numbers, and how their values are written."""


class Html(Markup):
    """A piece of a page, which notebooks show as it is."""

    def _repr_html_(self) -> str:
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
        "outcome_of": {mark: it.css for it in Outcome for mark in (it.mark, it.own)}.get,
        "heads": lambda columns: ["", *(NAMED[it].title for it in columns)],
        "link": session.link,
        "claim_link": session.claim_link,
        "claim_file": lambda judged: f"{session.CLAIMS}/{session.claim_file(judged)}",
        "static": lambda name: Html((files("experiments.report") / "static" / name).read_text()),
    }
    environment.filters |= {
        "time": written.duration, "two_digits": written.two_digits, "spelled": written.spelled,
    }  # fmt: skip
    environment.filters["where"] = lambda source: re.split("[:;]|, (?!abstract|table)", source)[0]
    return environment


def page(template: str, **content: Any) -> Html:
    """A whole page, or a part of one, from a template."""
    return Html(_templates().get_template(template).render(**content))


def table(macro: str, *content: Any) -> Html:
    """A table by the name of its macro in ``tables.html.j2``."""
    module: Any = _templates().get_template("tables.html.j2").module
    return Html(getattr(module, macro)(*content))


def browser(shown: session.Session) -> Html:
    """Every claim with what it rests on, to filter and to search; without scripts just unfolded."""
    facts = {"claims": shown.claims, "printed": shown.printed, "tables": groups_of_claims()}
    return page("claim_browser.html.j2", filters=filters(shown.claims), **facts)


def groups_of_claims() -> dict[str, Table]:
    """The tables, and the sentences."""
    return {**tables(), SENTENCES: Table(SENTENCES, "In sentences", {}, "half_edge_or_indexed")}


def filters(claims: Sequence[JudgedClaim]) -> dict[str, dict[str, tuple[str, int]]]:
    """By group the choices: value -> its title, and how many claims it has."""
    facts = [(it.outcome.value, it.claim.kind, it.claim.structure, it.claim.table) for it in claims]
    outcomes, claimants, structures, kinds = map(Counter, zip(*facts, strict=True))
    return {
        "claimed": {it.value: (it.value, claimants[it]) for it in Kind},
        "outcome": {it.value: (f"{it.mark} {it.value}", outcomes[it.value]) for it in Outcome},
        "structure": {name: (NAMED[name].title, structures[name]) for name in structures if name},
        "kind": {name: (it.title, kinds[name]) for name, it in groups_of_claims().items()},
    }


def verdicts(claims: Iterable[JudgedClaim], name: str) -> Html:
    """A table of claims at a glance: what is printed, and whether it holds."""
    return table("verdicts", *written.by_subject(claims, name))


def slopes(claims: Iterable[JudgedClaim], name: str) -> Html:
    """The same with the slopes along every axis, their intervals, and what a query costs."""
    measured = curves(session.open_run().run)
    return table("slopes", *written.by_subject(claims, name), list(Axis), measured)


def sentences(claims: Iterable[JudgedClaim], kind: str) -> Html:
    """The sentences of a kind, what was measured of them, and the verdicts."""
    mine = [it for it in claims if it.claim.table == SENTENCES and it.claim.kind == kind]
    return table("sentences", mine)


def tally(claims: Iterable[JudgedClaim]) -> Html:
    """How many claims of each kind came out how."""
    heads, *rows = written.tally_rows(claims)
    return table("words", heads, rows, "glance")


def legend() -> Html:
    """How the cells of tables are to be read."""
    return table("legend", written.legend())


def claim_tables(claims: Collection[JudgedClaim]) -> Html:
    """Every table at a glance, each under its title."""
    shown = each_table(claims, verdicts, '<p class="missing">{}</p>')
    return Html("\n".join(f"<h3>{escape(title)}</h3>{text}" for title, text in shown.items()))


def each_table(
    claims: Collection[JudgedClaim], how: Callable[[Any, str], str], otherwise: str
) -> dict[str, str]:
    """By title every table that claims are cells of, or a word on why it is not there."""
    named = {it.claim.table for it in claims if it.claim.structure}
    every = ((name, it.title) for name, it in tables().items() if name in named)
    return {title: or_missing(partial(how, claims, name), otherwise) for name, title in every}


def reasons(claims: Iterable[JudgedClaim], name: str) -> Html:
    """Why time leaves claims of a table undetermined."""
    rows = [
        (it.claim.title, NAMED[it.claim.structure].title, axis.label, verdict.reason)
        for it in claims
        if it.claim.table == name and it.claim.claims_something
        for axis, verdict in it.verdicts.items()
        if not axis.exact and verdict.outcome == Outcome.UNDETERMINED.value
    ]
    return text_table(["Query", "Structure", "Axis", "Reason"], rows)


def errata(every: Iterable[Erratum]) -> Html:
    """What is published, what it does, and what a run of it gave beside the corrected version."""
    return table("errata", [(it, it.show(), number) for number, it in enumerate(every, start=1)])


def about_run(run: Run) -> Html:
    """What was run where, and which cases were skipped, by reason."""
    return table("about_run", in_words(run), Counter(run.skipped["skipped"]))


def chapter_list() -> Html:
    """The chapters, to choose from."""
    return table("chapter_list", page_titles())


def or_missing(part: Callable[[], str], otherwise: str) -> str:
    """A part of a page, or a word on why it is not there."""
    try:
        return part()
    except session.MissingError as missing:
        return otherwise.format(escape(str(missing), quote=False))


def numbers(rows: Iterable[Sequence[Any]], heads: Heads) -> Html:
    """A table of numbers below their heads. Raises MissingError where there is no row."""
    written = [[how(it) for it, how in zip(row, heads.values(), strict=True)] for row in rows]
    if not written:
        raise session.MissingError("This run has not measured what would stand here.")
    return table("numbers", list(heads), written)


text_table = partial(table, "words")
"""A table of words below their heads: ``text_table(heads, rows)``."""


def frame_table(frame: pd.DataFrame) -> Html:
    """A table of what is text already. Raises MissingError where there is no row."""
    return numbers(frame.to_numpy(), dict.fromkeys(frame.columns, str))


@dataclass(frozen=True)
class Answer:
    """An answer of the front page, also in German; if not ``measured``, it says what is missing."""

    text: str
    german: str
    rests: Mapping[str, str]
    measured: bool

    def _repr_html_(self) -> str:
        return str(table("answer", self.text, self.measured, self.rests))


def answer(
    text: str, german: str, rests: Mapping[str, str], needs: Sequence[float], missing: str
) -> Answer:
    """An answer with its links, or ``missing`` where a number is."""
    measured = all(value == value for value in needs)  # nan where nothing was measured
    german = written.german_numbers(german) if measured else "Dieser Lauf hat das nicht gemessen."
    return Answer(text if measured else missing, german, rests, measured)


def abstract(answers: Iterable[Answer]) -> Html:
    """The same answers in German."""
    return table("abstract", [it.german for it in answers])


def closing(claims: Iterable[JudgedClaim], points: Mapping[str, Sequence[str]]) -> Html:
    """What a chapter comes to, sentence by sentence, each with the claims that it rests on.

    ``points``: by sentence the keys of claims that must be consistent, or with "not " before them
    violated. Where the run says something else, so does the page. Braces in a sentence are what was
    found of these claims. Raises KeyError for a claim that there is none of.
    """
    judged = {it.claim.key: it for it in claims}
    rows = []
    for text, keys in points.items():
        rests = [judged[key.removeprefix("not ")] for key in keys]
        denied = [key.startswith("not ") for key in keys]
        expected = [Outcome.VIOLATED if it else Outcome.CONSISTENT for it in denied]
        follows = [it.outcome for it in rests] == expected
        rows.append((text.format(*(it.found for it in rests)), follows, rests))
    return table("closing", rows)
