"""The report: the notebooks run on a run folder, as pages that open from disk, and a front page."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from pathlib import Path
from typing import Any

from experiments import html, statements
from experiments.claims import OPERATIONS, TABLES
from experiments.results import ResultsError, Run, load
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
    "rigour": "How far to trust it",
}
"""The notebooks in the order they are read. A new chapter is one notebook and one line here."""

QUIET = ["--IPKernelApp.log_level=40"]  # no warnings about how a local kernel is talked to

RUN_VARIABLE = "HEM_RUN"
"""The environment variable that tells a notebook which run to read."""


def write(run_folder: Path, output: Path) -> Path:
    """Write the report of a run to ``output`` -> its front page.

    The pages replace what was there all at once. Raises ResultsError where the run cannot be read
    or a notebook fails, naming it; then what was there stays.
    """
    run = load(run_folder)
    table = judged(run)
    save(run, table)
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=output.parent, prefix=".report-") as beside:
        fresh = Path(beside) / "html"
        fresh.mkdir()
        for name, title in CHAPTERS.items():
            body = _chapter(name, run_folder)
            (fresh / f"{name}.html").write_text(html.page(title, body, _links()), "utf-8")
        front = html.page("Triangle-mesh structures, measured", _front(run, table), _links())
        (fresh / "index.html").write_text(front, "utf-8")
        shutil.rmtree(output, ignore_errors=True)
        fresh.rename(output)
    return output / "index.html"


def write_page(run_folder: Path, folder: Path, reference: Path) -> Path:
    """Write what is committed of a run: a page with table 1 and the main plots, and the verdicts.

    The page goes to ``folder``, the verdicts to ``reference``, to compare later runs with.
    """
    from experiments import fracture_pictures, operation_plots, pictures, plots

    run = load(run_folder)
    save(run, judged(run), reference)
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
    return {"Verdicts": "index.html", **{title: f"{it}.html" for it, title in CHAPTERS.items()}}


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


def _chapter(name: str, run_folder: Path) -> str:
    """Run a notebook -> the body of its page, without its code."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError
    from nbconvert import HTMLExporter

    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
    client = NotebookClient(notebook, timeout=300, kernel_name="python3", extra_arguments=QUIET)
    try:
        with _environment(RUN_VARIABLE, str(run_folder.resolve())):
            client.execute(cwd=str(NOTEBOOKS))
    except CellExecutionError as error:
        what = f"{error.ename}: {error.evalue}"
        raise ResultsError(f"notebooks/{name}.ipynb cannot read {run_folder}: {what}") from error
    exporter = HTMLExporter(template_name="basic", exclude_input=True, exclude_output_prompt=True)
    body: str = exporter.from_notebook_node(notebook)[0]
    return body


def _front(run: Run, table: Any) -> str:
    claims = table[table["query"] != "memory"]
    counts = ", ".join(
        f"{number} {outcome}" for outcome, number in claims["outcome"].value_counts().items()
    )
    boards = "".join(
        f"<h2>{title}</h2>{html.verdicts(table[table['table'] == which])}"
        for which, title in TABLES.items()
    )
    chapters = "".join(
        f'<li><a href="{it}.html">{title}</a></li>' for it, title in CHAPTERS.items()
    )
    return (
        "<h1>Does the thesis hold?</h1>"
        f"<p>Cells of its tables, judged by the work that was counted: <b>{escape(counts)}</b>. "
        "Work is the number of array elements that a query or an operation accesses; it is exact "
        "and decides. Time is judged beside it, and is undetermined where the machine's caches "
        "could explain it as well. Structures of objects are interpreted, and measured on smaller "
        "meshes.</p>"
        f"{boards}"
        '<p class="soft">✓ consistent · ✗ violated · ? undetermined: the data cannot tell · '
        "– nothing is claimed, as the structure keeps no record of an edge: what was found is the "
        "cost of naming the edge by its two vertices.</p>"
        f"<h2>In sentences</h2>{html.statements(statements.judged(run))}"
        f"<h2>The evidence</h2><ul>{chapters}</ul>"
        f"<h2>The run</h2><p>{escape(_provenance(run))}</p>{_left_out(run)}"
    )


def _provenance(run: Run) -> str:
    meta, machine = run.meta, run.meta.get("machine", {})
    versions = ", ".join(f"{name} {number}" for name, number in meta.get("versions", {}).items())
    caches = ", ".join(f"{level} {size}" for level, size in machine.get("caches", {}).items())
    state = {True: " with changes that are not committed", False: "", None: ""}[meta.get("dirty")]
    finished = f"to {meta['finished']}" if "finished" in meta else "and not finished"
    return (
        f"Profile {meta.get('profile')}, from {meta.get('started')} {finished}, at commit "
        f"{str(meta.get('commit'))[:10]}{state}. "
        f"{machine.get('cores')} cores of {machine.get('cpu')} ({caches}), "
        f"{machine.get('memory_bytes', 0) / 2**30:.0f} GiB, {machine.get('platform')}. "
        f"{versions}. {len(run.cells):,} cells, each checked against the triangle list before it "
        "was measured."
    )


def _left_out(run: Run) -> str:
    if run.left_out.empty:
        return "<p>Nothing was left out.</p>"
    items = "".join(
        f"<li>{escape(f'{row.experiment} {row.structure} {row.id}: {row.left_out}')}</li>"
        for row in run.left_out.itertuples()
    )
    return f"<p>Left out:</p><ul>{items}</ul>"
