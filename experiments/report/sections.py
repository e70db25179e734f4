"""From the thesis to here: its sections, where each is done, and what became of its claims."""

import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from experiments.claims import SENTENCES, JudgedClaim, Kind
from experiments.claims.errata import ERRATA
from experiments.report.notebooks import page_titles
from experiments.report.pages import Html, part, text_table
from experiments.report.session import link

NOT_OF_SECTIONS = r"table \d+|errat(?:um|a) \d+"
"""Numbers in a source that are not those of sections."""


@dataclass(frozen=True)
class Section:
    """A section of the thesis, or the article: what it says, and where it is done.

    ``of``: its number as sources have it. ``done``: files and rooms. ``chapter``: of the report.
    """

    of: str
    title: str
    says: str
    chapter: str
    done: Sequence[str]


@cache
def sections() -> tuple[Section, ...]:
    """All of them, in the order of the documents."""
    text = (files("experiments.claims") / "sections.toml").read_text("utf-8")
    return tuple(Section(**it) for it in tomllib.loads(text)["section"])


def cited(source: str) -> set[str]:
    """The sections that a source cites, as ``Section.of`` has them: those of 7.1 are 7's."""
    document = re.split("[;:]", source)[0]
    if other := re.match("article|draft", document):
        return {other[0]}
    if not document.startswith("thesis"):
        return set()
    numbers = re.findall(r"\d(?:\.\d)*", re.sub(NOT_OF_SECTIONS, "", document))
    known = {it.of for it in sections()}
    found = {it if it in known else it.rpartition(".")[0] for it in numbers}
    return found | ({"abstract"} if "abstract" in document else set())


def traced(claims: Iterable[JudgedClaim]) -> Html:
    """A row per section: what it says, where it is done, and what became of what it claims."""
    printed = [it for it in claims if it.claim.kind is Kind.PRINTED and it.claim.claims_something]
    heads = "Section", "What it says", "Where it is done", "What became of it"
    return text_table(heads, [_row(it, printed) for it in sections()])


def _row(section: Section, printed: Sequence[JudgedClaim]) -> tuple[str, str, Html, Html]:
    mine = [it for it in printed if section.of in cited(it.claim.source)]
    said = [it for it in mine if it.claim.table == SENTENCES]
    cells = Counter(it.mark for it in mine if it.claim.table != SENTENCES)
    sources = [re.sub("^quoted in ", "", it.source) for it in ERRATA]
    wrong = [k for k, source in enumerate(sources) if section.of in cited(source)]
    became = part("became", said, cells, {k + 1: ERRATA[k].title for k in wrong})
    where = part("done", page_titles()[section.chapter], link(section.chapter), section.done)
    number = section.of if section.of[0].isdigit() else ""
    return f"{number} {section.title}", section.says, where, became
