"""The command line: ``hem study``, ``table``, ``report``, ``meshes``, ``info``, ``fracture``,
``check``, ``baseline update``, ``history``, ``judge``.

A command imports what it needs when it is run, so that help and mistakes are quick.
"""

from importlib.metadata import version
from pathlib import Path
from typing import Annotated

try:
    import typer
    from rich.table import Table
    from typer import Argument, Option
except ModuleNotFoundError as error:  # the library alone was installed
    raise SystemExit("hem: the commands need more: pip install 'hem-mesh[study]'") from error

import hem
from experiments.cli.advise import advise
from experiments.cli.check import baseline_app, check
from experiments.cli.console import MESH, Commands, Repair, RunArgument, console, errors, run_folder
from experiments.cli.fracture import fracture
from experiments.cli.history import history
from experiments.cli.judge import judge_file
from experiments.cli.study import run_study

app = typer.Typer(
    cls=Commands,
    help="Triangle-mesh data structures, measured and held against what a thesis claims of them.",
    no_args_is_help=True,
    rich_markup_mode="markdown",  # which fills the lines of a paragraph
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
PAGES, DOCUMENT = Path("report/html"), Path("report/report.pdf")
"""Where the report goes."""


def _show_version(wanted: bool) -> None:
    if wanted:
        console.print(f"hem {version('hem-mesh')}")
        raise typer.Exit


@app.callback()
def _options(
    show_version: Annotated[
        bool, Option("--version", callback=_show_version, is_eager=True, help="Say which.")
    ] = False,
) -> None:
    pass


app.command("study")(run_study)


@app.command("table")
def show_table(
    run: RunArgument = None,
    every: Annotated[bool, Option("--all", help="All structures, and the listings.")] = False,
    slopes: Annotated[bool, Option("--slopes", help="The slopes and their intervals.")] = False,
) -> None:
    """Print what the thesis claims of each structure, with the verdicts of a run."""
    folder = run_folder(run)
    from experiments.report import show_claims

    show_claims(folder, console, every, slopes)


@app.command("report")
def write_report(
    run: RunArgument = None,
    output: Annotated[
        Path | None, Option(help=f"Where it goes. Default: {PAGES}, with --pdf {DOCUMENT}.")
    ] = None,
    page: Annotated[bool, Option("--page", help="Just the page that is committed.")] = False,
    pdf: Annotated[bool, Option("--pdf", help="One document to print; needs Chromium.")] = False,
) -> None:
    """Run the notebooks on a run and write the report: pages that open from disk."""
    folder = run_folder(run)
    from experiments import report

    if page:
        done = f"Page written: {report.write_readme(folder, Path('report'))}"
    elif pdf:
        done = f"Document written: {report.write_pdf(folder, output or DOCUMENT)}"
    else:
        front = report.write_report(folder, output or PAGES)
        done = f"Report written. Open {front.resolve().as_uri()}"
    console.print(done, soft_wrap=True)


@app.command()
def meshes(
    size: Annotated[int, Option(help="Number of vertices to make the families with.")] = 1000,
) -> None:
    """List the families and the real models, with their counts."""
    families = {
        name: (hem.generate(name, size), it.what, it.sizes) for name, it in hem.FAMILIES.items()
    }
    models = {name: (hem.sample(name), it.what, "") for name, it in hem.SAMPLES.items()}
    titles = "Families, made by hem.generate(name, n_vertices)", "Models, read by hem.sample(name)"
    for title, made in zip(titles, (families, models), strict=True):
        table = _numbers("name", "vertices", "edges", "faces", "border", "valence", title=title)
        notes = Table.grid(padding=(0, 2, 0, 0))
        for name, (mesh, what, sizes) in made.items():
            s = mesh.summary()
            counts = (s.vertices, s.edges, s.faces, s.border_edges)
            table.add_row(name, *map("{:,}".format, counts), f"{s.valence_min}…{s.valence_max}")
            notes.add_row(name, what)
            if sizes:
                notes.add_row("  sizes", sizes)
        console.print(table, notes, "")


@app.command()
def info(
    mesh: Annotated[str, Argument(help=MESH)],
    repair: Repair = False,
) -> None:
    """Say what a mesh consists of, and which structure can hold it in how many bytes."""
    from structures import REGISTRY, build

    found = hem.find_mesh(mesh, repair)
    console.print(f"[bold]{mesh}[/]\n{found.summary()}\n")
    table = _numbers("structure", "bytes", "per vertex", "with 8-byte references", "per vertex")
    refusals = []
    for name, structure in REGISTRY.items():
        try:
            sizes = [sum(build(name, found, k).memory().values()) for k in (4, 8)]
            each = [(f"{size:,}", f"{size / max(len(found.points), 1):.1f}") for size in sizes]
            table.add_row(structure.title, *each[0], *each[1])
        except hem.MeshError as refusal:
            table.add_row(structure.title, "[red]cannot hold it[/]")
            refusals.append(f"Why: {refusal}")
    console.print(table)
    for reason in dict.fromkeys(refusals):
        console.print(reason, markup=False)


def _numbers(*heads: str, title: str | None = None) -> Table:
    """A table of names with numbers beside them."""
    table = Table(*heads, title=title)
    for column in table.columns[1:]:
        column.justify = "right"
    return table


app.command()(advise)
app.command()(fracture)
app.add_typer(history, name="history")
app.command()(check)
app.command("judge")(judge_file)
app.add_typer(baseline_app, name="baseline")
app.add_typer(baseline_app, name="reference", hidden=True)

__all__ = ["app", "console", "errors"]
