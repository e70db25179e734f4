"""The commands ``hem meshes`` and ``hem info``: which meshes there are, what one consists of."""

from __future__ import annotations  # else NumPy is imported just to read them

from dataclasses import asdict
from typing import Annotated, Any

from rich.markup import escape
from rich.table import Table
from typer import Argument, Option

import hem
from experiments.cli.console import AsJson, OfMesh, Repair, console, print_json
from experiments.report import show_rows

REFUSED = "cannot hold it"


def meshes(
    size: Annotated[int, Option(help="Vertices to make the families with; 100 or more.")] = 1000,
    as_json: AsJson = False,
) -> None:
    """List the families and the real models, with their counts.

    Example: `hem meshes --size 5000`
    """
    families = [_told(name, it, hem.generate(name, size)) for name, it in hem.FAMILIES.items()]
    models = [_told(name, it, hem.sample(name)) for name, it in hem.SAMPLES.items()]
    if as_json:
        print_json({"families": families, "models": models})
        return
    titles = "Families, made by hem.generate(name, n_vertices)", "Models, read by hem.sample(name)"
    for title, made in zip(titles, (families, models), strict=True):
        rows: list[tuple[str, ...]] = [("name", "vertices", "edges", "faces", "border", "valence")]
        notes = Table.grid(padding=(0, 2, 0, 0))
        for it in made:
            counts = (it[key] for key in ("vertices", "edges", "faces", "border_edges"))
            valence = f"{it['valence_min']}…{it['valence_max']}"
            rows.append((it["name"], *map("{:,}".format, counts), valence))
            notes.add_row(it["name"], it["what"])
            if it["sizes"]:
                notes.add_row("  sizes", it["sizes"])
        show_rows(console, rows, title, numbers=rows[0][1:])
        console.print(notes, "")


def _told(name: str, of: Any, mesh: hem.TriangleMesh) -> dict[str, Any]:
    sizes = getattr(of, "sizes", None)  # which models have not
    return {"name": name, "what": of.what, "sizes": sizes, **asdict(mesh.summary())}


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
    console.print(f"[bold]{escape(mesh)}[/]\n{found.summary()}\n")
    heads = "structure", "bytes", "per vertex", "8-byte references", "per vertex"
    table: list[tuple[str, ...]] = [heads]
    for row in rows:
        if row["refusal"]:
            table.append((row["title"], REFUSED, "", "", ""))
        else:
            sizes = row["bytes"], row["bytes_with_8_byte_references"]
            each = [(f"{it:,}", f"{it / max(len(found.points), 1):,.1f}") for it in sizes]
            table.append((row["title"], *each[0], *each[1]))
    show_rows(console, table, numbers=heads[1:], colors={REFUSED: "red"})
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
