"""``hem study``: measure every structure, resume after anything, say whether time can be judged."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer
from rich.markup import escape
from typer import Option

from experiments.cli.console import console, errors, user_errors


def run_study(
    preset: Annotated[
        str | None,
        Option("--preset", "--profile", help="How much: smoke, quick (default), standard, full."),
    ] = None,
    resume: Annotated[bool, Option("--resume", help="Resume the newest unfinished run.")] = False,
    run: Annotated[
        Path | None, Option(help="With --resume: the run to resume, finished or not.")
    ] = None,
    output: Annotated[Path, Option(help="Where the runs are kept.")] = Path("results/runs"),
    structure: Annotated[
        list[str] | None, Option(help="Measure just this one; may be repeated.")
    ] = None,
    experiment: Annotated[
        list[str] | None, Option(help="Run just this one; may be repeated.")
    ] = None,
    seed: Annotated[int | None, Option(help="Of the order of the cases.")] = None,
    pin: Annotated[bool, Option(help="Keep each process on one core, where possible.")] = True,
    workers: Annotated[
        str | None, Option(help="A Dask scheduler, tcp://host:port: measure on its machines.")
    ] = None,
) -> None:
    """Measure every structure. The results go to a new folder, case by case.

    A case that would not fit into memory is skipped and says so; HEM_MEMORY=8G pretends that there
    is so much.
    """
    with user_errors():
        from experiments.harness import memory
        from experiments.runs import study
        from experiments.runs.worker import DEFAULT_SEED

        memory.available()  # whether HEM_MEMORY can be read
        if workers:
            from experiments.runs import cluster

            cluster.require(workers)
        if resume:
            folder = study.resume(output, run)
            given = {
                "--preset": preset, "--structure": structure, "--experiment": experiment,
                "--seed": seed, "--no-pin": not pin,
            }  # fmt: skip
            _require_as_begun(folder, given, workers)
        elif run:
            raise ValueError(f"to resume {run}, say --resume as well")
        else:
            order = DEFAULT_SEED if seed is None else seed
            some = structure or (), experiment or ()
            folder = study.begin(preset or "quick", output, *some, seed=order, pin=pin)
        _measure(folder, workers)


def _require_as_begun(folder: Path, given: Mapping[str, object], workers: str | None) -> None:
    """Raise ValueError for options that would change how a run was begun."""
    from experiments.runs import read_meta

    meta = read_meta(folder)
    begun = {
        "--preset": meta["preset"], "--structure": meta["structures"],
        "--experiment": meta["experiments"], "--seed": meta["seed"], "--no-pin": not meta["pin"],
    }  # fmt: skip
    for option, value in given.items():
        if value not in (None, False, [], begun[option]):
            raise ValueError(f"{folder} is resumed as it was begun: leave out {option}")
    if not workers and any(folder.glob("machine-*")):
        raise ValueError(f"{folder} is of a cluster: resume it with --workers tcp://…")


def _measure(folder: Path, workers: str | None) -> None:
    """Measure what a run lacks, and say how it went and what to do now."""
    from experiments.cli.progress import show_progress
    from experiments.runs import CannotWriteError, load, noise, study

    begin = perf_counter()
    resuming = f"hem study --resume --run {folder}" + (f" --workers {workers}" if workers else "")
    console.print(f"Measuring into {folder}", soft_wrap=True)
    try:
        with show_progress(study.plan(folder), folder) as observer:
            if workers:
                from experiments.runs import cluster

                cluster.run(folder, workers, observer)
            else:
                study.run(folder, observer)
    except KeyboardInterrupt:
        errors.print(f"Stopped. What is finished is in {folder}; resume with: {resuming}")
        raise typer.Exit(130) from None
    except study.StudyFailedError as failure:
        errors.print(f"[bold red]Some cases failed.[/] Try them again with: {resuming}\n")
        errors.print(escape(str(failure)), highlight=False, soft_wrap=True)
        raise typer.Exit(1) from None
    except CannotWriteError as error:
        raise ValueError(f"{error}. What is finished is kept; resume with: {resuming}") from error
    run = load(folder)
    if len(run.skipped):
        console.print(f"{len(run.skipped)} cases were skipped; hem report says which and why.")
    seen = noise(run)
    console.print(f"[yellow]{seen.words}[/]" if seen.too_busy else seen.words, highlight=False)
    console.print(f"Done in {perf_counter() - begin:.0f} s. Now: hem table, hem report")
