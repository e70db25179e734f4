"""The page that is committed of a run: tables, sentences and the main plots, in Markdown."""

from __future__ import annotations

from pathlib import Path

from experiments import fracture_pictures, operation_plots, pictures, plots, statements
from experiments.claims import OPERATIONS, TABLES
from experiments.provenance import in_words
from experiments.results import Run, load
from experiments.table import markdown
from experiments.verdicts import OUTCOMES


def write(run_folder: Path, folder: Path) -> Path:
    """Write what is committed of a run for reading: a page with the tables and the main plots.

    Table 1 goes into the README beside ``folder``, too, if it has the marks for it.
    """
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
        f"# The thesis, measured\n\n{in_words(run)}\n\n{tables}\n\n## In sentences\n\n"
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
