"""What a chapter works with: the run it reports, and where its links lead."""

import os
from dataclasses import dataclass
from pathlib import Path

from experiments.claims import JudgedClaim, judge_run
from experiments.runs import Run, latest, load

RUN_VARIABLE = "HEM_RUN"  # the environment variable that tells a notebook which run to read
CLAIMS = "claims"  # the folder beside the pages that holds the claims' figures and data


class MissingError(ValueError):
    """What a cell would show was not measured, or cannot be shown here; the page says so."""


@dataclass
class Session:
    """A run, its judged claims, and whether all pages are printed as one document."""

    run: Run
    claims: list[JudgedClaim]
    printed: bool = False


def read_session(run_folder: str | Path, printed: bool = False) -> Session:
    """A run with its judged claims. Raises ResultsError where there is none."""
    run = load(run_folder)
    return Session(run, judge_run(run), printed)


_current: Session | None = None


def share(session: Session | None) -> None:
    """Make this the run of all chapters that are executed in this process."""
    global _current
    _current = session


def open_run() -> Session:
    """The run of this report; in a notebook of its own the one of ``HEM_RUN``, or the newest.

    Raises ResultsError where there is none.
    """
    from experiments.report.style import show_figures  # which a terminal does not wait for

    show_figures()
    if _current is None:
        share(read_session(os.environ.get(RUN_VARIABLE) or latest()))
    assert _current is not None
    return _current


def link(page: str, anchor: str = "") -> str:
    """Where a link to a page, or to a place on it, leads: printed all pages are one."""
    if _current and _current.printed:
        return f"#{anchor or page}"
    return f"{page}.html" + (f"#{anchor}" if anchor else "")


def claim_link(key: str) -> str:
    """Where a link to a claim leads."""
    return link("index", key)


def claim_file(judged: JudgedClaim) -> str:
    """How the names of a claim's files begin."""
    return judged.claim.key.replace("/", ".")


def project_file(path: str) -> Path:
    """A file that comes with the checkout. Raises MissingError where the package is installed."""
    found = Path(__file__).parents[2] / path
    if not found.exists():
        raise MissingError(f"This needs {path}, which comes with the source repository.")
    return found
