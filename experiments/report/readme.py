"""The page that is committed of a run: tables, sentences and the main plots, in Markdown."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from experiments.claims import judge_run
from experiments.harness import OPERATIONS, Axis
from experiments.report import figures, fracture_figures, memory_figures, mesh_figures
from experiments.report.session import MissingError, Session, share
from experiments.report.tables import markdown, sentences_markdown
from experiments.runs import Run, in_words, load, tables

DRAWN: dict[str, tuple[str, Callable[[Run], Figure]]] = {
    "overview": ("The faces around a vertex, by work and by time", figures.overview),
    "time": ("Time of the nine queries", lambda run: figures.scaling(run, Axis.TIME_FACES)),
    "work": ("Work of the nine queries", lambda run: figures.scaling(run, Axis.WORK_FACES)),
    "memory": ("Bytes per vertex", memory_figures.memory),
    "building": ("Time to build", figures.building),
    "operations": (
        "Time of the operations",
        lambda run: figures.scaling(run, Axis.TIME_FACES, OPERATIONS),
    ),
    "workloads": ("What people do with meshes", figures.workloads),
    "references": ("A half-edge mesh in arrays and in objects", memory_figures.references),
    "listings": ("The thesis' listings, as published and as corrected", figures.listings),
    "plankton": ("The article's walk around a vertex", lambda run: mesh_figures.plankton_walk()),
    "impacts": ("A plate struck in several places", lambda run: fracture_figures.impacts()),
    "broken": (
        "A bunny broken at three forces",
        lambda run: fracture_figures.gallery(fracture_figures.broken_by_force("bunny", "ceramic")),
    ),
    "shards": ("Breaking a surface", figures.shards_per_second),
    "overtaking": (
        "Queries and edits per build until the indexed mesh is overtaken",
        figures.overtaking,
    ),
}
"""The pictures of the page: by file the title and how it is drawn."""


def write_readme(run_folder: Path, folder: Path) -> Path:
    """Write what is committed of a run for reading: a page with the tables and the main plots.

    Table 1 goes into the README beside ``folder``, too, if it has the marks for it.
    """
    run = load(run_folder)
    claims = judge_run(run)
    share(Session(run, claims))
    folder.mkdir(parents=True, exist_ok=True)
    parts = [f"# The thesis, measured\n\n{in_words(run)}"]
    for name, table in tables().items():
        if any(it.claim.structure and it.claim.table == name for it in claims):
            parts.append(f"## {table.title}\n\n{_or_missing(partial(markdown, claims, name))}")
    parts.append(f"## In sentences\n\n{sentences_markdown(claims)}")
    parts += [f"## {title}\n\n{_picture(run, name, folder)}" for name, (title, _) in DRAWN.items()]
    page = folder / "README.md"
    page.write_text("\n\n".join(parts) + "\n", "utf-8")
    _fill_in(folder.parent / "README.md", _or_missing(partial(markdown, claims, "queries")))
    return page


def _picture(run: Run, name: str, folder: Path) -> str:
    title, draw = DRAWN[name]

    def drawn() -> str:
        draw(run).savefig(folder / f"{name}.png")
        return f"![{title}]({name}.png)"

    return _or_missing(drawn)


def _or_missing(part: Callable[[], str]) -> str:
    """A part of the page, or a word on why it is not there."""
    try:
        return part()
    except MissingError as missing:
        return f"*{missing}*"


def _fill_in(readme: Path, table: str) -> None:
    """Put the table between the two marks of a README that has them."""
    text = readme.read_text("utf-8") if readme.exists() else ""
    before, begin, rest = text.partition("<!-- table -->")
    _, end, after = rest.partition("<!-- end of table -->")
    if end:
        readme.write_text(f"{before}{begin}\n{table}\n{end}{after}", "utf-8")
