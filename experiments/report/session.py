"""What a chapter works with: the run it reports, and where its links lead."""

import os
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from experiments import carried
from experiments.claims import JudgedClaim, judge_run
from experiments.regression import RUN
from experiments.runs import RUNS, ResultsError, Run, latest, load
from hem import NotInstalledError

RUN_VARIABLE = "HEM_RUN"  # the environment variable that tells a notebook which run to read
CLAIMS = "claims"  # the folder beside the pages that holds the claims' figures and data


class MissingError(ValueError):
    """What a cell would show was not measured, or cannot be shown here; the page says so."""


LACKING = MissingError, NotInstalledError
"""What a page says in place of what it would show."""


def require(there: Any, what: str) -> None:
    """Raise MissingError where a run has not done ``what``: there are no rows, or it is false."""
    if not there:
        raise MissingError(f"This run has not {what}.")


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
    """The run of this report; else that of ``HEM_RUN``, the newest, or the committed baseline.

    Raises ResultsError for what is no run.
    """
    from experiments.report.style import show_figures  # which a terminal does not wait for

    show_figures()
    _go_on_in_jupyter()
    session = _current or read_session(os.environ.get(RUN_VARIABLE) or _newest_run())
    share(session)
    return session


def _go_on_in_jupyter() -> None:
    """Have a cell that lacks something say just so, and those below it run, as for a page."""
    from IPython.core.getipython import get_ipython

    shell: Any = get_ipython()
    if shell:
        shell.set_custom_exc(LACKING, lambda shell, kind, error, *_, **__: print(error))
    if hasattr(shell, "kernel") and _pass_over not in shell.events.callbacks["post_run_cell"]:
        shell.events.register("post_run_cell", _pass_over)


def _pass_over(result: Any) -> None:
    if isinstance(result.error_in_exec, LACKING):
        result.error_in_exec = None


def _newest_run() -> Path:
    """The newest run, of this folder or of the checkout; without any the baseline, and a word."""
    for root in (RUNS, carried(str(RUNS))):
        with suppress(ResultsError):
            return latest(root)
    print(
        "There is no run yet, so this is the committed baseline: a run reduced to what others are "
        "compared with. What it leaves out is named where it would stand."
    )
    return carried("results/reference") / RUN


def link(page: str, anchor: str = "") -> str:
    """Where a link to a page, or to a place on it, leads: printed all pages are one."""
    if _current and _current.printed:
        return f"#{anchor or page}"
    return f"{page}.html#{anchor}" if anchor else f"{page}.html"


claim_link = partial(link, "index")
"""Where a link to a claim leads, by its key."""


def claim_file(judged: JudgedClaim) -> str:
    """How the names of a claim's files begin."""
    return judged.claim.key.replace("/", ".")


def project_file(path: str) -> Path:
    """A file of the checkout, or as a wheel carries it. Raises MissingError if that has it not."""
    found = carried(str(Path(path).parent)) / Path(path).name
    if not found.exists():
        raise MissingError(f"This needs {path}, which comes with the source repository.")
    return found
