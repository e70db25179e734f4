"""The report of a run: its pages, which open from disk, or all of them as one document."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from concurrent.futures import Future, as_completed
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from experiments.claims import judge_run
from experiments.report import chapters, pdf
from experiments.report.claim_figures import FOLDER, write_claims
from experiments.report.notebooks import FRONT, page_titles
from experiments.report.pages import page
from experiments.report.session import Session
from experiments.runs import ResultsError, load

BATCH = 10
"""Claims whose figures a process draws at a time."""


def write_report(run_folder: Path, output: Path) -> Path:
    """Write the report of a run to ``output`` -> its front page.

    The pages replace what was there all at once. Raises ResultsError where the run cannot be read
    or a notebook fails, naming it; then what was there stays.
    """
    session = _judged(run_folder, printed=False)
    _require_replaceable(output)
    with _beside(output) as fresh:
        for name, body in _write_parts(session, fresh).items():
            content = page("page.html.j2", titles=page_titles(), here=name, front=FRONT, body=body)
            (fresh / f"{name}.html").write_text(content, "utf-8")
        _require_replaceable(output)
        if output.exists():
            output.rename(fresh.with_name("old"))
        fresh.rename(output)
    return output / f"{FRONT}.html"


def write_pdf(run_folder: Path, output: Path) -> Path:
    """Write the report of a run as one document to print -> ``output``.

    Raises ResultsError as ``write_report`` does, and PrintError without a browser to print it.
    """
    pdf.require_browser()  # rather now than after the notebooks
    session = _judged(run_folder, printed=True)
    with _beside(output) as fresh:
        bodies = _write_parts(session, fresh)
        content = page("print.html.j2", titles=page_titles(), front=FRONT, bodies=bodies)
        (fresh / "print.html").write_text(content, "utf-8")
        pdf.print_pdf(fresh / "print.html", fresh / "report.pdf").replace(output)
    return output


def _judged(run_folder: Path, printed: bool) -> Session:
    run = load(run_folder)
    return Session(run, judge_run(run), printed)


def _write_parts(session: Session, folder: Path) -> dict[str, str]:
    """Write the files beside the pages -> the bodies of the pages, in the order they are read."""
    (folder / FOLDER).mkdir()
    keys = [it.claim.key for it in session.claims]
    with chapters.workers(session) as pool:
        bodies = chapters.bodies(pool, page_titles())
        drawn = [
            pool.submit(write_claims, keys[start : start + BATCH], folder / FOLDER)
            for start in range(0, len(keys), BATCH)
        ]
        every: list[Future[Any]] = [*drawn, *bodies.values()]
        for part in as_completed(every):
            part.result()  # the first that fails ends all
        return {name: body.result() for name, body in bodies.items()}


def _require_replaceable(output: Path) -> None:
    """Raise ResultsError unless there is nothing at ``output``, or a report, to be replaced."""
    known = {f"{name}.html" for name in page_titles()} | {FOLDER}
    if output.exists() and not (
        output.is_dir() and all(path.name in known for path in output.iterdir())
    ):
        raise ResultsError(
            f"{output} is no report, and would be replaced by one: choose a folder that is not "
            "there yet, or empty"
        )


@contextmanager
def _beside(output: Path) -> Iterator[Path]:
    """A new folder beside the output, on the same disk; it goes away at the end."""
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".report-") as beside:
        fresh = Path(beside) / "fresh"
        fresh.mkdir()
        yield fresh
