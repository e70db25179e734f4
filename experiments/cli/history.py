"""The commands ``hem history add`` and ``hem history show``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from experiments.cli.console import console, errors, user_errors

history = typer.Typer(help="What became of the claims from commit to commit.", no_args_is_help=True)
FileOption = Annotated[Path, typer.Option("--file", help="The history, a line per run.")]
HISTORY = Path("results/history.jsonl")


@history.command()
def add(
    run: Annotated[
        Path | None, typer.Argument(help="The folder of a run; the newest if it is not given.")
    ] = None,
    file: FileOption = HISTORY,
) -> None:
    """Append a finished run. What is there already is not added again."""
    with user_errors():
        from experiments.regression.history import append, read
        from experiments.regression.snapshots import record
        from experiments.runs.results import latest, load
        from experiments.runs.steadiness import noise

        found = load(run or latest())
        line = record(found)
        added = append(line, file)
        kept = read(file)
        name, commit, machine = line["run"], line["commit"][:10], line["machine"]["id"]
        where = f"commit {commit}{'*' if line['dirty'] else ''}, machine {machine}"
        told = "Added" if added else "Already there"
        console.print(
            f"{told}: {name} ({where}, {len(line['claims'])} claims). "
            f"{file} has {len(kept.runs)} run{'s'[: len(kept.runs) != 1]}.",
            highlight=False, soft_wrap=True, markup=False,
        )  # fmt: skip
        if line["dirty"]:
            console.print("* There were changes that are not committed.", style="dim")
        if (seen := noise(found)).too_busy:
            console.print(f"[yellow]{seen.words}[/]", highlight=False)
        _warn(kept.faults)


@history.command()
def show(
    claim: Annotated[
        str | None,
        typer.Argument(
            help="half_edge, vertex_faces or half_edge/vertex_faces. Default: all in brief."
        ),
    ] = None,
    file: FileOption = HISTORY,
    machine: Annotated[
        str | None, typer.Option(help="Just the runs of this machine; its first digits do.")
    ] = None,
    profile: Annotated[str | None, typer.Option(help="Just the runs of this profile.")] = None,
    last: Annotated[
        int | None, typer.Option(help="Show this many runs, the newest; judge by all.")
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Everything as JSON, for other programs.")
    ] = False,
) -> None:
    """Print figures and verdicts by commit, and mark where they changed."""
    with user_errors():
        from experiments.regression.history import read
        from experiments.regression.trends import chosen
        from experiments.report import history_tables

        if last is not None and last < 1:
            raise ValueError(f"--last is at least 1, not {last}")
        kept = read(file)
        if not kept.runs:
            _warn(kept.faults)
            raise ValueError(f"there is no run in {file}; begin with: hem study, hem history add")
        kept = history_tables.of(kept, machine, profile)
        names = chosen(kept, claim)
        if as_json:
            _print_json(history_tables.as_json(kept, names, last))
        else:
            history_tables.show(kept, names, console, last, brief=claim is None)
        _warn(kept.faults)


def _print_json(content: dict[str, Any]) -> None:
    text = json.dumps(content, indent=1, allow_nan=False)
    console.print(text, highlight=False, soft_wrap=True, markup=False)


def _warn(faults: list[str]) -> None:
    for fault in faults:
        errors.print(f"hem: {fault}", style="yellow", highlight=False, soft_wrap=True, markup=False)
