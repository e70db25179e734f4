"""The command ``hem advise``."""

from __future__ import annotations

from dataclasses import asdict
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.filesize import decimal
from rich.markup import escape
from typer import Argument, Option

import hem
from experiments import carried
from experiments.cli.check import HERE
from experiments.cli.console import (
    AsJson,
    OfMesh,
    Repair,
    completed,
    console,
    errors,
    print_json,
    run_folder,
)

if TYPE_CHECKING:  # takes a second to import
    from experiments.advice import Advice
    from experiments.runs import Run

NOTHING = 3  # exit code where no structure suits
WORKLOADS = "drawn", "picked", "edited", "simplified", "remeshed"
NEEDS = "edges", "borders", "polygons", "attributes", "edits"  # told before anything is imported


# fmt: off
def advise(
    mesh: Annotated[str, Argument(**OfMesh)],
    workload: Annotated[str, Option(
        help=f"{', '.join(WORKLOADS)}; or a TOML or CSV file.",
        autocompletion=completed(__name__, "WORKLOADS"))] = "drawn",
    need: Annotated[list[str] | None, Option(
        help=f"{', '.join(NEEDS)}; may be repeated.",
        autocompletion=completed(__name__, "NEEDS"))] = None,
    most_bytes: Annotated[float, Option("--bytes", help="The most it may take.")] = inf,
    worst_edit: Annotated[float, Option(
        help="The most ms that the slowest kind of edit may take in the median.")] = inf,
    run: Annotated[
        Path | None, Option(help="A run of this machine. Default: the committed baseline.")
    ] = None,
    as_json: AsJson = False,
    repair: Repair = False,
) -> None:
    # fmt: on
    """Say which structure should hold a mesh, for what is asked of it and done to it.

    A workload is a table of how often that is, per build or per frame:

        frames = 600
        [[rows]]
        what = "vertex_faces"
        times = 3
        per = "frame"

    What it takes as a whole, measured on one structure, can be told, too: `[measured]` with
    structure, vertices and seconds.

    `with hem.record(s) as workload:` counts what a program does; `workload.save("mine.csv")`.

    Example: `hem advise bunny --workload simplified --need edges --worst-edit 1`

    Exit code 0; 1 or 2: a mistake in what was asked; 3: no structure suits.
    """
    from experiments import advice
    from experiments.regression import RUN
    from experiments.runs import load, noise

    limits = advice.Limits(most_bytes, worst_edit / 1e3)
    wanted = advice.find_workload(workload)
    usual = HERE / RUN  # who keeps a baseline of counters alone has none there
    usual = usual if usual.is_dir() else carried(str(HERE)) / RUN
    source = load(run_folder(run) if run else usual)
    if source.machines:
        raise ValueError(f"{source.folder} was measured by several machines: give one's folder")
    of_mesh = hem.find_mesh(mesh, repair)
    found = advice.advise(advice.Prices(source), wanted, of_mesh, limits, need or [])
    if (seen := noise(source)).too_busy:
        errors.print(seen.words, style="yellow")
    if as_json:
        told = {"run": str(source.folder), "machine": source.meta.get("machine", {})}
        told |= asdict(found)
        told["options"] = [it.pop("forecast") | it for it in told["options"]]
        print_json(told)
    else:
        _show(found, source, str(run or "the baseline"), mesh)
    if not found.options:
        errors.print("hem: no structure suits; ask for less, or allow more")
        raise typer.Exit(NOTHING)


def _show(found: Advice, run: Run, called: str, mesh: str) -> None:
    from experiments.report import digits, duration, show_rows
    from structures import REGISTRY

    cpu = run.meta.get("machine", {}).get("cpu", "an unknown machine")
    on = f"{escape(mesh)} ({found.faces:,} triangles)"
    console.print(f"[bold]{escape(found.workload.title)}[/], on {on}.", highlight=False)
    kind = "regular" if found.regular else "irregular"
    where = f"on {cpu}, on {kind} meshes"
    console.print(f"Predicted from {called}, measured {where}.", markup=False)
    rows = [("structure", "time", "nine of ten", "bytes", "what costs it more")]
    for option in found.options:
        it, behind = option.forecast, option.behind
        low, high = duration(it.low), duration(it.high)
        within = f"{low.removesuffix(high[high.index(' ') :])} … {high}"  # the unit once
        extra = f"{behind} {duration(it.parts.get(behind, 0.0))}" if behind else ""
        title = REGISTRY[it.structure].title
        rows.append((title, duration(it.seconds), within, decimal(option.bytes), extra))
    if len(rows) > 1:
        show_rows(console, rows)
    held = found.workload.measured
    if held and [it.forecast.structure for it in found.options[:1]] == [held.structure]:
        title = REGISTRY[held.structure].title
        console.print(f"It was measured on {title}, and nothing is a tenth quicker: stay.")
    for why in dict.fromkeys(found.refused.values()):
        alike = ", ".join(REGISTRY[it].title for it, its in found.refused.items() if its == why)
        console.print(f"Not suited: {alike}: {why}.", markup=False)
    for flip in found.flips:
        vertices, at = flip["of"] == "vertices", flip["at"]
        where = f"{at:,.0f} vertices" if vertices else f"{digits(at)} × the edits"
        best = flip["best"]
        told = f"{REGISTRY[best].title} is the best" if best else "nothing suits"
        console.print(f"At {where} {told}.")
    untold = sorted({what for it in found.options for what in it.forecast.untold})
    if untold:
        console.print(f"Skipped, as the run does not tell what it takes: {', '.join(untold)}.")
