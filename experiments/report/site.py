"""The report of a run: the chapters as pages that open from disk, and a front page."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from html import escape
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from experiments.claims import answers
from experiments.claims.growth import TABLES
from experiments.claims.judged import judged, save
from experiments.report import chapters, claim_browser, html, pdf
from experiments.report.entries import Entry, entries
from experiments.report.page import page, static
from experiments.runs.provenance import in_words
from experiments.runs.results import CannotWriteError, ResultsError, Run, load

FRONT = "index"
TITLE = "Does the thesis hold?"
"""The front page: its file, and what it is called."""

READING = """<p class="soft">✓ consistent · ✗ violated · ? undetermined: the data cannot tell ·
– nothing is claimed, as the structure keeps no record of an edge: what was found is the cost of
naming the edge by its two vertices. Work is the number of array elements that a query or an
operation accesses; it is exact and decides. Time is judged beside it, and is undetermined where the
machine’s caches could explain it as well. Structures of objects are interpreted, and measured on
smaller meshes.</p>"""
"""How to read the tables."""

UNFOLDING = """<p>Every cell of the tables and every sentence, with its plots, its data, the reasons
for its verdict, and its source. In the plots a dot is what was measured at one size, between its
smallest and largest sample; gray and dashed is the class that is claimed, as it fits best, and the
shade above it what waiting for memory can add; red and dashed is a class that fits better, or the
best one where nothing is claimed.</p>"""
"""How to read the claims."""


def write(run_folder: Path, output: Path) -> Path:
    """Write the report of a run to ``output`` -> its front page.

    The pages replace what was there all at once. Raises ResultsError where the run cannot be read
    or a notebook fails, naming it; then what was there stays.
    """
    run = load(run_folder)
    _require_replaceable(output)
    with _beside(output, "html") as fresh:
        parts = _parts(run, run_folder)
        front = page(TITLE, parts.front + parts.claims + parts.back, _links(), static("board.js"))
        (fresh / f"{FRONT}.html").write_text(front, "utf-8")
        for name, body in parts.chapters.items():
            text = page(chapters.CHAPTERS[name], body, _links())
            (fresh / f"{name}.html").write_text(text, "utf-8")
        claim_browser.write_files(parts.entries, fresh)
        _replace(output, fresh)
    return output / f"{FRONT}.html"


def write_pdf(run_folder: Path, output: Path) -> Path:
    """Write the report of a run as one document to print -> ``output``.

    Raises ResultsError as ``write`` does, and PrintError where there is no browser to print it.
    """
    pdf.browser()  # rather now than after the notebooks
    run = load(run_folder)
    with _beside(output, "print") as fresh:
        parts = _parts(run, run_folder)
        sections = pdf.sections(parts.front, parts.chapters, parts.claims, parts.back)
        (fresh / "print.html").write_text(pdf.document(TITLE, sections), "utf-8")
        claim_browser.write_files(parts.entries, fresh)
        printed = pdf.printed(fresh / "print.html", fresh / "report.pdf")
        printed.replace(output)
    return output


def _require_replaceable(output: Path) -> None:
    """Raise ResultsError unless there is nothing at ``output``, or a report, to be replaced."""
    known = {f"{name}.html" for name in (FRONT, *chapters.CHAPTERS)} | {"claims"}
    if output.exists() and not (
        output.is_dir() and all(it.name in known for it in output.iterdir())
    ):
        raise ResultsError(
            f"{output} is no report, and would be replaced by one: choose a folder that is not "
            "there yet, or empty"
        )


def _replace(output: Path, fresh: Path) -> None:
    """Put the new pages in the place of the old ones, which go away with what is beside them."""
    _require_replaceable(output)
    if output.exists():
        output.rename(fresh.with_name("old"))
    fresh.rename(output)


class Parts(NamedTuple):
    """What a report is made of: the front page in three parts, the chapters, and the claims."""

    front: str
    claims: str
    back: str
    chapters: dict[str, str]
    entries: list[Entry]


def _parts(run: Run, run_folder: Path) -> Parts:
    table = judged(run)
    with suppress(CannotWriteError):  # who may not write beside the run may read it all the same
        save(run, table)
    every = entries(run, table)
    front, claims, back = _front(run, table), _claims(every), _back(run)
    return Parts(front, claims, back, chapters.bodies(run_folder), every)


@contextmanager
def _beside(output: Path, name: str) -> Iterator[Path]:
    """A new folder beside the output, on the same disk; it goes away at the end."""
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".report-") as beside:
        fresh = Path(beside) / name
        fresh.mkdir()
        yield fresh


def _links() -> dict[str, str]:
    return {
        TITLE: f"{FRONT}.html",
        **{title: f"{it}.html" for it, title in chapters.CHAPTERS.items()},
    }


def _front(run: Run, table: pd.DataFrame) -> str:
    """The question, the answer and the tables."""
    boards = "".join(
        f"<h2>{title}</h2>{html.verdicts(table[table['table'] == which])}"
        for which, title in TABLES.items()
    )
    return (
        f"<h1>{TITLE}</h1>"
        f'<p class="question">{escape(answers.question())}</p>'
        f"{answers.shown(answers.answers(run, table))}{boards}{READING}"
    )


def _claims(every: list[Entry]) -> str:
    return (
        f'<h2 id="claims">All claims</h2>{UNFOLDING}{claim_browser.board(every, chapters.CHAPTERS)}'
    )


def _back(run: Run) -> str:
    """The way on, and what was run."""
    listed = "".join(
        f'<li><a href="{it}.html">{title}</a></li>' for it, title in chapters.CHAPTERS.items()
    )
    return (
        f'<div class="no-print"><h2>The chapters</h2><ol class="cards">{listed}</ol></div>'
        f"<h2>The run</h2><p>{escape(in_words(run))}</p>{_left_out(run)}"
    )


def _left_out(run: Run) -> str:
    if run.skipped.empty:
        return "<p>Nothing was left out.</p>"
    items = "".join(
        f"<li>{escape(f'{row.experiment} {row.structure} {row.id}: {row.skipped}')}</li>"
        for row in run.skipped.itertuples()
    )
    return f"<p>Left out:</p><ul>{items}</ul>"
