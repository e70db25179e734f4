"""The page that is committed of a run: tables, sentences and the main plots, in Markdown."""

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from experiments.claims import CLAIMED
from experiments.harness import OPERATIONS, QUERIES_TABLE, Axis
from experiments.report import tables, uses
from experiments.report.figures import fracture, growth, memory, meshes
from experiments.report.pages import each_table, or_missing
from experiments.report.session import read_session, share
from experiments.runs import Run, in_words

TIMES = partial(growth.scaling, axis=Axis.TIME_FACES)
DRAWN: dict[str, tuple[str, Callable[[Run], Figure]]] = {
    "overview": ("The faces around a vertex, by work and by time", growth.overview),
    "time": ("Time of the nine queries", TIMES),
    "work": ("Work of the nine queries", lambda run: growth.scaling(run, Axis.WORK_FACES)),
    "memory": ("Bytes per vertex", memory.by_field),
    "building": ("Time to build", growth.building),
    "operations": ("Time of the operations", partial(TIMES, subjects=OPERATIONS)),
    "workloads": ("What people do with meshes, compiled", growth.workloads),
    "references": ("A half-edge mesh in arrays and in objects", memory.references),
    "listings": ("The thesis' listings, as published and as corrected", growth.listings),
    "plankton": ("The article's walk around a vertex", lambda run: meshes.plankton_walk()),
    "impacts": ("A plate struck in several places", lambda run: fracture.impacts()),
    "broken": (
        "A bunny broken at three forces",
        lambda run: fracture.gallery(fracture.broken_by_force("bunny", "ceramic")),
    ),
    "shards": ("Breaking a surface", growth.shards_per_second),
    "overtaking": (
        "Queries and edits until the indexed mesh is overtaken, building included",
        growth.overtaking,
    ),
}
"""The pictures of the page: by file the title and how it is drawn."""

MARKED = "(?s)(<!-- table -->).*?(<!-- end of table -->)"  # where the README has table 1
MISSING = "*{}*"  # how the page says what was not measured


def write_readme(run_folder: Path, folder: Path) -> Path:
    """Write what is committed of a run for reading: a page with the tables and the main plots.

    Table 1 and its legend go into the README beside ``folder``, too, if it has marks for them.
    """
    share(session := read_session(run_folder))
    run, claims = session.run, session.claims
    folder.mkdir(parents=True, exist_ok=True)
    recommended = partial(uses.recommended_markdown, run)
    parts = {"Which structure for which use": or_missing(recommended, MISSING)}
    parts |= {
        "Who claims what": tables.markdown_rows(tables.tally_rows(claims)),
        "How to read it": "\n\n".join(tables.legend()),
    }
    parts |= each_table(claims, tables.markdown, MISSING)
    for kind in CLAIMED:
        parts[f"In sentences: {kind.about}"] = tables.sentences_markdown(claims, kind)
    for name, (title, draw) in DRAWN.items():
        picture = partial(_draw, run, draw, folder / f"{name}.png", title)
        parts[title] = or_missing(picture, MISSING)
    text = "\n\n".join(f"## {title}\n\n{part}" for title, part in parts.items())
    page = folder / "README.md"
    made = "Made by `hem report --page` from a run; README.md has its table 1 from there, too."
    page.write_text(f"# The thesis, measured\n\n{made} {in_words(run)}\n\n{text}\n", "utf-8")
    readme = folder.parent / "README.md"
    if readme.exists():
        table = f"{parts[QUERIES_TABLE.title]}\n\n{' '.join(tables.legend())}"
        text = re.sub(MARKED, lambda it: f"{it[1]}\n{table}\n{it[2]}", readme.read_text("utf-8"))
        readme.write_text(text, "utf-8")
    return page


def _draw(run: Run, draw: Callable[[Run], Figure], file: Path, title: str) -> str:
    draw(run).savefig(file)
    return f"![{title}]({file.name})"
