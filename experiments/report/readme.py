"""The page that is committed of a run: tables, sentences and the main plots, in Markdown."""

from __future__ import annotations

from pathlib import Path

from experiments.claims import sentences
from experiments.claims.growth import OPERATIONS, TABLES
from experiments.claims.judged import OUTCOMES
from experiments.report import figures, fracture_figures, mesh_figures, operation_figures
from experiments.report.tables import markdown
from experiments.runs.provenance import in_words
from experiments.runs.results import Run, load


def write(run_folder: Path, folder: Path) -> Path:
    """Write what is committed of a run for reading: a page with the tables and the main plots.

    Table 1 goes into the README beside ``folder``, too, if it has the marks for it.
    """
    run = load(run_folder)
    folder.mkdir(parents=True, exist_ok=True)
    drawn = {
        "overview": ("The faces around a vertex, by work and by time", figures.overview(run)),
        "time": ("Time of the nine queries", figures.scaling(run, "time", "faces")),
        "work": ("Work of the nine queries", figures.scaling(run, "work", "faces")),
        "memory": ("Bytes per vertex", figures.memory(run)),
        "building": ("Time to build", figures.building(run)),
        "operations": ("Time of the operations", figures.scaling(run, "time", "faces", OPERATIONS)),
        "workloads": ("What people do with meshes", operation_figures.workloads(run)),
        "references": ("A half-edge mesh in arrays and in objects", figures.references(run)),
        "listings": ("The thesis' listings, as printed and mended", figures.listings(run)),
        "plankton": ("The article's walk around a vertex", mesh_figures.plankton_walk()),
        "impacts": ("A plate struck in several places", fracture_figures.impacts()),
        "broken": (
            "A bunny broken at three forces",
            fracture_figures.gallery(fracture_figures.broken_by_force("bunny", "ceramic")),
        ),
        "shards": ("Breaking a surface", fracture_figures.shards_per_second(run)),
        "overtaking": (
            "Queries and edits per build until the indexed mesh is overtaken",
            operation_figures.overtaking(run),
        ),
    }
    for name, (_, figure) in drawn.items():
        figure.savefig(folder / f"{name}.png")
    shown = "\n\n".join(f"## {title}\n\n![{title}]({it}.png)" for it, (title, _) in drawn.items())
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
    for it in sentences.judged(run):
        found = sentences.bounds(it), sentences.span(it), f"{OUTCOMES[it.outcome]} {it.outcome}"
        lines.append(f"| {it.says} | {it.measured} | {' | '.join(found)} |")
    return "\n".join(lines)


def _fill_in(readme: Path, table: str) -> None:
    """Put the table between the two marks of a README that has them."""
    text = readme.read_text() if readme.exists() else ""
    before, begin, rest = text.partition("<!-- table -->")
    _, end, after = rest.partition("<!-- end of table -->")
    if end:
        readme.write_text(f"{before}{begin}\n{table}\n{end}{after}")
