"""The report: the notebooks run on a run folder, as pages that open from disk, and a front page."""

from __future__ import annotations

import asyncio
import os
import re
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, contextmanager, suppress
from html import escape, unescape
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from experiments import answers, board, html, pdf, statements
from experiments.claims import OPERATIONS, TABLES
from experiments.entries import Entry, entries
from experiments.noise import noise
from experiments.page import page, static
from experiments.results import CannotWriteError, ResultsError, Run, load
from experiments.table import markdown
from experiments.verdicts import OUTCOMES, judged, save

NOTEBOOKS = Path(__file__).parent.parent / "notebooks"
CHAPTERS = {
    "comparison_table": "The comparison table",
    "query_scaling": "How queries scale",
    "memory": "Memory",
    "operations": "Operations",
    "half_edge_or_indexed": "Half-edge or indexed?",
    "references_and_pairs": "References, indices and pairs",
    "errata": "What the listings do",
    "fracture": "Destruction",
    "regression": "From commit to commit",
    "rigour": "How far to trust it",
}
"""The notebooks in the order they are read. A new chapter is one notebook and one line here."""

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

AT_ONCE = 2
"""Notebooks that run beside each other."""

QUIET = ["--IPKernelApp.log_level=40"]  # no warnings about how a local kernel is talked to

RUN_VARIABLE = "HEM_RUN"
"""The environment variable that tells a notebook which run to read."""


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
            text = page(CHAPTERS[name], body, _links())
            (fresh / f"{name}.html").write_text(text, "utf-8")
        board.write_files(parts.entries, fresh)
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
        board.write_files(parts.entries, fresh)
        printed = pdf.printed(fresh / "print.html", fresh / "report.pdf")
        printed.replace(output)
    return output


def _require_replaceable(output: Path) -> None:
    """Raise ResultsError unless there is nothing at ``output``, or a report, to be replaced."""
    known = {f"{name}.html" for name in (FRONT, *CHAPTERS)} | {"claims"}
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
    return Parts(front, claims, back, _chapters(run_folder), every)


def _chapters(run_folder: Path) -> dict[str, str]:
    """Run every notebook -> the bodies of their pages.

    In a thread with a loop of its own, as a notebook from which this is called has one already. An
    interrupt cancels what runs there, which ends the kernels, before it goes on.
    """
    loop = asyncio.new_event_loop()
    everything = loop.create_task(_all_chapters(run_folder))
    with (
        closing(loop),
        _environment(RUN_VARIABLE, str(run_folder.resolve())),
        ThreadPoolExecutor(1) as pool,
    ):
        running = pool.submit(loop.run_until_complete, everything)
        try:
            return running.result()
        finally:
            loop.call_soon_threadsafe(everything.cancel)


async def _all_chapters(run_folder: Path) -> dict[str, str]:
    places = asyncio.Semaphore(AT_ONCE)

    async def chapter(name: str) -> str:
        async with places:
            return await _chapter(name, run_folder)

    try:
        async with asyncio.TaskGroup() as group:
            tasks = {name: group.create_task(chapter(name)) for name in CHAPTERS}
    except ExceptionGroup as failed:
        raise failed.exceptions[0] from None
    return {name: task.result() for name, task in tasks.items()}


@contextmanager
def _beside(output: Path, name: str) -> Iterator[Path]:
    """A new folder beside the output, on the same disk; it goes away at the end."""
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".report-") as beside:
        fresh = Path(beside) / name
        fresh.mkdir()
        yield fresh


def write_page(run_folder: Path, folder: Path) -> Path:
    """Write what is committed of a run for reading: a page with the tables and the main plots.

    Table 1 goes into the README beside ``folder``, too, if it has the marks for it.
    """
    from experiments import fracture_pictures, operation_plots, pictures, plots

    run = load(run_folder)
    folder.mkdir(parents=True, exist_ok=True)
    figures = {
        "overview": ("The faces around a vertex, by work and by time", plots.overview(run)),
        "time": ("Time of the nine queries", plots.scaling(run, "time", "faces")),
        "work": ("Work of the nine queries", plots.scaling(run, "work", "faces")),
        "memory": ("Bytes per vertex", plots.memory(run)),
        "building": ("Time to build", plots.building(run)),
        "operations": ("Time of the operations", plots.scaling(run, "time", "faces", OPERATIONS)),
        "workloads": ("What people do with meshes", operation_plots.workloads(run)),
        "references": ("A half-edge mesh in arrays and in objects", plots.references(run)),
        "listings": ("The thesis' listings, as printed and mended", plots.listings(run)),
        "plankton": ("The article's walk around a vertex", pictures.plankton_walk()),
        "impacts": ("A plate struck in several places", fracture_pictures.impacts()),
        "broken": (
            "A bunny broken at three forces",
            fracture_pictures.gallery(fracture_pictures.broken_by_force("bunny", "ceramic")),
        ),
        "shards": ("Breaking a surface", fracture_pictures.shards_per_second(run)),
        "overtaking": (
            "Queries and edits per build until the indexed mesh is overtaken",
            operation_plots.overtaking(run),
        ),
    }
    for name, (_, figure) in figures.items():
        figure.savefig(folder / f"{name}.png")
    shown = "\n\n".join(f"## {title}\n\n![{title}]({it}.png)" for it, (title, _) in figures.items())
    page = folder / "README.md"
    tables = "\n\n".join(f"## {title}\n\n{markdown(run, which)}" for which, title in TABLES.items())
    page.write_text(
        f"# The thesis, measured\n\n{_provenance(run)}\n\n{tables}\n\n## In sentences\n\n"
        f"{_sentences(run)}\n\n{shown}\n"
    )
    _fill_in(folder.parent / "README.md", markdown(run))
    return page


