"""The commands ``hem history add`` and ``hem history show``."""

from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from experiments.cli.console import AsJson, RunArgument, console, errors, print_json, run_folder

history = typer.Typer(help="What became of the claims from commit to commit.", no_args_is_help=True)
HISTORY = Path("results/history.jsonl")
FileOption = Annotated[Path, Option("--file", help="The history, a line per run.")]


@history.command()
def add(run: RunArgument = None, file: FileOption = HISTORY) -> None:
    """Append a finished run. What is there already is not added again.

    Example: `hem history add results/runs/NAME`
    """
    folder = run_folder(run)
    from experiments.regression import append_run, read_history, record_run
    from experiments.runs import load, noise

    found = load(folder)
    line = record_run(found)
    told = "Added" if append_run(line, file) else "Already there"
    kept = read_history(file)
    star, count = "*" if line["dirty"] else "", len(kept.runs)
    console.print(
        f"{told}: {line['run']} (commit {line['commit'][:10]}{star}, machine "
        f"{line['machine']['id']}, {len(line['claims'])} claims). "
        f"{file} has {count} run{'s'[: count != 1]}.",
        soft_wrap=True, markup=False,
    )  # fmt: skip
    if star:
        console.print("* There were changes that are not committed.", style="dim")
    if (seen := noise(found)).too_busy:
        console.print(f"[yellow]{seen.words}[/]")
    _warn(kept.faults)


@history.command()
def show(
    claim: Annotated[
        str | None, Argument(help="half_edge, vertex_faces or both with a slash. Default: all.")
    ] = None,
    file: FileOption = HISTORY,
    machine: Annotated[str | None, Option(help="Just this one's runs, by first digits.")] = None,
    preset: Annotated[
        str | None, Option("--preset", "--profile", help="Just the runs of this preset.")
    ] = None,
    last: Annotated[int | None, Option(min=1, help="Show so many runs; judge by all.")] = None,
    slopes: Annotated[bool, Option("--slopes", help="The slopes and intervals.")] = False,
    as_json: AsJson = False,
) -> None:
    """Print figures and verdicts by commit, and mark where they changed.

    Example: `hem history show half_edge/vertex_faces --last 10`
    """
    from experiments.regression import Trends, read_history
    from experiments.report import history_tables

    kept = read_history(file)
    if not kept.runs:
        _warn(kept.faults)
        raise ValueError(f"there is no run in {file}; begin with: hem study, hem history add")
    trends = Trends(kept).only(machine, preset)
    if as_json:
        print_json(history_tables.as_json(trends, claim, last))
    else:
        history_tables.show(trends, claim, console, last, slopes)
    _warn(kept.faults)


def _warn(faults: list[str]) -> None:
    for fault in faults:
        errors.print(f"hem: {fault}", style="yellow", markup=False)
