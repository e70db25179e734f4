"""The commands ``hem meshes`` and ``hem info``: which meshes there are, what one consists of."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any

from rich.table import Column, Table
from typer import Argument, Option

import hem
from experiments.cli.console import AsJson, OfMesh, Repair, console, print_json


def meshes(
    size: Annotated[int, Option(help="Number of vertices to make the families with.")] = 1000,
    as_json: AsJson = False,
) -> None:
    """List the families and the real models, with their counts.

    Example: `hem meshes --size 5000`
    """
    families = {
        name: (hem.generate(name, size), it.what, it.sizes) for name, it in hem.FAMILIES.items()
    }
    models = {name: (hem.sample(name), it.what, "") for name, it in hem.SAMPLES.items()}
    if as_json:
        print_json({"families": _listed(families), "models": _listed(models)})
        return
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


def _listed(made: dict[str, tuple[hem.TriangleMesh, str, str]]) -> list[dict[str, Any]]:
    return [
        {"name": name, "what": what, "sizes": sizes or None, **asdict(mesh.summary())}
        for name, (mesh, what, sizes) in made.items()
    ]


def info(
    mesh: Annotated[str, Argument(**OfMesh)], repair: Repair = False, as_json: AsJson = False
) -> None:
    """Say what a mesh consists of, and which structure can hold it in how many bytes.

    Example: `hem info model.ply --repair`
    """
    found = hem.find_mesh(mesh, repair)
    rows = _held(found)
    if as_json:
        print_json({"mesh": mesh, **asdict(found.summary()), "structures": rows})
        return
    console.print(f"[bold]{mesh}[/]\n{found.summary()}\n")
    table = _numbers("structure", "bytes", "per vertex", "with 8-byte references", "per vertex")
    for row in rows:
        if row["refusal"]:
            table.add_row(row["title"], "[red]cannot hold it[/]")
        else:
            sizes = row["bytes"], row["bytes_with_8_byte_references"]
            each = [(f"{it:,}", f"{it / max(len(found.points), 1):.1f}") for it in sizes]
            table.add_row(row["title"], *each[0], *each[1])
    console.print(table)
    for reason in dict.fromkeys(row["refusal"] for row in rows if row["refusal"]):
        console.print(f"Why: {reason}", markup=False)


def _held(mesh: hem.TriangleMesh | hem.PolygonMesh) -> list[dict[str, Any]]:
    """By structure how many bytes it takes, or why it cannot hold the mesh. O(n) each."""
    from structures import REGISTRY, build

    rows = []
    for name, structure in REGISTRY.items():
        small = large = refusal = None
        try:
            small, large = (sum(build(name, mesh, k).memory().values()) for k in (4, 8))
        except hem.MeshError as error:
            refusal = str(error)
        sizes = {"bytes": small, "bytes_with_8_byte_references": large}
        rows.append({"name": name, "title": structure.title, **sizes, "refusal": refusal})
    return rows


def _numbers(*heads: str, title: str | None = None) -> Table:
    """A table of names with numbers beside them."""
    first, *numbers = heads
    return Table(first, *(Column(it, justify="right") for it in numbers), title=title)
