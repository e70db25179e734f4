"""HTML from the templates: whole pages, the claim browser, and the tables that chapters show."""

import re
import tomllib
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import cache, partial
from html import escape
from importlib.resources import files
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from experiments.claims import DETERMINED, ERRATA, SENTENCES, JudgedClaim, Kind, Outcome, curves
from experiments.harness import Axis, Table
from experiments.report import session
from experiments.report import tables as written
from experiments.report.notebooks import page_titles
from experiments.report.rows import two_digits
from experiments.runs import experiments, in_words, tables
from structures import NAMED

Heads = Mapping[str, Callable[[Any], str]]
"""What stands above the columns of a table of numbers, and how their values are written."""


class Html(Markup):
    """A piece of a page, which notebooks show as it is."""

    rows: Sequence[Sequence[str]] = ()  # of a table of numbers its texts, the heads first

    def _repr_html_(self) -> str:
        return str(self)

    @property
    def markdown(self) -> str:
        """The same for a page in Markdown, which may hold HTML; of a table of numbers its rows."""
        return written.markdown_rows(self.rows) if self.rows else str(self)


@cache
def _templates() -> Environment:
    environment = Environment(
        loader=PackageLoader("experiments.report"), undefined=StrictUndefined,
        autoescape=select_autoescape(["html.j2"]), trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    environment.globals |= {
        "Axis": Axis,
        "NAMED": NAMED,
        "Outcome": Outcome,
        "experiments": experiments,
        "in_words": in_words,
        "measured": lambda: curves(session.open_run().run),
        "page_titles": page_titles,
        "written": written,
        "outcome_of": {mark: it.css for it in Outcome for mark in (it.mark, it.own)}.get,
        "heads": lambda columns: ["", *(NAMED[it].title for it in columns)],
        "link": session.link,
        "claim_link": session.claim_link,
        "claim_file": lambda judged: f"{session.CLAIMS}/{session.claim_file(judged)}",
        "static": lambda name: Html((files("experiments.report") / "static" / name).read_text()),
    }
    environment.filters |= {
        "digits": written.digits, "spelled": written.spelled, "time": written.duration,
        "two_digits": two_digits, "whole": written.count,
    }  # fmt: skip
    return environment


def page(template: str, **content: Any) -> Html:
    """A whole page, or a part of one, from a template."""
    return Html(_templates().get_template(template).render(**content))


def part(macro: str, *content: Any) -> Html:
    """A table or a paragraph, by the name of its macro in ``parts.html.j2``."""
    return Html(markdown(macro, *content, kind="html"))


def markdown(macro: str, *content: Any, kind: str = "md") -> str:
    """The same for a page in Markdown, of ``parts.md.j2``; without the end of its last line."""
    module: Any = _templates().get_template(f"parts.{kind}.j2").module
    return str(getattr(module, macro)(*content)).rstrip("\n")


def browser(shown: session.Session) -> Html:
    """Every claim with what it rests on, to filter and to search; without scripts just unfolded."""
    facts = {"claims": shown.claims, "printed": shown.printed, "tables": groups_of_claims()}
    return page("claim_browser.html.j2", filters=filters(shown.claims), **facts)


def groups_of_claims() -> dict[str, Table]:
    """The tables, and the sentences."""
    return {**tables(), SENTENCES: Table(SENTENCES, "In sentences", {}, "half_edge_or_indexed")}


def filters(claims: Sequence[JudgedClaim]) -> dict[str, dict[str, tuple[str, int]]]:
    """By group the choices: value -> its title, and how many claims it has."""
    facts = (
        (it.outcome.value, it.claim.claimant, it.claim.structure, it.claim.table) for it in claims
    )
    outcomes, claimants, structures, kinds = map(Counter, zip(*facts, strict=True))
    return {
        "claimed": {it.value: (it.value, claimants[it]) for it in Kind},
        "outcome": {it.value: (f"{it.mark} {it.value}", outcomes[it.value]) for it in Outcome},
        "structure": {name: (NAMED[name].title, structures[name]) for name in structures if name},
        "kind": {name: (it.title, kinds[name]) for name, it in groups_of_claims().items()},
    }


verdicts = partial(part, "verdicts")
"""Of claims and a table's name: what is printed at a glance, and whether it holds."""
slopes = partial(part, "slopes")
"""The same with the slopes along every axis, their intervals, and what a query costs."""
sentences = partial(part, "sentences")
"""Of claims and a kind: the sentences, what was measured of them, and the verdicts."""
tally = partial(part, "tally")
"""Of claims: how many of each kind came out how."""
legend = partial(part, "legend")
"""How the cells of tables are to be read."""
chapter_list = partial(part, "chapter_list")
"""The chapters, to choose from."""
about_run = partial(part, "about_run")
"""What was run where, and which cases were skipped, by reason."""
abstract = partial(part, "abstract")
"""The answers of the front page once more, in German."""
claims_markdown = partial(markdown, "claims")
"""Of claims and a table's name, in Markdown: what is claimed, its marks, and what was found."""
sentences_markdown = partial(markdown, "sentences")
"""Of claims and a kind, in Markdown: the sentences."""
about_history = partial(markdown, "history")
"""Of trends, in Markdown: how many runs there are, and what to do if they are few."""
text_table = partial(part, "words")
"""A table of words below their heads: ``text_table(heads, rows)``."""


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
    return {title: or_missing(otherwise, how, claims, name) for name, title in every}


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


def errata() -> Html:
    """What is published, what it does, and what a run of it gave beside the corrected version."""
    return part("errata", [(it, it.show(), number) for number, it in enumerate(ERRATA, start=1)])


def or_missing(otherwise: str, make: Callable[..., str], *given: Any) -> str:
    """A part of a page, made of what is ``given``, or a word on why it is not there."""
    try:
        return make(*given)
    except session.LACKING as missing:
        return otherwise.format(escape(str(missing), quote=False))


def numbers(rows: Iterable[Sequence[Any]], heads: Heads) -> Html:
    """A table of numbers below their heads, a dash for NaN. MissingError where there is no row."""
    texts = [
        [how(it) if it == it else "–" for it, how in zip(row, heads.values(), strict=True)]
        for row in rows
    ]
    session.require(texts, "measured what would stand here")
    table = part("numbers", list(heads), texts)
    table.rows = [list(heads), *texts]
    return table


def frame_table(frame: pd.DataFrame) -> Html:
    """A table of what is text already, which stands on the left. MissingError: there is no row."""
    session.require(len(frame), "measured what would stand here")
    return part("words", list(frame), frame.to_numpy().tolist(), "")


class Answer:
    """An answer of the front page with its links, also in German; ``missing`` where a number is."""

    def __init__(
        self, text: str, german: str, rests: Mapping[str, str], needs: Sequence[float], missing: str
    ) -> None:
        self.measured = all(value == value for value in needs)  # nan where nothing was measured
        self.text, self.rests = text if self.measured else missing, rests
        told = german if self.measured else "Dieser Lauf hat das auf keiner Maschine ganz gemessen."
        swapped = str.maketrans(",.", ".,")  # 1.234,5 for 1,234.5
        self.german = re.sub(r"\d[\d,.]*\d", lambda it: it[0].translate(swapped), told)

    def _repr_html_(self) -> str:
        return str(part("answer", self.text, self.measured, self.rests))


def closing(claims: Iterable[JudgedClaim], points: Mapping[str, Sequence[str]]) -> Html:
    """What a chapter comes to, sentence by sentence, each with the claims that it rests on.

    ``points``: by sentence the keys of claims that must be consistent, or with "not " before them
    violated. Where the run says something else or cannot tell, so does the page. Braces in a
    sentence are what was found of these claims. Raises KeyError for a claim that there is none of.
    """
    judged = {it.claim.key: it for it in claims}
    rows = []
    for text, keys in points.items():
        rests = [judged[key.removeprefix("not ")] for key in keys]
        wanted = (Outcome.VIOLATED if it.startswith("not ") else Outcome.CONSISTENT for it in keys)
        pairs = [{it.outcome, other} for it, other in zip(rests, wanted, strict=True)]
        denied, doubted = DETERMINED in pairs, any(len(it) > 1 for it in pairs)
        doubt = "This run does not bear it out: " if denied else "This run cannot tell: "
        rows.append((text.format(*(it.found for it in rests)), doubt if doubted else "", rests))
    return part("closing", rows)


@cache
def sections() -> dict[str, dict[str, Any]]:
    """The sections of the documents in their order, by the numbers that sources have.

    ``title``, what it ``says``, its ``chapter`` here, and the files and rooms where it is ``done``.
    """
    return tomllib.loads((files("experiments.claims") / "sections.toml").read_text("utf-8"))


def cited(source: str) -> set[str]:
    """The sections that a source cites, by their numbers there: those of 7.1 are 7's."""
    document = re.sub(r"table \d+|errat(?:um|a) \d+", "", re.split("[;:]", source)[0])
    names = re.findall("article|draft", document) or re.findall(r"\d(?:\.\d)*|abstract", document)
    return {it if it in sections() else it.rpartition(".")[0] for it in names}


def traced(claims: Iterable[JudgedClaim]) -> Html:
    """A row per section: what it says, where it is done, and what became of what it claims."""
    printed = [it for it in claims if it.claim.claimant is Kind.PRINTED]
    rows = []
    for number, section in sections().items():
        mine = [it for it in printed if number in cited(it.claim.source)]
        said = [it for it in mine if it.claim.table == SENTENCES]
        cells = Counter(it.mark for it in mine if it.claim.table != SENTENCES)
        wrong = {
            place: it.title
            for place, it in enumerate(ERRATA, start=1)
            if number in cited(it.source.removeprefix("quoted in "))
        }
        chapter, shown = section["chapter"], number if number[0].isdigit() else ""
        where = part("done", page_titles()[chapter], session.link(chapter), section["done"])
        became = part("became", said, cells, wrong)
        rows.append((f"{shown} {section['title']}", section["says"], where, became))
    heads = "Section", "What it says", "Where it is done", "What became of it"
    return text_table(heads, rows)