def _sentences(run: Run) -> str:
    lines = ["| the thesis | measured by | claimed | found | |", "|---|---|---|---|---|"]
    for it in statements.judged(run):
        found = statements.bounds(it), statements.span(it), f"{OUTCOMES[it.outcome]} {it.outcome}"
        lines.append(f"| {it.says} | {it.measured} | {' | '.join(found)} |")
    return "\n".join(lines)


def _fill_in(readme: Path, table: str) -> None:
    """Put the table between the two marks of a README that has them."""
    text = readme.read_text() if readme.exists() else ""
    before, begin, rest = text.partition("<!-- table -->")
    _, end, after = rest.partition("<!-- end of table -->")
    if end:
        readme.write_text(f"{before}{begin}\n{table}\n{end}{after}")


def _links() -> dict[str, str]:
    return {TITLE: f"{FRONT}.html", **{title: f"{it}.html" for it, title in CHAPTERS.items()}}


@contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before


async def _chapter(name: str, run_folder: Path) -> str:
    """Run a notebook -> the body of its page, without its code."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError
    from nbconvert import HTMLExporter

    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    client = NotebookClient(
        notebook, timeout=300, kernel_name="python3", extra_arguments=QUIET,
        shutdown_kernel="immediate",
    )  # fmt: skip
    try:
        await client.async_execute(cwd=str(NOTEBOOKS))
    except CellExecutionError as error:
        what = f"{error.ename}: {error.evalue}"
        raise ResultsError(f"notebooks/{name}.ipynb cannot read {run_folder}: {what}") from error
    exporter = HTMLExporter(template_name="basic", exclude_input=True, exclude_output_prompt=True)
    body = _described(exporter.from_notebook_node(notebook)[0])
    # Claims, whose keys have a slash, are on the front page.
    return re.sub(r'href="#([\w.-]+/)', r'href="index.html#\1', body)


def _described(body: str) -> str:
    """A chapter in which every picture is described by the heading that it stands under."""
    heading = ""
    parts = re.split(r"(<h[1-6].*?</h[1-6]>)", body, flags=re.DOTALL)
    for i, part in enumerate(parts):
        if i % 2:
            heading = escape(unescape(re.sub(r"<[^>]*>|¶", "", part)).strip())
        parts[i] = re.sub(r'alt="No description[^"]*"', f'alt="Plot: {heading}"', part)
    return "".join(parts)


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
    return f'<h2 id="claims">All claims</h2>{UNFOLDING}{board.board(every, CHAPTERS)}'


def _back(run: Run) -> str:
    """The way on, and what was run."""
    chapters = "".join(
        f'<li><a href="{it}.html">{title}</a></li>' for it, title in CHAPTERS.items()
    )
    return (
        f'<div class="no-print"><h2>The chapters</h2><ol class="cards">{chapters}</ol></div>'
        f"<h2>The run</h2><p>{escape(_provenance(run))}</p>{_left_out(run)}"
    )


def _provenance(run: Run) -> str:
    meta = run.meta
    versions = ", ".join(f"{name} {number}" for name, number in meta.get("versions", {}).items())
    state = {True: " with changes that are not committed", False: "", None: ""}[meta.get("dirty")]
    finished = f"to {meta['finished']}" if "finished" in meta else "and not finished"
    return (
        f"Profile {meta.get('profile')}, from {meta.get('started')} {finished}, at commit "
        f"{str(meta.get('commit'))[:10]}{state}. "
        f"{_machine(run)}. {versions}. {len(run.cells):,} cells, each checked against the triangle "
        f"list before it was measured. {noise(run).words}"
    )


def _machine(run: Run) -> str:
    if run.machines:
        return f"Measured by {len(run.machines)} machines, whose times are not compared"
    machine = run.meta.get("machine", {})
    caches = ", ".join(f"{level} {size}" for level, size in machine.get("caches", {}).items())
    return (
        f"{machine.get('cores')} cores of {machine.get('cpu')} ({caches}), "
        f"{machine.get('memory_bytes', 0) / 2**30:.0f} GiB, {machine.get('platform')}"
    )


def _left_out(run: Run) -> str:
    if run.left_out.empty:
        return "<p>Nothing was left out.</p>"
    items = "".join(
        f"<li>{escape(f'{row.experiment} {row.structure} {row.id}: {row.left_out}')}</li>"
        for row in run.left_out.itertuples()
    )
    return f"<p>Left out:</p><ul>{items}</ul>"
