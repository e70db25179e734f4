"""Laws of the way from the thesis to here: nothing that a document claims is missing from it."""

import re
from pathlib import Path

import pytest

from experiments.claims import Kind, load_claims, sentence_claims
from experiments.claims.errata import ERRATA
from experiments.report.notebooks import page_titles
from experiments.report.pages import cited, sections

ROOT = Path(__file__).parents[3]
ERRATA_SOURCES = {re.sub("^quoted in ", "", it.source) for it in ERRATA}
PRINTED = [it for it in (*load_claims(), *sentence_claims()) if it.kind is Kind.PRINTED]


@pytest.mark.parametrize("claim", PRINTED, ids=lambda it: it.key)
def test_every_claim_that_is_printed_stands_at_a_section_that_is_shown(claim) -> None:
    assert cited(claim.source)
    assert cited(claim.source) <= sections().keys()


def test_every_erratum_stands_at_a_section_too() -> None:
    assert all(cited(it) and cited(it) <= sections().keys() for it in ERRATA_SOURCES)


@pytest.mark.parametrize("section", sections().values(), ids=sections().keys())
def test_what_a_section_names_is_there(section) -> None:
    assert section["chapter"] in page_titles()
    assert all((ROOT / it).exists() for it in section["done"])
    assert re.search(r"\w\.$|\?$", section["says"])


def test_the_outlook_leads_to_the_walk_and_to_the_destruction_that_it_asks_for() -> None:
    outlook = sections()["6"]
    assert all(it in outlook["says"] for it in ("circulator", "bodies", "forces", "Voronoi"))
    assert "indices" not in outlook["says"]  # of which 3.2.1 tells, and of Plankton
    assert {"structures/plankton.py", "hem/fracture"} <= set(outlook["done"])


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("thesis 3.1, table 1; worked out in 7.1 to 7.4", {"3.1"}),
        ("thesis 4.1 and 5: constant; but the listing searches (erratum 6)", {"4.1", "5"}),
        ("thesis 3.3.1 and 4.1 (of erratum 6)", {"3.3.1", "4.1"}),
        ("thesis 7.4 and 3.2.2", {"7", "3.2.2"}),
        ("thesis, abstract; here taken as twice", {"abstract"}),
        ("article on Plankton", {"article"}),
        ("we expect it: thesis 5 leaves the question open", set()),
    ],
)
def test_a_source_cites_its_sections_and_no_table_or_erratum(source, expected) -> None:
    assert cited(source) == expected
