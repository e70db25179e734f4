"""The report of a run: its pages, which open from disk, or all of them as one document."""

import multiprocessing
import os
import signal
import tempfile
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import Any

from experiments.harness import allowed_cores
from experiments.report import pdf
from experiments.report.figures.claims import write_claims
from experiments.report.notebooks import FRONT, body, page_titles
from experiments.report.pages import page
from experiments.report.session import CLAIMS, Session, read_session, share
from experiments.runs import ResultsError

BATCH = 10  # claims whose figures a process draws at a time


def write_report(run_folder: Path, output: Path) -> Path:
    """Write the report of a run to ``output`` -> its front page.

    The pages replace what was there all at once. Raises ResultsError where the run cannot be read
    or a notebook fails, naming it; then what was there stays.
    """
    _require_replaceable(output)
    session = read_session(run_folder)
    with _beside(output) as fresh:
        for name, text in _write_parts(session, fresh).items():
            content = page("page.html.j2", titles=page_titles(), here=name, front=FRONT, body=text)
            (fresh / f"{name}.html").write_text(content, "utf-8")
        _require_replaceable(output)
        if output.exists():
            output.rename(fresh.with_name("old"))
        fresh.rename(output)
    return output / f"{FRONT}.html"


def write_pdf(run_folder: Path, output: Path) -> Path:
    """Write the report as one document to print -> ``output``; PrintError without a browser."""
    if output.is_dir():  # rather now than after the notebooks
        raise ResultsError(f"{output} is a folder: name a file in it, such as report.pdf")
    pdf.require_browser()
    session = read_session(run_folder, printed=True)
    with _beside(output) as fresh:
        bodies = _write_parts(session, fresh)
        content = page("print.html.j2", titles=page_titles(), front=FRONT, bodies=bodies)
        (fresh / "print.html").write_text(content, "utf-8")
        pdf.print_pdf(fresh / "print.html", fresh / "report.pdf").replace(output)
    return output


def _write_parts(session: Session, folder: Path) -> dict[str, str]:
    """Write the files beside the pages -> the bodies of the pages, in the order they are read."""
    (folder / CLAIMS).mkdir()
    keys = [it.claim.key for it in session.claims]
    with _workers(session) as pool:
        bodies = {name: pool.submit(body, name) for name in page_titles()}
        batches = [keys[start : start + BATCH] for start in range(0, len(keys), BATCH)]
        drawn = [pool.submit(write_claims, batch, folder / CLAIMS) for batch in batches]
        every: list[Future[Any]] = [*drawn, *bodies.values()]
        for part in as_completed(every):
            part.result()  # the first that fails ends all
        return {name: text.result() for name, text in bodies.items()}


@contextmanager
def _workers(session: Session) -> Iterator[ProcessPoolExecutor]:
    """Processes that know the run, one per core; an interrupt or an error ends them."""
    methods = multiprocessing.get_all_start_methods()  # forks share what this room's door imported
    context: Any = multiprocessing.get_context("forkserver" if "forkserver" in methods else "spawn")
    others = set(multiprocessing.active_children())
    pool = ProcessPoolExecutor(len(allowed_cores()) or None, context, _begin, (session,))
    try:
        yield pool
    except BaseException:
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in set(multiprocessing.active_children()) - others:
            worker.terminate()
        raise
    pool.shutdown()


def _begin(session: Session) -> None:
    """What a process does first. It ends with its parent, who alone hears an interrupt."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent: Any = multiprocessing.parent_process()
    Thread(target=lambda: (parent.join(), os._exit(1)), daemon=True).start()
    share(session)


def _require_replaceable(output: Path) -> None:
    """Raise ResultsError unless there is nothing at ``output``, or a report, to be replaced."""
    if output.resolve() == Path.cwd():
        raise ResultsError(f"{output} is the folder that you are in: choose one in it")
    known = {f"{name}.html" for name in page_titles()} | {CLAIMS}
    if output.is_dir() and all(path.name in known for path in output.iterdir()):
        return
    if output.exists():
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
