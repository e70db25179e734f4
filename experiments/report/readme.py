"""The page that is committed of a run: answers, tables and the main plots, in Markdown."""

import re
from collections.abc import Callable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from experiments.bench_real_time import RESERVED
from experiments.bench_workloads import FROM_PYTHON
from experiments.claims import CLAIMED
from experiments.harness import OPERATIONS, QUERIES_TABLE, Axis
from experiments.report import comparisons, pages, tables, uses
from experiments.report.figures import fracture, growth, memory, meshes, real_time
from experiments.report.notebooks import FRONT, execute, read
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
    "edits": ("Single edits, a render mesh in step: the share that takes longer", real_time.waits),
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

TABLES: dict[str, dict[str, Callable[[Run], pages.Html]]] = {
    "workloads": {
        "What people do with meshes in numbers, compiled": comparisons.workloads,
        "The same from Python: other programs, and mostly the time of Python": partial(
            comparisons.workloads, order=FROM_PYTHON
        ),
    },
    "edits": {
        "Single edits, where arrays grow: median · 99 of 100 · longest · edits in 16.7 ms": (
            real_time.frames
        ),
        "The same, where room was made beforehand": partial(real_time.frames, order=RESERVED),
        "Up to which size edits keep up": real_time.keeping_up,
        "Dropping what is dead": real_time.compactions,
        "Picking": real_time.picks_in_words,
        "Megabytes where it is drawn, in a render mesh, and in all with each structure": (
            real_time.weights
        ),
    },
}
"""What stands below a picture, by its title: tables and words of the chapters."""

MISSING = "*{}*"  # how the page says what was not measured


def write_readme(run_folder: Path, folder: Path) -> Path:
    """Write what is committed of a run for reading: a page that begins with the answers.

    They, and table 1 with its legend, go into the README beside ``folder``, too, if it has marks
    for them.
    """
    share(session := read_session(run_folder))
    run, claims = session.run, session.claims
    told = execute(read(FRONT), FRONT).get("answers", ())
    listed = "\n".join(f"{number}. {it.text}" for number, it in enumerate(told, start=1))
    answers = listed or MISSING.format("This run has measured none.")
    recommended = pages.or_missing(MISSING, uses.recommended_markdown, run)
    absent = uses.left_out().striptags()
    parts = {"Which structure for which use": f"{uses.HOW_TO_READ}\n\n{recommended}\n\n{absent}"}
    parts["Who claims what"] = tables.markdown_rows(tables.tally_rows(claims))
    parts |= pages.each_table(claims, pages.claims_markdown, MISSING)
    for kind in CLAIMED:
        parts[f"In sentences: {kind.about}"] = pages.sentences_markdown(claims, kind)
    folder.mkdir(parents=True, exist_ok=True)
    for name, (title, draw) in DRAWN.items():
        parts[title] = pages.or_missing(MISSING, _draw, run, draw, folder / f"{name}.png", title)
        for head, show in TABLES.get(name, {}).items():
            parts[head] = pages.or_missing(MISSING, lambda show: show(run).markdown, show)
    facts = {"answers": answers, "legend": tables.legend(), "about": in_words(run)}
    (folder / "README.md").write_text(pages.page("readme.md.j2", parts=parts, **facts), "utf-8")
    readme = folder.parent / "README.md"
    if readme.exists():
        table = f"{parts[QUERIES_TABLE.title]}\n\n{' '.join(tables.legend())}"
        text = _filled(readme.read_text("utf-8"), "answer", answers)
        readme.write_text(_filled(text, "table", table), "utf-8")
    return folder / "README.md"


def _filled(text: str, name: str, part: str) -> str:
    """A text with a part between its marks of this name, if it has them."""
    marked = f"(?s)(<!-- {name} -->).*?(<!-- end of {name} -->)"
    return re.sub(marked, lambda it: f"{it[1]}\n{part}\n{it[2]}", text)


def _draw(run: Run, draw: Callable[[Run], Figure], file: Path, title: str) -> str:
    draw(run).savefig(file)
    return f"![{title}]({file.name})"
