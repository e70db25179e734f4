"""The command line: ``hem study``, ``table``, ``report``, ``meshes``, ``info``, ``fracture``,
``check``, ``reference update``, ``history``.
"""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any

try:
    import typer
    from rich.table import Table
except ModuleNotFoundError as error:  # the library alone was installed
    raise SystemExit("hem: the commands need more: pip install 'hem-mesh[study]'") from error

import hem
from experiments.cli.check import baseline_app, check
from experiments.cli.console import console, errors, user_errors
from experiments.cli.fracture import fracture
from experiments.cli.history import history
from experiments.cli.study import run_study
from experiments.runs import latest

app = typer.Typer(
    help="Triangle-mesh data structures, measured and held against what a thesis claims of them.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
PAGES, DOCUMENT = Path("report/html"), Path("report/report.pdf")
"""Where the report goes."""

RunArgument = Annotated[
    Path | None, typer.Argument(help="The folder of a run; the newest if it is not given.")
]


def _show_version(wanted: bool) -> None:
    if wanted:
        console.print(f"hem {version('hem-mesh')}", highlight=False)
        raise typer.Exit


@app.callback()
def _options(
    show_version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Say which.")
    ] = False,
) -> None:
    pass


app.command("study")(run_study)


@app.command("table")
def show_table(
    run: RunArgument = None,
    every: Annotated[
        bool, typer.Option("--all", help="All structures, and the thesis' listings.")
    ] = False,
    slopes: Annotated[
        bool, typer.Option("--slopes", help="Instead the slopes with their intervals.")
    ] = False,
) -> None:
    """Print what the thesis claims of each structure, with the verdicts of a run."""
    with user_errors():
        from experiments.report import show_claims

        show_claims(run or latest(), console, every, slopes)


@app.command("report")
def write_report(
    run: RunArgument = None,
    output: Annotated[
        Path | None,
        typer.Option(
            help=f"Where the pages go ({PAGES} if it is not given), or the document ({DOCUMENT})."
        ),
    ] = None,
    page: Annotated[
        bool, typer.Option("--page", help="Instead write the page and the table to commit.")
    ] = False,
    pdf: Annotated[
        bool, typer.Option("--pdf", help="Instead write one document to print; needs Chromium.")
    ] = False,
) -> None:
    """Run the notebooks on a run and write the report: pages that open from disk."""
    with user_errors():
        from experiments.report import write_pdf, write_readme, write_report

        folder = run or latest()
        if page:
            written = write_readme(folder, Path("report"))
            console.print(f"Page written: {written}")
        elif pdf:
            written = write_pdf(folder, output or DOCUMENT)
            console.print(f"Document written: {written}", soft_wrap=True)
        else:
            front = write_report(folder, output or PAGES)
            console.print(f"Report written. Open {front.resolve().as_uri()}", soft_wrap=True)


@app.command()
def meshes(
    size: Annotated[int, typer.Option(help="Number of vertices to make the families with.")] = 1000,
) -> None:
    """List the families and the real models, with their counts."""
    with user_errors():
        table = _mesh_table("Families, made by hem.generate(name, n_vertices)", "sizes")
        for name, family in hem.FAMILIES.items():
            table.add_row(name, *_counts(hem.generate(name, size)), family.what, family.sizes)
        console.print(table)
        table = _mesh_table("Models, read by hem.sample(name)")
        for name, model in hem.SAMPLES.items():
            table.add_row(name, *_counts(hem.sample(name)), model.what)
        console.print(table)


def _mesh_table(title: str, *more: str) -> Table:
    table = Table(title=title)
    table.add_column("name", style="bold")
    for head in ("vertices", "edges", "faces", "border", "valence"):
        table.add_column(head, justify="right")
    for head in ("what", *more):
        table.add_column(head)
    return table


def _counts(mesh: hem.TriangleMesh) -> list[str]:
    s = mesh.summary()
    counts = [f"{count:,}" for count in (s.vertices, s.edges, s.faces, s.border_edges)]
    return [*counts, f"{s.valence_min}…{s.valence_max}"]


@app.command()
def info(
    mesh: Annotated[
        str, typer.Argument(help="A mesh file, or the name of a model (see hem meshes).")
    ],
    repair: Annotated[
        bool, typer.Option("--repair", help="Mend what is not manifold first.")
    ] = False,
) -> None:
    """Say what a mesh consists of, and which structure can hold it in how many bytes."""
    with user_errors():
        found = _read(mesh, repair)
        console.print(f"[bold]{mesh}[/]\n{found.summary()}\n", highlight=False)
        table, refusals = _holders(found)
        console.print(table)
        for refusal in refusals:
            console.print(f"Why: {refusal}", highlight=False)


def _read(mesh: str, repair: bool) -> hem.TriangleMesh | hem.PolygonMesh:
    if mesh in hem.SAMPLES and not Path(mesh).exists():
        options: dict[str, Any] = {"repair": True} if repair else {}
        return hem.sample(mesh, **options)
    return hem.load(mesh, repair=repair)


def _holders(mesh: hem.TriangleMesh | hem.PolygonMesh) -> tuple[Table, list[str]]:
    """What each structure takes to hold the mesh, and why some cannot, each reason once."""
    from structures import REGISTRY, build

    table = Table("structure", "bytes", "per vertex", "with 8-byte references", "per vertex")
    for column in table.columns[1:]:
        column.justify = "right"
    refusals: dict[str, None] = {}
    for name, structure in REGISTRY.items():
        try:
            sizes = [sum(build(name, mesh, k).memory().values()) for k in (4, 8)]
        except hem.MeshError as refusal:
            table.add_row(structure.title, "[red]cannot hold it[/]")
            refusals[str(refusal)] = None
            continue
        each = [(f"{size:,}", f"{size / max(len(mesh.points), 1):.1f}") for size in sizes]
        table.add_row(structure.title, *each[0], *each[1])
    return table, list(refusals)


app.command()(fracture)
app.add_typer(history, name="history")
app.command()(check)
app.add_typer(baseline_app, name="baseline")
app.add_typer(baseline_app, name="reference", hidden=True)

__all__ = ["app", "console", "errors"]
