"""The claim browser: every claim on one list, to filter and to search, with what it rests on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from experiments.claims import SENTENCES, JudgedClaim, Outcome
from experiments.harness import Axis, Table
from experiments.report.claim_figures import FOLDER, file_name
from experiments.report.pages import Html, page, two_digits, was_measured
from experiments.report.session import Session
from experiments.runs import tables
from hem.complexity import Verdict
from structures import NAMED


def browser(session: Session) -> Html:
    """All claims. Without scripts all of them are shown, and unfold one by one."""
    content = page(
        "claim_browser.html.j2",
        claims=session.claims,
        filters=filters(session.claims),
        tables=groups_of_claims(),
        folder=FOLDER,
        file_name=file_name,
        caption=caption,
        printed=session.printed,
        was_measured=was_measured,
    )
    return Html(content)


def groups_of_claims() -> dict[str, Table]:
    """The tables, and the sentences."""
    return {**tables(), SENTENCES: Table(SENTENCES, "In sentences", {}, "half_edge_or_indexed")}


def filters(claims: Sequence[JudgedClaim]) -> dict[str, dict[str, tuple[str, int]]]:
    """By group the choices: value -> its title, and how many claims it has."""
    counts = Counter((group, value) for it in claims for group, value in groups(it).items())
    names = dict.fromkeys(it.claim.structure for it in claims if it.claim.structure)
    kinds = {name: table.title for name, table in groups_of_claims().items()}
    choices = {
        "outcome": {it.value: f"{it.mark} {it.value}" for it in Outcome},
        "structure": {name: str(NAMED[name].title) for name in names},
        "kind": kinds,
    }
    return {
        group: {value: (title, counts[group, value]) for value, title in offered.items()}
        for group, offered in choices.items()
    }


def groups(judged: JudgedClaim) -> dict[str, str]:
    """The value of a claim in each group."""
    claim = judged.claim
    return {"outcome": judged.outcome.value, "structure": claim.structure, "kind": claim.table}


def caption(axis: Axis, verdict: Verdict, claimed: bool) -> str:
    """Slope, interval, what is claimed and what was found."""
    slope, low, high = map(two_digits, (verdict.slope, verdict.slope_low, verdict.slope_high))
    most = "at most " if verdict.bound == "upper" else ""
    told = f"claimed {most}{verdict.expected}, " if claimed else ""
    return f"slope {slope} ({low} … {high}) · {told}found {verdict.best}"
